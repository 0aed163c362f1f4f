"""The command ``tpss export``: files of a result, and bad folders that are called what they are."""

import json
import os

import pytest
import xarray as xr

from tpss.results.export import TABLES

SHORT = ("--set", "simulation.duration_min=3", "--out", "demo", "--quiet")


@pytest.fixture
def demo(tpss_command, short_file, tmp_path):
    """A saved result."""
    assert tpss_command("run", short_file, *SHORT).code == 0
    return tmp_path / "demo"


def test_tables_are_written_beside_the_result(tpss_command, demo):
    said = tpss_command("export", "demo")
    assert (said.code, said.err) == (0, "")
    assert said.out.startswith(
        "Wrote into demo/tables: trips.csv, stops.csv, waits.csv, stations.csv, regeneration.csv, "
        "converter_losses.csv, rails.csv, stray_current.csv, autotransformers.csv, "
        "transformer_losses.csv, storage.csv, violations.csv"
    )
    assert {file.name for file in (demo / "tables").iterdir()} == {f"{name}.csv" for name in TABLES}


def test_out_names_a_folder_that_may_be_new(tpss_command, demo, tmp_path):
    said = tpss_command("export", "demo", "--to", "xlsx", "--out", "for/excel")
    assert (said.code, said.out) == (0, "Wrote into for/excel: result.xlsx")
    assert (tmp_path / "for" / "excel" / "result.xlsx").is_file()
    assert {file.name for file in demo.iterdir()} == {"result.nc", "summary.json", "scenario.toml"}


@pytest.mark.parametrize(("word", "separator"), [("comma", ";"), ("point", ",")])
def test_csv_for_a_spreadsheet(tpss_command, demo, word, separator):
    said = tpss_command("export", "demo", "--spreadsheet", word)
    assert said.code == 0
    text = (demo / "tables" / "trips.csv").read_bytes().decode("utf-8")
    assert text.startswith(f"\ufefftrain{separator}service{separator}")


def test_existing_files_need_force(tpss_command, demo):
    tpss_command("export", "demo")
    said = tpss_command("export", "demo")
    assert (said.code, said.out) == (2, "")
    assert "demo/tables/trips.csv (and 28 more) exists already" in said.err
    assert tpss_command("export", "demo", "--force").code == 0


def test_a_result_that_is_replaced_takes_its_tables_along(tpss_command, demo, short_file):
    """Tables of another run than the one beside them would mislead."""
    tpss_command("export", "demo")
    tpss_command("run", short_file, *SHORT, "--force")
    assert not (demo / "tables").exists()


def damage_dataset(folder):
    whole = (folder / "result.nc").read_bytes()
    (folder / "result.nc").write_bytes(whole[: len(whole) // 2])


def summary_of_another_version(folder):
    text = json.loads((folder / "summary.json").read_text("utf-8"))
    text["result_format"] = 3
    text["provenance"]["tpss_version"] = "0.9.0"
    (folder / "summary.json").write_text(json.dumps(text))


def summary_of_an_old_version(folder):
    text = json.loads((folder / "summary.json").read_text("utf-8"))
    del text["result_format"]
    (folder / "summary.json").write_text(json.dumps(text))


def dataset_of_another_version(folder):
    dataset = xr.load_dataset(folder / "result.nc", engine="netcdf4")
    dataset.attrs["result_format"] = 3
    dataset.to_netcdf(folder / "result.nc", engine="netcdf4")
    summary = json.loads((folder / "summary.json").read_text())
    del summary["sha256"]  # as in a folder of that version
    (folder / "summary.json").write_text(json.dumps(summary))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda folder: (folder / "result.nc").unlink(),
         "demo is not a result folder: result.nc missing; name a folder that tpss run has written"),
        (damage_dataset, "demo is damaged ("),
        (summary_of_another_version,
         "demo was written by another version of TPSS (0.9.0): its format is 3, this version reads 2; "
         "run the scenario again (tpss run demo/scenario.toml), or read it with that version"),
        (summary_of_an_old_version, "its format is older than any number, this version reads 2"),
        (dataset_of_another_version, "result.nc and summary.json are not of the same version"),
    ],
    ids=["missing", "truncated", "newer", "older", "mixed"],
)  # fmt: skip
def test_a_bad_folder_is_called_what_it_is(tpss_command, demo, change, words):
    change(demo)
    said = tpss_command("export", "demo")
    assert (said.code, said.out) == (2, "")
    assert words in said.err
    assert not (demo / "tables").exists()


@pytest.mark.parametrize("folder", ["nowhere", ".", "short_line.toml"])
def test_what_is_no_result_is_called_that(tpss_command, short_file, folder):
    said = tpss_command("export", folder)
    assert said.code == 2
    assert "is not a result folder" in said.err


def test_an_unknown_kind_is_refused_with_those_there_are(tpss_command, demo):
    said = tpss_command("export", "demo", "--to", "ods")
    assert said.code == 2
    assert "csv" in said.err
    assert "parquet" in said.err


def test_a_folder_that_cannot_be_made_is_told(tpss_command, demo, tmp_path):
    (tmp_path / "notes.txt").touch()
    said = tpss_command("export", "demo", "--out", "notes.txt/a")
    assert said.code == 2
    assert "notes.txt/a cannot be written: Not a directory; give another --out" in said.err


def test_electrical_profiles_are_written_and_say_what_they_cover(tpss_command, demo, tmp_path):
    """3 minutes of a train that starts: on the first kilometre, at nearly 15 kV or more."""
    said = tpss_command("export-profiles", "demo", "--out", "p.json", "--power-class", "3")
    assert (said.code, said.err) == (0, "")
    assert said.out.startswith("Wrote p.json: ")
    document = json.loads((tmp_path / "p.json").read_text("utf-8"))
    assert document["level_order"]["15000V"][0] == "15000V"
    assert {level["power_class"] for level in document["levels"]} == {"3"}
    assert document["levels"][0]["track_ranges"][0]["begin"] == 0.0
    again = tpss_command("export-profiles", "demo", "--out", "p.json")
    assert (again.code, "exists already" in again.err) == (2, True)


@pytest.mark.skipif(os.name == "nt", reason="names of files have no such characters there")
def test_a_folder_whose_name_would_steer_the_terminal_is_shown_escaped(tpss_command, demo):
    said = tpss_command("export", demo, "--out", "red\x1b[31m")
    assert said.code == 0
    assert "\x1b" not in said.out
    assert r"red\x1b[31m" in said.out
