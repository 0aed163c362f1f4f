"""Parts of a scenario that many cases have in common: what says the same is validated once, and shared.

Parts are frozen, so nobody can tell.  To find out what says the same takes a tenth of validating it.
What is made of a part, such as a network, is then found by the part itself: nothing has to be compared.
"""

import marshal
from collections.abc import Hashable
from typing import Any

from pydantic import GetCoreSchemaHandler, ValidationInfo
from pydantic_core import CoreSchema, core_schema

from tpss.kept import Kept
from tpss.scenario.fields import Part

MOST = 512
"""Parts that are kept, of some thousand bytes each."""

WITHOUT_REFERENCES = 2
"""Version of `marshal` in which the same tables always have the same bytes."""

OF_LAWS = b"law"
"""What stands in a table that names a law of another package, which may be another one the next time."""

_parts = Kept[Any](MOST)


class MadeOnce(Part):
    """A part that equal tables share."""

    @classmethod
    def __get_pydantic_core_schema__(
        cls, source: type[Any], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        def validate(given: Any, validated: Any, info: ValidationInfo) -> Any:
            told = _told(given, info)
            if told is None:
                return validated(given)
            return _parts.of((cls, told), lambda: validated(given))

        return core_schema.with_info_wrap_validator_function(validate, handler(source))


def _told(given: Any, info: ValidationInfo) -> Hashable | None:
    """All that the validation of a table depends on; None: it cannot be told, or is no table."""
    if not isinstance(given, dict):
        return None
    context = sorted((info.context or {}).items())
    try:
        told = marshal.dumps((given, info.mode, context), WITHOUT_REFERENCES)
    except ValueError:  # it holds what no file does
        return None
    return None if OF_LAWS in told else told
