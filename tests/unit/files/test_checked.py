"""The checksum of a document is that of what it says, and is no part of it."""

import json

import pytest

from tpss.files.checked import CHECKSUM, takes_checksum, with_checksum

DOCUMENT = {"name": "line", "losses": [0.1, 2.5], "cases": {"1": None}}


def test_a_checksum_is_right_however_the_document_is_written():
    """In another order, and with other spaces."""
    written = dict(reversed(with_checksum(DOCUMENT).items()))
    read = json.loads(json.dumps(written, indent=3))
    assert takes_checksum(read)
    assert read == DOCUMENT


def test_a_document_that_was_written_without_one_is_taken_as_it_is():
    assert takes_checksum(dict(DOCUMENT))


@pytest.mark.parametrize("change", [{"name": "lime"}, {"more": 1}, {CHECKSUM: "0" * 64}])
def test_a_change_is_noticed(change):
    assert not takes_checksum({**with_checksum(DOCUMENT), **change})


def test_what_is_written_keeps_the_document_as_it_was():
    document = dict(DOCUMENT)
    with_checksum(document)
    assert document == DOCUMENT
