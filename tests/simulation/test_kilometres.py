"""A line begins anywhere: at other kilometres the same line gives the same result, but for roundings."""

import copy
import math
from typing import Any

import numpy as np
import pytest

import tpss
from tpss.many import key_figures
from tpss.scenario.line import end_of_line

from properties.kilometres import moved
from properties.rules import keep_the_rules
from scenarios import BUSY, COLD, SHORT_LINE

SAME = 1e-9
"""Positions of some thousand kilometres are rounded to 0.2 nm, and trains travel metres in a step; at
10,000 km, to 2 nm, a step that just reaches another gradient is off by more."""


def scenario_of(document: dict[str, Any]) -> tpss.Scenario:
    return tpss.Scenario.from_document(document, "moved")


def assert_like(found: tpss.Result, expected: tpss.Result, begin_km: float, same: float) -> None:
    """Assert that everything recorded is the same, at positions farther on."""
    assert found.status == expected.status
    for name in expected.dataset.data_vars:
        one, other = (r.dataset[name].to_numpy().astype(float) for r in (found, expected))
        if name == "route_position":  # the kilometre, or minus it
            continue
        one = one - begin_km * 1e3 if name == "position" else one
        largest = np.nanmax(np.abs(other), initial=0.0)
        np.testing.assert_allclose(one, other, rtol=0.0, atol=same * largest, err_msg=str(name))


@pytest.mark.parametrize("document", [COLD, BUSY], ids=["cold", "busy"])
@pytest.mark.parametrize(
    ("begin_km", "same"),
    [(438.0, SAME), (-2.5, SAME), (-1234.567, SAME), (0.1, SAME), (9999.3, 1e2 * SAME)],
)
@pytest.mark.parametrize("braking", ["whole-steps", "within-step"])
def test_other_kilometres_give_the_same_result(document, begin_km, same, braking):
    document = copy.deepcopy(document)
    document["simulation"]["braking"] = braking
    here = tpss.simulate(scenario_of(document))
    there = tpss.simulate(scenario_of(moved(document, begin_km)))
    keep_the_rules(there)
    assert_like(there, here, begin_km, same)
    ours, theirs = (r.summary["standards"]["mean_useful_voltage"] for r in (there, here))
    assert list(ours["zones_kv"].values()) == pytest.approx(list(theirs["zones_kv"].values()))


def test_a_line_from_km_438_has_no_contact_line_before_it():
    """The capacitance of 438 km more would move the energies by a hundredth: 1.619 for 1.608 MWh."""
    far = scenario_of(moved(COLD, 438.0))
    result = tpss.simulate(far.with_({"simulation.braking": "whole-steps"}))
    assert float(result.dataset.node_position.min()) == 438e3
    assert float(result.dataset.node_position.max()) == 478e3
    energy = result.summary["station_energy_mwh"]
    assert energy["W"] == pytest.approx(1.608, abs=5e-4)
    assert energy["E"] == pytest.approx(1.335, abs=5e-4)
    assert result.summary["losses_mwh"] == pytest.approx(0.060, abs=5e-4)
    assert result.summary["lowest_voltage"]["voltage_kv"] == pytest.approx(15.853, abs=5e-4)


def test_key_figures_of_zones_are_those_of_the_same_line_at_zero():
    """Without zones of one's own they are the sections between feeding stations and the line's ends."""
    document = copy.deepcopy(BUSY)
    del document["standards"]
    document["supply"]["converter_stations"][1]["position_km"] = 12.0
    here, there = (key_figures(scenario_of(each)) for each in (document, moved(document, -7.7)))
    assert there.mean_useful_voltage_kv == pytest.approx(here.mean_useful_voltage_kv, rel=SAME)
    assert there.lowest_voltage is not None
    assert here.lowest_voltage is not None
    expected_km = here.lowest_voltage.position_km - 7.7
    assert there.lowest_voltage.position_km == pytest.approx(expected_km)


def test_transformers_are_equally_spaced_from_kilometre_to_kilometre():
    """Two between 438 and 458 km: 444.667 and 451.333 km."""
    document = copy.deepcopy(SHORT_LINE)
    document["supply"]["high_voltage_line"] = {"type": "132kV", "transformers": 2}
    dataset = tpss.simulate(scenario_of(moved(document, 438.0))).dataset
    km = sorted(set((dataset.node_position.to_numpy() / 1e3).tolist()))
    assert km == pytest.approx([438.0, 438.0 + 20.0 / 3.0, 438.0 + 40.0 / 3.0, 458.0])


def test_a_mirrored_line_is_negative_kilometres():
    """From km 112.4 down to 102.4, written with minus signs: it climbs 7.4 km at 3 ‰, then falls."""
    document = copy.deepcopy(SHORT_LINE)
    document["line"] = {
        "begins_at_km": -112.4,
        "length_km": 10.0,
        "gradients": [
            {"from_km": -112.4, "permille": 3.0}, {"from_km": -105.0, "permille": -3.0}
        ],
        "speed_limits": [
            {"from_km": -112.4, "speed_kmh": 100.0}, {"from_km": -108.0, "speed_kmh": 80.0}
        ],
        "stations": [
            {"name": "West", "position_km": -112.4}, {"name": "East", "position_km": -102.4}
        ],
    }  # fmt: skip
    for station, km in zip(document["supply"]["converter_stations"], (-112.4, -102.4), strict=True):
        station["position_km"] = km
    result = tpss.simulate(scenario_of(document))
    (trip,) = result.trips[result.trips.arrival_min.notna()].itertuples()
    assert trip.distance_km == pytest.approx(10.0)
    force = result.dataset.gradient_force.to_numpy()[:, 0]
    weight_n = 1470e3 * 9.81
    assert np.nanmax(force) == pytest.approx(3e-3 * weight_n)
    assert np.nanmin(force) == pytest.approx(-3e-3 * weight_n)


@pytest.mark.parametrize(
    ("begin_km", "length_km", "end_km"),
    [(438.1, 40.2, 478.3), (0.0, math.pi, math.pi), (-0.1, 0.3, 0.2), (-2.5, 10.0, 7.5)],
)
def test_the_end_of_a_line_is_the_number_that_one_would_write(begin_km, length_km, end_km):
    assert end_of_line(begin_km, length_km) == end_km
