"""Runs on lines whose rails are conductors of their own: balances, rails, stray current, faults."""

import numpy as np
import pytest

import tpss
from tpss.outages.row import Verdict, row_of
from tpss.results.judged_rails import EN_50122

from direct_scenarios import direct_document, direct_scenario
from slow_audit import assert_agree, audit_of

PARTS = {"contact_line": {"r_ohm_per_km": 0.008}, "rails": {"r_ohm_per_km": 0.012}}
LEAKING = {"supply.catenary": PARTS, "supply.conductors": {"leakage_s_per_km": 0.2}}
WEST = "supply.rectifier_stations.West"


@pytest.fixture(scope="module")
def leaking():
    return tpss.simulate(direct_scenario(**LEAKING))


def test_all_balances_close_and_agree_with_the_slow_twin(leaking):
    assert leaking.summary["status"] == "finished"
    assert leaking.audit["passed"]
    expected, limits = audit_of(leaking.scenario)
    found = type(expected)(**{name: leaking.audit[name] for name in vars(expected)})
    assert_agree(found, expected, limits)


def test_insulated_rails_that_are_earthed_once_are_a_resistance_in_the_return():
    """Nothing leaves them then: 0.008 + 0.012 ohm/km are the 0.02 of a single conductor."""
    apart = tpss.simulate(
        direct_scenario(
            **{**LEAKING, "supply.conductors": {"leakage_s_per_km": 0.0},
               f"{WEST}.rail_earthing_ohm": 1.0}
        )
    )  # fmt: skip
    one = tpss.simulate(direct_scenario())
    for name in ("pantograph_voltage", "active_power", "speed"):
        own, other = apart.dataset[name].to_numpy(), one.dataset[name].to_numpy()
        np.testing.assert_allclose(own, other, rtol=1e-6, atol=1e-3)
    # A station's power is that before its link, of 1.1 microohm, in which some watts are lost.
    own, other = (run.dataset.station_active_power.to_numpy() for run in (apart, one))
    np.testing.assert_allclose(own, other, rtol=1.1e-5, atol=1e-3)
    assert apart.stray_current.leaving_a[0] == pytest.approx(0.0, abs=1e-9)


def test_what_is_told_of_rails(leaking):
    """Rails lie above earth where trains draw, and below at stations; the means are no higher."""
    rails = leaking.rails
    assert rails.position_km.is_monotonic_increasing
    assert rails.highest_v.max() > 0.0 > rails.lowest_v.min()
    assert (rails.permanent_v <= rails.short_v + 1e-9).all()
    assert leaking.stray_current.leaving_a[0] > 0.0
    lines = leaking.judged_rails.in_words
    assert lines[0].startswith("Rails to earth: at most")
    assert "Stray current" in lines[-1]


def test_limits_are_data(leaking):
    strict = leaking.with_standards({"rails.permanent_v": 1e-3, "rails.stray_ma_per_m": 1e-6})
    assert [", beyond it" in line for line in strict.judged_rails.in_words] == [False, True, True]


def test_what_is_beyond_a_limit_of_rails_is_a_violation_the_worst_first(leaking):
    assert len(leaking.standards.violations) == 0
    strict = leaking.with_standards({"rails.permanent_v": 1e-3, "rails.stray_ma_per_m": 1e-6})
    found = strict.standards.violations
    assert set(found.standard) == {EN_50122}
    voltages = found[found.rule == "rail voltage"]
    assert len(voltages) == (leaking.rails.permanent_v > 1e-3).sum() > 1
    assert voltages.value_kv.is_monotonic_decreasing
    assert voltages.value_kv[0] == leaking.rails.permanent_v.max() / 1e3
    assert "V to earth over 300 s, above 0.001 V" in voltages.words[0]
    assert found.words.iloc[-1].endswith("mA/m of track stray, above 1e-06 mA/m")
    assert row_of("", "", leaking).verdict == Verdict.KEPT
    assert row_of("", "", strict).verdict == Verdict.RAILS


def test_autotransformers_outside_of_the_line_are_told_with_their_place():
    document = direct_document()
    unit = {"positions_km": [2.0, 9.0], "rated_mva": 10.0, "short_circuit_percent": 1.0}
    document["supply"]["autotransformers"] = [unit]
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.Scenario.from_document(document)
    (found,) = [each for each in caught.value.findings if "positions_km" in each.key]
    assert found.key == "supply.autotransformers.0.positions_km.1"
    assert found.problem == "outside the line, which runs from 0 to 6 km"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"conductors": {"leakage_s_per_km": 0.0}}, "nothing ties the rails to earth"),
        ({"catenary": {"r_ohm_per_km": 0.02}}, "does not tell contact line and rails apart"),
        ({"autotransformers": [{"positions_km": [3.0], "rated_mva": 10.0,
                                "short_circuit_percent": 1.0}]}, "without a feeder"),
        ({"conductors": None, "autotransformers": [{"positions_km": [3.0], "rated_mva": 10.0,
                                                    "short_circuit_percent": 1.0}]},
         "without conductors"),
    ],
)  # fmt: skip
def test_what_does_not_belong_together_is_told(changes, words):
    document = direct_document()
    document["supply"] |= {"catenary": PARTS, "conductors": {"leakage_s_per_km": 0.1}, **changes}
    if document["supply"]["conductors"] is None:
        del document["supply"]["conductors"]
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.Scenario.from_document(document)
    assert any(words in str(finding) for finding in caught.value.findings)
