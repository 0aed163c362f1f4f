"""Equipment under loads that are given: states, windows, overloads and verdicts by hand.

Each case is a load over steps of a minute, or as said, of one piece of equipment with a rating.
"""

import json
import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

from tpss.results.standards.windows import highest_means, highest_means_between
from tpss.results.thermal.body import Body, body_of
from tpss.results.thermal.elements import Element
from tpss.results.thermal.judge import Judged, Thermal
from tpss.results.thermal.words import thermal_in_words
from tpss.scenario.rating import CatenaryRating, MotorRating, Rating, TransformerRating

MIN = 60.0
CONVERTER = {
    "time_constant_min": 30.0,
    "overloads": [{"percent": 125.0, "minutes": 60.0}, {"percent": 150.0, "minutes": 5.0}],
}
WIRE = {"time_constant_min": 4.7, "continuous_a": 467.0, "reference_c": 80.0, "ambient_c": 40.0}


def thermal(body: Body, load: Any, step_s: float = MIN, last_s: float | None = None) -> Thermal:
    """Judgement of a load without any train."""
    steps = len(load)
    time = np.arange(steps + 1.0) * step_s
    if last_s is not None:
        time[-1] = time[-2] + last_s
    none = (("time", "train"), np.empty((steps + 1, 0)))
    dataset = xr.Dataset(
        dict.fromkeys(("position", "active_power", "reactive_power"), none),
        coords={"time": time, "train": np.empty(0, dtype=str)},
    )
    element = Element("it", "converter", 0, 0.0, body)
    return Thermal.of([(element, np.array(load, dtype=float))], dataset.time.to_numpy(), dataset)


def judged(body: Body, load: Any, **more: Any) -> Judged:
    return thermal(body, load, **more).judged[0]


def rated(**keys: Any) -> Body:
    return body_of(Rating.model_validate({**CONVERTER, **keys}))


def test_the_rated_load_for_ever_is_within():
    found = judged(rated(overloads=[]), [1.0] * 200)
    assert found.highest_state_percent == pytest.approx(100.0)
    assert (found.verdict, found.allowed_state_percent) == ("within", 100.0)


def test_a_little_more_than_the_rated_load_for_ever_is_over():
    found = judged(rated(overloads=[]), [1.001] * 200)
    assert (found.verdict, found.highest_state_percent) == ("over", pytest.approx(100.2001))


def test_a_run_begins_in_the_steady_state_of_its_mean_square():
    """Loads of 1.2 and 0.5 by turns: (1.44 + 0.25) / 2 = 0.845, a load of 91.92 %."""
    found = thermal(rated(), [1.2, 0.5] * 30)
    assert found.states.state[0, 0] == pytest.approx(0.845)
    assert found.judged[0].start_load_percent == pytest.approx(100.0 * math.sqrt(0.845))
    assert found.judged[0].start == "r.m.s. load of the run"


def test_a_short_last_step_counts_as_it_is():
    """59 min of 0.5 and 15 s of 2.0: (59 · 0.25 + 0.25 · 4) / 59.25 = 0.26582."""
    found = thermal(rated(), [0.5] * 59 + [2.0], last_s=15.0)
    assert found.states.state[0, 0] == pytest.approx(15.75 / 59.25)
    assert found.states.state[-1, 0] == pytest.approx(
        4.0 + (found.states.state[-2, 0] - 4.0) * math.exp(-0.25 / 30.0)
    )


def test_a_preload_is_where_a_run_begins():
    found = thermal(rated(preload_percent=80.0), [0.0] * 60)
    expected = 0.64 * np.exp(-np.arange(61) / 30.0)
    np.testing.assert_allclose(found.states.state[:, 0], expected, rtol=1e-12)
    assert found.judged[0].start == "preload_percent"
    assert found.judged[0].highest_state_percent == pytest.approx(64.0)
    assert found.judged[0].state_at_min == 0.0


def test_windows_of_an_overload_by_hand():
    """Rated load, but for 10 min of 160 %: r.m.s. over 5 min 160, over 15 √((10 · 2.56 + 5) / 15) =
    142.8, over 60 √((25.6 + 50) / 60) = 112.2, over 120 √((25.6 + 110) / 120) = 106.3 %.  The table
    allows 150 over 5 min and 125 over 60, and judges no others, as protection does.
    """
    load = [1.0] * 60 + [1.6] * 10 + [1.0] * 60
    table = thermal(rated(), load).windows.set_index("window_min")
    expected = {1.0: 160.0, 5.0: 160.0, 15.0: 142.83, 60.0: 112.25, 120.0: 106.30}
    for window, percent in expected.items():
        assert table.highest_rms_percent[window] == pytest.approx(percent, abs=5e-3), window
    allowed = table.allowed_rms_percent
    assert allowed.dropna().to_dict() == {5.0: 150.0, 60.0: 125.0}
    assert math.isnan(allowed[120.0])
    assert 60.0 <= table.from_min[5.0] <= 65.0
    found = judged(rated(), load)
    assert (found.verdict, found.window_min) == ("over", 5.0)
    assert found.allowed_rms_percent == 150.0


def test_the_overloads_that_are_allowed_are_within_after_the_rated_load():
    """125 % for 60 min leads to 1.5625 - 0.5625 e^-2 = 148.6 %, 150 % for 5 min to 119.2 %."""
    body = rated(preload_percent=100.0)
    assert body.allowed_state == pytest.approx(1.5625 - 0.5625 * math.exp(-2.0))
    found = judged(body, [1.25] * 60)
    assert (found.verdict, found.highest_state_percent) == (
        "within",
        pytest.approx(148.637, abs=1e-3),
    )
    assert judged(body, [1.5] * 5 + [0.0] * 60).verdict == "within"


def test_an_allowed_overload_for_longer_is_over():
    """125 % for ever leads to 156 %, more than an hour of it does."""
    found = judged(rated(preload_percent=100.0), [1.25] * 90)
    assert found.verdict == "over"
    assert found.highest_rms_percent == pytest.approx(125.0)


def test_a_window_longer_than_the_run_has_no_mean():
    table = thermal(rated(), [1.0] * 10).windows.set_index("window_min")
    assert np.isnan(table.highest_rms_percent[[15.0, 30.0, 60.0, 120.0]]).all()
    assert table.highest_rms_percent[5.0] == pytest.approx(100.0)


def test_windows_that_begin_within_steps():
    """Steps of 2 min with the values 0, 4 and 1: over 1 min 4 is highest.  Over 5 min it is the window
    that ends with the run, and begins after 1 min: (0 · 1 + 4 · 2 + 1 · 2) / 5 = 2.
    """
    ((one, _), (five, begin)) = highest_means_between(
        np.array([[0.0], [4.0], [1.0]]), np.array([0.0, 2.0, 4.0, 6.0]), [1.0, 5.0]
    )
    assert (one[0], five[0], begin[0]) == (4.0, pytest.approx(2.0), pytest.approx(1.0))


@pytest.mark.parametrize("width", [1.0, 2.5, 7.0, 40.0])
def test_windows_are_those_of_equal_steps_where_steps_are_equal(width):
    values = np.random.default_rng(4).uniform(0.0, 1.0, (40, 3))
    found = highest_means_between(values, np.arange(41.0), [width])[0]
    for one, other in zip(found, highest_means(values, width), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12)


def test_windows_of_unequal_steps_are_no_lower_than_any_that_is_tried():
    random = np.random.default_rng(5)
    instants = np.concatenate([[0.0], np.cumsum(random.uniform(0.1, 2.0, 30))])
    values = random.uniform(0.0, 1.0, (30, 1))
    highest, begin = highest_means_between(values, instants, [3.3])[0]

    def mean(start: float) -> float:
        overlap = np.diff(np.clip(instants, start, start + 3.3))
        return float(overlap @ values[:, 0]) / 3.3

    assert mean(float(begin[0])) == pytest.approx(highest[0], rel=1e-12)
    assert max(mean(s) for s in np.linspace(0.0, instants[-1] - 3.3, 4001)) <= highest[0] + 1e-12


@pytest.mark.parametrize(
    "body",
    [
        rated(),
        body_of(CatenaryRating.model_validate(WIRE)),
        body_of(TransformerRating(cooling="ONAF")),
        body_of(TransformerRating(cooling="ONAN", ambient_c=35.0)),
    ],
    ids=["converter", "contact line", "ONAF", "ONAN"],
)
def test_figures_do_not_depend_on_the_time_step(body):
    """The same load in steps of a minute and of a second: within 0.5 %, the states exactly."""
    load = np.random.default_rng(6).uniform(0.0, 1.8, 150)
    coarse = thermal(body, load)
    fine = thermal(body, np.repeat(load, 60), step_s=1.0)
    np.testing.assert_allclose(
        fine.states.state[::60, 0], coarse.states.state[:, 0], rtol=1e-9, atol=1e-12
    )
    one, other = coarse.judged[0], fine.judged[0]
    assert one.verdict == other.verdict
    for name in (
        "highest_state_percent",
        "loss_of_life_min",
        "highest_rms_percent",
        "highest_temperature_c",
    ):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=5e-3, nan_ok=True)


def test_a_wire_at_its_continuous_current_has_its_reference_temperature():
    found = judged(body_of(CatenaryRating.model_validate(WIRE)), [1.0] * 60)
    assert (found.highest_temperature_c, found.allowed_temperature_c) == (pytest.approx(80.0), 80.0)


def test_a_transformer_may_be_as_hot_as_its_rating_says():
    """At 20 °C and rated load 98 °C, of which 120 are allowed; an hour of it costs an hour of life."""
    found = judged(body_of(TransformerRating(cooling="ONAF")), [1.0] * 60)
    assert found.highest_temperature_c == pytest.approx(98.0)
    assert (found.allowed_temperature_c, found.verdict) == (pytest.approx(120.0), "within")
    assert found.loss_of_life_min == pytest.approx(60.0)
    assert found.allowed_state_percent == pytest.approx(100.0 * 100.0 / 78.0)


def test_a_transformer_that_passes_its_temperature_is_over():
    """From 0.6 to 1.5 for an hour: 141 °C."""
    body = body_of(TransformerRating(cooling="ONAF", preload_percent=60.0))
    found = judged(body, [1.5] * 60)
    assert (found.verdict, found.highest_temperature_c) == ("over", pytest.approx(141.0, abs=0.6))
    assert found.state_at_min == 60.0


def test_a_transformer_that_burns_has_no_number_for_its_life():
    """At 40 times its rating it passes 6242 °C, where paper ages infinitely fast; JSON cannot say so."""
    found = thermal(body_of(TransformerRating(cooling="ONAF")), [40.0] * 60)
    assert found.judged[0].loss_of_life_min == math.inf
    (told,) = found.as_dict()["elements"].values()
    assert told["verdict"] == "over"
    assert "loss_of_life_min" not in told
    json.dumps(told, allow_nan=False)


def test_a_motor_bears_its_short_time_current_for_its_time_from_cold():
    """2080 A for 6 min from cold: 100 %; half a minute more is too long."""
    rating = {"continuous_a": 1250.0, "short_time_a": 2080.0, "short_time_min": 6.0}
    body = body_of(MotorRating.model_validate({**rating, "preload_percent": 0.0}))
    idle = [0.0] * 60
    assert judged(body, [1.664] * 12 + idle, step_s=30.0).verdict == "within"
    assert judged(body, [1.664] * 13 + idle, step_s=30.0).verdict == "over"


def test_what_is_not_there_yet_begins_when_it_comes():
    """Ten minutes absent, then the rated load, from a preload of 50 %: 0.25 until it comes."""
    nan = math.nan
    found = thermal(rated(preload_percent=50.0), [nan] * 10 + [1.0] * 30)
    state = found.states.state[:, 0]
    assert np.isnan(state[:10]).all()
    np.testing.assert_allclose(state[10:], 1.0 - 0.75 * np.exp(-np.arange(31) / 30.0), rtol=1e-12)


def test_what_begins_hottest_is_hottest_when_it_comes():
    """A load of 90 % before, 50 % from the tenth minute on: 81 % then, and not before."""
    found = judged(rated(preload_percent=90.0), [math.nan] * 10 + [0.5] * 30)
    assert (found.highest_state_percent, found.state_at_min) == (pytest.approx(81.0), 10.0)


def test_what_has_left_is_no_longer_judged():
    state = thermal(rated(), [1.0] * 10 + [math.nan] * 10).states.state[:, 0]
    assert np.isfinite(state[:11]).all()
    assert np.isnan(state[11:]).all()


def test_the_mean_of_what_comes_later_is_that_of_its_own_time():
    found = judged(rated(), [math.nan] * 30 + [0.6] * 30)
    assert found.start_load_percent == pytest.approx(60.0)


def test_words_tell_what_decides():
    load = [1.0] * 60 + [1.6] * 10 + [1.0] * 60
    assert thermal_in_words(thermal(rated(), load).as_dict()) == [
        "Thermal: 1 of 1 rated over what they bear: it: 160.0 % r.m.s. over 5 min from 64.00 min, "
        "150.0 % allowed (before the run the r.m.s. load of the run, 106 %)"
    ]
    wire = body_of(CatenaryRating.model_validate({**WIRE, "preload_percent": 0.0}))
    assert thermal_in_words(thermal(wire, [0.5] * 60).as_dict()) == [
        "Thermal: 1 rated, all within what they bear; closest to it is it: 50 °C, thermal state 25.0 % "
        "at 60.00 min, 100.0 % allowed (before the run a preload, 0 %)"
    ]
