"""Fixtures shared by all tests."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tpss.kernel import plain

SHARED = Path(__file__).parents[2] / "shared"
EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.fixture(params=["compiled", "plain"])
def as_run(request: pytest.FixtureRequest) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Gives a kernel once compiled, once as plain Python."""
    return plain if request.param == "plain" else lambda kernel: kernel
