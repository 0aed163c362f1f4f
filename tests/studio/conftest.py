"""A scenario that is open in the studio, and a client that asks as its page does."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tpss.studio.desk import Desk
from tpss.studio.live import Live
from tpss.studio.newest import Newest

from studio_page import LINE, Page


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A short line in a file with comments."""
    path = tmp_path / "line.toml"
    path.write_text(LINE, encoding="utf-8")
    return path


@pytest.fixture
def page_of() -> Callable[[Path], Page]:
    return lambda path: Page(Live(Desk(path), Newest()))


@pytest.fixture
def page(file: Path, page_of: Callable[[Path], Page]) -> Page:
    """A page on which that file is open."""
    return page_of(file)
