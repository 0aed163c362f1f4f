"""A law stands in one place: who edits it there has edited solver, audit and least squares."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from scenarios import SHORT_LINE

SOURCE = Path(__file__).parents[2] / "src" / "tpss"

QUADRATIC = {
    "law.no_load_voltage_v - law.droop_v_per_var * reactive_power_var / converters": (
        "law.no_load_voltage_v - law.droop_v_per_var * reactive_power_var / converters "
        "* (1.0 + abs(reactive_power_var) / converters / 4e6)"
    ),
    "-law.droop_v_per_var / converters": (
        "-law.droop_v_per_var / converters * (1.0 + 2.0 * abs(reactive_power_var) / converters / 4e6)"
    ),
}
"""The droop (2.1) and its slope, and what they become: steeper with the load,
U = U₀ - k q (1 + |q|/4 Mvar)."""

SCRIPT = """
import json, sys, tpss
document = json.load(sys.stdin)
found = {}
for load_flow in ("equations", "least-squares"):
    document["simulation"]["load_flow"] = load_flow
    result = tpss.simulate(tpss.Scenario.from_document(document, "short-line"))
    station = result.dataset.isel(station=0, node=0, time=slice(0, -1))
    found[load_flow] = {
        "file": tpss.__file__,
        "audit": result.audit,
        "passes": int(result.dataset.load_flow_passes.max()),
        "voltage_v": station.node_voltage.to_numpy().tolist(),
        "reactive_var": station.station_reactive_power.to_numpy().tolist(),
    }
print(json.dumps(found))
"""
DOCUMENT = {**SHORT_LINE, "simulation": {"time_step_min": 0.5, "duration_min": 3.0}}
PLAIN = {"NUMBA_DISABLE_JIT": "1"}
"""Without compilation: it would take longer than these few steps."""


def found_by(folder, elsewhere):
    """What the program in a folder finds by both of its load flows."""
    environment = {**os.environ, **PLAIN, "PYTHONPATH": str(folder)}
    call = [sys.executable, "-c", SCRIPT]
    done = subprocess.run(
        call, env=environment, cwd=elsewhere, capture_output=True, text=True, check=False,
        input=json.dumps(DOCUMENT),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert all(Path(each["file"]).is_relative_to(folder) for each in found.values())
    return found


def test_another_droop_is_solved_and_audited_as_it_stands_in_its_file(tmp_path):
    edited, elsewhere = tmp_path / "edited", tmp_path / "elsewhere"
    shutil.copytree(SOURCE, edited / "tpss")
    elsewhere.mkdir()
    file = edited / "tpss" / "sources" / "converter.py"
    text = file.read_text("utf-8")
    for law, other in QUADRATIC.items():
        assert text.count(law) == 1, law
        text = text.replace(law, other)
    file.write_text(text, "utf-8")
    before, after = found_by(SOURCE.parent, elsewhere), found_by(edited, elsewhere)
    for found in (before, after):
        usual, squares = found["equations"], found["least-squares"]
        assert usual["audit"]["passed"], usual["audit"]["failures"]
        assert squares["audit"]["passed"], squares["audit"]["failures"]
        assert squares["voltage_v"] == pytest.approx(usual["voltage_v"], rel=1e-8)
    usual, steeper = before["equations"], after["equations"]
    assert steeper["passes"] <= usual["passes"] + 1  # the slope is that of the voltage
    for u, q in zip(usual["voltage_v"], usual["reactive_var"], strict=True):
        assert u == pytest.approx(16.5e3 - 50e-6 * q / 2, rel=1e-8)
    for u, q in zip(steeper["voltage_v"], steeper["reactive_var"], strict=True):
        assert u == pytest.approx(16.5e3 - 50e-6 * q / 2 * (1 + abs(q) / 2 / 4e6), rel=1e-8)
    differences = [a - b for a, b in zip(usual["voltage_v"], steeper["voltage_v"], strict=True)]
    assert max(differences) > 1.0
