"""Supplies of unusual layout, and machines used outside what their networks were trained on."""

import numpy as np
import pytest

from tpss.model.effort_curve import adhesion

from scenarios import gradients, journey, limits, phases, run

STATION = {"type": "Q48/Q49", "converters": 2}


def step(minutes: float) -> dict[str, float]:
    return {"simulation.time_step_min": minutes}


def fed_at(*places_km: float) -> dict[str, object]:
    return {
        "supply.converter_stations": [
            {"name": f"C{i}", "position_km": km, **STATION} for i, km in enumerate(places_km)
        ]
    }


def placed_at_kmh(speed_kmh: float) -> dict[str, object]:
    """A light train at this speed, 12 km before its stop."""
    return {
        "trains.freight.mass_t": 80.0,
        "trains.freight.max_speed_kmh": 300.0,
        **limits((0, 300)),
        "traffic.0.first_departure_min": 30.0,
        "traffic.0.initial_trains": [{"position_km": 8.0, "speed_kmh": speed_kmh}],
    }


def test_a_station_in_mid_line_feeds_both_sides():
    """The only station stands at 10 km: the train draws from ahead of it, then from behind; both ends
    of the line are open, and beyond the train there is no current and no drop."""
    result = run({**step(0.1), **fed_at(10.0)})
    assert result.status == "finished"
    node = result.dataset.node_voltage.to_numpy()[:-1]
    train = result.dataset.pantograph_voltage.sel(train="eastbound 1").to_numpy()[:-1]
    x = journey(result).x[:-1]
    begin, middle, end = (
        node[:, result.dataset.node_position.to_numpy().tolist().index(m)] for m in (0, 1e4, 2e4)
    )
    before, behind = x < 9_990.0, x > 10_010.0
    assert begin[before] == pytest.approx(train[before], rel=1e-9)
    assert end[before] == pytest.approx(middle[before], rel=1e-9)
    assert end[behind] == pytest.approx(train[behind], rel=1e-9)
    assert begin[behind] == pytest.approx(middle[behind], rel=1e-9)


def test_the_drop_to_a_train_beyond_the_last_station_is_that_of_one_line():
    """Station at 5 km, train holding 60 km/h at x: U = U_s - z (x - 5 km) I, as phasors."""
    result = run({**step(0.1), **fed_at(5.0)})
    data, way = result.dataset, journey(result)
    k = int(np.searchsorted(way.x, 18_000.0))
    p, q, u, angle = (
        float(data[name][k, 0])
        for name in ("active_power", "reactive_power", "pantograph_voltage", "pantograph_angle")
    )
    station = data.node_position.to_numpy().tolist().index(5e3)
    train = u * np.exp(1j * angle)
    current = np.conj(complex(p, q) / train)
    at_station = train + complex(0.21, 0.20) * (way.x[k] / 1e3 - 5.0) * current
    assert float(data.node_voltage[k, station]) == pytest.approx(abs(at_station), rel=1e-9)
    assert float(data.node_angle[k, station]) == pytest.approx(np.angle(at_station), abs=1e-9)


@pytest.mark.parametrize("catenary", ["BT", "AT"])
@pytest.mark.parametrize("places", [(0.0, 10.0, 20.0), (3.0, 17.0), (0.001,), (19.999, 10.0)])
def test_a_train_passes_every_node_of_the_line(catenary, places):
    """At, just before and just behind stations, ends and transformers, with trains on either side."""
    changes = {**fed_at(*places), "supply.catenary": catenary, "traffic.0.headway_min": 3.0}
    between = [km for km in (5.0, 10.001) if min(abs(km - s) for s in places) > 0.0005]
    changes["supply.high_voltage_line"] = {"type": "132kV", "transformers_km": between}
    assert run({**changes, **step(0.1)}).status == "finished"


def test_a_mid_line_station_has_a_transformer_like_those_at_the_ends():
    """25 MVA for stations, wherever they stand, 16 MVA for transformers between them."""
    high_voltage = {"type": "132kV", "transformers_km": [5.0]}
    result = run({**fed_at(0.0, 10.0, 20.0), "supply.high_voltage_line": high_voltage, **step(0.5)})
    branches = result.dataset.branch.to_numpy().tolist()
    names = {f"transformer {km} km" for km in (0, 5, 10, 20)}
    assert names <= set(branches)
    data = result.dataset.isel(time=4)
    for place, ohm in ((10e3, complex(0.037, 0.54)), (5e3, complex(0.065, 0.85))):
        line, high = (
            float(data.node_voltage[i]) / level * np.exp(1j * float(data.node_angle[i]))
            for i, level in (
                (i, 8.0 if "high" in str(data.node[i].item()) else 1.0)
                for i in np.flatnonzero(data.node_position == place)
            )
        )
        current = float(data.branch_current[branches.index(f"transformer {place / 1e3:g} km")])
        assert current == pytest.approx(abs(line - high) / abs(ohm), rel=1e-6)


@pytest.mark.parametrize(
    ("changes", "counter"),
    [
        ({"trains.freight.max_motor_current_a": 2081.0}, "effort_extrapolated"),
        (placed_at_kmh(260.0), "effort_extrapolated"),
        ({"trains.freight.max_speed_kmh": 200.0, "trains.freight.mass_t": 80.0, **limits((0, 200)),
          "trains.freight.resistance_c_n_s2_per_m2": 1.0}, "power_factor_extrapolated"),
        ({"trains.freight.reactive_power": "double-bridge",
          "trains.freight.max_motor_voltage_v": 900.0, **limits((0, 100))}, "bridge_extrapolated"),
        ({**placed_at_kmh(210.0), "trains.freight.max_motor_current_a": 400.0}, "effort_clipped"),
        ({**placed_at_kmh(210.0), "trains.freight.max_motor_current_a": 400.0,
          "trains.freight.motor_inertia_kg": 0.0}, "effort_clipped"),
    ],
    ids=["2081 A", "260 km/h", "200 km/h", "900 V", "negative effort", "negative, no rotors"],
)  # fmt: skip
def test_networks_outside_their_range_are_counted(changes, counter):
    changes = {**step(0.1), "simulation.duration_min": 10.0, **changes}
    assert run(changes).summary["limited"][counter] > 0


def test_networks_inside_their_range_are_not_counted():
    limited = run({**step(0.1), "trains.freight.max_motor_current_a": 2080.0}).summary["limited"]
    assert {name for name, count in limited.items() if count} == {"short_piece"}


@pytest.mark.parametrize(
    ("current_a", "start_kn"),
    [
        (1250.0, 175.2),  # the machine
        (2080.0, 256.9),  # adhesion: 79 t · 9.81 · (0.161 + 7.5/44)
        (2500.0, 256.9),
    ],
)
def test_above_2080_ampere_the_rails_limit_the_effort_at_the_start(current_a, start_kn):
    result = run({**step(0.1), "trains.freight.max_motor_current_a": current_a})
    assert float(result.dataset.tractive_force[0, 0]) / 1e3 == pytest.approx(start_kn, abs=0.1)
    counted = result.summary["limited"]["effort_extrapolated"]
    assert (counted > 0) == (current_a > 2080.0)


@pytest.mark.parametrize("rail", ["dry", "wet"])
def test_an_adhesion_of_its_own_limits_a_train_on_any_rails(rail):
    """79 t · 9.81 · 0.2 = 155.0 kN, less than the machine's 175.2 kN."""
    result = run({"simulation.rail": rail, "trains.freight.adhesion": 0.2})
    assert float(result.dataset.tractive_force[0, 0]) == pytest.approx(79e3 * 9.81 * 0.2)


def test_an_adhesion_may_fall_with_the_speed():
    """From 0.2 at standstill to 0.1 at 20 km/h, linearly, and 0.1 beyond."""
    curve = {"speed_kmh": [0, 20], "value": [0.2, 0.1]}
    result = run({**step(0.1), "trains.freight.adhesion": curve})
    way, force = journey(result), result.dataset.tractive_force[:, 0].to_numpy()
    slow = np.flatnonzero((way.v < 10.0) & (way.a > 0.05))
    coefficient = 0.2 - 0.1 * np.minimum(3.6 * way.v[slow], 20.0) / 20.0
    assert slow.size > 10
    assert force[slow] == pytest.approx(79e3 * 9.81 * coefficient, rel=1e-12)
    (train,) = result.scenario.trains.values()
    drawn = adhesion(train, way.v[slow], result.scenario.simulation)
    assert drawn == pytest.approx(force[slow], rel=1e-12)


def test_wet_rails_limit_the_effort_over_speed():
    """79 t · 9.81 · 3.78/(23.6 + v), v in m/s, is less than the machine gives below some 10 m/s."""
    result = run({**step(0.1), "simulation.rail": "wet"})
    way, force = journey(result), result.dataset.tractive_force[:, 0].to_numpy()
    slow = np.flatnonzero((way.v < 10.0) & (way.a > 0.05))
    expected = 79e3 * 9.81 * 3.78 / (23.6 + way.v[slow])
    assert force[slow] == pytest.approx(expected, rel=1e-12)


def test_wet_rails_may_stall_a_train_that_dry_rails_carry():
    """Up 8 per mille: 15.4 + 115.4 kN; wet rails take 124.1 kN at standstill, dry ones the machine's."""
    hill = {**step(0.1), **gradients((0, 8.0)), "simulation.duration_min": 10.0}
    assert run(hill).status == "finished"
    wet = run({**hill, "simulation.rail": "wet"})
    assert wet.status == "stalled"
    assert "adhesion give 124.1 kN" in wet.summary["problem"]


def test_slip_is_paid_for_by_the_motors():
    """At constant speed the same force at the wheel rim costs 5 % more motor power with κ = 0.05, and
    no more of the auxiliaries' 151.5 kW."""
    powers = []
    for slip in (0.0, 0.05):
        result = run({**step(0.1), "trains.freight.slip": slip})
        way = journey(result)
        k = int(np.searchsorted(way.x, 15_000.0))
        assert way.a[k] == 0.0
        powers.append(float(result.dataset.active_power[k, 0]) - 151.5e3)
    assert powers[1] / powers[0] == pytest.approx(1.05, rel=1e-12)


def test_slip_slows_the_start():
    """The rotors' inertia counts 1 + κ times: F = (F_max + c F_res/M)/(1 + c/M) with c = 10.75 t · 1.2.

    F_max is the same but for the voltage, which differs by the power of 0.2 % more or less force."""
    result = run({**step(0.1), "trains.freight.slip": 0.2})
    plain = run(step(0.1))
    shares = []
    for r, rotor_t in ((result, 10.75 * 1.2), (plain, 10.75)):
        f, resistance = (
            float(r.dataset[n][0, 0]) for n in ("tractive_force", "running_resistance")
        )
        ratio = rotor_t / 1470.0
        shares.append(f * (1 + ratio) - ratio * resistance)
    assert shares[0] == pytest.approx(shares[1], rel=1e-4)
    assert phases(result)[0] == "motoring"
