"""Those who listen to the logger ``tpss`` learn what is simulated, how it ended, and where it is."""

import logging

import pytest

import tpss
from tpss.events import EVENTS, tell

from scenarios import short_line

MINUTES = {"simulation.duration_min": 2.0}


def told(caplog) -> list[str]:
    return [record.event for record in caplog.records if record.name == "tpss"]


def test_a_run_tells_its_beginning_its_end_and_its_place(caplog, tmp_path):
    caplog.set_level(logging.INFO, logger="tpss")
    result = tpss.simulate(short_line(MINUTES))
    result.save(tmp_path / "result")
    events = told(caplog)
    assert events[0 if events[0] != "compiling" else 1] == "simulating"
    assert events[-2:] == ["simulated", "saved"]
    end, saved = caplog.records[-2:]
    name = result.scenario.name
    assert end.getMessage().startswith(f"{name}: finished after 2.0 min, in ")
    assert end.fields["limited"] == sum(result.summary["limited"].values())
    assert saved.getMessage() == f"{name}: saved in {tmp_path / 'result'}"


def test_notes_of_a_run_are_told(caplog, monkeypatch):
    monkeypatch.setattr("tpss.api.notes", lambda result: ["West carries more than it is rated for"])
    caplog.set_level(logging.INFO, logger="tpss")
    tpss.simulate(short_line(MINUTES))
    note, end = caplog.records[-2:]
    assert note.getMessage() == "short-line: West carries more than it is rated for"
    assert end.fields["notes"] == 1


def test_notes_are_not_gathered_for_nobody(monkeypatch):
    monkeypatch.setattr("tpss.api.notes", lambda result: pytest.fail("nobody listens"))
    tpss.simulate(short_line(MINUTES))


def test_a_failed_audit_is_a_warning(caplog):
    tell("audit failed", scenario="line", failures="power_mismatch_va is 3, limit 0.01")
    (record,) = caplog.records
    assert record.levelno == logging.WARNING
    assert record.getMessage() == "line: the audit failed: power_mismatch_va is 3, limit 0.01"


@pytest.mark.parametrize("event", EVENTS)
def test_words_name_fields_by_their_names(event):
    """As a dict is what a record of a logger takes its words from."""
    level, words = EVENTS[event]
    assert level in (logging.INFO, logging.WARNING)
    assert "%s" not in words


def test_nobody_who_does_not_listen_hears_anything(capsys):
    tpss.simulate(short_line(MINUTES))
    tell("audit failed", scenario="line", failures="")
    assert capsys.readouterr() == ("", "")
    assert any(isinstance(each, logging.NullHandler) for each in logging.getLogger("tpss").handlers)
