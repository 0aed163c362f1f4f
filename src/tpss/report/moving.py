"""What a page needs to move the trains of a network over its plan."""

from typing import Any

import numpy as np

from tpss.model.routes import routes_of
from tpss.report.drawings.journey import rise_ahead
from tpss.report.drawings.network import track_rows
from tpss.report.layout import layout
from tpss.report.sampling import FEWEST, MOST_OF_TRAINS, Floats, kept, rounded
from tpss.results.places import train_lines, train_tracks
from tpss.results.result import Result

DIGITS = 3
"""Of kilometres, kilovolts, and places across the plan."""


def network_moving(result: Result, most_of_all: int = MOST_OF_TRAINS) -> dict[str, Any]:
    """The plan's lines, and the trains by their lines, kilometres on them and tracks.

    Of each train there are the columns of `tpss.report.sampling.sample_trains`, the index of its line,
    how far its track is beside the middle of that, the way since it began, and the gradient ahead.
    Where it changes its line, both steps are there.
    """
    data, scenario = result.dataset, result.scenario
    line_of, way_km = train_lines(data), data.route_position.to_numpy() / 1e3
    columns = {
        "km": data.position.to_numpy() / 1e3,
        "kmh": data.speed.to_numpy() * 3.6,
        "kv": data.pantograph_voltage.to_numpy() / 1e3,
        "aside": _aside(result),
    }
    routes = dict(zip((each.name for each in scenario.traffic), routes_of(scenario), strict=True))
    seen = np.flatnonzero(np.isfinite(way_km).any(axis=0))
    most = max(FEWEST, most_of_all // max(len(seen), 1))
    trains, thinned = [], False
    for i in seen:
        steps = np.flatnonzero(np.isfinite(way_km[:, i]))
        few = steps[kept([columns[name][steps, i] for name in ("kmh", "kv")], most)]
        thinned = thinned or len(few) < len(steps)
        changes = steps[:-1][np.diff(line_of[steps, i]) != 0]
        few = np.unique(np.concatenate([few, changes, changes + 1]))
        route = routes[str(data.service.to_numpy()[i])]
        rise = rise_ahead(scenario, route, 1e3 * way_km[few, i])
        trains.append(
            {
                "name": str(data.train.to_numpy()[i]),
                "step": few.tolist(),
                "line": line_of[few, i].tolist(),
                "way": rounded(way_km[few, i] - way_km[steps[0], i], DIGITS),
                "permille": rounded(1e3 * rise, DIGITS),
                **{name: rounded(values[few, i], DIGITS) for name, values in columns.items()},
            }
        )
    paths = layout(scenario)
    lines = [
        {"name": name, **{axis: getattr(path, axis).tolist() for axis in ("km", "x", "y")}}
        for name, path in paths.items()
    ]
    return {"lines": lines, "trains": trains, "thinned": thinned}


def _aside(result: Result) -> Floats:
    """By how much the tracks of trains are beside the middle of their lines. [rows]"""
    data = result.dataset
    km, line_of, tracks = data.position.to_numpy() / 1e3, train_lines(data), train_tracks(data)
    aside: Floats = np.zeros_like(km)
    for k, line in enumerate(result.scenario.lines_by_name.values()):
        here = line_of == k
        aside[here] = track_rows(line, km[here], tracks[here])
    return aside
