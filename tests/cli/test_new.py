"""The command ``tpss new``: an example to start from that can be checked and run as it stands."""

import tomllib

import pytest

import tpss
from tpss import load_result


def test_the_example_can_be_checked_and_run(tpss_command, tmp_path):
    said = tpss_command("new", "my-line")
    assert (said.code, said.err) == (0, "")
    assert "tpss check my-line/scenario.toml tpss run my-line/scenario.toml" in said.out
    checked = tpss_command("check", "my-line/scenario.toml")
    assert checked.code == 0
    assert "Note:" not in checked.out
    assert tpss_command("run", "my-line/scenario.toml", "--quiet").code == 0
    result = load_result(tmp_path / "results" / "first-line-001")
    assert result.status == "finished"
    assert result.trips.set_index("train").distance_km["eastbound 1"] == pytest.approx(60.0)


def test_what_the_comments_offer_can_be_used(tpss_command, tmp_path):
    """Each line that is commented out stands for what it says when the # is taken away."""
    tpss_command("new", "a")
    file = tmp_path / "a" / "scenario.toml"
    text = file.read_text("utf-8")
    offers = {
        "# duration_min": "until = ",
        '# rail = "wet"': None,
        "# gradients = ": "gradients_file = ",
        "# catenary = ": "catenary = ",
        "# max_motor_current_a": None,
        "# [supply.high_voltage_line]": None,
        '# type = "132kV"': None,
        "# transformers_km": None,
    }
    for offer, instead_of in offers.items():
        assert offer in text
        if instead_of:
            text = text.replace(f"\n{instead_of}", f"\n# was: {instead_of}")
        text = text.replace(offer, offer.removeprefix("# "))
    file.write_text(text, "utf-8")
    assert tomllib.loads(text)["simulation"]["duration_min"] == 120.0
    said = tpss_command("check", file)
    assert said.code == 0
    assert "132kV, 132 kV; transformers: 16MVA at 20 km, 40 km" in said.out


def test_a_folder_with_other_files_is_filled(tpss_command, tmp_path):
    (tmp_path / "notes.txt").write_text("Years of work.")
    assert tpss_command("new", ".").code == 0
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["gradients.csv", "notes.txt", "scenario.toml"]


@pytest.mark.parametrize("name", ["scenario.toml", "gradients.csv"])
def test_no_file_is_overwritten(tpss_command, tmp_path, name):
    (tmp_path / name).write_text("Years of work.")
    said = tpss_command("new", ".")
    assert (said.code, said.out) == (2, "")
    assert f"{name} exists already and is not changed; name another folder" in said.err
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert (tmp_path / name).read_text() == "Years of work."


def test_a_link_is_not_written_through(tpss_command, tmp_path):
    (tmp_path / "scenario.toml").symlink_to(tmp_path / "elsewhere")
    assert tpss_command("new", ".").code == 2
    assert not (tmp_path / "elsewhere").exists()


def test_a_folder_that_cannot_be_made_is_explained(tpss_command, tmp_path):
    (tmp_path / "notes.txt").touch()
    said = tpss_command("new", "notes.txt/a")
    assert said.code == 2
    assert "notes.txt/a cannot be written: Not a directory; name another folder" in said.err


def test_a_folder_with_a_space_is_quoted_in_what_to_type_next(tpss_command):
    assert "tpss check 'my line/scenario.toml'" in tpss_command("new", "my line").out


def test_the_examples_are_listed_with_a_line_each(tpss_command, tmp_path):
    said = tpss_command("new", "--from", "list")
    assert said.code == 0
    for name, sentence in tpss.examples.names().items():
        assert f"{name} {sentence}" in said.out
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", tpss.examples.names())
def test_an_example_is_copied_with_all_that_it_needs(tpss_command, tmp_path, name):
    """What is told as the next thing to do can be done."""
    said = tpss_command("new", "mine", "--from", name)
    assert (said.code, said.err) == (0, "")
    for place, file in tpss.examples.files_of(name).items():
        assert (tmp_path / "mine" / place).read_bytes() == file.read_bytes()
    _, *calls = said.out.split("then run: ")[1].split("tpss ")
    if "plan" in calls[0]:
        tpss.load_plan(tmp_path / "mine" / tpss.examples.path(name).name)
    elif "sweep" in calls[0]:
        tpss.load_study(tmp_path / "mine" / tpss.examples.path(name).name)
    else:
        assert tpss_command(*calls[0].split()).code == 0


def test_no_file_of_an_example_is_overwritten(tpss_command, tmp_path):
    (tmp_path / "network_timetable.csv").write_text("Years of work.")
    said = tpss_command("new", ".", "--from", "network")
    assert said.code == 2
    assert "network_timetable.csv exists already and is not changed" in said.err
    assert [path.name for path in tmp_path.iterdir()] == ["network_timetable.csv"]


def test_an_example_that_there_is_not_is_told_with_the_closest(tpss_command):
    said = tpss_command("new", "a", "--from", "thesis-160")
    assert said.code == 2
    assert "there is no such example; did you mean thesis-160km?" in said.err


def test_a_folder_has_to_be_named(tpss_command):
    said = tpss_command("new")
    assert said.code == 2
    assert "give a folder to write, such as my-line, or --from list" in said.err
