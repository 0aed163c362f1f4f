"""The load flow of lines of several conductors: time a train and step over that of one conductor.

    python benchmarks/conductors.py

A line of 60 km with a train every 2 km or closer, which draw constant powers, as one conductor, as
contact line and rails, with a feeder, and as two such tracks between autotransformers.  What is timed is
a solution from the state of the step before, in which every power was a thousandth less.
"""

import argparse
import time
from typing import Any

import numpy as np

from tpss.powerflow.assembly import SectionPart, assemble
from tpss.powerflow.bundles import BundlePart
from tpss.powerflow.links import LinkPart
from tpss.powerflow.network import loads_alone
from tpss.powerflow.solve import solve
from tpss.powerflow.system import system
from tpss.sources.grid import GridLaw
from tpss.sources.kinds import Source, SourceKind
from tpss.track.leg import Leg
from tpss.vehicle.train import Train
from tpss.vehicle.train_type import TrainType

from line_cases import Case, place

LENGTH_KM, POSTS = 60.0, 7
OWN_OHM_PER_KM, COMMON_OHM_PER_KM = 0.1 + 0.5j, 0.05 + 0.35j
SYSTEM = system(25e3, 25e3, 10e6, 50.0, 0.5, 1.35)
POWER_W = 20e6
"""Of all trains together."""


def fed_by(node: int) -> Any:
    """A station of 27.5 kV behind 1 + j3 ohm."""
    law = GridLaw.row(
        no_load_voltage_v=27.5e3, grid_impedance_ohm=1 + 3j, transformer_impedance_ohm=0j
    )
    return Source.array(
        [
            Source.row(
                node=node, kind=SourceKind.GRID, installed=1, controlled=False, rating_va=60e6,
                grid=law,
            )
        ]
    )  # fmt: skip


def network_of(conductors: int) -> tuple[Any, int]:
    """A line between posts of so many conductors, and its number of tracks."""
    width, cells = min(conductors, 3), POSTS - 1
    tracks = 2 if conductors == 6 else 1
    x, m = width * POSTS, 1e3 * LENGTH_KM / cells
    sections = [
        SectionPart(
            width * k + c % width, width * (k + 1) + c % width, m * k, m * (k + 1),
            OWN_OHM_PER_KM / 1e3, 0.0,
        )
        for c in range(conductors)
        for k in range(cells)
    ]  # fmt: skip
    if conductors == 1:
        return assemble(POSTS, sections, [], fed_by(0), SYSTEM), tracks
    z = np.full((conductors,) * 2, COMMON_OHM_PER_KM / 1e3) + np.diag(
        [(OWN_OHM_PER_KM - COMMON_OHM_PER_KM) / 1e3] * conductors
    )
    y = np.diag([2e-4 if c % width == 1 else 0.0 for c in range(conductors)]).astype(complex)
    returns = tuple(c + 1 if c % width == 0 else -1 for c in range(conductors))
    bundles = [
        BundlePart(tuple(c * cells + k for c in range(conductors)), returns, z, y)
        for k in range(cells)
    ]
    links = [LinkPart((0, 1, x), (1.0, -1.0, -1.0), 1e-3 + 0j), LinkPart((1,), (1.0,), 0.5 + 0j)]
    flat = [1.0, 0.0][:width] * POSTS + [1.0]
    if width == 3:
        flat = [1.0, 0.0, -1.0] * POSTS + [1.0]
        nodes = [(3 * k, 3 * k + 1, 3 * k + 2) for k in range(POSTS)]
        links += [LinkPart(each, (1.0, -2.0, 1.0), 0.5 + 2.6j) for each in nodes]
    return (
        assemble(
            x + 1, sections, [], fed_by(x), SYSTEM, links=links, bundles=bundles, flat_pu=flat,
            inner_ohm=[0.0],
        ),
        tracks,
    )  # fmt: skip


def case_of(conductors: int, trains: int) -> Case:
    """Trains evenly along the line, on its tracks by turns."""
    network, tracks = network_of(conductors)
    types, records = TrainType.blank(trains), Train.blank(trains)
    types.inertia_kg, types.slip_factor = 1.0, 1.0
    types.auxiliary_power_w = POWER_W / trains
    records.train_type = np.arange(trains)
    records.motion.position_m = 1e3 * LENGTH_KM * (np.arange(trains) + 0.5) / trains
    records.demand.per_efficiency = 1.0
    records.route = np.arange(trains) % tracks
    cells, width = POSTS - 1, min(conductors, 3)
    legs = [
        (-np.inf, 1.0, 0.0, 0, k + 1, width * k * cells, (width * k + 1) * cells)
        for k in range(tracks)
    ]
    return place(network, loads_alone(records, types), Leg.array(legs).reshape(tracks, 1))


def microseconds(case: Case, runs: int) -> float:
    """Least time of a solution from a state close by. [µs]"""
    best = np.inf
    for k in range(runs):
        case.loads.types.auxiliary_power_w *= 1.001 if k % 2 else 1.0 / 1.001
        begun = time.perf_counter()
        share, _ = solve(True, case.network, case.flow, case.loads)
        best = min(best, time.perf_counter() - begun)
        assert share == 1.0
    return 1e6 * float(best)


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=200)
    runs = parser.parse_args().runs
    print(f"{'trains':>6} {'conductors':>10} {'a solution':>12} {'a train':>9} {'over one':>9}")
    for trains in (30, 120, 480):
        one = 0.0
        for conductors in (1, 2, 3, 6):
            case = case_of(conductors, trains)
            solve(False, case.network, case.flow, case.loads)
            spent = microseconds(case, runs)
            one = spent if conductors == 1 else one
            print(
                f"{trains:6d} {conductors:10d} {spent:9.0f} µs {1e3 * spent / trains:6.0f} ns"
                f" {spent / one:9.1f}"
            )


if __name__ == "__main__":
    main()
