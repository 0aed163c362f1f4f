"""Groups of commands that tell what is wrong with an option as the rest of TPSS tells it."""

from typing import Any

import typer
from typer.core import TyperGroup

from tpss.errors import shortened

NO_VALUE = " "
"""In the place of a value, of options that take none: typer would show a `bool` there."""

_KINDS = {
    "int_parsing": "a whole number",
    "int_from_float": "a whole number",
    "float_parsing": "a number",
}


class Commands(TyperGroup):
    """A group whose commands refuse a wrong value by that value, what it is not, and what it may be.

    Newer versions of typer pass on the words of what checks values for them, which name no value; those
    of older ones are left as they are.
    """

    def invoke(self, ctx: Any) -> Any:
        """Run the command that was asked for.

        Raises
        ------
        typer.BadParameter
            A value is wrong.
        """
        try:
            return super().invoke(ctx)
        except typer.BadParameter as error:
            error.message = _plain(error)
            raise

    def get_params(self, ctx: Any) -> Any:
        """Options of the group, those of typer's own too, with a value if they take one."""
        return _without_values(super().get_params(ctx))

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Command of that name, whose ``--help`` is shown without a value."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            _without_values([command.get_help_option(ctx)])
        return command


def _without_values(options: Any) -> Any:
    for option in options:
        if getattr(option, "is_flag", False):
            option.metavar = NO_VALUE
    return options


def _plain(error: typer.BadParameter) -> str:
    """What is wrong with a value, by what its check found."""
    from pydantic import ValidationError

    if not isinstance(error.__cause__, ValidationError):
        return error.message
    detail = error.__cause__.errors()[0]
    context, value = detail.get("ctx", {}), shortened(repr(detail["input"]))
    if "error" in context:  # a check of typer's own, whose words say it all
        return str(context["error"])
    if detail["type"] in _KINDS:
        return f"{value} is not {_KINDS[detail['type']]}"
    return f"{value} is out of range: {detail['msg'].removeprefix('Input ')}"
