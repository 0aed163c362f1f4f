"""Docstrings as words and formulas that a browser draws."""

from xml.etree import ElementTree

import pytest

from tpss.studio.formulas import in_pieces, mathml

MATHML = "{http://www.w3.org/1998/Math/MathML}"
DOCSTRING = r"""Force of the wheels, with :math:`\mu` for both rails. [N]

.. math:: F_{max} = \mu m g

Whatever stands below, it is

    as it was written.

.. math::
    a &= b + c \\
    d &= e

References
----------
[Somebody2020]_
"""


def test_words_stay_and_formulas_are_drawn_in_their_order():
    pieces = in_pieces(DOCSTRING)
    assert ["words" in piece for piece in pieces] == [True, False, True, False, True, False, True]
    assert pieces[0] == {"words": "Force of the wheels, with "}
    assert pieces[4]["words"].strip() == "Whatever stands below, it is\n\n    as it was written."
    assert pieces[6]["words"].strip() == "References\n----------\n[Somebody2020]_"


def test_lines_of_a_formula_stand_below_each_other():
    rows = ElementTree.fromstring(in_pieces(DOCSTRING)[5]["formula"]).iter(f"{MATHML}mtr")
    assert ["".join(row.itertext()) for row in rows] == ["a=b+c", "d=e"]


def test_a_word_below_a_symbol_is_a_word():
    """Letters would be a product: F with m, a and x below it."""
    assert [
        each.text
        for each in ElementTree.fromstring(mathml("F_{max}", False)).iter(f"{MATHML}mtext")
    ] == ["max"]


def test_a_text_without_formulas_is_one_piece():
    assert in_pieces("Only words.") == [{"words": "Only words."}]


@pytest.mark.parametrize(("displayed", "display"), [(True, "block"), (False, "inline")])
def test_a_formula_stands_on_a_line_of_its_own_or_within_one(displayed, display):
    assert ElementTree.fromstring(mathml("a", displayed)).get("display") == display
