"""Stretches of contact line that no feeding station reaches."""

from typing import Any

from lines import STAR, double_track, network, scenario_of, service
from tpss.model.unfed import unfed_in_words, unfed_stretches

UP = service("up", "West", "East")


def star(*breaks: tuple[str, float, bool], **more: Any) -> Any:
    """A main line of 60 km, fed at its beginning, with a branch of 30 km 20 km before its end."""
    document = network(STAR, [UP], **more)
    document["supply"]["section_breaks"] = [
        {"name": name, "line": "main", "position_km": km, "closed": closed}
        for name, km, closed in breaks
    ]
    return scenario_of(document)


def test_where_all_is_tied_a_single_station_feeds_all():
    assert unfed_stretches(star(("B", 30.0, True))) == []
    assert unfed_in_words(star()) == ""


def test_behind_an_open_break_lines_are_without_a_source():
    scenario = star(("B", 30.0, False))
    assert unfed_stretches(scenario) == [("main", 30.0, 60.0, 0), ("branch", 100.0, 130.0, 0)]
    assert unfed_in_words(scenario) == (
        "no feeding station reaches main 30-60 km; branch 100-130 km: trains have no voltage there, "
        "coast and brake; close B, or add a feeding station there to feed them"
    )


def test_between_two_open_breaks_a_stretch_is_without_a_source():
    station = {"name": "end", "line": "main", "position_km": 60.0, "type": "Q48/Q49"}
    document = network(STAR, [UP])
    document["supply"]["converter_stations"].append({**station, "converters": 1})
    document["supply"]["section_breaks"] = [
        {"name": str(km), "line": "main", "position_km": km, "closed": False} for km in (10.0, 30.0)
    ]
    assert unfed_stretches(scenario_of(document)) == [("main", 10.0, 30.0, 0)]


def test_a_track_that_is_out_is_told_alone():
    """From 10 to 20 km of track 2, of two that are tied nowhere but at their ends."""
    document = double_track("no")
    out = {"line": "main", "track": 2, "from_km": 10.0, "to_km": 20.0}
    document["outages"] = [{"name": "maintenance", "sections": [out]}]
    document["simulation"]["outage"] = "maintenance"
    (found,) = unfed_stretches(scenario_of(document))
    assert (found.from_km, found.to_km, found.track) == (10.0, 20.0, 2)
    words = unfed_in_words(scenario_of(document))
    assert words.startswith("no feeding station reaches 10-20 km, track 2: ")
    assert "add a feeding station" not in words


def test_what_an_outage_leaves_for_a_time_is_told():
    document = network(STAR, [UP])
    document["outages"] = [
        {"name": "out", "stations": ["feeder"], "from_min": 20.0, "to_min": 30.0}
    ]
    document["simulation"]["outage"] = "out"
    assert [each.line for each in unfed_stretches(scenario_of(document))] == ["main", "branch"]
