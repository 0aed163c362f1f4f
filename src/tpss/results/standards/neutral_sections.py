"""Voltages across neutral sections between two phases of the grid."""

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.model.outages import layout_of
from tpss.model.phases import phases_of_nodes
from tpss.model.supply_plan import SupplyPlan
from tpss.physics.three_phase import angle_of
from tpss.results.standards.windows import Floats
from tpss.scenario.line import CLOSEST_KM
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import NeutralSection

Complexes = npt.NDArray[np.complex128]

SIDES = ("before neutral section", "behind neutral section")
"""How the names of the nodes on both sides end."""


class AcrossNeutral(NamedTuple):
    """A neutral section between two phases: the voltage between both sides."""

    line: str
    from_km: float
    to_km: float
    phases_before: str
    phases_behind: str
    angle_deg: float
    """Between the voltages of both sides without load. [°]"""
    highest_kv: float
    mean_kv: float
    at_min: float
    """When the voltage was highest. [min]"""


def across_neutral_sections(dataset: xr.Dataset, scenario: Scenario) -> list[AcrossNeutral]:
    """Voltages across the neutral sections both of whose sides have phases that are told."""
    supply = scenario.supply
    if not supply.neutral_sections or dataset.sizes["time"] < 2:
        return []
    plan = layout_of(scenario, scenario.outage).plan
    phases, lines = phases_of_nodes(plan, supply), list(scenario.lines_by_name)
    found = []
    for section in supply.neutral_sections:
        line = scenario.line_of(section)
        before, behind = (_nodes(section, lines.index(line), side, plan) for side in SIDES)
        if before and behind and phases[before[0]] and phases[behind[0]]:
            at = phases[before[0]], phases[behind[0]]
            told = line if len(lines) > 1 else ""
            found.append(_across(section, told, (before, behind), at, dataset))
    return found


def _nodes(section: NeutralSection, line: int, side: str, plan: SupplyPlan) -> list[int]:
    """Nodes of the contact lines on a side of a neutral section."""
    return [
        node
        for node, name in enumerate(plan.nodes)
        if plan.node_line[node] == line
        and abs(plan.node_km[node] - section.middle_km) < CLOSEST_KM
        and name.endswith(side)
    ]


def _across(
    section: NeutralSection,
    line: str,
    nodes: tuple[list[int], list[int]],
    phases: tuple[str, str],
    dataset: xr.Dataset,
) -> AcrossNeutral:
    before, behind = (
        _phasors(dataset, own[0], angle_of(of)) for own, of in zip(nodes, phases, strict=True)
    )
    both = (before != 0.0) & (behind != 0.0)
    across_kv: Floats = np.where(both, np.abs(before - behind) / 1e3, np.nan)
    apart = math.degrees(angle_of(phases[0]) - angle_of(phases[1]))
    known = bool(both.any())
    at = int(np.nanargmax(across_kv)) if known else 0
    return AcrossNeutral(
        line, section.from_km, section.to_km, *phases,
        angle_deg=abs((apart + 180.0) % 360.0 - 180.0),
        highest_kv=float(across_kv[at]),
        mean_kv=float(np.nanmean(across_kv)) if known else math.nan,
        at_min=float(dataset.time[at]) / 60.0 if known else math.nan,
    )  # fmt: skip


def _phasors(dataset: xr.Dataset, node: int, angle: float) -> Complexes:
    """Voltages of a node in every step, against phase R. [V]"""
    at = dataset.isel(node=node, time=slice(0, -1))
    turned = 1j * (at.node_angle.to_numpy() + angle)
    return np.asarray(at.node_voltage.to_numpy() * np.exp(turned))
