"""The report of a plan in a browser, opened from the disk: it has room, sorts, and asks nobody."""

import pytest

from tpss.planning.report import write_plan_report

from chromium import needs_chromium
from solved_plans import many, solved

pytestmark = needs_chromium


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """The plan with ten configurations and 27 scenarios, which needs the most room."""
    return write_plan_report(solved(tmp_path_factory.mktemp("plan"), many()))


@pytest.fixture
def opened(browser, file):
    """The open page, which must not have failed nor asked for anything when it is closed."""
    tab, faults, requests = browser.new_page(), [], []
    tab.on("console", lambda message: faults.append(message.text))
    tab.on("pageerror", lambda error: faults.append(str(error)))
    tab.on("request", lambda request: requests.append(request.url))
    tab.goto(file.as_uri(), timeout=120_000)
    tab.wait_for_selector("body[data-ready]", timeout=120_000)
    yield tab
    tab.close()
    assert faults == []
    assert requests == [file.as_uri()]


@pytest.mark.parametrize("width", [360, 1250])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_nothing_is_wider_than_the_page(opened, width, scheme):
    """Wide pictures and tables scroll by themselves."""
    opened.set_viewport_size({"width": width, "height": 900})
    opened.emulate_media(color_scheme=scheme)
    assert opened.evaluate("document.documentElement.scrollWidth") <= width


OVERLAPS = """svg => {
    const boxes = [...svg.querySelectorAll("text")]
        .map((text) => [text.getBoundingClientRect(), text.textContent])
        .filter(([, words]) => words);
    const found = [];
    boxes.forEach(([a, first], k) => boxes.slice(k + 1).forEach(([b, second]) => {
        const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (wide > 2 && high > 0.4 * Math.min(a.height, b.height)) found.push(`${first} | ${second}`);
    }));
    return found;
}"""
"""Texts of a picture that lie on each other."""

OUTSIDE = """svg => {
    const all = svg.getBoundingClientRect();
    return [...svg.querySelectorAll("text")]
        .filter((text) => {
            const own = text.getBoundingClientRect();
            return own.left < all.left - 2 || own.right > all.right + 2;
        }).map((text) => text.textContent);
}"""
"""Texts of a picture that are cut at its sides."""


def test_no_word_of_a_picture_lies_on_another_or_is_cut(opened):
    opened.set_viewport_size({"width": 1250, "height": 900})
    pictures = opened.query_selector_all(".drawing svg")
    assert len(pictures) == 5
    for picture in pictures:
        assert opened.evaluate(OVERLAPS, picture) == []
        assert opened.evaluate(OUTSIDE, picture) == []


def test_a_heading_sorts_its_column(opened):
    first = "#first-decisions tbody tr > :nth-child(5)"
    before = [float(each) for each in opened.locator(first).all_inner_texts()]
    for _ in range(2):
        opened.locator("#first-decisions thead button").nth(4).click()
    falling = [float(each) for each in opened.locator(first).all_inner_texts()]
    assert before == sorted(before)
    assert falling == sorted(before, reverse=True)
