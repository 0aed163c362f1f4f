"""The page of the result: its files, variables, tables and figures, from a run."""

import inspect
import re
from pathlib import Path

import numpy as np
from markdown_pieces import code, described, prose, table

import tpss
from tpss.audit.verdict import Audit, limits_of
from tpss.model import build_model
from tpss.results import tables

EXAMPLE = Path(__file__).parents[2] / "examples" / "thesis_160km.toml"

INTRODUCTION = """# Result

`tpss run` writes a result into a folder; `tpss.simulate` gives the same as a
[`Result`](python.md#tpss.Result), and `tpss.load_result` reads a folder back. [Read a
result](../how-to/read-a-result.md) shows how to work with it, the
[nomenclature](../nomenclature.md) says what stands behind the names.

## Files

| file | what |
|---|---|
| `result.nc` | the dataset: everything that was recorded, at every step (NetCDF 4) |
| `summary.json` | key figures, the audit, versions and platform |
| `scenario.toml` | the scenario as run, with all defaults and library values; it can be run again |

A folder is written whole or not at all. `--force` replaces a result folder, and nothing but a
result folder. [`tpss export`](command_line.md#tpss-export) adds a folder `tables` with files for
spreadsheets.

A result says in which version of this format it is written (`result_format`). A version of TPSS
that does not read it says so; the scenario in the folder can be run again."""

DATASET = """## Dataset

`Result.dataset` is an [xarray](https://docs.xarray.dev) dataset. Times run from the start of the
simulation, in steps: K steps have K + 1 instants. The last step may be shorter, as a run ends with the
arrival of its studied train (`last_step_s`). A **state** holds at the instant. An **interval** value
holds from that instant to the next, as a mean where a train's forces change within the step, so it is
NaN at the last one. A train that is not
on the line is NaN; its `train_state` is -1. Each variable carries its unit (`units`) and its
meaning (`long_name`)."""

STATES = "`train_state` has the values"

TABLES = """## Tables

`Result.trips`, `Result.stops`, `Result.stations` and `Result.train_steps` are pandas tables; those of
`Result.standards` stand on [a page of their own](evidence.md). What a train has not done yet, or not
within the run, is NaN. With `simulation.starts_at` the stops have their times by the clock too, in
columns named `arrival_clock`, `departure_clock`, `scheduled_arrival_clock` and
`scheduled_departure_clock`."""

TRIPS = {
    "train": "name",
    "service": "traffic entry that the train belongs to",
    "departure_min": "departure; NaN for a train that was on the line at the start",
    "arrival_min": "arrival at its destination",
    "trip_min": "from departure to arrival",
    "distance_km": "distance within the run",
    "mean_speed_kmh": "distance over the time on the line, stops included",
    "energy_mwh": "active energy drawn at the pantograph",
    "lowest_voltage_kv": "lowest voltage at the pantograph",
    "lowest_voltage_km": "... and where",
    "lowest_voltage_min": "... and when",
}
STOPS = {
    "train": "name",
    "station": "where it begins, stops, passes or ends",
    "position_km": "position on the line",
    "kind": "which of these: `start`, `stop`, `pass` or `end`",
    "arrival_min": "when it came to stand, or passed; NaN where it begins",
    "departure_min": "when it went on, or passed; NaN where it ends",
    "dwell_min": "from one to the other",
    "scheduled_arrival_min": "when it should have; NaN where nothing is scheduled or known",
    "scheduled_departure_min": "when it should have gone on, likewise",
    "late_min": "arrival, or departure where no arrival is scheduled, after its time; early: negative",
}
STATIONS = {
    "station": "name",
    "position_km": "position on the line",
    "energy_mwh": "active energy fed into the railway",
    "reactive_energy_mvarh": "reactive energy fed into the railway",
    "peak_power_mw": "highest active power of a step",
    "mean_loading": "mean of the running units' apparent power over their rating",
    "peak_loading": "highest of these loadings",
    "mean_converters": "mean number of units running",
}
THERMAL = {
    "element": "name",
    "kind": "`contact line`, `converter`, `transformer` or `motors`",
    "position_km": "position on the line; NaN of motors",
    "start_load_percent": "load in whose steady state it begins",
    "start": "where that comes from: `r.m.s. load of the run` or `preload_percent`",
    "highest_state_percent": "highest thermal state",
    "allowed_state_percent": "... and the highest one that is allowed",
    "state_at_min": "... and when it is highest",
    "highest_temperature_c": "highest temperature, of a transformer that of its hot spot; NaN where "
    "none is known",
    "allowed_temperature_c": "... and the highest one that is allowed",
    "loss_of_life_min": "life that the paper of a transformer with `cooling` lost",
    "window_min": "window in which its r.m.s. load comes closest to what is allowed; NaN without one",
    "highest_rms_percent": "highest r.m.s. load over that window",
    "allowed_rms_percent": "... and the one that is allowed",
    "from_min": "... and when the window begins",
    "verdict": "`within` or `over` what it bears",
    "trains": "trains that drew the most near it at that time",
}
THERMAL_WINDOWS = {
    "element": "name",
    "kind": "as above",
    "window_min": "length of the window: 1, 5, 15, 30, 60 or 120 min, or that of an overload",
    "highest_rms_percent": "highest r.m.s. load over it; NaN where the run is shorter",
    "allowed_rms_percent": "the one that is allowed; NaN where none is judged",
    "from_min": "when the window begins",
}
TRAIN_STEPS = {
    "train": "name",
    "service": "traffic entry that the train belongs to",
    "time_min": "time from the start",
    "state": "name of its `train_state`; empty at the last instant of the run",
    **{column: f"`{name}`" for column, name in tables.TRAIN_STEPS.items()},
}
SUMMARY = {
    "result_format": "version of the format in which the result is written",
    "name": "of the scenario",
    "description": "of the scenario",
    "status": "`finished`, `collapsed` (the line cannot carry its load), `stalled`, `deadlocked` "
    "(trains wait for each other) or `interrupted`",
    "time_step_min": "time step",
    "duration_min": "simulated time",
    "studied_train": "first departure of the first traffic entry; its arrival ends the run by default",
    "trip_time_min": "its time from departure to arrival, or null",
    "station_energy_mwh": "active energy of each feeding station",
    "total_energy_mwh": "their sum",
    "losses_mwh": "losses of contact line, transformers and high-voltage line, not those in stations",
    "lowest_voltage": "lowest voltage at a pantograph: `voltage_kv`, `train`, `position_km`, `time_min`",
    "load_flow_passes": "evaluations of the network a step: `mean` and `most`",
    "limited": "train-steps in which a model was limited or left its range",
    "audit": "figures of the audit, below",
    "step_choice": "how the time step was chosen, if the scenario gave none, below",
    "step_check": "what moves at half the time step, below",
    "lost_time": "what trains that arrived lost to the voltage, below",
    "simulation_s": "computing time of the simulation",
    "standards": "key figures of the [evidence for standards](evidence.md)",
    "provenance": "versions, platform and time of the run",
    "thermal": "only where something has a [rating](../how-to/thermal.md): how many pieces of equipment "
    "are `judged`, how many are `over`, and the figures of the table `thermal` for each (`elements`), "
    "the one that comes closest to what it bears, or is beyond it, first",
}
OF_LOSSES = {
    "converter_losses": "only where types of converters describe what they lose: totals of the table of "
    "that name, the `origins` of the losses, losses by `stations`, and those `not_described`",
}
TRANSFORMER_LOSSES = {
    "station": "transformer station",
    "from_grid_mwh": "energy from the grid, at the terminals of the transformers",
    "to_grid_mwh": "energy to it",
    "burnt_mwh": 'energy that a station with `feedback = "resistor"` burns: what would go to the grid',
    "load_mwh": "lost in the windings of its transformers, included in what is taken or given",
    "no_load_mwh": "lost by its transformers without load, likewise",
    "grid_mwh": "lost in the resistance of the grid before the terminals, not included; below 0 where "
    "currents of another station at the busbar return by it",
}
RAILS = {
    "line": "line, where there are several",
    "position_km": "place of a node of the rails",
    "highest_v": "highest voltage to earth in a step, of an alternating current its magnitude",
    "highest_at_min": "when that is",
    "lowest_v": "lowest one",
    "permanent_v": "highest mean of its magnitude over 300 s; NaN where the run is shorter",
    "short_v": "the same over a second, or over a step where that is longer",
}
STRAY_CURRENT = {
    "line": "line, where there are several",
    "leaving_a": "mean current that leaves its rails for the earth; as much comes back elsewhere",
    "peak_a": "the highest of a step",
    "leaving_ma_per_m": "the mean per length of all tracks",
}
AUTOTRANSFORMERS = {
    "line": "line, where there are several",
    "position_km": "where it stands",
    "highest_winding_a": "highest current of its windings",
    "highest_neutral_a": "highest current of its neutral, which leads to the rails",
    "peak_loading": "current of the neutral over that at rated power",
    "rms_15_min_loading": "highest r.m.s. value of that over 15 min",
    "rms_60_min_loading": "over 1 h; NaN where the run is shorter",
}
CONVERTER_LOSSES = {
    "station": "converter station",
    "from_grid_mwh": "energy from the 50 Hz grid",
    "to_grid_mwh": "energy to it",
    "burnt_mwh": 'energy that a station with `feedback = "resistor"` burns: what would go to the grid',
    "losses_mwh": "losses of converters, and auxiliaries",
    "idle_mwh": "of these, what converters lose without load",
    "by_load_mwh": "what their load adds",
    "auxiliaries_mwh": "auxiliaries of the station",
    "mean_efficiency": "what leaves the station, to either side, over what it is given",
    "starts": "converters started within the run",
    "peak_from_grid_mw": "highest power from the grid in a time step",
    "peak_1_min_mw": "highest mean over 1 min",
    "peak_15_min_mw": "over 15 min",
    "peak_1_h_mw": "over 1 h; NaN where the run is shorter",
    "origin": "where the losses come from: `estimate`, `measurement`, or not told",
}
EARLY_END = {
    "problem": "only after an early end: when and where it came, in words",
    "advice": "only after an early end: what would help",
}
ATTRIBUTES = {
    "result_format": "as in the summary",
    "title": "name of the scenario",
    "status": "as in the summary",
    "time_step_s": "time step",
    "last_step_s": "length of the last step",
    "trip_time_min": "as in the summary, or NaN",
    "station_energy_mwh": "in the order of `station`",
    "losses_mwh": "as in the summary",
    "audit": "as in the summary, as JSON",
}
STEP = """### `step_choice` and `step_check`

A scenario without `simulation.time_step_min` is run with the longest of 1, 0.5, 0.2, 0.1, 0.05, 0.02
and 0.01 min whose trips and energies keep within 0.3 % of the run at half of it (`largest_share`), and
whose lowest voltage and peak loading within 0.6 %. `step_choice` says which ones were tried
(`tried_min`), and whether the one that was taken is that close (`within`); it is null if the scenario
gives its step.

`step_check` compares the run with the same run at half its step. It is null if it was not asked for
(`--no-step-check`; `tpss.simulate` makes it with `step_check=True`).

`lost_time` compares the run with the same run at the highest no-load voltage of its stations at all
pantographs, whatever trains draw: `voltage_kv`, the `trains` that arrived in both, the minutes that they
were later in all (`total_min`), and the one that lost most (`worst_train`, `worst_min`). Null where none
arrived, or it was not asked for (`tpss run` asks; `tpss.simulate` with `lost_time=True`)."""

STEP_CHECK = {
    "half_step_min": "half the time step",
    "status": "status of the run with it",
    "duration_min": "simulated time of that run",
    "changes": "what moves, a list, below",
    "within": "whether both runs end alike, and all changes are within their limits",
    "tried_min": "shorter steps that were tried, if this one is too long: up to three halvings",
    "would_do_min": "the longest of them that is within the limits of its own half, or null",
    "not_made": "why there is no check, or null",
}
CHANGE = {
    "figure": "`trip_time_min` (of the studied train), `mean_trip_min` (of a service), "
    "`total_energy_mwh`, `energy_mwh` (of a station), `lowest_voltage_kv` or `peak_loading` (of the "
    "station that is loaded most); of runs that end early alike, `duration_min`",
    "of": "name of the train, service or station; empty for the whole run",
    "at_step": "the figure of the run",
    "at_half_step": "the figure at half the step",
    "share": "change over the figure itself; of a voltage, over its drop from the highest "
    "`no_load_voltage_kv`, at least 1 % of that; of energies, over the total; "
    "of an end, over a hundred steps at least",
    "limit": "largest share of a step that is short enough: 0.01, and 0.02 of voltage and loading",
    "within": "whether the share is within the limit",
}
AUDIT = """## Audit

Every run audits itself: from the recorded voltages it forms the currents and powers once more, in a
different way from the solver, and it checks energy balances, forces and motion. A figure beyond its
limit makes `tpss run` end with exit code 4. The limits of a run stand in `limits`, and those below
are the usual ones: over impedances of some microohms, such as between feeding points a few metres
apart, rounding alone is a visible mismatch, and the limits of power mismatch, converters and network
balance grow with it. With `power_sampling = "start"` the traction balance
does not close; it is reported but not judged."""


def page() -> str:
    """Text of the page."""
    rating = {"continuous_a": 467.0, "time_constant_min": 4.7}
    changes = {
        "simulation.until": None,
        "simulation.duration_min": 5.0,
        "supply.catenary": {"r_ohm_per_km": 0.21, "x_ohm_per_km": 0.2, "rating": rating},
    }
    result = tpss.simulate(tpss.load_scenario(EXAMPLE, changes), step_check=True)
    check = result.summary["step_check"]
    provenance = dict.fromkeys(result.summary["provenance"], "as in the summary's `provenance`")
    attributes = {**ATTRIBUTES, **provenance}
    blocks = [
        INTRODUCTION,
        DATASET,
        _variables(result),
        f"{STATES} {_flags(result)}.",
        "Coordinates:",
        _coordinates(result),
        "Attributes:",
        described(attributes, result.dataset.attrs, "attribute"),
        TABLES,
        "### `trips`, a row a train",
        described(TRIPS, result.trips, "column"),
        "### `stops`, a row a train and station of its route where it stops",
        described(STOPS, result.stops, "column"),
        "### `stations`, a row a feeding station",
        described(STATIONS, result.stations, "column"),
        "### `converter_losses`, a row a converter station that describes losses",
        described(CONVERTER_LOSSES, result.converter_losses, "column"),
        "### `transformer_losses`, a row a transformer station that tells its losses without load",
        described(TRANSFORMER_LOSSES, result.transformer_losses, "column"),
        "### `rails`, a row a place, where rails are [conductors of their own](../how-to/rails.md)",
        described(RAILS, result.rails, "column"),
        "### `stray_current`, a row a line, where besides the current is direct",
        described(STRAY_CURRENT, result.stray_current, "column"),
        "### `autotransformers`, a row an autotransformer",
        described(AUTOTRANSFORMERS, result.autotransformers, "column"),
        "### `thermal`, a row a piece of equipment with a [rating](../how-to/thermal.md)",
        described(THERMAL, result.thermal, "column"),
        "### `thermal_windows`, a row a piece of equipment with a rating and window",
        described(THERMAL_WINDOWS, result.thermal_windows, "column"),
        "### `train_steps`, a row a train and instant",
        described(TRAIN_STEPS, result.train_steps, "column"),
        "## Summary",
        "`Result.summary` is a dictionary, and the content of `summary.json`.",
        described(
            {**SUMMARY, **OF_LOSSES, **EARLY_END},
            {**result.summary, **OF_LOSSES, **EARLY_END},
            "key",
        ),
        STEP,
        described(STEP_CHECK, check, "key"),
        "Each of its `changes`:",
        described(CHANGE, check["changes"][0], "key"),
        AUDIT,
        _audit(result.scenario),
    ]
    return "\n\n".join(blocks)


def _variables(result: tpss.Result) -> str:
    rows = []
    for name, variable in result.dataset.data_vars.items():
        dims = ", ".join(f"`{dim}`" for dim in variable.dims)
        texts = (variable.attrs["units"], variable.attrs["long_name"])
        rows.append((f"`{name}`", dims, texts[0], _kind(variable.to_numpy()), texts[1]))
    return table(("variable", "dimensions", "unit", "kind", "meaning"), rows)


def _kind(values: np.ndarray) -> str:
    """Kind of a variable; only a state has values at the last instant."""
    at_the_end = np.isfinite(values[-1]) & (values.dtype.kind == "f")
    return "state" if at_the_end.any() else "interval"


def _flags(result: tpss.Result) -> str:
    meanings = result.dataset.train_state.attrs["flag_meanings"].split()
    return ", ".join(f"{value} {name}" for value, name in enumerate(meanings))


def _coordinates(result: tpss.Result) -> str:
    rows = [
        (
            f"`{name}`",
            ", ".join(f"`{dim}`" for dim in values.dims),
            values.attrs["units"],
            values.attrs["long_name"],
        )
        for name, values in result.dataset.coords.items()
    ]
    return table(("coordinate", "dimensions", "unit", "meaning"), rows)


def _audit(scenario: tpss.Scenario) -> str:
    """Table of the audit's figures from their docstring, with their limits in a run of a scenario."""
    limit_of, text = limits_of(build_model(scenario)[0]), inspect.getdoc(Audit) or ""
    figures = re.findall(r"^(\w[\w, ]*) : .*\n((?:    .*(?:\n|$))+)", text, re.MULTILINE)
    rows = []
    for names, meaning in figures:
        limits = ", ".join(f"{limit_of[name]:g}" for name in names.split(", ") if name in limit_of)
        marked = ", ".join(code(name).replace('"', "") for name in names.split(", "))
        rows.append((marked, limits, prose(" ".join(meaning.split()))))
    rows.append(("`passed`", "", "Whether every figure is within its limit."))
    return table(("figure", "limit", "meaning"), rows)
