"""What switching converters by their loading saves, and up to which power one less loses less.

Two of 10 MVA with 300 kW idle and c = 4.5 %: S* = 10 · √(2 · 0.03 / 0.045) = 11.547 MVA, where

    two lose 600 kW + 0.045 · 133.33 / 20 MW = 900 kW, one 300 kW + 0.045 · 133.33 / 10 MW = 900 kW
"""

import copy
import math
from typing import Any

import numpy as np
import pytest

import tpss
from tpss.converter_control.break_even import break_even_va, station_losses_w
from tpss.converter_control.compare import compare_controls
from tpss.results.grid_side import LossLaw, law_of
from tpss.scenario.supply import ConverterLosses

from scenarios import short_line

ROTARY = "Q48/Q49 with losses (estimate)"
STATIONS = "supply.converter_stations"


def law(**losses: Any) -> LossLaw:
    return law_of(ConverterLosses(**losses), 10e6)


def test_one_of_two_loses_less_up_to_11_5_mva() -> None:
    own = law(idle_kw=300.0, linear_percent=1.5, quadratic_percent=4.5)
    assert break_even_va(2, own) == pytest.approx(11.547e6, rel=1e-4)


@pytest.mark.parametrize("converters", [2, 3, 6])
def test_both_numbers_lose_the_same_there(converters: int) -> None:
    own = law(idle_kw=120.0, linear_percent=1.2, quadratic_percent=1.5)
    at = np.array([break_even_va(converters, own)])
    all_w, one_less_w = (station_losses_w(at, n, own)[0] for n in (converters, converters - 1))
    assert all_w == pytest.approx(one_less_w, rel=1e-12)
    for share, fewer_is_better in ((0.99, True), (1.01, False)):
        more_w = station_losses_w(share * at, converters - 1, own) - station_losses_w(
            share * at, converters, own
        )
        assert (more_w[0] < 0.0) == fewer_is_better


@pytest.mark.parametrize("converters", [2, 3, 6])
def test_a_curve_of_the_same_losses_gives_the_same(converters: int) -> None:
    """Sampled at each percent, of which the straight lines are within a part in ten thousand."""
    loads = range(0, 201)
    points = [{"load_percent": float(k), "loss_kw": 300.0 + 1.5 * k + 0.045 * k**2} for k in loads]
    expected = law(idle_kw=300.0, linear_percent=1.5, quadratic_percent=4.5)
    found = break_even_va(converters, law(curve=points))
    assert found == pytest.approx(break_even_va(converters, expected), rel=1e-4)


def test_losses_without_idle_ones_never_pay_and_straight_ones_always() -> None:
    assert break_even_va(2, law(idle_kw=0.0, quadratic_percent=1.0)) == 0.0
    assert break_even_va(2, law(idle_kw=100.0, linear_percent=1.0)) == math.inf
    straight = [{"load_percent": 0.0, "loss_kw": 100.0}, {"load_percent": 100.0, "loss_kw": 200.0}]
    assert break_even_va(2, law(curve=straight)) == math.inf


def scenario(**changes: Any) -> tpss.Scenario:
    own = {f"{STATIONS}.*.type": ROTARY, f"{STATIONS}.*.converters": 3}
    return short_line({**own, "simulation.duration_min": 30.0, **changes})


def test_what_is_saved_is_the_difference_of_two_runs() -> None:
    found = compare_controls(scenario())
    lost = {}
    for control in ("all-on", "loading"):
        run = tpss.simulate(scenario().with_({f"{STATIONS}.*.control": control}))
        days = run.summary["duration_min"] / 1440.0
        lost[control] = run.converter_losses.losses_mwh.to_numpy() / days
    np.testing.assert_allclose(found.table.saved_mwh, lost["all-on"] - lost["loading"], rtol=1e-12)
    np.testing.assert_allclose(found.table.all_on_mwh, lost["all-on"], rtol=1e-12)
    assert found.table.saved_mwh.sum() > 0.0
    assert found.saved_at_the_grid_mwh == pytest.approx(found.table.saved_mwh.sum(), rel=0.05)


def test_break_even_of_every_number_of_converters() -> None:
    table = compare_controls(scenario()).break_even
    assert table.converters.tolist() == [2, 3]
    expected = [10.0 * math.sqrt(n * (n - 1) * 0.03 / 0.045) for n in (2, 3)]
    np.testing.assert_allclose(table.power_mva, expected)
    np.testing.assert_allclose(table.loading * table.converters * 10.0, expected)


def test_own_types_that_differ_have_rows_of_their_own() -> None:
    types = [copy.deepcopy(tpss.library.values("converters", ROTARY)) for _ in range(2)]
    types[1]["losses"]["idle_kw"] = 200.0
    types[0]["losses"]["idle_kw"] = 250.0
    changes = {f"{STATIONS}.{k}.type": kind for k, kind in enumerate(types)}
    table = compare_controls(scenario(**changes)).break_even
    assert len(set(table.type)) == 2
    assert len(table) == 4


def test_a_scenario_without_losses_is_refused() -> None:
    with pytest.raises(tpss.ScenarioError) as caught:
        compare_controls(scenario(**{f"{STATIONS}.*.type": "Q48/Q49"}))
    assert "no station describes what its converters lose" in str(caught.value)
