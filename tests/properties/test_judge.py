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


def test_a_run_that_takes_more_steps_than_was_foreseen_is_given_up():
    """One train, for five days of steps of half a minute."""
    document = held(7200.0)
    document["traffic"][0] |= {"headway_min": 1e5}
    assert MOST_STEPS < 7200.0 / 0.5
    assert judge(document) == "begun, too long to end"
