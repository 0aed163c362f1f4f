"""Fixtures shared by all tests, and how the whole of the tests is spread over processes."""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # small matrices: threads only cost
os.environ["TPSS_LIBRARY"] = ""  # whoever runs the tests may have a library of their own

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tpss.kernel import plain

from chromium import browser as browser
from one_compile import compile_once

SHARED = Path(__file__).parents[2] / "shared"
EXAMPLES = Path(__file__).parents[1] / "examples"
OTHER_FILES = ("study_*.toml", "plan_*.toml", "geometry_*.toml")
"""Examples that are no scenarios."""

EXAMPLE_SCENARIOS = sorted(
    {*EXAMPLES.glob("*.toml")} - {file for each in OTHER_FILES for file in EXAMPLES.glob(each)}
)


@pytest.hookimpl(tryfirst=True)
def pytest_xdist_auto_num_workers(config: pytest.Config) -> int | None:
    """A process for each core if all tests are run; a part is done before they would have started."""
    return None if are_all(config) else 0


def are_all(config: pytest.Config) -> bool:
    """Whether all tests are run."""
    return config.args_source is pytest.Config.ArgsSource.TESTPATHS


def pytest_configure(config: pytest.Config) -> None:
    """Compile the kernels of every run before the processes start that would each do so.

    What only some of all tests need is compiled beside the first of them.
    """
    compile_once()
    if config.option.tx and not hasattr(config, "workerinput"):
        import tpss
        from tpss.run.kernels import are_ready

        from scenarios import short_line

        if not are_ready():
            print("Compiling the numerical kernels, once.", file=sys.stderr)
            tpss.simulate(short_line())
        if are_all(config):
            warm_up = subprocess.Popen([sys.executable, Path(__file__).with_name("warm_up.py")])
            config.add_cleanup(warm_up.wait)


@pytest.fixture(params=["compiled", "plain"])
def as_run(request: pytest.FixtureRequest) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Gives a kernel once compiled, once as plain Python."""
    return plain if request.param == "plain" else lambda kernel: kernel
