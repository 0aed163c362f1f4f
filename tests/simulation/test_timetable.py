"""Scheduled times: a train leaves no earlier, and as late as its least stop makes it."""

import numpy as np
import pytest

import tpss
from faults import faults_of, finding_at
from tpss.results.stops import punctuality

from scenarios import run, short_line

CLOSED_FORM = {
    "simulation.motion": "continuous",
    "simulation.braking": "within-step",
    "trains.freight": {
        "mass_t": 100.0, "adhesive_mass_t": 100.0, "resistance_a_n": 0.0,
        "resistance_b_n_s_per_m": 0.0, "resistance_c_n_s2_per_m2": 0.0, "max_speed_kmh": 72.0,
        "max_retardation_m_s2": 1.0, "auxiliary_power_kw": 0.0, "power_factor": 1.0,
        "efficiency": 1.0, "tractive_effort": {"max_force_kn": 100.0, "max_power_kw": 1e5},
    },
    "line.speed_limits.0.speed_kmh": 72.0,
    "traffic.0.departures_min": [3.0],
    "traffic.0.headway_min": None,
}  # fmt: skip
"""10 km at 20 m/s, 1 m/s² up and down: 520 s = 8.6667 min from stop to stop."""

HOP_MIN = 520.0 / 60.0


def stopping(step_min: float, **times: float) -> tpss.Result:
    stop = {"station": "Middle", "dwell_min": 1.0, **times}
    changes = {"traffic.0.stops": [stop], "simulation.time_step_min": step_min}
    return run({**CLOSED_FORM, **changes})


@pytest.mark.parametrize("step_min", [0.01, 0.07, 1.0, 7.3])
def test_a_train_that_is_early_waits_for_its_departure(step_min):
    """Scheduled 12 min after its own departure, after 3 min: it leaves after 15 min, to the second."""
    result = stopping(step_min, arrive_after_min=9.0, depart_after_min=12.0)
    call = result.stops.iloc[1]
    assert call.arrival_min == pytest.approx(3.0 + HOP_MIN, rel=1e-9)
    assert call.departure_min == pytest.approx(15.0, rel=1e-9)
    assert (call.scheduled_arrival_min, call.scheduled_departure_min) == (12.0, 15.0)
    assert call.late_min == pytest.approx(HOP_MIN - 9.0, rel=1e-9)
    assert result.stops.arrival_min.iloc[2] == pytest.approx(15.0 + HOP_MIN, rel=1e-9)


@pytest.mark.parametrize("step_min", [0.01, 0.07, 1.0, 7.3])
def test_a_train_that_is_late_leaves_after_its_least_stop(step_min):
    """Scheduled after 9 min, of which the hop takes 8.67, it stands a minute: 0.67 min late."""
    result = stopping(step_min, depart_after_min=9.0)
    call = result.stops.iloc[1]
    assert call.dwell_min == pytest.approx(1.0, rel=1e-9)
    assert call.late_min == pytest.approx(HOP_MIN + 1.0 - 9.0, rel=1e-9)
    assert np.isnan(call.scheduled_arrival_min)


def test_stepped_trains_leave_at_the_first_step_at_or_after_their_time():
    """Departure at 3 min, scheduled 12 min later: at 15 min, or at the first multiple of 0.7, 15.4.

    With 0.7 min the train departs at 3.5, the first step, so its time is 15.5: 16.1.
    """
    stepped = {"simulation.motion": "stepped", "traffic.0.stops": [
        {"station": "Middle", "dwell_min": 1.0, "depart_after_min": 12.0}
    ]}  # fmt: skip
    for step_min, leaves_min in ((0.05, 15.0), (0.7, 16.1)):
        result = run({**CLOSED_FORM, **stepped, "simulation.time_step_min": step_min})
        assert result.stops.departure_min.iloc[1] == pytest.approx(leaves_min)


def test_trains_that_run_already_keep_their_schedule_too():
    """The one that departed 12 min before the start leaves its stop at 8 min, 20 min under way."""
    changes = {
        "traffic.0.departures_min": None, "traffic.0.headway_min": 12.0,
        "traffic.0.already_running": True, "simulation.until": None,
        "simulation.duration_min": 30.0, "simulation.time_step_min": 0.1,
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0, "depart_after_min": 20.0}],
    }  # fmt: skip
    result = run({**CLOSED_FORM, **changes})
    table = result.stops.set_index(["train", "station"])
    assert table.departure_min["eastbound initial 1", "Middle"] == pytest.approx(8.0, abs=1e-6)
    assert table.departure_min["eastbound 1", "Middle"] == pytest.approx(20.0, abs=1e-6)


def test_a_train_of_unknown_departure_stands_for_its_least_stop():
    changes = {
        "traffic.0.initial_trains": [{"position_km": 9.0, "speed_kmh": 0.0}],
        "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0, "depart_after_min": 60.0}],
        "simulation.time_step_min": 0.1,
        "simulation.until": None,
        "simulation.duration_min": 10.0,
    }
    table = run({**CLOSED_FORM, **changes}).stops.set_index(["train", "station"])
    assert table.dwell_min["eastbound initial 1", "Middle"] == pytest.approx(1.0)


def test_the_destination_is_scheduled_by_the_service_and_the_run_says_how_it_was_kept():
    """Two hops and a stop of a minute take 18.33 min, 18 are scheduled; the stop has no schedule."""
    late = run({**CLOSED_FORM, "simulation.time_step_min": 0.1, "traffic.0.arrive_after_min": 18.0,
                "traffic.0.stops": [{"station": "Middle", "dwell_min": 1.0}]})  # fmt: skip
    assert late.stops.late_min.iloc[-1] == pytest.approx(2 * HOP_MIN + 1.0 - 18.0, abs=1e-6)
    assert punctuality(late.stops) == [
        "Timetable: 1 of 1 scheduled times missed by more than 0.1 min, most by eastbound 1 at East, "
        "0.33 min"
    ]
    assert punctuality(run(CLOSED_FORM).stops) == []


def test_times_that_do_not_follow_the_travel_are_faults():
    stop = {"station": "Middle", "dwell_min": 1.0}
    backwards = {"traffic.0.stops": [{**stop, "arrive_after_min": 9.0, "depart_after_min": 8.0}]}
    finding = finding_at("traffic.0.stops.0", faults_of(backwards))
    assert "lies before the arrival" in finding.problem
    crossed = {
        "traffic.0.stops": [{**stop, "depart_after_min": 30.0}],
        "traffic.0.arrive_after_min": 20.0,
    }
    with pytest.raises(tpss.ScenarioError, match="East is scheduled after 20 min, before Middle"):
        short_line(crossed)


@pytest.mark.parametrize("step_min", [0.1, 1.0, 7.3])
def test_a_train_passes_a_station_between_two_instants(step_min):
    """200 m while it gets to 20 m/s in 20 s, and 9.8 km in 490 s: 510 s, 8.5 min after its departure."""
    passing = {"traffic.0.passes": [{"station": "Middle", "after_min": 8.0}]}
    table = run({**CLOSED_FORM, **passing, "simulation.time_step_min": step_min}).stops
    assert table.kind.tolist() == ["start", "pass", "end"]
    call = table.iloc[1]
    assert call.arrival_min == call.departure_min == pytest.approx(3.0 + 8.5, rel=1e-9)
    assert call.dwell_min == 0.0
    assert call.scheduled_arrival_min == 11.0
    assert call.late_min == pytest.approx(0.5, rel=1e-9)
    assert np.isnan(call.scheduled_departure_min)


@pytest.mark.parametrize(("way_km", "time_s"), [(0.1, 200.0**0.5), (19.95, 1020.0 - 10.0)])
def test_a_passing_while_the_speed_changes_is_exact_too(way_km, time_s):
    """100 m at 1 m/s² take √(2 · 100) s, and the last 50 m to standstill √(2 · 50) = 10 s.

    20 km take 20 + 980 + 20 s.  Steps of 6 s change the speed evenly where it passes.
    """
    changes = {
        **CLOSED_FORM, "simulation.time_step_min": 0.1, "traffic.0.from": "East", "traffic.0.to": "West",
        "line.stations.+": {"name": "Halt", "position_km": 20.0 - way_km},
        "traffic.0.passes": [{"station": "Halt"}],
    }  # fmt: skip
    call = run(changes).stops.iloc[1]
    assert 60.0 * (call.arrival_min - 3.0) == pytest.approx(time_s, abs=1e-6)
    assert np.isnan(call.late_min)


def test_what_a_train_has_passed_before_the_start_or_not_yet_is_not_known():
    changes = {
        "traffic.0.initial_trains": [{"position_km": 12.0, "speed_kmh": 0.0}],
        "traffic.0.passes": [{"station": "Middle", "after_min": 8.5}],
        "simulation.time_step_min": 0.1,
        "simulation.until": None,
        "simulation.duration_min": 8.0,
    }
    table = run({**CLOSED_FORM, **changes}).stops
    assert table.arrival_min[table.kind == "pass"].isna().tolist() == [True, True]


def test_passes_are_on_the_way_and_in_its_order():
    passes = [{"station": "Middle"}, {"station": "East"}, {"station": "Mddle"}]
    keys = [finding.key for finding in faults_of({"traffic.0.passes": passes})]
    assert keys == ["traffic.0.passes.2.station", "traffic.0.passes.1.station"]
