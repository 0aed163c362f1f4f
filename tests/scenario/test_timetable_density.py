"""A denser timetable: times between departures are divided, and it begins again until its end."""

import pytest
import tomli_w

import tpss

from scenarios import SHORT_LINE

ROWS = """name,train,station,arrival,departure
A,freight,West,,0
A,,East,25,
B,freight,West,,10
B,,East,35,
C,freight,West,,20
C,,East,45,
"""


def departures_min(tmp_path, density: float) -> dict[str, float]:
    """Departures of the trains by their names."""
    (tmp_path / "rows.csv").write_text(ROWS, "utf-8")
    table = {"file": "rows.csv", "density": density}
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps({**SHORT_LINE, "traffic": [], "timetables": [table]}), "utf-8")
    scenario = tpss.load_scenario(file)
    assert all(entry.arrive_after_min == 25.0 for entry in scenario.traffic)
    return {entry.name: entry.departure_min for entry in scenario.traffic}


def test_a_timetable_twice_as_dense_is_run_twice_in_the_same_hours(tmp_path):
    """Trains at 0, 10 and 20 min repeat after 30 min: at half of it, after 15 min, until 20 min."""
    assert departures_min(tmp_path, 2.0) == {
        "A": 0.0, "B": 5.0, "C": 10.0, "A again": 15.0, "B again": 20.0,
    }  # fmt: skip


def test_a_timetable_half_as_dense_ends_where_it_ended(tmp_path):
    """Trains at 0, 20 and 40 min, of which the last would be later than 20 min."""
    assert departures_min(tmp_path, 0.5) == {"A": 0.0, "B": 20.0}


def test_a_density_of_one_changes_nothing(tmp_path):
    assert departures_min(tmp_path, 1.0) == {"A": 0.0, "B": 10.0, "C": 20.0}


def test_a_density_of_none_is_told(tmp_path):
    with pytest.raises(tpss.ScenarioError, match=r"timetables\.0\.density = 0\.0"):
        departures_min(tmp_path, 0.0)
