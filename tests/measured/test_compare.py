"""A result compared with measurements, by hand calculations on a run of ten minutes.

West feeds 0, 2, 4, 6, 3, 1, 5, 2, 0 and 1 MW: a mean of 2.4 MW, 24 MW min = 0.4 MWh.
"""

import json
import math

import numpy as np
import pytest

import tpss

from measured_files import EAST_MW, WEST_MW, in_minutes, made_up_result
from scenarios import run, short_line

nan = float("nan")
WEST, EAST = "station_active_power:West [MW]", "station_active_power:East [kW]"


def compare(result, path, **options):
    return tpss.compare_with_measurements(result, path, **options)


def only(comparison):
    (figures,) = comparison.figures.to_dict("records")
    return figures


def test_a_result_against_itself_has_no_error_and_no_offset(file):
    """A real run, its own values written with all digits."""
    result = run({"simulation.time_step_min": 0.5})
    data = result.dataset
    columns = {f"station_active_power:{name} [W]": data.station_active_power.sel(station=name)
               .to_numpy()[:-1].tolist() for name in ("West", "East")}  # fmt: skip
    columns["pantograph_voltage:eastbound 1 [V]"] = [
        None if math.isnan(each) else each
        for each in data.pantograph_voltage.sel(train="eastbound 1").to_numpy()[:-1].tolist()
    ]
    path = file(in_minutes(columns, step=0.5))
    found = compare(result, path, find_offset_min=3.0)
    assert found.offset.seconds == 0.0
    for name in ("bias", "bias_low", "bias_high", "rms_error", "error_5", "error_95"):
        np.testing.assert_allclose(found.figures[name], 0.0, atol=1e-9)
    energy_mwh = result.stations.energy_mwh.to_numpy()
    left_min = found.figures.left_out_min.to_numpy()
    assert left_min[:2].tolist() == [0.0, 0.0]
    last_s = data.attrs["last_step_s"]  # a last step that ends with an arrival is no whole interval
    lacking = 0.0 if last_s == 30.0 else data.station_active_power.to_numpy()[-2] * last_s / 3.6e9
    np.testing.assert_allclose(found.figures.measured_energy[:2], energy_mwh - lacking, rtol=1e-9)


def test_figures_are_those_of_the_hand_calculation(result, file):
    """Errors of -0.5 and +1 MW in two of ten minutes: bias 0.05 MW, RMS √(1.25 / 10) = 0.3536 MW.

    Sorted, the errors are -0.5, eight times 0 and 1: of the nine steps between them 5 % is 0.45 steps
    up from -0.5, at -0.275 MW, and 95 % is 0.45 steps down from 1, at 0.55 MW.
    """
    measured = list(WEST_MW)
    measured[3] += 0.5
    measured[4] -= 1.0
    found = only(compare(result, file(in_minutes({WEST: measured}))))
    assert found["measured_mean"] == pytest.approx(2.35)
    assert found["simulated_mean"] == pytest.approx(2.4)
    assert found["bias"] == pytest.approx(0.05)
    assert found["bias_percent"] == pytest.approx(100.0 * 0.05 / 2.35)
    assert found["rms_error"] == pytest.approx(math.sqrt(0.125))
    assert (found["error_5"], found["error_95"]) == (pytest.approx(-0.275), pytest.approx(0.55))
    assert found["measured_energy"] == pytest.approx(23.5 / 60.0)
    assert found["simulated_energy"] == pytest.approx(0.4)
    assert (found["unit"], found["energy_unit"]) == ("MW", "MWh")


def test_a_constant_bias_is_found_exactly_and_lies_in_its_interval(result, file):
    path = file(in_minutes({WEST: [each - 0.25 for each in WEST_MW]}))
    found = only(compare(result, path))
    assert found["bias"] == 0.25
    assert found["bias_low"] <= 0.25 <= found["bias_high"]
    assert found["rms_error"] == found["error_5"] == found["error_95"] == 0.25


def test_units_and_signs_are_converted_once(result, file):
    measured = {WEST: WEST_MW, EAST: [1e3 * each for each in EAST_MW]}
    found = compare(result, file(in_minutes(measured))).figures
    np.testing.assert_allclose(found.bias, 0.0, atol=1e-12)
    assert found.unit.tolist() == ["MW", "MW"]


def test_means_over_longer_steps_of_the_file(result, file):
    """Two minutes: West (0 + 2) / 2 = 1, 5, 2, 3.5 and 0.5 MW."""
    found = compare(result, file(in_minutes({WEST: [1.0, 5.0, 2.0, 3.5, 0.5]}, step=2.0)))
    assert found.grid.step_s == 120.0
    np.testing.assert_allclose(found.series[0].simulated, [1.0, 5.0, 2.0, 3.5, 0.5])
    assert only(found)["rms_error"] == pytest.approx(0.0, abs=1e-12)


def test_means_over_shorter_steps_of_the_file(result, file):
    """Half minutes, of which those of the third minute are 3 and 5 MW, so 4."""
    halves = np.repeat(WEST_MW, 2)
    halves[4:6] = [3.0, 5.0]
    found = compare(result, file(in_minutes({WEST: halves.tolist()}, step=0.5)))
    assert found.grid.step_s == 60.0
    np.testing.assert_allclose(found.series[0].measured, WEST_MW)


def test_intervals_of_ones_own_begin_with_the_longer_step_of_both(result, file):
    path = file(in_minutes({WEST: [1.0, 5.0, 2.0, 3.5, 0.5]}, step=2.0))
    found = compare(result, path, step_min=4.0)
    np.testing.assert_allclose(found.series[0].measured, [3.0, 2.75])
    np.testing.assert_allclose(found.series[0].simulated, [3.0, 2.75])


def test_stamps_at_the_ends_of_intervals_are_a_step_earlier(result, file):
    path = file(in_minutes({WEST: WEST_MW}, first=1.0))
    assert only(compare(result, path, stamps="end"))["rms_error"] == pytest.approx(0.0, abs=1e-12)
    assert only(compare(result, path))["rms_error"] > 1.0


def test_empty_cells_stay_gaps_and_are_told(result, file):
    """Minutes 3 and 4 are not known, 6 and 3 MW: 15 MW min are left in eight minutes."""
    measured = [*WEST_MW[:3], None, None, *WEST_MW[5:]]
    found = compare(result, file(in_minutes({WEST: measured})))
    figures = only(found)
    assert (figures["compared_min"], figures["left_out_min"]) == (8.0, 2.0)
    assert figures["simulated_energy"] == pytest.approx(15.0 / 60.0)
    assert any("2 empty cells in station_active_power:West [MW]" in note for note in found.notes)
    assert any("2 of 10 intervals are left out" in note for note in found.notes)
    assert np.isnan(found.aligned.iloc[3, 1])


def test_jumps_in_time_stay_gaps_and_are_told(result, file):
    lines = in_minutes({WEST: WEST_MW}).splitlines()
    found = compare(result, file("\n".join([*lines[:4], *lines[6:]])))
    assert only(found)["compared_min"] == 8.0
    assert any("1 jump in time, 2.00 min in all" in note for note in found.notes)


def test_an_interval_that_a_gap_touches_is_left_out_as_a_whole(result, file):
    measured = [*WEST_MW[:3], None, *WEST_MW[4:]]
    found = compare(result, file(in_minutes({WEST: measured})), step_min=2.0)
    assert found.series[0].compared == 4
    assert np.isnan(found.series[0].measured[1])
    assert found.series[0].simulated[1] == 5.0


def test_only_the_time_that_both_share_is_compared(result, file):
    """The file goes on from minute 6 to minute 20: 5, 2, 0 and 1 MW are shared."""
    found = compare(result, file(in_minutes({WEST: [5.0, 2.0, 0.0, 1.0, *[9.0] * 10]}, first=6.0)))
    assert found.aligned.from_min.tolist() == [6.0, 7.0, 8.0, 9.0]
    assert only(found)["rms_error"] == pytest.approx(0.0, abs=1e-12)


def test_windows_are_the_highest_of_powers_and_the_lowest_of_voltages(file):
    """Highest means of West over 1 and 5 min: 6 MW and (4 + 6 + 3 + 1 + 5) / 5 = 3.8 MW from minute 2.

    The lowest voltage in a minute is 13 kV in minute 4.
    """
    kv = [15.0, 15.0, 14.0, 14.0, 13.0, 14.0, 15.0, 15.0, 15.0, 15.0]
    result = made_up_result(station_mw={"West": WEST_MW, "East": EAST_MW}, voltage_kv={"up 1": kv})
    measured = {WEST: WEST_MW, "pantograph_voltage:up 1 [kV]": kv}
    windows = compare(result, file(in_minutes(measured))).windows
    west = windows[windows.series == "station_active_power:West"].set_index("window_min")
    assert west.measured[1.0] == pytest.approx(6.0)
    assert west.simulated[5.0] == pytest.approx(3.8)
    assert west.simulated_from_min[5.0] == 2.0
    assert math.isnan(west.measured[15.0])  # longer than the run
    volts = windows[windows.series == "pantograph_voltage:up 1"].set_index("window_min")
    assert (volts.which[1.0], volts.measured[1.0], volts.measured_from_min[1.0]) == (
        "lowest", 13.0, 4.0,
    )  # fmt: skip


def test_no_window_goes_over_a_gap(result, file):
    """Minute 4 is not known: five minutes are left behind it, (1 + 5 + 2 + 0 + 1) / 5 = 1.8 MW."""
    measured = [*WEST_MW[:4], None, *WEST_MW[5:]]
    windows = compare(result, file(in_minutes({WEST: measured}))).windows.set_index("window_min")
    assert windows.measured[5.0] == pytest.approx(1.8)
    assert windows.measured_from_min[5.0] == 5.0


def test_duration_curves_fall_from_the_highest_value(result, file):
    durations = compare(result, file(in_minutes({WEST: WEST_MW[::-1]}))).durations
    assert durations.measured.tolist() == durations.simulated.tolist() == sorted(WEST_MW)[::-1]
    assert durations.duration_min.tolist() == [float(k) for k in range(1, 11)]


def test_trains_that_are_not_there_are_gaps_of_the_run(file):
    mw = [nan, nan, 2.0, 2.0, 2.0, 2.0, 2.0, nan, nan, nan]
    result = made_up_result(power_mw={"up 1": mw})
    found = compare(result, file(in_minutes({"active_power:up 1 [MW]": [2.0] * 10})))
    assert only(found)["compared_min"] == 5.0
    assert any("in 5 nothing is simulated" in note for note in found.notes)


def test_the_voltage_of_a_station_is_that_of_its_contact_line(file):
    result = run({"simulation.time_step_min": 0.5})
    volts = result.dataset.node_voltage.sel(node="contact line at 20 km").to_numpy()[:-1].tolist()
    path = file(in_minutes({"station_voltage:East [V]": volts}, step=0.5))
    assert only(compare(result, path))["rms_error"] == pytest.approx(0.0, abs=1e-9)


def test_tables_and_their_origin_are_saved_all_or_none(result, file, tmp_path):
    found = compare(result, file(in_minutes({WEST: WEST_MW})), find_offset_min=2.0)
    files = found.save(tmp_path / "compared")
    assert [each.name for each in files] == [
        "aligned.csv", "figures.csv", "windows.csv", "durations.csv", "comparison.json",
    ]  # fmt: skip
    text = (tmp_path / "compared" / "aligned.csv").read_text("utf-8")
    assert text.startswith("from_min,station_active_power:West measured [MW],")
    how = json.loads((tmp_path / "compared" / "comparison.json").read_text("utf-8"))
    assert how["file"] == "measured.csv"
    assert how["offset"]["seconds"] == 0.0
    with pytest.raises(tpss.ResultError, match="--force"):
        found.save(tmp_path / "compared")


def test_a_result_whose_audit_failed_is_not_compared(result, file):
    result.figures["audit"] |= {"passed": False, "failures": ["power_mismatch_va is 3"]}
    with pytest.raises(tpss.ResultError, match="power_mismatch_va is 3"):
        compare(result, file(in_minutes({WEST: WEST_MW})))


@pytest.mark.parametrize("option", ["find_offset_min", "step_min"])
@pytest.mark.parametrize("value", [0.0, -1.0, nan])
def test_lengths_of_time_are_positive(result, file, option, value):
    with pytest.raises(tpss.ResultError, match=option):
        compare(result, file(in_minutes({WEST: WEST_MW})), **{option: value})


def test_intervals_that_are_shorter_than_a_step_are_refused(result, file):
    """Highest means over a minute of values of two would look like more than they are."""
    path = file(in_minutes({WEST: [1.0, 5.0, 2.0, 3.5, 0.5]}, step=2.0))
    with pytest.raises(tpss.ResultError, match="shorter than the steps of the file, of 2 min"):
        compare(result, path, step_min=1.0)
    with pytest.raises(tpss.ResultError, match="less than a step of 60 s"):
        compare(result, path, find_offset_min=0.5)


def test_stamps_are_at_the_beginning_or_at_the_end(result, file):
    with pytest.raises(tpss.ResultError, match="choose from begin, end"):
        compare(result, file(in_minutes({WEST: WEST_MW})), stamps="middle")


def test_a_clock_that_is_wrong_is_found_in_a_finer_run_with_noise(file):
    """Made, not measured: steps of 3 s with noise, by a clock that is 17.3 s ahead; the run has 30 s."""
    fine = tpss.simulate(short_line({"simulation.time_step_min": 0.05}))
    result = tpss.simulate(short_line({"simulation.time_step_min": 0.5}))
    times = fine.dataset.time.to_numpy()[:-1] + 17.3
    noise = np.random.default_rng(0).normal(scale=0.05, size=len(times))
    mw = fine.dataset.station_active_power.sel(station="West").to_numpy()[:-1] / 1e6 + noise
    lines = [f"{at:.3f};{value:.4f}" for at, value in zip(times, mw, strict=True)]
    path = file("\n".join([f"time [s];{WEST}", *lines]))
    found = compare(result, path, find_offset_min=2.0)
    assert found.offset.seconds == pytest.approx(17.3, abs=3.0)
    assert only(found)["rms_error"] < 0.5 * only(compare(result, path))["rms_error"]
