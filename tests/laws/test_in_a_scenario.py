"""Scenarios name laws, whose numbers the run then has; others stay what they are."""

import numpy as np
import pytest

import tpss
from laws.own_laws import CALM, DROOPS, TUNNEL
from tpss.laws import register

from scenarios import short_line

CONTINUOUS = {"simulation.motion": "continuous", "simulation.braking": "within-step"}


@pytest.fixture(autouse=True)
def _registered():
    for law in (TUNNEL, CALM, DROOPS):
        register(law)


def simulated(changes=None, motion=CONTINUOUS):
    result = tpss.simulate(short_line({**motion, **(changes or {})}))
    assert result.status == "finished"
    assert result.audit["passed"]
    return result


def of_first_train(result, name):
    return result.dataset[name].isel(train=0).to_numpy()


@pytest.mark.parametrize("motion", [CONTINUOUS, {}], ids=["continuous", "stepped"])
def test_a_resistance_that_is_the_own_one_changes_no_bit(motion):
    own = {"trains.freight.resistance_law": {"law": "tunnel"}}
    before, after = simulated(motion=motion), simulated(own, motion)
    for name in ("speed", "position", "active_power", "pantograph_voltage"):
        assert np.array_equal(
            of_first_train(before, name), of_first_train(after, name), equal_nan=True
        )


@pytest.mark.parametrize("motion", [CONTINUOUS, {}], ids=["continuous", "stepped"])
def test_a_resistance_is_that_of_the_law_while_a_speed_is_held(motion):
    """At 60 km/h on level track motors give what resists: A + B v + 3 C v²."""
    law = {"law": "tunnel", "parameters": {"factor": 3.0}}
    result = simulated({"trains.freight.resistance_law": law}, motion)
    train = result.scenario.trains["freight"]
    v = 60.0 / 3.6
    expected = (
        train.resistance_a_n
        + train.resistance_b_n_s_per_m * v
        + 3.0 * train.resistance_c_n_s2_per_m2 * v**2
    )
    held = np.isclose(of_first_train(result, "speed")[:-1], v, rtol=1e-12)
    held &= np.isclose(of_first_train(result, "speed")[1:], v, rtol=1e-12)
    force = of_first_train(result, "tractive_force")[: held.size][held]
    assert held.sum() > 50
    assert force == pytest.approx(np.full(force.size, expected), rel=1e-9)


def test_a_driver_coasts_down_to_the_speed_that_he_wants():
    """From 4 km before the stop on 75 % of 60 km/h, to which resistances alone slow him down.

    He holds a speed once it is within a millionth of the one that he wants.
    """
    law = {"law": "calm", "parameters": {"share": 0.75}}
    plain = simulated()
    calm = simulated({"trains.freight.driver": law})
    position, speed = of_first_train(calm, "position"), of_first_train(calm, "speed")
    to_stop = 20e3 - position
    braking = of_first_train(calm, "braking_force")
    before_braking = (to_stop < 4e3) & (to_stop > 500.0)
    assert np.all(braking[before_braking[: braking.size].nonzero()] == 0.0)
    assert np.nanmin(speed[before_braking]) == pytest.approx(45.0 / 3.6, rel=1e-6)
    assert np.nanmax(speed[to_stop > 4e3]) == pytest.approx(60.0 / 3.6, rel=1e-9)
    assert calm.figures["total_energy_mwh"] < plain.figures["total_energy_mwh"]


def test_a_driver_who_wants_too_little_is_taken_at_one_km_h_and_that_is_counted():
    law = {"law": "calm", "parameters": {"share": 0.0, "from_m": 50.0}}
    result = simulated({"trains.freight.driver": law, "simulation.duration_min": 60.0})
    assert result.figures["limited"]["least_wish"] > 0
    assert simulated().figures["limited"]["least_wish"] == 0


def test_a_station_has_the_voltage_of_its_law():
    """One converter at West: U = 16.5 kV - 50 µV/var Q, angle 10° - 30 nrad/W P."""
    result = simulated(
        {
            "supply.converter_stations.0.law": {"law": "droops"},
            "supply.converter_stations.0.converters": 1,
            "supply.converter_stations.0.grid_angle_deg": 10.0,
        }
    )
    west = result.dataset.sel(station="West").isel(time=slice(1, 40))
    p, q = west.station_active_power.to_numpy(), west.station_reactive_power.to_numpy()
    node = result.dataset.isel(node=0, time=slice(1, 40))
    assert np.ptp(p) > 1e5
    assert node.node_voltage.to_numpy() == pytest.approx(16_500.0 - 50e-6 * q, rel=1e-9)
    assert node.node_angle.to_numpy() == pytest.approx(np.deg2rad(10.0) - 3e-8 * p, abs=1e-9)


def test_the_result_says_whose_laws_it_used():
    result = simulated({"trains.freight.driver": {"law": "calm", "parameters": {"share": 0.9}}})
    assert result.figures["provenance"]["laws"] == (
        f"driver law calm of this process, {CALM.digest}"
    )
    assert "laws" not in simulated().figures["provenance"]


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        (
            {"trains.freight.driver": {"law": "hasty"}},
            "there is no driver law 'hasty'",
        ),
        (
            {"trains.freight.driver": {"law": "calm"}},
            "the law 'calm' has no value of 'share'",
        ),
        (
            {"trains.freight.resistance_law": {"law": "tunnel", "parameters": {"factor": 9.0}}},
            "'factor' of the law 'tunnel' is 9",
        ),
        (
            {
                "trains.freight.driver": {"law": "calm", "parameters": {"share": 0.9}},
                "simulation.motion": "stepped",
            },
            'does not go with motion = "stepped"',
        ),
        (
            {
                "trains.freight.driver": {"law": "calm", "parameters": {"share": 0.9}},
                "traffic.0.supplement_percent": 5.0,
            },
            "the driver of freight follows a law of his own, not this",
        ),
        (
            {
                "supply.converter_stations.0.law": {
                    "law": "droops",
                    "parameters": {"fall_v_per_var": 5.0},
                }
            },
            "finds voltage_v = ",
        ),
        (
            {
                "supply.converter_stations.0.law": {"law": "droops"},
                "supply.converter_stations.0.grid_reactance_ohm": 1.0,
            },
            "grid_reactance_ohm has no part in 'droops'",
        ),
        (
            {
                "supply.converter_stations.0.law": {"law": "droops"},
                "supply.converter_stations.0.feedback": "none",
            },
            "knows neither a limit of the current nor of what is fed back",
        ),
    ],
)
def test_what_a_law_cannot_do_is_a_fault_of_the_scenario(changes, problem):
    with pytest.raises(tpss.ScenarioError) as raised:
        short_line({**CONTINUOUS, **changes})
    assert problem in str(raised.value)


def test_a_scenario_keeps_the_law_that_it_was_read_with():
    """Another law registered under the same name later is that of scenarios read later."""
    from tpss.laws import Law

    law = {"law": "tunnel", "parameters": {"factor": 2.0}}
    before = short_line({**CONTINUOUS, "trains.freight.resistance_law": law})

    def none(speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2, factor):
        return 1.0 * factor

    register(Law(TUNNEL.kind, "tunnel", none, "", "", TUNNEL.parameters))
    after = short_line({**CONTINUOUS, "trains.freight.resistance_law": law})
    energy = [tpss.simulate(each).figures["total_energy_mwh"] for each in (before, after)]
    own = [each.trains["freight"].resistance_law for each in (before, after)]
    assert own[0] != own[1]
    assert energy[0] > energy[1]
