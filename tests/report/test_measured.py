"""What a report says of a comparison with measurements, and what its drawings show."""

import numpy as np
import pytest

import tpss
from tpss.report.drawings.measured import measured_durations, measured_over_time
from tpss.report.figures import measured_durations as printed_durations
from tpss.report.figures import measured_over_time as printed_over_time
from tpss.report.html import report, write_report

from measured_files import in_minutes
from pages import Page


@pytest.fixture(scope="module")
def compared(short, tmp_path_factory):
    """The short line beside its own power of West and 0.1 MW more, with a gap, over half minutes."""
    watts = short.dataset.station_active_power.sel(station="West").to_numpy()[:-1]
    whole = watts[: len(watts) // 10 * 10]
    values = whole.reshape(-1, 10).mean(axis=1) / 1e6 + 0.1
    cells = values.tolist()
    cells[4] = None
    path = tmp_path_factory.mktemp("measured") / "measured.csv"
    path.write_text(in_minutes({"station_active_power:West [MW]": cells}, step=0.5), "utf-8")
    return tpss.compare_with_measurements(short, path)


def test_the_page_has_the_plots_tables_and_notes(short, compared):
    page = Page(report(short, measured=compared))
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


def test_measurements_belong_to_their_result(short, compared, tmp_path):
    with pytest.raises(tpss.ResultError, match="belong into the report of the result"):
        write_report({"a": short, "b": short}, tmp_path / "r.html", measured=compared)
    assert not (tmp_path / "r.html").exists()
    assert write_report(short, tmp_path / "r.html", measured=compared).is_file()


def test_curves_are_the_aligned_means_and_gaps_interrupt_them(compared):
    (panel,) = measured_over_time(compared).panels
    measured, simulated = panel.items
    assert panel.label == "West [MW]"
    np.testing.assert_array_equal(measured.y[:-1], compared.series[0].measured)
    np.testing.assert_array_equal(simulated.y[:-1], compared.series[0].simulated)
    np.testing.assert_allclose(np.diff(measured.x), 0.5)
    assert np.isnan(measured.y[4])
    assert np.isfinite(simulated.y[4])


def test_a_series_of_its_own_is_drawn_with_its_error(compared):
    value, error = measured_over_time(compared, "station_active_power:West").panels
    assert value.label == "active power [MW]"
    known = np.isfinite(error.items[1].y)
    np.testing.assert_allclose(error.items[1].y[known], -0.1, atol=1e-9)


def test_duration_curves_fall_over_the_time_that_is_compared(compared):
    (panel,) = measured_durations(compared).panels
    measured, simulated = panel.items
    np.testing.assert_allclose(measured.y, simulated.y + 0.1, atol=1e-9)
    assert (np.diff(measured.y) <= 0.0).all()
    assert measured.x[-1] == pytest.approx(compared.figures.compared_min[0])


def test_they_are_printed_as_figures_too(compared):
    for draw in (printed_over_time, printed_durations):
        figure = draw(compared, "station_active_power:West")
        labels = [line.get_label() for line in figure.axes[0].lines]
        assert labels[:2] == ["measured", "simulated"]
