"""Records: fields from annotations, rows that accept no other names, nested records as views."""

from enum import IntEnum
from typing import Annotated, Any

import numpy as np
import pytest

from tpss.kernel import kernel
from tpss.record import Record, copy_of_records


class Colour(IntEnum):
    RED = 0
    BLUE = 7


class Point(Record):
    x_m: float
    y_m: float = 2.5


class Named(Record):
    number: int
    colour: Colour


class Track(Named):
    begin: Point
    end: Point = Point.row(x_m=9.0)
    open: bool = False
    phasor: complex = 1j
    weight: Annotated[np.ndarray[Any, Any], (2, 3)] = ((0.0,) * 3,) * 2


ROW = {"number": 3, "colour": Colour.BLUE, "begin": Point.row(x_m=1.0, y_m=0.0)}


def test_fields_are_the_annotations_those_of_a_base_class_first():
    assert Track.dtype.names == ("number", "colour", "begin", "end", "open", "phasor", "weight")
    types = [Track.dtype[name].base for name in Track.dtype.names]
    assert types == [np.int64, np.int64, Point.dtype, Point.dtype, np.bool_, complex, float]
    assert Track.dtype["weight"].shape == (2, 3)


def test_a_row_has_its_values_in_the_order_of_the_fields_and_its_defaults():
    assert Point.row(x_m=1.0) == (1.0, 2.5)
    assert Point.row(y_m=1.0, x_m=4.0) == (4.0, 1.0)
    row = Track.array([Track.row(**ROW)])[0]
    assert (row.number, row.colour, row.open, row.phasor) == (3, Colour.BLUE, False, 1j)
    assert (row.begin.x_m, row.begin.y_m, row.end.x_m, row.end.y_m) == (1.0, 0.0, 9.0, 2.5)


@pytest.mark.parametrize(
    ("values", "names"),
    [
        ({**ROW, "colours": 1}, r"unknown fields \['colours'\], missing fields \[\]"),
        ({"number": 1}, r"unknown fields \[\], missing fields \['colour', 'begin'\]"),
        ({**ROW, "dtype": 1}, r"unknown fields \['dtype'\]"),
        ({**ROW, "x_m": 1.0}, r"unknown fields \['x_m'\]"),  # of a nested record
    ],
)
def test_a_row_refuses_names_that_it_does_not_know_and_asks_for_those_that_it_lacks(values, names):
    with pytest.raises(TypeError, match="Track: .*" + names):
        Track.row(**values)


def test_a_nested_record_is_a_part_of_the_array_and_not_a_copy():
    tracks = Track.blank(2)
    tracks[1].begin.x_m = 5.0
    tracks.end.y_m = [1.0, 2.0]
    tracks[0].weight[1, 2] = 8.0
    assert tracks.begin.x_m.tolist() == [0.0, 5.0]
    assert [track.end.y_m for track in tracks] == [1.0, 2.0]
    assert tracks["weight"][0, 1].tolist() == [0.0, 0.0, 8.0]


def test_compiled_code_writes_into_the_part_that_it_is_handed():
    @kernel
    def shift(point: Point) -> None:
        point.x_m += 1.5

    tracks = Track.array([Track.row(**ROW)] * 2)
    shift(tracks[1].begin)
    assert tracks.begin.x_m.tolist() == [1.0, 2.5]


def test_blank_records_are_zero_and_have_any_shape():
    assert Track.blank(2, 3).shape == (2, 3)
    assert not Track.blank(1)[0].end.y_m


def test_a_copy_does_not_share_its_memory():
    tracks = Track.array([Track.row(**ROW)])
    copied = copy_of_records(tracks)
    tracks[0].begin.x_m = 7.0
    assert copied.dtype == tracks.dtype
    assert copied[0].begin.x_m == 1.0
    assert (copied[0].number, copied[0].phasor) == (3, 1j)
