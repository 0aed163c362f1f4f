"""The table of outages: which cases there are, how they are ranked, and what they are compared with."""

import pytest

import tpss
from tpss import ScenarioError
from tpss.outages.cases import outages_of
from tpss.outages.row import Row, Verdict

from scenarios import BUSY, short_line

EAST_OUT = {"name": "no East", "stations": ["East"]}


def busy(changes=None):
    """The busy line in continuous motion, for ten minutes."""
    ended = {"simulation.motion": None, "simulation.braking": None, "simulation.duration_min": 10.0}
    return tpss.Scenario.from_document(BUSY, "busy").with_({**ended, **(changes or {})})


def test_single_outages_are_each_station_each_unit_and_each_transformer():
    """A station of one converter has none fewer; the station transformers stand at 0 and 20 km."""
    names = [
        each.name for each in outages_of(busy({"supply.converter_stations.1.converters": 1}), True)
    ]
    assert names == [
        "West out", "East out", "West, one unit out", "transformer 0 km out",
        "transformer 5 km out", "transformer 12.6 km out", "transformer 20 km out",
    ]  # fmt: skip


def test_one_that_the_scenario_names_is_not_made_again():
    names = [each.name for each in outages_of(short_line({"outages": [EAST_OUT]}), True)]
    assert names == ["no East", "West out", "West, one unit out", "East, one unit out"]


def test_one_of_a_name_that_the_scenario_has_taken_says_that_it_is_out_throughout():
    """An outage of West for a while, which goes by the name of the single one."""
    later = {"name": "West out", "stations": ["West"], "from_min": 4.0}
    names = [each.name for each in outages_of(busy({"outages": [later]}), True)]
    assert names[:3] == ["West out", "West out, throughout", "East out"]


def test_without_outages_there_is_no_table():
    with pytest.raises(ScenarioError, match="--n-1"):
        tpss.compare_outages(short_line())


def test_rows_are_those_of_runs_with_the_outages():
    scenario = busy({"outages": [EAST_OUT, {**EAST_OUT, "name": "later", "from_min": 4.0}]})
    found = tpss.compare_outages(scenario, threads=2)
    assert [row.outage for row in found.rows] == ["intact", "no East", "later"]
    for row in found.rows:
        chosen = scenario if row.outage == "intact" else scenario.with_outage(row.outage)
        result = tpss.simulate(chosen)
        lowest = result.summary["lowest_voltage"]
        assert row.figures["lowest_voltage_kv"] == lowest["voltage_kv"]
        assert row.figures["lowest_voltage_train"] == lowest["train"]
        peaks = result.stations.set_index("station").peak_loading
        assert row.figures["peak_loading"] == pytest.approx(peaks.max())
        assert row.figures["peak_loading_station"] == peaks.idxmax()
        zones = result.standards.useful_voltage_zones.mean_useful_kv
        assert row.figures["useful_voltage_kv"] == zones.min()


def test_lost_minutes_count_against_the_intact_supply():
    scenario = short_line({"outages": [EAST_OUT], "simulation.time_step_min": 0.1})
    found = tpss.compare_outages(scenario)
    intact, out = found.rows
    arrivals = [
        tpss.simulate(each).trips.arrival_min[0]
        for each in (scenario, scenario.with_outage("no East"))
    ]
    assert intact.lost["lost_min"] == 0.0
    assert out.lost["lost_min"] == pytest.approx(arrivals[1] - arrivals[0])
    assert out.lost["most_lost_train"] == "eastbound 1"
    table = found.table()
    changes = table.lowest_voltage_kv - table.lowest_voltage_kv[0]
    assert table.lowest_voltage_kv_change.tolist() == pytest.approx(changes.tolist())


def test_the_graver_verdict_comes_first_then_the_lower_useful_voltage():
    def row(name, verdict, useful_kv):
        return Row(name, "", verdict, 1.0, {"useful_voltage_kv": useful_kv})

    rows = [
        row("kept", Verdict.KEPT, 15.0), row("low", Verdict.KEPT, 14.0),
        row("none", Verdict.NO_SOLUTION, 16.0), row("volts", Verdict.VOLTAGE, 12.0),
    ]  # fmt: skip
    assert [each.outage for each in sorted(rows, key=lambda each: each.rank)] == [
        "none", "volts", "low", "kept",
    ]  # fmt: skip


def test_a_case_that_does_not_solve_is_a_row_with_its_time():
    """A thin line with a train every other minute, which two stations carry, and one does not."""
    heavy = {
        "supply.converter_stations.0.converters": 12,
        "supply.converter_stations.1.converters": 12,
        "supply.catenary": {"r_ohm_per_km": 0.5, "x_ohm_per_km": 0.7},
        "traffic.0.headway_min": 2.0,
        "simulation.duration_min": 25.0,
        "simulation.time_step_min": 0.5,
        "outages": [{"name": "weak", "stations": ["East"], "units": {"West": 11}}],
    }
    found = tpss.compare_outages(short_line(heavy))
    assert found.intact.verdict > Verdict.NO_SOLUTION
    assert found.rows[1].verdict in (Verdict.NO_SOLUTION, Verdict.STALLED)
    assert f"at {found.rows[1].ended_min:.2f} min" in found.table().verdict[1]


def test_an_open_step_is_that_of_the_intact_supply():
    scenario = short_line({"simulation.time_step_min": None, "outages": [EAST_OUT]})
    found = tpss.compare_outages(scenario)
    assert len(found.rows) == 2
