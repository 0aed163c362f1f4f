"""A study's table holds every case once, however often the study was killed."""

import io
import json
import multiprocessing
import os
import resource
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pandas as pd
import psutil
import pyarrow.parquet as pq
import pytest

import tpss
from sweep.studies import small_cluster, study, write_study
from tpss.sweep import campaign, cluster
from tpss.sweep.derive import scenario_of
from tpss.sweep.design import design_of
from tpss.sweep.folder import Folder, batches, missing
from tpss.sweep.progress import Advance

from scenarios import gradients

SLOW = {
    "set": {"simulation.time_step_min": 0.002, "simulation.duration_min": 15.0},
    "vary": {"traffic.0.headway_min": {"low": 3.0, "high": 20.0}},
    "design": "sobol",
    "cases": 24,
}
"""Cases of some hundred milliseconds, so that there is time to kill what runs them."""


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    with small_cluster() as address:
        yield address


def without_timings(table: pd.DataFrame) -> pd.DataFrame:
    return table[[name for name in table.columns if not name.startswith("timing.")]]


def parts(folder: Path) -> dict[str, bytes]:
    """Finished files of rows by name, without their checksums."""
    files = sorted(folder.glob("cases/*.parquet"))
    return {file.name.rpartition("-")[0]: file.read_bytes() for file in files}


def command(file: Path, folder: Path) -> list[str]:
    whole = [sys.executable, "-m", "tpss", "sweep", str(file), "--out", str(folder)]
    return [*whole, "--workers", "2", "--quiet"]


def wait_for_parts(folder: Path, process: subprocess.Popen[bytes], count: int) -> None:
    while len(parts(folder)) < count:
        assert process.poll() is None, "it ended before it could be killed"
        time.sleep(0.01)


def test_rows_are_what_simulate_gives(tmp_path, scheduler):
    small = study(tmp_path)
    ended = tpss.run_study(small, tmp_path / "out", scheduler=scheduler)
    assert (ended.cases, ended.done, ended.before) == (6, 6, 0)
    table = tpss.load_table(tmp_path / "out")
    assert table.case.tolist() == list(range(6))
    design = design_of(small)
    for row in table.itertuples():
        scenario = scenario_of(design, row.case)
        result = tpss.simulate(scenario)
        assert row.scenario_hash == scenario.digest()
        assert row.status == "finished"
        assert row.audit_passed
        assert row.total_energy_mwh == pytest.approx(result.summary["total_energy_mwh"], rel=1e-12)
        assert row.lowest_voltage_kv == result.summary["lowest_voltage"]["voltage_kv"]
    assert table["set.supply.converter_stations.*.converters"].tolist() == [1, 2, 3] * 2
    assert table.converters.tolist() == [2, 4, 6] * 2
    assert (table["station.West.energy_mwh"] + table["station.East.energy_mwh"]).tolist() == (
        pytest.approx(table.total_energy_mwh.tolist(), rel=1e-12)
    )


def test_a_small_study_is_run_here_and_a_large_one_on_all_cores():
    """Processes take seconds to start: 3 s of computing are not worth it, unless they are asked for."""
    assert campaign.processes_for(300, 0.01, None) == 1
    assert campaign.processes_for(100_000, 0.01, None) == os.cpu_count()
    assert campaign.processes_for(300, 0.01, 4) == 4
    assert campaign.processes_for(3, 10.0, 8) == 3


def test_rows_are_the_same_on_processes_of_their_own(tmp_path):
    small = study(tmp_path)
    tpss.run_study(small, tmp_path / "here", workers=1)
    tpss.run_study(small, tmp_path / "there", workers=2)
    here, there = (tpss.load_table(tmp_path / name) for name in ("here", "there"))
    pd.testing.assert_frame_equal(without_timings(here), without_timings(there))
    assert not multiprocessing.active_children()


def test_a_study_that_is_stopped_leaves_no_processes(tmp_path):
    """As by Ctrl-C: what is done is kept, what runs is ended."""

    def stop(_: Advance) -> None:
        raise KeyboardInterrupt

    slow = study(tmp_path, SLOW)
    with pytest.raises(KeyboardInterrupt):
        tpss.run_study(slow, tmp_path / "out", workers=2, report=stop)
    assert not multiprocessing.active_children()
    assert 0 < len(tpss.load_table(tmp_path / "out")) < SLOW["cases"]


def test_a_collapse_and_a_stall_are_rows_as_others_are(tmp_path, scheduler):
    """Freight trains at the foot of a hill of 30 ‰; heavy ones stall, a train every 12 s collapses."""
    hill = gradients((0.0, 0.0), (5.0, 30.0))
    changes = {
        "set": {"simulation.time_step_min": 0.1, **hill},
        "vary": None,
        "choices": {
            "load": {
                "light": {"trains.freight.mass_t": 400.0},
                "heavy": {"trains.freight.mass_t": 4000.0},
                "many": {"trains.freight.mass_t": 400.0, "traffic.0.headway_min": 0.2},
            }
        },
    }
    tpss.run_study(study(tmp_path, changes), tmp_path / "out", scheduler=scheduler)
    table = tpss.load_table(tmp_path / "out").set_index("set.load")
    assert table.status.to_dict() == {"light": "finished", "heavy": "stalled", "many": "collapsed"}
    assert table.collapsed.tolist() == [False, False, True]
    assert table.stalled.tolist() == [False, True, False]
    assert table.trip_time_min.notna().tolist() == [True, False, False]
    assert 0.0 < table.carried_share["many"] < 1.0
    assert 0.0 < table.duration_min["many"] < table.duration_min["light"]


def test_a_case_that_is_no_scenario_is_a_row_that_says_why(tmp_path, scheduler, monkeypatch):
    """Had it not been found out before: in a study of thousands only a sample is tried."""
    placed = {"position_km": 1.0, "speed_kmh": 300.0}
    choices = {"placed": {"no": {}, "yes": {"traffic.0.initial_trains": [placed]}}}
    faulty = study(tmp_path, {"vary": None, "choices": choices})
    sound = study(tmp_path, {"vary": None, "choices": {"placed": {"no": {}}}})
    checked = campaign.check(design_of(sound))
    monkeypatch.setattr(campaign, "check", lambda _: checked)
    tpss.run_study(faulty, tmp_path / "out", scheduler=scheduler)
    table = tpss.load_table(tmp_path / "out")
    assert table.status.tolist() == ["finished", "invalid"]
    assert "faster than the limit here" in table.problem[1]


def test_what_is_done_is_not_run_again(tmp_path, scheduler):
    small = study(tmp_path)
    tpss.run_study(small, tmp_path / "out", scheduler=scheduler)
    before = parts(tmp_path / "out")
    again = tpss.run_study(small, tmp_path / "out", scheduler=scheduler)
    assert (again.done, again.before) == (6, 6)
    assert parts(tmp_path / "out") == before
    lost = sorted(before)[2]
    next((tmp_path / "out" / "cases").glob(f"{lost}-*")).unlink()
    assert tpss.run_study(small, tmp_path / "out", scheduler=scheduler).before < 6
    kept = parts(tmp_path / "out")
    assert {name for name in before if kept[name] != before[name]} == {lost}
    assert tpss.load_table(tmp_path / "out").case.tolist() == list(range(6))


def test_a_sobol_study_is_continued(tmp_path, scheduler):
    changes = {**SLOW, "set": {"simulation.duration_min": 1.0}, "cases": 5}
    tpss.run_study(study(tmp_path, changes), tmp_path / "out", scheduler=scheduler)
    few = tpss.load_table(tmp_path / "out")
    ended = tpss.run_study(
        study(tmp_path, {**changes, "cases": 12}), tmp_path / "out", scheduler=scheduler
    )
    many = tpss.load_table(tmp_path / "out")
    assert (ended.before, ended.done) == (5, 12)
    assert many.case.tolist() == list(range(12))
    pd.testing.assert_frame_equal(many[:5], few)


def test_killed_workers_and_studies_lose_nothing(tmp_path, scheduler):
    """First a worker is killed, which is replaced; then all of it, and the rest is run elsewhere."""
    file, folder = write_study(tmp_path, SLOW), tmp_path / "killed"
    with subprocess.Popen(command(file, folder)) as process:
        wait_for_parts(folder, process, 1)
        workers = [p for p in psutil.Process(process.pid).children() if _is_worker(p)]
        workers[0].kill()
        wait_for_parts(folder, process, 3)
        workers = psutil.Process(process.pid).children(recursive=True)
        process.kill()
    _, alive = psutil.wait_procs(workers, timeout=30)
    assert not alive, "workers outlive the command that started them"
    before = parts(folder)
    done = sum(pq.read_metadata(io.BytesIO(content)).num_rows for content in before.values())
    assert 0 < done < SLOW["cases"]
    again = tpss.run_study(tpss.load_study(file), folder, scheduler=scheduler)
    assert (again.before, again.done) == (done, SLOW["cases"])
    after = parts(folder)
    assert {name: after[name] for name in before} == before
    tpss.run_study(tpss.load_study(file), tmp_path / "whole", scheduler=scheduler)
    pd.testing.assert_frame_equal(
        without_timings(tpss.load_table(folder)),
        without_timings(tpss.load_table(tmp_path / "whole")),
    )


def _is_worker(process: psutil.Process) -> bool:
    return any("spawn_main" in argument for argument in process.cmdline())


def refused(small: tpss.Study, folder: Path, scheduler: str) -> str:
    """What is said of a study that cannot be run."""
    with pytest.raises(tpss.StudyError) as caught:
        tpss.run_study(small, folder, scheduler=scheduler)
    return str(caught.value)


def test_a_folder_of_another_study_or_version_is_refused(tmp_path, scheduler):
    small, folder = study(tmp_path), tmp_path / "out"
    tpss.run_study(small, folder, scheduler=scheduler)
    other = study(tmp_path, {"seed": 1})
    assert "holds another study" in refused(other, folder, scheduler)
    place = folder / "study.json"
    manifest = json.loads(place.read_text("utf-8"))
    del manifest["sha256"]  # theirs would be of what they wrote
    for key, words in (
        ("tpss_version", "was begun by another version (tpss_version 9, here"),
        ("kernel_hash", "was begun by other kernels"),
        ("table_format", "is of another format"),
    ):
        place.write_text(json.dumps({**manifest, key: "9"}), "utf-8")
        said = refused(small, folder, scheduler)
        assert words in said
        assert "give another --out" in said
    with pytest.raises(tpss.StudyError, match="written by another version of TPSS"):
        tpss.load_table(folder)


def test_a_folder_of_something_else_is_refused(tmp_path, scheduler):
    small = study(tmp_path)
    assert "not empty, nor the folder of a study" in refused(small, tmp_path, scheduler)
    assert "is not a folder" in refused(small, tmp_path / "study.toml", scheduler)
    with pytest.raises(tpss.StudyError, match=r"not the folder of a study \(study\.json"):
        tpss.load_table(tmp_path)


def test_two_processes_do_not_work_in_one_folder(tmp_path, scheduler):
    small, folder = study(tmp_path), tmp_path / "out"
    tpss.run_study(small, folder, scheduler=scheduler)
    manifest = json.loads((folder / "study.json").read_text("utf-8"))
    with Folder(folder).opened(manifest):
        assert "is in use by another process" in refused(small, folder, scheduler)


def test_a_full_disk_loses_nothing_that_was_there(tmp_path, scheduler):
    """The limit lets the manifest be written, but no file of rows."""
    small, folder = study(tmp_path), tmp_path / "out"
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (15_000, before[1]))
    try:
        said = refused(small, folder, scheduler)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert "cannot be written: File too large; free space" in said
    assert list(parts(folder)) == []
    assert not list(folder.glob("**/*.unfinished"))
    assert tpss.run_study(small, folder, scheduler=scheduler).done == 6


def test_a_damaged_file_is_told_with_the_remedy(tmp_path, scheduler):
    small, folder = study(tmp_path), tmp_path / "out"
    tpss.run_study(small, folder, scheduler=scheduler)
    damaged = sorted(folder.glob("cases/*.parquet"))[0]
    damaged.write_bytes(damaged.read_bytes()[:100])
    with pytest.raises(tpss.StudyError, match="is damaged"):
        tpss.load_table(folder)


def test_a_flipped_bit_is_told_wherever_it_lies(tmp_path):
    folder = tmp_path / "out"
    tpss.run_study(study(tmp_path), folder)
    part = sorted(folder.glob("cases/*.parquet"))[0]
    written = bytearray(part.read_bytes())
    for place in range(0, len(written), len(written) // 100):
        written[place] ^= 4
        part.write_bytes(written)
        with pytest.raises(tpss.StudyError, match="not as it was written"):
            tpss.load_table(folder)
        written[place] ^= 4


def test_other_words_in_the_manifest_are_told(tmp_path):
    folder = tmp_path / "out"
    tpss.run_study(study(tmp_path), folder)
    manifest = json.loads((folder / "study.json").read_text("utf-8"))
    manifest["study"] = manifest["study"].replace('"seed": ', '"seed": 1')
    (folder / "study.json").write_text(json.dumps(manifest), "utf-8")
    with pytest.raises(
        tpss.StudyError, match=r"study\.json is damaged \(its checksum is another\)"
    ):
        tpss.load_table(folder)


def test_files_whose_columns_differ_are_told(tmp_path):
    """Files without a checksum in their names, as written before."""
    folder = tmp_path / "out"
    tpss.run_study(study(tmp_path), folder)
    part = sorted(folder.glob("cases/*.parquet"))[0]
    table = pq.read_table(part)
    part.unlink()
    for k, columns in enumerate((table.column_names, table.column_names[:-1])):
        pq.write_table(table.select(columns), part.with_name(f"cases-{k}-{k + 1}.parquet"))
    with pytest.raises(tpss.StudyError, match=r"cases-1-2\.parquet is damaged \(its columns"):
        tpss.load_table(folder)


def test_a_scheduler_that_is_not_there_is_told(tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    said = refused(study(tmp_path), tmp_path / "out", "tcp://127.0.0.1:9")
    assert "no scheduler answers at tcp://127.0.0.1:9" in said
    assert "leave --scheduler out" in said


def test_workers_of_another_version_are_told():
    theirs = {"tcp://10.0.0.2:1234": {"tpss_version": "9", "kernel_hash": "0"}}
    with pytest.raises(tpss.StudyError, match=r"10\.0\.0\.2:1234 is of another version"):
        cluster.demand_version(theirs)


def test_gaps_between_what_is_done_are_cut_into_batches():
    """Of 10 cases 2 to 3 and 6 are done; batches of 3 begin at 0, 3, 6 and 9."""
    gaps = missing([(2, 4), (6, 7)], 10)
    assert gaps == [(0, 2), (4, 6), (7, 10)]
    assert list(batches(gaps, 3)) == [(0, 2), (4, 6), (7, 9), (9, 10)]
    assert missing([(0, 10)], 10) == []
    assert missing([], 2) == [(0, 2)]


def test_an_estimate_counts_what_comes_before_the_first_case():
    """10 s of checks and starts, then 300 cases of 0.1 s on two processes: 10 + 15 s."""
    assert campaign.Estimate(300, 0.1, 2, before_s=10.0).whole_s == 25.0


def test_an_estimate_measures_the_processes_that_will_run(tmp_path):
    one, two = (campaign.estimate(study(tmp_path), workers) for workers in (1, 2))
    assert (one.cases, one.workers, two.workers) == (6, 1, 2)
    assert one.before_s > 0.0
    assert 0.0 < one.case_s < one.whole_s
    assert not multiprocessing.active_children()
