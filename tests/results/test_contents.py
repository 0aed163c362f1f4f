"""What TPSS writes into a result folder goes with the result that is replaced; all else stays."""

from functools import cached_property
from typing import get_type_hints

from pandas import DataFrame

from tpss.report.figures import FIGURES as DRAWN
from tpss.report.html import write_report
from tpss.results import contents
from tpss.results.export import export
from tpss.results.file_kinds import Kind
from tpss.results.result import Result
from tpss.results.standards.evidence import Evidence

from scenarios import run


def tables_of(kind):
    """Names of what gives a table."""
    functions = {
        name: value.func for name, value in vars(kind).items() if isinstance(value, cached_property)
    }
    return {name for name, each in functions.items() if get_type_hints(each)["return"] is DataFrame}


def test_the_names_are_those_of_what_is_drawn():
    assert tuple(DRAWN) == contents.FIGURE_NAMES


def test_every_table_of_a_result_is_exported():
    of_standards = {f"standards.{name}" for name in tables_of(Evidence)}
    assert set(contents.TABLE_PLACES.values()) == tables_of(Result) | of_standards


def everything(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_a_result_that_is_replaced_takes_what_was_made_of_it_along(tmp_path):
    """Tables and figures of another run than the one beside them would mislead."""
    result, folder = run({"simulation.duration_min": 1.0}), tmp_path / "a"
    result.save(folder)
    result_files = everything(folder)
    for kind in (Kind.CSV, Kind.XLSX):
        export(result, kind, folder / "tables")
    (folder / "figures").mkdir()
    (folder / "figures" / "journey.png").write_bytes(b"drawn")
    write_report(result, folder / "report.html")
    result.save(folder, force=True)
    assert everything(folder) == result_files
    assert {path.name for path in folder.iterdir()} == result_files


def test_what_others_have_put_there_stays(tmp_path):
    result, folder = run({"simulation.duration_min": 1.0}), tmp_path / "a"
    result.save(folder)
    result_files = everything(folder)
    (folder / "notes" / "deep").mkdir(parents=True)
    (folder / "figures").mkdir()
    (folder / "tables").mkdir()
    mine = {"notes.txt", "report.html", "notes/deep/1.txt", "figures/for the board.png",
            "figures/journey.pdf", "tables/summary.csv"}  # fmt: skip
    for name in mine:
        (folder / name).write_text("mine")
    (folder / "link").symlink_to(tmp_path / "elsewhere")
    (folder / "figures" / "journey.png").write_bytes(b"drawn")
    result.save(folder, force=True)
    assert everything(folder) == result_files | mine
    assert (folder / "link").is_symlink()
    assert (folder / "notes.txt").read_text() == "mine"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
