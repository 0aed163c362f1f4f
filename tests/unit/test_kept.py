"""What many cases have in common is made once, told apart by its content, and not kept without bound."""

import numpy as np
import pytest

from tpss.kept import Kept, content_of
from tpss.record import Record


class Place(Record):
    position_m: float
    track: int


def test_a_value_is_made_once():
    kept, made = Kept[str](4), []
    for _ in range(3):
        assert kept.of("key", lambda: made.append(1) or "value") == "value"
    assert made == [1]


def test_what_was_made_first_goes_when_there_are_too_many():
    kept = Kept[int](2)
    for key in (1, 2, 3):
        kept.put(key, 10 * key)
    assert (kept.get(1), kept.get(2), kept.get(3), len(kept)) == (None, 20, 30, 2)
    kept.put(2, 21)  # takes the place of the other one, and counts as new
    kept.put(4, 40)
    assert (kept.get(2), kept.get(3), kept.get(4)) == (21, None, 40)


def test_an_error_is_not_kept():
    kept, raised = Kept[int](2), []

    def fail():
        raised.append(1)
        raise ValueError

    for _ in range(2):
        with pytest.raises(ValueError):
            kept.of("key", fail)
    assert raised == [1, 1]


def test_content_is_that_of_all_bytes_and_of_the_shape():
    def content(position_m, track, shape):
        return content_of((Place.array([(position_m, track)] * 6).reshape(shape), 1.5))

    assert content(2.0, 1, (2, 3)) == content(2.0, 1, (2, 3))
    assert hash(content(2.0, 1, (2, 3))) == hash(content(2.0, 1, (2, 3)))
    others = [(2.0, 2, (2, 3)), (2.0, 1, (3, 2)), (np.nextafter(2.0, 3.0), 1, (2, 3))]
    assert content(2.0, 1, (2, 3)) not in [content(*each) for each in others]
