"""Runs that cannot finish say so, and keep what they have."""

import pytest

import tpss
from tpss.errors import TooLargeError

from scenarios import short_line


def test_a_train_that_cannot_start_on_a_gradient_stalls_at_once():
    """1470 t on 15 per mille: 15.4 kN + 216.3 kN against less than 176 kN of the machine."""
    result = tpss.simulate(short_line({"line.gradients": [{"from_km": 0.0, "permille": 15.0}]}))
    assert result.status == "stalled"
    assert "eastbound 1 cannot start at 0.00 km" in result.summary["problem"]
    assert "231.7 kN" in result.summary["problem"]
    assert result.audit["passed"]


def test_a_train_that_stalls_in_the_step_of_its_departure_is_in_the_result():
    """It departs at 3 min, the run ends there: its position at that instant is all there is of it."""
    changes = {
        "line.gradients": [{"from_km": 0.0, "permille": 15.0}],
        "traffic.0.first_departure_min": 3.0,
    }
    result = tpss.simulate(short_line(changes))
    assert result.status == "stalled"
    assert "At 3.00 min eastbound 1 cannot start" in result.summary["problem"]
    assert result.trips.train.to_list() == ["eastbound 1"]
    assert float(result.dataset.position[-1, 0]) == 0.0


def test_a_train_that_would_roll_back_stalls_on_the_way():
    gradients = [{"from_km": 0.0, "permille": 0.0}, {"from_km": 5.0, "permille": 20.0}]
    result = tpss.simulate(short_line({"line.gradients": gradients}))
    assert result.status == "stalled"
    assert "would roll back" in result.summary["problem"]
    assert 5.0 < result.trips.distance_km[0] < 10.0
    assert result.summary["station_energy_mwh"]["West"] > 0.0


def test_wet_rails_carry_less_than_dry_ones():
    """At standstill dry rails take 256.9 kN and wet ones 124.1 kN of the machine's 175 kN."""
    dry = tpss.simulate(short_line({"simulation.duration_min": 1.0}))
    wet = tpss.simulate(short_line({"simulation.duration_min": 1.0, "simulation.rail": "wet"}))
    forces = [float(r.dataset.tractive_force.isel(time=0, train=0)) for r in (dry, wet)]
    assert forces[0] > 170e3
    assert abs(forces[1] - 124.1e3) < 100.0


def test_too_many_trains_on_a_weak_line_collapse_and_keep_what_was_simulated():
    changes = {
        "line.length_km": 100.0, "line.stations.2.position_km": 100.0,
        "supply.converter_stations": [
            {"name": "West", "position_km": 0.0, "type": "Q48/Q49", "converters": 2}
        ],
        "traffic.0.headway_min": 5.0,
    }  # fmt: skip
    result = tpss.simulate(short_line(changes))
    assert result.status == "collapsed"
    assert result.summary["duration_min"] > 10.0
    assert "cannot carry its load" in result.summary["problem"]
    assert "near" in result.summary["advice"]
    assert result.audit["passed"]
    assert result.audit["lowest_voltage_v"] > 8_250.0


@pytest.mark.parametrize(
    "changes",
    [
        {"simulation.duration_min": 100_000.0, "traffic.0.headway_min": 0.01},
        {"traffic.0.first_departure_min": 100_000.0, "simulation.time_step_min": 0.001},
        {"line.length_km": 2_000.0, "line.stations.2.position_km": 2_000.0,
         "line.speed_limits.0.speed_kmh": 1.0, "simulation.time_step_min": 0.001,
         "traffic.0.already_running": True},
    ],
    ids=["many trains", "late departure", "long trip"],
)  # fmt: skip
def test_a_run_that_memory_cannot_hold_is_refused_before_it_is_laid_out(changes, monkeypatch):
    """And before a train runs alone to find out which are on the line: by steps without number."""
    monkeypatch.delattr("tpss.run.start.trains_on_line")
    with pytest.raises(TooLargeError, match="GiB of memory"):
        tpss.simulate(short_line(changes))
