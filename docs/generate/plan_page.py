"""The page of the plan file: its keys, and the tables that come of it."""

from pathlib import Path
from typing import Any

from markdown_pieces import code, described, table
from pydantic.fields import FieldInfo

from tpss.planning.excel import HOLDS
from tpss.planning.plan import (
    LEVEL,
    Area,
    Budget,
    Economics,
    Evaluation,
    Future,
    PlanFile,
    PlannedMeasure,
    PlannedRenewal,
    Requirements,
    Stages,
)
from tpss.planning.price_fields import CostOfLength, Price
from tpss.planning.uncounted import GENERAL

EXAMPLE = Path(__file__).parents[2] / "examples" / "plan_320km.toml"

INTRODUCTION = """# Plan file

A plan is a file in [TOML](https://toml.io): what may be built of a power supply, what it costs, and
which traffic may come with which probability. `tpss plan` finds the plan of the least expected
cost; [Plan investments](../how-to/plan-investments.md) shows how. It needs `pip install
"tpss[plan]"`."""

MONEY = """Prices are numbers in the plan's currency, or tables that say where they are from: `{ value =
0.65e-6, source = "assumed" }`. They are real, all of one year. In the tables of `economics` they
stand by the name of a type of train, as in `train_not_run.freight = 0.06`."""

MEASURES = f"""Changes are those of a [variant](scenario.md): values that are set, then items that
are added, then what is removed. A cost is a number, or `{{ per_km = 3.7, km = 320.0 }}`. With
`levels` one of several sizes is built, and may be raised to a later one, which costs the
difference; `"{LEVEL}"` stands for the level's value:

```toml
[measures.Mid]
set."supply.converter_stations.Mid.converters" = "{LEVEL}"
levels = [3, 4]
cost = [45.0, 90.0]
```

All measures of an area are ordered the same number of stages ahead; each area has its own. What is
built stays, and is
renewed like for like after its life; it is charged its annuities until the end of the plan only."""

FUTURES = """A row of values is a list with one for each stage, or one value for all; what it does
not name is as in the scenario file. Paths are those of the scenario, or of prices behind
`economics`. Two scenarios are one as long as their values are equal: nobody can tell them apart
until then."""

AREAS = """With several areas measures, renewals and values of scenarios begin with the name of
theirs, as in `[measures.north.AT]` and `north.traffic.eastbound.headway_min`; names in `needs`,
`excludes` and `unless` are of the same area."""

CASES = """A case is a configuration, that is a set of measures, with a traffic, intact or with an
outage. It is simulated once ever: whatever else changes in the plan, its row in the folder's
`cases/` stays. Of services with headways means begin when the first train of each has arrived, and
hold whole periods of the timetable; of listed departures all of the run belongs to one period. A
configuration carries a traffic if the run comes through and keeps `[require]`, intact and with each
outage of `also_with` that the configuration has."""

COLUMNS = {
    "status": "how the run ended: `finished`, `collapsed`, `stalled`, `deadlocked`, or `not through` if "
    "trains took several times as long as is foreseen",
    "problem": "why it could not be run, or why its audit failed",
    "window_from_min": "where means begin",
    "window_to_min": "and end",
    "period_min": "period of the timetable",
    "drawn_from_grid_mw": "mean power that all stations take from the grid: what they feed and lose",
    "fed_back_to_grid_mw": "mean power that they give back to it",
    "converter_losses_mw": "mean losses of converter stations; null unless their types describe them",
    "network_losses_mw": "mean losses of the network",
    "lowest_voltage_kv": "lowest voltage at a pantograph in the window",
    "mean_useful_voltage_kv": "lowest mean useful voltage of a zone, EN 50388, in the window",
    "peak_loading": "highest loading of a station's running units in the window",
    "unbalance_percent": "highest unbalance of a busbar of the grid over 10 min in the window; null "
    "unless stations tell their `phases`",
    "rail_permanent_v": "highest mean voltage of rails to earth over 300 s in the window; this and the "
    "next two are null unless rails are conductors of their own",
    "rail_short_v": "highest one in a second or a step",
    "stray_ma_per_m": "highest mean of the current that strays from the rails of a line, over the "
    "length of its tracks; null of an alternating current",
    "case_digest": "digest of all that decides what comes out",
}

EACH = """Each station has `station.NAME.` with the means of all powers that are recorded of it, such as
`station.A.station_active_power_mw`, and with `converter_losses_mw` where they are described; each
service has `service.NAME.` with these:

| column | meaning |
|---|---|
| `train` | its type of train |
| `trains_per_h` | trains that run in an hour |
| `mean_trip_min` | trip time |
| `mean_late_min` | how late they arrive, early ones counted as 0; null where none is scheduled |
| `mean_lost_min` | minutes lost against a supply that holds its voltage; null with an outage |"""

TABLES = """`tpss plan run` writes `plan.json` and these files of CSV into the folder's `tables/`, and
`plan.xlsx` with a sheet for each of them (up to 20,000 rows):

| file | what it holds |
|---|---|
{rows}

`best_plans` holds 20 of them, with a budget as many as are found in 10 s. `switching_values` is empty of
an area whose scenarios part at once, and of plans of more than some thousand configurations (with a
budget some dozens), which `tpss plan price --sweep` may be asked about one by one."""


def page() -> str:
    """Text of the page."""
    rows = "\n".join(f"| `{name}` | {holds} |" for name, holds in HOLDS.items())
    uncounted = "\n".join(f"- {each}" for each in GENERAL)
    sections: list[tuple[str, type[Any], str]] = [
        ("The whole file", PlanFile, ""),
        ("`[stages]`", Stages, ""),
        ("`[economics]`", Economics, MONEY),
        ("A price", Price, ""),
        ("`[require]`", Requirements, ""),
        ("`[measures.NAME]`", PlannedMeasure, MEASURES),
        ("A cost by length", CostOfLength, ""),
        ("`[renewals.NAME]`", PlannedRenewal, ""),
        ("`[budget]`", Budget, ""),
        ("`[scenarios.NAME]`", Future, FUTURES),
        ("`[areas.NAME]`", Area, AREAS),
        ("`[evaluate]`", Evaluation, ""),
    ]
    parts = [INTRODUCTION, f"One such file is `examples/{EXAMPLE.name}`:"]
    parts.append(f"```toml\n{EXAMPLE.read_text('utf-8')}```")
    for title, part, words in sections:
        parts += [f"## {title}", *filter(None, [words]), _keys(part)]
    parts += ["## Cases", CASES, described(COLUMNS, COLUMNS, "column"), EACH]
    parts += ["## The answer", TABLES.replace("{rows}", rows), "## What is not counted", uncounted]
    return "\n\n".join(parts)


def _keys(part: type[Any]) -> str:
    """Table of a part's keys."""
    rows = [
        (f"`{field.alias or name}`", _default(field), field.description or "")
        for name, field in part.model_fields.items()
        if (part, name) != (Future, "values")
    ]
    return table(("key", "default", "meaning"), rows)


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    return "" if field.default in (None, "", {}, ()) else code(field.default)
