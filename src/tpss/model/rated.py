"""Transformers and sections of contact line that have a rating, and their rated currents."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from tpss.model.contact_line import LineLayout, stretches_of
from tpss.model.supply import system_of
from tpss.model.supply_plan import TRANSFORMER, SupplyPlan
from tpss.scenario.rating import CatenaryRating, LineTransformerRating
from tpss.scenario.supply import Supply
from tpss.scenario.supply.transformers import stations_beside_km
from tpss.units import si


class RatedTransformer(NamedTuple):
    """A transformer of the high-voltage line with a rating."""

    branch: int
    line: int
    position_km: float
    rating: LineTransformerRating
    rated_a: float
    """Current at rated power and the base voltage of the system. [A]"""


class RatedSection(NamedTuple):
    """A section of contact line with a rating; tracks that are tied everywhere share the current."""

    section: int
    line: int
    track: int | None
    """None: of all tracks."""
    ends_km: tuple[float, float]
    rating: CatenaryRating
    rated_a: float
    """Current that it bears for ever. [A]"""


def rated_transformers(plan: SupplyPlan, supply: Supply) -> Iterator[RatedTransformer]:
    """Transformers with a rating, in the order of their branches."""
    high_voltage = supply.high_voltage_line
    if high_voltage is None:
        return
    base_v, stations_km = system_of(supply).base_voltage_v, stations_beside_km(supply)
    for b, (kind, branch) in enumerate(zip(plan.branch_kinds, plan.branches, strict=True)):
        if kind != TRANSFORMER:
            continue
        line, km = plan.node_line[branch.end_node], plan.node_km[branch.end_node]
        at_station = km in stations_km
        unit = high_voltage.station_transformer if at_station else high_voltage.line_transformer
        if unit.rating is not None:
            rated_a = si(unit.rating, "rating_mva") / base_v
            yield RatedTransformer(b, line, km, unit.rating, rated_a)


def rated_sections(
    plan: SupplyPlan, supply: Supply, lines: Sequence[LineLayout]
) -> Iterator[RatedSection]:
    """Sections with a rating, line by line and track by track."""
    for line in lines:
        stretches = stretches_of(line, supply)
        for s, track in _sections_of(plan, line.number):
            ends_km = plan.sections[s].start_m / 1e3, plan.sections[s].end_m / 1e3
            middle_km = sum(ends_km) / 2.0
            stretch = next(each for each in stretches if each.begin_km <= middle_km < each.end_km)
            rating = stretch.catenary.rating
            if rating is not None:
                rated_a = rating.continuous_a * stretch.tracks / stretch.conductors
                yield RatedSection(s, line.number, track, ends_km, rating, rated_a)


def _sections_of(plan: SupplyPlan, line: int) -> Iterator[tuple[int, int | None]]:
    """Sections of a line, with the track of each, None where they are of all tracks."""
    for run in plan.runs[line]:
        for conductor, bounds in enumerate(run.sections):
            track = None if len(run.sections) == 1 else conductor + 1
            yield from ((s, track) for s in range(*bounds))
