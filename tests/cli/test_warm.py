"""`tpss warm` compiles all kernels ahead, and says so if nothing had to be compiled."""

import numba
import pytest

from tpss import api, examples, kernel, load_scenario, warm
from tpss.run.kernels import optional_parts


@pytest.fixture
def only_every_run(monkeypatch):
    first = next(iter(warm.OCCASIONS))
    monkeypatch.setattr(warm, "OCCASIONS", {first: warm.OCCASIONS[first]})


def test_what_is_compiled_already_is_not_compiled_again(tpss_command, only_every_run, tmp_path):
    assert tpss_command("warm").code == 0
    said = tpss_command("warm")
    assert said.code == 0
    assert f"Nothing had to be compiled; the kernels are in {kernel.cache_folder()}" in said.out
    assert list(tmp_path.iterdir()) == []


def test_quietly_nothing_is_said(tpss_command, only_every_run):
    said = tpss_command("warm", "--quiet")
    assert (said.code, said.out, said.err) == (0, "", "")


def test_what_was_compiled_is_counted(only_every_run, monkeypatch):
    pieces = iter([3, 5])
    monkeypatch.setattr(warm, "_on_disk", lambda: next(pieces))
    told = []
    assert warm.warm(told.append) == 2
    assert told == [("every run", 0, 1)]


@pytest.mark.parametrize("name", warm.OCCASIONS)
def test_an_occasion_is_a_sound_scenario(name):
    occasion = warm.OCCASIONS[name]
    api.build(load_scenario(examples.path(occasion.example), occasion.changes))


def test_each_part_that_most_networks_lack_is_some_occasion_s():
    found = [
        optional_parts(
            api.build(load_scenario(examples.path(each.example), each.changes)).start.model.network
        )
        for each in warm.OCCASIONS.values()
    ]
    assert all(any(column) for column in zip(*found, strict=True))


def test_kernels_that_cannot_be_kept_are_a_fault(tpss_command, monkeypatch, tmp_path):
    monkeypatch.setattr(kernel, "kernels_home", lambda: tmp_path)
    said = tpss_command("warm")
    assert said.code == 2
    assert "cannot be kept; let NUMBA_CACHE_DIR name a folder" in said.err


def test_without_compilation_there_is_nothing_to_do(tpss_command, monkeypatch):
    monkeypatch.setattr(numba.config, "DISABLE_JIT", 1)
    said = tpss_command("warm")
    assert said.code == 2
    assert "NUMBA_DISABLE_JIT is set, so nothing is compiled" in said.err


def test_an_interruption_keeps_what_was_compiled(tpss_command, monkeypatch):
    def interrupted(_):
        raise KeyboardInterrupt

    monkeypatch.setattr("tpss.warm.warm", interrupted)
    said = tpss_command("warm")
    assert said.code == 130
    assert "Interrupted; the same command continues." in said.err
