"""25 kV stations on different phases of one grid: a case that two other programs have solved.

Two stations of 27.5 kV, each with a transformer of 30 MVA, 10 %, 100 kW, stand at a grid of 220 kV,
2500 MVA, R/Z = 0.1: A at km 0 between the phases R and S, B at km 50 between S and T.  A neutral section
of km 24.0 to 24.3 parts a line of 0.169 + j0.432 Ω/km.  Train 1 draws 5 MW and 1 Mvar at km 9, train 2
6 MW and 1.2 Mvar at km 21, train 3 7 MW and 1.4 Mvar at km 33.  A three-phase Newton method and a fixed
point on the tableau of all branches agree on what stands here to 1e-7 V.

Phasors of the load flow count from the station's voltage without load; the other programs count them
from the phase R, so those of A are turned by +30°, those of B by -90°.
"""

import cmath
import math

import numpy as np
import pytest

from tpss.model.contact_line import LineLayout
from tpss.model.supply import build_supply
from tpss.physics.three_phase import angle_of, impedance_between, sequences, winding_of
from tpss.powerflow.assembly import SectionPart, assemble
from tpss.powerflow.in_service import in_service
from tpss.powerflow.links import LinkPart
from tpss.powerflow.solve import solve
from tpss.results.three_phase import busbar_of
from tpss.scenario.supply import Supply
from tpss.sources.grid import GridLaw
from tpss.sources.kinds import Source, SourceKind

from networks import constant_loads, place

STATION = {
    "no_load_voltage_kv": 27.5,
    "grid_kv": 220.0,
    "grid_short_circuit_mva": 2500.0,
    "grid_r_over_x": 0.1 / math.sqrt(1.0 - 0.1**2),
    "transformer": {"rated_mva": 30.0, "short_circuit_percent": 10.0, "load_loss_kw": 100.0},
}
A = {**STATION, "name": "A", "position_km": 0.0, "phases": "RS"}
B = {**STATION, "name": "B", "position_km": 50.0, "phases": "ST"}
PLACES_KM = [9.0, 21.0, 33.0]
POWERS = [5e6 + 1e6j, 6e6 + 1.2e6j, 7e6 + 1.4e6j]
LINE_OHM_PER_M = (0.169 + 0.432j) / 1e3
TURNS = np.exp(1j * np.radians([30.0, 30.0, -90.0]))
APART = {
    "trains": [23705.62254 + 10588.99291j, 23445.11386 + 9263.192479j, -2510.300374 - 25873.80459j],
    "stations": [24023.69593 + 12394.04472j, -808.861625 - 27213.52725j],
    "currents": [430.3980226 + 86.56429994j, -79.6078452 - 262.8202734j],
    "across": 43684.00269,
}
TOGETHER = {
    "trains": [23776.96633 + 10563.91347j, 23514.65237 + 9241.563862j, -2534.391524 - 25729.30792j],
    "stations": [24097.751 + 12364.41824j, -825.6210457 - 27078.86981j],
    "currents": [429.6203378 + 85.56272355j, -80.43107247 - 264.1406521j],
    "across": 43606.35918,
}


def line_of(stations, neutral_km=((24.0, 24.3),)):
    return Supply(
        system="25kV-50Hz",
        catenary={"r_ohm_per_km": 0.169, "x_ohm_per_km": 0.432},
        transformer_stations=stations,
        neutral_sections=[{"from_km": begin, "to_km": end} for begin, end in neutral_km],
    )


def solved(supply, powers=POWERS, places_km=PLACES_KM, change=lambda network: network):
    layout = LineLayout("line", 0, 0.0, 50.0, (), ((0.0, 50.0, 1),), True)
    network, plan = build_supply(supply, (layout,))
    case = place(change(network), constant_loads([1e3 * km for km in places_km], powers))
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0
    return case, plan


def fed_a(case):
    """Currents of the stations, each against its own voltage without load. [A]"""
    return case.flow.nodes.leaving_current_a[case.network.sources.node]


def seen_from_r(case, supply):
    """Currents of the stations against phase R. [A]"""
    angles = [angle_of(station.phases) for station in supply.stations]
    return fed_a(case) * np.exp(1j * np.array(angles))


@pytest.mark.parametrize(
    ("more", "expected"), [({}, APART), ({"busbar": "north"}, TOGETHER)], ids=["apart", "together"]
)
def test_voltages_and_currents_are_those_of_the_other_programs(more, expected):
    """Ten digits are given, 1e-5 V and 1e-7 A."""
    supply = line_of([{**A, **more}, {**B, **more}])
    case, _ = solved(supply)
    assert np.abs(case.train_voltage * TURNS - expected["trains"]).max() < 2e-5
    volts = case.flow.nodes.voltage_v[case.network.sources.node] * TURNS[[0, 2]]
    assert np.abs(volts - expected["stations"]).max() < 2e-5
    assert np.abs(seen_from_r(case, supply) - expected["currents"]).max() < 1e-6


@pytest.mark.parametrize(
    ("more", "expected"), [({}, APART), ({"busbar": "north"}, TOGETHER)], ids=["apart", "together"]
)
def test_the_voltage_across_the_neutral_section_is_that_of_the_other_programs(more, expected):
    """The ends of the line are open there, so it is that between the last trains: 43.7 and 43.6 kV."""
    case, plan = solved(line_of([{**A, **more}, {**B, **more}]))
    before, behind = (
        next(n for n, name in enumerate(plan.nodes) if name.endswith(f"{side} neutral section"))
        for side in ("before", "behind")
    )
    volts = case.flow.nodes.voltage_v
    across = volts[before] * cmath.rect(1.0, math.pi / 6) - volts[behind] * -1j
    assert abs(across) == pytest.approx(expected["across"], abs=1e-4)


def test_unbalance_of_stations_with_grids_of_their_own():
    """0.4838779939 % at A, 0.3024232638 % at B; of the currents 1: both sequences are of one size."""
    supply = line_of([A, B])
    case, _ = solved(supply)
    for s, (station, expected) in enumerate(
        zip(supply.stations, (0.004838779939, 0.003024232638), strict=True)
    ):
        found = busbar_of([station], fed_a(case)[None, [s]])
        assert found.name == station.name
        assert found.unbalance == pytest.approx([expected], rel=1e-8)
        assert found.current_unbalance == pytest.approx([1.0], rel=1e-12)


def test_unbalance_and_phase_currents_of_a_common_busbar():
    """0.4138452133 %, 52.5 % of the currents; 54.757, 77.303 and 34.514 A in the phases."""
    supply = line_of([{**A, "busbar": "north"}, {**B, "busbar": "north"}])
    case, _ = solved(supply)
    found = busbar_of(supply.stations, fed_a(case)[None, :])
    assert found.unbalance == pytest.approx([0.004138452133], rel=1e-8)
    assert found.current_unbalance == pytest.approx([0.5252021342], rel=1e-8)
    amperes = [54.75722189, 77.30266126, 34.5143633]
    assert np.abs(found.phase_currents_a[0]) == pytest.approx(amperes, abs=1e-6)


def test_a_busbar_with_one_station_is_a_grid_of_its_own():
    """To the last digit: nothing is shared."""
    own, named = (solved(line_of([{**A, **more}, B]))[0] for more in ({}, {"busbar": "north"}))
    assert (own.train_voltage == named.train_voltage).all()


def test_phases_turn_nothing_on_an_island_of_its_own():
    """To the last digit: each island counts its phasors from its own voltage without load."""
    with_phases = solved(line_of([A, B]))[0].train_voltage
    without = solved(line_of([{**A, "phases": None}, {**B, "phases": None}]))[0].train_voltage
    assert (with_phases == without).all()


def test_a_station_that_is_out_leaves_the_other_with_the_grid_alone():
    """A feeds as if B had a grid of its own; trains under B have no voltage."""
    together = line_of([{**A, "busbar": "north"}, {**B, "busbar": "north"}])
    case, _ = solved(together, POWERS[:2], PLACES_KM[:2], lambda net: in_service(net, {1: 0}, []))
    alone, _ = solved(line_of([A, B]), POWERS[:2], PLACES_KM[:2])
    assert case.train_voltage == pytest.approx(alone.train_voltage, abs=1e-6)


def test_fewer_transformers_have_the_impedances_of_those_that_are_left():
    """One of A's two out is A with one; the grid that it shares stays the same."""
    shared = {"busbar": "north"}
    two, one = (
        line_of([{**A, **shared, "transformers": count}, {**B, **shared}]) for count in (2, 1)
    )
    out, _ = solved(two, change=lambda network: in_service(network, {0: 1}, []))
    assert out.train_voltage == pytest.approx(solved(one)[0].train_voltage, abs=1e-6)


CONNECTED = {**STATION, "name": "North", "position_km": 24.1}
VV = {**CONNECTED, "connection": "V/V", "phases_before": "RS", "phases_behind": "ST"}
SCOTT = {**CONNECTED, "connection": "Scott", "phases_before": "ST", "phases_behind": "R"}


@pytest.mark.parametrize(("station", "expected"), [(VV, 0.5), (SCOTT, 0.0)], ids=["V/V", "Scott"])
def test_equal_loads_at_the_terminals_have_the_unbalance_of_the_connection(station, expected):
    """Of currents A = B: √(A² + B² - AB)/(A + B) = 0.5; of M = T: (M - T)/(M + T) = 0."""
    stations = line_of([station]).stations
    found = busbar_of(stations, np.array([[300.0 - 60.0j, 300.0 - 60.0j]]))
    assert found.current_unbalance == pytest.approx([expected], abs=1e-12)


def test_unequal_loads_have_the_unbalance_of_the_connection():
    """A = 300 A, B = 120 A: V/V √(300² + 120² - 300·120)/420 = 0.622, Scott 180/420 = 0.429."""
    loads = np.array([[300.0, 120.0]]) * cmath.rect(1.0, -0.3)
    for station, expected in (
        (VV, math.sqrt(300**2 + 120**2 - 300 * 120) / 420),
        (SCOTT, 180 / 420),
    ):
        found = busbar_of(line_of([station]).stations, loads)
        assert found.current_unbalance == pytest.approx([expected], rel=1e-12)


def test_a_v_v_station_is_two_stations_at_a_common_busbar():
    supply = line_of([VV])
    assert [station.name for station in supply.stations] == ["North RS", "North ST"]
    assert [station.position_km for station in supply.stations] == [24.0, 24.3]
    case, _ = solved(supply)
    beside = [
        {**STATION, "name": name, "position_km": km, "phases": phases, "busbar": "North"}
        for name, km, phases in (("West", 23.99, "RS"), ("East", 24.31, "ST"))
    ]
    nearly, _ = solved(line_of(beside))
    assert case.train_voltage == pytest.approx(nearly.train_voltage, rel=1e-4)


def test_the_sides_of_a_scott_station_do_nothing_to_each_other():
    """A load on one side leaves the other at its voltage without load."""
    case, plan = solved(line_of([SCOTT]), POWERS[:2], PLACES_KM[:2])
    assert abs(case.flow.nodes.voltage_v[plan.sources[0]]) < 27_200.0
    assert case.flow.nodes.voltage_v[plan.sources[1]] == pytest.approx(27_500.0, abs=1e-9)


def test_a_load_on_one_side_of_a_v_v_station_moves_the_voltage_of_the_other():
    """By z₂₁ J = -Z₁ (27.5/220)² e^(j120°) J, of the current J of the other side against its voltage."""
    case, plan = solved(line_of([VV]), POWERS[:2], PLACES_KM[:2])
    z1_ohm = 220e3**2 / 2500e6 * complex(0.1, math.sqrt(0.99)) / 64.0
    # Against phase R the drop is -Z₁ J e^(j30°); the second side counts from its -90°.
    drop = -z1_ohm * fed_a(case)[0] * cmath.rect(1.0, 2.0 * math.pi / 3.0)
    assert case.flow.nodes.voltage_v[plan.sources[1]] == pytest.approx(27_500.0 - drop, abs=1e-6)


def test_windings_have_the_voltage_between_two_phases():
    for phases in ("RS", "ST", "TR", "SR", "TS", "RT", "R", "S", "T"):
        assert winding_of(phases).sum() == pytest.approx(0.0, abs=1e-15)
        assert impedance_between(phases, phases) == pytest.approx(2.0)
    angles = {"RS": 30, "ST": -90, "TR": 150, "SR": -150, "R": 0, "S": -120, "T": 120}
    for phases, degrees in angles.items():
        assert math.degrees(angle_of(phases)) == pytest.approx(degrees, abs=1e-9)


def test_sequences_of_balanced_currents_and_of_one_between_two_phases():
    """Balanced: all positive.  1 A from R to S: both of size 1/√3."""
    turn = cmath.exp(2j * math.pi / 3.0)
    positive, negative = sequences(np.array([1.0, turn.conjugate(), turn]))
    assert positive == pytest.approx(1.0)
    assert negative == pytest.approx(0.0, abs=1e-15)
    positive, negative = sequences(np.array([1.0, -1.0, 0.0], dtype=complex))
    assert abs(positive) == pytest.approx(1.0 / math.sqrt(3.0))
    assert abs(negative) == pytest.approx(1.0 / math.sqrt(3.0))


UNIT_OHM = 0.08402777778 + 2.519432481j
GRID_OHM = 220e3**2 / 2500e6 * complex(0.1, math.sqrt(0.99)) / 64.0
"""Of a phase, on the side of 27.5 kV."""


def phase_source(node, k):
    """A phase of the grid on the railway's side, behind its impedance."""
    return Source.row(
        node=node,
        kind=SourceKind.GRID,
        installed=1,
        controlled=False,
        rating_va=1.0,
        grid=GridLaw.row(
            no_load_voltage_v=cmath.rect(27_500.0 / math.sqrt(3.0), -k * 2.0 * math.pi / 3.0),
            grid_impedance_ohm=GRID_OHM,
            transformer_impedance_ohm=0j,
        ),
    )


def by_links(sections, feeds, loads, system):
    """A line of sections between nodes, fed at nodes by transformers of a ratio between two phases."""
    parts = [SectionPart(*each, LINE_OHM_PER_M, 0.0) for each in sections]
    first = 1 + max(part.end_node for part in parts)
    phases = [phase_source(first + k, k) for k in range(3)]
    links = [
        LinkPart(
            (node, first + "RST".index(pair[0]), first + "RST".index(pair[1])),
            (1.0, -ratio, ratio),
            UNIT_OHM * ratio**2,
        )
        for node, pair, ratio in feeds
    ]
    network = assemble(first + 3, parts, [], Source.array(phases), system, links=links)
    twin = place(network, loads)
    share, _ = solve(False, twin.network, twin.flow, twin.loads)
    assert share == 1.0
    return twin


def test_stations_at_a_busbar_are_the_grid_s_phases_and_transformers_between_them():
    """Ideal transformers, as links, and three sources of 27.5/√3 kV behind Z₁ give the same voltages.

    All is on the railway's side, against phase R.  Each link has its short-circuit impedance, and the
    weights 1 on the contact line, -1 and 1 on the two phases.
    """
    case, _ = solved(line_of([{**A, "busbar": "north"}, {**B, "busbar": "north"}]))
    sections = [(0, 1, 0.0, 24.15e3), (2, 3, 24.15e3, 50e3)]
    loads = constant_loads([1e3 * km for km in PLACES_KM], POWERS)
    twin = by_links(sections, [(0, "RS", 1.0), (3, "ST", 1.0)], loads, case.network.system)
    assert twin.train_voltage == pytest.approx(case.train_voltage * TURNS, abs=1e-5)


@pytest.mark.parametrize("seed", range(12))
def test_random_stations_at_a_busbar_agree_with_transformers_between_phases(seed):
    """Three islands, the middle one fed at both ends; any phases, ratios, trains that draw or feed."""
    random = np.random.default_rng(seed)
    pairs = random.choice(["RS", "ST", "TR", "SR", "TS", "RT"], 3)
    ratios = random.uniform(0.98, 1.02, 3)
    fed = [(0.0, 0), (24.5, 1), (45.0, 1), (50.0, 2)]
    stations = [
        {
            **STATION,
            "name": f"station {k}",
            "position_km": km,
            "phases": pairs[island],
            "busbar": "north",
            "no_load_voltage_kv": 27.5 * ratios[island],
        }
        for k, (km, island) in enumerate(fed)
    ]
    supply = line_of(stations, [(24.0, 24.2), (45.3, 45.5)])
    places_km = np.sort(random.uniform(1.0, 49.0, 5))
    powers = random.uniform(-2e6, 7e6, 5) + 1j * random.uniform(0.0, 1e6, 5)
    case, _ = solved(supply, list(powers), list(places_km))
    nodes_m = [(0, 1, 0.0, 24.1e3), (2, 3, 24.1e3, 24.5e3), (3, 4, 24.5e3, 45e3)]
    nodes_m += [(4, 5, 45e3, 45.4e3), (6, 7, 45.4e3, 50e3)]
    feeds = [
        (node, pairs[island], ratios[island])
        for node, (_, island) in zip((0, 3, 4, 7), fed, strict=True)
    ]
    loads = constant_loads(list(1e3 * places_km), list(powers))
    twin = by_links(nodes_m, feeds, loads, case.network.system)
    islands = np.searchsorted([24.1, 45.4], places_km)
    turns = np.exp(1j * np.array([angle_of(str(pairs[k])) for k in islands]))
    assert twin.train_voltage == pytest.approx(case.train_voltage * turns, abs=1e-5)
