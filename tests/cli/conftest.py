"""The command line, called in an empty folder."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest
import tomli_w

from tpss.cli.main import main

from scenarios import SHORT_LINE


@dataclass(frozen=True)
class Said:
    """What a call of the command line printed, its white space made even, and its exit code."""

    code: int | str | None
    out: str
    err: str


@pytest.fixture
def tpss_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Said]:
    """The command line in an empty folder; no call of it may print a traceback."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.delenv("TPSS_DEBUG", raising=False)

    def call(*arguments: object) -> Said:
        capsys.readouterr()
        monkeypatch.setattr("sys.argv", ["tpss", *map(str, arguments)])
        with pytest.raises(SystemExit) as exited:
            main()
        out, err = (" ".join(text.split()) for text in capsys.readouterr())
        assert "Traceback" not in out + err
        return Said(exited.value.code, out, err)

    return call


@pytest.fixture
def short_file(tmp_path: Path) -> Path:
    """The short line as a file."""
    file = tmp_path / "short_line.toml"
    file.write_text(tomli_w.dumps(SHORT_LINE), encoding="utf-8")
    return file
