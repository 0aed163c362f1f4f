"""A study tells what equipment bears and how old it gets, where its lines say that."""

import copy

import pytest

import feeding_back
import tpss
from feeding_back import PLAIN
from tpss import library
from tpss.results.thermal.figures import FIGURES, USES
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of
from tpss.sweep.outcome import load_outcome
from tpss.sweep.report import study_report
from tpss.sweep.summary import summarise

COLUMNS = [f"thermal.{name}" for name in FIGURES]

LABELS = {
    "of what contact lines bear [%]", "of what transformers bear [%]", "of what converters bear [%]",
    "of what motors bear [%]", "hottest transformer [°C]", "life lost by a transformer [min]",
}  # fmt: skip


def rated():
    """The line with a high-voltage line, and a rating of everything."""
    found = copy.deepcopy(feeding_back.document(PLAIN, {}))
    supply = found["supply"]
    supply["catenary"] = library.values("catenaries", "BT")
    supply["catenary"]["rating"] = {"continuous_a": 300.0, "time_constant_min": 5.0}
    supply["high_voltage_line"] = {"type": "132kV", "transformers": 0}
    unit = library.values("transformers", "25MVA")
    unit["rating"] = {"rating_mva": 5.0, "cooling": "ONAN"}
    supply["high_voltage_line"]["station_transformer"] = unit
    for station in supply["converter_stations"]:
        overloads = [{"percent": 110.0, "minutes": 2.0}]
        rating = {"time_constant_min": 20.0, "overloads": overloads}
        station["type"] = {**library.values("converters", PLAIN), "rating": rating}
    motors = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
    found["trains"]["freight"]["motor_rating"] = motors
    return found


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    place = tmp_path_factory.mktemp("rated")
    small = feeding_back.study(place, rated())
    tpss.run_study(small, place / "out", workers=1)
    return small, place / "out"


def test_its_columns_are_what_the_runs_tell(told):
    """They come from the recording alone; those of a run, from its dataset."""
    small, folder = told
    for row in tpss.load_table(folder).to_dict("records"):
        result = tpss.simulate(scenario_of(design_of(small), row["case"]))
        table = result.thermal
        used = (table.highest_state_percent / table.allowed_state_percent).combine(
            (table.highest_rms_percent / table.allowed_rms_percent).fillna(0.0), max
        )
        for name, kind in USES.items():
            highest = used[table.kind == kind].max()
            assert row[f"thermal.{name}"] == pytest.approx(
                100.0 * highest, rel=1e-9, nan_ok=True
            ), name
        assert row["thermal.hot_spot_c"] == pytest.approx(table.highest_temperature_c.max())
        assert row["thermal.loss_of_life_min"] == pytest.approx(table.loss_of_life_min.max())
        assert row["thermal.over"] == (table.verdict == "over").sum()


def test_summary_and_report_show_them(told):
    _, folder = told
    assert set(summarise(tpss.load_table(folder), 2).spread.index) >= LABELS
    page = study_report(load_outcome(folder), folder)
    assert all(label in page for label in LABELS)


def test_a_case_tells_what_trips(tmp_path):
    """Loads grow with the traffic; of what it may, each case trips what its own run does."""
    found = rated()
    found["protection"] = {"trip": True}
    for station in found["supply"]["converter_stations"]:
        station["type"]["rating"]["overloads"] = [{"percent": 101.0, "minutes": 1.0}]
        station["type"]["rating_mva"] = 0.4
    small = feeding_back.study(tmp_path, found)
    tpss.run_study(small, tmp_path / "out", workers=1)
    table = tpss.load_table(tmp_path / "out")
    for row in table.to_dict("records"):
        result = tpss.simulate(scenario_of(design_of(small), row["case"]))
        names = [trip["element"] for trip in result.summary.get("trips", [])]
        assert row["trips"] == len(names)
        assert row["tripped"] == ("; ".join(names) or None)
    assert table.trips.sum() > 0


def test_they_are_absent_where_nothing_has_a_rating(tmp_path):
    small = feeding_back.study(tmp_path, feeding_back.document(PLAIN, {}))
    tpss.run_study(small, tmp_path / "out", workers=1)
    table = tpss.load_table(tmp_path / "out")
    assert table[[*COLUMNS, "trips", "tripped"]].isna().all().all()
    assert LABELS.isdisjoint(summarise(table, 2).spread.index)
