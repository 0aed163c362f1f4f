"""The page of the study file: its keys, and the columns of the table that comes of it."""

import inspect
from pathlib import Path
from typing import Any

from markdown_pieces import code, described, prose, table
from pydantic.fields import FieldInfo

from tpss.sweep.columns import MADE_BY, OUTPUTS, TIMINGS
from tpss.sweep.inputs import Inputs
from tpss.sweep.lengths import PLACES
from tpss.sweep.settings import INSTEAD_OF
from tpss.sweep.study import Gradients, StudyFile
from tpss.sweep.variation import Variation

EXAMPLE = Path(__file__).parents[2] / "examples" / "study_converters.toml"

INTRODUCTION = """# Study file and table

A study is a file in [TOML](https://toml.io): a [scenario](scenario.md) that all cases start from, what
varies, and how cases are drawn. `tpss sweep` runs it; [Run a study](../how-to/run-a-study.md) shows
how. It needs `pip install "tpss[study]"`: Dask's `distributed`, SciPy and PyArrow."""

PATHS = """## Key paths

Tables are named by their keys, list items by their names or numbers from 0, or all of them by `*`, as in
`traffic.0.headway_min` or `supply.converter_stations.*.converters`. In TOML a `*` stands in quotes, of
the whole path or of itself. The text `"none"` leaves a key out, as in `"supply.high_voltage_line" =
"none"`. `+` is one more item of a list, or none: `"supply.posts.+" = ["none", {{ name = "Post 80",
line = "main", position_km = 80.0 }}]`.

Whatever a scenario says may vary, for example:

| what | path |
|---|---|
| a line of a network, and its tracks | `lines.main.length_km`, `lines.main.tracks` |
| tracks at a station | `lines.branch.stations.Forsa.tracks` |
| a timetable, and its density | `timetables.0.file`, `timetables.0.density` |
| one train of a timetable that does not vary itself | `traffic.R101.train` |
| a feeding station | `supply.converter_stations.Western.converters` |
| transformers of the high-voltage line | `supply.high_voltage_line.transformers` |
| the contact line of a stretch | `supply.contact_lines.0.catenary` |
| an outage, or none | `simulation.outage` = `["none", "Western out"]` |

What no case depends on is refused: names, descriptions and variants, outages where none applies, and
gradients of a line on which they are drawn.

A new `line.length_km`, or `lines.NAME.length_km`, moves what stands along that line in proportion:
{places}. The gradients keep their places. Other values are set after that, so a position is one on the
new line.

Of these keys one replaces the others: {instead}."""

GRADIENTS = """A profile has exactly the mean and the standard deviation that are asked for, over the
line of its case. Before they are shifted and stretched, the gradients of neighbouring pieces are
numbers of a normal distribution, correlated by $\\rho = e^{-\\text{piece}/\\text{correlation}}$.
`profile` decides between profiles of the same statistics: cases with the same number draw from the same
numbers."""

TABLE = """## The table

A row a case, in files of [Parquet](https://parquet.apache.org) in the folder's `cases/`;
`tpss.load_table(folder)` gives it as one table of pandas, by case. What a case does not have is null: a
train that did not arrive has no trip time. Of a run that ended early, energies are those until then.

| status | the case |
|---|---|
| `finished` | ran to its end |
| `collapsed` | ended where the line could not carry its load: a result |
| `stalled` | ended where a train could not continue: a result |
| `invalid` | makes no scenario; `problem` says why |
| `failed` | met a fault of the program; `problem` names it |

Parameters of the study are columns by their key paths behind `set.`, such as
`set.traffic.0.headway_min`."""

INPUTS = {
    "length_km": "length of the line, or of all lines",
    "route_km": "distance that the studied train runs",
    "stops": "stops of the studied train",
    "converter_stations": "number of converter stations",
    "station_distance_km": "mean distance between neighbouring converter stations of a line; null "
    "of one",
    "longest_station_distance_km": "the longest of them",
    "converters": "converters installed in all stations",
    "converters_per_station": "their mean number",
    "converter_rating_mva": "rating of all of them together",
    "catenary": "name in the library, or `own`",
    "catenary_r_ohm_per_km": "resistance of the contact line",
    "catenary_x_ohm_per_km": "its reactance",
    "connection_x_ohm": "reactance between a feeding point and the line; 0 of a BT system",
    "high_voltage_line": "whether there is one",
    "transformers": "transformers between the converter stations",
    "feeding_distance_km": "mean distance between neighbouring stations and transformers",
    "headway_min": "time between departures of the first service; null if they are listed",
    "trains_per_h": "departures of all services with a headway",
    "listed_trains": "trains with listed departures, those of timetables among them",
    "speed_limit_kmh": "highest on the studied train's route, of the line and of the train",
    "mean_speed_limit_kmh": "mean over that route",
    "train_mass_t": "mass of the studied train",
    "max_motor_current_a": "its current limit; null if it has none",
    "gradient_mean_permille": "mean gradient over the line; of a network, here and below, over the "
    "studied train's route",
    "gradient_std_permille": "standard deviation of the gradient over the line",
    "steepest_permille": "steepest rise",
    "starting_gradient_permille": "mean over the first 2 km of the studied train's route",
    "gradient_trend_permille": "rise of the straight line through the gradients, from the line's "
    "beginning to its end",
    "gradient_middle_permille": "how much steeper it is far from converter stations: mean, weighted by "
    "$6u(1-u)$ at the share $u$ of the distance between two of them, less the plain mean; null of one",
    "time_step_min": "time step",
}

MEANINGS = {
    "status": "how the case ended",
    "problem": "why it could not be run, or why its audit failed",
    "collapsed": "whether the line could not carry its load",
    "stalled": "whether a train could not continue",
    "duration_min": "simulated time; of a run that ended early, when it did",
    "steps": "steps carried out",
    "carried_share": "share of the load that a collapsing line could carry, otherwise 1",
    "trip_time_min": "trip time of the studied train",
    "mean_speed_kmh": "its mean speed",
    "total_energy_mwh": "energy of all converter stations",
    "losses_mwh": "losses of the network",
    "converter_losses_mwh": "losses of converter stations; null unless their types describe them",
    "drawn_from_grid_mwh": "energy that stations take from their grids; null likewise",
    "fed_back_to_grid_mwh": "energy that they give back; null unless losses are described, or trains "
    "have electric brakes",
    "braking.braked_mwh": "work of all brakes; this and its parts are null unless trains have electric "
    "brakes",
    "braking.friction_mwh": "part of it: friction brakes",
    "braking.machine_losses_mwh": "part of it: lost in the machines",
    "braking.refused_mwh": "part of it: offered to the line, which does not take it, so that friction "
    "brakes do",
    "braking.rheostat_mwh": "part of it: likewise, and burnt in rheostats of trains",
    "braking.own_use_mwh": "part of it: auxiliaries and motors of the train itself",
    "braking.own_storage_mwh": "of that, what trains put into their own stores",
    "braking.fed_back_mwh": "part of it: what trains feed back into the line",
    "braking.used_by_others_mwh": "of that, what other trains use, and losses of the line",
    "braking.to_stores_mwh": "of that, what stores at the line take",
    "braking.to_grid_mwh": "of that, what stations take back, on the railway's side",
    "braking.burnt_in_stations_mwh": "of that, what resistors of stations burn",
    "thermal.contact_line_use_percent": "highest use of what contact lines bear: thermal state, or "
    "their r.m.s. load over a window, of what is allowed; this and the next four are null unless their "
    "kind of equipment has a `rating`",
    "thermal.transformer_use_percent": "likewise of transformers",
    "thermal.converter_use_percent": "likewise of converters",
    "thermal.rectifier_use_percent": "likewise of rectifiers",
    "thermal.motor_use_percent": "likewise of the motors of a train",
    "thermal.hot_spot_c": "hottest hot spot of a transformer; null unless its rating has `cooling`",
    "thermal.loss_of_life_min": "longest life that the paper of a transformer lost; null likewise",
    "thermal.over": "pieces of equipment beyond what they bear; null unless something has a rating",
    "unbalance_percent": "highest unbalance of a busbar of the grid, as a mean over 10 min, of a "
    "shorter run over all of it; null unless stations tell their `phases`",
    "rail_permanent_v": "highest voltage of rails to earth, as a mean over 300 s; this and the next two "
    "are null unless rails are conductors of their own, this one of a shorter run too",
    "rail_short_v": "highest one in a second or a step",
    "stray_ma_per_m": "highest mean of the current that strays from the rails of a line, over the "
    "length of its tracks; null of an alternating current",
    "trips": "how much equipment tripped; null unless `protection` lets it",
    "tripped": "which, in the order of time; null if nothing did",
    "lowest_voltage_kv": "lowest voltage at a pantograph",
    "lowest_voltage_km": "where it was",
    "lowest_voltage_min": "when it was",
    "mean_useful_voltage_kv": "lowest mean useful voltage of a zone, EN 50388",
    "dimensioning_train_kv": "mean useful voltage of the dimensioning train",
    "peak_power_mw": "highest active power of a station",
    "peak_loading": "highest loading of the running converters of a station",
    "mean_passes": "evaluations of the network in a step, on average",
    "most_passes": "and at most",
    "audit_passed": "whether all figures of the audit are within their limits",
}

EACH = """Each converter station has `station.NAME.` and each service `service.NAME.` with these:

| column | meaning |
|---|---|
| `station.NAME.energy_mwh`, `.reactive_energy_mvarh` | energy fed into the railway |
| `station.NAME.peak_power_mw` | highest active power |
| `station.NAME.mean_loading`, `.peak_loading` | loading of the running converters |
| `service.NAME.arrived` | trains that departed and arrived |
| `service.NAME.mean_trip_min`, `.longest_trip_min` | their trip times |
| `audit.FIGURE` | the [audit's](result.md) figures |
| `limited.WHAT` | what was limited or left its range, in train-steps |"""

MADE = {
    "scenario_hash": "digest of all that the case's scenario says but its name",
    "study_hash": "digest of all that decides what a case is",
    "tpss_version": "version of TPSS",
    "kernel_hash": "digest of the kernels' sources and of numba's version",
    "timing.build_s": "time for scenario and model",
    "timing.run_s": "time for the run and its key figures",
    "timing.ended": "when the case was done",
}


def page() -> str:
    """Text of the page."""
    outputs = [name for name in OUTPUTS if not name.startswith(("audit.", "limited."))]
    groups = {
        frozenset((key, *others)): (key, *others) for key, others in reversed(INSTEAD_OF.items())
    }
    instead = "; ".join(", ".join(map(code, group)) for group in reversed(groups.values()))
    places = ", ".join(code(place).replace('"', "") for place in PLACES)
    return "\n\n".join(
        [
            INTRODUCTION,
            f"One such file is `examples/{EXAMPLE.name}`:",
            f"```toml\n{EXAMPLE.read_text('utf-8')}```",
            "## The whole file",
            _keys(StudyFile),
            PATHS.format(places=places, instead=instead),
            "## What may vary",
            prose(inspect.getdoc(Variation) or ""),
            "A list stands for its values: `[2, 3, 4]` is the same as `{ values = [2, 3, 4] }`.",
            _keys(Variation),
            "## `[gradients]`",
            _keys(Gradients),
            GRADIENTS,
            TABLE,
            "### What the case is",
            described(INPUTS, Inputs._fields, "column"),
            "### What came of it",
            described(MEANINGS, outputs, "column"),
            EACH,
            "### What made it",
            described(MADE, [*MADE_BY, *TIMINGS], "column"),
            "Timings differ from run to run; all else is the same whenever and wherever a case is run.",
        ]
    )


def _keys(part: type[Any]) -> str:
    """Table of a part's keys."""
    rows = [
        (f"`{name}`", _default(field), field.description or "")
        for name, field in part.model_fields.items()
    ]
    return table(("key", "default", "meaning"), rows)


def _default(field: FieldInfo) -> str:
    if field.is_required():
        return "**required**"
    return "" if field.default in (None, "") or field.default == {} else code(field.default)
