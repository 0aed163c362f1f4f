"""Load flows of whole runs against pandapower, an independent program for power systems.

Moments of each run are laid out anew and solved by pandapower, see `pandapower_net`.  The largest
differences are printed: ``python -m pytest -rP tests/validation/test_against_pandapower.py``.
"""

import numpy as np
import pytest

import tpss

from conftest import EXAMPLES
from pandapower_net import (
    solve_network_with_pandapower,
    solve_with_pandapower,
    worst_differences,
)

NAMES = [
    "thesis_160km", "thesis_3_3", "thesis_3_7_2", "at_headway_3", "at_hv_headway_3", "emu_25kv",
]  # fmt: skip

TOLERANCE = 1e-7
"""In p.u. and rad: ours leaves up to 1e-9 of base power at a bus, pandapower 1e-10, of 70 buses."""


def odd_line():
    """What no example has: open ends, equally spaced transformers, another voltage, short pieces.

    Feeders stand at 20, 60, 100 and 140 km, trains at and within a metre of them and of each other.
    """
    places_km = [19.9996, 20.0, 40.0, 40.0003, 59.9992, 60.0, 60.0, 99.9999, 120.0, 150.0]
    changes = {
        "name": "open-ends",
        "supply.high_voltage_line.transformers_km": None,
        "supply.high_voltage_line.transformers": 2,
        "supply.high_voltage_line.base_kv": 66.0,
        "supply.converter_stations.0.position_km": 20.0,
        "supply.converter_stations.1.position_km": 140.0,
        "supply.converter_stations.1.converters": 3,
        "traffic.0.already_running": None,
        "traffic.0.initial_trains": [{"position_km": km, "speed_kmh": 50.0} for km in places_km],
        "simulation.duration_min": 4.0,
    }
    return tpss.load_scenario(EXAMPLES / "at_hv_headway_3.toml", changes)


def telling_moments(result):
    """Steps of a run at which a wrong network would show most."""
    dataset = result.dataset.isel(time=slice(0, -1))
    on_line = dataset.position.where(np.isfinite(dataset.active_power))
    gaps = np.diff(np.sort(on_line.values, axis=1), axis=1)  # trains that are not there sort last
    gaps = np.where(np.isfinite(gaps), gaps, np.inf)
    return {
        "start": 0,
        "heaviest losses": int(dataset.network_losses.argmax("time")),
        "lightest losses": int(dataset.network_losses.argmin("time")),
        "lowest voltage": int(dataset.pantograph_voltage.min("train").argmin("time")),
        "closest trains": int(gaps.min(axis=1).argmin()),
        "end": dataset.sizes["time"] - 1,
    }


def assert_agreement(scenario, solve=solve_with_pandapower):
    result = tpss.simulate(scenario)
    assert result.status == "finished"
    worst = dict.fromkeys(("voltage", "angle", "P", "Q"), 0.0)
    for when, step in telling_moments(result).items():
        moment = result.dataset.isel(time=step)
        differences = worst_differences(solve(scenario, moment), moment)
        assert max(differences.values()) < TOLERANCE, (when, differences)
        worst = {what: max(worst[what], value) for what, value in differences.items()}
    print(scenario.name, *(f"{what} {value:.1e}" for what, value in worst.items()), sep=" | ")


@pytest.mark.parametrize("name", NAMES)
def test_an_example_agrees(name):
    """Every pantograph's and node's voltage and angle, every station's active and reactive power."""
    assert_agreement(tpss.load_scenario(EXAMPLES / f"{name}.toml"))


def test_the_network_agrees():
    """Two lines that meet, of two tracks tied at a post and of one, each with a catenary of its own."""
    scenario = tpss.load_scenario(EXAMPLES / "network.toml")
    assert_agreement(scenario, solve_network_with_pandapower)


def test_a_line_with_open_ends_and_trains_less_than_a_metre_apart_agrees():
    assert_agreement(odd_line())


def test_islands_on_different_phases_agree():
    """Each island is a net of its own; the line has one track here."""
    one_track = {
        "line.tracks": None,
        "supply.tracks_tied": None,
        "supply.catenary.mutual_r_ohm_per_km": None,
        "supply.catenary.mutual_x_ohm_per_km": None,
    }
    assert_agreement(tpss.load_scenario(EXAMPLES / "neutral_section_25kv.toml", one_track))


@pytest.mark.parametrize("feedback", ["grid", "none"])
def test_trains_that_feed_back_agree(feedback):
    """Down a grade all trains are sources, of which one station takes nothing where it is told so."""
    brakes = {"max_force_kn": 250.0, "max_power_kw": 4_000.0, "efficiency": 0.85}
    changes = {
        "name": f"down-{feedback}",
        "line.gradients": [{"from_km": 0.0, "permille": -12.0}],
        "trains.*.regeneration": brakes,
        "supply.converter_stations.0.feedback": feedback,
    }
    scenario = tpss.load_scenario(EXAMPLES / "at_headway_3.toml", changes)
    result = tpss.simulate(scenario)
    given_w = result.dataset.active_power.isel(time=slice(0, -1)).sum("train")
    taken_w = result.dataset.station_active_power.isel(time=slice(0, -1))
    assert float(given_w.min()) < -5e6
    worst_taken_w = float(taken_w.isel(station=0).min())
    assert worst_taken_w < -1e6 if feedback == "grid" else worst_taken_w > -4e4
    moment = result.dataset.isel(time=int(given_w.argmin("time")))
    differences = worst_differences(solve_with_pandapower(scenario, moment), moment)
    assert max(differences.values()) < TOLERANCE, differences
