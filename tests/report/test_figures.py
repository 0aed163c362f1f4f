"""Figures show what the result holds, in the units that their axes name."""

import numpy as np
import pytest

from tpss.report.figures import (
    journey,
    station_loading,
    station_powers,
    voltage_along_line,
)
from tpss.report.gradients import inclination

from scenarios import limits, run

HILLS = {
    "line.gradients": [{"from_km": 0.0, "permille": 2.0}, {"from_km": 5.0, "permille": -1.0}],
    "traffic.0.headway_min": 10.0,
}


@pytest.fixture(scope="module")
def level():
    return run()


@pytest.fixture(scope="module")
def hilly():
    return run(HILLS)


def drawn(panel, k=0):
    """Horizontal and vertical values of a panel's k-th curve."""
    return (np.asarray(values, dtype=float) for values in panel.lines[k].get_data())


def test_a_journey_has_the_thesis_s_six_panels_above_one_axis(level):
    figure = journey({"level": level})
    labels = [panel.get_ylabel() for panel in figure.axes]
    assert labels == [
        "inclination [‰]", "speed [km/h]", "$P_D$ [MW]", "$Q_D$ [Mvar]", "$U$ [kV]", "$-\\theta$ [°]",
    ]  # fmt: skip
    assert figure.axes[-1].get_xlabel() == "position [km]"
    assert journey({"level": level}, against="time").axes[-1].get_xlabel() == "time [min]"


def test_a_journey_shows_the_studied_train_in_the_units_of_the_axes(level):
    data = level.dataset.sel(train="eastbound 1")
    panels = journey({"level": level}).axes
    for panel, values in zip(
        panels[1:],
        (
            data.speed * 3.6,
            data.active_power / 1e6,
            data.reactive_power / 1e6,
            data.pantograph_voltage / 1e3,
            -np.degrees(data.pantograph_angle),
        ),
        strict=True,
    ):
        x, y = drawn(panel)
        np.testing.assert_array_equal(x, data.position / 1e3)
        np.testing.assert_array_equal(y, values)


def test_another_train_can_be_chosen(hilly):
    x, _ = drawn(journey({"": hilly}, train="eastbound 2").axes[0])
    np.testing.assert_array_equal(x, hilly.dataset.position.sel(train="eastbound 2") / 1e3)


def test_runs_that_lie_upon_each_other_differ_by_colour_and_by_line(level, hilly):
    figure = journey({"level": level, "hilly": hilly})
    first, second = figure.axes[1].lines
    assert first.get_color() != second.get_color()
    assert first.get_linestyle() != second.get_linestyle()
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["level", "hilly"]


def test_one_run_needs_no_legend(level):
    assert not journey({"level": level}).legends


def test_the_inclination_holds_from_its_position_to_the_next_one_s(hilly):
    """2 ‰ up to 5 km, -1 ‰ from there; beyond the profile its ends go on; nowhere, none."""
    places = np.array([-1.0, 0.0, 4_999.9, 5_000.0, 30_000.0, np.nan])
    expected = [0.002, 0.002, 0.002, -0.001, -0.001, np.nan]
    np.testing.assert_array_equal(inclination(hilly.scenario.only_line, places), expected)


def test_the_voltage_is_drawn_over_the_way_and_feeding_points_are_marked(level):
    (panel,) = voltage_along_line({"level": level}).axes
    marks = [line for line in panel.lines if len(line.get_xdata()) == 2]
    assert [line.get_xdata()[0] for line in marks] == [0.0, 20.0]
    x, y = drawn(panel, len(marks))
    data = level.dataset.sel(train="eastbound 1")
    np.testing.assert_array_equal(x, data.position / 1e3)
    np.testing.assert_array_equal(y, data.pantograph_voltage / 1e3)


def test_limits_and_stations_stand_beside_the_voltage_if_asked(level):
    (panel,) = voltage_along_line({"level": level}, limits=True).axes
    words = {text.get_text() for text in panel.texts}
    assert words >= {"$U_{min2}$ 11", "$U_{min1}$ 12", "$U_{n}$ 15", "West", "East"}
    low, high = panel.get_ylim()
    assert low < 11.0 < 18.0 < high


def test_a_journey_is_explained_in_words_with_its_stations(level):
    panels = journey({"level": level}, explained=True).axes
    labels = [" ".join(panel.get_ylabel().split()) for panel in panels]
    assert labels == [
        "gradient [‰]", "speed; limit (dashed) [km/h]", "active power $P_D$ [MW]",
        "reactive power $Q_D$ [Mvar]", "voltage $U$ [kV]", "minus angle $-\\theta$ [°]",
    ]  # fmt: skip
    assert [text.get_text() for text in panels[0].texts] == ["West", "Middle", "East"]
    by_time = journey({"level": level}, against="time", explained=True).axes
    assert [text.get_text() for panel in by_time for text in panel.texts] == []


UP_THEN_DOWN = limits((0.0, 60.0), (5.0, 90.0), (12.0, 40.0), (15.0, 200.0))


@pytest.mark.parametrize(
    ("changes", "places", "speeds"),
    [
        (UP_THEN_DOWN, [0, 5, 12, 15, 20], [60, 90, 40, 135, 135]),
        ({**UP_THEN_DOWN, "trains.freight.length_m": 500.0},
         [0, 5.5, 12, 15.5, 20], [60, 90, 40, 135, 135]),
        ({**UP_THEN_DOWN, "traffic.0.from": "East", "traffic.0.to": "West"},
         [20, 15, 12, 5, 0], [135, 40, 90, 60, 60]),
    ],
    ids=["up", "with its length", "down"],
)  # fmt: skip
def test_the_limit_is_drawn_where_the_train_meets_it(changes, places, speeds):
    """It runs at most at 135 km/h, and its tail has to pass before a limit rises."""
    speed = journey({"": run(changes)}, explained=True).axes[1]
    x, y = drawn(speed, -1)
    np.testing.assert_allclose(x, places, atol=1e-6)
    np.testing.assert_allclose(y, speeds)


def test_stations_have_a_colour_each_and_runs_a_line_style(level, hilly):
    figure = station_powers({"level": level, "hilly": hilly})
    active, reactive = figure.axes
    names = [line.get_label() for line in active.lines]
    assert names == ["West, level", "East, level", "West, hilly", "East, hilly"]
    west, east, west_hilly, _ = active.lines
    assert west.get_color() == west_hilly.get_color() != east.get_color()
    assert west.get_linestyle() == east.get_linestyle() != west_hilly.get_linestyle()
    _, y = drawn(reactive, 1)
    np.testing.assert_array_equal(y, level.dataset.station_reactive_power.sel(station="East") / 1e6)


def test_the_loading_stands_above_the_number_of_converters(level):
    loading, running = station_loading(level).axes
    np.testing.assert_array_equal(
        list(drawn(loading, 1))[1], level.dataset.converter_loading.sel(station="East") * 100.0
    )
    np.testing.assert_array_equal(
        list(drawn(running, 0))[1], level.dataset.active_converters.sel(station="West")
    )


def test_a_figure_can_be_saved(level, tmp_path):
    journey({"level": level}).savefig(tmp_path / "journey.png")
    assert (tmp_path / "journey.png").read_bytes().startswith(b"\x89PNG")
