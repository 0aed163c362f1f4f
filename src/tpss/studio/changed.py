"""What differs between two documents, as key paths that `Scenario.with_` takes."""

import json
import shlex
from collections.abc import Iterator, Mapping
from typing import Any

import tomlkit
from tomlkit.items import InlineTable

from tpss.scenario.paths import EVERY, ONE_MORE

Change = tuple[str, Any]
"""Key path and new value; None takes out what is there."""


def changes_between(before: Mapping[str, Any], after: Mapping[str, Any]) -> list[Change]:
    """Changes that make one document of another, if they are made in this order.

    Items are told by their numbers.  What no path can name, such as a key with a dot, is replaced
    with the table that holds it.
    """
    return list(_of_tables(before, after, ""))


def _of_tables(before: Mapping[str, Any], after: Mapping[str, Any], path: str) -> Iterator[Change]:
    """Changes of a table, or the whole of it where a key that differs cannot be named."""
    differing = [key for key in {**before, **after} if not _alike(before.get(key), after.get(key))]
    if path and not all(_is_plain(key) for key in differing):
        yield path, after
        return
    for key in differing:
        place = f"{path}.{key}" if path else key
        if key not in after:
            yield place, None
        else:
            yield from _of_values(before.get(key), after[key], place)


def _of_values(before: Any, after: Any, path: str) -> Iterator[Change]:
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        yield from _of_tables(before, after, path)
    elif isinstance(before, list) and isinstance(after, list) and before:
        yield from _of_lists(before, after, path)
    else:
        yield path, after


def _of_lists(before: list[Any], after: list[Any], path: str) -> Iterator[Change]:
    """Changes of items, then items taken out from the last one on, or added behind all others."""
    first = 0
    while first < min(len(before), len(after)) and _alike(before[first], after[first]):
        first += 1
    last = 0
    while last < min(len(before), len(after)) - first and _alike(
        before[-1 - last], after[-1 - last]
    ):
        last += 1
    out = before[first : len(before) - last]
    new = after[first : len(after) - last]
    if (len(new) > len(out) and last) or not after:
        yield path, after  # an item in the midst of others has no path
        return
    for number, (old, value) in enumerate(zip(out, new, strict=False), first):
        yield from _of_values(old, value, f"{path}.{number}")
    for number in reversed(range(first + len(new), first + len(out))):
        yield f"{path}.{number}", None
    for value in new[len(out) :]:
        yield f"{path}.{ONE_MORE}", value


def _alike(one: Any, other: Any) -> bool:
    """Whether two values are equal and of one kind: true is not 1, but 1.0 is."""
    if isinstance(one, bool) or isinstance(other, bool):
        return one is other
    if isinstance(one, Mapping) and isinstance(other, Mapping):
        return one.keys() == other.keys() and all(_alike(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_alike, one, other))
    return bool(one == other)


def _is_plain(key: str) -> bool:
    """Whether a key can be a part of a key path."""
    return key not in ("", EVERY, ONE_MORE) and "." not in key


def as_toml(value: Any) -> str:
    """A value as one writes it into a file of TOML, in one line."""
    return str(_inline(value).as_string())


def _inline(value: Any) -> Any:
    if isinstance(value, Mapping):
        table: InlineTable = tomlkit.inline_table()
        for key, inside in value.items():
            table.append(key, _inline(inside))
        return table
    if isinstance(value, list):
        array = tomlkit.array()
        array.extend(_inline(each) for each in value)
        return array
    return tomlkit.item(value)


def as_options(changes: list[Change]) -> str:
    """Changes as options of the command line."""
    texts = (f"{path}={'' if value is None else as_toml(value)}" for path, value in changes)
    return " ".join(f"--set {shlex.quote(text)}" for text in texts)


def as_python(file: str, changes: list[Change]) -> str:
    """Changes as a program that loads the scenario and makes them."""
    lines = ["import tpss", "", f"scenario = tpss.load_scenario({json.dumps(file)})"]
    for group in _without_repetition(changes):
        inside = "".join(f"    {json.dumps(path)}: {value!r},\n" for path, value in group.items())
        lines.append(f"scenario = scenario.with_({{\n{inside}}})")
    return "\n".join(lines) + "\n"


def _without_repetition(changes: list[Change]) -> Iterator[dict[str, Any]]:
    """Changes in groups without a path twice, which a dict cannot hold."""
    group: dict[str, Any] = {}
    for path, value in changes:
        if path in group:
            yield group
            group = {}
        group[path] = value
    if group:
        yield group
