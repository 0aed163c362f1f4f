"""Delays of departures: drawn by seed and name of a train, counted as lateness, made good at stops."""

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from tpss.run.delays import Delays

from scenarios import run, short_line

MANY = [f"train {number}" for number in range(4000)]


def test_a_share_of_the_trains_is_delayed_exponentially():
    """Of 4000 trains 20 % are delayed, give or take 0.6 % (a standard deviation), on average by 120 s.

    The mean of 800 exponential times is within 120 / √800 = 4.2 s, their standard deviation is their
    mean, and a share of e^-1 is above it.
    """
    drawn_s = np.array([Delays(120.0, 0.2, seed=1).of(name) for name in MANY])
    delayed_s = drawn_s[drawn_s > 0.0]
    assert len(delayed_s) / len(MANY) == pytest.approx(0.2, abs=0.02)
    assert delayed_s.mean() == pytest.approx(120.0, abs=13.0)
    assert delayed_s.std() == pytest.approx(120.0, abs=20.0)
    assert (delayed_s > 120.0).mean() == pytest.approx(np.exp(-1.0), abs=0.05)


def test_a_delay_is_the_same_whatever_other_trains_there_are_and_another_with_another_seed():
    first, second = ([Delays(120.0, 1.0, seed).of(name) for name in MANY[:100]] for seed in (1, 2))
    assert first == [Delays(120.0, 1.0, 1).of(name) for name in MANY[:100]]
    assert not set(first) & set(second)
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.3


CONTINUOUS = {
    "simulation.motion": "continuous", "simulation.braking": "within-step",
    "simulation.duration_min": 90.0, "simulation.time_step_min": 0.1, "traffic.0.headway_min": 5.0,
}  # fmt: skip
DELAYED = {**CONTINUOUS, "traffic.0.delays": {"mean_min": 3.0, "share": 0.5, "seed": 4}}


@pytest.mark.parametrize("motion", ["continuous", "stepped"])
def test_trains_depart_late_and_that_counts_as_lateness(motion):
    """Scheduled are 0, 5, 10, ... min; the delay is what each is later, and nothing else moves."""
    delayed = run({**DELAYED, "simulation.motion": motion})
    starts = delayed.stops[delayed.stops.kind == "start"].set_index("train")
    numbers = [int(name.rpartition(" ")[2]) for name in starts.index]
    drawn_min = np.array([Delays(180.0, 0.5, 4).of(name) for name in starts.index]) / 60.0
    if motion == "stepped":  # at the first step at or after its time
        drawn_min = np.ceil((drawn_min - 1e-9) / 0.1) * 0.1
    assert starts.scheduled_departure_min.to_numpy() == pytest.approx(
        [5.0 * (n - 1) for n in numbers]
    )
    assert starts.late_min.to_numpy() == pytest.approx(drawn_min, abs=1e-7)
    assert 0 < (drawn_min > 0.0).sum() < len(drawn_min)


def test_a_late_train_has_its_delay_until_a_stop_makes_it_good():
    """A minute is scheduled for a stop that takes no time: who is late by less leaves on time."""
    stop = {"station": "Middle", "dwell_min": 0.0, "depart_after_min": 14.0}
    table = run({**DELAYED, "traffic.0.stops": [stop]}).stops.set_index(["train", "kind"])
    delayed = 0
    for train in table.index.get_level_values("train").unique():
        start, call = table.loc[train, "start"], table.loc[train, "stop"]
        if np.isnan(call.departure_min):
            continue
        under_way_min = call.arrival_min - start.departure_min
        expected_min = max(14.0, start.late_min + under_way_min)
        assert call.departure_min - start.scheduled_departure_min == pytest.approx(expected_min)
        assert call.late_min == pytest.approx(expected_min - 14.0, abs=1e-9)
        delayed += call.late_min > 0.0
    assert delayed > 0


def test_the_studied_train_may_be_delayed_beyond_what_was_foreseen():
    """The run goes on until it arrives."""
    late = {"traffic.0.delays": {"mean_min": 300.0, "seed": 0}, "simulation.time_step_min": 0.5}
    result = run(late)
    first = result.stops.iloc[0]
    assert first.late_min > 60.0
    assert result.status == "finished"
    assert result.summary["trip_time_min"] == pytest.approx(run(
        {"simulation.time_step_min": 0.5}
    ).summary["trip_time_min"], abs=0.51)  # fmt: skip


def test_trains_that_run_already_and_services_without_delays_are_on_time():
    changes = {**DELAYED, "traffic.0.already_running": True}
    running = run(changes).dataset
    on_time = run({**changes, "traffic.0.delays": None}).dataset
    placed = np.isnan(running.departure_time.to_numpy())
    assert placed.sum() > 0
    assert (
        running.position.to_numpy()[0, placed].tolist()
        == on_time.position.to_numpy()[0, placed].tolist()
    )
    assert np.isnan(running.departure_delay.to_numpy()[placed]).all()
    assert np.nansum(on_time.departure_delay) == 0.0


@pytest.mark.parametrize(
    ("key", "value"), [("mean_min", 0.0), ("share", 1.5), ("seed", 0.5), ("mean_min", None)]
)
def test_delays_that_cannot_be(key, value):
    delays = {"mean_min": 2.0, "share": 0.2, "seed": 1, key: value}
    given = {name: each for name, each in delays.items() if each is not None}
    assert finding_at(f"traffic.0.delays.{key}", faults_of({"traffic.0.delays": given}))


def test_delays_of_a_timetable_are_those_of_each_of_its_trains(tmp_path):
    (tmp_path / "times.csv").write_text(
        "name,station,departure\na,West,1.0\na,East,\nb,West,2.0\nb,East,\n"
    )
    document = short_line().as_document() | {"traffic": []}
    document["timetables"] = [
        {"file": "times.csv", "train": "freight", "delays": {"mean_min": 2.0}}
    ]
    read = tpss.Scenario.from_document(document, tmp_path / "line.toml")
    assert [entry.delays.mean_min for entry in read.traffic] == [2.0, 2.0]
    table = tpss.simulate(read.with_({"simulation.duration_min": 30.0})).stops
    late_min = table.late_min[table.kind == "start"].tolist()
    expected_min = [Delays(120.0, 1.0, 0).of(name) / 60.0 for name in ("a", "b")]
    assert sorted(late_min) == pytest.approx(sorted(expected_min), abs=0.051)
    with pytest.raises(tpss.ScenarioError, match=r"timetables\.0\.delays\.share"):
        read.with_({"timetables.0.delays.share": 2.0})
