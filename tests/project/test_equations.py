"""Every equation leads to its code, and every citation to the bibliography."""

import ast
import re
from pathlib import Path

import pytest

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


def test_every_function_of_physics_cites_a_source():
    """Helpers that compute no equation of their own are named here."""
    helpers = {
        "step_index", "stair_ahead", "reaches", "series_at", "prepare_series", "outside", "exponential",
        "effort_outside_training", "bridge_outside_training", "take_speed", "speed_is_taken",
        "prove_free_band", "train_armature_current", "train_bridge_sine", "note_cap",
        "motor_power_demand",
        "armature_demand", "outside_curve", "take_rows", "outside_table", "take_effort",
        "highest_force", "_described_force", "effort_extrapolates",
    }  # fmt: skip
    for file in (SOURCE / "physics").glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.FunctionDef) and node.name not in helpers:
                cited = re.search(r"\[\w+\d{4}\]_", ast.get_docstring(node) or "")
                assert cited, (file.name, node.name)
