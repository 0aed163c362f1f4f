"""The studio in a browser, used by roles and labels, as by someone who does not see the page."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from chromium import needs_chromium
from served_studio import SIZES, Shown, serving

pytestmark = needs_chromium


TABS = ("Curves", "What if", "Variants", "Outages", "Research")


@pytest.fixture
def home(file: Path) -> Iterator[str]:
    with serving(file) as address:
        yield address


@pytest.fixture
def shown(browser: Any, home: str) -> Iterator[Shown]:
    page = Shown(browser.new_page(viewport=SIZES["wide"]), home).open()
    yield page
    page.tab.close()
    assert page.faults == []
    assert [url for url in page.requests if not url.startswith((home, "blob:"))] == []


def test_what_is_opened_is_shown(shown):
    tab = shown.tab
    assert tab.get_by_role("heading", level=1).inner_text() == "short-line"
    for words in ("Run finished", "Audit passed", "No violations"):
        assert tab.get_by_text(words, exact=True).is_visible()
    assert tab.get_by_role("img", name="Voltage along the line").is_visible()
    assert tab.get_by_role("img", name="Train graph").is_visible()
    assert " kV" in shown.tile("Lowest voltage")


def test_a_number_that_is_typed_moves_the_result(shown):
    before = shown.tile("Energy")
    shown.field("headway in min").fill("20")
    shown.settle()
    assert shown.tile("Energy") != before
    assert "+" in shown.tile("Energy")
    assert shown.button("Changes (1)").is_visible()


def test_decimal_commas_are_numbers(shown):
    shown.field("headway in min").fill("12,5")
    shown.settle()
    shown.button("Changes").click()
    assert "traffic.0.headway_min=12.5" in shown.tab.get_by_role("dialog").inner_text()


def test_a_finding_stands_beside_its_field(shown):
    headway = shown.field("headway in min")
    headway.fill("zwei")
    shown.settle()
    assert headway.get_attribute("aria-invalid") == "true"
    told = shown.tab.locator(f"#{headway.get_attribute('aria-describedby')}").inner_text()
    assert told.startswith("not a number")
    assert shown.tab.get_by_text("1 fault: the result is that before.").is_visible()
    headway.fill("20")
    shown.settle()
    assert headway.get_attribute("aria-invalid") is None


def test_edits_are_undone_and_redone_by_keys(shown):
    headway = shown.field("headway in min")
    headway.fill("20")
    shown.settle()
    shown.tab.keyboard.press("Control+z")
    shown.settle()
    assert headway.input_value() == "60"
    shown.tab.keyboard.press("Control+Shift+z")
    shown.settle()
    assert headway.input_value() == "20"


def test_arrow_keys_move_a_number(shown):
    headway = shown.field("headway in min")
    headway.focus()
    shown.tab.keyboard.press("ArrowUp")
    shown.tab.keyboard.press("Shift+ArrowDown")
    shown.settle()
    assert headway.input_value() == "51"


def test_a_feeding_point_is_moved_by_keys(shown):
    station = shown.slider("Feeding station East, 2 converters")
    station.focus()
    for key in ("ArrowLeft", "Shift+ArrowLeft"):
        shown.tab.keyboard.press(key)
    shown.settle()
    assert station.get_attribute("aria-valuenow") == "18.9"
    assert shown.button("Changes (1)").is_visible()


def test_a_transformer_is_dragged(shown):
    transformer = shown.slider("Transformer").nth(1)
    box = transformer.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    shown.tab.mouse.move(x, y)
    shown.tab.mouse.down()
    for step in range(1, 6):
        shown.tab.mouse.move(x - 20 * step, y)
    shown.tab.mouse.up()
    shown.settle()
    km = float(transformer.get_attribute("aria-valuenow"))
    assert 10.0 < km < 13.0
    assert shown.button("Changes (1)").is_visible()


def test_changes_are_written_in_three_ways(shown):
    shown.field("headway in min").fill("20")
    shown.settle()
    shown.button("Changes").click()
    dialog = shown.tab.get_by_role("dialog")
    for kind, words in (
        ("Command line", "--set traffic.0.headway_min=20.0"),
        ("Python", '"traffic.0.headway_min": 20.0'),
        ("File", "+headway_min = 20.0  # one an hour"),
    ):
        dialog.get_by_role("button", name=kind).click()
        assert words in dialog.inner_text()


def test_what_is_saved_is_in_the_file(shown, file):
    shown.field("headway in min").fill("20")
    shown.settle()
    shown.tab.keyboard.press("Control+s")
    shown.wait_for("document.getElementById('save').disabled")
    assert "headway_min = 20.0  # one an hour" in file.read_text("utf-8")


def test_a_file_that_was_changed_meanwhile_is_not_overwritten(shown, file):
    changed = file.read_text("utf-8") + "# by another program\n"
    file.write_text(changed, "utf-8")
    shown.field("headway in min").fill("20")
    shown.settle()
    shown.button("Save").click()
    assert "not overwritten" in shown.tab.get_by_role("alert").inner_text()
    assert file.read_text("utf-8") == changed


def test_a_page_that_is_closed_loses_nothing(browser, home):
    first = Shown(browser.new_page(), home).open()
    first.field("headway in min").fill("20")
    first.settle()
    first.tab.close()
    again = Shown(browser.new_page(), home).open()
    assert again.field("headway in min").input_value() == "20"
    assert again.button("Changes (1)").is_visible()
    again.tab.close()


def test_a_server_that_is_killed_and_started_again_has_the_draft(browser, file):
    with serving(file) as home:
        page = Shown(browser.new_page(), home).open()
        page.field("headway in min").fill("20")
        page.settle()
    page.field("headway in min").fill("30")
    page.tab.get_by_text("The server does not answer").wait_for()
    assert f"tpss studio {file}" in page.tab.get_by_role("alert").inner_text()
    page.tab.close()
    with serving(file) as home:
        page = Shown(browser.new_page(), home).open()
        assert page.field("headway in min").input_value() == "20"
        page.tab.close()


def test_two_pages_do_not_overwrite_each_other(browser, home):
    one, other = (Shown(browser.new_page(), home).open() for _ in range(2))
    one.field("headway in min").fill("20")
    one.settle()
    other.field("headway in min").fill("30")
    other.tab.get_by_text("Another page has edited this file").wait_for()
    other.button("Take over its edits").click()
    other.wait_for_value("headway in min", "20")
    one.tab.close()
    other.tab.close()


def test_names_are_text(browser, file):
    evil = "<img src=x onerror=document.title='evil'>"
    file.write_text(file.read_text("utf-8").replace('"Middle"', f'"{evil}"'), "utf-8")
    with serving(file) as home:
        page = Shown(browser.new_page(), home).open()
        assert page.slider(f"Station {evil}").is_visible()
        assert page.tab.title() == "line.toml – TPSS studio"
        assert page.faults == []
        page.tab.close()


def test_a_pinned_baseline_is_compared_with(shown):
    shown.field("headway in min").fill("20")
    shown.settle()
    shown.button("Pin as baseline").click()
    assert "+" not in shown.tile("Energy")
    assert shown.tab.get_by_text("Baseline: after 1 edits").is_visible()
    shown.tab.keyboard.press("Control+z")
    shown.settle()
    assert "−" in shown.tile("Energy")


def test_every_chart_has_its_table(shown):
    shown.button("Voltage along the line as a table").click()
    table = shown.tab.get_by_role("region", name="Voltage along the line, values")
    assert table.get_by_role("columnheader").all_inner_texts()[0] == "position [km]"
    assert table.get_by_role("row").count() > 20


def test_axes_write_numbers_as_the_rest_of_the_page_does(shown):
    ask = "async () => (await import('./scales.js')).AXIS.values(null, [12500, 0.25, -3])"
    assert shown.tab.evaluate(ask) == ["12500", "0.25", "−3"]


def test_cells_of_a_spreadsheet_take_the_place_of_a_table(shown):
    shown.tab.get_by_text("line", exact=True).first.click()
    cell = shown.field("from 1 of gradients")
    cell.focus()
    shown.tab.evaluate(
        """text => {
            const data = new DataTransfer();
            data.setData("text/plain", text);
            document.activeElement.dispatchEvent(
                new ClipboardEvent("paste", { clipboardData: data, bubbles: true, cancelable: true }));
        }""",
        "0,0\t2,5\n10,0\t-1,5\n",
    )
    shown.wait_for_value("permille 2 of gradients", "-1.5")
    shown.settle()
    shown.button("Changes").click()
    shown.tab.get_by_role("dialog").get_by_role("button", name="File").click()
    assert "permille = 2.5" in shown.tab.get_by_role("dialog").inner_text()


def test_a_station_is_taken_out_of_service_by_a_key(shown):
    station = shown.slider("Feeding station East, 2 converters")
    station.focus()
    shown.tab.keyboard.press("o")
    shown.settle()
    assert shown.tab.get_by_text("Outage: East out").is_visible()
    shown.tab.keyboard.press("o")
    shown.settle()
    assert not shown.tab.get_by_text("Outage: East out").is_visible()


def test_an_outage_of_the_table_is_shown_by_a_click(shown):
    shown.tab.get_by_role("tab", name="Outages").click()
    shown.button("Run all single outages").click()
    shown.button("Show West out").click()
    shown.settle()
    assert shown.tab.get_by_text("Outage: West out").is_visible()


def test_edits_are_kept_as_a_variant(shown):
    shown.field("headway in min").fill("20")
    shown.settle()
    shown.tab.get_by_role("tab", name="Variants").click()
    shown.tab.get_by_role("textbox", name="Name", exact=True).fill("dense traffic")
    shown.button("Keep edits as a variant").click()
    row = shown.tab.get_by_role("row", name="dense-traffic finished 1")
    row.wait_for()
    shown.wait_for_value("headway in min", "60")
    row.get_by_role("button", name="Show dense-traffic").click()
    shown.wait_for_value("headway in min", "20")


def test_a_slider_asks_what_if(shown):
    shown.tab.get_by_role("tab", name="What if").click()
    assert shown.tab.get_by_label("Number", exact=True).input_value() == "traffic.0.headway_min"
    shown.slider("Value").focus()
    shown.tab.keyboard.press("ArrowLeft")
    shown.settle()
    assert float(shown.field("headway in min").input_value()) < 60.0
    shown.button("Response curve").click()
    shown.tab.get_by_role("img", name="Response").wait_for()


def test_trains_move_over_the_drawing(shown):
    shown.button("Trains").click()
    shown.tab.get_by_text("1 trains; lowest voltage").wait_for()
    before = shown.tab.locator("circle.train").get_attribute("cx")
    shown.slider("Time").focus()
    for _ in range(20):
        shown.tab.keyboard.press("ArrowRight")
    assert float(shown.tab.locator("circle.train").get_attribute("cx")) > float(before)
    shown.button("Play").click()
    shown.wait_for("Number(document.getElementById('moment').value) > 25")


def test_a_chart_more_is_chosen(shown):
    shown.tab.get_by_role("checkbox", name="Losses of the network").check()
    shown.tab.get_by_role("img", name="Losses of the network").wait_for()


def test_the_equations_behind_a_chart_are_told(shown):
    shown.tab.get_by_role("tab", name="Research").click()
    shown.tab.get_by_label("Behind").select_option("Train graph")
    shown.tab.get_by_text("adhesion_limit").click()
    told = shown.tab.locator("pre[aria-label=adhesion_limit]")
    assert told.inner_text().startswith("Largest tractive force that wheel and rail transmit")
    drawn = told.locator("math").bounding_box()
    assert drawn["width"] > 100
    assert drawn["height"] > 15
    steps = shown.tab.get_by_role("region", name="Steps of a train")
    steps.get_by_role("row").nth(5).wait_for()


def test_a_report_is_made_with_the_words_of_its_author(shown):
    shown.button("Report").click()
    shown.tab.get_by_role("textbox", name="Title").fill("The line tomorrow")
    shown.button("Report (HTML)").click()
    with shown.tab.expect_download() as download:
        shown.tab.get_by_role("link", name="Download").click()
    assert "The line tomorrow" in Path(download.value.path()).read_text("utf-8")


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", SIZES)
def test_nothing_keeps_anyone_out(browser, home, size, scheme):
    axe = pytest.importorskip("axe_playwright_python.sync_playwright")
    context = browser.new_context(viewport=SIZES[size], color_scheme=scheme)
    page = Shown(context.new_page(), home).open()
    page.field("headway in min").fill("20") if size == "wide" else None
    page.settle()
    views = [page.tab.get_by_role("tab", name=name) for name in TABS]
    for view in [*views, *([page.button("Edit")] if size == "narrow" else [])]:
        view.click()
        found = axe.Axe().run(page.tab)
        assert found.violations_count == 0, found.generate_report()
    width = page.tab.evaluate("document.documentElement.scrollWidth")
    assert width <= SIZES[size]["width"]
    context.close()


def test_the_page_is_used_by_keyboard_alone(shown, file):
    press = shown.tab.keyboard.press
    for _ in range(60):
        press("Tab")
        if shown.tab.evaluate(
            "document.activeElement.labels?.[0]?.innerText.startsWith('headway')"
        ):
            break
    shown.tab.keyboard.type("25")
    shown.settle()
    press("Control+s")
    shown.wait_for("document.getElementById('save').disabled")
    assert tomllib.loads(file.read_text("utf-8"))["traffic"][0]["headway_min"] == 25.0
