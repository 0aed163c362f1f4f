"""A solution where there is one, the right one, and no other."""

from pathlib import Path

import numpy as np
import pytest

import tpss
from tpss.powerflow.network import Ending
from tpss.powerflow.solve import solve

from collapses import CONFIRMED, SOLVED, run
from networks import BT, ROTARY, STIFF, constant_loads, network_of, place, simple_line, sources
from scenarios import short_line

CASES = Path(__file__).parent / "cases"
LINES = range(70_000, 70_008)


def test_no_collapse_of_an_odd_line_is_a_false_one():
    """Current limitations, stations unlike in reactance, voltage and angle; two homotopies judge."""
    outcomes, _, faults = run(LINES)
    assert faults == []
    assert outcomes[SOLVED] > len(LINES) / 3
    assert outcomes[CONFIRMED] > 0


def test_many_trains_at_the_knees_of_their_current_limitation_are_solved():
    """16 trains stand within 2 V of umin2, where the slope of each one's demand jumps from 0 to
    3,500 var/V: they roll to a stop there, which is not a line that cannot carry its load.
    """
    changes = {
        "simulation.time_step_min": 0.2,
        "simulation.duration_min": 10.0,
        "line.length_km": 120.0,
        "line.gradients": [{"from_km": 0.0, "permille": 4.0}],
        "line.speed_limits": [{"from_km": 0.0, "speed_kmh": 100.0}],
        "line.stations": [
            {"name": "W", "position_km": 0.0}, {"name": "E", "position_km": 120.0}
        ],
        "supply.catenary": "BT",
        "supply.converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 1}
        ],
        "trains.freight": {
            "model": "Rc4-freight-1470t", "max_motor_current_a": 2080.0,
            "filter_reactance_ohm": -0.45, "reactive_power": "double-bridge",
            "current_limitation": {"max_current_a": 600.0, "umin2_kv": 11.0, "knee_factor": 0.9},
        },
        "traffic": [{"name": "e", "train": "freight", "from": "W", "to": "E", "headway_min": 5.0,
                     "already_running": True}],
    }  # fmt: skip
    result = tpss.simulate(short_line(changes))
    assert result.status == "stalled"
    assert "current limitation" in result.summary["problem"]
    assert result.audit["passed"]


def unlike(**changes):
    return {**ROTARY, **changes}


@pytest.mark.parametrize(
    ("name", "status", "words"),
    [
        ("unlike_stations", "finished", ""),
        ("unlike_and_heavy", "stalled", ""),
        ("singular_pivot", "stalled", ""),
        ("two_roots", "finished", ""),
        ("falls_out_of_step", "collapsed", "beyond 3.9 % of that C2 falls out of step"),
        ("out_of_step", "collapsed", "C0 falls out of step"),
        (
            "out_of_step_without_load",
            "collapsed",
            "all that C0 carries then is the charging current",
        ),
        ("no_force_below_the_limit", "finished", ""),
    ],
)
def test_odd_scenarios_end_as_they_should(name, status, words):
    """The last one: at 0 force of the machine, below its limit, a train rolls as one that pulls."""
    result = tpss.simulate(tpss.load_scenario(CASES / f"{name}.toml"))
    assert result.status == status
    assert words in result.summary.get("problem", "")
    assert "nan" not in result.summary.get("problem", "")
    assert result.audit["passed"], result.audit["failures"]


def test_the_root_after_a_switch_is_that_of_the_path_from_no_load():
    """Newton's method from the step before finds 39 MW and 35 MW, for a train of 0.5 MW."""
    result = tpss.simulate(tpss.load_scenario(CASES / "two_roots.toml"))
    fed_w = result.dataset.station_active_power.sel(station=["C2", "C3"])
    assert float(abs(fed_w).max()) < 1e6


def test_a_machine_beyond_ninety_degrees_is_no_state():
    """A reactor fed in the wrong direction: U² + X Q/n < 0 asks for Q < -18.9 Mvar of a machine."""
    network = network_of(2, [(0, 1, 0.0, 1e3, BT, 0.0)], [], sources((0, ROTARY)))
    case = place(network, constant_loads([500.0], [1e3 - 40e6j]))
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share < 0.7
    assert case.flow.search[0].ending in (Ending.OUT_OF_STEP, Ending.LEFT_BAND)


@pytest.mark.parametrize("apart_deg", [0.0, 10.0, 20.0])
def test_stations_at_other_angles_have_a_state(apart_deg):
    east = unlike(grid_angle_rad=np.radians(apart_deg))
    case = simple_line(40e3, [20e3], [2e6 + 0j], ROTARY, east)
    share, _ = solve(False, case.network, case.flow, case.loads)
    assert share == 1.0


@pytest.mark.parametrize(("west_v", "carried"), [(16_200.0, True), (16_500.0, False)])
def test_a_machine_that_a_stronger_station_pulls_out_of_step_is_told_without_load(west_v, carried):
    """Through x = 10 Ω of line a machine of 15.5 kV behind X = 200 Ω takes Q = U (E - U) / x.

    Nothing is left of its triangle at Q = U² / X, so for E - U = U x / X = 775 V; brought apart from
    16 kV each, 16.5 and 15.5 kV get to 78 % of their difference.
    """
    west = {**STIFF, "no_load_voltage_v": west_v}
    east = {**STIFF, "no_load_voltage_v": 15_500.0, "generator_reactance_ohm": 200.0}
    case = simple_line(50e3, [25e3], [1.0 + 0j], west, east, impedance=0.2e-3j)
    share, _ = solve(False, case.network, case.flow, case.loads)
    outcome = case.flow.search[0]
    assert (share == 1.0) == carried
    assert outcome.ending == (Ending.FOUND if carried else Ending.OUT_OF_STEP)
    assert outcome.without_load != carried
