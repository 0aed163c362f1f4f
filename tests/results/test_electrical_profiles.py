"""Electrical profiles for OSRD, of a made-up run whose voltages are known.

The short line of 20 km at 15 kV; two trains, three steps:

    train  from  over    to      at
    up     0.0   2.0     3.5 km  14.8, 14.2 kV, then it has left
    down   20.0  19.5    19.0    15.4, 13.0 kV
"""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import tpss
from tpss.results.electrical_profiles import electrical_profiles
from tpss.results.osrd_tracks import OsrdTrack, read_tracks

from scenarios import SHORT_LINE

NAN = float("nan")


@pytest.fixture
def result() -> tpss.Result:
    """The run of the table above."""
    position_m = np.array([[0.0, 20e3], [2000.0, 19.5e3], [3500.0, 19e3], [NAN, NAN]])
    voltage_v = np.array([[14.8e3, 15.4e3], [14.2e3, 13.0e3], [NAN, NAN], [NAN, NAN]])
    there = ("time", "train")
    dataset = xr.Dataset(
        {"position": (there, position_m), "pantograph_voltage": (there, voltage_v)},
        coords={"time": 60.0 * np.arange(4), "train": ["up", "down"]},
    )
    return tpss.Result(tpss.Scenario.from_document(SHORT_LINE, "made up"), dataset, {})


def bands(document: dict[str, Any], power_class: str = "1") -> dict[str, list[tuple[float, float]]]:
    """Ranges of the only track [km] by their values."""
    return {
        level["value"]: [(part["begin"] / 1e3, part["end"] / 1e3) for part in level["track_ranges"]]
        for level in document["levels"]
        if level["power_class"] == power_class
    }


def test_a_stretch_has_the_band_that_its_voltage_does_not_fall_below(result):
    """Bands of 500 V: 14.8 kV is in that of 14.5; 14.2, and the mean of 15.4 and 13.0, of 14.0 kV."""
    document = electrical_profiles(result, band_v=500.0)
    assert bands(document) == {"14500V": [(0.0, 2.0)], "14000V": [(2.0, 4.0), (19.0, 20.0)]}


def test_the_lowest_voltage_counts_if_it_is_asked_for(result):
    document = electrical_profiles(result, band_v=500.0, lowest=True)
    assert bands(document)["13000V"] == [(19.0, 20.0)]


def test_no_band_is_above_the_nominal_voltage(result):
    """At stretches of 0.5 km the train from the end finds 15.4 kV on the first one."""
    document = electrical_profiles(result, stretch_km=0.5, band_v=500.0)
    assert bands(document)["15000V"] == [(19.5, 20.0)]
    assert bands(document)["13000V"] == [(19.0, 19.5)]


def test_bands_are_a_tenth_of_the_nominal_voltage_unless_given(result):
    """15, 13.5, 12 kV: all of the trains' voltages lie between 15 and 13.5, but the lowest one."""
    document = electrical_profiles(result, lowest=True)
    assert bands(document) == {"13500V": [(0.0, 4.0)], "12000V": [(19.0, 20.0)]}
    assert document["level_order"] == {"15000V": ["15000V", "13500V", "12000V"]}


def test_every_power_class_gets_the_same(result):
    document = electrical_profiles(result, power_classes=("1", "5"))
    assert bands(document, "5") == bands(document, "1") != {}


def test_without_tracks_a_line_is_one_in_metres(result):
    (level,) = electrical_profiles(result)["levels"]
    assert level["track_ranges"][0] == {"track": "line", "begin": 0.0, "end": 4000.0}


def test_tracks_have_their_own_positions_falling_ones_where_they_run_the_other_way(result):
    """T1 lies on km 0 to 3, and begins at 100 m; T2 on km 3 to 20, from its end to its beginning."""
    tracks = [
        OsrdTrack("line", 0.0, 3.0, "T1", 100.0, 3100.0),
        OsrdTrack("line", 3.0, 20.0, "T2", 17e3, 0),
    ]
    (level,) = electrical_profiles(result, tracks)["levels"]
    assert level["track_ranges"] == [
        {"track": "T1", "begin": 100.0, "end": 3100.0},
        {"track": "T2", "begin": 16_000.0, "end": 17_000.0},
        {"track": "T2", "begin": 0.0, "end": 1000.0},
    ]


HEADER = "line,from_km,to_km,track,begin_m,end_m\n"


def test_tracks_are_read_from_the_table_of_an_import(result, tmp_path):
    table = tmp_path / "tracks.csv"
    table.write_text(HEADER + "line,0,3,T1,100,3100\n")
    assert read_tracks(table, result.scenario.lines_by_name) == [
        OsrdTrack("line", 0.0, 3.0, "T1", 100.0, 3100.0)
    ]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("track,line\n", "has not the header"),
        (HEADER + "line,0,3,T1,100\n", "line 2 is not a track"),
        (HEADER + "line,0,x,T1,100,200\n", "line 2 is not a track"),
        (HEADER + "line,3,3,T1,100,200\n", "line 2 is not a track"),
        (HEADER + "main,0,3,T1,100,200\n", "no line main in the result; lines: line"),
        (None, "cannot be read"),
    ],
)
def test_a_table_of_something_else_is_told(result, tmp_path, text, words):
    if text is not None:
        (tmp_path / "tracks.csv").write_text(text)
    with pytest.raises(tpss.ResultError, match=words):
        read_tracks(tmp_path / "tracks.csv", result.scenario.lines_by_name)
