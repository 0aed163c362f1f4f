"""Cases are drawn as the design says, and each follows from its number alone."""

import numpy as np
import pytest

from sweep.studies import study
from tpss.sweep.design import Design, design_of
from tpss.sweep.study import study_of_json
from tpss.sweep.variation import Variation

LENGTH, HEADWAY = "line.length_km", "traffic.0.headway_min"
RANGES = {LENGTH: {"low": 10.0, "high": 20.0}, HEADWAY: {"low": 5.0, "high": 30.0}}


def drawn(tmp_path, design: str, cases: int, seed: int = 0) -> Design:
    changes = {"design": design, "cases": cases, "seed": seed, "vary": RANGES}
    return design_of(study(tmp_path, changes))


def points(design: Design) -> np.ndarray:
    return np.array([list(design.values(case).values()) for case in range(design.cases)])


def test_a_grid_has_all_combinations_the_last_parameter_first(tmp_path):
    design = design_of(study(tmp_path))
    values = [tuple(design.values(case).values()) for case in range(design.cases)]
    assert values == [(5.0, 1), (5.0, 2), (5.0, 3), (10.0, 1), (10.0, 2), (10.0, 3)]


def test_a_range_in_a_grid_has_its_ends_and_equal_steps(tmp_path):
    vary = {LENGTH: {"low": 10.0, "high": 20.0, "steps": 5}}
    design = design_of(study(tmp_path, {"vary": vary}))
    assert points(design).ravel().tolist() == [10.0, 12.5, 15.0, 17.5, 20.0]


def test_a_latin_hypercube_has_one_case_in_each_slice(tmp_path):
    """Of 20 cases, one in every twentieth of each range."""
    found = points(drawn(tmp_path, "latin-hypercube", 20))
    for column, (low, high) in zip(found.T, [(10.0, 20.0), (5.0, 30.0)], strict=True):
        slices = np.floor((column - low) / (high - low) * 20).astype(int)
        assert sorted(slices) == list(range(20))


def test_a_sobol_sequence_goes_on_where_it_ended(tmp_path):
    """So a study can be continued: its first cases stay the same ones, whatever their number."""
    few, many = drawn(tmp_path, "sobol", 11), drawn(tmp_path, "sobol", 40)
    assert points(many)[:11].tolist() == points(few).tolist()
    assert few.study.digest == many.study.digest


def test_sixteen_points_of_a_sobol_sequence_fill_sixteen_boxes(tmp_path):
    """In base 2 every elementary box of area 1/16 holds one point of the first 16."""
    found = (points(drawn(tmp_path, "sobol", 16)) - [10.0, 5.0]) / [10.0, 25.0]
    for across in (1, 2, 4, 8, 16):
        boxes = np.floor(found * [across, 16 // across]).astype(int)
        assert len(np.unique(boxes, axis=0)) == 16


@pytest.mark.parametrize("design", ["sobol", "latin-hypercube"])
def test_a_seed_decides_what_is_drawn(tmp_path, design):
    first, same = drawn(tmp_path, design, 8, seed=1), drawn(tmp_path, design, 8, seed=1)
    other = drawn(tmp_path, design, 8, seed=2)
    assert points(first).tolist() == points(same).tolist()
    assert points(first).tolist() != points(other).tolist()
    assert first.study.digest == same.study.digest != other.study.digest


def test_a_study_survives_its_way_to_another_machine(tmp_path):
    design = drawn(tmp_path, "sobol", 8)
    arrived = design_of(study_of_json(design.study.as_json()))
    assert points(arrived).tolist() == points(design).tolist()
    assert arrived.study.digest == design.study.digest


@pytest.mark.parametrize(
    ("parameter", "shares", "expected"),
    [
        ({"values": ["a", "b"]}, [0.0, 0.49, 0.5, 0.99], ["a", "a", "b", "b"]),
        ({"low": 0.0, "high": 4.0}, [0.0, 0.25], [0.0, 1.0]),
        ({"low": 1.0, "high": 3.0, "whole": True}, [0.0, 0.34, 0.67, 0.999], [1, 2, 3, 3]),
        ({"low": 1.0, "high": 100.0, "scale": "log"}, [0.0, 0.5], [1.0, 10.0]),
        ({"low": 1.0, "high": 100.0, "scale": "log", "whole": True}, [0.25, 0.75], [3, 32]),
    ],
)
def test_a_share_of_the_way_gives_a_value(parameter, shares, expected):
    """Half-way on a logarithmic scale lies the geometric mean, √(1 · 100) = 10."""
    values = [Variation.model_validate(parameter).at(share) for share in shares]
    assert values == (pytest.approx(expected) if isinstance(expected[0], float) else expected)


def test_key_paths_may_be_written_with_or_without_quotes(tmp_path):
    nested = {"traffic": {"0": {"headway_min": {"low": 5.0, "high": 30.0}}}}
    flat = {HEADWAY: {"low": 5.0, "high": 30.0}}
    changes = {"design": "sobol", "cases": 4}
    with_quotes, without = (study(tmp_path, {**changes, "vary": vary}) for vary in (flat, nested))
    assert list(without.file.vary) == [HEADWAY]
    assert without.digest == with_quotes.digest
