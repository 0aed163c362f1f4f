"""Spare time: held speeds, coasting before stops, and the least energy for a time.

The train of the closed form gains 1 m/s each second, loses as much with its brakes, and has a constant
resistance of 0.1 m/s², which also slows it down when it coasts.
"""

import math

import pandas as pd
import pytest

import tpss
from driving_program import Vehicle, least_cost
from faults import faults_of, finding_at
from tpss.model.build import build_model
from tpss.model.searches import lowest_between, root_between
from tpss.model.spare_time import Leg, way_that_takes
from tpss.model.traffic import build_services
from tpss.savings.table import spare_time_savings

from conftest import EXAMPLES
from properties.rules import keep_the_rules
from scenarios import short_line

CLOSED_FORM = {
    "simulation.motion": "continuous", "simulation.braking": "within-step",
    "simulation.time_step_min": 0.1,
    "trains.freight": {
        "mass_t": 100.0, "adhesive_mass_t": 100.0, "resistance_a_n": 10_000.0,
        "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0, "max_speed_kmh": 72.0,
        "max_retardation_m_s2": 1.0, "max_acceleration_m_s2": 1.0, "auxiliary_power_kw": 0.0,
        "power_factor": 1.0, "efficiency": 0.5,
        "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 1e5},
    },
    "line.speed_limits.0.speed_kmh": 72.0,
}  # fmt: skip

FAST = {
    **CLOSED_FORM,
    "trains.freight": {
        "mass_t": 400.0, "adhesive_mass_t": 100.0, "resistance_a_n": 6_000.0,
        "resistance_b_n_s_per_m": 60.0, "resistance_c_n_s2_per_m2": 8.0, "max_speed_kmh": 160.0,
        "max_retardation_m_s2": 0.6, "auxiliary_power_kw": 0.0, "power_factor": 1.0,
        "efficiency": 0.85, "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 4_000.0},
    },
    "line.speed_limits.0.speed_kmh": 160.0,
}  # fmt: skip

COAST = {"traffic.0.supplement_percent": 10.0, "traffic.0.spare_time": "coasting"}


def leg_of(changes: dict) -> Leg:
    """The whole way of the short line, 20 km."""
    scenario = short_line(changes)
    model, _ = build_model(scenario)
    service = build_services(scenario, model)[0]
    return Leg(model, service.train_type, service.start_m, service.stops_m[-1])


def test_time_and_energy_of_a_train_that_coasts_are_those_of_the_closed_form():
    """20 s and 200 m to 20 m/s, which it holds for 900 s up to 18.2 km; from there it coasts down to v
    at 0.1 m/s², and brakes at 1 m/s² over v²/2: (400 - v²)/0.2 + v²/2 = 1800 m gives v² = 200/4.5, and a
    time of (20 - v)/0.1 + v.

    The motors give 1.1 m/s² over 200 m and 0.1 m/s² over 18 km: 2.02 kJ/kg, twice that at half
    efficiency."""
    way = leg_of(CLOSED_FORM).way(coasts_from_m=18_200.0)
    v = math.sqrt(200.0 / 4.5)
    assert way.time_s == pytest.approx(20.0 + 900.0 + (20.0 - v) / 0.1 + v, rel=1e-9)
    assert way.energy_j == pytest.approx(2.0 * 100e3 * (1.1 * 200.0 + 0.1 * 18_000.0), rel=1e-9)


def test_a_train_that_has_coasted_down_to_a_quarter_of_its_speed_holds_that():
    """It coasts from 10 km on: (400 - 25)/0.2 = 1875 m to 5 m/s, which it holds for what is left."""
    way = leg_of(CLOSED_FORM).way(coasts_from_m=10_000.0)
    held_s = (10_000.0 - 1_875.0 - 12.5) / 5.0
    expected_s = 20.0 + 9_800.0 / 20.0 + 150.0 + held_s + 5.0
    assert way.time_s == pytest.approx(expected_s, rel=1e-6)


@pytest.mark.parametrize("manner", ["held-speed", "coasting", "least-energy"])
def test_each_manner_takes_the_time_and_none_less_energy_than_both_together(manner):
    leg = leg_of(FAST)
    for share in (1.02, 1.1, 1.4):
        wanted_s = share * leg.way().time_s
        way = way_that_takes(leg, wanted_s, manner)
        assert way.time_s == pytest.approx(wanted_s, rel=1e-5)
        best = way_that_takes(leg, wanted_s, "least-energy")
        assert best.energy_j <= way.energy_j * (1.0 + 1e-6)
        assert way.energy_j < leg.way().energy_j


@pytest.mark.parametrize("slope", [0.0, 5.0, -3.0])
def test_on_a_constant_gradient_the_least_energy_is_that_of_a_dynamic_program(slope):
    """The program bounds it from below by the highest of its bounds over the price of time."""
    leg = leg_of({**FAST, "line.gradients": [{"from_km": 0.0, "permille": slope}]})
    mass_kg = 400e3
    vehicle = Vehicle(
        200e3 / mass_kg, 4e6 / mass_kg, 0.6, (6e3 / mass_kg, 60.0 / mass_kg, 8.0 / mass_kg), 0.85
    )
    wanted_s = 1.15 * leg.way().time_s
    energy = way_that_takes(leg, wanted_s, "least-energy").energy_j / mass_kg

    def bound(price: float) -> float:
        cost = least_cost(vehicle, 20e3, slope * 1e-3, 160.0 / 3.6, price, places=600, levels=700)
        return price * wanted_s - cost

    price = lowest_between(bound, 0.5, 8.0, 0.2)
    assert energy == pytest.approx(-bound(price), rel=0.01)


def test_the_simulated_train_takes_its_supplement_and_less_energy():
    """Alone on a strong line it comes when it should; its speed falls before the stop."""
    fast = tpss.simulate(short_line({**FAST}))
    slow = tpss.simulate(short_line({**FAST, **COAST}))
    keep_the_rules(slow)
    hop_min = [float(result.trips.trip_min.iloc[0]) for result in (fast, slow)]
    assert hop_min[1] == pytest.approx(1.1 * hop_min[0], rel=2e-3)
    energy = [float(result.trips.energy_mwh.iloc[0]) for result in (fast, slow)]
    leg = leg_of(FAST)
    way = way_that_takes(leg, 1.1 * leg.way().time_s, "coasting")
    assert energy[1] == pytest.approx(way.energy_j / 3.6e9, rel=5e-3)
    assert energy[1] < 0.75 * energy[0]


def test_scheduled_times_leave_time_to_spare():
    """A train that is scheduled in 12 min comes after 12 min, not early."""
    times = {"traffic.0.arrive_after_min": 12.0}
    early = tpss.simulate(short_line({**FAST, **times}))
    just = tpss.simulate(short_line({**FAST, **times, "traffic.0.spare_time": "least-energy"}))
    assert float(early.trips.trip_min.iloc[0]) < 9.5
    assert float(just.trips.trip_min.iloc[0]) == pytest.approx(12.0, rel=2e-3)


def test_a_schedule_that_leaves_no_time_is_driven_as_fast_as_it_goes():
    times = {"traffic.0.arrive_after_min": 5.0, "traffic.0.spare_time": "least-energy"}
    hurried = tpss.simulate(short_line({**FAST, **times}))
    fast = tpss.simulate(short_line(FAST))
    assert hurried.trips.trip_min.iloc[0] == fast.trips.trip_min.iloc[0]


def test_a_train_that_feeds_back_has_less_to_gain_from_coasting():
    """What the brakes give back counts: a train that feeds back most of it coasts for less."""
    brakes = {"max_force_kn": 300.0, "max_power_kw": 9e3, "efficiency": 0.9}
    feeding = {**FAST, "trains.freight.regeneration": brakes}
    gained = []
    for changes in (FAST, feeding):
        leg = leg_of(changes)
        held, best = (
            way_that_takes(leg, 1.1 * leg.way().time_s, manner).energy_j
            for manner in ("held-speed", "least-energy")
        )
        gained.append(1.0 - best / held)
    assert 0.0 < gained[1] < gained[0]


def test_savings_are_found_of_a_scenario_that_leaves_its_step_open():
    """A way from stop to stop is one passage: no figure depends on the step."""
    given = tpss.load_scenario(EXAMPLES / "emu_25kv.toml")
    is_open = given.with_({"simulation.time_step_min": None})
    found, expected = (spare_time_savings(each, [5.0]) for each in (is_open, given))
    pd.testing.assert_frame_equal(found, expected)


def test_spare_time_without_time_and_with_steps_is_a_fault():
    """Nor with trains that are placed on the line, which may be faster."""
    found = faults_of({"traffic.0.spare_time": "coasting"})
    assert "give a supplement, or scheduled times" in finding_at("traffic.0", found).remedy
    stepped = {**COAST, "simulation.motion": "stepped"}
    assert "stepped" in finding_at("traffic.0.spare_time", faults_of(stepped)).problem
    placed = {
        "traffic.0.already_running": None,
        "traffic.0.initial_trains": [{"position_km": 1.0, "speed_kmh": 50.0}],
        "traffic.0.arrive_after_min": 30.0, "traffic.0.spare_time": "coasting",
    }  # fmt: skip
    assert "spare_time" in finding_at("traffic.0", faults_of(placed)).remedy


def test_trains_that_begin_together_start_apart_and_load_their_station_less():
    """Two services of the same minutes: the second one starts 200 s later, and so does the fourth train,
    and the peak of the station that feeds both is lower."""
    alike = {
        "name": "other",
        "train": "freight",
        "from": "West",
        "to": "Middle",
        "headway_min": 10.0,
    }
    both = {
        **FAST, "traffic": [{**alike, "name": "one"}, alike], "simulation.duration_min": 15.0,
        "simulation.until": None,
    }  # fmt: skip
    together = tpss.simulate(short_line(both))
    apart = tpss.simulate(short_line({**both, "signalling.starts_apart_s": 200.0}))
    departs_s = 60.0 * apart.trips.departure_min
    assert departs_s.to_list() == pytest.approx([0.0, 200.0, 600.0, 800.0])
    peaks = [float(result.stations.peak_power_mw.iloc[0]) for result in (together, apart)]
    assert peaks[1] < 0.8 * peaks[0]


def test_trains_with_a_schedule_that_wait_for_others_are_late():
    """A single train of the same minute, whose schedule stays, is 40 s late from its start on."""
    single = {"train": "freight", "from": "West", "to": "Middle", "departure_min": 1.0}
    late = {
        **FAST, "traffic": [{**single, "name": "a"}, {**single, "name": "b", "arrive_after_min": 30.0}],
        "simulation.duration_min": 15.0, "simulation.until": None, "signalling.starts_apart_s": 40.0,
    }  # fmt: skip
    stops = tpss.simulate(short_line(late)).stops
    first = stops[stops.kind == "start"]
    assert (60.0 * first.late_min).to_list() == pytest.approx([0.0, 40.0])


def test_searches_find_roots_and_valleys():
    assert root_between(lambda x: x**3 - 2.0, 0.0, 2.0, 1e-9) == pytest.approx(2.0 ** (1 / 3))
    assert lowest_between(lambda x: (x - 1.3) ** 2, 0.0, 2.0, 1e-6) == pytest.approx(1.3, abs=1e-5)
