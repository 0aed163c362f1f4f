"""Times of the clock: minutes counted from `simulation.starts_at`, in scenarios and in results."""

import pytest

from faults import faults_of, finding_at
from tpss.results.stops import punctuality
from tpss.scenario.clock import clock_at, seconds_of

from scenarios import run, short_line

AT_HALF_PAST_FIVE = {"simulation.starts_at": "05:30"}


@pytest.mark.parametrize(
    ("text", "time_s"),
    [("00:00", 0), ("05:30", 19_800), ("6:12:30", 22_350), ("25:35:00", 92_100), ("101:00", 363_600)],
)  # fmt: skip
def test_a_time_of_the_clock_in_seconds_from_midnight(text, time_s):
    """6 h 12 min 30 s are 21600 + 720 + 30 s; 25:35 is 1:35 on the following day."""
    assert seconds_of(text) == time_s


@pytest.mark.parametrize("text", ["", "5", "05:60", "05:30:61", "05.30", "-1:00", "05:30 ", "0530"])
def test_what_is_no_time_of_the_clock(text):
    assert seconds_of(text) is None


def test_the_clock_shows_whole_seconds_and_goes_on_beyond_midnight():
    """From 23:30, 42.51 min later it is 24:12:30.6, so 24:12:31."""
    assert clock_at(42.51, 23.5 * 3600) == "24:12:31"
    assert clock_at(float("nan"), 0.0) == ""


def test_departures_by_the_clock_are_minutes_from_the_start():
    """06:12:30 is 42.5 min after 05:30, and 25:00 is 19.5 h after it; minutes may stand beside them."""
    scenario = short_line(
        {
            **AT_HALF_PAST_FIVE,
            "traffic.0.headway_min": None,
            "traffic.0.departures_min": [1.0, "06:12:30", "25:00"],
        }
    )
    assert scenario.traffic[0].departures_min == (1.0, 42.5, 1170.0)
    first = {**AT_HALF_PAST_FIVE, "traffic.0.first_departure_min": "05:31"}
    assert short_line(first).traffic[0].first_departure_min == 1.0


def test_a_scenario_by_the_clock_is_the_same_as_one_in_minutes():
    by_the_clock = short_line({**AT_HALF_PAST_FIVE, "traffic.0.first_departure_min": "05:40"})
    in_minutes = short_line({**AT_HALF_PAST_FIVE, "traffic.0.first_departure_min": 10.0})
    assert by_the_clock == in_minutes
    assert (
        by_the_clock.with_({"simulation.starts_at": "05:35"}).traffic[0].first_departure_min == 5.0
    )


def test_times_at_stops_are_shown_by_the_clock_too():
    """Departure at 05:33; 10 km there and 10 km on: whatever the minutes are, the clock is 330 ahead."""
    changes = {"traffic.0.first_departure_min": 3.0, "traffic.0.arrive_after_min": 15.0}
    table = run({**AT_HALF_PAST_FIVE, **changes}).stops
    assert table.departure_clock[0] == "05:33:00"
    assert table.scheduled_arrival_clock[1] == "05:48:00"
    assert table.arrival_clock[1] == clock_at(330.0 + table.arrival_min[1], 0.0)
    assert table.arrival_clock[0] == ""
    words = f"most by eastbound 1 at East, {table.late_min[1]:.2f} min ({table.arrival_clock[1]})"
    assert punctuality(table)[0].endswith(words)
    assert "arrival_clock" not in run(changes).stops


def test_a_single_train_has_the_name_of_its_service():
    single = {"traffic.0.headway_min": None, "traffic.0.departure_min": 2.0}
    result = run(single)
    assert result.dataset.train.values.tolist() == ["eastbound"]
    assert result.summary["studied_train"] == "eastbound"
    assert result.stops.departure_min[0] == 2.0


def test_a_single_train_may_not_have_the_name_of_another_one():
    single = {
        "name": "eastbound 2",
        "train": "freight",
        "from": "West",
        "to": "East",
        "departure_min": 2.0,
    }
    named = short_line({"traffic.+": {**single, "name": "eastbound two"}})
    assert named.traffic[1].name == "eastbound two"
    findings = faults_of({"traffic.+": {**single, "to": "Middle"}})
    assert (
        "whose name a train of another service has"
        in finding_at("traffic.1.name", findings).problem
    )


@pytest.mark.parametrize(
    ("start", "departure", "problem", "remedy"),
    [
        (None, "06:00", "of which minute 0 is not known", "add starts_at"),
        (
            "06:00",
            "05:59:59",
            "before the start of the simulation, at 06:00:00",
            "go on with 29:00",
        ),
        ("06:00", "6 pm", "neither a number of minutes nor a time of the clock", "HH:MM"),
    ],
)
def test_departures_that_cannot_be_told_by_the_clock(start, departure, problem, remedy):
    changes = {"simulation.starts_at": start, "traffic.0.first_departure_min": departure}
    finding = finding_at("traffic.0.first_departure_min", faults_of(changes))
    assert problem in finding.problem
    assert remedy in finding.remedy
    assert finding.value == repr(departure)


@pytest.mark.parametrize("start", ["24:00", "5h30", 5.5])
def test_the_clock_at_the_start_is_that_of_a_day(start):
    finding = finding_at("simulation.starts_at", faults_of({"simulation.starts_at": start}))
    assert finding.problem in ("not a time of the clock", "not text")
