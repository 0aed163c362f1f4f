"""What is drawn: extremes survive, and the voltage between trains is that of the line."""

import numpy as np
import pandas as pd
import pytest

from tpss.report.contact_line import line_voltage
from tpss.report.drawings.journey import journey
from tpss.report.drawings.stations import station_powers
from tpss.report.drawings.time_distance import colour_range
from tpss.report.render.interactive import render
from tpss.report.sampling import kept, sample_trains
from tpss.report.tables import of_frame

from scenarios import run


@pytest.mark.parametrize(
    ("kv", "lowest"),
    [([16.0, 16.4], 14.4), ([0.7, 0.8], 0.64), ([0.5, 0.8], 0.5), ([12.0, 16.0], 12.0)],
)
def test_a_scale_of_voltages_spans_two_kilovolts_or_a_fifth_of_low_ones(kv, lowest):
    assert colour_range(np.array(kv)) == pytest.approx((lowest, max(kv)))


def test_a_short_curve_stays_whole():
    assert kept((np.arange(5.0),), 5).tolist() == [0, 1, 2, 3, 4]


def test_a_thinned_curve_keeps_its_ends_and_every_peak():
    """A peak up and a dip down, one value each, among 100 000."""
    values = np.zeros(100_000)
    values[31_415], values[65_432] = 1.0, -1.0
    few = kept((values,), 500)
    assert len(few) <= 500
    assert {0, 31_415, 65_432, 99_999} <= set(few.tolist())


def test_each_column_keeps_its_own_peaks():
    first, second = np.zeros(10_000), np.zeros(10_000)
    first[123], second[4_567] = 1.0, 1.0
    assert {123, 4_567} <= set(kept((first, second), 100).tolist())


def test_what_is_not_recorded_is_no_extreme():
    values = np.full(1_000, np.nan)
    values[500] = -3.0
    assert 500 in kept((values,), 50)


def test_trains_are_sampled_at_every_step_of_a_short_run(short):
    samples = sample_trains(short.dataset)
    assert not samples.thinned
    first = samples.trains[0]
    position_m = short.dataset.position.sel(train=first["name"]).to_numpy()
    there = np.isfinite(position_m)
    np.testing.assert_allclose(first["km"], position_m[there] / 1e3, atol=5e-4)
    assert first["step"] == np.flatnonzero(there).tolist()


def test_the_envelope_holds_the_lowest_recorded_voltage(short):
    line = line_voltage(short.dataset)
    assert line.lowest_kv.min() == pytest.approx(short.summary["lowest_voltage"]["voltage_kv"])
    assert (line.lowest_kv <= line.mean_kv + 1e-12).all()
    assert (line.mean_kv <= line.highest_kv + 1e-12).all()


def test_between_two_stations_of_equal_voltage_without_trains_the_voltage_is_even():
    """No current flows, so the phasor is the same everywhere."""
    result = run({"traffic.0.first_departure_min": 50.0, "simulation.duration_min": 2.0})
    line = line_voltage(result.dataset)
    np.testing.assert_allclose(line.map_kv, 16.5, rtol=1e-6)


def test_a_run_without_a_step_has_no_voltage_along_the_line(collapsed):
    assert line_voltage(collapsed.dataset) is None


def test_curves_differ_in_colour_and_in_line_style(short):
    figure = render(station_powers({"": short}), 440)
    looks = {(trace.line.color, trace.line.dash) for trace in figure.data[:2]}
    assert len({colour for colour, _ in looks}) == len({dash for _, dash in looks}) == 2


def test_a_journey_shows_the_speed_that_was_recorded(short):
    speed = render(journey({"": short}, shown=["speed [km/h]"]), 560).data[0]
    assert max(speed.y) == pytest.approx(float(short.dataset.speed.max()) * 3.6, rel=1e-6)


def test_a_table_shows_units_few_digits_and_no_more_rows_than_it_says():
    table = of_frame("long", "Long", pd.DataFrame({"energy_mwh": np.arange(1_200) / 7.0}))
    assert table.headings == ["energy [MWh]"]
    assert len(table.rows) == 1_000
    assert table.caption == "Long (the first 1000 of 1200; the saved result has all)"
    assert (table.rows[1][0].text, table.rows[1][0].value) == ("0.143", "0.1428571")


def test_what_is_missing_in_a_table_is_a_dash():
    table = of_frame("gap", "Gap", pd.DataFrame({"arrival_min": [np.nan]}))
    assert (table.rows[0][0].text, table.rows[0][0].value) == ("–", "")
