"""A drawing is described once, and both the print and the page show all of it."""

import numpy as np
import pytest

from tpss.report.contact_line import line_voltage
from tpss.report.drawings.losses import losses
from tpss.report.drawings.parts import Bar, Curve, Drawing, Mark, Panel
from tpss.report.drawings.time_distance import time_distance
from tpss.report.drawings.voltage import envelopes
from tpss.report.figures import FIGURES
from tpss.report.render import interactive, static

from scenarios import run


def counted(drawing: Drawing) -> int:
    """Number of items other than marks."""
    return sum(not isinstance(item, Mark) for panel in drawing.panels for item in panel.items)


GRID = {
    "name": "Grid", "position_km": 15.0, "no_load_voltage_kv": 16.0, "grid_kv": 132.0,
    "grid_short_circuit_mva": 800.0, "phases": "RS",
    "transformer": {"rated_mva": 10.0, "short_circuit_percent": 8.0},
}  # fmt: skip


@pytest.fixture(scope="module")
def described():
    """The short line with converters that say what they lose, a rated catenary, trains with stores."""
    rating = {"continuous_a": 467.0, "time_constant_min": 4.7}
    store = {"kind": "battery", "capacity_kwh": 50.0, "power_kw": 500.0, "efficiency": 0.9}
    return run(
        {
            "traffic.0.headway_min": 10.0,
            "supply.converter_stations.*.type": "Q48/Q49 with losses (estimate)",
            "supply.catenary": {"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.2, "rating": rating},
            "supply.transformer_stations": [GRID],
            "trains.freight.storage": store,
            "simulation.motion": None,
            "simulation.braking": None,
        }
    )


@pytest.mark.parametrize("name", [name for name in FIGURES if name != "rails"])
def test_every_figure_for_print_is_drawn_for_a_page_too(described, name):
    shown = {"": described} if FIGURES[name].overlaid else described
    drawing = FIGURES[name].describe(shown, "eastbound 1", "distance")
    figure = interactive.render(drawing, 400)
    assert len(figure.data) == counted(drawing)
    assert figure.layout.meta in ("time", "position", "speed", "energy")
    assert figure.to_json()


def test_every_plot_of_a_page_is_drawn_for_print_too(short):
    voltage = line_voltage(short.dataset)
    for drawing in (
        losses({"": short}),
        envelopes({"": (short, voltage)}, with_trains=True),
        time_distance(short, voltage),
    ):
        (panel,) = drawing.panels
        figure = static.render(drawing)
        figure.draw_without_rendering()
        assert figure.axes[0].get_ylabel() == panel.label


def test_a_mark_does_not_widen_its_axis_and_is_named_where_it_has_words():
    """A rating of 100 far above a load of 1, and one with words."""
    curve = Curve(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    drawing = Drawing("time [min]", [Panel("load [%]", [curve, Mark(100.0), Mark(0.5, "half")])])
    (axes,) = static.render(drawing).axes
    assert axes.get_ylim()[1] < 2.0
    layout = interactive.render(drawing, 300).layout
    assert [shape.y0 for shape in layout.shapes] == [100.0, 0.5]
    assert [note.text for note in layout.annotations] == ["half"]


def test_a_long_curve_of_many_pieces_keeps_the_gaps_between_them():
    """Three pieces of 30 000 points: about a third of the budget each, a peak in the last one."""
    y = np.zeros(90_002)
    y[[30_000, 60_001]] = np.nan
    y[70_000] = 5.0
    curve = Curve(np.arange(90_002.0), y)
    (drawn,) = interactive.render(Drawing("time [min]", [Panel("", [curve])]), 300).data
    assert len(drawn.x) < 7_000
    assert np.flatnonzero(np.isnan(drawn.y)).size == 2
    assert np.nanmax(drawn.y) == 5.0


def test_the_legend_is_that_of_the_first_panel(short):
    figure = interactive.render(FIGURES["stations"].describe({"": short}, None, "distance"), 440)
    assert [trace.name for trace in figure.data if trace.showlegend] == ["West", "East"]


def test_an_area_of_colours_and_a_bar_hold_what_was_described(short):
    voltage = line_voltage(short.dataset)
    area = interactive.render(time_distance(short, voltage), 520).data[0]
    np.testing.assert_allclose(area.z, voltage.map_kv, rtol=1e-6)
    bars = FIGURES["energy"].describe(short, None, "distance").panels[0].items
    assert all(isinstance(bar, Bar) for bar in bars)
    figure = interactive.render(FIGURES["energy"].describe(short, None, "distance"), 400)
    ends = [trace.base[0] + trace.x[0] for trace in figure.data]
    assert ends == pytest.approx([bar.start + bar.length for bar in bars])


def test_wide_numbers_of_a_vertical_axis_have_room():
    """Of every panel: 12,500 is wider than the margin that all figures have."""
    curve = Curve(np.array([0.0, 1.0]), np.array([0.0, 12500.0]))
    panels = [Panel("power [kW]", [curve]), Panel("power [kW]", [curve])]
    shown = interactive.render(Drawing("time [min]", panels), 400)
    assert [axis.automargin for axis in shown.select_yaxes()] == [True, True]
