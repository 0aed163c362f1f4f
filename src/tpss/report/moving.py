"""What a page needs to move the trains of a network over its plan."""

from typing import Any

import numpy as np

from tpss.report import sampling
from tpss.report.drawings.network import track_rows
from tpss.report.layout import layout
from tpss.report.sampling import Floats
from tpss.results.places import TRACK, line_names, train_lines, train_tracks
from tpss.results.result import Result

DIGITS = 3
"""Of places along the plan and across it."""


def network_moving(result: Result) -> dict[str, Any]:
    """The plan's lines, and the trains by their lines, kilometres on them and tracks.

    Of each train there are the columns of `tpss.report.sampling.sample_trains`, the index of its line,
    and how far its track is beside the middle of that; where it changes its line, both steps are there.
    """
    data, scenario = result.dataset, result.scenario
    names, line_of = line_names(data), train_lines(data)
    km, kmh = data.position.to_numpy() / 1e3, data.speed.to_numpy() * 3.6
    kv = data.pantograph_voltage.to_numpy() / 1e3
    seen = np.flatnonzero(np.isfinite(km).any(axis=0))
    most = max(sampling.FEWEST, sampling.MOST_OF_TRAINS // max(len(seen), 1))
    aside = _aside(result, km) if TRACK in data else np.zeros_like(km)
    trains, thinned = [], False
    for i in seen:
        there = np.isfinite(km[:, i])
        few, left_out = sampling.sampled_steps(there, (kmh[:, i], kv[:, i]), most)
        steps = np.flatnonzero(there)
        changes = np.flatnonzero(np.diff(line_of[steps, i]))
        few = np.unique(np.concatenate([few, steps[changes], steps[changes + 1]]))
        thinned = thinned or left_out
        trains.append(
            {
                "name": str(data.train.to_numpy()[i]),
                "step": few.tolist(),
                "line": line_of[few, i].tolist(),
                "km": np.round(km[few, i], DIGITS).tolist(),
                "kmh": np.round(kmh[few, i], 1).tolist(),
                "kv": [
                    None if np.isnan(each) else round(each, DIGITS) for each in kv[few, i].tolist()
                ],
                "aside": np.round(aside[few, i], DIGITS).tolist(),
            }
        )
    paths = layout(scenario)
    lines = [
        {"name": name, **{axis: getattr(paths[name], axis).tolist() for axis in ("km", "x", "y")}}
        for name in names
    ]
    return {"lines": lines, "trains": trains, "thinned": thinned}


def _aside(result: Result, km: Floats) -> Floats:
    """By how much the tracks of trains are beside the middle of their lines. [rows]"""
    data, aside = result.dataset, np.zeros_like(km)
    line_of, tracks = train_lines(data), train_tracks(data)
    for k, name in enumerate(line_names(data)):
        here = line_of == k
        line = result.scenario.lines_by_name[name]
        aside[here] = track_rows(line, km[here], tracks[here])
    return aside
