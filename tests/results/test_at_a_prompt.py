"""What results and scenarios do where they are looked at: at a prompt, in a notebook, in a script."""

from importlib.metadata import version

import pandas as pd
import pytest

import tpss

from scenarios import run, short_line


@pytest.fixture(scope="module")
def result():
    return run({"simulation.duration_min": 1.0, "name": "a-b", "traffic.0.name": "<b>"})


def test_a_result_is_a_line_at_a_prompt(result):
    assert (
        repr(result) == str(result) == "<Result 'a-b': finished, 1.00 min, 1 train, audit passed>"
    )


def test_a_result_is_a_table_in_a_notebook(result):
    page = result._repr_html_()
    assert page.startswith("<table><caption>a-b</caption>")
    assert "&lt;b&gt;" in page
    assert "<b>" not in page
    assert "Audit</th><td style='text-align:left'>passed" in page


def test_a_scenario_is_a_line_at_a_prompt():
    """Stations of the line, and those that feed it."""
    scenario = short_line({"name": "a-b"})
    lines = "1 line, 3 stations, 2 feeding stations, 1 service"
    assert repr(scenario) == f"<Scenario 'a-b': {lines}>"


def test_a_prompt_completes_what_a_scenario_is_and_nothing_of_the_library_below():
    """With pydantic's there would be forty more names, of which some skip all checks."""
    names = {name for name in dir(short_line()) if not name.startswith("_")}
    assert {"with_", "save", "digest", "variant", "traffic", "supply"} <= names
    assert not {"parse_obj", "dict", "model_copy", "construct"} & names
    assert "time_step_min" in dir(short_line().simulation)


def test_a_scenario_is_saved_as_it_is_run(tmp_path):
    scenario = short_line({"traffic.0.headway_min": 7.0})
    file = scenario.save(tmp_path / "line.toml")
    assert tpss.load_scenario(file) == scenario
    with pytest.raises(tpss.ResultError, match="exists already"):
        scenario.save(file)
    scenario.with_({"name": "another"}).save(file, force=True)
    assert tpss.load_scenario(file).name == "another"


def test_tables_are_written_as_files_of_each_kind(result, tmp_path):
    names = {file.stem for file in result.to_csv(tmp_path / "csv")}
    assert {"trips", "stations", "violations"} <= names
    assert {file.stem for file in result.to_parquet(tmp_path / "parquet")} == names
    book = result.to_excel(tmp_path / "all.xlsx")
    with pd.ExcelFile(book) as opened:
        assert set(opened.sheet_names) >= names
    with pytest.raises(tpss.ResultError, match="exists already"):
        result.to_excel(book)
    with pytest.raises(tpss.ResultError, match=r"does not end in \.xlsx"):
        result.to_excel(tmp_path / "all.csv")


def test_a_figure_and_a_report_are_asked_of_the_result(result, tmp_path):
    figure = result.plot("journey", against="time")
    assert figure.get_suptitle() == "a-b: <b> 1"
    with pytest.raises(tpss.ResultError, match="there is no figure 'volt'"):
        result.plot("volt")
    with pytest.raises(tpss.ResultError, match="against time or distance, not 'tme'"):
        result.plot("journey", against="tme")
    assert "TPSS report" in result.report(tmp_path / "report.html").read_text()[:2000]


def test_a_file_is_simulated_as_the_scenario_in_it(tmp_path):
    scenario = short_line({"simulation.duration_min": 1.0})
    file = scenario.save(tmp_path / "line.toml")
    assert tpss.simulate(file).dataset.equals(tpss.simulate(scenario).dataset)
    assert tpss.simulate(str(file)).scenario == scenario


def test_however_a_scenario_was_made_its_changes_stay():
    scenario = short_line({"name": "a"})
    for other in (
        scenario.model_copy(update={"name": "b"}),
        tpss.Scenario(**(scenario.as_document() | {"name": "b"})),
    ):
        changed = other.with_({"traffic.0.headway_min": 9.0})
        assert (changed.name, changed.traffic[0].headway_min) == ("b", 9.0)


def test_the_version_is_that_of_the_package():
    assert tpss.__version__ == version("tpss")
