"""The outcome of a case: means over whole periods of the timetable, once it runs steadily."""

import math

import pytest

import tpss
from tpss.planning.outcome import outcome_of
from tpss.planning.period import period_of
from tpss.planning.plan import Evaluation

from conftest import EXAMPLES
from scenarios import SHORT_LINE

LINE = {**SHORT_LINE, "simulation": {"time_step_min": 0.5}}


def line(changes=None):
    return tpss.Scenario.from_document(LINE, "line").with_(changes or {})


def test_energy_is_that_of_the_trains_of_a_period():
    """A train an hour, on its way for less than an hour: a mean power of its energy in an hour.

    Other voltages are where the load flow begins, so the same to its tolerance only.
    """
    figures = tpss.simulate(
        line({"traffic.0.headway_min": None, "traffic.0.departures_min": [0.0]})
    )
    row = outcome_of(line(), Evaluation())
    assert row["period_min"] == 60.0
    assert row["window_to_min"] - row["window_from_min"] == pytest.approx(60.0)
    assert row["drawn_from_grid_mw"] == pytest.approx(figures.summary["total_energy_mwh"], rel=1e-7)
    assert row["network_losses_mw"] == pytest.approx(figures.summary["losses_mwh"], rel=1e-5)
    assert row["service.eastbound.mean_trip_min"] == pytest.approx(figures.summary["trip_time_min"])
    lowest = figures.summary["lowest_voltage"]
    assert row["lowest_voltage_kv"] == pytest.approx(lowest["voltage_kv"], rel=1e-12)


def test_where_the_run_ends_does_not_count():
    """Trains every 7.5 min, steps of 0.5 min: means over 1 h and over 3 h are the same."""
    busy = line({"traffic.0.headway_min": 7.5})
    short, long = (outcome_of(busy, Evaluation(measured_min=minutes)) for minutes in (60.0, 180.0))
    assert short["steps"] < long["steps"]
    for name in ("drawn_from_grid_mw", "network_losses_mw", "service.eastbound.mean_trip_min"):
        assert short[name] == pytest.approx(long[name], rel=1e-6), name


def test_means_are_of_the_steady_state_where_trains_lose_minutes_too():
    """320 km, trains every 48 min that lose 6 min each: the mean of 2 periods is that of 10."""
    scenario = tpss.load_scenario(EXAMPLES / "line_320km.toml", {"traffic.0.headway_min": 48.0})
    short, long = (outcome_of(scenario, Evaluation(measured_min=m)) for m in (60.0, 480.0))
    assert short["service.eastbound.mean_lost_min"] > 5.0
    for name in ("drawn_from_grid_mw", "network_losses_mw", "service.eastbound.mean_lost_min"):
        assert short[name] == pytest.approx(long[name], rel=1e-4), name


def test_powers_of_the_grid_are_those_of_the_stations_and_what_these_lose():
    """Transformer stations lose some of what they take, which is recorded."""
    scenario = tpss.load_scenario(EXAMPLES / "emu_25kv.toml", {"simulation.time_step_min": 0.5})
    row = outcome_of(scenario, Evaluation())
    names = [station.name for station in scenario.supply.stations]
    fed = sum(row[f"station.{name}.station_active_power_mw"] for name in names)
    lost = sum(row[f"station.{name}.station_losses_mw"] for name in names)
    assert lost > 0.0
    assert row["drawn_from_grid_mw"] - row["fed_back_to_grid_mw"] == pytest.approx(fed + lost)


def test_the_grid_delivers_what_converters_lose_where_that_is_described():
    """Two stations of two sets of 300 kW idle, and 30 kW of auxiliaries: more than 1.23 MW."""
    kind = {"supply.converter_stations.*.type": "Q48/Q49 with losses (estimate)",
            "supply.converter_stations.0.station_kw": 30.0}  # fmt: skip
    plain, row = (outcome_of(line(changes), Evaluation()) for changes in ({}, kind))
    assert math.isnan(plain["converter_losses_mw"])
    lost = row["converter_losses_mw"]
    installed = sum(s.converters for s in line().supply.converter_stations)
    assert lost > 0.3 * installed + 0.03
    net = [each["drawn_from_grid_mw"] - each["fed_back_to_grid_mw"] for each in (row, plain)]
    assert net[0] - net[1] == pytest.approx(lost, rel=1e-9)
    names = [station.name for station in line().supply.stations]
    each = [row[f"station.{name}.converter_losses_mw"] for name in names]
    assert sum(each) == pytest.approx(lost, rel=1e-12)
    assert row["service.eastbound.mean_trip_min"] == plain["service.eastbound.mean_trip_min"]


def test_minutes_lost_are_those_against_a_supply_that_does_not_yield():
    weak = line({"supply.converter_stations.0.converters": 1, "supply.converter_stations.1": None,
                 "traffic.0.headway_min": 10.0})  # fmt: skip
    row = outcome_of(weak, Evaluation())
    result = tpss.simulate(weak.with_({"simulation.duration_min": 60.0}), lost_time=True)
    lost = result.summary["lost_time"]
    assert row["service.eastbound.mean_lost_min"] > 0.0
    assert row["service.eastbound.mean_lost_min"] <= lost["worst_min"] * 1.01


def test_lateness_is_judged_where_an_arrival_is_scheduled():
    """Scheduled a minute before the train can come, it is a minute late."""
    trip_min = outcome_of(line(), Evaluation())["service.eastbound.mean_trip_min"]
    row = outcome_of(line({"traffic.0.arrive_after_min": trip_min - 1.0}), Evaluation())
    assert row["service.eastbound.mean_late_min"] == pytest.approx(1.0)
    early = outcome_of(line({"traffic.0.arrive_after_min": trip_min + 1.0}), Evaluation())
    assert early["service.eastbound.mean_late_min"] == 0.0
    assert math.isnan(outcome_of(line(), Evaluation())["service.eastbound.mean_late_min"])


def test_listed_departures_are_a_period_of_their_own():
    """Two trains in a period of 240 min: half the mean power of a train an hour."""
    listed = {"traffic.0.headway_min": None, "traffic.0.departures_min": [0.0, 60.0]}
    row = outcome_of(line(listed), Evaluation(period_min=240.0))
    hourly = outcome_of(line(), Evaluation())
    assert row["service.eastbound.trains_per_h"] == 0.5
    assert row["drawn_from_grid_mw"] == pytest.approx(hourly["drawn_from_grid_mw"] / 2, rel=1e-7)


def test_a_line_that_collapses_has_no_steady_state():
    weak = {"supply.converter_stations.1": None, "traffic.0.headway_min": 0.2}
    row = outcome_of(line(weak), Evaluation())
    assert row["status"] == "collapsed"
    assert "drawn_from_grid_mw" not in row


@pytest.mark.parametrize(
    ("headways", "period"), [((20.0, 30.0), 60.0), ((7.5, 10.0), 30.0), ((0.1, 0.3), 0.3)]
)
def test_services_repeat_together_after_the_least_common_multiple_of_headways(headways, period):
    one = LINE["traffic"][0]
    traffic = [
        {**one, "name": f"service {i}", "headway_min": each} for i, each in enumerate(headways)
    ]
    assert period_of(line({"traffic": traffic}), Evaluation()) == pytest.approx(period, rel=1e-12)


def test_a_period_that_is_not_known_is_asked_for():
    one = LINE["traffic"][0]
    odd = [{**one, "name": f"{each}", "headway_min": each} for each in (7.1, 11.3, 13.7)]
    with pytest.raises(tpss.ScenarioError, match="repeat together only after 109"):
        period_of(line({"traffic": odd}), Evaluation())
    listed = {"traffic.0.headway_min": None, "traffic.0.departures_min": [0.0]}
    with pytest.raises(tpss.ScenarioError, match=r"evaluate\.period_min"):
        period_of(line(listed), Evaluation())
    assert period_of(line(listed), Evaluation(period_min=1440.0)) == 1440.0
