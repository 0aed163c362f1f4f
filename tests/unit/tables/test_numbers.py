"""What begins the decimals of a column: found from all of it, or refused, never guessed."""

import math

import pytest

from tpss.tables.numbers import COMMA, POINT, number, plain, readings_of, signs_of

ANY = (-1e9, 1e9)


@pytest.mark.parametrize(
    ("text", "sign", "value"),
    [
        ("1.5", POINT, 1.5), ("1,5", COMMA, 1.5), ("-.5", POINT, -0.5), ("7.", POINT, 7.0),
        ("1,234.5", POINT, 1234.5), ("1.234.567,8", COMMA, 1234567.8), ("+3e2", POINT, 300.0),
        ("1234", COMMA, 1234.0),
    ],
)  # fmt: skip
def test_numbers(text, sign, value):
    assert number(text, sign) == value


@pytest.mark.parametrize(
    "text", ["", "-", ".", "1,5", "1,23,456.0", "0,123.4", "1 km", "nan", "1.2.3"]
)
def test_what_is_no_number_with_a_decimal_point(text):
    assert math.isnan(number(text, POINT))


@pytest.mark.parametrize("space", [" ", "\u00a0", "\u2009", "\u202f", "'", "\u2019"])
def test_spaces_and_apostrophes_may_part_thousands(space):
    assert plain(f"1{space}234{space}567") == "1234567"
    assert plain(f"12{space}34") == f"12{space}34"


@pytest.mark.parametrize("minus", "-\u2212\u2013\u2010\uff0d")
def test_a_minus_may_be_that_of_typography(minus):
    assert plain(f"{minus}3") == "-3"


@pytest.mark.parametrize(
    ("texts", "possible"),
    [
        (["1", "20"], (POINT, COMMA)),
        (["1.5", "1.234"], (POINT,)),
        (["1,234", "12,34"], (COMMA,)),
        (["0,500"], (COMMA,)),
        (["1.234,5"], (COMMA,)),
        (["1,234", "2,345"], (POINT, COMMA)),
        (["1.5", "2,5"], ()),
        (["steep", "1.5"], (POINT,)),
    ],
)
def test_a_column_as_a_whole_says_how_it_is_read(texts, possible):
    assert readings_of(texts).possible == possible


def signs(columns, separator=";", **ranges):
    return signs_of(columns, separator, {name: ranges.get(name, ANY) for name in columns})


def test_a_column_that_does_not_say_is_read_as_the_others_and_that_is_told():
    found, (note,) = signs({"km": ["1,234"], "v": ["80,5"]})
    assert found == {"km": COMMA, "v": COMMA}
    assert note == "km is read with a decimal comma, as in the other columns: 1,234 is 1.234"


def test_a_column_that_only_one_reading_leaves_in_range_is_read_so_and_that_is_told():
    found, (note,) = signs({"km": ["1,234", "12,345"]}, km=(0.0, 1e4))
    assert found == {"km": COMMA}
    assert "out of range" in note


def test_a_column_that_nothing_decides_has_no_sign():
    assert signs({"km": ["1,234", "2,345"], "v": ["80", "90"]}) == ({"v": POINT}, [])


def test_columns_parted_by_commas_have_decimal_points():
    assert signs({"km": ["1.234", "2.345"]}, ",") == ({"km": POINT}, [])


def test_columns_that_differ_are_told():
    found, (note,) = signs({"km": ["1.5"], "h": ["2,5"]})
    assert found == {"km": POINT, "h": COMMA}
    assert note == "columns differ in their decimals: decimal points in km and decimal commas in h"
