"""What campaigns of random scenarios have found, cut down to a small case that shows it."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss

from properties.journeys import Journey
from properties.judge import farthest_off, judge_result
from properties.kilometres import moved
from properties.roots import Replay, follow_paths
from scenarios import SHORT_LINE, short_line


def standing(*kms: float) -> dict[str, Any]:
    """Trains at rest, from the start."""
    return {"traffic.0.initial_trains": [{"position_km": km, "speed_kmh": 0.0} for km in kms]}


@pytest.mark.parametrize("seed", range(5))
def test_trains_a_metre_apart_on_a_line_of_ten_microohms_a_metre_pass_the_audit(seed):
    """Voltages are rounded by 2⁻⁵² of them: through 10 µΩ that is 0.006 VA, and a train between two
    such pieces is judged by four voltages."""
    rng = np.random.default_rng(seed)
    places = np.full(rng.integers(5, 20), rng.uniform(5.0, 9.0))
    changes = {
        "supply.catenary": {"r_ohm_per_km": 0.01, "x_ohm_per_km": 0.0},
        "simulation.time_step_min": 0.01,
        "simulation.duration_min": 1.0,
        "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 5.0}],
    }
    judge_result(tpss.simulate(short_line({**changes, **standing(*places)})))


def filtering_trains(share: float) -> tpss.Scenario:
    """Eight idle trains with large filters, 130 km from the only converter, at a share of their load."""
    converters = [{"name": "C", "position_km": 130.34, "type": "Q48/Q49", "converters": 1}]
    return short_line(
        {
            "simulation.time_step_min": 0.01,
            "simulation.duration_min": 0.01,
            "line.length_km": 266.0,
            "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 5.0}],
            "supply.converter_stations": converters,
            "simulation.power_sampling": "start",
            "trains.freight.filter_reactance_ohm": -0.44 / share,
            "trains.freight.auxiliary_power_kw": 151.5 * share,
            **standing(*[0.0] * 7),
        }
    )


def test_too_high_a_voltage_at_a_part_of_the_load_does_not_forbid_the_whole():
    """On the path from zero load the voltage rises to 1.21 of its base, and falls again to 1.1996.

    The other load flow follows it there without a turn: the root is no false one.
    """
    result = tpss.simulate(filtering_trains(1.0))
    judge_result(result)
    highest_v = float(result.dataset.pantograph_voltage[0].max())
    assert highest_v == pytest.approx(19_792.7, abs=0.1)
    part = tpss.simulate(filtering_trains(0.85))
    assert part.status == "collapsed"
    judge_result(part)
    assert " at 0.00 km has 19.80 kV, the highest." in part.summary["problem"]
    assert "filter_reactance_ohm" in part.summary["advice"]


def test_a_train_just_above_the_voltage_without_traction_gives_the_force_that_its_power_belongs_to():
    """At 11 000.05 V the limited current leaves a little force, which a rounding of 1e-7 V
    changes by 2e-6 of itself: force and power have to belong to one voltage."""
    changes = {
        "simulation.time_step_min": 5.0,
        "simulation.duration_min": None,
        "simulation.until": "first-departure-arrives",
        "line.length_km": 212.87128712871288,
        "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 9.4}],
        "line.stations": [
            {"name": "S0", "position_km": 70.247524752},
            {"name": "S1", "position_km": 168.168316832},
        ],
        "supply.converter_stations": [
            {"name": "C", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}
        ],
        "trains.freight": {
            "model": "Rc4-freight-1470t", "auxiliary_power_kw": 1000.0, "mass_t": 80.0,
            "filter_reactance_ohm": -5.0, "base_speed_kmh": 20.0, "max_motor_current_a": 150.0,
            "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0, "slip": 0.0,
            "current_limitation": {"max_current_a": 900.0},
        },
        "traffic": [{"name": "eastbound", "train": "freight", "from": "S0", "to": "S1",
                     "headway_min": 2737.5057931325046, "already_running": True}],
    }  # fmt: skip
    result = tpss.simulate(short_line(changes))
    assert float(result.dataset.pantograph_voltage.min()) == pytest.approx(11_000.05, abs=0.01)
    assert result.audit["traction_balance"] < 1e-13


def hardest_braking_m_s2(begin_km: float) -> float:
    """Highest retardation of a train that brakes to a stop within steps of 0.06 s, once it is judged."""
    document = copy.deepcopy(SHORT_LINE)
    document["simulation"] = {
        "time_step_min": 0.001, "duration_min": 3.0, "motion": "stepped", "braking": "within-step",
    }  # fmt: skip
    document["line"]["stations"][1]["position_km"] = 1.0
    document["traffic"][0]["stops"] = [{"station": "Middle", "dwell_min": 0.5}]
    result = tpss.simulate(tpss.Scenario.from_document(moved(document, begin_km), "far"))
    judge_result(result)
    way = Journey(result, "eastbound 1")
    return float(-way.a[way.braking > 0.0].min())


def test_far_from_kilometre_0_the_rounding_of_a_place_is_braked_for():
    """A step of 0.06 s that ends at the stop begins 0.85 m/s² (0.06 s)²/2 = 1.53 mm before it, the
    steps before it 2², 3², ... times as far.  At 1400 km positions are rounded by up to 1.16e-10 m:
    7.6e-8 of that distance, and with all steps before, 1 + 1/4 + 1/9 + ... = 1.64 times as much."""
    assert hardest_braking_m_s2(0.0) == pytest.approx(0.85, rel=1e-10)
    far = hardest_braking_m_s2(1400.0) / 0.85 - 1.0
    assert 1e-8 < far < 1.64 * 7.6e-8


def starting_trains(full_voltage_kv: float) -> tpss.Scenario:
    """Three trains that start at one place, in a step of a minute, with a force that falls from a
    voltage on to nothing 100 V below."""
    return short_line(
        {
            "simulation": {"time_step_min": 1.0, "duration_min": 1.0},
            "line.length_km": 60.0,
            "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
            "line.stations": [
                {"name": "West", "position_km": 0.0},
                {"name": "East", "position_km": 60.0},
            ],
            "supply.catenary": {"r_ohm_per_km": 0.2, "x_ohm_per_km": 0.2},
            "supply.converter_stations": [
                {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 4}
            ],
            "trains.freight": {
                "tractive_effort": {
                    "max_force_kn": 150.0, "max_power_kw": 3000.0,
                    "full_voltage_kv": full_voltage_kv, "zero_voltage_kv": full_voltage_kv - 0.1,
                },
                "mass_t": 400.0, "adhesive_mass_t": 80.0, "resistance_a_n": 4000.0,
                "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 5.0,
                "max_speed_kmh": 120.0, "max_retardation_m_s2": 0.5, "efficiency": 0.85,
                "auxiliary_power_kw": 50.0, "auxiliary_power_factor": 1.0, "power_factor": 0.9,
            },
            "traffic.0.first_departure_min": 9000.0,
            "traffic.0.initial_trains": [{"position_km": 15.0, "speed_kmh": 0.0}] * 3,
        }
    )  # fmt: skip


def test_a_solution_within_millivolts_of_a_knee_is_found():
    """With all their force the trains have 14 770.36 V.  Where it falls from 1 to 3 V above that on,
    they have the voltage of that knee but for a tenth of a volt, the less the higher it is: a volt less
    takes 1 % of the force.  Slopes over 1e-5 of the voltage, 0.15 V, belong to neither side there."""
    knees_kv = [14.7714, 14.7724, 14.7734]
    above_v = []
    for knee_kv in knees_kv:
        result = tpss.simulate(starting_trains(knee_kv))
        judge_result(result)
        assert result.status == "finished"
        highest_v = float(result.dataset.pantograph_voltage[0].max())
        above_v.append(highest_v - 1e3 * knee_kv)
    assert np.abs(above_v).max() < 0.1
    assert (np.diff(above_v) < 0.0).all()


def test_a_collapse_within_a_step_that_ends_with_an_arrival_is_judged_in_that_time():
    """Eight trains start for a stop 10 m ahead, 87 km from the only converter: over some seconds they
    ask for more than the line carries, over a step of five minutes for a twentieth of that or less."""
    result = tpss.simulate(
        short_line(
            {
                "simulation": {"time_step_min": 5.0},
                "line.length_km": 100.0,
                "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 6.9}],
                "line.stations": [
                    {"name": "West", "position_km": 89.74},
                    {"name": "East", "position_km": 89.75},
                ],
                "supply.converter_stations": [
                    {"name": "C", "position_km": 2.4, "type": "Q48/Q49", "converters": 1}
                ],
                "traffic.0.headway_min": 2100.0,
                "traffic.0.initial_trains": [{"position_km": 89.74, "speed_kmh": 0.0}] * 7,
            }
        )
    )
    assert result.status == "collapsed"
    judge_result(result)
    replay = Replay(result.scenario, 1)
    short_s = replay.tried_s(0)
    assert 5.0 < short_s < 30.0
    assert replay.root_of_step(0, short_s)[0] < 1.0
    assert replay.root_of_step(0, 300.0)[0] == 1.0


OUT_OF_PHASE = {
    "format": 1, "name": "out-of-phase",
    "line": {
        "length_km": 0.2, "gradients": [{"from_km": 0.0, "permille": 0.0}],
        "speed_limits": [{"from_km": 0.0, "speed_kmh": 60.0}],
        "stations": [{"name": "S0", "position_km": 0.1}, {"name": "S1", "position_km": 0.01}],
    },
    "supply": {
        "catenary": "BT",
        "converter_stations": [
            {
                "name": "C0", "position_km": 0.03, "grid_angle_deg": -58.8, "converters": 3,
                "grid_reactance_ohm": 1.3,
                "type": {
                    "no_load_voltage_kv": 16.9, "rating_mva": 80.0, "motor_reactance_pu": 0.3,
                    "generator_reactance_pu": 10.0, "motor_base_mva": 10.0, "generator_base_mva": 10.0,
                    "base_voltage_kv": 16.5, "droop_kv_per_mvar": 0.08,
                },
            },
            {
                "name": "C1", "position_km": 0.0312, "type": "Q48/Q49", "converters": 1,
                "grid_reactive_power_mvar": 0.8, "grid_angle_deg": 5.0, "grid_reactance_ohm": 0.16,
            },
        ],
    },
    "trains": {"freight": {"model": "Rc4-freight-1470t"}},
    "traffic": [{"name": "a", "train": "freight", "from": "S1", "to": "S0", "headway_min": 2.0}],
}  # fmt: skip


def test_stations_out_of_phase_count_as_the_path_from_alike_stations_says():
    """Two stations a metre apart, 64° apart at their grids, feed each other in two ways that are both
    sound, and 9 % apart.  Loads raised from base voltage find the one, the path from stations made
    alike the other, which counts."""
    result = tpss.simulate(tpss.Scenario.from_document(copy.deepcopy(OUT_OF_PHASE), "out-of-phase"))
    judge_result(result)
    drawn = result.dataset.pantograph_voltage.to_numpy()[0]
    replay = Replay(result.scenario, result.dataset.sizes["time"])
    length_s = result.dataset.attrs["time_step_s"]
    assert farthest_off(drawn, replay.root_of_step(0, length_s)[1]) > 0.05
    assert farthest_off(drawn, replay.root_of_step(0, length_s, follow_paths)[1]) < 1e-6
