"""Stretches of contact line that no feeding station reaches, as they are open or out."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tpss.model.contact_line import Run
from tpss.model.outages import layout_of, service_of
from tpss.model.supply_plan import SupplyPlan
from tpss.powerflow.network import UNFED, Network
from tpss.scenario.line import CLOSEST_KM
from tpss.scenario.scenario import Scenario
from tpss.units import kilometres, on_line


class UnfedStretch(NamedTuple):
    """A stretch of a line without voltage."""

    line: str
    """Name of the line; empty if there is no other one."""
    from_km: float
    to_km: float
    track: int
    """Number of the track, 0: all of them."""

    @property
    def in_words(self) -> str:
        """Where it is."""
        place = on_line(self.line, f"{kilometres(self.from_km)}-{kilometres(self.to_km)} km")
        return f"{place}, track {self.track}" if self.track else place


def unfed_stretches(scenario: Scenario) -> list[UnfedStretch]:
    """Stretches that are without a feeding station at some time of a run, in the order of the lines.

    Those that are said to have no contact line are left out.
    """
    plan = layout_of(scenario, scenario.outage).plan
    service = service_of(scenario)
    networks = [service.network, *(each.network for each in service.switchings)]
    dark = {s for network in networks for s in _dark_sections(network)}
    names = list(scenario.lines_by_name)
    found: list[UnfedStretch] = []
    for name, runs in zip(names, plan.runs, strict=True):
        bare = [
            each for each in scenario.supply.without_contact_line if scenario.line_of(each) == name
        ]
        spans = (
            span
            for run in runs
            for span in _spans(run, plan, dark)
            if not any(each.from_km <= span[0] and span[1] <= each.to_km for each in bare)
        )
        shown = name if len(names) > 1 else ""
        found += _joined(
            UnfedStretch(shown, *span) for span in sorted(spans, key=lambda x: x[::-1])
        )
    return found


def _dark_sections(network: Network) -> list[int]:
    begins = network.sections["start_node"]
    return np.flatnonzero(network.source_of_node[begins] == UNFED).tolist()


def _spans(run: Run, plan: SupplyPlan, dark: set[int]) -> Iterator[tuple[float, float, int]]:
    """Beginnings and ends of sections without a source [km], and their tracks."""
    by_track = []
    for bounds in run.sections:
        above = [plan.sections[k] for k in range(*bounds) if k in dark]
        by_track.append([(each.start_m / 1e3, each.end_m / 1e3) for each in above])
    if all(spans == by_track[0] for spans in by_track):
        by_track = by_track[:1]
    for number, spans in enumerate(by_track, 1):
        yield from ((*span, number if len(by_track) > 1 else 0) for span in spans)


def _joined(stretches: Iterator[UnfedStretch]) -> list[UnfedStretch]:
    """Stretches of which those that follow each other on a track are one."""
    joined: list[UnfedStretch] = []
    for each in stretches:
        last = joined[-1] if joined else None
        if last and last.track == each.track and each.from_km - last.to_km < CLOSEST_KM:
            each = joined.pop()._replace(to_km=each.to_km)
        joined.append(each)
    return sorted(joined, key=lambda each: (each.from_km, each.track))


def bare_in_words(scenario: Scenario) -> str:
    """A sentence on trains without a store that run where there is no contact line, if there are any."""
    stretches = scenario.supply.without_contact_line
    running = dict.fromkeys(entry.train for entry in scenario.traffic)
    without = [name for name in running if scenario.trains[name].storage is None]
    if not stretches or not without:
        return ""
    listed = "; ".join(each.in_words for each in stretches)
    return (
        f"there is no contact line along {listed}, and {', '.join(without)} has no store of energy: "
        "where such trains come there, they coast and brake; give them storage"
    )


def unfed_in_words(scenario: Scenario) -> str:
    """A sentence on these stretches, with what would feed them; empty if there are none."""
    stretches = unfed_stretches(scenario)
    if not stretches:
        return ""
    listed = "; ".join(each.in_words for each in stretches)
    dark = f"no feeding station reaches {listed}: trains have no voltage there, coast and brake"
    if scenario.outage is not None:
        return dark
    supply = scenario.supply
    opened = [post.name for post in supply.posts if not post.closed]
    opened += [each.name for each in supply.section_breaks if not each.closed]
    closing = f"close {' or '.join(opened)}, or " if opened else ""
    return f"{dark}; {closing}add a feeding station there to feed them"
