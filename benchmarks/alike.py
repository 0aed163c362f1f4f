"""Whether key figures of two runs are the same: every figure by its name, and how far two are apart."""

import dataclasses
import math
from collections.abc import Collection, Iterator
from typing import Any

NOT_COMPARED = ("way", "audit")
"""Which way a run was made, and the audit's figures, which are roundings."""


def figures_in(
    value: Any, left_out: Collection[str] = NOT_COMPARED, name: str = ""
) -> Iterator[tuple[str, Any]]:
    """All figures in what holds some, by their names, such as ``stations.0.energy_mwh``.

    Those whose names are left out are not among them, nor what these hold; a place in a tuple is no part
    of such a name: ``stations.energy_mwh`` leaves that of all stations out.
    """
    parts = _parts(value)
    if parts is None:
        yield name, value
        return
    for part, held in parts:
        inner = f"{name}.{part}" if name else part
        if ".".join(each for each in inner.split(".") if not each.isdigit()) not in left_out:
            yield from figures_in(held, left_out, inner)


def _parts(value: Any) -> list[tuple[str, Any]] | None:
    """What a value holds, by its names; None of a figure."""
    if dataclasses.is_dataclass(value):
        return [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
    if isinstance(value, dict):
        return list(value.items())
    return [(str(k), each) for k, each in enumerate(value)] if isinstance(value, tuple) else None


def difference(found: Any, expected: Any, unit: float = 0.0) -> float:
    """Difference of two figures, relative to the expected one, or to a unit if that is more.

    It is infinite where they are no numbers, and not the same, or where one of them is unknown.
    """
    if found == expected:
        return 0.0
    if not (isinstance(found, float) and isinstance(expected, float)):
        return math.inf
    if math.isnan(found) and math.isnan(expected):
        return 0.0
    size = max(unit, abs(expected))
    apart = abs(found - expected) / size if size else math.inf
    return math.inf if math.isnan(apart) else apart


def differences(
    found: Any,
    expected: Any,
    agree: float,
    left_out: Collection[str] = NOT_COMPARED,
    unit: float = 0.0,
) -> list[str]:
    """Where key figures are further apart than roundings; those of different names are nowhere alike.

    Parameters
    ----------
    found, expected : KeyFigures, or part of some
        Of a run in lanes, and of the same one alone.
    agree : float
        Difference that counts as none, as of `difference`.
    left_out : collection of str
        As of `figures_in`.
    unit : float
        As of `difference`.
    """
    one, other = dict(figures_in(found, left_out)), dict(figures_in(expected, left_out))
    if one.keys() != other.keys():
        return [f"{name}: in one of them only" for name in sorted(one.keys() ^ other.keys())]
    return [
        f"{name}: {one[name]!r} in lanes, {other[name]!r} alone"
        for name in one
        if difference(one[name], other[name], unit) > agree
    ]
