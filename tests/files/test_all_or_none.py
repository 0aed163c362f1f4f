"""Whatever kills a process, at whatever call of the file system, files are all old or all new.

A child process writes, and is killed with SIGKILL at its n-th call of the file system that changes
anything; n runs from 1 until the child lives to its end.  Then another process looks.
"""

import errno
import os
import shutil
import signal
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tpss.files import whole
from tpss.files.several import check_files, save_files
from tpss.files.whole import ABANDONED_S, write_file
from tpss.files.workplace import NEW, clear_left, put_in_place, restore, workplace

WRITE = "write"
"""What comes after a file was made and before anything is in it; no event of the interpreter."""

CHANGES = (
    "open", "os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.chmod", "shutil.rmtree", WRITE,
)  # fmt: skip
"""Events that come before the file system is changed."""

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="a process is not copied there")


def killed_at(call: int, work) -> bool:
    """Whether a process that does some work was killed at this call."""
    child = os.fork()
    if child == 0:
        seen = 0

        def count(event, _):
            nonlocal seen
            if event in CHANGES:
                seen += 1
                if seen == call:
                    os.kill(os.getpid(), signal.SIGKILL)

        sys.addaudithook(count)
        write = whole._write_through
        whole._write_through = lambda *file: (count(WRITE, None), write(*file))
        try:
            work()
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status)


def refused_from(call: int, work) -> bool:
    """Whether some work fails on a disk that is full from this call on: what is there may be moved."""
    child = os.fork()
    if child == 0:
        seen = 0

        def refuse(event, arguments):
            nonlocal seen
            needs_room = event in ("os.mkdir", WRITE, "fsync")
            if event == "open" and isinstance(arguments[2], int):
                needs_room = bool(arguments[2] & os.O_CREAT)
            if needs_room:
                seen += 1
                if seen >= call:
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

        sys.addaudithook(refuse)
        os.fsync = lambda _: refuse("fsync", ())
        status = 1
        try:
            work()
            status = 0
        finally:
            os._exit(status)
    return bool(os.waitpid(child, 0)[1])


def at_every_call(prepare, work, look, ended_at=killed_at) -> int:
    """Do some work, killed or refused at each of its calls in turn; return the number of calls."""
    call = 1
    while True:
        prepare()
        killed = ended_at(call, work)
        look(killed)
        if not killed:
            return call - 1
        call += 1


def make_old(folder: Path) -> None:
    """Let what is hidden in a folder have been made long ago."""
    for left in folder.glob(".*"):
        os.utime(left, (0.0, 0.0))


def content_of(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir() if path.is_file()}


@pytest.mark.parametrize("ended_at", [killed_at, refused_from])
@pytest.mark.parametrize("can_exchange", [True, False])
def test_a_folder_is_the_old_or_the_new_one(tmp_path, monkeypatch, can_exchange, ended_at):
    """The user's own files are in it, too; without an exchange the next one to come restores it."""
    if not can_exchange:
        monkeypatch.setattr("tpss.files.workplace.exchange", lambda *_: False)
    target, kept = tmp_path / "result", {"notes.txt": "mine"}

    def carry_over(old: Path, new: Path) -> None:
        for file in old.glob("*.txt"):
            (new / "checked").mkdir(exist_ok=True)
            file.rename(new / file.name)

    def put_right(work: Path) -> None:
        restore(work, target, carry_over)

    def prepare() -> None:
        clear_left(target, put_right)
        target.mkdir(exist_ok=True)
        for name, text in {"a.nc": "old", "b.json": "old", **kept}.items():
            (target / name).write_text(text)

    def work() -> None:
        with workplace(target, put_right) as place:
            (place / NEW).mkdir()
            for name in ("a.nc", "b.json"):
                (place / NEW / name).write_text("new")
            put_in_place(place, target, carry_over)

    def look(_: bool) -> None:
        if can_exchange:
            assert target.is_dir()
        make_old(tmp_path)
        clear_left(target, put_right)
        found = content_of(target)
        assert found in ({"a.nc": each, "b.json": each, **kept} for each in ("old", "new"))
        assert [path.name for path in tmp_path.iterdir() if path.name != "result"] == []

    assert at_every_call(prepare, work, look, ended_at) > 6


@pytest.mark.parametrize("ended_at", [killed_at, refused_from])
def test_several_files_are_all_old_or_all_new(tmp_path, ended_at):
    old, new = (dict.fromkeys(("b.csv", "in/c.csv"), each) for each in ("old", "new"))
    new |= {"a.csv": "new", "in/d.csv": "new"}

    def prepare() -> None:
        shutil.rmtree(tmp_path)
        (tmp_path / "in").mkdir(parents=True)
        for name, text in {**old, "mine.txt": "mine"}.items():
            (tmp_path / name).write_text(text)

    def look(_: bool) -> None:
        make_old(tmp_path)
        check_files(tmp_path, [], force=True)
        inner = {f"in/{name}": text for name, text in content_of(tmp_path / "in").items()}
        found = content_of(tmp_path) | inner
        assert found.pop("mine.txt") == "mine"
        assert found in (old, new)
        assert [path.name for path in tmp_path.iterdir() if path.is_dir()] == ["in"]

    def work() -> None:
        save_files(tmp_path, {name: text.encode() for name, text in new.items()}, force=True)

    assert at_every_call(prepare, work, look, ended_at) > 10


def test_a_folder_that_was_not_there_is_made_with_all_files_or_not_at_all(tmp_path):
    """Whoever comes next leaves nothing behind, where there was no folder to work in, either."""
    folder, files = tmp_path / "deep" / "tables", {"a.csv": "new", "b.csv": "new"}

    def prepare() -> None:
        shutil.rmtree(tmp_path / "deep", ignore_errors=True)

    def work() -> None:
        save_files(folder, {name: text.encode() for name, text in files.items()}, force=False)

    def look(_: bool) -> None:
        assert not folder.exists() or content_of(folder) == files
        shutil.rmtree(tmp_path / "deep", ignore_errors=True)
        make_old(tmp_path)
        check_files(folder, files, force=False)
        assert list(tmp_path.iterdir()) == []

    assert at_every_call(prepare, work, look) > 5


def test_a_file_is_the_old_or_the_new_one(tmp_path):
    place = tmp_path / "report.html"

    def look(killed: bool) -> None:
        assert place.read_text() in (("old", "new") if killed else ("new",))
        make_old(tmp_path)

    calls = at_every_call(lambda: place.write_text("old"), lambda: write_file(place, b"new"), look)
    assert calls >= 2
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]  # what was left is cleared


def test_what_others_are_writing_is_not_cleared(tmp_path):
    theirs = tmp_path / ".a.json-01234567.unfinished"
    theirs.write_text("half")
    write_file(tmp_path / "a.json", b"whole")
    assert theirs.exists()
    long_ago = theirs.stat().st_mtime - 2.0 * ABANDONED_S
    os.utime(theirs, (long_ago, long_ago))
    write_file(tmp_path / "a.json", b"whole")
    assert not theirs.exists()


def test_writers_of_one_file_do_not_meet(tmp_path):
    place, contents = tmp_path / "study.json", [bytes([k]) * 100_000 for k in range(8)]
    with ThreadPoolExecutor(8) as writers:
        list(writers.map(lambda content: write_file(place, content), contents * 5))
    assert place.read_bytes() in contents
    assert len(list(tmp_path.iterdir())) == 1


def test_a_workplace_in_use_is_left_alone(tmp_path):
    target = tmp_path / "result"
    with workplace(target) as theirs:
        clear_left(target)
        assert theirs.is_dir()
    assert list(tmp_path.iterdir()) == []


def test_many_work_on_one_target_at_once(tmp_path):
    """Each of them clears first what it takes for left behind, and none of them loses its folder."""

    def work_once(number: int) -> str:
        with workplace(tmp_path / "result") as work:
            (work / NEW).write_text(str(number))
            return (work / NEW).read_text()

    with ThreadPoolExecutor(8) as workers:
        assert list(workers.map(work_once, range(400))) == [str(number) for number in range(400)]
    assert list(tmp_path.iterdir()) == []
