"""Stops: close to each other, dwells, departures after them, whatever the step.

Rules: the final position error is below a millimetre, no deceleration is above the maximum; a dwell
lasts ceil(dwell/h) steps with auxiliaries only; a train so near its stop that full effort would leave
no plan takes the largest acceleration that leaves one.
"""

import numpy as np
import pytest

from scenarios import gradients, journey, limits, phases, run, stops

LIGHT = {"trains.freight.mass_t": 100.0}
STEPS_MIN = [0.01, 0.05, 0.3, 1.0, 2.0, 5.0]


def step(minutes: float) -> dict[str, float]:
    return {"simulation.time_step_min": minutes}


@pytest.mark.parametrize("step_min", [*STEPS_MIN, 0.1])
@pytest.mark.parametrize("mass_t", [100.0, 1470.0])
@pytest.mark.parametrize("braking", ["whole-steps", "within-step"])
def test_stops_closer_together_than_a_braking_distance(step_min, mass_t, braking):
    """50 m, then 10 m, then 1 m: to stop from 60 km/h takes 163 m."""
    places = stops((10.0, step_min), (10.05, step_min), (10.06, step_min), (10.061, step_min))
    manner = {"simulation.braking": braking, "trains.freight.mass_t": mass_t}
    result = run({**step(step_min), **places, **manner})
    assert result.status == "finished"
    way = journey(result)
    standing = way.x[way.state == 4]
    assert standing.tolist() == [10_000.0, 10_050.0, 10_060.0, 10_061.0]


def test_a_stop_within_the_way_of_one_step_is_reached_in_two():
    """50 m ahead, steps of 5 min: the speed v' after the first leaves a stop in whole steps if
    h v'/2 + h v'/2 = 50 m, so v' = 50/300 m/s."""
    way = journey(run({**step(5.0), **stops((0.05, 5.0))}))
    assert way.v[:3] == pytest.approx([0.0, 50.0 / 300.0, 0.0])
    assert way.x[:3] == pytest.approx([0.0, 25.0, 50.0])


@pytest.mark.parametrize(
    ("dwell_min", "steps"),
    [
        (0.0, 0),  # it goes on at once
        (0.1, 1),
        (0.3, 1),
        (0.9, 3),  # 0.9/0.3 is 3.0000000000000004 in binary: not a fourth one
        (1.0, 4),
    ],
)
def test_a_dwell_lasts_whole_steps(dwell_min, steps):
    result = run({**LIGHT, **step(0.3), **stops((10.0, dwell_min))})
    way = journey(result)
    at_stop = way.x == 10_000.0
    assert (way.state[at_stop] == 4).sum() == steps
    assert at_stop.sum() == steps + 1  # the instant of the departure is one more
    expected = ["motoring", "braking", *(["dwelling"] if steps else []), "motoring"]
    assert phases(result)[: len(expected)] == expected


def test_a_dwelling_train_draws_its_auxiliaries_alone():
    """151.5 kW at a power factor of 0.8: 151.5 · 0.6/0.8 = 113.6 kvar."""
    result = run({**LIGHT, **step(0.3), **stops((10.0, 2.0))})
    train = result.dataset.sel(train="eastbound 1")
    dwelling = (train.train_state == 4).to_numpy()
    assert set(train.active_power.to_numpy()[dwelling]) == {151_500.0}
    assert train.reactive_power.to_numpy()[dwelling] == pytest.approx(113_625.0)
    assert (train.tractive_force.to_numpy()[dwelling] == 0.0).all()
    assert (train.braking_force.to_numpy()[dwelling] == 0.0).all()


def test_a_train_that_limits_have_all_but_stopped_does_not_creep_to_its_stop():
    """10 m/s, 120.01 m before a lower limit, steps of 24 s: to end the step before it, the train has
    to slow down to 2 · 120.01/24 - 10 = 0.00083 m/s.  Its stop lies 10 m behind the limit; to hold
    that speed would take three hours and a half.  It takes the largest acceleration that leaves a
    plan, to 10/24 - 0.00083/2 = 0.41625 m/s, and stops after one step more."""
    changes = {
        **LIGHT,
        **step(0.4),
        "simulation.duration_min": 4.0,
        **stops((10.0, 1.0)),
        **limits((0, 36), (9.99, 5)),
        "traffic.0.initial_trains": [{"position_km": 9.99 - 0.120_01, "speed_kmh": 36.0}],
    }
    result = run(changes)
    train = "eastbound initial 1"
    assert phases(result, train)[:3] == ["braking", "motoring", "dwelling"]
    way = journey(result, train)
    assert way.v[1:4] == pytest.approx([2 * 120.01 / 24 - 10, 0.41625, 0.0])
    assert way.x[1:4] == pytest.approx([9_990.0, 9_995.005, 10_000.0])


@pytest.mark.parametrize(
    ("step_min", "speed_kmh"),
    [(0.01, 0.0), (0.01, 1e-9), (0.01, 20.0), (0.3, 0.0), (0.3, 1e-9), (0.3, 0.001), (0.3, 1.0),
     (5.0, 0.0), (5.0, 1e-9), (5.0, 0.001), (5.0, 0.4)],
)  # fmt: skip
def test_a_train_placed_slowly_before_its_stop_reaches_it_soon(step_min, speed_kmh):
    """20 m within ten minutes and three steps; at 0.001 km/h they would take twenty hours."""
    changes = {
        **step(step_min),
        "simulation.duration_min": 10.0 + 3 * step_min,
        **stops((10.0, 30.0)),
        "traffic.0.initial_trains": [{"position_km": 9.98, "speed_kmh": speed_kmh}],
    }
    way = journey(run(changes), "eastbound initial 1")
    assert 4 in way.state.tolist()


def test_a_plan_that_asks_for_less_than_the_resistances_give_is_driven_by_the_motor():
    """Up 6 per mille at 30 km/h, steps of a minute: R + m g s = 22 + 86.5 kN brake 1470 t by
    0.074 m/s², more than the few hundredths that spread 8.3 m/s over whole minutes."""
    changes = {
        **step(1.0),
        **stops((10.0, 1.0)),
        **limits((0, 30)),
        "line.gradients.0.permille": 6.0,
    }
    result = run(changes)
    way = journey(result)
    arrival = int(np.flatnonzero(way.x == 10_000.0)[0])
    slowing = np.flatnonzero((way.a < 0.0) & (way.x < 10_000.0))
    driven = [k for k in slowing if way.state[k] == 1]
    assert driven, "no step of the plan is driven by the motor"
    assert (way.braking[driven] == 0.0).all()
    assert slowing[-1] + 1 == arrival


def test_a_plan_that_the_machine_cannot_follow_is_made_anew():
    """300 t, accelerating near its stop, plan to hold 10.5 m/s for two steps of 6 s, then to brake.
    In the second step a ramp of 70 per mille asks for 15.4 + 206 kN, more than the motors give: the
    train loses speed against its plan, accelerates again behind the ramp, and stops exactly."""
    changes = {
        **step(0.1),
        **stops((10.0, 1.0)),
        **gradients((0, -2.0), (9.72, 70.0), (9.78, -2.0)),
        "simulation.duration_min": 3.0,
        "trains.freight.mass_t": 300.0,
        "trains.freight.max_retardation_m_s2": 0.3,
        "traffic.0.initial_trains": [{"position_km": 9.6, "speed_kmh": 27.0}],
    }
    train = "eastbound initial 1"
    result = run(changes)
    way, force = journey(result, train), result.dataset.tractive_force.sel(train=train)
    assert phases(result, train)[:3] == ["motoring", "braking", "dwelling"]
    assert way.v[2] == way.v[1] > 10.0  # held
    assert way.v[3] < way.v[2]  # on the ramp, with all the force there is
    assert way.state[2] == 1
    assert float(force[2]) > 0.9 * float(force.max())
    assert 10_000.0 in way.x


def test_a_destination_at_the_end_of_the_line_is_reached_exactly():
    way = journey(run({**LIGHT, **step(0.05)}))
    assert way.x[-1] == 20_000.0
    assert way.v[-1] == 0.0
    assert way.state[-1] == 5
