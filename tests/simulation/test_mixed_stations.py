"""Stations with converters of several types: how these share, what they lose, what is refused."""

import copy
from typing import Any

import numpy as np
import pytest

import tpss
from lines import line, network, run, scenario_of, service
from tpss import Finding, ScenarioError, library
from tpss.converter_control.compare import compare_controls
from tpss.results.converter_losses import station_powers
from tpss.results.grid_side import sides_of
from tpss.scenario.supply.mixed_station import MOST_TYPES
from tpss.sources.mixed import TYPES, split_all

from slow_audit import assert_agree, audit_of

ROTARY = "Q48/Q49 with losses (estimate)"
STATIC = {
    **library.values("converters", "static 15 MVA with losses (estimate)"),
    "droop_kv_per_mvar": 0.02, "generator_reactance_pu": 0.2, "motor_reactance_pu": 0.3,
}  # fmt: skip
"""Stiffer than a rotary one of its rating, so that it takes more than its part."""

UNITS = [{"type": ROTARY, "converters": 2}, {"type": STATIC, "converters": 1}]


def base() -> dict[str, Any]:
    made = line(40.0, {"A": 0.0, "B": 40.0})
    found = network({"main": made}, [service("up", "A", "B", departures_min=[0.0, 5.0])])
    found["simulation"] = {"duration_min": 12.0, "time_step_min": 0.1}
    return found


def mixed(**more: Any) -> dict[str, Any]:
    found = base()
    station = {"name": "West", "line": "main", "position_km": 10.0, "units": UNITS}
    found["supply"]["converter_stations"] = []
    found["supply"]["mixed_stations"] = [{**copy.deepcopy(station), **more}]
    return found


def shares_mw(result: tpss.Result) -> np.ndarray:
    """Powers of the types of the first station in every step. [MVA], shape (steps, types)"""
    data = result.dataset
    powers = data.station_active_power[:-1, 0] + 1j * data.station_reactive_power[:-1, 0]
    (side,) = (each for each in sides_of(result.scenario) if each.mixed is not None)
    assert side.mixed is not None
    shared = np.zeros((powers.size, len(TYPES)), dtype=complex)
    split_all(np.ascontiguousarray(powers.to_numpy()), side.mixed[0], shared)
    return shared[:, :2] / 1e6


def test_types_share_as_stations_that_hardly_anything_parts() -> None:
    """Two stations of one type each, 1 m apart on 0.25 mΩ."""
    apart = base()
    kinds = zip(("rotary", "static"), UNITS, (10.0, 10.001), strict=True)
    apart["supply"]["converter_stations"] = [
        {"name": name, "line": "main", "position_km": km, **units} for name, units, km in kinds
    ]
    two, one = run(apart), run(mixed())
    active, reactive = (
        two.dataset[f"station_{name}_power"].to_numpy()[:-1] / 1e6
        for name in ("active", "reactive")
    )
    np.testing.assert_allclose(shares_mw(one), active + 1j * reactive, atol=2e-3)
    np.testing.assert_allclose(
        one.dataset.pantograph_voltage, two.dataset.pantograph_voltage, rtol=1e-5
    )


def test_a_stiffer_type_takes_more_than_its_part() -> None:
    shared = shares_mw(run(mixed()))
    pulling = shared.real.sum(axis=1) > 1.0
    assert (shared.real[pulling, 1] > 1.2 * shared.real[pulling, 0] * 15.0 / 20.0).all()


def test_one_type_is_a_converter_station() -> None:
    """To the rounding of the solutions, its losses too."""
    plain = base()
    plain["supply"]["converter_stations"] = [
        {"name": "West", "line": "main", "position_km": 10.0, "type": ROTARY, "converters": 3}
    ]
    units = [{"type": ROTARY, "converters": 2}, {"type": ROTARY, "converters": 1}]
    one, two = run(plain), run(mixed(units=units))
    np.testing.assert_allclose(
        two.dataset.pantograph_voltage, one.dataset.pantograph_voltage, rtol=1e-9
    )
    columns = ["from_grid_mwh", "losses_mwh", "idle_mwh", "by_load_mwh", "mean_efficiency"]
    np.testing.assert_allclose(
        two.converter_losses[columns].astype(float), one.converter_losses[columns].astype(float),
        rtol=1e-7,
    )  # fmt: skip
    assert two.stations.peak_loading.item() == pytest.approx(one.stations.peak_loading.item())


def test_losses_are_those_of_each_type_s_own_part() -> None:
    result = run(mixed())
    (found,) = station_powers(result.dataset, result.scenario).values()
    rotary, static = np.abs(shares_mw(result)).T
    by_load_mw = 0.015 * rotary + 0.045 * rotary**2 / 20.0
    by_load_mw += 0.012 * static + 0.015 * static**2 / 15.0
    np.testing.assert_allclose(found.by_load / 1e6, by_load_mw, rtol=1e-9)
    np.testing.assert_allclose(found.idle, 2 * 300e3 + 120e3, rtol=1e-12)
    fed = result.dataset.station_active_power.to_numpy()[:-1, 0]
    np.testing.assert_allclose(found.from_grid - found.to_grid, fed + found.losses, rtol=1e-12)


def test_it_is_told_beside_stations_that_are_switched() -> None:
    """Nothing is switched in it, but it takes part of what stations with fewer converters leave it."""
    document = mixed()
    document["supply"]["converter_stations"] = [
        {"name": "East", "line": "main", "position_km": 40.0, "type": ROTARY, "converters": 3}
    ]
    table = compare_controls(scenario_of(document)).table.set_index("station")
    assert table.converters.to_dict() == {"East": 3, "West": 3}
    assert table.starts["West"] == 0.0
    assert table.saved_mwh["East"] > 10.0 * abs(table.saved_mwh["West"]) > 0.0


def test_the_audit_and_its_slow_twin_agree() -> None:
    """The twin finds how the types share every load by another method."""
    third = {**STATIC, "droop_kv_per_mvar": 0.1, "rating_mva": 3.0}
    scenario = scenario_of(mixed(units=[*UNITS, {"type": third, "converters": 2}]))
    expected, limits = audit_of(scenario)
    told = tpss.simulate(scenario).audit
    assert told["converter_residual"] < 1e-9
    found = type(expected)(**{name: told[name] for name in vars(expected)})
    # As near as the library's method comes, 1e-9 kV.
    assert_agree(found, expected, {**limits, "converter_residual": 1e-6})


def test_the_law_has_as_many_types_as_a_scenario() -> None:
    assert len(TYPES) == MOST_TYPES


def test_own_types_by_name_are_those_of_units_too() -> None:
    found = mixed(units=[{"type": "own", "converters": 2}, UNITS[0]])
    found["supply"]["converter_types"] = {"own": STATIC}
    scenario = scenario_of(found)
    assert scenario.supply.mixed_stations[0].units[0].type.rating_mva == 15.0
    assert scenario_of(scenario.as_document()) == scenario


def test_a_mixed_station_may_go_out_whole() -> None:
    found = mixed()
    end = {"name": "End", "line": "main", "position_km": 40.0, "type": ROTARY, "converters": 3}
    found["supply"]["converter_stations"] = [end]
    found["outages"] = [{"name": "no West", "stations": ["West"]}]
    result = tpss.simulate(scenario_of(found).with_outage("no West"))
    assert result.audit["passed"], result.audit["failures"]
    assert (result.stations.set_index("station").energy_mwh["West"]) == 0.0


def faults_of(document: dict[str, Any]) -> tuple[Finding, ...]:
    with pytest.raises(ScenarioError) as caught:
        scenario_of(document)
    return caught.value.findings


@pytest.mark.parametrize(
    ("kind", "problem"),
    [
        ({"no_load_voltage_kv": 16.0}, "a current would circulate"),
        ({"droop_kv_per_mvar": 0.0}, "no droop or no reactance"),
        ({"generator_reactance_pu": 0.0, "motor_reactance_pu": 0.0}, "no droop or no reactance"),
    ],
)
def test_types_that_cannot_share_a_load_are_refused(kind: dict[str, Any], problem: str) -> None:
    units = [UNITS[0], {"type": {**STATIC, **kind}, "converters": 1}]
    (finding,) = faults_of(mixed(units=units))
    assert problem in finding.problem
    assert finding.key == "supply.mixed_stations.0"


def test_single_converters_of_it_do_not_go_out() -> None:
    found = mixed()
    found["outages"] = [{"name": "one", "units": {"West": 1}}]
    (finding,) = faults_of(found)
    assert "of which single ones do not go out" in finding.problem
