"""Trains that brake at the last moment, within a step: `simulation.braking = "within-step"`.

Hand-worked stop used below: 1470 t on level track at 60 km/h, 500 m before its stop, b = 0.85 m/s², in a
step of 60 s.

    R = 33 716.7 N (15 400 + 4 650 + 13 666.7)
    v²/2b = 163.40 m,  v/b = 19.608 s,  τ = (500 - 163.40)/16.667 = 20.196 s
    it stands after 39.804 s, for the 20.196 s that are left
    F = R · 20.196/60 = 11 349 N,  R̄ = R · 39.804/60 = 22 368 N
    F_brake = (1 470 000 · 0.85 - R) · 19.608/60 = 397 315 N
    a = -16.667/60 = -0.27778 m/s²:  11 349 - 22 368 - 397 315 = -408 333 N = M a
    P = R · 16.667 · 20.196/60 / 0.8 + 151 500 = 387 940 W

and hand-worked limit: the same train 1 km before a limit of 30 km/h.

    (v - w)/b = 9.804 s,  τ = 60 - 9.804 = 50.196 s
    way = 16.667 · 50.196 + (16.667² - 8.333²)/1.7 = 836.601 + 122.549 = 959.150 m,
          then 40.850 m at 30 km/h
    F = R · 50.196/60 = 28 207 N
    F_brake = (1 470 000 · 0.85 - R) · 9.804/60 = 198 658 N
    P = R · 16.667 · 50.196/60 / 0.8 + 151 500 = 739 154 W
"""

import numpy as np
import pytest

import tpss
from tpss.step.state import TrainState

from scenarios import gradients, journey, limits, phases, run, short_line, stops

WITHIN = {"simulation.braking": "within-step"}
STEPS_MIN = [0.01, 0.05, 0.1, 0.3, 1.0, 2.0, 5.0]
PLACED = "eastbound initial 1"


def step(minutes):
    return {**WITHIN, "simulation.time_step_min": minutes}


def placed(position_km, speed_kmh, **more):
    """A train on the line at the start, for three minutes."""
    train = [{"position_km": position_km, "speed_kmh": speed_kmh}]
    return {"traffic.0.initial_trains": train, "simulation.duration_min": 3.0, **more}


def row(result, k, train=PLACED):
    """What is recorded of a train at an instant and over the step after it."""
    return result.dataset.sel(train=train).isel(time=k)


@pytest.fixture(scope="module")
def hand_worked():
    return run({**step(1.0), **stops((10.0, 1.0)), **placed(9.5, 60.0)})


def test_it_stands_at_its_stop_at_the_next_instant(hand_worked):
    assert phases(hand_worked, PLACED)[:2] == ["braking", "dwelling"]
    assert journey(hand_worked, PLACED).x[:3].tolist() == [9_500.0, 10_000.0, 10_000.0]
    assert journey(hand_worked, PLACED).v[1] == 0.0


def test_recorded_forces_are_the_means_of_the_step(hand_worked):
    found = row(hand_worked, 0)
    assert float(found.tractive_force) == pytest.approx(11_349, abs=1.0)
    assert float(found.running_resistance) == pytest.approx(22_368, abs=1.0)
    assert float(found.braking_force) == pytest.approx(397_315, abs=1.0)
    assert float(found.acceleration) == pytest.approx(-0.277_78, abs=1e-5)


def test_power_is_that_of_holding_for_its_share_of_the_step_and_the_auxiliaries(hand_worked):
    assert float(row(hand_worked, 0).active_power) == pytest.approx(387_940, abs=2.0)


def test_reactive_power_follows_the_motors_share(hand_worked):
    """Q = P tan φ of the motors, by the power factor at 60 km/h, and 113 625 var."""
    found = row(hand_worked, 0)
    motors_w = (float(found.active_power) - 151_500.0) * 0.8
    assert float(found.reactive_power) == pytest.approx(113_625 + 0.960_636 * motors_w, rel=1e-5)


def test_motor_current_is_the_mean_of_the_step(hand_worked):
    """As at the same force all along, a hundredth of the step held further away, times the share."""
    far = run({**step(1.0), **stops((10.0, 1.0)), **placed(5.0, 60.0)})
    whole, part = float(row(far, 0).motor_current), float(row(hand_worked, 0).motor_current)
    assert part == pytest.approx(whole * 20.196 / 60.0, rel=1e-4)


@pytest.mark.parametrize("current_model", ["power-factor", "double-bridge"])
def test_a_braking_train_balances_at_a_voltage_that_follows_its_power(current_model):
    """The audit looks at the power at every node: a train's share is inside the coupled solution."""
    changes = {"trains.freight.reactive_power": current_model, "traffic.0.headway_min": 4.0}
    result = run({**step(1.0), **changes, **stops((10.0, 1.0)), "simulation.duration_min": 60.0})
    assert result.audit["power_mismatch_va"] < 0.01


@pytest.mark.parametrize("step_min", STEPS_MIN)
def test_stops_are_met_to_a_nanometre_whatever_the_step(step_min):
    places = stops((10.0, 0.0), (14.7, 0.3), (14.71, 1.0))
    result = run({**step(step_min), **places, **gradients((0, 3), (9.8, -6), (14, 4), (18, -2))})
    assert result.status == "finished"
    assert result.audit["stop_error_m"] < 1e-9
    way = journey(result)
    assert {10_000.0, 14_700.0, 14_710.0, 20_000.0} <= set(way.x[way.v == 0.0])


def test_a_dwell_begins_with_the_instant_after_the_stop():
    result = run({**step(0.3), **stops((10.0, 0.9))})
    way = journey(result)
    assert (way.state[way.x == 10_000.0] == TrainState.DWELLING).sum() == 3
    train = result.dataset.sel(train="eastbound 1")
    dwelling = (train.train_state == TrainState.DWELLING).to_numpy()
    assert set(train.active_power.to_numpy()[dwelling]) == {151_500.0}


def test_the_time_of_arrival_is_that_within_the_step():
    """500 m before its destination, 39.804 s; the run goes on to the end of the step."""
    result = run({**step(1.0), **placed(19.5, 60.0)})
    trip = result.trips.set_index("train").loc[PLACED]
    assert trip.arrival_min * 60.0 == pytest.approx(39.804, abs=1e-3)
    assert trip.mean_speed_kmh == pytest.approx(500.0 / 39.804 * 3.6, rel=1e-4)
    assert journey(result, PLACED).state[1] == TrainState.ARRIVED


def test_trip_times_hardly_depend_on_the_step():
    """In whole steps those of 0.5 and 1 min are 0.45 min longer than that of 0.05 min."""
    trips = [run(step(h)).summary["trip_time_min"] for h in (0.05, 0.5, 1.0)]
    assert trips[1:] == pytest.approx([trips[0]] * 2, abs=0.1)


def test_a_train_brakes_fully_over_whole_steps_once_it_has_begun():
    """At steps of 3 s: 19.6 s with the brakes are a part, five or six whole steps, and a part."""
    result = run({**step(0.05), **stops((10.0, 1.0))})
    way = journey(result)
    braking = np.flatnonzero((way.state == TrainState.BRAKING) & (way.x < 10_000.0))
    assert way.a[braking[1:-1]] == pytest.approx(-0.85, rel=1e-9)
    assert len(braking) in (7, 8)
    assert braking[-1] - braking[0] == len(braking) - 1


def test_a_train_on_its_braking_course_at_the_start_goes_on_with_it():
    """At 60 km/h with v²/2b = 163.399 m left, and then one that is 1 mm too late."""
    way_m = (60 / 3.6) ** 2 / 1.7
    result = run({**step(0.1), **stops((10.0, 1.0)), **placed(10.0 - (way_m + 1e-9) / 1e3, 60.0)})
    assert journey(result, PLACED).a[:3] == pytest.approx(-0.85)
    late = {**step(0.1), **stops((10.0, 1.0)), **placed(10.0 - (way_m - 1e-3) / 1e3, 60.0)}
    with pytest.raises(tpss.ScenarioError, match=r"too fast to stop at 10 km\n"):
        tpss.simulate(short_line(late))


def test_trains_already_running_are_taken_over_in_the_midst_of_their_course():
    """A headway after its departure the first of them brakes, with four steps of 3 s behind it."""
    way = journey(run({**step(0.05), **stops((10.0, 0.5))}))
    begun = int(np.argmax(way.state == TrainState.BRAKING))
    headway = {"traffic.0.already_running": True, "traffic.0.headway_min": (begun + 4) * 0.05}
    result = run({**step(0.05), **headway, **stops((10.0, 0.5)), "simulation.duration_min": 2.0})
    taken_over = journey(result, PLACED)
    assert taken_over.a[:3] == pytest.approx(-0.85)
    assert taken_over.x[8] == 10_000.0
    assert result.audit["stop_error_m"] < 1e-9


def test_gradients_count_over_the_way_to_the_stop_and_no_further():
    """20 per mille behind the stop change nothing of the step that ends there."""
    level, steep = (
        run({**step(1.0), **stops((10.0, 1.0)), **placed(9.5, 60.0), **profile})
        for profile in (gradients((0, 0)), gradients((0, 0), (10.0, 20)))
    )
    assert float(row(steep, 0).gradient_force) == 0.0
    assert float(row(steep, 0).active_power) == float(row(level, 0).active_power)


def test_downhill_the_speed_is_held_with_the_brakes():
    """-10 per mille: -144.2 kN + 33.7 kN = -110.5 kN; no power, and the work of the brakes balances."""
    result = run({**step(1.0), **stops((10.0, 1.0)), **placed(9.5, 60.0), **gradients((0, -10))})
    found = row(result, 0)
    held_n, stopped_n = 110_490.3, 1_249_500 + 110_490.3
    assert float(found.braking_force) == pytest.approx(
        (held_n * 20.196 + stopped_n * 19.608) / 60.0, rel=1e-4
    )
    assert float(found.active_power) == 151_500.0


def test_a_train_that_cannot_hold_its_speed_brakes_evenly():
    """15 per mille ask for 250 kN, the machine gives less than 170 kN.  400 m before the stop the train
    brakes with v²/2d = 0.34722 m/s² for 48 s: (510 417 - 250 027) · 48/60 = 208 312 N."""
    hill = gradients((0, 0), (9.5, 15), (10.0, 0))
    result = run({**step(1.0), **stops((10.0, 1.0)), **placed(9.6, 60.0), **hill})
    found = row(result, 0)
    assert journey(result, PLACED).x[1] == 10_000.0
    assert float(found.tractive_force) == 0.0
    assert float(found.braking_force) == pytest.approx(208_312, abs=1.0)
    assert float(found.active_power) == 151_500.0


def test_on_a_hill_steeper_than_the_brakes_the_train_is_driven_to_its_stop():
    """100 t, brakes of 0.1 m/s², 25 per mille: 24.5 kN + 33.7 kN slow it down by 0.58 m/s²; it needs
    the motors all the way down to a stand."""
    weak = {"trains.freight.mass_t": 100.0, "trains.freight.max_retardation_m_s2": 0.1}
    result = run({**step(0.5), **weak, **stops((10.0, 1.0)), **gradients((0, 25))})
    way = journey(result)
    before = np.flatnonzero(way.x == 10_000.0)[0] - 1
    assert way.state[before] == TrainState.MOTORING
    assert way.braking[before] == 0.0
    assert way.a[before] >= -0.1


def test_a_course_that_the_machine_cannot_follow_is_found_anew():
    """300 t with weak brakes meet a ramp of 70 per mille that asks for more than the motors give."""
    changes = {
        **step(0.1),
        **stops((10.0, 1.0)),
        **gradients((0, -2.0), (9.72, 70.0), (9.78, -2.0)),
        **placed(9.6, 27.0),
        "trains.freight.mass_t": 300.0,
        "trains.freight.max_retardation_m_s2": 0.2,
    }
    result = run(changes)
    way, force = journey(result, PLACED), result.dataset.tractive_force.sel(train=PLACED)
    assert float(force.max()) > 0.9 * float(force[2:6].max()) > 1e5
    assert 10_000.0 in way.x


@pytest.mark.parametrize("step_min", STEPS_MIN)
@pytest.mark.parametrize("before_m", [-5.0, 0.0, 1e-3, 50.0, 400.0])
def test_a_lower_limit_around_the_stop_goes_first(step_min, before_m):
    """`run` looks at every step that passes the limit's position."""
    lower = limits((0, 60), (10.0 - before_m / 1e3, 20), (10.5, 60))
    result = run({**step(step_min), **stops((10.0, 1.0)), **lower})
    assert result.status == "finished"
    assert result.audit["stop_error_m"] < 1e-9


LOWER = limits((0, 60), (10.0, 30), (14.0, 60))


def test_a_train_holds_its_speed_before_it_brakes_to_a_lower_limit():
    result = run({**step(1.0), **LOWER, **placed(9.0, 60.0)})
    way, found = journey(result, PLACED), row(result, 0)
    assert way.v[:4] == pytest.approx([60 / 3.6, 30 / 3.6, 30 / 3.6, 30 / 3.6], rel=1e-12)
    assert way.x[1] == pytest.approx(9_959.150, abs=1e-3)
    assert float(found.tractive_force) == pytest.approx(28_207, abs=1.0)
    assert float(found.braking_force) == pytest.approx(198_658, abs=1.0)
    assert float(found.active_power) == pytest.approx(739_154, abs=2.0)
    assert way.state[0] == TrainState.BRAKING


@pytest.mark.parametrize("step_min", STEPS_MIN)
@pytest.mark.parametrize("place_km", [9.0, 9.37, 10.0])
@pytest.mark.parametrize("high_kmh", [40, 100])
def test_no_train_falls_below_a_lower_limit_ahead(step_min, place_km, high_kmh):
    """100 t, at its limit before 4 km.  In whole steps of 0.5 min the train came down to 4 km/h; that
    none is above its limit is a rule of every run."""
    light = {"trains.freight.mass_t": 100.0}
    result = run({**step(step_min), **light, **limits((0, high_kmh), (place_km, 30), (20, 60))})
    way = journey(result)
    near = way.v[(way.x > 6_000.0) & (way.x < place_km * 1e3 + 3_000.0)]
    assert near.min(initial=np.inf) >= 30 / 3.6 - 1e-9


def test_a_lower_limit_costs_a_trip_no_more_than_its_share_of_a_step():
    """At most a step is run at 30 km/h in place of 60, which costs 1 - 30/60 of it, and the energy by
    which running resistance differs; that back to 60 km/h adds a little.  Whole steps of a minute
    cost 2 min."""
    fine, minutes = (run({**step(h), **LOWER}).summary for h in (0.05, 1.0))
    assert minutes["trip_time_min"] == pytest.approx(fine["trip_time_min"], abs=0.6)
    assert minutes["total_energy_mwh"] == pytest.approx(fine["total_energy_mwh"], rel=0.015)


def test_a_train_that_cannot_hold_its_speed_before_a_lower_limit_brakes_uniformly():
    """15 per mille ask for more than the machine gives at 60 km/h."""
    hill = gradients((0, 0), (8.9, 15), (10.0, 0))
    result = run({**step(1.0), **LOWER, **placed(9.0, 60.0), **hill})
    way, found = journey(result, PLACED), row(result, 0)
    assert way.x[1] - way.x[0] == pytest.approx(30.0 * (way.v[0] + way.v[1]))
    assert way.v[1] == pytest.approx(30 / 3.6)
    assert float(found.tractive_force) * float(found.braking_force) == 0.0


def test_a_train_placed_too_near_to_a_lower_limit_for_that_brakes_in_whole_steps():
    """600 m before the limit: 60 km/h to 12 km/h takes all of the minute and of the way."""
    way = journey(run({**step(1.0), **LOWER, **placed(9.4, 60.0)}), PLACED)
    assert way.x[1] == pytest.approx(10_000.0)
    assert way.v[1] == pytest.approx(12 / 3.6)


def test_a_stop_behind_a_lower_limit_is_met_from_the_course_to_the_limit():
    """The stop is 10 m behind the limit's position."""
    for step_min in STEPS_MIN:
        result = run({**step(step_min), **limits((0, 60), (9.99, 30)), **stops((10.0, 1.0))})
        assert result.audit["stop_error_m"] < 1e-9


@pytest.mark.parametrize("step_min", [0.05, 0.5, 1.0])
def test_the_original_driver_brakes_within_steps_too(step_min):
    result = run({**step(step_min), "simulation.driver": "aggressive", **stops((10.0, 1.0))})
    assert result.status == "finished"
    assert 10_000.0 in journey(result).x
    assert result.audit["stop_error_m"] < 1e-9


def test_in_whole_steps_nothing_is_held_or_stood():
    result = run({"simulation.time_step_min": 0.5, **stops((10.0, 1.0))})
    assert result.scenario.simulation.braking == "whole-steps"
    assert float(result.dataset.arrival_time.max()) % 30.0 == 0.0
