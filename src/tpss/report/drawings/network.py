"""The network as a plan: lines, tracks, stations, what feeds them, and the lowest voltage along them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tpss.report.contact_line import line_voltage
from tpss.report.corridor import on_line, separate_tracks
from tpss.report.drawings import parts
from tpss.report.drawings.time_distance import colour_range
from tpss.report.layout import Path, layout
from tpss.report.palette import BLACK, COLOURS
from tpss.report.sampling import Floats
from tpss.results.result import Result
from tpss.scenario.line import Line
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply.transformers import transformer_positions_km
from tpss.units import kilometres

GAP_ROWS = 0.08
"""Distance of the tracks of a line."""

BELOW_ROWS = -0.3
"""Place of feeding stations and of the high-voltage line, seen from the railway line."""

POINTS_A_ROW = 50
"""Points of a slanted part of a line, which are farther apart in the plan than those of level parts."""

LABELS_ACROSS = 45
"""Names of stations that fit side by side; of closer ones the first is shown."""

WIDTH = 2.6
"""Of the contact line."""

LABEL = "lowest voltage [kV]"

Paths = Mapping[str, Path]


def network(result: Result, *, with_trains: bool = False) -> parts.Drawing:
    """Plan of a run's lines, coloured by the lowest voltage of the run.

    Each line is true to length, without its course over the ground.  The axis has the kilometres of the
    longest one, which is drawn level.

    Parameters
    ----------
    result : Result
        With a time step at least.
    with_trains : bool
        Whether to add the trains in the first time step, as the last item, which a page moves.
    """
    scenario = result.scenario
    paths = layout(scenario)
    contact_lines, colours = _contact_lines(result, paths)
    items: list[parts.Item] = [
        *_high_voltage_line(result, paths),
        # An edge, so that the darkest colours are seen on a dark page too.
        parts.Curve(contact_lines.x, contact_lines.y, colour=BLACK, width=WIDTH + 0.9),
        contact_lines,
        *_switches(result, paths),
        *_stations(result, paths),
        *_feeding_stations(result, paths),
        *_names_of_lines(result, paths),
    ]
    if with_trains:
        items.append(_trains(colours))
    low, high = _ends(paths, 1)
    span_y = low - 0.75, high + 0.75
    panel = parts.Panel("", items, span=span_y, bare=True)
    left, right = _ends(paths, 0)
    margin = 0.04 * (right - left)
    lines = scenario.lines_by_name
    longest = max(lines, key=lambda name: lines[name].length_km)
    axis = parts.POSITION if len(lines) == 1 else f"position on {longest} [km]"
    height_inch = 1.2 * (span_y[1] - span_y[0])
    return parts.Drawing(axis, [panel], (left - margin, right + margin), panel_inch=height_inch)


def rows_of(drawing: parts.Drawing) -> float:
    """Height of a plan in rows."""
    low, high = drawing.panels[0].span or (0.0, 1.0)
    return high - low


def _ends(paths: Paths, axis: int) -> tuple[float, float]:
    values = np.concatenate([(path.x, path.y)[axis] for path in paths.values()])
    return float(values.min()), float(values.max())


def _spread(paths: Paths, places: Sequence[tuple[str, float]]) -> tuple[Floats, Floats]:
    """Places of positions on lines, along and across the plan."""
    points = [paths[line].at(km) for line, km in places]
    x, y = np.array(points, dtype=float).reshape(-1, 2).T
    return x, y


def track_rows(line: Line, place_km: Floats, track: Floats | int) -> Floats:
    """By how much a track is drawn beside the middle of its line at some places. [rows]"""
    count = np.ones_like(place_km)
    for begin_km, end_km, tracks in line.tracks_by_stretch:
        count = np.where((place_km >= begin_km) & (place_km <= end_km), tracks, count)
    return np.asarray(GAP_ROWS * (0.5 * (count - 1.0) - (np.minimum(track, count) - 1.0)))


def _contact_lines(result: Result, paths: Paths) -> tuple[parts.Curve, parts.Colours]:
    """The contact line of every track, one after another, with a gap after each, and its colours."""
    tracks = [
        _track(result, name, track, path)
        for name, path in paths.items()
        for track in range(1, result.scenario.lines_by_name[name].most_tracks + 1)
    ]
    gap = np.array([np.nan])
    x, y, kv = (
        np.concatenate([part for each in tracks for part in (each[k], gap)]) for k in range(3)
    )
    words = [word for each in tracks for word in (*each[3], "")]
    colours = parts.Colours(kv, LABEL, *colour_range(kv))
    return parts.Curve(x, y, width=WIDTH, words=words, colours=colours), colours


def _track(
    result: Result, name: str, track: int, path: Path
) -> tuple[Floats, Floats, Floats, list[str]]:
    """Places along and across the plan, voltages [kV] and words of the contact line of a track."""
    line = result.scenario.lines_by_name[name]
    voltage = line_voltage(on_line(result, name, track))
    if voltage is None:
        raise ValueError("no time step was simulated, so there is no voltage")
    slanted = [
        np.linspace(path.km[k], path.km[k + 1], 2 + int(POINTS_A_ROW * rows))
        for k, rows in enumerate(np.abs(np.diff(path.y)).tolist())
    ]
    km = np.unique(np.concatenate([voltage.position_km, *slanted]))
    lowest_kv = np.interp(km, voltage.position_km, voltage.lowest_kv)
    x, y = path.at(km)
    there = _has_track(line, km, track)
    what = f"{name} km" if len(result.scenario.lines_by_name) > 1 else "km"
    which = f", track {track}" if separate_tracks(result.scenario, name) else ""
    words = [
        f"{what} {place:.1f}{which}: {lowest:.2f} kV"
        for place, lowest in zip(km.tolist(), lowest_kv.tolist(), strict=True)
    ]
    kv = np.where(there, lowest_kv, np.nan)
    return np.where(there, x, np.nan), y + track_rows(line, km, track), kv, words


def _has_track(line: Line, place_km: Floats, track: int) -> npt.NDArray[np.bool_]:
    there = np.zeros(place_km.shape, dtype=bool)
    for begin_km, end_km, tracks in line.tracks_by_stretch:
        there |= (place_km >= begin_km) & (place_km <= end_km) & (track <= tracks)
    return there


def _stations(result: Result, paths: Paths) -> Iterator[parts.Places]:
    """Passenger stations, each once, and those where lines meet as junctions."""
    stands = _stands(result.scenario)
    labelled = _labelled(stands, paths)
    kinds = {
        False: ("station", parts.DOT, False),
        True: ("junction", parts.RING, True),
    }
    for junction, (kind, symbol, hollow) in kinds.items():
        chosen = {name: at for name, at in stands.items() if (len(at) > 1) == junction}
        if not chosen:
            continue
        x, y = _spread(paths, [at[0] for at in chosen.values()])
        words = [_where(name, at, len(paths) > 1) for name, at in chosen.items()]
        labels = [name if name in labelled else "" for name in chosen]
        yield parts.Places(
            x, y, kind, symbol, COLOURS[BLACK], words, labels=labels, hollow=hollow
        )  # fmt: skip


def _stands(scenario: Scenario) -> dict[str, list[tuple[str, float]]]:
    """Lines and positions of the stations, by their names. [km]"""
    stands: dict[str, list[tuple[str, float]]] = {}
    for name, line in scenario.lines_by_name.items():
        for station in line.stations:
            stands.setdefault(station.name, []).append((name, station.position_km))
    return stands


def _where(name: str, at: list[tuple[str, float]], several: bool) -> str:
    places = [
        f"{line} km {kilometres(km)}" if several else f"km {kilometres(km)}" for line, km in at
    ]
    return f"{name}: {', '.join(places)}"


def _labelled(stands: dict[str, list[tuple[str, float]]], paths: Paths) -> set[str]:
    """Stations whose names are shown: junctions first, and of others those that leave them legible."""
    left, right = _ends(paths, 0)
    closest_km = (right - left) / LABELS_ACROSS
    shown: dict[str, tuple[float, float]] = {}
    for name, at in sorted(stands.items(), key=lambda each: len(each[1]) == 1):
        x, y = paths[at[0][0]].at(at[0][1])
        if all(abs(x - other) >= closest_km or abs(y - row) > 0.5 for other, row in shown.values()):
            shown[name] = (float(x), float(y))
    return set(shown)


def _feeding_stations(result: Result, paths: Paths) -> Iterator[parts.Item]:
    """Feeding stations below their places, with their peak loading."""
    stations, table = result.scenario.supply.stations, result.stations.set_index("station")
    fed = [(result.scenario.line_of(each), each.position_km) for each in stations]
    x, y = _spread(paths, fed)
    yield _ties(x, y)
    words, labels = [], []
    for station in stations:
        peak, power = table.peak_loading[station.name], table.peak_power_mw[station.name]
        words.append(f"{station.name}: peak loading {peak:.0%}, peak power {power:.1f} MW")
        labels.append(f"{station.name}\n{100.0 * peak:.0f} %")
    y, name = y + BELOW_ROWS, "feeding station, peak loading"
    yield parts.Places(x, y, name, parts.SQUARE, COLOURS[0], words, labels=labels, above=False)


def _names_of_lines(result: Result, paths: Paths) -> Iterator[parts.Places]:
    """Names of several lines, each below its longest straight part, where nothing else is below it."""
    if len(paths) == 1:
        return
    scenario = result.scenario
    below = [(scenario.line_of(each), each.position_km) for each in scenario.supply.stations]
    below += [at[0] for at in _stands(scenario).values() if len(at) > 1]
    below_x, below_y = _spread(paths, below)
    shares, places = np.array([0.5, 0.35, 0.65, 0.2, 0.8]), []
    for name, path in paths.items():
        k = int(np.diff(path.km).argmax())
        km = path.km[k] + shares * (path.km[k + 1] - path.km[k])
        x, y = path.at(km)
        near = np.abs(below_y - y[:, None]) < 0.5
        free = np.where(near, np.abs(below_x - x[:, None]), np.inf).min(axis=1)
        places.append((name, float(km[free.argmax()])))
    x, y = _spread(paths, places)
    words = [f"line {name}" for name in paths]
    yield parts.Places(
        x, y, "", parts.NO_SYMBOL, COLOURS[BLACK], words, labels=words, above=False
    )  # fmt: skip


def _ties(x: Floats, y: Floats) -> parts.Curve:
    """What ties the contact line to what stands below it."""
    gap = np.full_like(x, np.nan)
    below = np.stack([y, y + BELOW_ROWS, gap], axis=1)
    return parts.Curve(np.repeat(x, 3), below.ravel(), colour=BLACK, width=0.7)


def _high_voltage_line(result: Result, paths: Paths) -> Iterator[parts.Item]:
    """The high-voltage line below its railway line, and its transformers."""
    supply, scenario = result.scenario.supply, result.scenario
    if supply.high_voltage_line is None:
        return
    name = scenario.line_of(supply.high_voltage_line)
    path, transformers = paths[name], sorted(transformer_positions_km(supply))
    stations = [s.position_km for s in supply.stations if scenario.line_of(s) == name]
    stands = np.array(sorted({*transformers, *stations}))
    corners = path.km[(path.km > stands[0]) & (path.km < stands[-1])]
    x, y = path.at(np.sort(np.concatenate([stands, corners])))
    yield parts.Curve(x, y + BELOW_ROWS, "high-voltage line", BLACK, parts.DASHED)
    if transformers:
        x, y = path.at(np.array(transformers))
        yield _ties(x, y)
        words = [f"transformer at km {kilometres(km)}" for km in transformers]
        y = y + 0.5 * BELOW_ROWS
        yield parts.Places(x, y, "transformer", parts.TRIANGLE, COLOURS[2], words)


def _switches(result: Result, paths: Paths) -> Iterator[parts.Places]:
    """Coupling posts and breaks of the contact line, open ones hollow, and neutral sections."""
    supply, line_of, outage = (
        result.scenario.supply,
        result.scenario.line_of,
        result.scenario.outage,
    )
    opened = outage.opens if outage is not None else ()
    kinds = (
        ("coupling post", "open post", parts.DIAMOND, COLOURS[3], supply.posts),
        ("section break", "open section break", parts.CROSS, COLOURS[1], supply.section_breaks),
    )
    for closed, open_, symbol, colour, switches in kinds:
        for hollow, name in ((False, closed), (True, open_)):
            chosen = [e for e in switches if hollow == (e.name in opened or not e.closed)]
            if not chosen:
                continue
            x, y = _spread(paths, [(line_of(each), each.position_km) for each in chosen])
            words = [
                f"{name} {each.name}: km {kilometres(each.position_km)}"
                + (f", opened by {outage.name}" if outage and each.closed and hollow else "")
                for each in chosen
            ]
            yield parts.Places(x, y, name, symbol, colour, words, hollow=hollow)
    yield from _neutral_sections(result, paths)


def _neutral_sections(result: Result, paths: Paths) -> Iterator[parts.Places]:
    """Neutral sections, at their middles."""
    supply, line_of = result.scenario.supply, result.scenario.line_of
    if supply.neutral_sections:
        places = [(line_of(each), each.middle_km) for each in supply.neutral_sections]
        words = [
            f"neutral section: km {kilometres(each.from_km)}-{kilometres(each.to_km)}"
            for each in supply.neutral_sections
        ]
        x, y = _spread(paths, places)
        yield parts.Places(x, y, "neutral section", parts.CROSS, COLOURS[4], words)


def _trains(colours: parts.Colours) -> parts.Curve:
    """A point for the trains, which are coloured as the contact line; it is nowhere yet."""
    nowhere = np.array([np.nan])
    scale = replace(colours, values=nowhere, explained=False)
    return parts.Curve(
        nowhere, nowhere, "trains now", width=2.4, joined=False, words=[""], colours=scale
    )
