"""A report in a browser, opened from the disk: it draws, moves, sorts, and asks nobody for anything."""

import csv
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from sweep.studies import study_with_stalls
from tpss.report.html import report, write_report
from tpss.sweep.report import write_study_report

from chromium import needs_chromium
from scenarios import run

pytestmark = needs_chromium


@dataclass
class Opened:
    """An open page, and what it said and asked for."""

    tab: Any
    faults: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def trains(self) -> list[float]:
        """Positions of the trains that are shown."""
        return self.tab.evaluate("[...document.getElementById('moment').data.at(-1).x]")

    def wait_for(self, expression: str) -> None:
        """Wait until an expression is true; asked from outside, as the page forbids `eval`."""
        ends = time.monotonic() + 30.0
        while not self.tab.evaluate(expression):
            assert time.monotonic() < ends, expression
            self.tab.wait_for_timeout(50)

    def cursor(self, plot: str) -> float:
        return self.tab.evaluate(f"document.getElementById('{plot}').layout.shapes.at(-1).x0")

    def column(self, table: str, number: int) -> list[str]:
        return self.tab.locator(f"#{table} tbody tr > :nth-child({number})").all_inner_texts()


def open_page(browser: Any, file: Path, **options: Any) -> Opened:
    opened = Opened(browser.new_page(**options))
    opened.tab.on("console", lambda message: opened.faults.append(message.text))
    opened.tab.on("pageerror", lambda error: opened.faults.append(str(error)))
    opened.tab.on("request", lambda request: opened.requests.append(request.url))
    opened.tab.goto(file.as_uri(), timeout=120_000)
    opened.tab.wait_for_selector("body[data-ready]", timeout=120_000)
    return opened


@pytest.fixture(scope="module")
def report_file(page: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("report") / "report.html"
    file.write_text(page, encoding="utf-8")
    return file


@pytest.fixture
def opened(browser: Any, report_file: Path) -> Iterator[Opened]:
    found = open_page(browser, report_file)
    yield found
    found.tab.close()
    assert found.faults == []
    assert found.requests == [report_file.as_uri()]


def test_a_report_is_a_file_that_is_sent_by_mail(report_file):
    """The script of the plots, 4.8 MB as plotly's own package has it, is 0.7 MB of at most 2 MB."""
    assert report_file.stat().st_size < 2e6


def test_every_plot_is_drawn(opened):
    plots = opened.tab.locator(".plot")
    assert plots.count() == 6
    for plot in plots.all():
        assert plot.locator("svg.main-svg").count() > 0
        assert plot.locator(".trace, .hm").count() > 0


def test_a_comparison_with_measurements_is_drawn_and_follows_the_time(
    browser, short, beside, tmp_path
):
    file = write_report(short, tmp_path / "report.html", measured=beside)
    opened = open_page(browser, file)
    for plot in ("measured", "measured-durations"):
        assert opened.tab.locator(f"#{plot} .trace").count() == 2
    opened.tab.locator("#time").focus()
    for _ in range(3):
        opened.tab.keyboard.press("ArrowRight")
    at = "document.getElementById('{}').layout.shapes.at(-1).x0"
    measured, losses = at.format("measured"), at.format("losses")
    opened.wait_for(f"{measured} > 0 && {measured} === {losses}")  # of the last press, in both
    assert opened.cursor("measured") == opened.cursor("losses")
    opened.tab.close()
    assert opened.faults == []


def test_nothing_offers_to_send_a_figure_away(opened):
    opened.tab.locator("#losses").hover()
    titles = opened.tab.locator(".modebar-btn").evaluate_all(
        "buttons => buttons.map(each => each.dataset.title || '')"
    )
    assert titles
    assert not [title for title in titles if "loud" in title]


def test_the_slider_moves_trains_and_cursors_by_keyboard(opened):
    before = opened.trains()
    opened.tab.locator("#time").focus()
    for _ in range(3):
        opened.tab.keyboard.press("ArrowRight")
    opened.wait_for("document.getElementById('time').value === '3'")
    opened.tab.wait_for_timeout(300)
    assert opened.trains() != before
    step = float(opened.tab.locator("#time").input_value())
    minutes = float(opened.tab.locator("#now").inner_text().split()[0])
    assert step == 3
    for plot in ("graph", "powers", "converters", "losses"):
        assert opened.cursor(plot) == pytest.approx(minutes)
    assert "on the line; lowest voltage" in opened.tab.locator("#state").inner_text()


def test_times_are_shown_by_the_clock_too_where_there_is_one(browser, tmp_path):
    file = tmp_path / "report.html"
    file.write_text(report(run({"simulation.starts_at": "06:58"})), encoding="utf-8")
    found = open_page(browser, file)
    found.tab.locator("#time").fill("60")
    found.wait_for("document.getElementById('now').textContent.startsWith('3.00')")
    assert found.tab.locator("#now").inner_text() == "3.00 min (07:01:00)"
    assert found.faults == []
    found.tab.close()


def test_pointing_at_one_plot_moves_the_cursor_of_the_others(opened):
    area = opened.tab.locator("#losses .nsewdrag").first
    area.scroll_into_view_if_needed()
    area.hover()
    opened.wait_for("document.getElementById('powers').layout.shapes.at(-1).x0 > 1")
    assert opened.cursor("powers") == opened.cursor("losses")


def test_it_plays_and_pauses(opened):
    opened.tab.locator("#play").click()
    opened.wait_for("+document.getElementById('time').value >= 2")
    opened.tab.locator("#play").click()
    assert "Play" in opened.tab.locator("#play").inner_text()
    stopped = opened.tab.locator("#time").input_value()
    opened.tab.wait_for_timeout(300)
    assert opened.tab.locator("#time").input_value() == stopped


def test_another_train_can_be_chosen_over_time_too(opened):
    opened.tab.select_option("#train", index=1)
    opened.tab.select_option("#against", "time")
    shown = opened.tab.evaluate(
        "(({data, layout}) => [data[0].name, data[0].x[0], layout.xaxis3.title.text])"
        "(document.getElementById('journey'))"
    )
    assert shown == ["eastbound 2", pytest.approx(10.0), "time [min]"]


def test_a_heading_sorts_up_and_down_as_numbers(opened):
    heading = opened.tab.locator("#trains thead button").filter(has_text="energy")
    heading.click()
    column = opened.tab.evaluate(
        "[...document.querySelectorAll('#trains thead th')].findIndex(h => h.ariaSort) + 1"
    )
    rising = [float(text) for text in opened.column("trains", column)]
    assert rising == sorted(rising)
    assert len(set(rising)) > 1
    heading.click()
    assert [float(text) for text in opened.column("trains", column)] == rising[::-1]


def test_a_table_downloads_as_csv(opened, short, tmp_path):
    with opened.tab.expect_download() as download:
        opened.tab.locator("button[data-table=trains]").click()
    assert download.value.suggested_filename == "trains.csv"
    download.value.save_as(tmp_path / "trains.csv")
    with (tmp_path / "trains.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["train"] for row in rows] == short.trips.train.tolist()
    energy = [float(row["energy [MWh]"]) for row in rows]
    assert energy == pytest.approx(short.trips.energy_mwh.tolist(), rel=1e-6)


def test_it_fits_a_phone(browser, report_file):
    size = {"width": 390, "height": 844}
    found = open_page(browser, report_file, viewport=size, is_mobile=True, has_touch=True)
    assert found.tab.evaluate("document.documentElement.scrollWidth") <= size["width"]
    assert found.faults == []
    found.tab.close()


def test_it_prints(browser, report_file):
    found = open_page(browser, report_file)
    assert found.tab.pdf(format="A4").startswith(b"%PDF")
    assert found.faults == []
    found.tab.close()


def test_a_dark_page_has_light_curves_and_prints_in_dark_ones(browser, report_file):
    """The black line of 100 % loading turns light; on paper, and for who wants it light, it is black."""
    found = open_page(browser, report_file, color_scheme="dark")
    state = (
        "(({layout}) => [layout.paper_bgcolor, layout.shapes[0].line.color])"
        "(document.getElementById('converters'))"
    )
    assert found.tab.evaluate(state) == ["#15181D", "#E6E6E6"]
    body = "getComputedStyle(document.body).backgroundColor"
    assert found.tab.evaluate(body) == "rgb(21, 24, 29)"
    found.tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert found.tab.evaluate(state) == ["#FFFFFF", "#000000"]
    found.tab.evaluate("dispatchEvent(new Event('afterprint'))")
    assert found.tab.evaluate(state) == ["#15181D", "#E6E6E6"]
    found.tab.emulate_media(color_scheme="light")
    found.wait_for("document.getElementById('converters').layout.paper_bgcolor === '#FFFFFF'")
    assert found.faults == []
    found.tab.close()


def test_one_slider_moves_the_trains_of_all_compared_runs(browser, compared, tmp_path):
    file = tmp_path / "comparison.html"
    file.write_text(compared, encoding="utf-8")
    found = open_page(browser, file)
    shown = "document.getElementById('envelopes').data.slice(-2).map((trace) => trace.x.length)"
    found.tab.locator("#time").fill("220")  # 11 min in steps of 0.05 min
    found.wait_for(f"({shown})[1] === 3")
    assert found.tab.evaluate(shown) == [2, 3]
    assert found.tab.locator("#now").inner_text() == "11.00 min"
    said = found.tab.locator("#state p").all_inner_texts()
    assert [line.split(";")[0] for line in said] == [
        "every 10 min: 2 trains on the line",
        "every 5 min: 3 trains on the line",
    ]
    assert found.cursor("powers") == pytest.approx(11.0)
    assert found.faults == []
    found.tab.close()


def test_the_gradient_below_a_journey_is_that_of_the_line(opened):
    opened.tab.select_option("#train", index=1)
    shown = opened.tab.evaluate("[...new Set(document.getElementById('journey').data[2].y)]")
    assert shown == [0.0]


def test_a_comparison_draws_its_plots(browser, compared, tmp_path):
    file = tmp_path / "comparison.html"
    file.write_text(compared, encoding="utf-8")
    found = open_page(browser, file)
    assert found.tab.locator(".plot svg.main-svg").count() > 0
    assert found.tab.locator(".plot.drawn").count() == 5
    assert found.faults == []
    assert found.requests == [file.as_uri()]
    found.tab.close()


def test_the_slider_moves_the_trains_of_a_network_onto_its_branch(browser, star, tmp_path):
    """At minute 30 both trains have passed Fork: one is on the branch, beside the main line."""
    file = tmp_path / "network.html"
    file.write_text(report(star), encoding="utf-8")
    found = open_page(browser, file)
    shown = "[...document.getElementById('network').data.at(-1).%s]"
    assert found.tab.evaluate(shown % "y") == [0.0, 0.0]
    found.tab.locator("#time").fill("300")  # steps of 0.1 min
    found.wait_for(f"({shown % 'y'}).some((row) => row !== 0)")
    x, y = (found.tab.evaluate(shown % axis) for axis in "xy")
    words = found.tab.evaluate(shown % "text")
    up = next(k for k, text in enumerate(words) if text.startswith("up 1<br>branch km 1"))
    assert y[1 - up] == 0.0
    assert x[1 - up] > 40.0
    assert "2 trains on the network; lowest" in found.tab.locator("#state").inner_text()
    found.tab.select_option("#train", label="up 1")
    way = found.tab.evaluate("document.getElementById('journey').data[0].x.at(-1)")
    assert way == pytest.approx(70.0)
    assert found.faults == []
    assert found.requests == [file.as_uri()]
    found.tab.close()


def test_the_journey_of_any_train_that_all_compared_runs_have_can_be_chosen(
    browser, compared, tmp_path
):
    """Trains every 10 min and every 5: the second one departs at minute 10, and at minute 5."""
    file = tmp_path / "comparison.html"
    file.write_text(compared, encoding="utf-8")
    found = open_page(browser, file)
    choices = found.tab.locator("#train option").all_inner_texts()
    assert choices[:3] == ["the studied train of each run", "eastbound 1", "eastbound 2"]
    found.tab.select_option("#train", label="eastbound 2")
    found.tab.select_option("#against", "time")
    journey = "document.getElementById('journey').data"
    shown = found.tab.evaluate(f"{journey}.slice(0, 2).map((each) => [each.name, each.x[0]])")
    assert shown == [
        ["every 10 min: eastbound 2", pytest.approx(10.0)],
        ["every 5 min: eastbound 2", pytest.approx(5.0)],
    ]
    found.tab.select_option("#train", index=0)
    assert found.tab.evaluate(f"{journey}[1].name") == "every 5 min: eastbound 1"
    assert found.faults == []
    found.tab.close()


def test_a_table_of_outages_is_drawn_sorted_and_downloaded(browser, table_page, tmp_path, found):
    file = tmp_path / "outages.html"
    file.write_text(table_page, encoding="utf-8")
    opened = open_page(browser, file)
    tab = opened.tab
    assert tab.locator("#voltages .scatterlayer .trace").count() == 2
    tab.locator("#outages thead button", has_text="lowest voltage").click()
    lowest = [float(text.split()[0]) for text in opened.column("outages", 3)]
    assert lowest == sorted(lowest)
    with tab.expect_download() as download:
        tab.locator("button.csv[data-table=outages]").click()
    download.value.save_as(tmp_path / "outages.csv")
    rows = list(csv.reader((tmp_path / "outages.csv").read_text().splitlines()))
    assert {row[0] for row in rows[1:]} == {row.outage for row in found.rows}
    tab.close()
    assert opened.faults == []
    assert opened.requests[0] == file.as_uri()


@pytest.fixture(scope="module")
def study_page(browser, tmp_path_factory):
    folder = study_with_stalls(tmp_path_factory.mktemp("study"))
    file = write_study_report(folder, folder / "report.html")
    opened = open_page(browser, file, viewport={"width": 1280, "height": 900})
    yield opened
    assert not opened.faults
    assert all(url.startswith("file:") for url in opened.requests)


def test_a_number_chooses_a_case_and_gives_the_command_that_opens_it(study_page):
    study_page.tab.fill("#case", "4")
    study_page.tab.press("#case", "Tab")
    told = study_page.tab.inner_text("#case-told")
    assert "Case 4: " in told
    assert "supply.converter_stations.*.converters" in told
    assert study_page.tab.inner_text("#case-command").endswith("--case 4")


def test_a_click_on_a_point_chooses_its_case(study_page):
    """Whose words begin with its number."""
    point = "document.getElementById('trade-offs').data[0].text[0]"
    number = study_page.tab.evaluate(point).partition("<br>")[0].removeprefix("case ")
    study_page.tab.locator("#trade-offs").scroll_into_view_if_needed()
    study_page.tab.locator("#trade-offs .point").first.click(force=True)
    study_page.wait_for(f"document.getElementById('case').value === '{number}'")


def test_lists_choose_what_is_drawn(study_page):
    study_page.tab.select_option("#across", label="supply.converter_stations.*.converters")
    study_page.wait_for(
        "document.getElementById('trade-offs').layout.xaxis.title.text.endsWith('converters')"
    )
    values = study_page.tab.evaluate("[...document.getElementById('trade-offs').data[0].x]")
    assert set(values) == {1, 2, 3}


def test_a_heading_sorts_the_cases(study_page):
    study_page.tab.locator("#cases thead button").first.click()
    study_page.tab.locator("#cases thead button").first.click()
    assert study_page.column("cases", 1) == [str(number) for number in range(8, -1, -1)]
