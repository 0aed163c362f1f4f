"""Key paths into a scenario's document: one language for changes by hand, in variants and in studies.

``supply.converter_stations.Mid.converters``: tables are entered by their keys, lists by an item's number
from 0, or by its name where its items have names.  ``*`` is every item or key, and ``+``, at a list, one
more item behind its last.
"""

from collections.abc import Iterable, Mapping
from typing import Any

EVERY, ONE_MORE = "*", "+"


class NoSuchPlaceError(LookupError):
    """A path leads to no place; says what there is instead."""


def places_of(document: Any, path: str) -> list[str]:
    """Key paths, of keys and numbers only, of all places that a path names; the last key may be new.

    With ``*`` there may be none.

    Raises
    ------
    NoSuchPlaceError
        A list has no item of a name or number, or the path leads through a value.
    """
    return [".".join(keys) for keys in _follow(document, path.split("."), [])]


def _follow(container: Any, ahead: list[str], behind: list[str]) -> Iterable[list[str]]:
    """Keys of the places that the rest of a path names from a container on."""
    if not ahead:
        yield behind
        return
    key, *rest = ahead
    if key == EVERY:
        keys: Iterable[Any] = ()
        if isinstance(container, Mapping):
            keys = container
        elif isinstance(container, list | tuple):
            keys = range(len(container))
        for each in keys:
            yield from _follow(container[each], rest, [*behind, str(each)])
        return
    if container is None or isinstance(container, Mapping):
        inside = None if container is None else container.get(key)
        if key == ONE_MORE and container is None:  # the first item of a list that is not there yet
            key = "0"
        yield from _follow(inside, rest, [*behind, key])
        return
    if not isinstance(container, list | tuple):
        raise NoSuchPlaceError(f"{'.'.join(behind)} is a value; name tables by their keys")
    number = _number_of(key, container)
    inside = container[number] if number < len(container) else None
    yield from _follow(inside, rest, [*behind, str(number)])


def _number_of(key: str, items: list[Any] | tuple[Any, ...]) -> int:
    """Number of the item of a list that a key names."""
    if key == ONE_MORE:
        return len(items)
    if key.isdecimal() and int(key) < len(items):
        return int(key)
    names = [item.get("name") if isinstance(item, Mapping) else None for item in items]
    if key in names:
        return names.index(key)
    known = ", ".join(str(name) for name in names if name is not None)
    which = f"name one of {known}, or give its" if known else "give an item's"
    raise NoSuchPlaceError(
        f"{which} number from 0 to {len(items) - 1}, * for all of them, + for one more"
        if items
        else "the list is empty; + is its first item"
    )
