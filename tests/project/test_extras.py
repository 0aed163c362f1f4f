"""A small core, and extras for what needs more: what is missing is told with what installs it."""

import ast
import importlib
import re
import runpy
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import tpss
from tpss import extras
from tpss.extras import NEEDS, PACKAGES, demand, imports_explained, remedy

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
OF_EXTRAS = sorted({module for need in NEEDS.values() for module in need.modules})
WITHIN = {
    "PIL": "matplotlib",
    "threadpoolctl": "scikit-learn",
    "psutil": "distributed",
    "llvmlite": "numba",
}
"""Modules that come with a package that is asked for."""

ALONE = (
    "import sys; sys.modules |= dict.fromkeys({modules!r}); "
    "from tpss.__main__ import main; sys.argv = ['tpss', *{arguments!r}]; main()"
)
"""The command line as if some modules were not installed."""


def names_of(extra: str) -> set[str]:
    """Packages of an extra, and of those that it names."""
    found: set[str] = set()
    for requirement in PROJECT["optional-dependencies"][extra]:
        if own := re.fullmatch(r"tpss\[(.*)\]", requirement):
            found |= {name for other in own[1].split(",") for name in names_of(other)}
        else:
            found.add(re.match(r"[\w-]+", requirement)[0].lower())
    return found


def imported(folder: Path) -> Iterator[tuple[Path, str]]:
    """Modules that the files of a folder import, those of Python apart."""
    for file in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module]
            for name in (each.partition(".")[0] for each in names):
                if name not in sys.stdlib_module_names:
                    yield file, name


def package(module: str) -> str:
    return (
        {"tomli_w": "tomli-w", "netCDF4": "netcdf4", "pydantic_core": "pydantic"}
        | PACKAGES
        | WITHIN
    ).get(module, module)


CORE = {re.match(r"[\w-]+", each)[0].lower() for each in PROJECT["dependencies"]}


def test_what_is_imported_is_in_the_core_or_asked_for():
    for file, module in imported(ROOT / "src" / "tpss"):
        needed = module in OF_EXTRAS or package(module) in CORE or module == "threadpoolctl"
        assert module == "tpss" or needed, f"{file} imports {module}"


@pytest.mark.parametrize("need", NEEDS)
def test_the_extra_that_is_named_has_what_is_needed(need):
    assert {package(module) for module in NEEDS[need].modules} <= names_of(NEEDS[need].extra)


def test_the_core_has_no_package_of_an_extra():
    assert not CORE & {package(module) for module in OF_EXTRAS}


def test_all_has_every_extra_of_users():
    of_developers = {"test", "bench", "docs", "all"}
    users = set(PROJECT["optional-dependencies"]) - of_developers
    assert names_of("all") == {name for extra in users for name in names_of(extra)}


def test_the_matrix_tries_every_extra_of_users():
    matrix = runpy.run_path(str(ROOT / ".ci" / "matrix"))
    extras_of_users = set(PROJECT["optional-dependencies"]) - {"test", "bench", "docs"}
    assert set(matrix["TESTS"]) == set(matrix["ANSWERED"]) == {"", *extras_of_users}
    for files in matrix["TESTS"].values():
        assert all((ROOT / file).exists() for file in files)


def test_the_installation_page_lists_every_extra_of_users():
    page = (ROOT / "docs" / "how-to" / "install.md").read_text("utf-8")
    listed = set(re.findall(r"^\| `([a-z-]+)` \|", page, re.MULTILINE))
    assert listed == set(PROJECT["optional-dependencies"]) - {"test", "bench", "docs"}


def test_the_tests_ask_for_all_that_they_import():
    own = {path.stem for path in ROOT.glob("tests/**/*")} | {"tests", "tpss"}
    own |= {path.stem for path in ROOT.glob("benchmarks/**/*.py")} | {"benchmarks"}
    for file, module in imported(ROOT / "tests"):
        if module not in own:
            assert package(module) in CORE | names_of("test"), f"{file} imports {module}"


def test_a_missing_package_is_told_with_the_extra(monkeypatch):
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(tpss.StudyError) as caught:
        demand("study", "report")
    assert str(caught.value) == (
        "studies need pyarrow, scipy; reports need jinja2, plotly, not installed: "
        'pip install "tpss[study,report]"'
    )
    assert remedy("training") == 'pip install "tpss[study]"'


def test_the_error_is_that_of_the_first_need_that_lacks_something(monkeypatch):
    monkeypatch.setattr(extras, "find_spec", lambda name: None if name == "plotly" else object())
    with pytest.raises(tpss.ResultError, match=r'^reports need plotly.*"tpss\[report\]"$'):
        demand("study", "report")


def test_an_import_says_which_extra_it_lacks(monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly", None)
    words = r'reports need plotly.*"tpss\[report\]"'
    with pytest.raises(tpss.ResultError, match=words), imports_explained():
        importlib.import_module("plotly")
    with pytest.raises(ModuleNotFoundError, match="nowhere"), imports_explained():
        importlib.import_module("nowhere")


def told_without(modules: list[str], *arguments: object) -> subprocess.CompletedProcess[str]:
    code = ALONE.format(modules=modules, arguments=list(map(str, arguments)))
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A scenario, and its result, made by the core alone."""
    place = tmp_path_factory.mktemp("core")
    for call in (
        ("new", place / "line"),
        ("check", place / "line/scenario.toml"),
        ("run", place / "line/scenario.toml", "--out", place / "result", "--no-step-check"),
        ("export", place / "result"),
        ("library",),
        ("schema", "--out", place / "schema.json"),
    ):
        done = told_without(OF_EXTRAS, *call)
        assert done.returncode == 0, done.stderr
    return place


def test_the_core_makes_checks_runs_and_exports(folder):
    assert (folder / "result/result.nc").is_file()
    assert sorted((folder / "result/tables").glob("*.csv"))


@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (["run", "line/scenario.toml", "--out", "new", "--report"], "report"),
        (["outages", "line/scenario.toml", "--out", "new", "--report"], "report"),
        (["converters", "line/scenario.toml", "--plot", "new.png"], "report"),
        (["spare-time", "line/scenario.toml", "--plot", "new.png"], "report"),
        (["report", "result"], "report"),
        (["compare", "result", "none.csv", "--report"], "report"),
        (["compare", "result", "none.csv", "--out", "new"], "report"),
        (["plot", "result", "--out", "new"], "report"),
        (["export", "result", "--to", "xlsx", "--out", "new"], "excel"),
        (["export", "result", "--to", "parquet", "--out", "new"], "parquet"),
        (["sweep", "none.toml", "--out", "new"], "study"),
        (["sweep", "--summary", "none"], "study"),
        (["sweep", "none.toml", "--case", "1", "--out", "new"], "study"),
        (["approximate", "train", "none", "--out", "new"], "study"),
        (["approximate", "predict", "none", "--table", "none.parquet"], "parquet"),
        (["plan", "check", "none.toml"], "plan"),
        (["plan", "run", "none.toml", "--out", "new"], "plan"),
        (["plan", "price", "none"], "plan"),
        (["plan", "why", "none", "AT in 2030"], "plan"),
        (["plan", "report", "none"], "report,plan"),
        (["run", "line/scenario.toml", "--set", "simulation.load_flow=least-squares"], "least-squares"),
        (["run", "line/scenario.toml", "--set", "line.gradients_file=a.xlsx"], "excel"),
    ],
)  # fmt: skip
def test_a_command_says_what_it_lacks_before_it_does_anything(
    folder, monkeypatch, arguments, extra
):
    monkeypatch.chdir(folder)
    (folder / "line" / "a.xlsx").write_bytes(b"")
    before = sorted(folder.rglob("*"))
    done = told_without(OF_EXTRAS, *arguments)
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert f'pip install "tpss[{extra}]"' in done.stderr
    assert done.stdout == ""
    assert sorted(folder.rglob("*")) == before


@pytest.mark.parametrize(
    ("code", "extra"),
    [
        ("tpss.write_report", "report"),
        ("tpss.run_study", "study"),
        ("tpss.load_result({result!r}).report({new!r})", "report"),
        ("tpss.load_result({result!r}).plot()", "report"),
        ("tpss.load_result({result!r}).to_excel({new!r})", "excel"),
    ],
)
def test_a_script_is_told_too(folder, code, extra):
    call = code.format(result=str(folder / "result"), new=str(folder / "new.xlsx"))
    script = f"import sys; sys.modules |= dict.fromkeys({OF_EXTRAS!r}); import tpss; {call}"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert done.stderr.splitlines()[-1].startswith("tpss.errors.")
    assert f'pip install "tpss[{extra}]"' in done.stderr
