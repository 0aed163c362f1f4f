"""Running-time supplements: the speed that is held between two stops for the time that is wanted.

The train of the closed form gains and loses 1 m/s each second: a way L at a speed v takes L/v + v
seconds from stop to stop, and a time T needs v = (T - √(T² - 4 L)) / 2.
"""

import math

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from tpss.driving.data import Profile
from tpss.model.build import build_model
from tpss.model.held_limits import Held, capped
from tpss.model.supplements import NO_TIME, Stretch, Wanted, held_speed, with_supplements
from tpss.model.traffic import build_services

from scenarios import short_line

CLOSED_FORM = {
    "simulation.motion": "continuous", "simulation.braking": "within-step",
    "simulation.time_step_min": 0.1,
    "trains.freight": {
        "mass_t": 100.0, "adhesive_mass_t": 100.0, "resistance_a_n": 0.0,
        "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0, "max_speed_kmh": 72.0,
        "max_retardation_m_s2": 1.0, "auxiliary_power_kw": 0.0, "power_factor": 1.0,
        "efficiency": 1.0, "tractive_effort": {"max_force_kn": 100.0, "max_power_kw": 1e5},
    },
    "line.speed_limits.0.speed_kmh": 72.0,
}  # fmt: skip

HALF_WAY = {"traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}]}


def speed_for(time_s: float, way_m: float = 10_000.0) -> float:
    return (time_s - math.sqrt(time_s**2 - 4.0 * way_m)) / 2.0


def simulated(**changes) -> tpss.Result:
    paths = {f"traffic.0.{key}": value for key, value in changes.items()}
    return tpss.simulate(short_line({**CLOSED_FORM, **HALF_WAY, **paths}))


@pytest.mark.parametrize(
    ("supplement", "time_s"),
    [({"supplement_percent": 10.0}, 572.0), ({"supplement_min_per_100km": 3.0}, 538.0),
     ({"supplement_percent": 5.0, "supplement_min_per_100km": 1.0}, 552.0)],
)  # fmt: skip
def test_each_hop_takes_its_supplement_at_the_speed_of_the_closed_form(supplement, time_s):
    """520 s at 20 m/s: 572 s with 10 %, 538 s with 3 min for 100 km, 18 s for 10 km,
    and 552 s with 5 % and 6 s."""
    result = simulated(**supplement)
    table = result.stops
    hops_s = [
        60.0 * table.arrival_min[1],
        60.0 * (table.arrival_min[2] - table.departure_min[1]),
    ]
    assert hops_s == pytest.approx([time_s] * 2, rel=1e-4)
    assert float(result.dataset.speed.max()) == pytest.approx(speed_for(time_s), rel=5e-4)
    assert result.audit["passed"]


def test_trains_in_steps_and_down_the_line_take_theirs_too():
    """In whole steps of 3 s the time is met within one."""
    stepped = {"simulation.motion": "stepped", "simulation.time_step_min": 0.05}
    down = {"traffic.0.from": "East", "traffic.0.to": "West", "traffic.0.supplement_percent": 10.0}
    for changes, slack_s in (({}, 0.06), (stepped, 6.0)):
        result = tpss.simulate(short_line({**CLOSED_FORM, **HALF_WAY, **down, **changes}))
        assert 60.0 * result.stops.arrival_min[1] == pytest.approx(572.0, abs=slack_s)


def test_trains_that_run_already_hold_it_from_the_start():
    """At a headway of 5 min one stands where a lone train with supplement is then."""
    given = {"headway_min": 5.0, "supplement_percent": 10.0}
    running = simulated(already_running=True, **given).dataset
    lone = simulated(**given).dataset
    first = running.sel(train="eastbound initial 1", time=0.0)
    assert float(first.position) == pytest.approx(
        float(lone.position.sel(train="eastbound 1", time=300.0)), abs=1e-6
    )


def test_trains_of_the_same_stops_and_supplement_share_a_row_and_others_keep_theirs():
    single = {"name": "a", "train": "freight", "from": "West", "to": "East", "departure_min": 1.0}
    with_supplement = {**single, "supplement_percent": 5.0}
    scenario = short_line(
        {
            **CLOSED_FORM,
            "traffic": [
                single,
                {**with_supplement, "name": "b"},
                {**with_supplement, "name": "c"},
                {**with_supplement, "name": "d", "to": "Middle"},
            ],
        }
    )
    model, _ = build_model(scenario)
    more, services = with_supplements(scenario, model, build_services(scenario, model))
    assert [service.train_type for service in services] == [0, 1, 1, 2]
    assert more.types["profile"].tolist() == [0, 1, 2]
    assert more.limits.value[0].max() == 20.0
    assert more.types[1].highest_speed_m_s == model.types[0].highest_speed_m_s


def test_without_a_supplement_the_model_is_as_it_was():
    scenario = short_line(CLOSED_FORM)
    model, _ = build_model(scenario)
    services = build_services(scenario, model)
    assert with_supplements(scenario, model, services) == (model, services)
    assert (
        held_speed(model, Stretch(0, 0.0, 1e4, Wanted(0.0, 0.0, NO_TIME, "held-speed")), 0)
        == math.inf
    )


def test_a_train_that_comes_to_no_end_has_no_speed_to_hold():
    """On 100 per mille its 100 kN, as much as its weight down the slope, do not start it."""
    steep = {
        "line.gradients": [{"from_km": 0.0, "permille": 100.0}],
        "trains.freight.mass_t": 150.0,
    }
    model, _ = build_model(short_line({**CLOSED_FORM, **steep}))
    assert (
        held_speed(model, Stretch(0, 0.0, 1e4, Wanted(0.1, 0.0, NO_TIME, "held-speed")), 0)
        == math.inf
    )


def test_limits_are_capped_between_two_stops():
    """Of 30 and 10 m/s from 0 and 400 m; 20 m/s are held from 100 to 300 m, 15 from there to 500 m."""
    limits = Profile(np.array([0.0, 400.0, np.inf]), np.array([30.0, 10.0, 10.0]))
    held = [Held(100.0, 300.0, 20.0, 300.0), Held(300.0, 500.0, 15.0, 500.0)]
    lower = capped(limits, held)
    assert lower.from_m.tolist() == [0.0, 100.0, 300.0, 400.0]
    assert lower.value.tolist() == [30.0, 20.0, 15.0, 10.0]


def test_trains_placed_on_the_line_and_a_supplement_exclude_each_other():
    changes = {
        "traffic.0.already_running": None,
        "traffic.0.initial_trains": [{"position_km": 1.0, "speed_kmh": 50.0}],
        "traffic.0.supplement_percent": 5.0,
    }
    assert "leave initial_trains out" in finding_at("traffic.0", faults_of(changes)).remedy
    assert finding_at(
        "traffic.0.supplement_percent", faults_of({"traffic.0.supplement_percent": -1.0})
    )
