"""``tpss approximate``: train, predict, check, and what is said of bad input."""

import errno
from pathlib import Path
from unittest.mock import patch

import pandas as pd
import pytest

from tpss.approximator import fit
from tpss.approximator.train import train_approximator

from made_up_studies import SMALL, made_up_table, write_study

LINE = {
    "length_km": 100,
    "converters": 8,
    "headway_min": 12,
    "speed_limit_kmh": 80,
    "gradient_mean_permille": 0,
    "gradient_std_permille": 1,
    "catenary": "BT",
    "high_voltage_line": "true",
    "transformers": 3,
}


def settings(**changes):
    """Options that set the inputs of a line; None leaves one out."""
    pairs = {**LINE, **changes}.items()
    return [word for name, v in pairs if v is not None for word in ("--set", f"{name}={v}")]


@pytest.fixture(autouse=True)
def _small_networks():
    with patch.dict(fit.NEURONS, SMALL):
        yield


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    return write_study(tmp_path_factory.mktemp("study") / "made-up", made_up_table(400))


@pytest.fixture(scope="module")
def trained(study):
    with patch.dict(fit.NEURONS, SMALL):
        return train_approximator(study)


@pytest.fixture
def model(trained, tmp_path):
    return trained.save(tmp_path / "trained.json")


def test_train_writes_a_file_and_says_how_good_it_is(tpss_command, study):
    said = tpss_command("approximate", "train", study, "--out", "new/model.json", "--seed", "3")
    assert said.code == 0
    assert "Trained on 320 cases of the study made-up" in said.out
    assert "Wrote new/model.json" in said.out
    assert Path("new/model.json").exists()


def test_check_says_what_a_model_is(tpss_command, model):
    said = tpss_command("approximate", "check", model)
    assert said.code == 0
    assert "catenary AT or BT" in said.out
    assert "train_mass_t 1470 only" in said.out
    assert "Predicts mean speed, trip time, total energy, losses, lowest voltage" in said.out
    assert "does not tell what converters lose or what trains feed back" in said.out


def test_check_compares_with_the_cases_held_out_or_with_another_study(
    tpss_command, model, study, tmp_path
):
    own = tpss_command("approximate", "check", model, study)
    assert own.out.startswith("80 cases of made-up that were held out")
    other = write_study(tmp_path / "other", made_up_table(200, seed=9), study_hash="0ther")
    said = tpss_command("approximate", "check", model, other)
    assert said.code == 0
    assert "cases of made-up" in said.out


def test_predict_prints_the_figures_of_a_line(tpss_command, model):
    """100 km at 80 km/h, 2 % slower for 1 permille above the lowest mean: 76.5 min."""
    said = tpss_command("approximate", "predict", model, *settings())
    assert said.code == 0
    assert "trip time 7" in said.out
    assert "probability of collapse 0.0" in said.out


def test_predict_says_that_a_line_collapses(tpss_command, model):
    said = tpss_command("approximate", "predict", model, *settings(length_km=150, headway_min=6))
    assert said.code == 0
    assert said.out.startswith("The line cannot carry this load: probability of collapse")


@pytest.mark.parametrize("name", ["lines.csv", "lines.parquet"])
def test_predict_reads_and_writes_tables(tpss_command, model, name):
    lines = pd.DataFrame([LINE, {**LINE, "headway_min": 20}]).assign(high_voltage_line=True)
    lines.to_csv("lines.csv", index=False)
    lines.to_parquet("lines.parquet", index=False)
    said = tpss_command("approximate", "predict", model, "--table", name)
    assert (said.code, said.err) == (0, "")
    said = tpss_command("approximate", "predict", model, "--table", name, "--out", f"of-{name}")
    assert said.code == 0
    found = pd.read_csv(f"of-{name}") if name.endswith("csv") else pd.read_parquet(f"of-{name}")
    assert found["headway_min"].tolist() == [12, 20]
    assert (
        found["trip_time_min"]
        .between(found["trip_time_min.low"], found["trip_time_min.high"])
        .all()
    )


def test_a_line_outside_the_trained_region_is_refused_or_flagged(tpss_command, model):
    options = settings(length_km=300)
    said = tpss_command("approximate", "predict", model, *options)
    assert said.code == 2
    assert "outside the trained region: station_distance_km = 300: trained at" in said.err
    said = tpss_command("approximate", "predict", model, *options, "--flag")
    assert said.code == 0
    assert "outside the trained region: station_distance_km = 300" in said.err


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"headway_minutes": 8}, "headway_minutes = 8.0 this approximator has no such input"),
        ({"headway_min": None}, "headway_min this input is missing -> give it (5"),
        ({"headway_min": "8min"}, "headway_min = '8min' not a number"),
        ({"headway_min": "nan"}, "headway_min = nan not a number"),
        ({"catenary": "XT"}, "catenary = XT: trained at AT or BT"),
        ({"catenary": ""}, "catenary= not of the form INPUT=VALUE"),
    ],
)
def test_bad_inputs_are_told(changes, words, tpss_command, model):
    said = tpss_command("approximate", "predict", model, *settings(**changes))
    assert said.code == 2
    assert words in said.err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "give --set for each input, --scenario, or --table"),
        (["--table", "lines.csv", "--set", "stops=0"], "give either --table, or one line"),
        (["--table", "no.csv"], "no.csv cannot be read as a table: No such file"),
        (["--table", "lines.txt"], "neither .csv nor .parquet"),
        (["--table", "empty.csv"], "empty.csv cannot be read as a table"),
        (["--table", "bad.parquet"], "bad.parquet cannot be read as a table"),
        (["--set", "stops=0", "--out", "figures.xlsx"], "neither .csv nor .parquet"),
    ],
)
def test_bad_calls_are_told(options, words, tpss_command, model):
    Path("empty.csv").write_text("")
    Path("bad.parquet").write_text("no table")
    said = tpss_command("approximate", "predict", model, *options)
    assert said.code == 2
    assert words in said.err


def test_what_is_no_study_or_no_model_is_told(tpss_command, model, tmp_path):
    (tmp_path / "folder").mkdir()
    said = tpss_command("approximate", "train", "folder")
    assert said.code == 2
    assert "folder is not the folder of a study" in said.err
    said = tpss_command("approximate", "check", "folder/study.json")
    assert said.code == 2
    assert "folder/study.json cannot be read: No such file" in said.err
    said = tpss_command("approximate", "check", model, "folder")
    assert said.code == 2


def test_an_existing_or_unwritable_file_is_told_before_the_training(tpss_command, study, model):
    for out, words in (
        (model, "exists; give another --out, or --force"),
        (Path.cwd(), "is a folder"),
        (model / "new.json", "cannot be written"),
    ):
        said = tpss_command("approximate", "train", study, "--out", out)
        assert said.code == 2
        assert words in said.err


def test_a_disk_that_fills_up_while_training_costs_no_training(tpss_command, study, tmp_path):
    """The file goes into a temporary folder instead, and the old one stays."""
    out = tmp_path / "model.json"
    out.write_text("old")
    full = OSError(errno.ENOSPC, "No space left on device")
    real = Path.replace

    def replace(self, target):
        if target == out:
            raise full
        return real(self, target)

    with patch.object(Path, "replace", replace):
        said = tpss_command("approximate", "train", study, "--out", out, "--force")
    assert said.code == 2
    assert "model.json cannot be written: No space left on device" in said.err
    saved = Path(said.err.split("It was saved as ")[1].split(" instead")[0])
    assert tpss_command("approximate", "check", saved).code == 0
    assert out.read_text() == "old"
    assert list(tmp_path.glob("*.unfinished")) == []
    saved.unlink()
    saved.parent.rmdir()
