"""The command ``tpss plot``: files of figures, and requests that are refused."""

import pytest
from matplotlib.legend import Legend

import tpss
from tpss.report.figures import FIGURES, draw, overlay

SHORT = ("--set", "simulation.duration_min=3", "--out", "demo", "--quiet")
UNTOLD = ("converter-losses", "unbalance", "braking", "storage", "thermal", "rails")
BEGINS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}


@pytest.fixture
def demo(tpss_command, short_file, tmp_path):
    """A saved result."""
    assert tpss_command("run", short_file, *SHORT).code == 0
    return tmp_path / "demo"


def test_all_figures_go_into_a_folder_of_the_result(tpss_command, demo):
    said = tpss_command("plot", "demo")
    assert (said.code, said.err) == (0, "")
    assert said.out.startswith("Wrote into demo/figures: network.png, time-distance.png, journey")
    written = {file.name for file in (demo / "figures").iterdir()}
    assert written == {f"{name}.png" for name in FIGURES if name not in UNTOLD}
    assert "Left out thermal: no equipment has a rating" in said.out


def test_losses_of_converters_are_drawn_where_they_are_described(tpss_command, short_file):
    losses = "supply.converter_stations.*.type=Q48/Q49 with losses (estimate)"
    assert tpss_command("run", short_file, *SHORT, "--set", losses).code == 0
    assert "converter-losses.png" in tpss_command("plot", "demo").out


def test_losses_that_are_not_described_are_not_drawn(tpss_command, demo):
    said = tpss_command("plot", "demo", "--figure", "converter-losses")
    assert said.code == 2
    assert "no converter type describes its losses" in said.err


@pytest.mark.parametrize("kind", BEGINS)
def test_the_name_of_the_file_decides_its_format(tpss_command, demo, tmp_path, kind):
    said = tpss_command("plot", "demo", "--figure", "journey", "--out", f"a.{kind}")
    assert (said.code, said.out) == (0, f"Wrote a.{kind}")
    assert (tmp_path / f"a.{kind}").read_bytes().startswith(BEGINS[kind])


def test_the_same_result_gives_the_same_file(tpss_command, demo, tmp_path):
    for name in ("a.pdf", "b.pdf"):
        tpss_command("plot", "demo", "--figure", "energy", "--out", name)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()


def test_a_journey_against_time_differs_from_one_against_distance(tpss_command, demo, tmp_path):
    for axis in ("time", "distance"):
        said = tpss_command("plot", "demo", "--figure", "journey", "--against", axis,
                            "--train", "eastbound 1", "--out", f"{axis}.svg")  # fmt: skip
        assert said.code == 0
    assert (tmp_path / "time.svg").read_bytes() != (tmp_path / "distance.svg").read_bytes()


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (
            ("--figure", "jurney"),
            "there is no figure 'jurney'; did you mean journey? choose from all",
        ),
        (("--figure", "energy", "--train", "eastbound 1"), "energy does not show a single train; leave"),
        (("--figure", "energy", "--against", "time"), "energy is not a journey; leave --against"),
        (
            ("--figure", "journey", "--train", "x"),
            "there is no train 'x' on the line; trains: east",
        ),
        (("--figure", "energy", "--from", "West", "--to", "East"), "energy shows the whole run; leave"),
        (("--figure", "energy", "--out", "a.jpg"), "a.jpg has an unknown format; use a name that"),
        (("--figure", "energy", "--out", "no/a.png"), "there is no folder no"),
        (("--out", "a.png"), "a.png is one file, and all figures need a folder"),
        (("--figure", "energy", "--out", "demo.svg"), "demo.svg exists already"),
        (("--out", "demo.svg/x"), "demo.svg/x cannot be written"),
    ],
    ids=[
        "figure",
        "train of all",
        "axis of none",
        "train",
        "stretch",
        "format",
        "folder",
        "one file",
        "there",
        "below a file",
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_said_and_nothing_is_written(
    tpss_command, demo, tmp_path, asked, words
):
    (tmp_path / "demo.svg").write_text("mine")
    before = sorted(tmp_path.iterdir())
    said = tpss_command("plot", "demo", *asked)
    assert (said.code, said.out) == (2, "")
    assert words in said.err
    assert sorted(tmp_path.iterdir()) == before
    assert (tmp_path / "demo.svg").read_text() == "mine"


def test_existing_figures_need_force(tpss_command, demo):
    tpss_command("plot", "demo", "--figure", "energy")
    assert tpss_command("plot", "demo", "--figure", "energy").code == 2
    assert tpss_command("plot", "demo", "--figure", "energy", "--force").code == 0


def test_where_no_train_runs_the_others_are_drawn_and_it_is_said(tpss_command, short_file):
    late = ("--set", "traffic.0.first_departure_min=9")
    assert tpss_command("run", short_file, *late, *SHORT).code == 0
    said = tpss_command("plot", "demo")
    assert said.code == 0
    assert "Left out journey: no train was on the line" in said.out
    refused = tpss_command("plot", "demo", "--figure", "journey")
    assert refused.code == 2
    assert "demo (finished) holds nothing to draw: no train was on the line" in refused.err


def test_a_folder_without_a_result_is_refused(tpss_command):
    said = tpss_command("plot", "nowhere")
    assert said.code == 2
    assert "nowhere is not a result folder" in said.err


def test_some_minutes_of_a_long_run_are_drawn(tpss_command, demo, tmp_path):
    call = ("plot", "demo", "--figure", "time-distance", "--out", "part.png")
    assert tpss_command(*call, "--from-min", 1, "--to-min", 2.5).code == 0
    result = tpss.load_result(demo)
    assert draw("time-distance", result, minutes=(1.0, 2.5)).axes[0].get_xlim() == (1.0, 2.5)
    assert draw("time-distance", result, minutes=(None, 2.0)).axes[0].get_xlim() == (0.0, 2.0)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--from-min", 2, "--to-min", 1), "no minutes 2 to 1 to draw; give some of 0 to 3"),
        (("--to-min", 90), "no minutes 0 to 90 to draw"),
        (("--from-min", 0, "--figure", "journey"), "journey is not time-distance; leave"),
    ],
)
def test_minutes_that_cannot_be_drawn_are_refused(tpss_command, demo, options, words):
    said = tpss_command("plot", "demo", "--figure", "time-distance", *options)
    assert said.code == 2
    assert words in said.err


@pytest.fixture
def other(tpss_command, short_file, demo, tmp_path):
    """Another saved result, of lighter trains."""
    lighter = ("--set", "trains.freight.mass_t=900", "--out", "other", "--set", "name=lighter")
    assert tpss_command("run", short_file, *SHORT, *lighter).code == 0
    return tmp_path / "other"


@pytest.mark.parametrize("name", [name for name in FIGURES if FIGURES[name].overlaid])
def test_several_results_are_drawn_into_one_figure_if_one_of_them_can_be(
    tpss_command, demo, other, tmp_path, name
):
    one = tpss_command("plot", "demo", "--figure", name)
    both = tpss_command("plot", "demo", "other", "--figure", name, "--out", "both.png")
    assert both.code == one.code
    if one.code == 0:
        assert both.out == "Wrote both.png"
        assert (tmp_path / "both.png").read_bytes().startswith(BEGINS["png"])
    else:
        assert "holds nothing to draw" in both.err


def test_results_that_are_overlaid_are_told_apart_by_their_labels(demo, other):
    runs = {"heavy": tpss.load_result(demo), "light": tpss.load_result(other)}
    figure = overlay("train-voltage", runs)
    assert figure.get_suptitle().startswith("heavy / light")
    told = [text.get_text() for text in figure.findobj(Legend)[0].get_texts()]
    assert told == ["heavy", "light"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--out", "a.png"), "of several results one figure is drawn; name it by --figure"),
        (("--figure", "journey"), "belongs to none of them; give its --out"),
        (("--figure", "network", "--out", "a.png"), "network shows a single result; name one, or"),
        (("--figure", "journey", "--label", "a", "--out", "a.png"), "1 labels for 2 results"),
    ],
)
def test_what_several_results_cannot_be_drawn_as_is_said(
    tpss_command, demo, other, tmp_path, options, words
):
    said = tpss_command("plot", "demo", "other", *options)
    assert said.code == 2
    assert words in said.err
    assert not (tmp_path / "a.png").exists()
