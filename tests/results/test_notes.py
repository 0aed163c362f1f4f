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


def test_a_run_without_a_step_has_no_loads_to_note():
    result = tpss.simulate(short_line({"line.gradients": [{"from_km": 0.0, "permille": 30.0}]}))
    assert result.dataset.sizes["time"] == 1
    assert not any("rating" in note or "circulates" in note for note in notes(result))
    assert not np.isfinite(result.dataset.converter_loading).any()
