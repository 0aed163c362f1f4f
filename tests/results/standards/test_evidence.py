"""Evidence of real runs: the thesis's main line, and the AT line with a train every 3 minutes."""

import numpy as np
import pytest

from tpss import load_result, load_scenario, simulate

from conftest import EXAMPLES
from scenarios import run


@pytest.fixture(scope="module")
def main_line():
    return simulate(load_scenario(EXAMPLES / "thesis_160km.toml"))


@pytest.fixture(scope="module")
def at_line():
    return simulate(load_scenario(EXAMPLES / "at_headway_3.toml"))


@pytest.fixture(scope="module")
def at_high_voltage():
    changes = {"simulation.duration_min": 6.0}
    return simulate(load_scenario(EXAMPLES / "at_hv_headway_3.toml", changes))


@pytest.fixture(scope="module")
def low():
    """A line that is too weak for its trains: 60 km from one end, a train every 20 minutes."""
    return run(
        {
            "line.length_km": 60.0,
            "line.stations.2.position_km": 60.0,
            "line.speed_limits.0.speed_kmh": 80.0,
            "supply.converter_stations": [
                {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 3}
            ],
            "traffic.0.headway_min": 12.0,
        }
    )


def contact_line_losses_mwh(result):
    """R I² piece by piece between neighbouring trains and nodes, in plain loops.

    At one place a node comes before a train, but the line's last node after it.
    """
    dataset, catenary = result.dataset, result.scenario.supply.catenary
    impedance = complex(catenary.r_ohm_per_km, catenary.x_ohm_per_km) / 1e3
    on_line = (dataset.node_kind == "contact line").to_numpy()
    node_m = dataset.node_position.to_numpy()[on_line]
    node_v = (dataset.node_voltage * np.exp(1j * dataset.node_angle)).to_numpy()[:, on_line]
    train_m = dataset.position.to_numpy()
    train_v = (dataset.pantograph_voltage * np.exp(1j * dataset.pantograph_angle)).to_numpy()
    losses_j, duration_s = 0.0, np.diff(dataset.time.to_numpy())
    for k in range(dataset.sizes["time"] - 1):
        nodes = list(zip(node_m, node_v[k], strict=True))
        trains = [(m, v) for m, v in zip(train_m[k], train_v[k], strict=True) if np.isfinite(v)]
        points = sorted([*nodes[:-1], *trains, nodes[-1]], key=lambda point: point[0])
        for (begin_m, begin_v), (end_m, end_v) in zip(points, points[1:], strict=False):
            piece = impedance * max(1.0, end_m - begin_m)
            losses_j += abs((begin_v - end_v) / piece) ** 2 * piece.real * duration_s[k]
    return losses_j / 3.6e9


@pytest.mark.parametrize("name", ["main_line", "at_line", "at_high_voltage"])
def test_the_parts_of_the_losses_sum_up_to_all_of_them(request, name):
    """The contact line's share is checked against its own currents, the sum against the recorded."""
    result = request.getfixturevalue(name)
    losses = result.standards.losses.set_index("branch_kind").energy_mwh
    assert losses["contact line"] == pytest.approx(contact_line_losses_mwh(result), rel=1e-9)
    assert losses.sum() == pytest.approx(result.summary["losses_mwh"], rel=1e-12)
    assert (losses > 0.0).all()
    assert result.summary["standards"]["losses_mwh"] == losses.to_dict()


def test_only_what_the_network_has_loses_energy(main_line, at_line, at_high_voltage):
    kinds = [set(r.standards.losses.branch_kind) for r in (main_line, at_line, at_high_voltage)]
    assert kinds == [
        {"contact line", "transformer", "high-voltage line"},
        {"contact line", "connection"},
        {"contact line", "connection", "transformer", "high-voltage line"},
    ]


def test_a_sound_line_is_within_the_limits(main_line):
    """The lowest voltage of the run is 14.571 kV; no train is below 12 kV."""
    evidence = main_line.standards
    assert set(evidence.voltage.verdict) == {"within the limits"}
    assert evidence.voltage.lowest_kv.min() == main_line.summary["lowest_voltage"]["voltage_kv"]
    assert evidence.excursions.empty
    assert evidence.violations.empty
    assert evidence.notes == []


def test_mean_useful_voltage_is_that_of_all_recorded_voltages(main_line):
    """There is one feeding section, so its mean is that of the whole dataset."""
    zones = main_line.standards.useful_voltage_zones
    assert zones.zone.tolist() == ["West-East"]
    mean_kv = float(np.nanmean(main_line.dataset.pantograph_voltage)) / 1e3
    assert zones.mean_useful_kv[0] == pytest.approx(mean_kv)
    assert zones.minimum_kv[0] == 13.5


def test_the_dimensioning_train_has_the_lowest_mean_in_traction(at_line):
    voltage, force = at_line.dataset.pantograph_voltage, at_line.dataset.tractive_force
    means = voltage.where(force > 0.0).mean("time")
    present = voltage.notnull().sum("time") * at_line.dataset.attrs["time_step_s"] >= 60.0
    lowest = means.where(present).idxmin("train")
    assert at_line.standards.dimensioning_train == str(lowest.to_numpy())


def test_energies_of_trains_are_those_of_the_trips(main_line):
    energy, trips = main_line.standards.energy, main_line.trips
    assert energy.consumed_mwh.tolist() == pytest.approx(trips.energy_mwh.tolist())
    assert (energy.regenerated_mwh == 0.0).all()
    assert (energy.mass_t == 1470.0).all()


def test_blocks_sum_up_to_the_energy_of_the_run(main_line):
    blocks = main_line.standards.energy_blocks
    assert blocks.to_min.max() == main_line.summary["duration_min"]
    assert blocks.consumed_mwh.sum() == pytest.approx(main_line.trips.energy_mwh.sum())


def test_the_highest_mean_of_a_step_is_the_peak(main_line):
    table = main_line.standards.station_power
    assert table.window_min.unique().tolist() == [0.5, 1.0, 3.0, 15.0, 60.0]
    peaks = table[table.window_min == 0.5].highest_mean_mw.tolist()
    assert peaks == pytest.approx(main_line.stations.peak_power_mw.tolist(), rel=1e-12)
    falls = table.pivot(index="station", columns="window_min", values="highest_mean_mw")
    assert (np.diff(falls.to_numpy(), axis=1) <= 1e-12).all()


def test_the_area_below_the_load_duration_curve_is_the_energy(main_line):
    table = main_line.standards.load_duration
    lasts_min = table.groupby("station", sort=False).duration_min.diff()
    lasts_min = lasts_min.fillna(table.duration_min)
    energies = (table.power_mw * lasts_min / 60.0).groupby(table.station, sort=False).sum()
    assert energies.to_dict() == pytest.approx(main_line.summary["station_energy_mwh"])


def test_transformers_and_lines_have_currents_over_windows(main_line):
    table = main_line.standards.branch_current
    peaks = table[table.window_min == 0.5].set_index("branch").highest_rms_a
    recorded = main_line.dataset.branch_current.max("time").to_series()
    assert peaks.to_dict() == pytest.approx(recorded.to_dict())


def test_a_weak_line_has_violations_that_name_train_and_place(low):
    evidence, figures = low.standards, low.summary["standards"]
    worst = evidence.violations.iloc[0]
    assert (worst.standard, worst.rule) == ("EN 50163", "below Umin2")
    lowest = low.summary["lowest_voltage"]
    assert worst.subject == f"train {lowest['train']}"
    assert (worst.value_kv, worst.position_km) == (lowest["voltage_kv"], lowest["position_km"])
    assert figures["worst_violations"][0] == worst.words
    assert figures["violations"] == len(evidence.violations)
    assert figures["voltage"]["trains_below_umin2"] >= 1


def test_windows_longer_than_the_run_are_told(at_high_voltage):
    (note,) = at_high_voltage.standards.notes
    assert note == "Windows of 15, 60 min are longer than the run (6 min): their means are NaN"
    powers = at_high_voltage.summary["standards"]["station_power_mw"]["West"]
    assert powers["3 min"] > 0.0
    assert powers["15 min"] is None


def test_a_run_is_judged_otherwise_without_running_again(main_line):
    strict = main_line.with_standards(
        {
            "voltage_limits.umin1_kv": 14.9,
            "voltage_limits.umin2_kv": 14.6,
            "peak_from_min": 30.0,
            "peak_to_min": 90.0,
            "zones": [{"name": "middle", "from_km": 60.0, "to_km": 100.0}],
        }
    )
    assert len(strict.standards.violations) > 10
    assert strict.standards.useful_voltage_zones.zone.tolist() == ["middle"]
    assert strict.summary["standards"]["violations"] == len(strict.standards.violations)
    assert main_line.summary["standards"]["violations"] == 0
    voltage, position = main_line.dataset.pantograph_voltage, main_line.dataset.position
    inside = (position >= 60e3) & (position < 100e3)
    time = main_line.dataset.time / 60.0
    chosen = voltage.where(inside & (time >= 30.0) & (time < 90.0))
    mean_kv = float(chosen.mean()) / 1e3
    assert strict.standards.useful_voltage_zones.mean_useful_kv[0] == pytest.approx(mean_kv)


def test_a_fast_line_has_the_higher_minimum(main_line):
    fast = run({"line.speed_limits.0.speed_kmh": 210.0, "simulation.duration_min": 1.0})
    assert fast.standards.least_useful_voltage_kv == 14.2
    assert main_line.standards.least_useful_voltage_kv == 13.5


def test_a_peak_window_beyond_the_run_is_told(main_line):
    late = main_line.with_standards({"peak_from_min": 60.0, "peak_to_min": 120.0})
    assert late.summary["standards"]["mean_useful_voltage"]["zones_kv"] == {"West-East": None}
    (note,) = late.standards.notes
    assert note.startswith("The peak window of 60 min to 120 min is not within the run (99.19 min)")


def test_a_run_that_ended_early_says_so():
    result = simulate(load_scenario(EXAMPLES / "overloaded.toml"))
    assert result.standards.notes[-1].startswith("The run ended early")
    assert result.standards.dimensioning_train is None
    for name in ("voltage", "energy", "energy_blocks", "station_power", "load_duration"):
        getattr(result.standards, name)


def test_an_idle_line_has_evidence_too():
    changes = {"simulation.duration_min": 5.0, "traffic.0.first_departure_min": 30.0}
    evidence = run({"supply.catenary": "AT", **changes}).standards
    for name in ("voltage", "useful_voltage_trains", "energy", "energy_blocks", "violations"):
        assert getattr(evidence, name).empty, name
    assert evidence.useful_voltage_zones.mean_useful_kv.isna().all()


def test_a_loaded_result_has_the_same_evidence(main_line, tmp_path):
    again = load_result(main_line.save(tmp_path / "result"))
    assert again.standards.as_dict() == main_line.summary["standards"]
    assert again.standards.branch_current.equals(main_line.standards.branch_current)
