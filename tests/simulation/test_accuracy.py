"""Order of accuracy of the coupled step, and what its options change."""

import pytest

import tpss

from conftest import EXAMPLES
from scenarios import run


def energy(step_min, **more):
    changes = {"simulation.time_step_min": step_min, "simulation.duration_min": 12.0, **more}
    return run(changes).summary["total_energy_mwh"]


def test_halving_the_step_at_least_halves_the_error_of_the_energy():
    finest = energy(0.01)
    errors = [abs(energy(step) - finest) for step in (0.8, 0.4, 0.2)]
    assert errors[0] < 0.02 * finest
    assert errors[1] <= 0.55 * errors[0]
    assert errors[2] <= 0.55 * errors[1]


def test_billing_the_mean_speed_is_more_accurate_than_that_at_the_start():
    finest = energy(0.01)
    start = energy(0.8, **{"simulation.power_sampling": "start"})
    assert abs(start - finest) > 3 * abs(energy(0.8) - finest)


MAIN_LINE = tpss.load_scenario(EXAMPLES / "thesis_160km.toml", {"simulation.until": None})
WITHIN = {"simulation.braking": "within-step"}


def energy_over_90_minutes(step_min, changes):
    changes = {"simulation.duration_min": 90.0, "simulation.time_step_min": step_min, **changes}
    return tpss.simulate(MAIN_LINE.with_(changes)).summary["total_energy_mwh"]


@pytest.fixture(scope="module")
def finest():
    return energy_over_90_minutes(0.05, {})


@pytest.mark.parametrize("step_min", [0.1, 0.2, 0.5, 1.0, 2.0])
def test_braking_within_steps_keeps_the_energy_within_3_per_mille_at_any_step(step_min, finest):
    """Of the main line, nine trains of which brake to their destination: in whole steps of a minute that
    alone is -6.5 per mille, as they begin up to 30 s too early."""
    assert energy_over_90_minutes(step_min, WITHIN) == pytest.approx(finest, rel=3e-3)


def test_with_short_steps_it_hardly_matters_how_trains_brake(finest):
    """At 3 s: a train begins to brake 1.5 s later on average, of 33 s."""
    assert energy_over_90_minutes(0.05, WITHIN) == pytest.approx(finest, rel=5e-4)


def test_a_climb_costs_its_potential_energy():
    """5 per mille over the way: m g Δh at the wheels, /0.8 at the pantograph."""
    level, hill = (
        run({"line.gradients": [{"from_km": 0.0, "permille": g}], "simulation.duration_min": 15.0})
        for g in (0.0, 5.0)
    )
    climb_m = 0.005 * hill.trips.distance_km[0] * 1e3
    extra = hill.trips.energy_mwh[0] - level.trips.energy_mwh[0] * (
        hill.trips.distance_km[0] / level.trips.distance_km[0]
    )
    assert extra == pytest.approx(1_470_000 * 9.81 * climb_m / 0.8 / 3.6e9, rel=0.06)


@pytest.mark.parametrize("option", [
    {"simulation.adhesion_speed_unit": "km/h"},
    {"simulation.gradient_sampling": "start"},
    {"trains.freight.reactive_power": "double-bridge"},
    {"trains.freight.slip": 0.02},
    {"trains.freight.rotating_mass_factor": 0.05},
    {"trains.freight.motor_voltage": "former", "trains.freight.reactive_power": "double-bridge"},
    {"trains.freight.filter_reactance_ohm": -0.45},
    {"supply.catenary": "AT"},
    {"supply.high_voltage_line": {"type": "132kV", "transformers_km": [10.0]}},
    {"supply.catenary": "AT", "supply.high_voltage_line": {"type": "132kV", "transformers": 1}},
])  # fmt: skip
def test_every_option_changes_the_run_and_passes_the_audit(option):
    plain, changed = (run({**{"simulation.duration_min": 8.0, "line.gradients": GRADIENTS}, **more})
                      for more in ({}, option))  # fmt: skip
    a, b = (r.dataset.station_reactive_power.sum() for r in (plain, changed))
    c, d = (r.dataset.speed.sum() for r in (plain, changed))
    assert float(a) != float(b) or float(c) != float(d)


GRADIENTS = [{"from_km": 0.0, "permille": 0.0}, {"from_km": 0.33, "permille": 4.0}]


def test_the_former_motor_current_is_that_of_all_four_motors():
    new, former = (
        run({"simulation.duration_min": 3.0, "trains.freight.motor_current": model})
        for model in ("new", "former")
    )
    ratio = former.dataset.motor_current / new.dataset.motor_current
    assert ratio.dropna("time", how="all").to_numpy() == pytest.approx(4.0)
