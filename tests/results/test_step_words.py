"""What is said of a time step, from the summary of a run."""

import pytest

from tpss.results.step_words import step_lines, step_warnings


def change(figure, of, here, finer, share, within=True):
    return {"figure": figure, "of": of, "at_step": here, "at_half_step": finer, "share": share,
            "limit": 0.02 if figure in ("lowest_voltage_kv", "peak_loading") else 0.01,
            "within": within}  # fmt: skip


def summary(*changes, status="finished", choice=None, **check):
    """Of a run of 12 min in steps of 0.5 min, and its check."""
    made = {
        "half_step_min": 0.25, "status": "finished", "duration_min": 12.0, "changes": list(changes),
        "within": all(each["within"] for each in changes), "tried_min": [], "would_do_min": None,
        "not_made": None, **check,
    }  # fmt: skip
    return {"status": status, "duration_min": 12.0, "time_step_min": 0.5, "step_check": made,
            "step_choice": choice}  # fmt: skip


SMALL = (
    change("trip_time_min", "eastbound 1", 10.0, 10.02, 0.002),
    change("mean_trip_min", "eastbound", 10.0, 10.02, 0.002),
    change("total_energy_mwh", "", 2.0, 2.002, 0.001),
    change("lowest_voltage_kv", "eastbound 1", 14.5, 14.496, -0.002),
    change("peak_loading", "West", 0.5, 0.5, 0.0),
)


def test_each_change_is_told_in_the_unit_in_which_it_is_understood():
    assert step_lines(summary(*SMALL)) == [
        "At half the step (0.25 min): trip +0.02 min, energy +0.1 %, lowest voltage −4 V, "
        "peak loading ±0.0 %"
    ]
    assert step_warnings(summary(*SMALL)) == []


def test_changes_beyond_their_limits_are_told_the_largest_of_each_kind_first():
    beyond = (
        change("trip_time_min", "eastbound 1", 10.0, 10.2, 0.02, within=False),
        change("mean_trip_min", "westbound", 10.0, 9.5, -0.05, within=False),
        change("total_energy_mwh", "", 2.0, 2.03, 0.015, within=False),
        change("lowest_voltage_kv", "eastbound 1", 14.5, 14.44, -0.03, within=False),
    )
    (told,) = step_warnings(summary(*beyond, tried_min=[0.25, 0.125], would_do_min=0.125))
    assert told == (
        "the step of 0.5 min is too long: at half of it (0.25 min) the mean trip of westbound moves "
        "by −5.0 %, the lowest voltage moves by −3.0 % of its drop and the energy moves by +1.5 %, "
        "more than 1 %; a step of 0.125 min would do"
    )


@pytest.mark.parametrize(
    ("tried_min", "remedy"),
    [
        ([0.25, 0.125], "none of the shorter ones tried would do (0.25, 0.125 min)"),
        ([], "a shorter one was not tried, as such a run takes long"),
    ],
)
def test_that_no_step_would_do_is_told(tried_min, remedy):
    trip = change("trip_time_min", "eastbound 1", 10.0, 10.2, 0.02, within=False)
    (told,) = step_warnings(summary(trip, tried_min=tried_min))
    assert told.endswith(f"the trip of eastbound 1 moves by +2.0 %, more than 1 %; {remedy}")


def test_a_step_that_decides_how_the_run_ends_is_told():
    found = summary(status="stalled", within=False, tried_min=[0.25], would_do_min=0.25)
    assert step_lines(found) == ["At half the step (0.25 min) the run finishes"]
    assert step_warnings(found) == [
        "the step of 0.5 min decides how the run ends: with it a train stalls at 12.00 min, at half "
        "of it the run finishes; a step of 0.25 min would do"
    ]


def test_ends_that_differ_in_time_only_are_told():
    end = change("duration_min", "", 12.0, 13.0, 0.083, within=False)
    found = summary(end, status="collapsed", would_do_min=0.125)
    found["step_check"] |= {"status": "collapsed", "duration_min": 13.0}
    assert step_lines(found) == [
        "At half the step (0.25 min) the line cannot carry its load at 13.00 min"
    ]
    assert "(0.25 min) the end of the run moves by +8.3 %, more than 1 %" in step_warnings(found)[0]


def test_why_there_is_no_check_is_told():
    found = summary(not_made="it was interrupted", within=None, status=None)
    assert step_lines(found) == ["No step check: it was interrupted"]
    assert step_warnings(found) == []


CLOSE = "within 0.3 % of the run at half of it"


@pytest.mark.parametrize(
    ("tried_min", "within", "how"),
    [
        ([1.0, 0.5], True, f"the longest one tried that keeps {CLOSE}"),
        ([1.0, 0.5], False, f"the shortest one tried, and none keeps {CLOSE}"),
        ([], False, "as the run takes too long for steps to be tried"),
    ],
)
def test_how_a_step_was_chosen_is_told(tried_min, within, how):
    choice = {"tried_min": tried_min, "largest_share": 0.003, "within": within}
    assert step_lines(summary(*SMALL, choice=choice))[0] == f"Time step: 0.5 min, {how}"


def test_results_saved_before_say_nothing():
    assert step_lines({"time_step_min": 0.5, "status": "finished"}) == []
    assert step_warnings({"time_step_min": 0.5, "status": "finished"}) == []
