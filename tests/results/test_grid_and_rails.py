"""Unbalance, rails and stray current in the key figures of runs and of plans: those of the results."""

import math

import pytest

import tpss
from tpss.planning.outcome import outcome_of
from tpss.planning.plan import Evaluation, Requirements
from tpss.planning.requirements import failures
from tpss.planning.told import not_told
from tpss.results.grid_and_rails import FIGURES
from tpss.results.standards.unbalance import unbalance_of
from tpss.sweep.columns import output_columns

from direct_scenarios import direct_scenario
from scenarios import short_line

PARTS = {"contact_line": {"r_ohm_per_km": 0.008}, "rails": {"r_ohm_per_km": 0.012}}
LEAKING = {"supply.catenary": PARTS, "supply.conductors": {"leakage_s_per_km": 0.2}}
STATION = {
    "no_load_voltage_kv": 27.5, "grid_short_circuit_mva": 1500.0, "grid_kv": 110.0,
    "transformer": {"rated_mva": 15.0, "short_circuit_percent": 10.0, "load_loss_kw": 60.0},
}  # fmt: skip
UNIT = {
    "tractive_effort": {"max_force_kn": 200.0, "max_power_kw": 4000.0}, "mass_t": 200.0,
    "adhesive_mass_t": 100.0, "resistance_a_n": 3000.0, "resistance_b_n_s_per_m": 0.0,
    "resistance_c_n_s2_per_m2": 10.0, "max_speed_kmh": 120.0, "max_retardation_m_s2": 0.8,
    "efficiency": 0.85, "auxiliary_power_kw": 100.0, "power_factor": 1.0,
}  # fmt: skip


def leaking() -> tpss.Scenario:
    return direct_scenario(**LEAKING)


def at_phases() -> tpss.Scenario:
    """Two stations at the phases RS; twelve minutes, so that a mean over ten is not that of all."""
    stations = [
        {**STATION, "name": name, "position_km": km, "phases": "RS"}
        for name, km in (("West", 0.0), ("East", 20.0))
    ]
    return short_line(
        {
            "simulation": {"time_step_min": 0.1, "duration_min": 12.0},
            "supply": {
                "system": "25kV-50Hz",
                "catenary": {"r_ohm_per_km": 0.1, "x_ohm_per_km": 0.3},
                "transformer_stations": stations,
            },
            "trains.freight": UNIT,
            "traffic.0.headway_min": 6.0,
        }
    )


def figures_of(scenario: tpss.Scenario) -> tpss.KeyFigures:
    (figures,) = tpss.simulate_many([scenario], threads=1)
    return figures


def test_rails_and_stray_current_are_those_of_the_result() -> None:
    scenario = leaking()
    result, found = tpss.simulate(scenario), figures_of(scenario).grid_and_rails
    assert found["rail_permanent_v"] == result.rails.permanent_v.max() > 0.0
    assert found["rail_short_v"] == result.rails.short_v.max() >= found["rail_permanent_v"]
    assert found["stray_ma_per_m"] == result.stray_current.leaving_ma_per_m.max() > 0.0
    assert math.isnan(found["unbalance_percent"])


def test_unbalance_is_that_of_the_result() -> None:
    scenario = at_phases()
    result, found = tpss.simulate(scenario), figures_of(scenario).grid_and_rails
    highest = max(e.mean_10_min_percent for e in unbalance_of(result.dataset, scenario))
    assert found["unbalance_percent"] == highest > 0.0
    assert all(math.isnan(found[name]) for name in FIGURES if name != "unbalance_percent")


def test_they_are_columns_of_a_study_and_nothing_where_a_scenario_has_neither() -> None:
    told, bare = figures_of(leaking()), figures_of(short_line())
    assert bare.grid_and_rails == {}
    assert not set(FIGURES) & set(output_columns(bare))
    assert set(FIGURES) <= set(output_columns(told))


def test_a_plan_takes_them_in_its_window() -> None:
    """Trains every 5 min, on their way for a quarter of an hour: the last hour is like any."""
    row = outcome_of(direct_scenario(**LEAKING, **{"simulation.duration_min": None}), Evaluation())
    assert 0.0 < row["rail_permanent_v"] <= row["rail_short_v"]
    assert row["stray_ma_per_m"] > 0.0
    assert not set(FIGURES) & set(outcome_of(short_line(), Evaluation()))


ROW = {
    "status": "finished", "lowest_voltage_kv": 14.0, "unbalance_percent": 1.4,
    "rail_permanent_v": math.nan, "rail_short_v": 88.0, "stray_ma_per_m": 2.0,
}  # fmt: skip


def test_a_requirement_is_not_kept_beyond_its_limit_or_where_nothing_is_known() -> None:
    require = Requirements(
        unbalance_percent=1.0, rail_permanent_v=60.0, rail_short_v=90.0, stray_ma_per_m=2.5
    )
    assert list(failures(ROW, require)) == ["unbalance 1.40 %", "rails permanently not known"]
    assert list(failures(ROW, Requirements(stray_ma_per_m=1.5))) == ["stray current 2.00 mA/m"]
    assert list(failures(ROW, Requirements())) == []


@pytest.mark.parametrize(
    ("scenario", "faults"),
    [
        (short_line, {"unbalance_percent", "rail_permanent_v", "rail_short_v", "stray_ma_per_m"}),
        (leaking, {"unbalance_percent"}),
        (at_phases, {"rail_permanent_v", "rail_short_v", "stray_ma_per_m"}),
    ],
)
def test_a_requirement_of_which_a_scenario_tells_nothing_is_a_fault(scenario, faults) -> None:
    require = Requirements(
        unbalance_percent=1.0, rail_permanent_v=60.0, rail_short_v=90.0, stray_ma_per_m=2.5
    )
    found = list(not_told(require, {"north": scenario()}, "plan.toml"))
    assert {each.key for each in found} == {f"require.{name}" for name in faults}
    assert all("of north does not tell it" in each.problem for each in found)
    assert all("leave the requirement out" in each.remedy for each in found)
