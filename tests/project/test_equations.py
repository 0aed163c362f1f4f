"""Every equation leads to its code, and every citation to the bibliography."""

import ast
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from scenarios import SHORT_LINE

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "tpss"
ROWS = re.findall(
    r"^\| (\(.*?) \| .*? \| `(\S+\.py)` (.*?) \| \[.*?\]\((\S+)\) \|$",
    (ROOT / "docs/equations.md").read_text("utf-8"),
    re.M,
)


def numbers(text):
    """Equation numbers in a text, ranges written out: (F.2)-(F.4) gives F.2, F.3, F.4."""
    found = set()
    for first, last in re.findall(r"\(([2-3A-F]\.\d+[ab]?)\)(?:-\(([2-3A-F]\.\d+)\))?", text):
        found.add(first)
        if last:
            chapter, low = first.split(".")
            found.update(f"{chapter}.{k}" for k in range(int(low), int(last.split(".")[1]) + 1))
    return found


def docstring(file, name):
    tree = ast.parse((SOURCE / file).read_text("utf-8"))
    if name.startswith("("):
        return ast.get_docstring(tree) or ""
    functions = {n.name: n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)}
    return ast.get_docstring(functions[name.strip("`")]) or ""


@pytest.mark.parametrize(("equations", "file", "name", "page"), ROWS)
def test_a_row_of_the_table_leads_to_a_function_that_cites_its_equations(
    equations, file, name, page
):
    assert numbers(equations) <= numbers(docstring(file, name))


@pytest.mark.parametrize(("file", "page"), sorted({(file, page) for _, file, _, page in ROWS}))
def test_a_row_of_the_table_leads_to_a_page_that_names_the_file_and_its_limits(file, page):
    """The page says how the equation is read, and what is in doubt."""
    text = (ROOT / "docs" / page.partition("#")[0]).read_text("utf-8")
    assert f"`{file}`" in text
    assert "## Limits of validity" in text or "doubt" in text


LAST = {"2": 33, "3": 9, "B": 4, "C": 17, "D": 15, "E": 13, "F": 41}
"""Number of equations of each chapter; appendix A has none."""

THESIS = {f"{chapter}.{k}" for chapter, last in LAST.items() for k in range(1, last + 1)}
THESIS = THESIS - {"F.23"} | {"F.23a", "F.23b"}


def test_the_table_covers_the_thesis():
    """But for (F.1), a change of units; (F.23) is printed in two parts."""
    rows = set().union(*(numbers(equations) for equations, *_ in ROWS))
    assert rows == THESIS - {"F.1"}


def test_no_docstring_cites_an_equation_that_there_is_not():
    for file in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Module | ast.FunctionDef | ast.ClassDef):
                assert numbers(ast.get_docstring(node) or "") <= THESIS | {"F.23"}, file.name


def test_every_citation_stands_in_the_bibliography():
    entries = set(
        re.findall(r"\*\*\[(\w+)\]\*\*", (ROOT / "docs/bibliography.md").read_text("utf-8"))
    )
    files = [*SOURCE.rglob("*.py"), *SOURCE.rglob("*.toml"), *SOURCE.rglob("*.json")]
    cited = {
        name for file in files for name in re.findall(r"\[(\w+\d{4})\]_", file.read_text("utf-8"))
    }
    assert cited <= entries


COMPUTE_NO_EQUATION = {
    "physics": {"bridge_outside_training"},
    "conductors/formulas": set(),
    "sources": {
        "residual", "is_plausible", "losses", "reserve",
        "unloaded", "unloaded_converter", "unloaded_grid", "unloaded_mixed",
        "set_unloaded", "set_unloaded_converter", "set_unloaded_grid", "set_unloaded_mixed",
        "unloaded_rectifier", "set_unloaded_rectifier",
        # Of a law of somebody else.
        "own_residual", "own_is_plausible", "unloaded_own", "set_unloaded_own",
        "rounded",
        # Of several types of converters each is asked.
        "_of_type", "split_all", "mixed_is_plausible", "_is_plausible", "mixed_reserve", "_reserve",
    },
    "storage": set(),
    "vehicle": {
        # Which law holds, and what is evaluated when.
        "update_effort", "highest_force", "_described_force", "effort_extrapolates", "motors_force",
        "_by_own_law",
        "evaluate_rows", "update_speed_terms", "update_cap_terms", "certify_free_band",
        "within_free_band", "motor_power_demand", "armature_demand", "motors_current",
        "train_bridge_sine", "effort_outside_training", "outside_table", "effort_by_speed",
        "take_speed_as_it_is", "_settle", "effort_at", "follows_voltage", "voltage_decides",
        "lay_out_bands", "band_above", "band_below",
        "lay_out_loads", "slopes_over_load", "falls_with_power",
        # Questions about the state of a train, and what keeps it.
        "is_on_line", "brakes_within_step", "current_limits", "find_breaches", "copy_motion",
        "works_beyond_loads", "regenerates", "asks_more", "has_store", "begin_own_store",
    },
}  # fmt: skip
"""Functions of each room that compute no equation of their own: they choose, keep or ask."""


@pytest.mark.parametrize("room", COMPUTE_NO_EQUATION)
def test_every_function_that_computes_an_equation_cites_its_source(room):
    silent = {
        node.name
        for file in (SOURCE / room).rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(node, ast.FunctionDef)
        and not re.search(r"\[\w+\d{4}\]_", ast.get_docstring(node) or "")
    }
    assert silent == COMPUTE_NO_EQUATION[room]


def test_every_curve_and_network_cites_its_source():
    """The numerics of a machine's curves; that of pairs and blocks is derived where it stands."""
    helpers = {
        "index_at", "index_from", "room_to_next", "reaches", "series_at", "prepare_series", "outside",
        "exponential", "times_power_of_two", "outside_curve", "_piece_at",
    }  # fmt: skip
    for name in ("staircase", "series", "neural_network", "exponential", "curve"):
        tree = ast.parse((SOURCE / "numerics" / f"{name}.py").read_text("utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.FunctionDef) and node.name not in helpers:
                cited = re.search(r"\[\w+\d{4}\]_", ast.get_docstring(node) or "")
                assert cited, (name, node.name)


BRIDGES = {"trains.freight.reactive_power": "double-bridge", "trains.freight.efficiency": 0.8}
CASES = {
    "a stop within whole steps": {
        "simulation.time_step_min": 1.0,
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}],
        "supply.converter_stations.0.control": "loading",
    },
    "the original program": {
        "simulation.driver": "aggressive",
        "simulation.time_step_min": 0.5,
        "simulation.duration_min": 3.0,
        "simulation.load_flow": "least-squares",
        "trains.freight.motor_voltage": "former",
        "trains.freight.motor_current": "former",
        "trains.freight.filter_reactance_ohm": -0.45,
        **BRIDGES,
    },
    "at the limit of rails and machine": {
        "simulation.time_step_min": 0.5,
        "simulation.duration_min": 6.0,
        "simulation.rail": "wet",
        **BRIDGES,
    },
}
"""Changes of a short line by the name of the case; together they exercise every equation."""

SCRIPT = """
import json, sys, warnings
from pathlib import Path
called = set()
def note(frame, event, _):
    if event == "call":
        called.add((frame.f_code.co_filename, frame.f_code.co_name))
import tpss
changes = json.load(sys.stdin)
sys.setprofile(note)
result = tpss.simulate(tpss.Scenario.from_document(changes.pop("document"), "case").with_(changes))
sys.setprofile(None)
assert result.audit["passed"], result.audit
folder = Path(tpss.__file__).parent
inside = [(Path(f), name) for f, name in called if f.startswith(str(folder))]
print(json.dumps([[f.relative_to(folder).as_posix(), name] for f, name in inside]))
"""


@pytest.fixture(scope="module")
def called(tmp_path_factory):
    """Functions that the cases call, as pairs of file and name, with the first case that does."""
    environment = {**os.environ, "NUMBA_DISABLE_JIT": "1", "PYTHONPATH": str(SOURCE.parent)}
    found = {}
    for case, changes in CASES.items():
        done = subprocess.run(
            [sys.executable, "-W", "error", "-c", SCRIPT], env=environment, text=True,
            input=json.dumps({**changes, "document": SHORT_LINE}), capture_output=True, check=False,
            cwd=tmp_path_factory.mktemp("case"),
        )  # fmt: skip
        assert done.returncode == 0, (case, done.stderr[-2000:])
        for file, name in json.loads(done.stdout):
            found.setdefault((file, name), case)
    return found


def test_each_equation_is_exercised_by_a_case(called):
    """Where an equation stands in the opening text of a file, any of its functions counts."""
    files = {place for place, _ in called}
    idle = [
        equations
        for equations, file, name, _ in ROWS
        if (file not in files if name.startswith("(") else (file, name.strip("`")) not in called)
    ]
    assert not idle, f"no case computes {idle}"
