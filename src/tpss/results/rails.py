r"""Voltage of the rails to earth, and the current that strays from them.

Between points (nodes, trains) the leakage g of a piece of line is lumped at its ends, as the load flow
has it: from a point at the voltage V the current g V l/2 leaves for each piece that it ends.  On a
direct current what leaves, where V > 0, comes back elsewhere; the mean of what leaves is the stray
current.

References
----------
[EN50122]_, on touch voltages and stray current; the limits are data.
"""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.places import line_names, lines_of, train_lines, where_told
from tpss.results.standards.windows import Floats, highest_means, step_values
from tpss.scenario.scenario import Scenario

RAILS = "rails"
"""Kind of the nodes of rails."""

PERMANENT_S, SHORT_S = 300.0, 1.0
"""Windows whose highest means are held against the limits. [s]"""


def has_rails(dataset: xr.Dataset) -> bool:
    """Whether rails are conductors of their own."""
    return "rail_voltage" in dataset


def rail_voltages(dataset: xr.Dataset, name: str, is_direct: bool) -> Floats:
    """Voltages of rails, shape (steps, ...): of a direct current with their sign. [V]

    Parameters
    ----------
    name : str
        ``rail`` for those at trains, ``node`` for those of all nodes.
    """
    volts = step_values(dataset, f"{name}_voltage")
    return volts * np.cos(step_values(dataset, f"{name}_angle")) if is_direct else volts


def rails(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per place with a node of the rails: their voltage to earth over the run.

    `highest_v` and `lowest_v` are the highest and the lowest voltage in a step, of an alternating
    current its magnitude; `permanent_v` and `short_v` the highest means of the magnitude over 300 s and
    1 s, NaN if the run is shorter, or over a time step where that is longer.  Empty unless rails are
    conductors of their own.
    """
    columns = ("line", "position_km", "highest_v", "highest_at_min", "lowest_v", "permanent_v",
               "short_v")  # fmt: skip
    if not has_rails(dataset) or dataset.sizes["time"] < 2:
        return pd.DataFrame(columns=columns)
    at = np.flatnonzero(dataset.node_kind.to_numpy() == RAILS)
    volts = rail_voltages(dataset, "node", scenario.supply.is_direct)[:, at]
    step_s = float(dataset.attrs["time_step_s"])
    means = {
        name: highest_means(np.abs(volts), max(1.0, width_s / step_s))[0]
        for name, width_s in (("permanent_v", PERMANENT_S), ("short_v", SHORT_S))
    }
    names = line_names(dataset)
    table = where_told(
        {
            "line": [names[line] for line in lines_of(dataset, "node")[at]],
            "position_km": dataset.node_position.to_numpy()[at] / 1e3,
            "highest_v": volts.max(axis=0),
            "highest_at_min": dataset.time.to_numpy()[volts.argmax(axis=0)] / 60.0,
            "lowest_v": volts.min(axis=0),
            **means,
        },
        names,
    )
    order = np.lexsort((table["position_km"], lines_of(dataset, "node")[at]))
    return pd.DataFrame(table).iloc[order].reset_index(drop=True)


def stray_current(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per line: the current that leaves its rails, as a mean over the run.

    `leaving_a` is the mean, `peak_a` the highest of a step, `leaving_ma_per_m` the mean over the length
    of all tracks.  Empty unless rails are conductors of their own on a direct current.
    """
    columns = ("line", "leaving_a", "peak_a", "leaving_ma_per_m")
    if not has_rails(dataset) or not scenario.supply.is_direct or dataset.sizes["time"] < 2:
        return pd.DataFrame(columns=columns)
    names, rows = line_names(dataset), []
    for number, line in enumerate(scenario.lines_by_name.values()):
        leaving = _leaving_a(number, dataset, scenario)
        tracks_m = sum((end - begin) * count * 1e3 for begin, end, count in line.tracks_by_stretch)
        mean = float(leaving.mean())
        rows.append((names[number], mean, float(leaving.max()), 1e3 * mean / tracks_m))
    table = {
        name: list(column) for name, column in zip(columns, zip(*rows, strict=True), strict=True)
    }
    return pd.DataFrame(where_told(table, names))


def _leaving_a(number: int, dataset: xr.Dataset, scenario: Scenario) -> Floats:
    """Current that leaves the rails of a line for the earth, in each step, shape (steps,). [A]"""
    of_line = (dataset.node_kind.to_numpy() == RAILS) & (lines_of(dataset, "node") == number)
    node_m = dataset.node_position.to_numpy()[of_line]
    node_v = rail_voltages(dataset, "node", True)[:, of_line]
    train_v = rail_voltages(dataset, "rail", True)
    train_m = dataset.position.to_numpy()[:-1]
    there = np.isfinite(train_v) & (train_lines(dataset)[:-1] == number)
    g_s_per_m = _leakage_of(number, scenario)
    found = np.empty(len(node_v))
    for k in range(len(node_v)):
        at_m = np.concatenate([node_m, train_m[k, there[k]]])
        order = np.argsort(at_m, kind="stable")
        place_m, volts = at_m[order], np.concatenate([node_v[k], train_v[k, there[k]]])[order]
        piece_s = np.diff(place_m) * g_s_per_m(0.5 * (place_m[1:] + place_m[:-1]))
        half_s = 0.5 * (np.append(piece_s, 0.0) + np.append(0.0, piece_s))
        found[k] = float((half_s * np.maximum(volts, 0.0)).sum())
    return found


def _leakage_of(number: int, scenario: Scenario) -> Any:
    """Leakage of all tracks of a line at places [m], as a function. [S/m]"""
    line = list(scenario.lines_by_name.values())[number]
    conductors = scenario.supply.conductors
    of_track = 0.0 if conductors is None else conductors.leakage_s_per_km / 1e3
    stretches = list(line.tracks_by_stretch)
    ends_m = np.array([end for _, end, _ in stretches[:-1]]) * 1e3
    counts = np.array([count for _, _, count in stretches], dtype=float)
    return lambda place_m: of_track * counts[np.searchsorted(ends_m, place_m, side="right")]
