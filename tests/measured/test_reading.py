"""Files as recorders and spreadsheets write them, and faults that say where they are and what to do."""

import numpy as np
import pytest

import tpss

from measured_files import EAST_MW, WEST_MW, in_minutes, made_up_result
from scenarios import run

WEST = "station_active_power:West [MW]"
VALUES = ["0", "2", "4", "6", "3", "1", "5", "2", "0", "1"]


def compare(result, path, **options):
    return tpss.compare_with_measurements(result, path, **options)


def error_of(result, path, **options):
    """Sum of squared errors of the first series, in MW²."""
    measured, simulated = compare(result, path, **options).series[0].both
    return float(np.nansum((simulated - measured) ** 2))


def at(times, heading="time", separator=",", values=VALUES):
    rows = [f"{time}{separator}{value}" for time, value in zip(times, values, strict=False)]
    return "\n".join([f"{heading}{separator}{WEST}", *rows]) + "\n"


def clock(*, seconds=True, first=(6, 0)):
    minutes = [60 * first[0] + first[1] + k for k in range(10)]
    return [f"{m // 60 % 24:02d}:{m % 60:02d}{':00' if seconds else ''}" for m in minutes]


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_separators(result, file, separator):
    path = file(at(range(10), "time [min]", separator))
    assert error_of(result, path) == 0.0


def test_a_mark_of_the_byte_order_comments_blank_lines_and_line_ends_of_windows(result, file):
    text = "# recorder 7\n\n" + at(range(10), "time [min]") + "\n\n"
    path = file(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert error_of(result, path) == 0.0


def test_decimal_commas_beside_semicolons(result, file):
    values = [f"{value},0" for value in VALUES]
    path = file(at(range(10), "time [min]", ";", values))
    assert error_of(result, path) == 0.0


def test_commas_that_may_part_thousands_are_told(result, file):
    values = [f"{value},000" for value in VALUES[1:4]]
    found = compare(result, file(at(range(3), "time [min]", ";", values)))
    assert any("1,234 as 1.234" in note for note in found.notes)
    values[0] = "2,00"
    found = compare(result, file(at(range(3), "time [min]", ";", values)))
    assert not any("1,234 as 1.234" in note for note in found.notes)


def test_lines_that_end_with_a_separator(result, file):
    path = file(at(range(10), "time [min]", ";").replace("\n", ";\n"))
    assert error_of(result, path) == 0.0


def test_windows_1252_is_read_and_told(result, file):
    text = at(range(10), "time [min]").replace("time [min]", "time [min],Ort")
    text = "\n".join(
        line if k == 0 else line.replace(",", ",Müllheim,", 1)
        for k, line in enumerate(text.split("\n"))
    )
    columns = file('ignore = ["Ort"]\n', "columns.toml")
    found = compare(result, file(text.encode("cp1252")), columns=columns)
    assert "measured.csv is not UTF-8 and was read as Windows-1252" in found.notes


@pytest.mark.parametrize("seconds", [True, False])
def test_times_of_the_clock_follow_the_scenario_s_start(file, seconds):
    path = file(at(clock(seconds=seconds)))
    assert error_of(made_up_result("06:00"), path) == 0.0
    assert compare(made_up_result("05:58"), path).grid.begin_s == 120.0


def test_times_of_the_clock_go_on_over_midnight(file):
    found = compare(made_up_result("23:55"), file(at(clock(first=(23, 55)))))
    assert found.series[0].compared == 10
    assert found.aligned.clock.tolist()[-1] == "24:04:00"


def test_a_file_that_begins_after_midnight_meets_a_run_that_began_before(file):
    path = file(at(clock(first=(0, 1)), values=VALUES[6:]))
    assert error_of(made_up_result("23:55"), path) == 0.0


def test_begins_says_what_the_clock_shows_at_minute_0(result, file):
    path = file(at(clock()))
    assert error_of(result, path, begins="06:00") == 0.0
    assert error_of(made_up_result("12:00"), path, begins="06:00:00") == 0.0


def test_an_offset_may_be_looked_for_without_a_known_begin(result, file):
    found = compare(result, file(at(clock())), find_offset_min=3.0)
    assert found.offset.seconds == 0.0
    assert any("looked for around a begin at the first time" in note for note in found.notes)


def dated(zone="", day="2026-03-02"):
    return [f"{day}T{time}{zone}" for time in clock()]


@pytest.mark.parametrize("zone", ["", "Z", "+01:00", "-0330"])
def test_dates_with_or_without_a_zone(file, zone):
    found = compare(made_up_result("06:00"), file(at(dated(zone))))
    assert found.series[0].compared == 10
    assert found.begins == "2026-03-02 06:00:00"
    assert any("first zone" in note for note in found.notes) == bool(zone)


def test_a_clock_that_is_put_forward_in_spring_makes_no_gap(file):
    """01:59 in winter time is followed by 03:00 in summer time, a minute later."""
    times = [f"2026-03-29T01:{55 + k}:00+01:00" for k in range(5)]
    times += [f"2026-03-29T03:0{k}:00+02:00" for k in range(5)]
    assert error_of(made_up_result("01:55"), file(at(times))) == 0.0


def test_of_several_days_one_is_taken_and_told(file):
    """A second day with 1 MW more: the first one is as near, and taken unless one is named."""
    more = [str(float(value) + 1.0) for value in VALUES]
    times = [*dated(), *dated(day="2026-03-03")]
    path = file(at(times, values=[*VALUES, *more]))
    first = compare(made_up_result("06:00"), path)
    assert first.begins == "2026-03-02 06:00:00"
    assert any("on 2 days" in note and "--begins with a date" in note for note in first.notes)
    assert error_of(made_up_result("06:00"), path) == 0.0
    assert error_of(made_up_result(), path, begins="2026-03-03T06:00") == pytest.approx(10.0)


@pytest.mark.parametrize(("unit", "length"), [("s", 60.0), ("min", 1.0), ("h", 1.0 / 60.0)])
def test_times_that_are_counted_need_their_unit(result, file, unit, length):
    path = file(at([repr(k * length) for k in range(10)], f"t [{unit}]"))
    assert error_of(result, path) == pytest.approx(0.0, abs=1e-12)


def test_begins_is_the_minute_of_a_file_that_counts(result, file):
    path = file(at(range(100, 110), "time [min]"))
    assert error_of(result, path, begins="100") == 0.0


MAP = """
time = "Zeit"
time_unit = "min"
ignore = ["Bemerkung"]

[columns."UW West P"]
quantity = "station_active_power"
element = "West"
unit = "kW"
factor = -1
"""


def test_a_file_explains_columns_that_recorders_have_named(result, file):
    rows = [f"x;{k};{-1000 * value:g}" for k, value in enumerate(WEST_MW)]
    path = file("\n".join(["Bemerkung;Zeit;UW West P", *rows]))
    assert error_of(result, path, columns=file(MAP, "columns.toml")) == 0.0


def test_headings_and_a_file_may_explain_columns_together(result, file):
    path = file(in_minutes({WEST: WEST_MW, "P2": EAST_MW}))
    text = '[columns.P2]\nquantity = "station_active_power"\nelement = "East"\nunit = "MW"\n'
    found = compare(result, path, columns=file(text, "columns.toml"))
    assert [each.name for each in found.series] == [
        "station_active_power:West", "station_active_power:East",
    ]  # fmt: skip


def headed(*headings):
    cells = ",".join("1" for _ in headings)
    return "\n".join([",".join(["time [min]", *headings]), f"0,{cells}", f"1,{cells}"])


BAD = {
    "empty": ("", "the file is empty", "write a header"),
    "no rows": ("time [min],x\n", "no rows follow the header", "add rows"),
    "one row": (at([0], "time [min]"), "a single time", "two rows"),
    "twice": (headed(WEST, WEST), "the column is there twice", "its own name"),
    "again": (headed(WEST, "station_active_power:West [kW]"), "has the same", "leave one out"),
    "nothing": (headed(WEST, "Bemerkung"), "column 'Bemerkung'", "QUANTITY:ELEMENT [UNIT]"),
    "only times": ("time [min]\n0\n1\n", "no column is to be compared", "station_active_power"),
    "quantity": (headed("station_power:West [MW]"), "'station_power'", "station_active_power"),
    "element": (headed("station_active_power:Wset [MW]"), "no such station", "did you mean West"),
    "train": (headed("active_power:up 9 [MW]"), "'up 9'", "up 1"),
    "unit": (headed("station_active_power:West [MVA]"), "'MVA'", "choose from W, kW, MW"),
    "quotes": ('time [min],"a\n0,1\n1,2\n', "no rows follow the header", "add rows"),
    "a cell without an end": (f'time [min],{WEST}\n0,"{"1" * 200_000}', "line 2", "close quotes"),
    "number": (at(range(10), "time [min]", values=[*VALUES[:3], "1x", *VALUES[4:]]),
               "line 5, column 'station_active_power:West [MW]' = 1x", "decimal point"),
    "infinite": (at(range(10), "time [min]", values=["inf", *VALUES[1:]]), "= inf", "not a number"),
    "thousands": (at(range(3), "time [min]", ";", ["1,5", "1.000,5", "2,5"]), "= 1.000,5",
                  "decimal comma"),
    "short row": (f"time [min],{WEST}\n0,1\n1\n", "line 3 = 1", "1 values, expected 2"),
    "long row": (f"time [min],{WEST}\n0,1\n1,2,3\n", "line 3 = 1,2,3", "in quotes"),
    "no time": (at(["noon"]), "= noon", "write HH:MM"),
    "another time": (at(["06:00", "06:01", "120"]), "line 4, column 'time' = 120", "kind of the first"),
    "no unit": (at(range(10)), "numbers without a known unit of time", "time [s] or time [min]"),
    "unit of time": (at(range(10), "time [d]"), "not a unit of time", "units: s, min, h"),
    "order": (at([0, 1, 1, 2], "time [min]"), "line 4, column 'time [min]' = 1", "follows 1"),
    "autumn": (at(["2026-10-25T02:59", "2026-10-25T02:00"]), "does not increase", "time zone"),
    "zones": (at(["2026-03-02T06:00Z", "2026-03-02T06:01"]), "line 3", "give all of them one"),
    "no date": (at(["2026-02-30T06:00", "2026-03-02T06:01"]), "no such date", "write HH:MM"),
    "overlap": (at(range(20, 30), "time [min]"), "minute 20 to minute 30", "--begins"),
    "too short": (at([9.5, 9.8], "time [min]"), "no interval of 1 min", "--begins"),
    "all gaps": (at(range(10), "time [min]", values=[""] * 10), "column 'station", "ignore"),
    "no clock": (at(clock()), "does not say what the clock shows", "--begins HH:MM:SS"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_told_with_its_name_the_place_and_a_remedy(file, case):
    text, problem, remedy = BAD[case]
    result = made_up_result(
        station_mw={"West": WEST_MW, "East": EAST_MW}, power_mw={"up 1": EAST_MW}
    )
    with pytest.raises(tpss.ScenarioError) as caught:
        compare(result, file(text))
    told = str(caught.value)
    assert "measured.csv" in told
    assert problem in told
    assert remedy in told


BAD_MAPS = {
    "no TOML": ("time = ", "not TOML", "toml.io"),
    "key": ('zeit = "time"', "no such key", "columns, ignore, time, time_unit"),
    "no such column": ('[columns.P]\nquantity = "x"', "the table has no such column", "choose from"),
    "ignored": ('ignore = ["Remark"]', "ignore = 'Remark'", "the table has no such column"),
    "no list": ("ignore = 3", "not a list", '["remark"]'),
    "no table": ("columns = 3", "columns = 3", "not a table"),
    "no table of a column": ("[columns]\nX = 3", "columns.X = 3", "not a table"),
    "time": ('time = "when"', "time = 'when'", "the table has no such column"),
    "time unit": ('time_unit = "d"', "not a unit of time", "s, min, h"),
    "a list for a text": ('time_unit = ["s"]', "time_unit = ['s']", "s, min, h"),
    "named twice": ('ignore = ["X"]\n[columns.X]\nquantity = "active_power"', "columns.X = 'X'",
                    "leave it out of one"),
    "no quantity": ('[columns.X]\nquantity = ["W"]', "columns.X.quantity = ['W']", "choose from"),
    "key of a column": ("[columns.X]\nscale = 3", "columns.X.scale = 3", "no such key"),
    "no element": ('[columns.X]\nquantity = "active_power"\nunit = "W"', "X.element = ''", "up 1"),
    "factor": ('[columns.X]\nquantity = "active_power"\nelement = "up 1"\nunit = "W"\nfactor = 0',
               "columns.X.factor = 0", "-1 for the opposite sign"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD_MAPS)
def test_a_bad_file_that_explains_columns_is_told(file, case):
    text, problem, remedy = BAD_MAPS[case]
    result = made_up_result(power_mw={"up 1": EAST_MW})
    with pytest.raises(tpss.ScenarioError) as caught:
        compare(result, file(headed("X")), columns=file(text, "columns.toml"))
    told = str(caught.value)
    assert "columns.toml" in told
    assert problem in told
    assert remedy in told


BAD_BEGINS = {
    "no clock": (at(clock()), "noon", "noon is not one"),
    "a date for a clock": (
        at(clock()),
        "2026-03-02T06:00",
        "with a date only if the file has dates",
    ),
    "no minute": (at(range(10), "time [min]"), "06:00", "not a number of minutes"),
    "no zone": (at(dated("Z")), "2026-03-02T06:00", "its times have the time zone Z"),
    "a zone": (at(dated()), "2026-03-02T06:00Z", "its times have no time zone"),
    "no date": (at(dated()), "2026-02-30T06:00", "no date"),
}


@pytest.mark.parametrize("case", BAD_BEGINS)
def test_a_begin_that_does_not_fit_the_file_is_told(result, file, case):
    text, begins, problem = BAD_BEGINS[case]
    with pytest.raises(tpss.ScenarioError, match=problem):
        compare(result, file(text), begins=begins)


def test_no_offset_is_found_of_what_does_not_vary(result, file):
    with pytest.raises(tpss.ScenarioError, match="no series varies"):
        compare(result, file(in_minutes({WEST: [1.0] * 10})), find_offset_min=2.0)


def test_a_file_that_is_not_there_and_a_folder(result, tmp_path):
    for place, words in (
        (tmp_path / "no.csv", "there is no such file"),
        (tmp_path, "cannot be read"),
    ):
        with pytest.raises(tpss.ScenarioError, match=words):
            compare(result, place)


def test_a_station_whose_node_is_not_told_by_its_place_asks_for_one(file):
    """An outage parts the contact line at East, so that there are two nodes."""
    out = {"name": "out", "sections": [{"from_km": 15.0, "to_km": 20.0}]}
    result = run({
        "simulation.time_step_min": 0.5, "simulation.duration_min": 3.0, "outages": [out],
        "simulation.outage": "out", "simulation.motion": None, "simulation.braking": None,
    })  # fmt: skip
    with pytest.raises(tpss.ScenarioError, match=r"take node_voltage, .* contact line at 20 km"):
        compare(result, file(headed("station_voltage:East [kV]")))
    found = compare(result, file(headed("node_voltage:contact line at 20 km [kV]")))
    assert found.series[0].compared == 2
