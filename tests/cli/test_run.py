"""The command ``tpss run``: what it prints and saves, and the exit code by which it tells how it went.

Exit codes: 0 done, 2 bad input, 3 no solution or a stalled train, 4 the audit failed,
130 interrupted.
"""

import json
import os
import re
import resource
import tomllib
from contextlib import contextmanager
from pathlib import Path

import pytest
import tomli_w

import tpss.api
from lines import STAR, network, service
from tpss import load_result
from tpss.audit import verdict
from tpss.cli.main import main
from tpss.files import whole, workplace

from conftest import EXAMPLES

HEADWAY = EXAMPLES / "at_headway_3.toml"
OVERLOADED = EXAMPLES / "overloaded.toml"
SHORT = ("--set", "simulation.duration_min=3")
STEEP = ("--set", "line.gradients=[{from_km = 0.0, permille = 30.0}]")


def files_in(folder: Path) -> dict[str, bytes]:
    """Contents of all files below a folder."""
    return {str(f.relative_to(folder)): f.read_bytes() for f in folder.rglob("*") if f.is_file()}


def folders_in(folder: Path) -> list[str]:
    return sorted(str(f.relative_to(folder)) for f in folder.rglob("*") if f.is_dir())


def test_a_run_is_saved_into_numbered_folders(tpss_command, tmp_path):
    for number in (1, 2, 3):
        said = tpss_command("run", HEADWAY, *SHORT)
        assert said.code == 0
        assert f"Saved in {Path('results', f'at-headway-3-00{number}')}" in said.out
    assert folders_in(tmp_path / "results") == [f"at-headway-3-00{n}" for n in (1, 2, 3)]


def test_the_saved_folder_is_a_result(tpss_command, tmp_path):
    tpss_command("run", HEADWAY, *SHORT)
    folder = tmp_path / "results" / "at-headway-3-001"
    assert sorted(files_in(folder)) == ["result.nc", "scenario.toml", "summary.json"]
    result = load_result(folder)
    assert result.status == "finished"
    assert result.dataset.sizes["time"] == 16  # 3 min / 0.2 min, and the start


def test_a_run_prints_what_matters(tpss_command, short_file):
    said = tpss_command("run", short_file)
    assert said.code == 0
    for words in (
        "short-line",
        "eastbound 1",
        "West",
        "East",
        "Trip time of eastbound 1:",
        "Energy over",
        "of which losses",
        "Lowest voltage:",
        "Audit passed",
    ):
        assert words in said.out


LIMITS = "standards.voltage_limits"


def judged(**limits):
    """Options by which a run is judged by other limits."""
    return [word for key, value in limits.items() for word in ("--set", f"{LIMITS}.{key}={value}")]


def test_a_run_within_its_limits_is_told_so_in_one_line(tpss_command):
    said = tpss_command("run", HEADWAY, *SHORT)
    assert "Voltage: no train below 12.0 kV or above 17.25 kV" in said.out
    assert "Limit violated" not in said.out


def test_the_worst_violations_are_told_in_words_and_the_others_counted(tpss_command, tmp_path):
    said = tpss_command("run", HEADWAY, *SHORT, *judged(umin1_kv=14.8, umin2_kv=14.5))
    assert said.code == 0
    told = re.findall(
        r"Limit violated: train eastbound initial \d+: at least 3\.0 min below 14\.5 kV near km "
        r"\d+\.\d \(lowest 14\.\d\d kV at \d\.\d min\)",
        said.out,
    )
    assert len(told) == 5
    violations = len(load_result(tmp_path / "results/at-headway-3-001").standards.violations)
    assert f"... and {violations - 5} more; tpss export lists all" in said.out
    assert "Voltage:" not in said.out


def test_a_voltage_that_is_low_for_as_long_as_it_may_be_is_told_as_such(tpss_command):
    said = tpss_command("run", HEADWAY, *SHORT, *judged(umin1_kv=14.8, longest_low_min=5))
    assert "Limit violated" not in said.out
    pattern = r"Voltage: train .*: at least 3\.0 min below 14\.8 kV near km .*; 5 min are allowed"
    assert re.search(pattern, said.out)


def test_quiet_prints_nothing(tpss_command, tmp_path):
    said = tpss_command("run", HEADWAY, *SHORT, "--quiet")
    assert (said.code, said.out, said.err) == (0, "", "")
    assert folders_in(tmp_path) == ["results", "results/at-headway-3-001"]


def test_set_changes_the_scenario_that_is_run_and_saved(tpss_command, tmp_path):
    changes = ("traffic.0.headway_min=12", "supply.catenary=BT", "name=study")
    options = [word for change in changes for word in ("--set", change)]
    assert tpss_command("run", HEADWAY, *SHORT, *options, "--quiet").code == 0
    saved = tomllib.loads((tmp_path / "results/study-001/scenario.toml").read_text("utf-8"))
    assert saved["traffic"][0]["headway_min"] == 12
    assert saved["supply"]["catenary"]["r_ohm_per_km"] == 0.21
    assert saved["simulation"]["duration_min"] == 3


def test_out_names_the_folder(tpss_command, tmp_path):
    assert tpss_command("run", HEADWAY, *SHORT, "--out", "a/b", "--quiet").code == 0
    assert folders_in(tmp_path) == ["a", "a/b"]


def test_an_existing_folder_is_refused_and_left_alone(tpss_command, tmp_path):
    tpss_command("run", HEADWAY, *SHORT, "--out", "a", "--quiet")
    before = files_in(tmp_path)
    said = tpss_command("run", HEADWAY, *SHORT, "--set", "traffic.0.headway_min=5", "--out", "a")
    assert said.code == 2
    assert "a exists already" in said.err
    assert "--force" in said.err
    assert files_in(tmp_path) == before


def test_a_refused_folder_is_found_out_before_the_run(tpss_command, tmp_path, monkeypatch):
    monkeypatch.setattr(tpss.api, "prepare", lambda *_: pytest.fail("it has run"))
    (tmp_path / "a").mkdir()
    assert tpss_command("run", HEADWAY, "--out", "a").code == 2


def test_force_replaces_a_result(tpss_command, tmp_path):
    tpss_command("run", HEADWAY, *SHORT, "--out", "a", "--quiet")
    said = tpss_command("run", HEADWAY, *SHORT, "--set", "name=new", "--out", "a", "--force")
    assert said.code == 0
    assert load_result(tmp_path / "a").scenario.name == "new"
    assert folders_in(tmp_path) == ["a"]


def test_force_fills_an_empty_folder(tpss_command, tmp_path):
    (tmp_path / "a").mkdir()
    assert tpss_command("run", HEADWAY, *SHORT, "--out", "a", "--force", "--quiet").code == 0
    assert load_result(tmp_path / "a").status == "finished"


@pytest.mark.parametrize("out", ["thesis", ".", "thesis/chapter.txt"])
def test_force_deletes_nothing_but_results(tpss_command, tmp_path, out):
    (tmp_path / "thesis").mkdir()
    (tmp_path / "thesis" / "chapter.txt").write_text("Years of work.")
    before = files_in(tmp_path)
    said = tpss_command("run", HEADWAY, *SHORT, "--out", out, "--force")
    assert said.code == 2
    assert "is not a result folder" in said.err
    assert files_in(tmp_path) == before


def test_a_folder_below_a_file_is_refused(tpss_command, tmp_path):
    (tmp_path / "notes.txt").touch()
    said = tpss_command("run", HEADWAY, *SHORT, "--out", "notes.txt/a")
    assert said.code == 2
    assert "notes.txt/a cannot be written: Not a directory; give another --out" in said.err
    assert list(files_in(tmp_path)) == ["notes.txt"]


@pytest.mark.skipif(os.geteuid() == 0, reason="the administrator may write anywhere")
def test_a_folder_that_may_not_be_written_is_refused(tpss_command, tmp_path):
    (tmp_path / "locked").mkdir(mode=0o500)
    said = tpss_command("run", HEADWAY, *SHORT, "--out", "locked/a")
    assert said.code == 2
    assert "locked/a cannot be written: Permission denied" in said.err


@pytest.mark.parametrize("name", ["x" * 300, "loop/a"])
def test_a_folder_that_cannot_be_made_is_found_out_before_the_run(
    tpss_command, tmp_path, monkeypatch, name
):
    monkeypatch.setattr(tpss.api, "prepare", lambda *_: pytest.fail("it has run"))
    (tmp_path / "loop").symlink_to("loop")
    said = tpss_command("run", HEADWAY, "--out", name)
    assert said.code == 2
    assert "cannot be written: " in said.err
    assert "give another --out" in said.err


def test_a_link_to_a_folder_leads_the_result_there(tpss_command, tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "results").symlink_to("disk")
    assert tpss_command("run", HEADWAY, *SHORT, "--quiet").code == 0
    assert load_result(tmp_path / "disk" / "at-headway-3-001").status == "finished"


def test_a_result_that_cannot_be_saved_is_rescued(tpss_command, tmp_path, monkeypatch):
    """The disk of ``results`` fills up; the hours of computing are not lost."""
    write = whole.write_new

    def to_a_full_disk(path, content):
        if "results" in path.parts:
            raise OSError(28, "No space left on device")
        write(path, content)

    (tmp_path / "spare").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "spare"))
    monkeypatch.setattr(whole, "write_new", to_a_full_disk)
    said = tpss_command("run", HEADWAY, *SHORT)
    assert said.code == 2
    assert "results cannot be written: No space left on device" in said.err
    (rescued,) = (tmp_path / "spare").iterdir()
    assert f"The result was saved into {rescued} instead." in said.err
    assert load_result(rescued).status == "finished"
    assert folders_in(tmp_path / "results") == []


@contextmanager
def file_size_limit(size):
    """Refuse to let any file grow beyond a size: the system's own way, as on a full disk.

    Around the command alone: what the tests themselves print may go to a file that is larger.
    """
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_full_disk_is_found_out_before_the_run(tpss_command, tmp_path, monkeypatch):
    monkeypatch.setattr(tpss.api, "prepare", lambda *_: pytest.fail("it has run"))
    with file_size_limit(10_000):
        said = tpss_command("run", HEADWAY)
    assert said.code == 2
    assert "results cannot be written: File too large; give another --out" in said.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("options", [(), ("--quiet",)], ids=["", "quiet"])
def test_a_result_that_no_disk_can_hold_is_printed_at_least(
    tpss_command, tmp_path, monkeypatch, options
):
    (tmp_path / "spare").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "spare"))
    with file_size_limit(workplace.TRIAL_BYTES):
        said = tpss_command("run", HEADWAY, *SHORT, *options)
    assert said.code == 2
    assert "Energy over 3.00 min" in said.out
    assert "results cannot be written: File too large" in said.err
    assert "Only what is printed here is kept of the result." in said.err
    assert files_in(tmp_path) == {}
    assert folders_in(tmp_path) == ["results", "spare"]


def test_show_prints_a_row_for_every_step(tpss_command, capsys, monkeypatch):
    """3 min of 0.2 min are 15 steps, and one row more for the last instant."""
    said = tpss_command("run", HEADWAY, *SHORT, "--show", "eastbound 1")
    assert said.code == 0
    table = said.out[said.out.rindex("eastbound 1 ") :]
    for heading in ("speed", "voltage", "traction", "brakes", "motor"):
        assert heading in table
    rows = re.findall(r"\b(\d\.\d\d) \d+\.\d{3} \d+\.\d\d (?=\d\.\d{4}|-)", table)
    assert [float(row) for row in rows] == pytest.approx([0.2 * k for k in range(16)])


@pytest.mark.parametrize("name", ["east 1", "eastbound", "eastbound 01", "eastbound 0"])
def test_show_of_an_unknown_train_is_refused_before_anything_runs(tpss_command, tmp_path, name):
    said = tpss_command("run", HEADWAY, *SHORT, "--show", name)
    assert (said.code, said.out) == (2, "")
    assert f"{HEADWAY}: --show = '{name}' there is no such train" in said.err
    assert (
        "-> did you mean eastbound 1? trains: eastbound 1, 2, ...; eastbound initial 1, 2, ..."
        in said.err
    )
    assert files_in(tmp_path) == {}


def test_show_proposes_the_train_of_the_number_that_was_written(tpss_command):
    said = tpss_command("run", HEADWAY, *SHORT, "--show", "eastbond 3")
    assert "did you mean eastbound 3?" in said.err


def test_show_knows_lists_of_departures_and_trains_that_are_placed(tpss_command, tmp_path):
    document = network(STAR, [service("up", "West", "Mine"), service("along", "West", "East")])
    up, along = document["traffic"]
    up["initial_trains"] = [{"line": "main", "position_km": 1.0, "speed_kmh": 0.0}]
    along.pop("headway_min", None)
    along["departures_min"] = [0.0, 5.0]
    (tmp_path / "network.toml").write_text(tomli_w.dumps(document), encoding="utf-8")
    said = tpss_command("run", "network.toml", "--show", "down 1")
    assert said.code == 2
    assert "trains: up 1; up initial 1; along 1 to 2" in said.err


def test_show_of_a_train_that_was_not_on_the_line_says_so_beside_the_result(tpss_command, tmp_path):
    """Every 3 min a train departs, of which 3 min see the first one only."""
    said = tpss_command("run", HEADWAY, *SHORT, "--show", "eastbound 7")
    assert said.code == 0
    assert "Note: eastbound 7 was not on the line during this run" in said.out
    assert load_result(tmp_path / "results" / "at-headway-3-001").status == "finished"


def test_bad_input_is_reported_whole_and_nothing_is_written(tpss_command, tmp_path):
    faults = ("supply.catenary=BTX", "line.length_km='160 km'", "traffic.0.to=Eats")
    options = [word for fault in faults for word in ("--set", fault)]
    said = tpss_command("run", HEADWAY, *options)
    assert (said.code, said.out) == (2, "")
    assert f"{HEADWAY}: supply.catenary = 'BTX'" in said.err
    assert "did you mean BT?" in said.err
    assert "line.length_km = '160 km'" in said.err
    assert "traffic.0.to = 'Eats'" in said.err
    assert list(tmp_path.iterdir()) == []


def test_bad_input_is_reported_by_a_quiet_run_too(tpss_command):
    said = tpss_command("run", HEADWAY, "--set", "supply.catenary=BTX", "--quiet")
    assert (said.code, said.out) == (2, "")
    assert "did you mean BT?" in said.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere.toml"], "there is no such file"),
        (["."], "the file cannot be read"),
        ([HEADWAY, "--set", "simulation.time_step_min"], "not of the form KEY=VALUE"),
        ([HEADWAY, "--set", "traffic.7.headway_min=3"], "no such place in the scenario"),
        ([HEADWAY, "--set", "trafic.headway_min=3"], "did you mean traffic?"),
        ([HEADWAY, "--outt", "a"], "No such option"),
        ([], "Missing argument"),
    ],
)
def test_a_wrong_call_is_explained(tpss_command, tmp_path, arguments, words):
    said = tpss_command("run", *arguments)
    assert (said.code, said.out) == (2, "")
    assert words in said.err
    assert list(tmp_path.iterdir()) == []


def test_a_train_placed_too_fast_is_bad_input(tpss_command, tmp_path):
    trains = "traffic.0.initial_trains=[{position_km = 3.0, speed_kmh = 120.0}]"
    changes = ("--set", "traffic.0.already_running=false", "--set", trains)
    said = tpss_command("run", HEADWAY, *changes)
    assert said.code == 2
    assert "faster than the limit here, 60 km/h" in said.err
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_memory_cannot_hold_is_refused(tpss_command, tmp_path):
    """Ten weeks in steps of 12 s with a train every 3 minutes."""
    said = tpss_command("run", HEADWAY, "--set", "simulation.duration_min=100000")
    assert (said.code, said.out) == (2, "")
    assert "GiB of memory" in said.err
    assert "a longer time step, a shorter duration or a longer headway" in said.err
    assert list(tmp_path.iterdir()) == []


def test_an_overloaded_line_ends_with_the_reason_and_advice(tpss_command, tmp_path):
    said = tpss_command("run", OVERLOADED)
    assert said.code == 3
    for pattern in (
        r"Collapsed\. At 0\.00 min the line cannot carry its load",
        r"\d+ trains demand \d+\.\d+ MW and \d+\.\d+ Mvar",
        r"beyond \d+\.\d % of that",
        r"eastbound initial \d at \d+\.\d+ km has \d+\.\d+ kV, the lowest",
        r"What would help: Strengthen the supply",
        r"weakest place is near \d+ km",
        r"Saved in results.overloaded-001",
    ):
        assert re.search(pattern, said.out), pattern
    assert load_result(tmp_path / "results" / "overloaded-001").status == "collapsed"


def test_what_was_simulated_before_the_collapse_is_saved(tpss_command, tmp_path):
    """Trains enter an empty line one after the other until there are too many."""
    said = tpss_command("run", OVERLOADED, "--set", "traffic.0.already_running=false")
    assert said.code == 3
    result = load_result(tmp_path / "results" / "overloaded-001")
    minutes = float(result.dataset.time[-1]) / 60.0
    assert minutes > 10.0
    assert f"Collapsed. At {minutes:.2f} min" in said.out
    assert result.summary["total_energy_mwh"] > 0.0


def test_a_stalled_train_ends_the_run_with_forces_and_advice(tpss_command, tmp_path):
    """1470 t on 30 ‰ ask for 1470 · 9.81 · 0.030 + 15.4 = 432.6 + 15.4 = 448.0 kN."""
    said = tpss_command("run", HEADWAY, *STEEP)
    assert said.code == 3
    for words in (
        "Stalled. At 0.00 min eastbound 1 cannot start at 0.00 km",
        "demand 448.0 kN",
        "kV and 0.0 km/h",
        "What would help: Lower the train's mass",
    ):
        assert words in said.out
    assert load_result(tmp_path / "results" / "at-headway-3-001").status == "stalled"


@pytest.mark.parametrize("arguments", [(OVERLOADED,), (HEADWAY, *STEEP)], ids=["load", "stall"])
def test_a_quiet_run_tells_by_its_exit_code_that_it_failed(tpss_command, tmp_path, arguments):
    said = tpss_command("run", *arguments, "--quiet")
    assert (said.code, said.out) == (3, "")
    assert len(folders_in(tmp_path / "results")) == 1


def test_the_audit_shows_the_limits_that_held(tpss_command, tmp_path):
    """Transformers a metre apart: over 0.2 mΩ roundings are visible, and the limits follow them."""
    high_voltage = "supply.high_voltage_line={type = '132kV', transformers_km = [%s]}"
    limits = {}
    for places in ("40.0, 80.0", "5.0, 5.001, 5.002"):
        said = tpss_command(
            "run", HEADWAY, *SHORT, "--set", high_voltage % places, "--out", "r", "--force"
        )
        audit = json.loads((tmp_path / "r/summary.json").read_text("utf-8"))["audit"]
        limits[places] = audit["limits"]
        shown = re.search(r"power mismatch (\S+) VA \(limit (\S+)\)", said.out)
        assert float(shown[1]) == pytest.approx(audit["power_mismatch_va"], rel=0.05)
        assert float(shown[2]) == pytest.approx(audit["limits"]["power_mismatch_va"], rel=0.05)
        assert audit["power_mismatch_va"] <= audit["limits"]["power_mismatch_va"]
        assert "converters " in said.out
    usual, grown = limits.values()
    assert usual["power_mismatch_va"] == pytest.approx(0.01, rel=0.1)
    assert grown["power_mismatch_va"] > 1.5 * usual["power_mismatch_va"]
    assert grown["converter_residual"] >= usual["converter_residual"]


def test_what_is_not_judged_is_said_to_be_so(tpss_command):
    said = tpss_command("run", HEADWAY, *SHORT, "--set", "simulation.power_sampling=start")
    assert re.search(r"traction \S+ \(not judged\)", said.out)


def fail_the_audit(monkeypatch: pytest.MonkeyPatch, figure: str) -> None:
    usual = verdict.usual_limits
    monkeypatch.setattr(verdict, "usual_limits", lambda base: {**usual(base), figure: -1.0})


@pytest.mark.parametrize("figure", sorted(verdict.JUDGED))
def test_a_failed_audit_is_loud(tpss_command, tmp_path, monkeypatch, figure):
    fail_the_audit(monkeypatch, figure)
    said = tpss_command("run", HEADWAY, *SHORT)
    assert said.code == 4
    assert "Audit FAILED" in said.out
    assert f"Audit failed: {figure} is" in said.out
    saved = json.loads((tmp_path / "results/at-headway-3-001/summary.json").read_text("utf-8"))
    assert saved["audit"]["passed"] is False


def test_a_failed_audit_counts_more_than_an_early_end(tpss_command, monkeypatch):
    fail_the_audit(monkeypatch, "power_mismatch_va")
    assert tpss_command("run", OVERLOADED, "--quiet").code == 4


def break_the_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    def prepare(*_):
        raise RuntimeError("a wheel came off")

    monkeypatch.setattr(tpss.api, "prepare", prepare)


def test_a_fault_of_the_program_says_so_without_a_traceback(tpss_command, monkeypatch):
    break_the_simulation(monkeypatch)
    said = tpss_command("run", HEADWAY, "--quiet")
    assert (said.code, said.out) == (1, "")
    assert "Internal error: RuntimeError: a wheel came off" in said.err
    assert "please report it" in said.err


def test_a_fault_of_the_program_can_be_traced(tpss_command, monkeypatch):
    break_the_simulation(monkeypatch)
    monkeypatch.setenv("TPSS_DEBUG", "1")
    monkeypatch.setattr("sys.argv", ["tpss", "run", str(HEADWAY), "--quiet"])
    with pytest.raises(RuntimeError, match="a wheel came off"):
        main()


@pytest.mark.parametrize("columns", [80, 60, 40])
def test_tables_have_whole_numbers_in_a_narrow_terminal(
    tpss_command, tmp_path, monkeypatch, columns
):
    """Lines of 60 km and a branch; a table that is too wide is printed in parts."""
    document = network(STAR, [service("up", "West", "Mine"), service("along", "West", "East")])
    document["simulation"]["duration_min"] = 10.0
    document["variants"] = {"lighter": {"set": {"trains.freight.mass_t": 500.0}}}
    (tmp_path / "network.toml").write_text(tomli_w.dumps(document), encoding="utf-8")
    monkeypatch.setenv("COLUMNS", str(columns))
    said = tpss_command(
        "run", "network.toml", "--variant", "all", "--no-step-check", "--out", "all"
    )
    assert said.code == 0
    assert "…" not in said.out
    assert ("Trains, continued" in said.out) == (columns < 80)


def test_show_tells_the_line_of_each_place(tpss_command, tmp_path):
    document = network(STAR, [service("up", "West", "Mine")])
    document["simulation"]["duration_min"] = 40.0
    (tmp_path / "network.toml").write_text(tomli_w.dumps(document), encoding="utf-8")
    said = tpss_command("run", "network.toml", "--no-step-check", "--out", "a", "--show", "up 1")
    assert "time on position" in said.out
    lines = re.findall(r"\d\.\d\d (main|branch) \d+\.\d{3}", said.out)
    assert list(dict.fromkeys(lines)) == ["main", "branch"]
