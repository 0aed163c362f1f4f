"""Gradients: descents held by the brakes, climbs that slow a train down, stalls and restarts."""

import numpy as np
import pytest

import tpss

from scenarios import gradients, journey, limits, phases, run, short_line, stops

WEIGHT_N = 1_470e3 * 9.81


def step(minutes: float) -> dict[str, float]:
    return {"simulation.time_step_min": minutes}


@pytest.mark.parametrize("step_min", [0.01, 0.3, 2.0])
def test_a_descent_is_held_by_the_brakes(step_min):
    """-10 per mille at 60 km/h: m g 0.01 - R = 144.2 - 33.7 kN; motors off, auxiliaries only."""
    result = run({**step(step_min), **gradients((0, -10.0))})
    assert phases(result)[-3:] == ["motoring", "braking", "arrived"]
    way = journey(result)
    k = int(np.searchsorted(way.x, 15_000.0))
    v = 60 / 3.6
    resistance = 15_400 + 279 * v + 49.2 * v * v
    assert way.v[k] == v
    assert way.braking[k] == pytest.approx(0.01 * WEIGHT_N - resistance)
    assert float(result.dataset.active_power[k, 0]) == 151.5e3


def test_on_a_gentle_descent_less_motor_force_holds_the_speed():
    """-2 per mille: R - m g 0.002 = 33.7 - 28.8 kN."""
    result = run({**step(0.1), **gradients((0, -2.0))})
    k = int(np.searchsorted(journey(result).x, 15_000.0))
    force = float(result.dataset.tractive_force[k, 0])
    assert force == pytest.approx(33_717 - 0.002 * WEIGHT_N, abs=1.0)


def test_a_climb_slows_a_train_down_and_a_crest_lets_it_accelerate():
    """Up 11 per mille a heavy train cannot hold 80 km/h; behind the crest it reaches them again."""
    result = run(
        {**step(0.05), **limits((0, 80)), **gradients((0, 0.0), (10.0, 11.0), (14.0, -1.0))}
    )
    way = journey(result)
    assert phases(result) == ["motoring", "braking", "arrived"]
    climbing = (way.x > 10_200.0) & (way.x < 13_900.0)
    assert (way.a[climbing] < 0.0).all()
    assert way.v[climbing].min() < 0.9 * 80 / 3.6
    assert way.v[way.x > 14_000.0].max() == pytest.approx(80 / 3.6)


@pytest.mark.parametrize("step_min", [0.01, 0.3, 1.0, 5.0])
def test_a_train_stalls_on_a_climb_too_steep_for_it(step_min):
    """Up 16 per mille: 15.4 + 230.7 kN at a stand, against 175 kN.  With 5 km of run-up it comes some
    way, slows down, and would roll back; the run ends there with all it has."""
    result = tpss.simulate(short_line({**step(step_min), **gradients((0, 0.0), (5.0, 16.0))}))
    assert result.audit["passed"]
    assert result.status == "stalled"
    assert "slows down and would roll back" in result.summary["problem"]
    assert "kN" in result.summary["problem"]
    assert "mass" in result.summary["advice"]
    way = journey(result)
    way.judge()
    assert 5_000.0 < way.x[-1] < 8_000.0
    assert (way.a[:-1][way.x[:-1] > 5_000.0 + 60 / 3.6 * 60 * step_min] < 0.0).all()


def test_a_train_that_stopped_on_a_climb_cannot_start_again():
    """It comes to its stop up 12 per mille by momentum, dwells, and needs 15.4 + 173.0 kN to start."""
    hill = gradients((0, 0.0), (9.0, 12.0), (11.0, 0.0))
    result = tpss.simulate(short_line({**step(0.05), **stops((10.0, 2.0)), **hill}))
    assert result.status == "stalled"
    assert phases(result) == ["motoring", "braking", "dwelling"]
    assert "cannot start at 10.00 km" in result.summary["problem"]
    assert "188.4 kN" in result.summary["problem"]
    assert result.audit["passed"]


def test_a_heavy_train_starts_again_on_a_climb_at_low_voltage():
    """30 km from the only station, two trains ahead at 50 km/h draw the voltage down to 9.5 kV.  Up
    10.5 per mille the train needs 15.4 + 151.4 kN, and has 175.7 kN: (175.7 - 166.8)/1470 = 6 mm/s².
    The network of the effort, trained from 10.5 kV on, extrapolates, which is counted."""
    entries = [
        {"name": "restarting", "train": "freight", "from": "A", "to": "C", "departures_min": [50.0],
         "stops": [{"station": "B", "dwell_min": 0.3}],
         "initial_trains": [{"position_km": 29.98, "speed_kmh": 10.0}]},
        {"name": "ahead", "train": "freight", "from": "A", "to": "C", "departures_min": [50.0],
         "initial_trains": [{"position_km": km, "speed_kmh": 50.0} for km in (26.6, 27.6)]},
    ]  # fmt: skip
    places = [{"name": n, "position_km": km} for n, km in (("A", 0.0), ("B", 30.0), ("C", 35.0))]
    changes = {
        **step(0.1),
        **limits((0, 50)),
        **gradients((0, 10.5)),
        "line.length_km": 35.0,
        "line.stations": places,
        "supply.converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}
        ],
        "traffic": entries,
        "simulation.duration_min": 5.0,
    }
    result = run(changes)
    train = "restarting initial 1"
    assert phases(result, train) == ["braking", "dwelling", "motoring"]
    way = journey(result, train)
    restart = int(np.flatnonzero(way.state == 4)[-1]) + 1
    data = result.dataset.sel(train=train)
    assert 9_000.0 < float(data.pantograph_voltage[restart]) < 10_500.0
    force = float(data.tractive_force[restart])
    assert way.a[restart] == pytest.approx((force - 15_400 - 0.0105 * WEIGHT_N) / 1_470e3)
    assert 0.003 < way.a[restart] < 0.01
    assert result.summary["limited"]["effort_extrapolated"] > 0


def test_a_train_starts_downhill_no_faster_than_its_driver_wants():
    """-30 per mille pull 1470 t by 0.28 m/s²; to reach 10 km/h in a step of 1 min takes 0.046."""
    result = run({**step(1.0), **limits((0, 10)), **gradients((0, -30.0))})
    way = journey(result)
    assert way.a[0] == pytest.approx(10 / 3.6 / 60)
    assert way.braking[0] == pytest.approx(0.03 * WEIGHT_N - 15_400 - 1_470e3 * way.a[0])
    assert phases(result)[:2] == ["braking", "arrived"]


def test_brakes_hold_a_dwelling_train_on_any_gradient():
    """A standing train is held; no force, no power but the auxiliaries', no way."""
    for rise in (-40.0, 10.0):
        changes = {
            **step(0.2),
            **stops((10.0, 5.0)),
            **gradients((0, 0.0), (9.9, rise), (10.1, 0.0)),
        }
        result = run(changes)
        way = journey(result)
        dwelling = way.state == 4
        assert set(way.x[dwelling]) == {10_000.0}
        assert set(result.dataset.active_power[:, 0].to_numpy()[dwelling]) == {151.5e3}


def test_a_step_over_crest_and_dip_climbs_what_the_line_climbs():
    """5 min at 60 km/h are 5 km; within them the line rises and falls by 40 per mille.  The gradient
    force of the step is that of its mean, zero."""
    hills = gradients((0, 0.0), (10.0, 40.0), (11.0, -40.0), (12.0, 0.0))
    result = run({**step(5.0), **hills})
    way = journey(result)
    k = int(np.flatnonzero(way.x < 10_000.0)[-1])
    assert way.x[k] + 60 / 3.6 * 300.0 > 12_000.0
    assert float(result.dataset.gradient_force[k, 0]) == pytest.approx(0.0, abs=1e-6 * WEIGHT_N)


@pytest.mark.parametrize("permille", [3.0, -1.0])
def test_a_curve_opposes_a_train_uphill_and_downhill(permille):
    """R = 300 m: 650/245 per mille of the weight, here for 2 km."""
    curves = [{"from_km": 9.0, "to_km": 11.0, "radius_m": 300.0}]
    changes = {**step(0.1), **gradients((0, permille)), "line.curves": curves}
    result = run(changes)
    in_curve = abs(journey(result).x - 10_000.0) < 900.0
    force_n = result.dataset.gradient_force.to_numpy()[:, 0][: in_curve.size][in_curve]
    assert force_n == pytest.approx(WEIGHT_N * (permille + 650.0 / 245.0) * 1e-3, rel=1e-12)
