"""Trains that feed back: what they give, what the line takes, and where it goes."""

import copy
import math
from typing import Any

import numpy as np
import pytest

from grades import A_N, EFFICIENCY, R_OHM_PER_KM, SPEED_M_S, WEIGHT_N, document, values
from lines import run, scenario_of, service
from tpss import ScenarioError
from tpss.model.build import build_model
from tpss.results.notes import notes
from tpss.results.regeneration import PARTS, fed_back, in_words


def test_a_train_down_a_grade_gives_back_what_the_one_up_draws_less_resistance() -> None:
    """At 20 m/s on 10 ‰ of 400 t, 39.24 kN, against 10 kN: the brakes hold 29.24 kN, the motors pull
    49.24 kN.  So it draws 49.24 · 20 / 0.8 = 1231 kW upwards and feeds back 29.24 · 20 · 0.8 = 467.8 kW.
    """
    grade_n = WEIGHT_N * 0.01 / math.sqrt(1.0 + 0.01**2)
    down, up = run(document(max_force_kn=150.0)), run(document(permille=10.0))
    middle = slice(150, 200)
    gives, draws = -values(down, "active_power")[middle], values(up, "active_power")[middle]
    np.testing.assert_allclose(gives, (grade_n - A_N) * SPEED_M_S * EFFICIENCY, rtol=1e-4)
    np.testing.assert_allclose(draws, (grade_n + A_N) * SPEED_M_S / EFFICIENCY, rtol=1e-4)
    np.testing.assert_allclose(
        draws * EFFICIENCY - gives / EFFICIENCY, 2.0 * A_N * SPEED_M_S, rtol=1e-9
    )


def test_voltage_rises_as_that_of_one_train_and_one_source() -> None:
    """Through R a train that feeds back P has U² - U₀ U - R P = 0: U = (U₀ + √(U₀² + 4 R P)) / 2."""
    result = run(document(full_until_kv=30.0, zero_from_kv=31.0))
    km, p = values(result, "position") / 1e3, -values(result, "active_power")
    r = np.maximum(R_OHM_PER_KM * km, 1e-9)
    expected = (16.5e3 + np.sqrt(16.5e3**2 + 4.0 * r * p)) / 2.0
    np.testing.assert_allclose(values(result, "pantograph_voltage")[1:], expected[1:], rtol=1e-7)


def test_voltage_stays_below_the_one_at_which_nothing_is_taken() -> None:
    """20 Ω of line: to feed back 1.25 MW whole would take 17.9 kV at 40 km; the line takes less."""
    result = run(document(permille=-25.0, r_ohm_per_km=0.5, full_until_kv=17.25, zero_from_kv=17.4))
    volts = values(result, "pantograph_voltage")
    assert 17.25e3 < volts.max() < 17.4e3
    offered = values(result, "regenerated_power") + values(result, "refused_power")
    assert (values(result, "refused_power") >= 0.0).all()
    far = values(result, "position") > 35e3
    assert (values(result, "refused_power")[far] > 0.2 * offered[far])[:20].all()


def test_motion_does_not_depend_on_what_the_line_takes() -> None:
    """Friction brakes give what the electric ones do not."""
    weak = {"permille": -25.0, "r_ohm_per_km": 0.5}
    with_, without = run(document(**weak, zero_from_kv=17.4)), run(document(**weak))
    for name in ("route_position", "speed", "braking_force", "braking_power"):
        np.testing.assert_array_equal(values(with_, name), values(without, name), err_msg=name)
    assert with_.summary["total_energy_mwh"] < without.summary["total_energy_mwh"]


@pytest.mark.parametrize("step_min", [0.05, 0.5])
def test_what_electric_brakes_give_does_not_depend_on_the_step(step_min: float) -> None:
    """Braking from 72 km/h to a stand at the end included, of which the last 10 km/h fade.

    In the one step in which the train draws first, and brakes then, what it feeds back is the mean.
    """
    takes_all = {"full_until_kv": 18.5, "zero_from_kv": 19.0}
    fine = run(document(step_min=0.01, **takes_all)).regeneration.iloc[0]
    other = run(document(step_min=step_min, **takes_all)).regeneration.iloc[0]
    one, two = (each.own_use_mwh + each.fed_back_mwh for each in (fine, other))
    assert two == pytest.approx(one, rel=1e-6)
    assert other.fed_back_mwh == pytest.approx(fine.fed_back_mwh, rel=2e-2)


def test_the_parts_of_what_is_braked_add_up_to_it() -> None:
    scenario = document(permille=-25.0, r_ohm_per_km=0.5, zero_from_kv=17.4, max_power_kw=1000.0)
    scenario["trains"]["freight"]["auxiliary_power_kw"] = 100.0
    result = run(scenario)
    (row,) = result.regeneration.to_dict("records")
    assert sum(row[part] for part in PARTS) == pytest.approx(row["braked_mwh"], rel=1e-12)
    absent = {"rheostat_mwh", "own_storage_mwh"}
    assert all(row[part] > 0.0 for part in PARTS if part not in absent)
    assert all(row[part] == 0.0 for part in absent)
    losses = row["machine_losses_mwh"]
    taken = row["refused_mwh"] + row["own_use_mwh"] + row["fed_back_mwh"]
    assert losses == pytest.approx((1.0 / EFFICIENCY - 1.0) * taken, rel=1e-9)


def test_a_rheostat_burns_what_friction_brakes_would_have_to_take() -> None:
    """The run is the same to the last bit; what the line does not take is told as burnt."""
    weak = {"permille": -25.0, "r_ohm_per_km": 0.5, "zero_from_kv": 17.4}
    friction, rheostat = run(document(**weak)), run(document(**weak, rest="rheostat"))
    for name in ("route_position", "pantograph_voltage", "refused_power", "regenerated_power"):
        np.testing.assert_array_equal(values(friction, name), values(rheostat, name), err_msg=name)
    (left,), (burnt,) = (each.regeneration.to_dict("records") for each in (friction, rheostat))
    assert burnt["rheostat_mwh"] == left["refused_mwh"] > 0.0
    assert burnt["refused_mwh"] == left["rheostat_mwh"] == 0.0
    for part in (*PARTS, "braked_mwh"):
        if part not in ("refused_mwh", "rheostat_mwh"):
            assert burnt[part] == left[part], part
    assert "rheostats" in in_words(fed_back(rheostat.dataset, rheostat.scenario) or {})


def test_a_rheostat_is_cold_where_the_line_takes_all() -> None:
    result = run(document(full_until_kv=18.5, zero_from_kv=19.0, rest="rheostat"))
    (row,) = result.regeneration.to_dict("records")
    assert row["fed_back_mwh"] > 0.0
    assert row["rheostat_mwh"] == row["refused_mwh"] == 0.0


def test_of_two_types_of_train_only_that_with_a_rheostat_burns() -> None:
    """Two trains with the same brakes follow each other down; the second has a rheostat."""
    scenario = document(permille=-25.0, r_ohm_per_km=0.5, zero_from_kv=17.4)
    other = copy.deepcopy(scenario["trains"]["freight"])
    other["regeneration"]["rest"] = "rheostat"
    scenario["trains"]["other"] = other
    following = {**service("second", "A", "B", departures_min=[15.0]), "train": "other"}
    scenario["traffic"].append(following)
    scenario["simulation"] = {"time_step_min": 0.1, "duration_min": 60.0}
    first, second = run(scenario).regeneration.to_dict("records")
    assert first["refused_mwh"] > 0.0
    assert first["rheostat_mwh"] == 0.0
    assert second["rheostat_mwh"] > 0.0
    assert second["refused_mwh"] == 0.0


def test_another_train_uses_what_one_feeds_back() -> None:
    """Of two that meet, the one up draws more than the one down gives: nothing reaches the grid then."""
    scenario = document(max_force_kn=150.0)
    scenario["traffic"].append(service("up", "B", "A", departures_min=[0.0]))
    scenario["simulation"] = {"time_step_min": 0.1, "duration_min": 20.0}
    result = run(scenario)
    totals = fed_back(result.dataset, result.scenario)
    assert totals is not None
    assert totals["used_by_others_mwh"] > 0.9 * totals["fed_back_mwh"] > 0.0
    parts = totals["used_by_others_mwh"] + totals["to_grid_mwh"] + totals["burnt_in_stations_mwh"]
    assert parts == pytest.approx(totals["fed_back_mwh"])
    assert "other trains and the line" in in_words(totals)
    assert not [note for note in notes(result) if "circulates" in note]


def test_trains_share_what_becomes_of_it_by_what_each_feeds_back() -> None:
    """Two trains down and one up, step by step: what the station takes, over what both give, is the
    share of each that reaches the grid; the rest goes to the other train and the line."""
    scenario = document(max_force_kn=150.0)
    scenario["traffic"][0]["departures_min"] = [0.0, 3.0]
    scenario["traffic"].append(service("up", "B", "A", departures_min=[6.0]))
    scenario["simulation"] = {"time_step_min": 0.1, "duration_min": 20.0}
    result = run(scenario)
    data, hours = result.dataset, np.diff(result.dataset.time) / 3600.0
    given = np.maximum(-np.nan_to_num(data.active_power.to_numpy()[:-1]), 0.0)
    station = data.station_active_power.to_numpy()[:-1]
    to_grid_mwh = np.zeros(data.sizes["train"])
    for k, length_h in enumerate(hours):
        taken = -np.minimum(station[k], 0.0).sum()
        if taken > 0.0:
            to_grid_mwh += given[k] * length_h * taken / max(given[k].sum(), taken) / 1e6
    table = result.regeneration.set_index("train")
    assert (given > 0.0).any(axis=0).sum() >= 2
    np.testing.assert_allclose(table.to_grid_mwh, to_grid_mwh, rtol=1e-9, atol=1e-12)
    uses = table.used_by_others_mwh + table.to_grid_mwh + table.burnt_in_stations_mwh
    np.testing.assert_allclose(uses, table.fed_back_mwh, rtol=1e-12)
    assert table.used_by_others_mwh.max() > 0.0
    totals = fed_back(result.dataset, result.scenario)
    assert totals is not None
    for name, total in totals.items():
        assert table[name].sum() == pytest.approx(total), name


def test_a_station_with_a_resistor_burns_what_it_takes() -> None:
    """The load flow is the same; the energy is booked as burnt."""
    grid, resistor = document(max_force_kn=150.0), document(max_force_kn=150.0)
    resistor["supply"]["converter_stations"][0]["feedback"] = "resistor"
    one, two = run(grid), run(resistor)
    np.testing.assert_array_equal(
        values(one, "pantograph_voltage"), values(two, "pantograph_voltage")
    )
    first, second = (fed_back(each.dataset, each.scenario) for each in (one, two))
    assert first is not None
    assert second is not None
    assert first["to_grid_mwh"] == second["burnt_in_stations_mwh"] > 0.0
    assert first["burnt_in_stations_mwh"] == second["to_grid_mwh"] == 0.0


def test_reactive_power_follows_its_power_factor() -> None:
    """With 0.9, inductive: Q is tan(arccos 0.9) = 0.4843 of what the line takes."""
    result = run(document(power_factor=0.9))
    taken = values(result, "regenerated_power")
    braking = taken > 0.0
    np.testing.assert_allclose(
        values(result, "reactive_power")[braking],
        math.tan(math.acos(0.9)) * taken[braking],
        rtol=1e-9,
    )


def test_without_electric_brakes_there_is_no_table_and_no_variable() -> None:
    result = run(document())
    assert result.regeneration.empty
    assert "regenerated_power" not in result.dataset
    assert fed_back(result.dataset, result.scenario) is None


def build(scenario: dict[str, Any]) -> None:
    build_model(scenario_of(scenario))


@pytest.mark.parametrize(
    ("brakes", "words"),
    [
        ({"fade_to_kmh": 12.0}, "fade_to_kmh (12 km/h) is not below fade_from_kmh (10 km/h)"),
        ({"full_until_kv": 17.9, "zero_from_kv": 17.5}, "zero_from_kv (17.5 kV) is not above"),
        ({"full_until_kv": 18.5}, "not below zero_from_kv, 18 kV"),
        ({"full_until_kv": 16.0}, "below the voltage of West without load, 16.5 kV"),
        ({"efficiency": 1.2}, "efficiency"),
        ({"rest": "resistor"}, "rest"),
        ({"max_force_kn": 0.0}, "max_force_kn"),
    ],
)
def test_electric_brakes_that_cannot_be_are_named(brakes: dict[str, Any], words: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        build(document(**{"max_power_kw": 3000.0, **brakes}))
    assert words in str(caught.value)


def test_stepped_motion_does_not_know_them() -> None:
    scenario = document(max_force_kn=150.0)
    scenario["simulation"]["motion"] = "stepped"
    with pytest.raises(ScenarioError) as caught:
        build(scenario)
    assert 'does not go with motion = "stepped"' in str(caught.value)
