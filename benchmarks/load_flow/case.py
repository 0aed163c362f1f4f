"""The line that all programs solve: a network, its trains' powers and their places in every step.

100 km of BT catenary between two stations, three transformers between them and a 132 kV line beside
it: thesis Table 3-3 with one transformer more.  The others do not know the converter law, so ideal
sources of 16.5 kV at the angle 0 stand in the converters' place.

Each train moves to and fro on a stretch of line of its own, by up to 50 m a step (3 s at 60 km/h), so
none passes another or a feeding point: the others would have to build a new network for that.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

import tpss
from tpss.model import build_model
from tpss.powerflow.network import Network

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]
Indices = npt.NDArray[np.int32]
Run = Callable[[], Complexes]
"""Solves all steps of a case; gives the voltages, shape (steps, buses). [p.u.]"""

EXAMPLE = Path(__file__).parents[2] / "examples" / "thesis_3_3.toml"
TRANSFORMERS_KM = [25.0, 50.0, 75.0]

TOTAL_POWER_VA = 36e6 + 18e6j
"""Drawn by all trains together: the lowest voltage is then 0.92 p.u."""
LARGEST_MOVE_M = 50.0
SWING = 0.4
"""Of a train to either side, as a share of the distance between trains."""
FASTEST_TURN = 0.5
"""Of its to and fro in a step. [rad]"""

BASE_VOLTAGE_V, BASE_POWER_VA = 16.5e3, 10e6
BASE_IMPEDANCE_OHM = BASE_VOLTAGE_V**2 / BASE_POWER_VA
TOLERANCE = 1e-8
"""Power mismatch of a solution, in per unit of `BASE_POWER_VA`; a simulation with TPSS takes 1e-10."""
MOST_ITERATIONS = 20


@dataclass(frozen=True)
class Case:
    """A line with trains over a number of steps.

    Its buses are the network's fixed nodes, then the trains from west to east.
    """

    network: Network
    position_m: Floats
    """Shape (steps, trains). [m]"""
    power_va: Complexes
    """Drawn by the trains, shape (steps, trains). [VA]"""

    @property
    def steps(self) -> int:
        return self.position_m.shape[0]

    @property
    def trains(self) -> int:
        return self.position_m.shape[1]

    @property
    def nodes(self) -> int:
        """Number of fixed nodes."""
        return self.network.source_of_node.size

    @property
    def buses(self) -> int:
        return self.nodes + self.trains

    @property
    def source_nodes(self) -> Indices:
        return self.network.sources.node.astype(np.int32)

    @property
    def load_buses(self) -> Indices:
        return self.nodes + np.arange(self.trains, dtype=np.int32)

    def first(self, steps: int) -> "Case":
        """The same case with its first steps only."""
        return Case(self.network, self.position_m[:steps], self.power_va[:steps])


def build_case(trains: int, steps: int, moving: bool) -> Case:
    """The line with ideal sources, and so many trains, which draw the same in total.

    Parameters
    ----------
    moving : bool
        Whether the trains move and draw constant powers, or stand and draw changing ones.
    """
    rng = np.random.default_rng(trains)
    network = ideal(build_network())
    distance_m = network.sections.end_m[-1] / trains
    swing_m = SWING * distance_m
    pace = min(LARGEST_MOVE_M / swing_m, FASTEST_TURN)
    turn = np.sin(pace * np.arange(steps)[:, None] + rng.uniform(0.0, 2.0 * np.pi, trains))
    share = rng.uniform(0.5, 1.5, (2, trains))
    share /= share.sum(axis=1, keepdims=True)
    position_m = distance_m * (np.arange(trains) + 0.5) + swing_m * turn * moving
    power = TOTAL_POWER_VA.real * share[0] + 1j * TOTAL_POWER_VA.imag * share[1]
    return Case(network, position_m, power * (1.0 + 0.2 * turn * (not moving)))


def build_network() -> Network:
    """The network with its converter stations."""
    changes = {"supply.high_voltage_line.transformers_km": TRANSFORMERS_KM}
    model, _ = build_model(tpss.load_scenario(EXAMPLE, changes))
    system = model.network.system
    assert (system.base_voltage_v, system.base_power_va) == (BASE_VOLTAGE_V, BASE_POWER_VA)
    return model.network


def ideal(network: Network) -> Network:
    """The same network with ideal sources in the converters' place."""
    sources = network.sources.copy()
    for name in ("droop_v_per_var", "generator_reactance_ohm", "motor_reactance_ohm"):
        sources["converter"][name] = 0.0
    return network._replace(sources=sources)


@dataclass(frozen=True)
class Branches:
    """The same network as other programs want it: impedances between buses."""

    start: Indices
    end: Indices
    impedance: Complexes
    """Shape (steps, branches). [p.u.]"""


def build_branches(case: Case) -> Branches:
    """Lumped impedances, then the pieces of contact line from west to east."""
    lumped, sections = case.network.branches, case.network.sections
    assert not sections.susceptance_s_per_m.any(), "the peers are given series impedances only"
    start, end = list(lumped.start_node), list(lumped.end_node)
    ohm = [np.tile(lumped.impedance_ohm, (case.steps, 1))]
    for section in sections:
        at_m = case.position_m[0]
        inside = np.flatnonzero((section.start_m < at_m) & (at_m < section.end_m))
        chain = [section.start_node, *(case.nodes + inside), section.end_node]
        start += chain[:-1]
        end += chain[1:]
        edges = np.broadcast_to([section.start_m, section.end_m], (case.steps, 2))
        places_m = np.hstack([edges[:, :1], case.position_m[:, inside], edges[:, 1:]])
        ohm.append(section.impedance_ohm_per_m * np.diff(places_m))
    return Branches(
        start=np.array(start, dtype=np.int32),
        end=np.array(end, dtype=np.int32),
        impedance=np.hstack(ohm) / BASE_IMPEDANCE_OHM,
    )
