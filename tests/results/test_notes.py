"""Notes after a run: loads that no equipment stands, and power that circulates."""

import numpy as np
import pytest

import tpss
from tpss.results.notes import notes

from scenarios import short_line

HEAVY = {
    "mass_t": 600.0, "adhesive_mass_t": 600.0, "resistance_a_n": 1000.0,
    "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 5.0, "max_speed_kmh": 160.0,
    "max_retardation_m_s2": 0.8, "auxiliary_power_kw": 0.0, "power_factor": 0.9, "efficiency": 1.0,
    "tractive_effort": {"max_force_kn": 600.0, "max_power_kw": 12_000.0},
}  # fmt: skip


def heavy_trains(converters: int, departures_min=(0.0, 0.5, 1.0)) -> tpss.Result:
    """Trains of up to 12 MW that start from one station of converters of 10 MVA."""
    station = {"name": "W", "position_km": 0.0, "type": "Q48/Q49", "converters": converters}
    return tpss.simulate(
        short_line(
            {
                "simulation.duration_min": 10.0,
                "line.speed_limits.0.speed_kmh": 160.0,
                "supply.catenary": "AT",
                "supply.converter_stations": [station],
                "trains.freight": HEAVY,
                "traffic.0.headway_min": None,
                "traffic.0.departures_min": list(departures_min),
            }
        )
    )


def test_a_station_above_its_rating_is_noted_with_how_far_how_long_and_when():
    result = heavy_trains(1)
    loading = result.dataset.converter_loading.to_numpy()[:-1, 0]
    (note,) = [each for each in notes(result) if "rating" in each]
    worst = int(loading.argmax())
    assert note.startswith(f"W was loaded to {100 * loading.max():.0f} % of its rating (")
    assert f"MVA at {worst * 0.05:.2f} min)" in note
    assert f"above 100 % for {(loading > 1).sum() * 0.05:.2f} min between" in note
    assert 2.5 < loading.max() < 3.5


def test_a_station_within_its_rating_is_not_noted():
    assert not any("rating" in note for note in notes(heavy_trains(10)))


@pytest.mark.parametrize(("angle_deg", "told"), [(0.0, False), (10.0, True)])
def test_power_that_circulates_is_noted(angle_deg, told):
    """At 10 degrees between their grids one station feeds the other, whatever the train takes."""
    result = tpss.simulate(short_line({"supply.converter_stations.1.grid_angle_deg": angle_deg}))
    said = [
        note for note in notes(result) if note.startswith("power circulates between the stations")
    ]
    assert bool(said) == told
    if told:
        power_mw = result.dataset.station_active_power.to_numpy()[:-1] / 1e6
        back_mwh = -power_mw[power_mw < 0.0].sum() * 0.05 / 60.0
        assert f"West received up to {-power_mw.min():.1f} MW" in said[0]
        assert f"and {back_mwh:.3f} MWh went from station to station" in said[0]
        assert f"took {power_mw.sum() * 0.05 / 60.0:.3f} MWh" in said[0]


def with_table(**table) -> tpss.Result:
    """A light train by a table on a short line of 160 km/h; the line idles at 16.5 kV."""
    changes = {
        "line.speed_limits.0.speed_kmh": 160.0,
        "trains.freight": {
            **HEAVY, "mass_t": 100.0, "adhesive_mass_t": 100.0, "tractive_effort": table,
        },
    }  # fmt: skip
    return tpss.simulate(short_line(changes))


def test_a_table_that_was_used_beyond_its_end_is_named_with_train_and_speeds():
    result = with_table(speed_kmh=[0.0, 40.0, 80.0], force_kn=[100.0, 80.0, 45.0])
    speed_kmh = result.dataset.speed.to_numpy()[:-1] * 3.6
    beyond = (result.dataset.tractive_force.to_numpy()[:-1] > 0.0) & (speed_kmh > 80.0)
    assert (
        f"freight pulled above 80 km/h, up to {speed_kmh[beyond].max():.4g} km/h, in {beyond.sum()} "
        "train-steps: its table of tractive effort ends there, and its outer values hold"
    ) in notes(result)


@pytest.mark.parametrize(("top_kv", "told"), [(14.0, True), (15.0, False)])
def test_a_voltage_above_a_table_counts_only_if_the_table_ends_below_the_nominal_one(top_kv, told):
    row = [100.0, 40.0]
    result = with_table(
        speed_kmh=[0.0, 160.0], voltage_kv=[10.0, top_kv], force_kn=[[0.8 * f for f in row], row]
    )
    assert result.summary["limited"]["effort_extrapolated"] > 0
    said = [note for note in notes(result) if "pulled" in note]
    assert len(said) == told
    assert not told or said[0].startswith("freight pulled above 14 kV, up to 16.")


def test_an_rc4_below_the_voltages_of_its_network_is_named_with_how_far():
    """Behind 60 km of BT catenary with one station the voltage falls below 10.5 kV."""
    changes = {
        "line.length_km": 60.0, "line.stations.2.position_km": 60.0,
        "line.speed_limits.0.speed_kmh": 100.0,
        "supply.converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}
        ],
        "traffic.0.headway_min": 10.0,
    }  # fmt: skip
    result = tpss.simulate(short_line(changes))
    (note,) = [each for each in notes(result) if "pulled" in each]
    lowest = (
        result.dataset.pantograph_voltage.where(result.dataset.tractive_force > 0.0).min() / 1e3
    )
    assert note.startswith(f"freight pulled below 10.5 kV, down to {float(lowest):.4g} kV, in ")
    count = result.summary["limited"]["effort_extrapolated"]
    assert note.endswith(
        f"in {count} train-steps: the tractive-effort network of the Rc4 was not trained there"
    )


def test_departures_dwells_and_arrivals_at_feeding_points_are_not_noted():
    """Trains stand at West, at Middle with its transformer for two minutes, and at East."""
    changes = {
        "supply.high_voltage_line": {"type": "132kV", "transformers_km": [10.0]},
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 2.0}],
    }
    result = tpss.simulate(short_line(changes))
    assert result.summary["limited"]["short_piece"] > 40
    assert not any("closer" in note for note in notes(result))


def test_a_train_that_stands_at_a_feeding_point_between_stations_is_noted():
    """It creeps at 1 km/h from 0.2 m before a transformer: 1.2 m at 0.28 m/s and less are some steps."""
    result = tpss.simulate(
        short_line(
            {
                "simulation.time_step_min": 0.01,
                "simulation.duration_min": 1.0,
                "line.speed_limits.0.speed_kmh": 1.0,
                "supply.high_voltage_line": {"type": "132kV", "transformers_km": [5.0]},
                "traffic.0.already_running": False,
                "traffic.0.first_departure_min": 50.0,
                "traffic.0.initial_trains": [{"position_km": 4.9998, "speed_kmh": 0.0}],
            }
        )
    )
    near = (result.dataset.position.to_numpy()[:-1, 0] - 5000.0) < 1.0
    (note,) = [each for each in notes(result) if "closer" in each]
    assert f"feeding point at 5.00 km and counted as 1 m away, in {near.sum()} train-steps" in note


def test_a_run_without_a_step_has_no_loads_to_note():
    result = tpss.simulate(short_line({"line.gradients": [{"from_km": 0.0, "permille": 30.0}]}))
    assert result.dataset.sizes["time"] == 1
    assert not any("rating" in note or "circulates" in note for note in notes(result))
    assert not np.isfinite(result.dataset.converter_loading).any()
