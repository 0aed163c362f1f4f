"""The run that never was, and files beside it."""

from collections.abc import Callable
from pathlib import Path

import pytest

import tpss

from measured_files import made_up_result


@pytest.fixture
def result() -> tpss.Result:
    """Powers of two stations, without a clock."""
    return made_up_result()


@pytest.fixture
def file(tmp_path: Path) -> Callable[..., Path]:
    """Writes a file, of text or bytes, and gives its path."""

    def write(content: str | bytes, name: str = "measured.csv") -> Path:
        path = tmp_path / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return write
