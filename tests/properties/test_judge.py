"""The judge of random scenarios takes no run to an end that does not come."""

import copy

from properties.judge import MOST_STEPS, SMALLEST, Document, judge


def held(until_min: float) -> Document:
    """A train a minute, which are held at their origin from the first minute on, up to some time."""
    document = copy.deepcopy(SMALLEST)
    document["simulation"] = {"time_step_min": 0.5}
    document["traffic"][0] |= {"headway_min": 1.0, "first_departure_min": 2.0}
    document["signalling"] = {"separation": "moving-block"}
    document["events"] = [{"kind": "restart", "held_from_min": 1.0, "at_min": until_min}]
    return document


def test_a_run_that_fills_its_line_for_longer_than_was_foreseen_is_given_up():
    """In five days there are 7200 trains at the origin, after 202 minutes more than 200."""
    assert judge(held(5.0)) == "finished"
    assert judge(held(7200.0)) == "begun, too long to end"


def test_a_limit_behind_the_first_station_holds_while_the_tail_is_under_it():
    """It begins 10 m behind the limit of 20 km/h with 300 m of train: for 290 m it may not be faster,
    though with 60 km/h at its head it could be, after a minute at full effort."""
    document = copy.deepcopy(SMALLEST)
    document["simulation"] = {"time_step_min": 1.0, "duration_min": 4.0, "motion": "stepped"}
    line = document["line"]
    line["length_km"] = 50.0
    line["stations"] = [{"name": "A", "position_km": 2.0}, {"name": "B", "position_km": 45.0}]
    limits = [(0.0, 20.0), (1.99, 60.0)]
    line["speed_limits"] = [{"from_km": km, "speed_kmh": kmh} for km, kmh in limits]
    document["trains"]["freight"]["length_m"] = 300.0
    assert judge(document) == "finished"


def test_a_run_that_takes_more_steps_than_was_foreseen_is_given_up():
    """One train, for five days of steps of half a minute."""
    document = held(7200.0)
    document["traffic"][0] |= {"headway_min": 1e5}
    assert MOST_STEPS < 7200.0 / 0.5
    assert judge(document) == "begun, too long to end"


def test_a_service_that_runs_already_and_does_not_arrive_is_not_run():
    """A machine that gives nothing at 0.1 km/h takes its train 1 km in 10 h or more: in 7200 steps of
    5 s and more."""
    document = copy.deepcopy(SMALLEST)
    document["simulation"] = {"time_step_min": 1.0 / 12.0, "duration_min": 1.0}
    document["traffic"][0]["already_running"] = True
    assert judge(document) == "finished"
    slow = {"speed_kmh": [0.0, 0.1], "force_kn": [200.0, 0.0]}
    document["trains"]["freight"] |= {"tractive_effort": slow, "power_factor": 0.9}
    assert judge(document) == "checked, too long to run"
