"""Names and texts of others: one form of Unicode, and nothing that steers a terminal or a page."""

import copy
import io

import pytest
import tomli_w

import tpss
from tpss.cli.terminal import Console, say
from tpss.printable import printable
from tpss.report.page import templates

from scenarios import SHORT_LINE, short_line

ONE, TWO = "Malm\u00f6", "Malmo\u0308"
"""An ö of one character, and of two."""

ESCAPE = "\x1b]0;title\x07"


def with_names(station, stop):
    document = copy.deepcopy(SHORT_LINE)
    document["line"]["stations"][1]["name"] = station
    document["traffic"][0]["stops"] = [{"station": stop, "dwell_min": 1.0}]
    return document


@pytest.mark.parametrize(("station", "stop"), [(ONE, TWO), (TWO, ONE), (TWO, TWO)])
def test_names_are_compared_in_one_form_of_unicode(tmp_path, station, stop):
    document = with_names(station, stop)
    file = tmp_path / "line.toml"
    file.write_text(tomli_w.dumps(document), "utf-8")
    for scenario in (tpss.load_scenario(file), tpss.Scenario.from_document(document)):
        assert scenario.line.stations[1].name == ONE
        assert scenario.traffic[0].stops[0].station == ONE


def test_values_that_are_set_are_in_that_form_too():
    scenario = tpss.Scenario.from_document(with_names(ONE, ONE))
    assert (
        scenario.with_({"traffic.0.to": TWO, "traffic.0.stops": None}).traffic[0].destination == ONE
    )


@pytest.mark.parametrize(
    "character",
    ["\t", "\x1b", "\x7f", "\x85", "\x9b", "\u200b", "\u200e", "\u202e", "\u2028", "\u2029", "\u2066",
     "\u00ad", "\ufeff"],
    ids=lambda character: f"U+{ord(character):04X}",
)  # fmt: skip
def test_what_cannot_be_seen_is_refused_in_names(character):
    name = f"Mid{character}dle"
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.Scenario.from_document(with_names(name, name))
    first = caught.value.findings[0]
    assert first.key == "line.stations.1.name"
    assert f"U+{ord(character):04X}" in first.problem
    assert character not in str(caught.value)


@pytest.mark.parametrize("name", ["Älvsjö", "Łódź", "北京", "Αθήνα", "a b-c/d (e)", "\U0001f682"])
def test_names_of_any_language_are_names(name):
    assert tpss.Scenario.from_document(with_names(name, name)).line.stations[1].name == name


def test_findings_show_what_steers_as_its_code():
    with pytest.raises(tpss.ScenarioError) as caught:
        short_line({f"line.{ESCAPE}": 1})
    assert "\\x1b]0;title\\x07" in str(caught.value)
    assert "\x1b" not in str(caught.value)


def test_a_cell_of_a_table_too(tmp_path):
    document = copy.deepcopy(SHORT_LINE)
    del document["line"]["gradients"]
    document["line"]["gradients_file"] = "a.csv"
    (tmp_path / "a.csv").write_text(f"position_km,gradient_permille\n0,{ESCAPE}x\n", "utf-8")
    with pytest.raises(tpss.ScenarioError) as caught:
        tpss.Scenario.from_document(document, tmp_path / "line.toml")
    assert "\\x1b]0;title\\x07x" in str(caught.value)
    assert "\x1b" not in str(caught.value)


def test_the_console_shows_what_steers_as_its_code_and_keeps_its_own_colours():
    file = io.StringIO()
    console = Console(file=file, force_terminal=True, color_system="standard", width=200)
    console.print(f"[bold]name[/bold] {ESCAPE}\u202eabc", highlight=False)
    say(console, f"{ESCAPE}[red]\nnext")
    text = file.getvalue()
    assert "\x1b[1mname\x1b[0m" in text
    assert "\\x1b]0;title" in text
    assert "\\u202eabc" in text
    assert "[red]\nnext\n" in text
    assert "\x1b]" not in text


def test_a_page_shows_what_turns_a_line_round_as_its_code():
    template = templates().from_string("{{ text }}{{ ours|safe }}")
    page = template.render(text="a\u202e<b>\n", ours="<i>\u202e")
    assert page == "a\\u202e&lt;b&gt;\n<i>\u202e"


def test_texts_that_steer_nothing_are_left_alone():
    for text in ("plain", "Höhe ‰ – 5 km²", "\u00a0a"):
        assert printable(text) == text
