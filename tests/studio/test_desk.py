"""The open file: edits, and how they come into it."""

import tomllib

import pytest

from tpss.errors import ScenarioError
from tpss.studio.desk import MOST_EDITS, Desk
from tpss.studio.drafts import OvertakenError

from studio_page import LINE

HEADWAY = ["traffic.0.headway_min", 12]


def test_edits_are_made_in_their_order(file):
    edits = [
        ["traffic.0.stops.+", {"station": "Middle", "dwell_min": 1.0}],
        ["traffic.0.stops.0.dwell_min", 2.5],
    ]
    document = Desk(file).document(edits)
    assert document["traffic"][0]["stops"] == [{"station": "Middle", "dwell_min": 2.5}]


def test_a_whole_number_stays_decimal_where_one_was(file):
    found = Desk(file).document([HEADWAY, ["supply.converter_stations.0.converters", 3]])
    assert repr(found["traffic"][0]["headway_min"]) == "12.0"
    assert repr(found["supply"]["converter_stations"][0]["converters"]) == "3"


def test_what_is_saved_keeps_comments(file):
    desk = Desk(file)
    desk.save([HEADWAY], desk.content.digest)
    text = file.read_text("utf-8")
    assert text == LINE.replace("headway_min = 60.0  #", "headway_min = 12.0  #")
    assert tomllib.loads(text) == desk.content.document


def test_a_file_that_was_changed_meanwhile_is_not_overwritten(file):
    desk = Desk(file)
    file.write_text(file.read_text("utf-8") + "# of another\n", encoding="utf-8")
    with pytest.raises(OvertakenError, match="changed on the disk"):
        desk.save([HEADWAY], desk.content.digest)
    assert file.read_text("utf-8").endswith("# of another\n")


def test_a_page_that_knows_an_older_file_does_not_save(file):
    desk = Desk(file)
    before = desk.content.digest
    desk.save([HEADWAY], before)
    with pytest.raises(OvertakenError):
        desk.save([["traffic.0.headway_min", 15]], before)


def test_too_many_edits_are_refused(file):
    with pytest.raises(ScenarioError, match="too many edits"):
        Desk(file).document([HEADWAY] * (MOST_EDITS + 1))


@pytest.mark.parametrize(
    ("key", "name"),
    [
        ("line.gradients_file", "../gradients.csv"),
        ("line.gradients_file", "/etc/passwd"),
        ("trains.freight.model", "../../own.toml"),
        ("supply.catenary", "link/own.toml"),
    ],
)
def test_files_outside_the_folder_are_not_read(file, tmp_path_factory, key, name):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "own.toml").write_text("r_ohm_per_km = 0.2\nx_ohm_per_km = 0.2\n", "utf-8")
    (file.parent / "link").symlink_to(elsewhere)
    desk = Desk(file)
    edits = [[key, name], *([["line.gradients", None]] if key.startswith("line") else [])]
    with pytest.raises(ScenarioError) as raised:
        desk.scenario(desk.document(edits))
    (finding,) = raised.value.findings
    assert (finding.key, finding.problem) == (key, "a file outside the opened folder")


def test_a_larger_folder_may_be_opened(file, tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    moved = file.rename(inner / "line.toml")
    (tmp_path / "own.toml").write_text("r_ohm_per_km = 0.2\nx_ohm_per_km = 0.2\n", "utf-8")
    edits = [["supply.catenary", "../own.toml"]]
    desk = Desk(moved, tmp_path)
    assert desk.name == "inner/line.toml"
    assert desk.scenario(desk.document(edits)).supply.catenary.r_ohm_per_km == 0.2


def test_a_file_must_lie_in_the_opened_folder(file, tmp_path):
    (tmp_path / "other").mkdir()
    with pytest.raises(ScenarioError, match="not in the opened folder"):
        Desk(file, tmp_path / "other")
