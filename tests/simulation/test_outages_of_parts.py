"""Stores, autotransformers and transformers of two windings that are out: as if they were not there."""

from typing import Any

import numpy as np
import pytest

import tpss
from tpss.outages.cases import single_outages

from conftest import EXAMPLES
from direct_scenarios import direct_scenario
from slow_audit import assert_agree, audit_of

STORE = {
    "name": "Middle", "position_km": 3.0, "kind": "battery", "capacity_kwh": 20.0, "power_kw": 800.0,
    "efficiency": 0.95, "soc_start": 0.5, "charges_above_kv": 0.84, "discharges_below_kv": 0.79,
    "charge_kw_per_v": 40.0, "discharge_kw_per_v": 25.0,
}  # fmt: skip
STATION = "supply.transformer_stations.Airport"
GROUP = "supply.autotransformers.0"


def out(**keys: Any) -> dict[str, Any]:
    return {"outages": [{"name": "out", **keys}], "simulation.outage": "out"}


def stored(**changes: Any) -> tpss.Scenario:
    return direct_scenario(**{"supply.storage": [STORE], **changes})


def fast(**changes: Any) -> tpss.Scenario:
    """The double track with autotransformers, for a quarter of an hour."""
    ended = {"simulation.duration_min": 15.0}
    return tpss.load_scenario(EXAMPLES / "hs_2x25kv.toml").with_({**ended, **changes})


def run(scenario: tpss.Scenario) -> tpss.Result:
    result = tpss.simulate(scenario)
    assert result.audit["passed"], result.audit["failures"]
    return result


def assert_alike(one: tpss.Result, other: tpss.Result, *names: str) -> None:
    for name in ("pantograph_voltage", "active_power", "position", *names):
        a, b = one.dataset[name].to_numpy(), other.dataset[name].to_numpy()
        np.testing.assert_allclose(a, b, rtol=1e-7, atol=1e-3, err_msg=name)


def test_a_store_that_is_out_is_as_if_it_were_not_there_and_keeps_what_it_holds() -> None:
    without, idle = run(direct_scenario()), run(stored(**out(storage=["Middle"])))
    assert_alike(idle, without, "station_active_power")
    assert (idle.dataset.store_power.to_numpy()[:-1] == 0.0).all()
    assert (idle.dataset.stored_energy == 10.0 * 3.6e6).all()


def test_the_slow_audit_agrees_that_a_store_that_is_out_rests() -> None:
    scenario = stored(**out(storage=["Middle"]))
    expected, limits = audit_of(scenario)
    told = tpss.simulate(scenario).audit
    found = type(expected)(**{name: told[name] for name in vars(expected)})
    assert found.passed
    assert_agree(found, expected, limits)


def test_a_store_that_is_out_for_a_time_goes_on_with_what_it_held() -> None:
    """From 4 to 8 min; before and after, it takes and gives."""
    result = run(stored(**out(storage=["Middle"], from_min=4.0, to_min=8.0)))
    minutes = result.dataset.time.to_numpy()[:-1] / 60.0
    power = result.dataset.store_power.to_numpy()[:-1, 0]
    energy = result.dataset.stored_energy.to_numpy()[:-1, 0]
    away = (minutes > 4.0 - 1e-6) & (minutes < 8.0 - 1e-6)
    assert (power[away] == 0.0).all()
    assert np.abs(power[minutes < 4.0 - 1e-6]).max() > 0.0
    assert np.abs(power[minutes > 8.0]).max() > 0.0
    assert len(set(energy[away])) == 1


def test_an_autotransformer_that_is_out_is_as_if_it_were_not_there() -> None:
    """But for the tie of the tracks where it stands, which stays."""
    idle = run(fast(**out(autotransformers=[{"position_km": 30.0}])))
    post = {"name": "Tie", "position_km": 30.0}
    absent = run(
        fast(**{f"{GROUP}.positions_km": [10.0, 20.0, 40.0, 50.0], "supply.posts": [post]})
    )
    assert_alike(idle, absent, "station_active_power")
    table = idle.autotransformers.set_index("position_km")
    assert table.highest_winding_a[30.0] == 0.0
    assert (table.highest_winding_a.drop(30.0) > 0.0).all()


def test_without_any_autotransformer_the_feeder_carries_no_traction_current() -> None:
    """All five out: only the station's winding joins the feeder, which lies idle, and voltages fall."""
    all_out = [{"position_km": km} for km in (10.0, 20.0, 30.0, 40.0, 50.0)]
    idle, intact = run(fast(**out(autotransformers=all_out))), run(fast())
    lowest, usual = (each.summary["lowest_voltage"]["voltage_kv"] for each in (idle, intact))
    assert lowest < usual
    assert (idle.autotransformers.highest_winding_a == 0.0).all()


@pytest.mark.parametrize("share", [0.1, 0.5])
def test_windings_of_a_transformer_that_is_out_are_out_too(share: float) -> None:
    """Of two transformers one is out: a station of one, its halves too."""
    two = {f"{STATION}.transformers": 2, f"{STATION}.share_in_halves": share}
    one = run(fast(**{**two, f"{STATION}.transformers": 1}))
    left = run(fast(**two, **out(units={"Airport": 1})))
    assert_alike(left, one, "station_active_power", "station_reactive_power")


def test_every_store_and_autotransformer_is_a_single_element() -> None:
    names = [each.name for each in single_outages(stored())]
    assert "store Middle out" in names
    names = [each.name for each in single_outages(fast())]
    assert [name for name in names if "auto" in name] == [
        f"autotransformer {km} km out" for km in (10, 20, 30, 40, 50)
    ]


def test_a_table_of_outages_ranks_them() -> None:
    found = tpss.compare_outages(stored(**{"simulation.duration_min": 8.0}), every=True, threads=1)
    row = next(row for row in found.rows if row.outage == "store Middle out")
    assert row.out == "store Middle out"
