"""Mean useful voltage of zones and trains by EN 50388.

Steps of half a minute on a line of 10 km, one zone up to 5 km and one from there. A train's tractive
effort is positive in the steps marked with *.

    step          0      1      2      3
    train a      14.0*  13.0*  15.0   16.0     at 0, 2, 5, 8 km
    train b       -      -     12.0    -       at 4 km, for half a minute, coasting
    train c       -     13.2*  13.6*   -       at 9, 10 km

    zone 0-5 km    (14 + 13 + 12) / 3           = 13.0 kV
    zone 5-10 km   (13.2 + 15 + 13.6 + 16) / 4  = 14.45 kV
    train a        (14 + 13) / 2                = 13.5 kV
    train c        (13.2 + 13.6) / 2            = 13.4 kV, present for 60 s: the dimensioning train
"""

import numpy as np
import pytest

from tpss.results.standards.useful_voltage import (
    Section,
    dimensioning_train,
    feeding_sections,
    steps_in_window,
    train_table,
    zone_table,
)

from made_up import made_up, nan

DATASET = made_up(
    step_min=0.5,
    voltage_kv={
        "a": [14.0, 13.0, 15.0, 16.0],
        "b": [nan, nan, 12.0, nan],
        "c": [nan, 13.2, 13.6, nan],
    },
    force_kn={"a": [10.0, 5.0, 0.0, 0.0], "b": [nan, nan, 0.0, nan], "c": [nan, 1.0, 1.0, nan]},
    position_km={
        "a": [0.0, 2.0, 5.0, 8.0, 9.0],
        "b": [nan, nan, 4.0, 4.5, nan],
        "c": [nan, 9.0, 10.0, 10.0, nan],
    },
)
ZONES = [Section("first", "", 0.0, 5.0), Section("second", "", 5.0, 10.0)]
ENDS = {"": (0.0, 10.0)}
WHOLE = steps_in_window(DATASET, 0.0, None)


def test_that_of_a_zone_counts_all_trains_in_it_whatever_they_do():
    zones = zone_table(DATASET, ZONES, ENDS, WHOLE, 13.5).set_index("zone")
    assert zones.mean_useful_kv.to_dict() == pytest.approx({"first": 13.0, "second": 14.45})
    assert zones.trains.to_dict() == {"first": 2, "second": 2}
    assert zones.verdict.to_dict() == {"first": "below the minimum", "second": "reached"}


def test_that_of_a_train_counts_the_steps_in_which_it_pulls():
    trains = train_table(DATASET, WHOLE, 13.5).set_index("train")
    assert trains.mean_useful_kv[["a", "c"]].tolist() == pytest.approx([13.5, 13.4])
    assert np.isnan(trains.mean_useful_kv["b"])
    assert trains.traction_min.to_dict() == {"a": 1.0, "b": 0.0, "c": 1.0}
    assert trains.verdict.to_dict() == {"a": "reached", "b": "", "c": "below the minimum"}


def test_the_dimensioning_train_has_the_lowest_of_those_present_for_60_s():
    assert dimensioning_train(train_table(DATASET, WHOLE, None)) == ("c", pytest.approx(13.4))


def test_a_train_that_is_there_for_a_moment_does_not_count():
    """Within the second half of the run, train c is present for 30 s only."""
    window = steps_in_window(DATASET, 1.0, 2.0)
    trains = train_table(DATASET, window, 13.5).set_index("train")
    assert trains.counts.to_dict() == {"a": True, "b": False, "c": False}
    assert dimensioning_train(trains.reset_index()) is None  # train a does not pull then


def test_a_train_that_does_not_count_has_no_verdict_either():
    """Within the second minute train c pulls for 30 s, at 13.6 kV: too short to be judged by 14 kV."""
    window = steps_in_window(DATASET, 1.0, 2.0)
    trains = train_table(DATASET, window, 14.0).set_index("train")
    assert trains.mean_useful_kv["c"] == pytest.approx(13.6)
    assert trains.verdict.to_dict() == {"a": "", "b": "", "c": ""}


def test_only_the_peak_window_counts():
    zones = zone_table(DATASET, ZONES, ENDS, steps_in_window(DATASET, 0.0, 1.0), 13.5)
    assert zones.mean_useful_kv.tolist() == pytest.approx([13.5, 13.2])


@pytest.mark.parametrize("window", [(0.0, 2.5), (2.0, None), (3.0, 4.0)])
def test_a_peak_window_that_the_run_does_not_cover_gives_no_figures(window):
    steps = steps_in_window(DATASET, *window)
    assert steps is None
    assert zone_table(DATASET, ZONES, ENDS, steps, 13.5).mean_useful_kv.isna().all()
    assert train_table(DATASET, steps, 13.5).mean_useful_kv.isna().all()
    assert (train_table(DATASET, steps, 13.5).verdict == "").all()


def test_without_a_minimum_nothing_is_judged():
    assert (zone_table(DATASET, ZONES, ENDS, WHOLE, None).verdict == "").all()


@pytest.mark.parametrize(
    ("stations_km", "sections"),
    [
        ((0.0, 10.0), [("A-B", 0.0, 10.0)]),
        ((2.0, 8.0), [("0 km-A", 0.0, 2.0), ("A-B", 2.0, 8.0), ("B-10 km", 8.0, 10.0)]),
        ((8.0, 2.0), [("0 km-B", 0.0, 2.0), ("B-A", 2.0, 8.0), ("A-10 km", 8.0, 10.0)]),
    ],
)
def test_feeding_sections_lie_between_stations_and_the_line_s_ends(stations_km, sections):
    dataset = made_up(station_mw={"A": [1.0], "B": [1.0]}, stations_km=stations_km)
    expected = [(name, "", begin, end) for name, begin, end in sections]
    assert feeding_sections(dataset, ENDS) == expected
