"""Pictures within a page, and words, columns and cells in all renderers."""

import re

import numpy as np
import pytest

from tpss.report.drawings.parts import (
    BELOW,
    RING,
    Bar,
    Curve,
    Drawing,
    Mark,
    Panel,
    Places,
    Words,
)
from tpss.report.render import interactive, static
from tpss.report.render.inline import inline

EVIL = "$a_1$ <b> & \"c\" id='x'"


@pytest.fixture(scope="module")
def drawing():
    """A row of two cells below the names of their columns, with words beside them."""
    items = [
        Bar(0, -0.5, 1.0, EVIL, "one", "#0072B2", height=0.94),
        Bar(0, 0.5, 1.0, "two", "", "#F7CF8B", height=0.94),
        Curve(np.array([0.0, 1.0]), np.array([0.0, 0.0])),
        Places(np.array([1.0]), np.array([0.0]), "place", RING, "#009E73", ()),
        Mark(0.5, "today", upright=True),
        Words(1.5, 0.0, EVIL, BELOW, bold=True),
    ]
    panel = Panel("", items, rows=[EVIL])
    return Drawing(EVIL, [panel], (-0.5, 2.0), columns=["2030", EVIL], width_inch=9.0)


def texts(svg):
    return re.findall(r"<text[^>]*>([^<]*)</text>", svg)


def test_text_of_a_picture_is_text_as_it_was_given(drawing):
    """Five times: axis, column, row, words, and the legend."""
    svg = inline(drawing, "k", EVIL)
    assert texts(svg).count("$a_1$ &lt;b&gt; &amp; \"c\" id='x'") == 5
    assert {"one", "2030", "today"} <= set(texts(svg))
    assert "aria-label=\"$a_1$ &lt;b&gt; &amp; &quot;c&quot; id='x'\"" in svg


def test_pictures_of_a_page_share_no_names(drawing):
    def names(key):
        svg = inline(drawing, key, "a picture")
        own = set(re.findall(r' id="([^"]*)"', svg))
        used = set(re.findall(r'(?:href="#|url\(#)([^")]*)', svg))
        assert used <= own
        return own

    assert names("a")
    assert not names("a") & names("b")


def test_a_picture_has_the_colours_of_its_page(drawing):
    svg = inline(drawing, "k", "a picture")
    assert "var(--ink)" in svg
    assert "stroke: var(--page)" in svg
    assert "font-family" not in svg
    assert re.search(r'<path[^>]*style="fill: #0072b2', svg)  # an area stays what it is


def test_the_same_drawing_gives_the_same_picture(drawing):
    assert inline(drawing, "k", "words") == inline(drawing, "k", "words")


def test_a_page_s_plot_has_the_same_words_columns_and_cells(drawing):
    figure = interactive.render(drawing, 300)
    assert list(figure.layout.xaxis.ticktext) == ["2030", EVIL]
    assert [trace.width for trace in figure.data if trace.type == "bar"] == [0.94, 0.94]
    assert f"<b>{EVIL}</b>" in [each.text for each in figure.layout.annotations]


def test_names_of_columns_stand_upright_where_they_are_long():
    cells = [Bar(0, k - 0.5, 1.0, "", "", "#F7CF8B", height=0.94) for k in range(20)]
    panel = Panel("", cells, rows=["row"])
    for names, turned in (([str(k) for k in range(20)], 0.0), (["a long name"] * 20, 90.0)):
        (axes,) = static.render(Drawing("", [panel], columns=names)).axes
        assert {label.get_rotation() for label in axes.get_xticklabels()} == {turned}
