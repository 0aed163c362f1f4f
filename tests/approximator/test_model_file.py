"""The file of an approximator: it keeps every digit, and nothing in it is run."""

import json
import pickle
import subprocess
import sys

import pytest

import tpss

from made_up_studies import made_up_table


def test_an_approximator_that_was_saved_predicts_the_same(model, model_file):
    table = made_up_table(50, seed=6)[[each.name for each in model.file.inputs.varying]]
    again = tpss.load_approximator(model_file)
    assert again.file == model.file
    assert again.predict(table, "flag").equals(model.predict(table, "flag"))


def test_to_predict_needs_neither_scikit_learn_nor_pyarrow(model_file):
    program = (
        "import sys; sys.modules.update(dict.fromkeys(('sklearn', 'pyarrow', 'scipy', 'numba')))\n"
        "import tpss; m = tpss.load_approximator(sys.argv[1])\n"
        "middle = {e.name: e.values[1] if e.kind == 'choice' else (e.low + e.high) / 2\n"
        "          for e in m.file.inputs.varying}\n"
        "print(m.predict({k: [v] for k, v in middle.items()}, 'flag')['trip_time_min'][0] > 0)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(model_file)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stdout == "True\n", done.stderr


def test_the_file_states_data_versions_and_scores(model_file):
    document = json.loads(model_file.read_text("utf-8"))
    data = document["data"]
    assert (data["study"], data["study_hash"], data["cases"]) == ("made-up", "feed", 600)
    assert len(data["held_out"]) == 120
    assert {"tpss", "scikit-learn"} == set(document["made_by"])
    assert len(document["scores"]) == len(document["outputs"])


class Bomb:
    """What a pickle would run."""

    def __reduce__(self):
        return (pytest.fail, ("the file was run",))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "damaged"),
        (b"{}", "not the file of an approximator"),
        (b"[" * 100_000, "damaged"),
        (b"\xff\xfe\x00", "damaged"),
        (b'{"format": "tpss-approximator", "version": 4}', "another version of TPSS"),
        (pickle.dumps(Bomb()), "damaged"),
    ],
    ids=["empty", "foreign", "deep", "binary", "newer", "pickle"],
)
def test_a_foreign_file_is_refused(content, words, tmp_path):
    file = tmp_path / "model.json"
    file.write_bytes(content)
    with pytest.raises(tpss.ApproximatorError, match=words):
        tpss.load_approximator(file)


def spoilt(file, *path, value):
    """The file with one value changed."""
    document = json.loads(file.read_text("utf-8"))
    container = document
    for key in path[:-1]:
        container = container[key]
    container[path[-1]] = value
    file.write_text(json.dumps(document), "utf-8")
    return file


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("figures", "w1"), []),
        (("figures", "w1"), 7),
        (("figures", "w1", 0), [[1.0]]),
        (("figures", "b2", 0, 0), float("nan")),
        (("figures", "b2", 0, 0), "__import__('os')"),
        (("figures", "w1", 0, 0, 0), 1e308),
        (("outputs", 0, "scale"), "eval"),
        (("outputs", 0, "low"), None),
        (("domain", "pairs"), []),
        (("domain", "pairs", 0), "12"),
        (("inputs", "varying", 0, "high"), -1e9),
        (("inputs", "varying", 0, "kind"), "code"),
        (("inputs", "varying", 0, "low"), -1.0),
        (("figures", "w0", 0), [[1.0]]),
        (("inputs", "multiples", 0, "of"), "nothing"),
        (("inputs", "multiples", 0, "factor"), 0.0),
        (("unknown",), 1),
    ],
)
def test_a_damaged_file_says_where(path, value, model_file):
    with pytest.raises(tpss.ScenarioError, match="the file is damaged") as error:
        tpss.load_approximator(spoilt(model_file, *path, value=value))
    assert str(model_file) in str(error.value)


@pytest.mark.parametrize(
    ("path", "value"),
    [(("figures", "b2", 0, 0), 0.25), (("outputs", 0, "factor"), 9.0), (("data", "seed"), 99)],
)
def test_other_numbers_than_were_written_are_told(path, value, model_file):
    with pytest.raises(tpss.ApproximatorError, match="its checksum is another; train it again"):
        tpss.load_approximator(spoilt(model_file, *path, value=value))


def test_a_file_cut_off_anywhere_is_refused(model_file):
    text = model_file.read_text("utf-8")
    for share in range(1, 20):
        model_file.write_text(text[: len(text) * share // 20], "utf-8")
        with pytest.raises(tpss.ApproximatorError, match="damaged"):
            tpss.load_approximator(model_file)


def test_an_existing_file_is_kept_unless_it_may_be_replaced(model, model_file):
    with pytest.raises(tpss.ApproximatorError, match="exists"):
        model.save(model_file)
    model.save(model_file, force=True)


def test_a_name_that_no_file_can_have_is_told(model):
    with pytest.raises(tpss.ApproximatorError, match="cannot be written: File name too long"):
        model.save("x" * 300)
