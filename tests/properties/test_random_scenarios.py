"""Random scenarios end in one of four ways: a result, an early end that says why, findings, a refusal.

Never in another exception, in values that are not numbers, in a hang, or in a root of the load flow
other than the one that loads raised from zero lead to.  The same cases are drawn every time;
`campaign` draws others, as many as one likes.
"""

from collections import Counter
from random import Random
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

import tpss

from properties.crowds import crowded_scenarios
from properties.judge import judge, warm_up
from properties.junctions import junctions
from properties.own_laws import scenarios_by_own_laws
from properties.phases import scenarios_at_phases
from properties.strategies import direct_scenarios, sound_scenarios, spoilt_scenarios
from properties.together import judge_together, like_cases

CASES = settings(
    max_examples=200,
    derandomize=True,
    database=None,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)


@pytest.fixture(scope="module", autouse=True)
def _compiled() -> None:
    warm_up()


def test_sound_scenarios_run_by_the_rules_or_say_why_not():
    """Trains may be placed too fast, lines overloaded, hills too steep; nothing else goes wrong."""
    outcomes: Counter[str] = Counter()

    @CASES
    @given(sound_scenarios())
    def look(document: dict[str, Any]) -> None:
        outcomes[judge(document)] += 1

    look()
    cases = sum(outcomes.values())
    assert cases >= 200
    assert outcomes["finished"] > cases / 3
    assert outcomes["stalled"] > cases / 50
    assert outcomes["collapsed"] > cases / 50


def test_stations_at_phases_of_a_grid_run_by_the_rules_or_say_why_not():
    """Stations that share a grid's impedance, or feed both sides of a neutral section; some are out."""
    outcomes: Counter[str] = Counter()

    @settings(CASES, max_examples=60)
    @given(scenarios_at_phases())
    def look(document: dict[str, Any]) -> None:
        outcomes[judge(document)] += 1

    look()
    cases = sum(outcomes.values())
    assert cases >= 60
    assert outcomes["finished"] > cases / 3


def test_trains_that_meet_on_single_tracks_all_come_through():
    """Whoever waits goes on: nobody is in anybody's way for ever, however few tracks there are."""
    outcomes: Counter[str] = Counter()

    @settings(CASES, max_examples=100)
    @given(crowded_scenarios())
    def look(document: dict[str, Any]) -> None:
        outcomes[judge(document)] += 1

    look()
    assert outcomes["finished"] > 0.9 * sum(outcomes.values())
    assert "deadlocked" not in outcomes


def test_trains_that_meet_at_junctions_of_few_tracks_all_come_through():
    """However they follow each other where they wait on one track, for different ways."""
    for seed in range(40):
        document = junctions(Random(seed))
        result = tpss.simulate(tpss.Scenario.from_document(document, "junctions"))
        assert result.status == "finished", (seed, result.summary.get("problem"))
        assert result.trips.arrival_min.notna().all(), seed


def test_railways_of_direct_current_run_by_the_rules_or_say_why_not():
    """The same lines and traffic, fed by rectifiers that block where trains feed back."""
    outcomes: Counter[str] = Counter()

    @settings(CASES, max_examples=60)
    @given(direct_scenarios())
    def look(document: dict[str, Any]) -> None:
        outcomes[judge(document)] += 1

    look()
    assert outcomes["finished"] > sum(outcomes.values()) / 3, outcomes


def test_laws_of_one_s_own_run_by_the_rules_or_say_why_not():
    """The same lines and traffic, with drivers, resistances and stations by registered laws."""
    outcomes: Counter[str] = Counter()

    @settings(CASES, max_examples=40)
    @given(scenarios_by_own_laws(sound_scenarios()))
    def look(document: dict[str, Any]) -> None:
        outcomes[judge(document)] += 1

    look()
    assert outcomes["finished"] > sum(outcomes.values()) / 4, outcomes


def test_like_cases_come_out_the_same_in_lanes_and_alone():
    """Six masses and headways of each; most of the others have too few steps to be worth lanes."""
    outcomes: Counter[str] = Counter()

    @settings(CASES, max_examples=40)
    @given(like_cases(sound_scenarios()))
    def look(document: dict[str, Any]) -> None:
        outcomes[judge_together(document)] += 1

    look()
    assert outcomes["6 of 6 in lanes"] > 4, outcomes


def test_spoilt_scenarios_lead_to_findings_or_run_by_the_rules():
    outcomes: Counter[str] = Counter()

    @CASES
    @given(spoilt_scenarios())
    def look(document: dict[str, Any]) -> None:
        outcomes[judge(document).split(":")[0]] += 1

    look()
    cases = sum(outcomes.values())
    assert cases >= 200
    assert outcomes["finding"] > cases / 2
