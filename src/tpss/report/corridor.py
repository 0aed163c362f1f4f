"""Corridors: a chain of lines, along which a run of a network is drawn as if it were one line.

Kilometres along a corridor count from the station where it begins.  A run of one line needs none: it is
drawn whole or between two of its stations, at its own kilometres.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from tpss.errors import ResultError, suggest
from tpss.model.contact_line import stretches_of
from tpss.model.supply import layouts_of
from tpss.model.supply_plan import CONTACT_LINE
from tpss.report.contact_line import phasors_at
from tpss.report.sampling import Floats
from tpss.results.places import LINE, lines_of, train_lines, train_tracks
from tpss.results.result import Result
from tpss.scenario.routes import Hop, NoWayError, find_way, hops_of
from tpss.scenario.scenario import Scenario

LANDMARK = "landmark"
"""Coordinate with the names of the stations along a corridor."""


ALONG = "along"
"""Attribute of a dataset that is seen along a corridor: where that begins, changes lines and ends."""


class Stretch(NamedTuple):
    """A stretch of a corridor on one line; a place p there is at s p + o along the corridor."""

    line: str
    begin_km: float
    end_km: float
    sign: float
    offset_km: float

    def along_km(self, place_km: Floats) -> Floats:
        """Places along the corridor; NaN for those that are not on the stretch. [km]"""
        low, high = sorted((self.begin_km, self.end_km))
        with np.errstate(invalid="ignore"):
            inside = (place_km >= low) & (place_km <= high)
        return np.where(inside, self.sign * place_km + self.offset_km, np.nan)


def corridor_of(scenario: Scenario, stations: Sequence[str] = ()) -> list[Stretch]:
    """The shortest corridor over stations; by default the way of the first service, to where it turns.

    Raises
    ------
    ResultError
        There is no such station, or no way.
    """
    places = {
        name: {station.name: station.position_km for station in line.stations}
        for name, line in scenario.lines_by_name.items()
    }
    hops, first = hops_of(places), scenario.traffic[0]
    for name in stations:
        if name not in hops:
            raise ResultError(f"there is no station {name!r}; {suggest(name, list(hops))}")
    try:
        if stations:
            way = find_way(hops, stations[0], stations[1:-1], stations[-1])
        else:
            calls = [stop.station for stop in first.stops]
            way = find_way(hops, first.origin, calls, first.destination, first.via)
    except (NoWayError, IndexError) as error:
        raise ResultError(f"no corridor over {', '.join(stations)}: {error}") from error
    if way.turns and stations:
        raise ResultError(f"the corridor would turn round at {way.hops[way.turns[0]].end}")
    return list(_stretches(way.stretches))


def _stretches(stretches: Sequence[Hop]) -> Iterator[Stretch]:
    """Stretches of a way up to where it turns round, with kilometres from its beginning."""
    reached_km, before = 0.0, ""
    for hop in stretches:
        if hop.line == before:
            return
        offset_km = reached_km - hop.sign * hop.begin_km
        yield Stretch(hop.line, hop.begin_km, hop.end_km, hop.sign, offset_km)
        reached_km, before = reached_km + hop.length_km, hop.line


def along(result: Result, stations: Sequence[str] = ()) -> Result:
    """A run as it is seen along a corridor; that of one line as it is, or between two of its stations.

    What is not on the corridor is left out: trains are not there, nodes and feeding stations are none of
    it.

    Raises
    ------
    ResultError
        As `corridor_of`.
    """
    if LINE not in result.dataset.coords and not stations:
        return result
    corridor = corridor_of(result.scenario, stations)
    if LINE not in result.dataset.coords:
        corridor = [_in_own_kilometres(corridor)]
    data = _with_trains(result.dataset, result.scenario, corridor)
    for what in ("node", "station"):
        data = _with_fixed(data, what, result.scenario, corridor)
    data = _with_ends(data, result, corridor)
    names, places_km = _landmarks(result.scenario, corridor)
    data = data.assign_coords(
        {LANDMARK: names, f"{LANDMARK}_position": (LANDMARK, 1e3 * np.array(places_km))}
    )
    return replace(
        result, dataset=data.assign_attrs({ALONG: _in_words(names, places_km, corridor)})
    )


def _in_own_kilometres(corridor: Sequence[Stretch]) -> Stretch:
    (stretch,) = corridor
    begin_km, end_km = sorted((stretch.begin_km, stretch.end_km))
    return Stretch(stretch.line, begin_km, end_km, 1.0, 0.0)


def _in_words(names: Sequence[str], places_km: Sequence[float], corridor: Sequence[Stretch]) -> str:
    ends = [corridor[0].begin_km, *(stretch.end_km for stretch in corridor)]
    stretches = [corridor[0], *corridor]
    at_km = [float(each.along_km(np.array(km))) for each, km in zip(stretches, ends, strict=True)]
    return " – ".join(names[int(np.abs(np.array(places_km) - km).argmin())] for km in at_km)


def on_line(result: Result, name: str, track: int = 1) -> xr.Dataset:
    """Trains and nodes of a run that are on one of its lines, at its kilometres.

    Where its tracks are not tied to each other everywhere, only those of one track.
    """
    line = result.scenario.lines_by_name[name]
    whole = [Stretch(name, line.begins_at_km, line.end_km, 1.0, 0.0)]
    data = result.dataset
    if LINE in data.coords:
        data = _with_trains(data, result.scenario, whole)
        data = _with_fixed(data, "node", result.scenario, whole)
    apart = separate_tracks(result.scenario, name)
    if not apart:
        return data
    others = [f", track {k}" for k in range(1, line.most_tracks + 1) if k != track]
    own = [not any(other in node for other in others) for node in data.node.to_numpy().astype(str)]
    km, tracks = data.position.to_numpy() / 1e3, train_tracks(data)
    beside = np.zeros(km.shape, dtype=bool)
    for begin_km, end_km in apart:
        beside |= (km >= begin_km) & (km <= end_km) & (tracks != track)
    there = data.pantograph_voltage.where(~beside)
    return data.isel(node=np.flatnonzero(own)).assign(pantograph_voltage=there)


def separate_tracks(scenario: Scenario, name: str) -> list[tuple[float, float]]:
    """Ends of the stretches of a line where each track has a contact line of its own. [km]"""
    layout = next(each for each in layouts_of(scenario.lines_by_name) if each.name == name)
    stretches = stretches_of(layout, scenario.supply)
    return [(each.begin_km, each.end_km) for each in stretches if each.conductors > 1]


def is_corridor(result: Result) -> bool:
    """Whether a run is seen along a corridor of a network."""
    return LANDMARK in result.dataset.coords


def landmarks(result: Result) -> dict[str, float]:
    """Places of the stations along a corridor, or along the line of a run of one. [km]"""
    data = result.dataset
    if not is_corridor(result):
        return {each.name: each.position_km for each in result.scenario.only_line.stations}
    places_km = data[f"{LANDMARK}_position"].to_numpy() / 1e3
    return dict(
        zip(data[LANDMARK].to_numpy().astype(str).tolist(), places_km.tolist(), strict=True)
    )


def span_km(result: Result) -> tuple[float, float]:
    """Ends of a corridor, or of the line of a run of one. [km]"""
    if is_corridor(result):
        places = landmarks(result).values()
        return min(places), max(places)
    line = result.scenario.only_line
    return line.begins_at_km, line.end_km


def gradients_along(result: Result) -> list[tuple[float, float]]:
    """Places from which gradients hold, along a corridor or a line, and the gradients. [km], [‰]"""
    lines = result.scenario.lines_by_name
    if len(lines) == 1:
        return [(each.from_km, each.permille) for each in result.scenario.only_line.gradients]
    names = list(landmarks(result))
    profile: list[tuple[float, float]] = []
    for stretch in corridor_of(result.scenario, names):
        line = lines[stretch.line]
        seen = line if stretch.sign > 0.0 else line.mirrored()
        begin, end = (stretch.sign * km for km in (stretch.begin_km, stretch.end_km))
        pieces = seen.gradients_between(begin, end)
        profile += [(start + stretch.offset_km, permille) for start, _, permille in pieces]
    return profile


def _landmarks(scenario: Scenario, corridor: Sequence[Stretch]) -> tuple[list[str], list[float]]:
    found: dict[str, float] = {}
    for stretch in corridor:
        for station in scenario.lines_by_name[stretch.line].stations:
            here_km = float(stretch.along_km(np.array(station.position_km)))
            if np.isfinite(here_km):
                found.setdefault(station.name, here_km)
    ordered = sorted(found, key=found.__getitem__)
    return ordered, [found[name] for name in ordered]


def _with_trains(data: xr.Dataset, scenario: Scenario, corridor: Sequence[Stretch]) -> xr.Dataset:
    names, line = list(scenario.lines_by_name), train_lines(data)
    places_km = data.position.to_numpy() / 1e3
    along_km = np.full(places_km.shape, np.nan)
    for stretch in corridor:
        here = line == names.index(stretch.line)
        along_km[here] = stretch.along_km(places_km[here])
    there = np.isfinite(along_km)
    changed = {"position": (data.position.dims, 1e3 * along_km, data.position.attrs)}
    for name in ("pantograph_voltage", "pantograph_angle", "speed"):
        values = np.where(there, data[name].to_numpy(), np.nan)
        changed[name] = (data[name].dims, values, data[name].attrs)
    return data.assign(changed)


def _with_fixed(
    data: xr.Dataset, what: str, scenario: Scenario, corridor: Sequence[Stretch]
) -> xr.Dataset:
    """The nodes or stations of a corridor, those of other lines at a station where lines meet too."""
    names = np.array(list(scenario.lines_by_name))
    owner = names[lines_of(data, what)]
    places_km = data[f"{what}_position"].to_numpy() / 1e3
    along_km = np.full(places_km.shape, np.nan)
    rank = np.arange(places_km.size)  # nodes of one place stand in the order of rising kilometres
    for stretch in corridor:
        # Where lines meet that are not tied, each has a node of its own.
        own = set(places_km[owner == stretch.line].tolist()) if what == "node" else set()
        for line, shift in _shared(scenario, stretch.line):
            here = owner == line
            if line != stretch.line:
                here &= np.isin(places_km, [km for km, there in shift.items() if there not in own])
            here &= np.isnan(along_km)
            own_km = np.array([shift.get(km, km) for km in places_km[here].tolist()])
            along_km[here] = stretch.along_km(own_km)
            rank[here] = int(stretch.sign) * np.flatnonzero(here)
    chosen = np.flatnonzero(np.isfinite(along_km))
    order = chosen[np.lexsort((rank[chosen], along_km[chosen]))]
    attributes = data[f"{what}_position"].attrs
    return data.isel({what: order}).assign_coords(
        {f"{what}_position": (what, 1e3 * along_km[order], attributes)}
    )


def _with_ends(data: xr.Dataset, result: Result, corridor: Sequence[Stretch]) -> xr.Dataset:
    """The view with a node at each of its ends, between the nodes and trains beside it on its line."""
    for stretch, end_km in (
        (corridor[0], corridor[0].begin_km),
        (corridor[-1], corridor[-1].end_km),
    ):
        along_m = 1e3 * float(stretch.along_km(np.array(end_km)))
        on_contact_line = data.node_kind.to_numpy() == CONTACT_LINE
        if (np.abs(data.node_position.to_numpy()[on_contact_line] - along_m) < 1.0).any():
            continue
        volts = phasors_at(on_line(result, stretch.line), 1e3 * end_km)
        like = data.isel(node=np.flatnonzero(on_contact_line)[:1])
        if not like.sizes["node"]:  # of a stretch without any, all are between nodes
            like = result.dataset.isel(node=[0])
        end = like.assign(
            node_voltage=(like.node_voltage.dims, np.abs(volts)[:, None], like.node_voltage.attrs),
            node_angle=(like.node_angle.dims, np.angle(volts)[:, None], like.node_angle.attrs),
        ).assign_coords(
            node=[f"{CONTACT_LINE} at {along_m / 1e3:g} km"], node_position=("node", [along_m])
        )
        of_nodes = [name for name, each in data.data_vars.items() if "node" in each.dims]
        joined = xr.concat(
            [data[of_nodes], end[of_nodes]], dim="node", coords="minimal", compat="override"
        )
        data = data.drop_dims("node").assign(joined.data_vars)
    order = np.argsort(data.node_position.to_numpy(), kind="stable")
    return data.isel(node=order)


def _shared(scenario: Scenario, line: str) -> Iterator[tuple[str, dict[float, float]]]:
    """The line itself; and others with the places where they meet it, and these places on it. [km]"""
    lines = scenario.lines_by_name
    own = {station.name: station.position_km for station in lines[line].stations}
    yield line, {}
    for name, other in lines.items():
        if name != line:
            yield name, {s.position_km: own[s.name] for s in other.stations if s.name in own}
