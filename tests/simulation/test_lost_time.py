"""Time lost to the voltage: against the same run at the supply's voltage without load."""

from dataclasses import replace

import pytest

import tpss
from tpss.kept import Kept
from tpss.run import stiff
from tpss.run.protection import run_to_end
from tpss.step.advance import advance

from scenarios import short_line

WEAK = {
    "simulation.motion": "continuous",
    "simulation.braking": "within-step",
    "supply.catenary": {"r_ohm_per_km": 0.4, "x_ohm_per_km": 0.4},
    "supply.converter_stations.East": None,
    "line.speed_limits.0.speed_kmh": 100.0,
    "line.gradients.0.permille": 5.0,
    "traffic.0.headway_min": 12.0,
}
STRONG = {"supply.catenary": {"r_ohm_per_km": 0.001, "x_ohm_per_km": 0.0}}
STIFF_STATIONS = {
    "supply.converter_stations.0.type": {
        "rating_mva": 1e3, "no_load_voltage_kv": 16.5, "droop_kv_per_mvar": 0.0,
        "generator_reactance_pu": 0.0, "generator_base_mva": 10.0, "motor_reactance_pu": 0.0,
        "motor_base_mva": 10.0, "base_voltage_kv": 16.5,
    }
}  # fmt: skip


def lost(*changes) -> dict | None:
    merged = {key: value for each in changes for key, value in each.items()}
    return tpss.simulate(short_line(merged), lost_time=True).summary["lost_time"]


def test_it_is_what_the_train_takes_longer_than_on_a_line_without_impedance():
    weak = tpss.simulate(short_line(WEAK), lost_time=True)
    strong = tpss.simulate(short_line({**WEAK, **STRONG, **STIFF_STATIONS}))
    longer_min = weak.summary["trip_time_min"] - strong.summary["trip_time_min"]
    assert longer_min > 0.05
    found = weak.summary["lost_time"]
    assert (found["worst_train"], found["trains"]) == ("eastbound 1", 1)
    assert found["worst_min"] == pytest.approx(longer_min, abs=2e-3)
    assert found["total_min"] == pytest.approx(found["worst_min"])
    assert found["voltage_kv"] == 16.5


def test_a_machine_that_the_voltage_does_not_touch_loses_nothing():
    """200 kN and 2 MW at any voltage."""
    machine = {"max_force_kn": 200.0, "max_power_kw": 2000.0}
    same = {"trains.freight.tractive_effort": machine, "trains.freight.power_factor": 0.9}
    assert lost(WEAK, same)["total_min"] == pytest.approx(0.0, abs=1e-9)


def test_it_is_over_all_trains_that_have_arrived_and_names_the_one_that_lost_most():
    found = lost(WEAK, {"simulation.until": None, "simulation.duration_min": 60.0,
                        "traffic.0.already_running": True})  # fmt: skip
    assert found["trains"] >= 4
    assert found["total_min"] > found["worst_min"] > 0.0
    assert found["worst_train"].startswith("eastbound")


@pytest.mark.parametrize(
    "changes",
    [
        {"simulation.until": None, "simulation.duration_min": 2.0},
        {"line.gradients.0.permille": 60.0},
    ],
    ids=["too short", "stalled at once"],
)
def test_there_is_none_where_no_train_has_arrived(changes):
    assert lost(WEAK, changes) is None


def test_it_is_not_looked_for_unless_it_is_asked_for():
    assert tpss.simulate(short_line(WEAK)).summary["lost_time"] is None


def test_cases_with_the_same_trains_share_the_run_at_one_voltage_and_find_what_they_would_alone(
    monkeypatch,
):
    """A shorter run takes its part of a longer one; another supply has the same, other trains do not."""
    given = {"simulation.until": None, "traffic.0.already_running": True}
    changes = [{}, {"supply.catenary": "AT"}, {"trains.*.mass_t": 700.0}]
    starts = [
        tpss.prepare(short_line({**WEAK, **given, "simulation.duration_min": 60.0, **each})).start
        for each in changes
    ]
    starts = [replace(start, steps=steps) for steps in (300, 200, 250, 299) for start in starts]
    runs = [(run_to_end(start, advance)[0], start) for start in starts]

    def alone(run, start):
        monkeypatch.setattr(stiff, "_kept", Kept(1))
        return stiff.lost_by_train(run, start, 16500.0)

    expected = [alone(*each) for each in runs]
    assert all(expected)
    monkeypatch.setattr(stiff, "_kept", Kept(8))
    assert [stiff.lost_by_train(*each, 16500.0) for each in runs] == expected
    assert len(stiff._kept) == 2
