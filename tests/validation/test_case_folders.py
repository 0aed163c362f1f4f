"""A validation folder that does not say where its figures come from, or why, is refused."""

import re
import shutil

import pytest

from cases import HERE, CaseError, load_case

GOOD = HERE / "Boullanger_2009_Table_3_4"


@pytest.fixture
def folder(tmp_path):
    """A complete case, to be spoilt."""
    return shutil.copytree(GOOD, tmp_path / "A_2009_Table_1")


def spoil(file, old, new):
    text = file.read_text("utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), "utf-8")


def refusal(folder):
    with pytest.raises(CaseError) as caught:
        load_case(folder)
    message = str(caught.value)
    assert message.startswith("A_2009_Table_1: ")
    return message


def test_a_complete_folder_is_a_case(folder):
    case = load_case(folder)
    assert case.title == "Table 3-4: a stop half-way"
    assert [quantity.name for quantity in case.expected.quantities][:2] == ["trip time", "E1 + E2"]


@pytest.mark.parametrize("name", ["README.md", "scenario.toml", "expected.toml"])
def test_every_file_is_needed(folder, name):
    (folder / name).unlink()
    assert f"{name} is missing" in refusal(folder)


@pytest.mark.parametrize("paragraph", ["Source", "Stated", "Assumed"])
def test_provenance_is_needed(folder, paragraph):
    spoil(folder / "README.md", f"**{paragraph}.**", paragraph)
    message = refusal(folder)
    assert f"no paragraph '**{paragraph}.** ...'" in message
    assert "a case without provenance proves nothing" in message


def test_a_title_is_needed(folder):
    spoil(folder / "README.md", "# ", "")
    assert "begins without a title" in refusal(folder)


def first_reason(folder):
    """The first reason as it stands in the file."""
    text = (folder / "expected.toml").read_text("utf-8")
    return re.search(r'reason = """.*?"""', text, re.DOTALL)[0]


def test_a_tolerance_needs_a_reason(folder):
    spoil(folder / "expected.toml", first_reason(folder), "")
    message = refusal(folder)
    assert "expected.toml: quantities.0.reason (trip time): Field required" in message
    assert "say why it is as wide as it is" in message


def test_a_word_is_no_reason(folder):
    spoil(folder / "expected.toml", first_reason(folder), 'reason = "trust me"')
    assert "at least 20 characters" in refusal(folder)


@pytest.mark.parametrize("rules", ["", 'within = 0.5\nbound = "at most"'])
def test_a_quantity_has_one_rule(folder, rules):
    spoil(folder / "expected.toml", "within = 0.5", rules)
    assert "give one of within, within_percent, bound, shown_only" in refusal(folder)


def test_an_unknown_key_is_refused(folder):
    spoil(folder / "expected.toml", "within = 0.5", "wihtin = 0.5")
    assert "wihtin" in refusal(folder)


def test_a_value_of_a_run_that_is_not_run_is_refused(folder):
    spoil(folder / "expected.toml", '"after" = 104.5', '"before" = 106.5')
    assert "expected.toml names before, which is not run" in refusal(folder)


def test_a_measure_that_is_not_there_is_refused(folder):
    spoil(folder / "expected.toml", '"trip_time_min"', '"trip_min"')
    assert "no measure trip_min; there are trip_time_min, " in refusal(folder)


def test_a_drawing_that_is_not_there_is_refused(folder):
    file = folder / "expected.toml"
    drawing = '[[figures]]\ndraw = "jorney"\nruns = ["after"]\nvariants = ["A"]\n'
    text = file.read_text("utf-8") + drawing + 'caption = "The journey of a train."\n'
    file.write_text(text, "utf-8")
    assert "figures.0.draw: Input should be 'journey'" in refusal(folder)


def test_a_miss_of_something_else_is_refused(folder):
    spoil(
        folder / "expected.toml", '[[misses]]\nquantity = "trip time"', '[[misses]]\nquantity = "E"'
    )
    assert "a miss of E, no such quantity" in refusal(folder)


@pytest.mark.parametrize(
    ("rule", "ours", "agrees"),
    [
        ("within = 0.5", 105.0, True),
        ("within = 0.5", 105.01, False),
        ("within = 0.5", 103.99, False),
        ("within_percent = 1.0", 105.545, True),
        ("within_percent = 1.0", 105.6, False),
        ('bound = "at most"', 104.5, True),
        ('bound = "at most"', 104.6, False),
        ('bound = "at least"', 104.5, True),
        ('bound = "at least"', 104.4, False),
        ('shown_only = "percent"', 1.0, None),
        ("within = 0.5", float("nan"), False),
    ],
)
def test_rules_judge_as_they_are_written(folder, rule, ours, agrees):
    spoil(folder / "expected.toml", "within = 0.5", rule)
    quantity = load_case(folder).expected.quantities[0]
    assert quantity.agrees(104.5, ours) is agrees
