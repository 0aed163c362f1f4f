"""Which laws there are: those that installed packages offer, and those registered in this process.

Packages are looked at when a law is asked for, not before: one that cannot be imported stands in
nobody's way who has no use for it.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from tpss.laws.law import Law, LawError

GROUP = "tpss.laws"
"""Entry points at which packages offer a `Law`, or a list of them."""


@dataclass(frozen=True)
class Registered:
    """A law, and whose it is."""

    law: Law
    origin: str
    """Package and version, or that it was registered in this process."""

    @property
    def in_words(self) -> str:
        """For the provenance of a result."""
        return f"{self.law.kind.name} law {self.law.name} of {self.origin}, {self.law.digest}"


_HERE = "this process"
_registered: dict[tuple[str, str], Registered] = {}


def register(law: Law) -> Law:
    """Let scenarios of this process name a law; one of the same kind and name is replaced.

    For notebooks and scripts.  Other processes, such as those of a study, do not know it: for these,
    offer it as an entry point ``tpss.laws`` of a package.
    """
    _registered[law.kind.name, law.name] = Registered(law, _HERE)
    return law


def known_laws() -> dict[tuple[str, str], Registered]:
    """All laws by kind and name; those of this process hide those of packages.

    Raises
    ------
    LawError
        A package's laws cannot be imported or are none, or two packages offer one of the same name.
    """
    return {**_of_packages(), **_registered}


def find_law(kind: str, name: str) -> Registered:
    """A law by its kind and name.

    Raises
    ------
    LawError
        There is none; or see `known_laws`.
    """
    laws = known_laws()
    if (kind, name) in laws:
        return laws[kind, name]
    known = sorted(own for of_kind, own in laws if of_kind == kind)
    there_are = f"take one of {', '.join(known)}, or " if known else ""
    raise LawError(
        f"there is no {kind} law {name!r}", f"{there_are}install the package that offers it"
    )


def laws_named(content: Any) -> list[str]:
    """The laws that a document names as ``law``, in words, sorted, with the digests of their functions.

    For those who have to know whether a table that was begun can be continued.
    """
    names = set(_names_in(content))
    if not names:
        return []
    return sorted(each.in_words for (_, name), each in known_laws().items() if name in names)


def _names_in(content: Any) -> Iterator[str]:
    if isinstance(content, Mapping):
        if isinstance(named := content.get("law"), str):
            yield named
        content = list(content.values())
    if isinstance(content, (list, tuple)):
        for each in content:
            yield from _names_in(each)


@cache
def _of_packages() -> dict[tuple[str, str], Registered]:
    found: dict[tuple[str, str], Registered] = {}
    for point in entry_points(group=GROUP):
        for each in _laws_at(point):
            key = each.law.kind.name, each.law.name
            if key in found:
                raise LawError(
                    f"{found[key].origin} and {each.origin} both offer a {key[0]} law {key[1]!r}",
                    "uninstall one of them, or have its law renamed",
                )
            found[key] = each
    return found


def _laws_at(point: EntryPoint) -> Iterator[Registered]:
    origin = f"{point.dist.name} {point.dist.version}" if point.dist else point.value
    try:
        offered = point.load()
    except Exception as error:  # whatever a module of somebody else's raises when it is imported
        raise LawError(
            f"the laws {point.name!r} of {origin} cannot be imported from {point.value}: "
            f"{type(error).__name__}: {error}",
            "mend or uninstall that package",
        ) from error
    laws = [offered] if isinstance(offered, Law) else list(offered)
    for law in laws:
        if not isinstance(law, Law):
            raise LawError(
                f"{point.value} of {origin} offers {law!r}, which is not a tpss.laws.Law",
                "mend or uninstall that package",
            )
        yield Registered(law, origin)
