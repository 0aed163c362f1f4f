"""What a report says of a comparison with measurements, and what its drawings show."""

import numpy as np
import pytest

import tpss
from tpss.report.drawings.measured import measured_durations, measured_over_time
from tpss.report.figures import measured_durations as printed_durations
from tpss.report.figures import measured_over_time as printed_over_time
from tpss.report.html import report, write_report

from pages import Page


def test_the_page_has_the_plots_tables_and_notes(short, beside):
    page = Page(report(short, measured=beside))
    assert "measurements" in page.order
    assert {
        "Measured and simulated over time",
        "Duration curves",
        "Means, errors and energies",
        "Worst means over windows",
    } <= set(page.captions)
    assert "station_active_power:West MW" in page.text
    assert "-0.100" in page.text
    assert "1 empty cell in station_active_power:West [MW]" in page.text
    assert [each for each in page.loaded if not each.startswith("#")] == []


def test_a_page_without_measurements_does_not_speak_of_them(page):
    assert "measurements" not in Page(page).order


def test_measurements_belong_to_their_result(short, beside, tmp_path):
    with pytest.raises(tpss.ResultError, match="belong into the report of the result"):
        write_report({"a": short, "b": short}, tmp_path / "r.html", measured=beside)
    assert not (tmp_path / "r.html").exists()
    assert write_report(short, tmp_path / "r.html", measured=beside).is_file()


def test_curves_are_the_aligned_means_and_gaps_interrupt_them(beside):
    (panel,) = measured_over_time(beside).panels
    measured, simulated = panel.items
    assert panel.label == "West [MW]"
    np.testing.assert_array_equal(measured.y[:-1], beside.series[0].measured)
    np.testing.assert_array_equal(simulated.y[:-1], beside.series[0].simulated)
    np.testing.assert_allclose(np.diff(measured.x), 0.5)
    assert np.isnan(measured.y[4])
    assert np.isfinite(simulated.y[4])


def test_a_series_of_its_own_is_drawn_with_its_error(beside):
    value, error = measured_over_time(beside, "station_active_power:West").panels
    assert value.label == "active power [MW]"
    known = np.isfinite(error.items[1].y)
    np.testing.assert_allclose(error.items[1].y[known], -0.1, atol=1e-9)


def test_duration_curves_fall_over_the_time_that_is_compared(beside):
    (panel,) = measured_durations(beside).panels
    measured, simulated = panel.items
    np.testing.assert_allclose(measured.y, simulated.y + 0.1, atol=1e-9)
    assert (np.diff(measured.y) <= 0.0).all()
    assert measured.x[-1] == pytest.approx(beside.figures.compared_min[0])


def test_they_are_printed_as_figures_too(beside):
    for draw in (printed_over_time, printed_durations):
        figure = draw(beside, "station_active_power:West")
        labels = [line.get_label() for line in figure.axes[0].lines]
        assert labels[:2] == ["measured", "simulated"]
