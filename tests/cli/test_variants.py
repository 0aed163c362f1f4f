"""``tpss run --variant``: one, several, all, and their figures side by side."""

import copy
from pathlib import Path

import pytest
import tomli_w

import tpss

from scenarios import SHORT_LINE

VARIANTS = {
    "AT": {"description": "another catenary", "set": {"supply.catenary": "AT"}},
    "steep": {"set": {"line.gradients.0.permille": 40.0}},
}


@pytest.fixture
def file(tmp_path) -> Path:
    document = {**copy.deepcopy(SHORT_LINE), "variants": VARIANTS}
    document["simulation"]["duration_min"] = 5.0
    path = tmp_path / "line.toml"
    path.write_text(tomli_w.dumps(document))
    return path


def test_a_variant_is_run_in_place_of_the_scenario(tpss_command, file, tmp_path):
    said = tpss_command("run", file, "--variant", "AT", "--out", tmp_path / "out")
    assert said.code == 0
    assert "another catenary" in said.out
    assert tpss.load_result(tmp_path / "out").scenario.supply.catenary.r_ohm_per_km < 0.1


def test_all_are_run_saved_apart_and_compared(tpss_command, file, tmp_path):
    """On 40 per mille the train cannot start: the exit code is that of the worst end."""
    said = tpss_command("run", file, "--variant", "all", "--out", tmp_path / "out")
    assert said.code == 3
    assert sorted(each.name for each in (tmp_path / "out").iterdir()) == ["AT", "base", "steep"]
    table = said.out[said.out.rindex("Variants") :].split()
    assert table.index("base") < table.index("AT") < table.index("steep")
    assert "stalled" in table
    drop = "(+0.0" in said.out or "(-0.0" in said.out
    assert drop


def test_variants_that_give_themselves_one_name_are_compared_all_the_same(tpss_command, file):
    both = [word for name in VARIANTS
            for word in ("--set", f"variants.{name}.set.name=same")]  # fmt: skip
    said = tpss_command("run", file, *both, "--variant", "all")
    assert said.code == 3
    assert "AT" in said.out[said.out.rindex("Variants") :]


def test_results_of_several_are_numbered_where_no_folder_is_given(tpss_command, file, tmp_path):
    tpss_command("run", file, "--variant", "AT", "--variant", "steep", "--quiet")
    saved = sorted(each.name for each in (tmp_path / "results").iterdir())
    assert saved == ["short-line-AT-001", "short-line-steep-001"]


def test_an_unknown_variant_is_told_with_those_that_there_are(tpss_command, file):
    said = tpss_command("run", file, "--variant", "BT")
    assert said.code == 2
    assert "no such variant" in said.err
    assert "variants: AT, steep" in said.err


def test_check_builds_every_variant(tpss_command, file):
    said = tpss_command("check", file)
    assert said.code == 0
    assert "AT: another catenary" in said.out
    assert "steep: changes line.gradients.0.permille" in said.out
    wrong = tpss_command("check", file, "--set", "variants.AT.set={supply.catenary = 'ATT'}")
    assert wrong.code == 2
    assert "(variant AT)" in wrong.err


def test_a_run_says_what_trains_lost_to_the_voltage(tpss_command, file, tmp_path):
    weak = [
        "supply.catenary={r_ohm_per_km = 0.4, x_ohm_per_km = 0.4}",
        "supply.converter_stations.East=",
        "line.speed_limits.0.speed_kmh=100.0",
        "line.gradients.0.permille=5.0",
        "simulation.duration_min=40",
    ]
    assignments = [word for text in weak for word in ("--set", text)]
    said = tpss_command("run", file, *assignments, "--out", tmp_path / "out")
    assert "Lost to the voltage: " in said.out
    assert "by 1 train that arrived (against 16.5 kV everywhere)" in said.out
