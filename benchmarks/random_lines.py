"""Random supply networks with random trains, from light loads to far beyond collapse."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from tpss.kernel import kernel
from tpss.model.routes import Running
from tpss.model.trains import build_train_types
from tpss.numerics.series import SCRATCH_SHAPE
from tpss.physics.adhesion import Rail, adhesion_limit
from tpss.powerflow.assembly import BranchPart, SectionPart, assemble, new_flow
from tpss.powerflow.network import Flow, Loads, Network, loads_alone
from tpss.powerflow.placing import locate_trains, measure_pieces
from tpss.powerflow.system import system
from tpss.scenario.rolling_stock import Train
from tpss.sources.kinds import Source, SourceKind
from tpss.track.leg import along_one_line
from tpss.vehicle import train as train_records
from tpss.vehicle.demand import certify_free_band, update_cap_terms, update_speed_terms
from tpss.vehicle.train_type import TrainType

Random = np.random.Generator

MODEL = "Rc4-freight-1470t"
LIMITS = {"max_force_kn": 300, "max_power_kw": 6000, "full_voltage_kv": 15, "zero_voltage_kv": 10}
LOCOMOTIVES, POINTS = build_train_types(
    [
        Running(Train(model=MODEL)),
        Running(Train(model=MODEL, reactive_power="double-bridge", motor_voltage="former")),
        Running(Train(model=MODEL, reactive_power="double-bridge", filter_reactance_ohm=-0.45)),
        Running(Train(model=MODEL, tractive_effort=LIMITS, power_factor=0.95)),
    ]
)
SCRATCH = np.zeros(SCRATCH_SHAPE)
SYSTEM = system(15e3, 16.5e3, 10e6, 16.7, 0.5, 1.2)
CATENARIES = {
    # Impedance [ohm/m], susceptance [S/m], and connection impedance [ohm].
    "BT": (complex(0.21, 0.20) * 1e-3, 0.0, 0j),
    "AT": (complex(0.0335, 0.031) * 1e-3, 2 * math.pi * 16.7 * 13.5e-12, 0.189 + 0.293j),
}
HIGH_VOLTAGE_OHM_PER_M = complex(0.051, 0.062) * 1e-3 / (132.0 / 16.5) ** 2
TRANSFORMERS_OHM = {"station": 0.037 + 0.54j, "line": 0.065 + 0.85j}
MOST_STATIONS, MOST_TRANSFORMERS, MOST_TRAINS = 5, 4, 24
OTHER_LOAD = 0.1
"""Share of trains that start or stop to pull from one step to the next."""


@dataclass(frozen=True)
class Line:
    """A network with trains on it, ready to be solved."""

    network: Network
    loads: Loads
    flow: Flow

    def standing_anew(self) -> "Line":
        """The same line in its first state, without a solution."""
        return put_on_line(self.network, self.loads)


def random_line(rng: Random) -> Line:
    """A line of 20 to 200 km with 1 to 5 stations and 1 to 24 trains."""
    network = random_network(rng, rng.uniform(20e3, 200e3))
    return put_on_line(network, random_loads(rng, network))


def moved(rng: Random, line: Line) -> Line:
    """The line a step later: all trains a little further, a few with quite another load."""
    trains, types = line.loads.trains.copy(), line.loads.types.copy()
    end_m = line.network.sections.end_m[-1]
    motion = trains.motion
    motion.position_m = np.clip(motion.position_m + rng.uniform(0.0, 60.0, trains.size), 0.0, end_m)
    motion.speed_m_s = np.clip(motion.speed_m_s + rng.uniform(-1.0, 1.0, trains.size), 0.0, None)
    factor = rng.uniform(0.9, 1.1, trains.size)
    others = rng.random(trains.size) < OTHER_LOAD
    factor[others] = rng.uniform(0.0, 2.0, others.sum())
    trains.demand.force_cap_n *= factor
    types.auxiliary_power_w *= factor
    types.auxiliary_reactive_power_var *= factor
    prepare(trains, types, SCRATCH, POINTS)
    return put_on_line(line.network, line.loads._replace(trains=trains, types=types))


def put_on_line(network: Network, loads: Loads) -> Line:
    count = loads.trains.size
    flow = new_flow(network, count)
    locate_trains(count, loads.trains, along_one_line(network.sections.size), network, flow)
    measure_pieces(count, network, flow)
    return Line(network, loads, flow)


def random_network(rng: Random, length_m: float) -> Network:
    """Stations anywhere, BT or AT catenary, with a high-voltage line or without."""
    per_m, susceptance, connection = CATENARIES[rng.choice(list(CATENARIES))]
    stations = list(rng.uniform(0.0, length_m, rng.integers(1, MOST_STATIONS + 1)))
    high_voltage = rng.random() < 0.5
    transformers = list(rng.uniform(0.0, length_m, rng.integers(0, MOST_TRANSFORMERS + 1)))
    transformers = transformers if high_voltage else []
    points = sorted({0.0, length_m, *stations, *transformers})
    node = {m: n for n, m in enumerate(points)}
    n_nodes, branches = len(points), []
    feeding = dict(node)
    if connection:
        for m in stations:
            feeding[m], n_nodes = n_nodes, n_nodes + 1
            branches.append(BranchPart(feeding[m], node[m], connection))
    before: tuple[float, int] | None = None
    for m in sorted([*stations, *transformers]) if high_voltage else []:
        upper, n_nodes = n_nodes, n_nodes + 1
        ohm = (
            TRANSFORMERS_OHM["station"] if m in stations else TRANSFORMERS_OHM["line"] + connection
        )
        branches.append(BranchPart(feeding[m], upper, ohm))
        if before is not None:
            ohm = HIGH_VOLTAGE_OHM_PER_M * (m - before[0])
            branches.append(BranchPart(before[1], upper, ohm))
        before = (m, upper)
    sections = [
        SectionPart(node[a], node[b], a, b, per_m, susceptance)
        for a, b in zip(points, points[1:], strict=False)
    ]
    sources = random_sources(rng, [feeding[m] for m in stations])
    return assemble(n_nodes, sections, branches, sources, SYSTEM)


def random_sources(rng: Random, nodes: list[int]) -> Any:
    """All stations with the converter law, or all of them ideal."""
    rows = Source.blank(len(nodes))
    rows.node, rows.kind, law = nodes, SourceKind.CONVERTER, rows.converter
    law.no_load_voltage_v = rng.uniform(15_500.0, 17_000.0)
    law.motor_voltage_v = 16_500.0
    rows.installed = rng.integers(1, 7, len(nodes))
    if rng.random() < 0.7:
        law.droop_v_per_var = 50e-6
        law.generator_reactance_ohm = 0.53 * 16.5**2 / 10.0
        law.motor_reactance_ohm = 0.49 * 16.5**2 / 10.7
    return rows


def random_loads(rng: Random, network: Network) -> Loads:
    """Trains that draw a constant P and Q, locomotives, or some of both."""
    count = int(rng.integers(1, MOST_TRAINS + 1))
    share = rng.choice([0.0, 0.5, 1.0])
    types, trains = TrainType.blank(count), train_records.Train.blank(count)
    trains.train_type = np.arange(count)
    trains.motion.position_m = random_places(rng, network, count)
    trains.demand.mean_speed_weight_s = rng.choice([0.0, 1.5])
    trains.demand.voltage_v = 15_000.0
    largest_w = 10.0 ** rng.uniform(5.8, 7.8)
    for k in range(count):
        if rng.random() < share:
            types[k] = LOCOMOTIVES[rng.integers(LOCOMOTIVES.size)]
            drive(rng, trains[k], types[k])
        else:
            types[k] = constant_load(rng.uniform(0.0, largest_w), rng.uniform(-0.3, 0.8))
    prepare(trains, types, SCRATCH, POINTS)
    return loads_alone(trains, types)


def random_places(rng: Random, network: Network, count: int) -> Any:
    """Anywhere; some at a node, some at the same place as another."""
    end_m = network.sections.end_m[-1]
    places = rng.uniform(0.0, end_m, count)
    nodes_m = [*network.sections.start_m, end_m]
    for k in np.flatnonzero(rng.random(count) < 0.1):
        places[k] = rng.choice(nodes_m) if rng.random() < 0.5 else rng.choice(places)
    return places


def constant_load(active_w: float, reactive_share: float) -> Any:
    """A type whose auxiliaries draw all of its power, at any voltage the same."""
    row = LOCOMOTIVES[0].copy()
    row.auxiliary_power_w = active_w
    row.auxiliary_reactive_power_var = reactive_share * active_w
    return row


def drive(rng: Random, train: Any, kind: Any) -> None:
    """Speed, gradient and wanted force of a locomotive; half of them want all that they can get."""
    demand, speed_m_s = train.demand, rng.uniform(0.0, kind.highest_speed_m_s)
    train.motion.speed_m_s = speed_m_s
    demand.resistance_n = rng.uniform(0.0, 250e3)
    demand.adhesion_n = adhesion_limit(kind.adhesive_mass_kg, speed_m_s, Rail.DRY)
    demand.force_cap_n = demand.adhesion_n * min(1.0, rng.uniform(0.0, 2.0))
    demand.driven_share = 1.0


@kernel
def prepare(trains: Any, types: Any, scratch: Any, points: Any) -> None:
    """What stays fixed of all trains while they are solved, as the clock prepares it."""
    for k in range(trains.size):
        train, kind = trains[k], types[trains[k].train_type]
        train.demand.terms_speed_m_s = -1.0
        update_speed_terms(train.motion.speed_m_s, kind, train.demand, points, scratch)
        certify_free_band(kind, train.demand)
        update_cap_terms(kind, train.demand)
