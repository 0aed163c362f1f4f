"""Trains that are held at stations, to start all at once: where the supply is asked for most."""

from typing import Any

import numpy as np
import pytest

import tpss
from lines import line, network, run, scenario_of, service
from tpss.step.state import TrainState

HELD_MIN, RESTART_MIN = 20.0, 45.0


def crowd(**event: Any) -> dict[str, Any]:
    """Trains of 100 km/h at every 8 min up 60 km with stations every 10 km, fed at both ends."""
    stations = {f"S{k}": 10.0 * k for k in range(7)}
    traffic = [service("up", "S0", "S6", departures_min=[0.0, 8.0, 16.0, 24.0])]
    document = network({"main": line(60.0, stations)}, traffic)
    end = {"name": "end", "line": "main", "position_km": 60.0, "type": "Q48/Q49", "converters": 3}
    document["supply"]["converter_stations"].append(end)
    document["signalling"] = {"separation": "moving-block"}
    restart = {"kind": "restart", "held_from_min": HELD_MIN, "at_min": RESTART_MIN, **event}
    return {**document, "events": [restart]}


def test_trains_stop_at_their_next_stations_and_start_at_once():
    """At 20 min the first is past 30 km and the second past 15: they stop at 40 and 20 km, the third,
    which has left at 16, at 10 km; the fourth stays where it begins.
    """
    result = run(crowd())
    data = result.dataset
    last = round(RESTART_MIN / 0.1)
    there_km = data.position.to_numpy()[last] / 1e3
    np.testing.assert_allclose(there_km, [40.0, 20.0, 10.0, 0.0], atol=1e-6)
    assert (data.speed.to_numpy()[last] == 0.0).all()
    assert (data.speed.to_numpy()[last + 1] > 0.0).all()
    assert len(result.waits) == 0


def test_the_restart_asks_for_more_than_trains_at_their_times():
    held, free = run(crowd()), run({key: part for key, part in crowd().items() if key != "events"})
    peaks = [float(np.nanmax(each.dataset.active_power.sum("train"))) for each in (held, free)]
    assert peaks[0] > 1.2 * peaks[1]


def test_a_train_that_cannot_stop_at_the_next_station_any_more_stops_at_the_one_after_it():
    """The first train is 200 m before S3, at 30 km, at the time from which trains are held."""
    free = run({key: part for key, part in crowd().items() if key != "events"})
    km = free.dataset.position.to_numpy()[:, 0] / 1e3
    from_min = float(np.interp(29.8, km[:300], free.dataset.time[:300])) / 60.0
    result = run(crowd(held_from_min=from_min))
    assert result.dataset.position.to_numpy()[440, 0] / 1e3 == pytest.approx(40.0, abs=1e-6)
    assert result.summary["limited"]["too_near"] == 0


def test_trains_of_other_lines_go_on():
    document = crowd(lines=["main"])
    document["lines"]["other"] = line(20.0, {"T0": 0.0, "S3": 20.0})
    document["traffic"].append(service("other", "T0", "S3", departures_min=[22.0]))
    state = run(document).dataset.train_state.sel(train="other 1").to_numpy()
    assert (state[round(36.0 / 0.1) :] == TrainState.ABSENT).all()
    assert (state == TrainState.MOTORING).any()


def test_before_and_after_an_event_nothing_is_other_than_without_it():
    late = run(crowd(held_from_min=85.0, at_min=89.0))
    free = run({key: part for key, part in crowd().items() if key != "events"})
    for name in ("route_position", "pantograph_voltage"):
        np.testing.assert_array_equal(late.dataset[name][:850], free.dataset[name][:850])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"at_min": 10.0}, r"let at_min be later than held_from_min"),
        ({"lines": ["mian"]}, r"events\.0\.lines\.0 = 'mian'\n.*no such line\n.*did you mean main"),
        ({"kind": "stop"}, r"events\.0\.kind"),
        ({"at_min": "06:00"}, r"starts_at"),
    ],
)
def test_faults_of_events_are_told(change, words):
    with pytest.raises(tpss.ScenarioError, match=words):
        scenario_of(crowd(**change))


def test_trains_that_see_nobody_cannot_be_held():
    document = crowd()
    del document["signalling"]
    with pytest.raises(tpss.ScenarioError, match=r"moving-block"):
        scenario_of(document)
