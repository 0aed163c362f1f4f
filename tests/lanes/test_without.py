"""Where kernels of lanes cannot be made, cases run alone, as ever; who demanded lanes is told why.

Each case runs in a process of its own: what lanes are made of is imported once.
"""

import logging
import subprocess
import sys

import pytest
from numba.core.errors import TypingError

import tpss
from tpss import many
from tpss.errors import LanesError
from tpss.lanes.compile import lane_version, lanes_folder
from tpss.many import _do_without

import unconverted
from scenarios import short_line

SETTING = """
import logging
import sys
import tpss
from tpss.lanes import compile as making
from scenarios import short_line
import unconverted

told = []
class Heard(logging.Handler):
    def emit(self, record):
        if record.event == "no lanes":
            told.append(record.getMessage())
logging.getLogger("tpss").addHandler(Heard())
CASES = [short_line({"trains.freight.mass_t": 900.0 + 50.0 * k}) for k in range(9)]
"""

A_FILE_IN_PLACE_OF_THE_FOLDER = """
import pathlib, tempfile
blocked = pathlib.Path(tempfile.mkdtemp()) / "lanes"
blocked.write_text("")
making.lanes_folder = lambda: blocked
"""

A_FORM_THAT_IS_NOT_CONVERTED = """
import tpss.step.traffic
tpss.step.traffic.depart = unconverted.cubes
"""

RUNS_ALONE = """
alone = list(tpss.simulate_many(CASES, 2, lanes=False))
tpss.many.are_compiled = lambda: True
found = list(tpss.simulate_many(CASES, 2))
print({each.way for each in found}, found == alone, len(told), *told)
"""

IS_TOLD = """
try:
    list(tpss.simulate_many(CASES, 2, lanes=True))
except tpss.LanesError as error:
    print(error)
"""
REASONS = {
    A_FILE_IN_PLACE_OF_THE_FOLDER: "lanes cannot be written: ",
    A_FORM_THAT_IS_NOT_CONVERTED: (
        "unconverted.cubes has a form that is not converted, a power that is not a square: x ** 3"
    ),
}


def printed(*parts: str) -> str:
    """What a process prints that runs these lines."""
    lines = "\n".join((f"import sys; sys.path[:0] = {sys.path!r}", SETTING, *parts))
    done = subprocess.run([sys.executable, "-c", lines], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.mark.parametrize("obstacle", REASONS, ids=["folder", "form"])
def test_cases_run_alone_where_lanes_cannot_be_made(obstacle):
    """To the figures that they would have had, and it is told once, though two threads find out."""
    told = printed(obstacle, RUNS_ALONE)
    assert told.startswith("{'alone'} True 1 cases run alone, as lanes cannot be used: ")
    assert REASONS[obstacle] in told


@pytest.mark.parametrize("obstacle", REASONS, ids=["folder", "form"])
def test_whoever_demands_lanes_is_told_why_there_are_none(obstacle):
    told = printed(obstacle, IS_TOLD)
    assert told.startswith("cases cannot run in lanes: ")
    assert REASONS[obstacle] in told
    assert told.endswith("; leave out lanes=True")


def test_what_is_known_to_be_unusable_is_told_once(monkeypatch, caplog):
    monkeypatch.setattr(many, "_unusable", [])
    caplog.set_level(logging.WARNING, logger="tpss")
    for _ in range(3):
        _do_without("the folder is full")
    (record,) = caplog.records
    assert record.getMessage() == "cases run alone, as lanes cannot be used: the folder is full"


def test_what_numba_does_not_compile_is_told_as_well(monkeypatch):
    def fails(_):
        raise TypingError("no such type")

    monkeypatch.setattr(many, "_in_lanes", fails)
    monkeypatch.setattr(many, "_unusable", [])
    cases = [short_line()] * 4
    with pytest.raises(LanesError, match=r"no such type; leave out lanes=True$"):
        list(tpss.simulate_many(cases, 1, lanes=True))
    monkeypatch.setattr(many, "are_compiled", lambda: True)
    assert [each.way for each in tpss.simulate_many(cases, 1)] == ["alone"] * 4


@pytest.mark.parametrize("kernel", unconverted.KERNELS, ids=lambda kernel: kernel.__name__)
def test_a_form_that_is_not_converted_is_shown(kernel):
    with pytest.raises(LanesError) as caught:
        lane_version(kernel)
    name, _, rest = str(caught.value).partition(" has a form that is not converted, ")
    assert name == f"unconverted.{kernel.__name__}"
    assert kernel.__doc__.rstrip(".").lower() in rest
    assert rest.endswith(
        "; write it in one of those of tpss.lanes.convert, or its lane version by hand"
    )


def test_a_kernel_that_calls_one_with_such_a_form_is_not_to_blame():
    with pytest.raises(tpss.LanesError, match=r"^unconverted\.cubes has a form"):
        lane_version(unconverted.calls_one)


def test_to_ask_for_the_folder_does_not_make_it(monkeypatch, tmp_path):
    monkeypatch.setattr("tpss.lanes.compile.cache_folder", lambda: tmp_path)
    assert not lanes_folder.__wrapped__().exists()
