"""The report of a plan, made of its folder: what it says first, its figures, its tables, its text."""

import copy
import json
import re

import pytest

import tpss
from tpss.errors import PlanError
from tpss.planning.figures.catalogue import FIGURES
from tpss.planning.report import pictures_of, plan_report
from tpss.planning.written import read_written
from tpss.results.contents import HEAD_BYTES, REPORT_MARK

import small_plans
from pages import Page
from small_plans import PLAN
from solved_plans import HEADWAY, many, solved

TIGHT = {"require/lowest_voltage_kv": 12.0}

LARGEST_BYTES = 2_000_000

MID = PLAN["measures"]["Mid"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The small plan: with one measure a train every 5 min has 8.8 kV, with both 10.8 kV."""
    return solved(tmp_path_factory.mktemp("plan"), TIGHT)


@pytest.fixture(scope="module")
def page(folder):
    return plan_report(read_written(folder))


def pictures(page):
    """Texts of the pictures of a page."""
    return [
        re.findall(r"<text[^>]*>([^<]*)</text>", svg)
        for svg in re.findall(r"(?s)<svg.*?</svg>", page)
    ]


def picture(page, name):
    """Texts of one picture, and the page around it."""
    inside = page.split(f'aria-labelledby="{name}-title"')[1]
    return pictures(inside)[0]


def test_the_page_loads_nothing_and_says_what_it_is(page):
    assert [each for each in Page(page).loaded if not each.startswith("#")] == []
    assert REPORT_MARK in page[:HEAD_BYTES]
    assert "default-src 'none'" in page
    assert len(page.encode()) < LARGEST_BYTES


def test_it_opens_with_the_answer_the_claim_and_what_is_not_counted(page, folder):
    text, document = Page(page).text, json.loads((folder / "plan.json").read_text())
    told = [*document["answer"], document["claim"], *document["not_counted"]]
    places = [text.index(" ".join(each.split())) for each in told]
    assert places == sorted(places)
    assert places[-1] < text.index("What the plan is worth")
    assert "none is added because the supply is better" in text
    assert "Losses of converters are not described" in text


def test_every_figure_is_drawn(page):
    assert len(pictures(page)) == len(FIGURES)
    captions = Page(page).captions
    assert [each.title for each in FIGURES.values()] == [c for c in captions if c in {
        each.title for each in FIGURES.values()}]  # fmt: skip


def test_the_tree_has_what_is_built_the_traffic_and_how_likely_it_is(page):
    """With both measures a train every 5 min has 10.8 kV, too little: fewer run."""
    texts = picture(page, "decision-tree-0")
    assert {"2030", "2040", "low", "high"} <= set(texts)
    assert "60 %: headway 20 min" in texts
    assert {"40 %: headway 5 min", "runs headway 20 min"} <= set(texts)
    assert "a part of it runs" in texts


def test_the_map_says_what_limits_each_configuration(page):
    """14 kV less 0.6 kV for each train an hour: 3 or 12 of them, with 2 kV more for each measure."""
    texts = picture(page, "carried-0")
    assert {"20", "5", "headway of eastbound [min]", "in the plan"} <= set(texts)
    assert {"12.20 kV", "6.80 kV", "14.20 kV", "8.80 kV", "10.80 kV"} <= set(texts)
    assert {"carried", "limited by a requirement"} <= set(texts)


def test_a_supply_that_collapses_has_its_own_colour(tmp_path):
    """Below 6 kV: a train every 4 min leaves 5 kV."""
    densest = {"probability": 0.4, HEADWAY: [20.0, 4.0]}
    page = plan_report(read_written(solved(tmp_path, {**TIGHT, "scenarios/high": densest})))
    assert {"collapsed", "does not come through"} <= set(picture(page, "carried-0"))


def test_what_is_not_kept_with_an_outage_only_has_a_star(tmp_path):
    """Three trains an hour: 12.2 kV, and 11.9 kV with the outage."""
    page = plan_report(read_written(solved(tmp_path, {**TIGHT, "require/also_with": ["one out"]})))
    assert "11.90 kV *" in picture(page, "carried-0")
    assert "lowest voltage 11.90 kV with one out" in Page(page).text


def test_bars_have_their_costs_and_what_they_cost_more(page, folder):
    firsts = read_written(folder).tables["first_decisions"]
    texts = picture(page, "first-costs-0")
    best, second = firsts.cost[0], firsts.surplus[1]
    assert f"{best:,.1f}" in texts
    assert any(each.endswith(f"+{second:,.1f}") for each in texts)
    assert {"energy", "trains not run, freight", "building and renewals"} <= set(texts)


def test_components_of_a_first_decision_add_up_to_its_cost(folder):
    written = read_written(folder)
    sums = written.tables["first_costs"].groupby("configuration").discounted.sum()
    for first in written.rows("first_decisions", "small"):
        assert sums[first["configuration"]] == pytest.approx(first["cost"], rel=1e-12)


def test_the_tornado_says_where_the_decision_turns_and_to_what(page, folder):
    turned = [
        row for row in read_written(folder).rows("switching_values", "small") if row["below_to"]
    ]
    texts = " ".join(picture(page, "switching-values-0"))
    assert turned
    for row in turned:
        assert f"below {row['below']:.4g}: {row['below_to']}" in texts


def test_regret_has_a_row_a_plan_and_a_column_a_scenario(page, folder):
    texts = picture(page, "regret-0")
    assert {"the plan", "decided today", "as today", "low", "high", "largest"} <= set(texts)
    table = read_written(folder).tables["regret"]
    assert f"{table.high.iloc[-1]:,.1f}" in texts


def test_prices_have_their_year_and_source(page):
    text = Page(page).text
    assert "Without a source: energy per kWh; lost minute, freight." in text
    assert "energy per kWh 6.5e-07 2024 none given" in text
    assert "train not run, freight 0.06 2024 assumed" in text


def test_costs_of_a_scenario_are_told_by_component_and_stage(page, folder):
    """The last row of the table of costs is the whole; of all scenarios it is the expected cost."""
    document = json.loads((folder / "plan.json").read_text())
    discounted = Page(page).text.split("Costs of the plan, discounted")[1]
    assert f"all – {document['expected_cost']:.2f}" in discounted.split("Download CSV")[1]


def test_what_the_user_writes_is_text(tmp_path):
    """Names of scenarios and measures are plain; titles, sources and the description need not be."""
    evil = "<script>alert(1)</script> & $x_1$"
    changes = {"measures/Mid/title": evil, "measures/Mid/source": evil, "description": evil,
               "economics/currency": "M$<b>", "scenarios/low/title": evil}  # fmt: skip
    page = plan_report(read_written(solved(tmp_path, changes)))
    assert "alert(1)</script>" not in page
    assert "M$<b>" not in page
    assert any("M$&lt;b&gt;" in text for texts in pictures(page) for text in texts)
    assert Page(page).text.count(evil) >= 4


def test_many_configurations_stages_and_scenarios_have_room(tmp_path):
    written = read_written(solved(tmp_path, many()))
    page = plan_report(written)
    assert len(page.encode()) < LARGEST_BYTES
    assert len(pictures(page)) == len(FIGURES)
    assert {f"growth-{k}" for k in range(27)} <= set(picture(page, "decision-tree-0"))
    assert "A tie: Converter-station-0, Converter-station-1" in Page(page).text
    assert "any of them" in Page(page).text


def test_ties_are_told(tmp_path):
    """Two measures that do the same for the same money, of which one is enough."""
    same = {"measures/Mid/cost": 30.0, "measures/AT/cost": 30.0, "require/lowest_voltage_kv": 13.0}
    alone = {"measures/Mid/excludes": ["AT"]}
    text = Page(plan_report(read_written(solved(tmp_path, {**same, **alone})))).text
    assert "A tie: AT, Mid cost the same" in text or "A tie: Mid, AT cost the same" in text


def test_a_plan_that_builds_nothing_says_so(tmp_path):
    dear = {"measures/Mid/cost": 4e3, "measures/AT/cost": 5e3, "require/lowest_voltage_kv": 0.0}
    page = plan_report(read_written(solved(tmp_path, dear)))
    assert "Nothing is built in any scenario" in Page(page).text
    assert "stays as today" in picture(page, "decision-tree-0")


def test_today_s_traffic_alone_is_one_scenario(tmp_path):
    alone = {"scenarios/low": None, "scenarios/high": None}
    page = plan_report(read_written(solved(tmp_path, {**TIGHT, **alone})))
    assert "1 scenario." in Page(page).text
    assert {"100 %: as today", "as-today"} <= set(picture(page, "decision-tree-0"))


def test_scenarios_that_part_at_once_have_a_first_decision_each(tmp_path):
    """It is not told where a decision turns that depends on the scenario."""
    parted = {"scenarios/low/" + HEADWAY: [10.0, 20.0]}
    page = plan_report(read_written(solved(tmp_path, {**TIGHT, **parted})))
    assert "It is not known where the first decision turns" in Page(page).text
    assert {"if low", "if high"} <= set(picture(page, "first-costs-0"))


def two_areas():
    """The small plan as two areas, with a budget that one of them can spend."""
    lines = {
        name: {"scenario": "line.toml", "title": f"Line <{name}>"} for name in ("north", "south")
    }
    measures = {
        f"measures/{area}.Mid": {**MID, "cost": cost}
        for area, cost in (("north", 20.0), ("south", 25.0))
    }
    futures = {
        f"scenarios/{name}": {
            "probability": share,
            "north.traffic.eastbound.headway_min": [20.0, dense],
            "south.traffic.eastbound.headway_min": [20.0, dense],
        }
        for name, share, dense in (("low", 0.6, 20.0), ("high", 0.4, 6.0))
    }
    without = dict.fromkeys(("scenario", "measures/Mid", "measures/AT"))
    return {
        **without, **measures, **futures, "areas": lines, "budget": {"per_stage": [30.0, 30.0]},
        "require/lowest_voltage_kv": 10.0,
    }  # fmt: skip


def test_areas_have_figures_of_their_own_and_a_budget_its_table(tmp_path):
    page = plan_report(read_written(solved(tmp_path, two_areas())))
    text = Page(page).text
    assert "north: Line <north>" in text
    assert "south: Line <south>" in text
    assert "Budget, and what is spent of it" in text
    assert len(pictures(page)) == 2 * 4 + 1
    assert re.search(r"The best \d+ plans, with what is in service where they differ", text)
    assert "Where the first decision turns" in text


def test_areas_for_whose_pictures_there_is_no_room_are_named(tmp_path, monkeypatch):
    written = read_written(solved(tmp_path, two_areas()))
    (north, *_), _ = pictures_of(written)
    room = sum(len(each.svg) for each in north.figures)
    monkeypatch.setattr("tpss.planning.report.MOST_LETTERS", room)
    page = plan_report(written)
    assert "Not drawn, for want of room: south; the tables have all of them." in Page(page).text
    assert len(pictures(page)) == 4 + 1


def test_names_that_look_like_numbers_stay_names(tmp_path):
    """A scenario called 2040, and measures called 1 and 01."""
    measures = {"measures/1": MID, "measures/Mid": None}
    futures = {"scenarios/2040": {"probability": 0.4, HEADWAY: [20.0, 5.0]}, "scenarios/high": None}
    written = read_written(solved(tmp_path, {**TIGHT, **measures, **futures}))
    assert "1" in set(written.tables["first_decisions"].configuration)
    assert "2040" in picture(plan_report(written), "regret-0")


def test_a_report_needs_only_the_folder_of_the_answer(tmp_path):
    """The plan's file and its scenario may be gone."""
    folder = solved(tmp_path, TIGHT)
    (tmp_path / "plan.toml").unlink()
    (tmp_path / "line.toml").unlink()
    file = tpss.write_plan_report(folder)
    assert file == folder / "report.html"
    assert REPORT_MARK in file.read_text(encoding="utf-8")[:HEAD_BYTES]
    with pytest.raises(tpss.ResultError, match="--force"):
        tpss.write_plan_report(folder)
    tpss.write_plan_report(folder, force=True)


def test_a_folder_without_its_tables_is_refused_with_the_remedy(tmp_path):
    folder = solved(tmp_path, TIGHT)
    (folder / "tables" / "regret.csv").unlink()
    with pytest.raises(PlanError, match=r"regret\.csv cannot be read.*run tpss plan run again"):
        read_written(folder)
    with pytest.raises(PlanError, match="name one that tpss plan run has written"):
        read_written(tmp_path)


LOSING = "Q48/Q49 with losses (estimate)"

MID_LOSING = {"measures/Mid/add/supply.converter_stations/type": LOSING}
"""A station that may be built, whose converters say what they lose."""


def test_losses_of_some_converters_are_told_apart(tmp_path):
    """Converters of today say nothing of them; those of a measure do, by an estimate."""
    document = json.loads((solved(tmp_path, MID_LOSING) / "plan.json").read_text())
    said = " ".join(document["not_counted"])
    assert "Losses of some converters are not described" in said
    assert "Outside the hours in which the traffic runs converters are taken to be off" in said
    assert [words for words in document["by_estimate"] if "converters" in words]


def test_losses_that_are_counted_are_not_listed_as_not_counted(tmp_path, monkeypatch):
    """The first page says that they are estimates."""
    line = copy.deepcopy(small_plans.LINE)
    for station in line["supply"]["converter_stations"]:
        station["type"] = LOSING
    monkeypatch.setattr(small_plans, "LINE", line)
    place = solved(tmp_path, MID_LOSING)
    document = json.loads((place / "plan.json").read_text())
    assert "not described" not in " ".join(document["not_counted"])
    text = Page(plan_report(read_written(place))).text
    assert "By estimate: What converters lose" in text
    assert text.index("By estimate") < text.index("What is not counted")


def test_without_losses_nothing_is_an_estimate(folder, page):
    assert json.loads((folder / "plan.json").read_text())["by_estimate"] == []
    assert "By estimate" not in Page(page).text
