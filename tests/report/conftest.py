"""Results to report on: made once, as a report only reads them."""

import copy

import pytest

import lines
import tpss
from tpss.measured.compare import MeasuredComparison
from tpss.outages.report import outages_report
from tpss.outages.run import Comparison
from tpss.report.html import comparison, report

from conftest import EXAMPLES
from measured_files import in_minutes
from scenarios import run, short_line


@pytest.fixture(scope="session")
def short() -> tpss.Result:
    """The short line, a train every ten minutes."""
    return run({"traffic.0.headway_min": 10.0})


@pytest.fixture(scope="session")
def star() -> tpss.Result:
    """A branch that leaves a main line; a train runs onto it, and one along."""
    ways = [lines.service("up", "West", "Mine"), lines.service("along", "West", "East")]
    document = lines.network(lines.STAR, ways)
    document["supply"]["catenary"] = "AT"
    return lines.run(document)


@pytest.fixture(scope="session")
def collapsed() -> tpss.Result:
    """A line that cannot carry its traffic from the first step on."""
    return tpss.simulate(tpss.load_scenario(EXAMPLES / "overloaded.toml"))


@pytest.fixture(scope="session")
def mistrusted(short: tpss.Result) -> tpss.Result:
    """The short line with an audit that failed."""
    summary = copy.deepcopy(short.summary)
    summary["audit"] |= {
        "passed": False,
        "power_mismatch_va": 3.0,
        "failures": ["power_mismatch_va is 3, limit 0.01"],
    }
    return tpss.Result(short.scenario, short.dataset, summary)


@pytest.fixture(scope="session")
def page(short: tpss.Result) -> str:
    """Report of the short line."""
    return report(short)


@pytest.fixture(scope="session")
def compared(short: tpss.Result, collapsed: tpss.Result) -> str:
    """The short line beside one with more traffic, and beside one that collapsed."""
    dense = run({"traffic.0.headway_min": 5.0})
    return comparison({"every 10 min": short, "every 5 min": dense, "collapsed": collapsed})


@pytest.fixture(scope="session")
def beside(short: tpss.Result, tmp_path_factory: pytest.TempPathFactory) -> MeasuredComparison:
    """The short line against its own power of West and 0.1 MW more, with a gap, over half minutes."""
    watts = short.dataset.station_active_power.sel(station="West").to_numpy()[:-1]
    whole = watts[: len(watts) // 10 * 10]
    values = whole.reshape(-1, 10).mean(axis=1) / 1e6 + 0.1
    cells = values.tolist()
    cells[4] = None
    path = tmp_path_factory.mktemp("measured") / "measured.csv"
    path.write_text(in_minutes({"station_active_power:West [MW]": cells}, step=0.5), "utf-8")
    return tpss.compare_with_measurements(short, path)


OUTAGES = [
    {"name": "no East", "stations": ["East"]},
    {"name": "the middle", "sections": [{"from_km": 9.0, "to_km": 11.0}]},
    {"name": "all <b>", "stations": ["West", "East"], "from_min": 6.0, "to_min": 12.0},
]


@pytest.fixture(scope="session")
def found() -> Comparison:
    """Table of the short line's outages: a station, a section, all for a time."""
    plain = {"simulation.motion": None, "simulation.braking": None}
    return tpss.compare_outages(short_line({**plain, "outages": OUTAGES}))


@pytest.fixture(scope="session")
def table_page(found: Comparison) -> str:
    """Report of that table."""
    return outages_report(found)
