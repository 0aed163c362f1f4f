"""Converters are switched every three minutes by the mean loading of the last three."""

import numpy as np
import pytest

from tpss.step.converter_control import converters_needed

from scenarios import run


@pytest.mark.parametrize(
    ("mean", "running", "installed", "expected"),
    [
        (0.2, 6, 6, 2),  # 0.2 · 6 / 0.85 = 1.41
        (0.85, 3, 6, 3),  # exactly 3: a rounding must not call for a fourth
        (0.86, 3, 6, 4),
        (1.4, 5, 6, 6),  # 8.2, but only six are there
        (0.0, 4, 6, 1),  # one always runs
    ],
)
def test_as_many_converters_run_as_carry_the_mean_at_85_percent(
    as_run, mean, running, installed, expected
):
    assert as_run(converters_needed)(mean, float(running), installed) == expected


def test_control_acts_at_the_first_instant_at_or_past_each_third_minute():
    """Steps of 0.8 min: 3, 6, 9 min -> instants 3.2, 6.4, 9.6 min."""
    result = run(
        {
            "simulation.time_step_min": 0.8,
            "simulation.duration_min": 12.0,
            "supply.converter_stations.0.converters": 6,
            "supply.converter_stations.0.control": "loading",
        }
    )
    active = result.dataset.active_converters.sel(station="West").to_numpy()[:-1]
    assert active[:4].tolist() == [6, 6, 6, 6]
    loading = result.dataset.converter_loading.sel(station="West").to_numpy()
    assert active[4] == max(1, np.ceil(loading[:4].mean() * 6 / 0.85))
    assert active[8] == max(1, np.ceil(loading[4:8].mean() * active[4] / 0.85))
    assert set(result.dataset.active_converters.sel(station="East").to_numpy()[:-1]) == {2.0}
