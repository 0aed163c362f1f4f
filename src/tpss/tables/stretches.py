"""Values over stretches that may overlap: the lowest holds."""

from collections.abc import Sequence
from typing import NamedTuple


class Stretch(NamedTuple):
    """A value between two positions [km], and the row that it came from."""

    begin_km: float
    end_km: float
    value: float
    row: int


def lowest_of(stretches: Sequence[Stretch]) -> tuple[list[Stretch], list[tuple[float, float]]]:
    """The lowest value everywhere, as stretches one after another, and the gaps that none covers.

    Parameters
    ----------
    stretches : sequence of Stretch
        In any order, each longer than nothing.
    """
    edges = sorted({km for each in stretches for km in (each.begin_km, each.end_km)})
    ordered = sorted(stretches)
    found, gaps, covering, following = (
        list[Stretch](),
        list[tuple[float, float]](),
        list[Stretch](),
        0,
    )
    for begin, end in zip(edges, edges[1:], strict=False):
        covering = [each for each in covering if each.end_km > begin]
        while following < len(ordered) and ordered[following].begin_km <= begin:
            covering.append(ordered[following])
            following += 1
        if not covering:
            gaps.append((begin, end))
            continue
        lowest = min(covering, key=lambda each: (each.value, each.row))
        if found and found[-1].value == lowest.value and found[-1].end_km == begin:
            found[-1] = found[-1]._replace(end_km=end)
        else:
            found.append(Stretch(begin, end, lowest.value, lowest.row))
    return found, gaps
