"""Result folders are written whole or not at all, whatever befalls the program."""

import gzip
import json
import os
import shutil
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from tpss import ResultError, load_result, load_scenario, simulate, write_report
from tpss.files import whole, workplace
from tpss.report.contact_line import line_voltage
from tpss.results import store

from conftest import EXAMPLES
from scenarios import run


@pytest.fixture(scope="module")
def old():
    return run({"simulation.duration_min": 1.0, "name": "old"})


@pytest.fixture(scope="module")
def new():
    return run({"simulation.duration_min": 1.0, "name": "new"})


def names_in(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_result_is_saved_into_the_next_numbered_folder(old, new, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    saved = [str(result.save()) for result in (old, old, new)]
    assert saved == ["results/old-001", "results/old-002", "results/new-001"]


def test_runs_that_end_at_once_each_get_a_folder(old, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with ThreadPoolExecutor(4) as runs:
        folders = list(runs.map(lambda _: old.save(), range(4)))
    assert sorted(map(str, folders)) == [f"results/old-00{n}" for n in range(1, 5)]
    assert all(load_result(folder).scenario.name == "old" for folder in folders)
    assert len(names_in(tmp_path / "results")) == 4


def test_a_number_taken_in_the_last_moment_is_passed_over(old, new, tmp_path, monkeypatch):
    """The first folder was free when it was looked for; another run has moved into it since."""
    monkeypatch.chdir(tmp_path)
    first, second = store.PARENT / "new-001", store.PARENT / "new-002"
    old.save(first)
    found = iter([first, first, second])
    monkeypatch.setattr(store, "next_folder", lambda _: next(found))
    assert new.save() == second
    assert load_result(first).scenario.name == "old"


KILLED = """
import os, signal, sys
from pathlib import Path
import tpss
from tpss.files import workplace
from tpss.results import store

def kill(*_, **__):
    os.kill(os.getpid(), signal.SIGKILL)

def kill_at_second(rename=Path.rename, calls=[]):
    def at_second(path, target):
        calls.append(path)
        return kill() if len(calls) == 2 else rename(path, target)
    return at_second

new = tpss.load_result("new")
if sys.argv[1] == "writing":
    store.json.dumps = kill
elif sys.argv[1] == "moving":
    workplace.put_in_place = kill
elif sys.argv[1] == "carrying over":
    store.carry_over = kill
else:
    workplace.exchange = lambda *_: False
    Path.rename = kill_at_second()
new.save("result", force=True)
"""


def save_and_be_killed(when: str, folder: Path) -> None:
    done = subprocess.run([sys.executable, "-c", KILLED, when], cwd=folder, check=False)
    assert done.returncode == -signal.SIGKILL


@pytest.mark.parametrize("when", ["writing", "moving"])
def test_a_killed_process_leaves_the_old_result(old, new, tmp_path, when):
    old.save(tmp_path / "result")
    new.save(tmp_path / "new")
    save_and_be_killed(when, tmp_path)
    assert load_result(tmp_path / "result").scenario.name == "old"


def test_a_process_killed_between_the_old_result_and_the_new_one_loses_neither(old, new, tmp_path):
    """Where two folders cannot take each other's name in one step, none has it for a moment.

    Whoever asks for the result next gets the old one, with what its user has put there.
    """
    old.save(tmp_path / "result")
    new.save(tmp_path / "new")
    (tmp_path / "result" / "mine.txt").write_text("mine")
    save_and_be_killed("between", tmp_path)
    assert not (tmp_path / "result").exists()
    assert load_result(tmp_path / "result").scenario.name == "old"
    assert (tmp_path / "result" / "mine.txt").read_text() == "mine"
    assert names_in(tmp_path) == ["new", "result"]


@pytest.mark.parametrize("comes_next", [load_result, lambda folder: refused_in(folder)])
def test_what_a_user_has_put_into_a_result_comes_back_whoever_comes_next(
    old, new, tmp_path, comes_next
):
    """Killed after the new result took the place of the old one, before the user's file followed."""
    old.save(tmp_path / "result")
    new.save(tmp_path / "new")
    (tmp_path / "result" / "mine.txt").write_text("mine")
    save_and_be_killed("carrying over", tmp_path)
    assert not (tmp_path / "result" / "mine.txt").exists()
    comes_next(tmp_path / "result")
    assert (tmp_path / "result" / "mine.txt").read_text() == "mine"
    assert load_result(tmp_path / "result").scenario.name == "new"
    assert names_in(tmp_path) == ["new", "result"]


def refused_in(folder) -> None:
    """A run that may not replace what is there."""
    with pytest.raises(ResultError, match="exists already"):
        store.check_target(load_scenario(EXAMPLES / "thesis_3_3.toml"), folder, force=False)


def test_a_flipped_bit_is_told(old, tmp_path):
    """Wherever it lies: 150 places of the dataset, of which many would give other numbers silently."""
    folder = old.save(tmp_path / "result")
    written = bytearray((folder / "result.nc").read_bytes())
    for place in range(len(written) // 300, len(written), len(written) // 150):
        written[place] ^= 4
        (folder / "result.nc").write_bytes(written)
        with pytest.raises(ResultError, match="not as it was written"):
            load_result(folder)
        written[place] ^= 4
    (folder / "result.nc").write_bytes(written)
    assert load_result(folder).summary.keys() == old.summary.keys()


@pytest.mark.parametrize(
    ("name", "before", "after"),
    [
        ("summary.json", '"passed": true', '"passed": false'),
        ("summary.json", '"trip_time_min"', '"trip_time_mim"'),
        ("scenario.toml", "mass_t = 14", "mass_t = 15"),
    ],
)
def test_other_words_in_a_result_are_told(old, tmp_path, name, before, after):
    folder = old.save(tmp_path / "result")
    written = (folder / name).read_text("utf-8")
    assert before in written
    (folder / name).write_text(written.replace(before, after, 1), "utf-8")
    with pytest.raises(ResultError, match=f"{name} is not as it was written"):
        load_result(folder)


def test_a_summary_without_a_checksum_that_lacks_something_is_told(old, tmp_path):
    folder = old.save(tmp_path / "result")
    summary = json.loads((folder / "summary.json").read_text("utf-8"))
    for key in ("sha256", "trip_time_min", "losses_mwh"):
        del summary[key]
    (folder / "summary.json").write_text(json.dumps(summary), "utf-8")
    with pytest.raises(ResultError, match=r"summary\.json has no losses_mwh, trip_time_min"):
        load_result(folder)


def test_a_result_may_pass_through_a_system_that_ends_lines_otherwise(old, tmp_path):
    folder = old.save(tmp_path / "result")
    for name in ("summary.json", "scenario.toml"):
        text = (folder / name).read_bytes().replace(b"\n", b"\r\n")
        (folder / name).write_bytes(text)
    assert load_result(folder).summary.keys() == old.summary.keys()


def test_datasets_are_compressed_and_nothing_of_them_is_lost(old, tmp_path):
    several = simulate(load_scenario(EXAMPLES / "thesis_3_3.toml"))
    folder = several.save(tmp_path / "result")
    assert (folder / "result.nc").stat().st_size < 0.3 * several.dataset.nbytes
    assert load_result(folder).dataset.identical(several.dataset)


def test_the_old_result_comes_back_if_the_new_one_cannot_take_its_place(
    old, new, tmp_path, monkeypatch
):
    folder = old.save(tmp_path / "result")
    rename = Path.rename

    def failing(path, target):
        if path.name == "new":
            raise OSError(5, "Input/output error")
        return rename(path, target)

    with monkeypatch.context() as changed:
        changed.setattr(workplace, "exchange", lambda *_: False)
        changed.setattr(Path, "rename", failing)
        with pytest.raises(ResultError, match="cannot be written: Input/output error"):
            new.save(folder, force=True)
    assert load_result(folder).scenario.name == "old"
    assert names_in(tmp_path) == ["result"]


def test_a_folder_that_another_run_has_written_meanwhile_is_not_replaced(
    old, new, tmp_path, monkeypatch
):
    folder = tmp_path / "result"
    write = whole.write_new

    def meanwhile(path, content):
        monkeypatch.setattr(whole, "write_new", write)
        old.save(folder)
        write(path, content)

    monkeypatch.setattr(whole, "write_new", meanwhile)
    with pytest.raises(ResultError, match="exists already"):
        new.save(folder)
    assert load_result(folder).scenario.name == "old"
    assert names_in(tmp_path) == ["result"]


@pytest.mark.skipif(os.name == "nt", reason="links need a privilege there")
def test_a_link_stays_when_what_it_leads_to_is_replaced(old, new, tmp_path):
    folder = old.save(tmp_path / "disk" / "result")
    (tmp_path / "link").symlink_to(folder)
    new.save(tmp_path / "link", force=True)
    assert (tmp_path / "link").is_symlink()
    assert load_result(folder).scenario.name == "new"


@pytest.fixture
def earlier(tmp_path):
    """A result of the AT line with its high-voltage line, saved before nodes had a `node_kind`."""
    folder = tmp_path / "earlier"
    shutil.copytree(Path(__file__).parent / "earlier", folder)
    packed = folder / "result.nc.gz"
    (folder / "result.nc").write_bytes(gzip.decompress(packed.read_bytes()))
    packed.unlink()
    return folder


def test_nodes_of_an_earlier_result_have_the_kinds_that_they_have_now(earlier):
    with xr.open_dataset(earlier / "result.nc", engine="netcdf4") as stored:
        assert "node_kind" not in stored.coords
    result = load_result(earlier)
    now = simulate(result.scenario)
    assert set(now.dataset.node_kind.to_numpy()) == {
        "contact line", "AT feeder", "high-voltage line"
    }  # fmt: skip
    xr.testing.assert_equal(result.dataset.node_kind, now.dataset.node_kind)
    assert result.dataset.node_kind.attrs == now.dataset.node_kind.attrs
    since = {"departure_delay", "call", "call_arrival_time", "call_departure_time"}
    assert set(result.dataset.coords) | since == set(now.dataset.coords)


def test_an_earlier_result_is_reported_as_one_of_now(earlier, tmp_path):
    result = load_result(earlier)
    then, now = line_voltage(result.dataset), line_voltage(simulate(result.scenario).dataset)
    np.testing.assert_allclose(then.map_kv, now.map_kv, rtol=1e-6)
    assert write_report(result, tmp_path / "report.html").stat().st_size > 100_000
    again = load_result(result.save(tmp_path / "again"))
    xr.testing.assert_identical(again.dataset, result.dataset)
