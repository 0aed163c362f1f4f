"""Drafts survive pages and servers, and no page overwrites the edits of another."""

import pytest

from tpss.errors import TpssError
from tpss.studio.drafts import Draft, Drafts, OvertakenError

EDIT = {"label": "headway 12", "pairs": [["traffic.0.headway_min", 12.0]]}


def test_without_any_it_has_no_edits(file):
    assert Drafts(file).read() == Draft()


def test_what_is_kept_is_there_for_the_next_server(file):
    kept = Drafts(file).keep(Draft(0, "of the file", (EDIT,), ()))
    assert Drafts(file).read() == kept
    assert kept.revision == 1
    assert kept.edits == (EDIT,)


def test_a_page_that_does_not_know_the_last_one_is_overtaken(file):
    drafts = Drafts(file)
    drafts.keep(Draft(0, "", (EDIT,), ()))
    with pytest.raises(OvertakenError):
        drafts.keep(Draft(0, "", (), ()))
    assert drafts.read().edits == (EDIT,)


def test_they_lie_beside_the_file(file):
    Drafts(file).keep(Draft())
    names = [each.relative_to(file.parent).as_posix() for each in file.parent.rglob("*")]
    assert sorted(names) == [".tpss-studio", ".tpss-studio/line.toml.json", "line.toml"]


def test_a_file_that_is_no_draft_is_told(file):
    drafts = Drafts(file)
    drafts.keep(Draft())
    drafts.place.write_text("[]", encoding="utf-8")
    with pytest.raises(TpssError, match="is no draft"):
        drafts.read()


def test_two_pages_learn_of_each_other(page):
    told = {"revision": 0, "digest": "d", "edits": [EDIT], "undone": []}
    assert page.ask("keep-draft", **told) == {"revision": 1}
    assert page.ask("keep-draft", **told)["overtaken"] is True
    assert page.ask("read-draft")["edits"] == [EDIT]
