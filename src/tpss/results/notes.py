"""Notes on a run: what was limited or left its range, and loads that no equipment stands."""

from collections.abc import Iterator

import numpy as np
import xarray as xr

from tpss.model.relays import station_relays
from tpss.model.unfed import bare_in_words, unfed_in_words
from tpss.powerflow.network import SHORTEST_PIECE_M
from tpss.results.explain import warnings
from tpss.results.extrapolation import EFFORT, extrapolations
from tpss.results.passing import passings
from tpss.results.places import line_names, lines_of, train_lines
from tpss.results.result import Result
from tpss.results.standards.windows import Floats, step_values
from tpss.results.step_words import step_warnings
from tpss.results.storage import storage_notes
from tpss.results.stranded import stranded_trains
from tpss.results.tables import J_PER_MWH, step_s
from tpss.units import kilometres, on_line

MOST_CIRCULATING = 0.1
"""Energy that stations may receive from others without a note, as a share of what trains and losses
take. [1]"""

CLOSE_M = SHORTEST_PIECE_M
"""Distance below which the load flow sets a train apart. [m]"""

BEYOND = "the model continues, the equipment would not"
"""Said of what is loaded beyond its rating, and does not trip."""

APART_M = 1e8
"""What lies between the places on one line and those on the next; no line is so long. [m]"""

MOST_STRANDED = 5
"""Trains without power that are listed."""

WIDEST_DEG = 121.0
"""Angle across a neutral section above that of two pairs of phases in their order, 120°. [°]"""

FEW = 3
"""Train-steps that closeness may take without a note, as of a train that passes."""


def notes(result: Result) -> list[str]:
    """Sentences on a run that ended, each a sign that something may not be as it was meant."""
    if result.dataset.sizes["time"] < 2:
        return [
            *_outage(result),
            *_trips(result),
            *step_warnings(result.summary),
            *warnings(result.summary),
        ]
    return [
        *_outage(result),
        *_trips(result),
        *step_warnings(result.summary),
        *_unfed(result),
        *_wide_angles(result),
        *_stranded(result),
        *_current_limits(result),
        *storage_notes(result.dataset, result.scenario),
        *_overloads(result),
        *_circulation(result),
        *extrapolations(result),
        *_closeness(result),
        *_passing(result),
        *warnings(result.summary, but=[EFFORT]),
    ]


def _trips(result: Result) -> Iterator[str]:
    """What tripped, in the order of time."""
    for number, trip in enumerate(result.summary.get("trips", []), 1):
        yield (
            f"protection, {number}: {trip['element']} tripped at {trip['time_min']:.2f} min, loaded to "
            f"{trip['load_percent']:.0f} % over {trip['window_min']:g} min, "
            f"{trip['allowed_percent']:.0f} % allowed; the run went on without it"
        )


def _current_limits(result: Result) -> Iterator[str]:
    """Stations that were at the highest current of their converters."""
    for name, limit in result.summary.get("current_limits", {}).items():
        if limit["time_min"] > 0.0:
            yield (
                f"{name} was at the highest current of its converters for {limit['time_min']:.1f} min: "
                "its voltage fell, and others had to give more"
            )


def _outage(result: Result) -> Iterator[str]:
    """The outage with which it was run."""
    outage = result.scenario.outage
    if outage is not None:
        yield f"outage {outage.name}: {outage.in_words}"


def _unfed(result: Result) -> Iterator[str]:
    """Stretches of contact line without a source."""
    for words in (unfed_in_words(result.scenario), bare_in_words(result.scenario)):
        if words:
            yield words


def _wide_angles(result: Result) -> Iterator[str]:
    """Neutral sections between voltages further apart than those of two phases in their order."""
    for each in result.standards.across:
        if each.angle_deg > WIDEST_DEG:
            place = on_line(each.line, f"{kilometres(each.from_km)}-{kilometres(each.to_km)} km")
            phases = f"{each.phases_before} and {each.phases_behind}"
            yield (
                f"the voltages on both sides of the neutral section at {place} ({phases}) are "
                f"{each.angle_deg:.0f}° apart: up to {each.highest_kv:.1f} kV stand across it; another "
                "order of the phases of one side makes it less"
            )


def _stranded(result: Result) -> Iterator[str]:
    """Trains that stood without power."""
    stood = stranded_trains(result.dataset)
    if stood:
        more = f", and {len(stood) - MOST_STRANDED} more" if len(stood) > MOST_STRANDED else ""
        listed = "; ".join(each.in_words for each in stood[:MOST_STRANDED])
        yield f"stranded without power: {listed}{more}; voltages are those of trains that are fed"


def _stations_that_trip(result: Result) -> set[str]:
    """Names of the stations that protection disconnects if they bear too much."""
    if not result.scenario.protection.trip:
        return set()
    return {relay.protected.name for relay in station_relays(result.scenario)}


def _rated_rectifiers(result: Result) -> set[str]:
    """Names of rectifier stations whose ratings say how long they bear how much: they are judged."""
    stations = result.scenario.supply.rectifier_stations
    return {each.name for each in stations if each.type.rating and each.type.rating.overloads}


def _overloads(result: Result) -> Iterator[str]:
    """Stations whose running converters or transformers were above their rating for several steps."""
    unit = "MW" if result.scenario.supply.is_direct else "MVA"
    data, h = result.dataset, step_s(result.dataset) / 60.0
    loading = step_values(data, "converter_loading")
    apparent_mva = np.hypot(*_station_powers_mw(result))
    tripping, judged = _stations_that_trip(result), _rated_rectifiers(result)
    for i, name in enumerate(data.station.to_numpy()):
        above = loading[:, i] > 1.0
        if above.sum() < 2 or (name in judged and name not in tripping):
            continue
        worst = int(np.nanargmax(loading[:, i]))
        times = np.flatnonzero(above)
        yield (
            f"{name} was loaded to {100.0 * loading[worst, i]:.0f} % of its rating "
            f"({apparent_mva[worst, i]:.1f} {unit} at {worst * h:.2f} min), and above 100 % for "
            f"{above.sum() * h:.2f} min between {times[0] * h:.2f} and {(times[-1] + 1) * h:.2f} min; "
            f"{'it trips by its overloads' if name in tripping else BEYOND}"
        )


def _circulation(result: Result) -> Iterator[str]:
    """Power that some stations feed and others receive, while trains take little of it."""
    data, (active_mw, _) = result.dataset, _station_powers_mw(result)
    received_mw = np.maximum(-active_mw, 0.0)
    received_mw *= _share_from_stations(data, received_mw)[:, None]
    h = step_s(data) * 1e6 / J_PER_MWH
    circulating_mwh, taken_mwh = received_mw.sum() * h, active_mw.sum() * h
    if circulating_mwh <= MOST_CIRCULATING * max(taken_mwh, 0.0) or circulating_mwh <= 0.0:
        return
    worst, station = np.unravel_index(int(received_mw.argmax()), received_mw.shape)
    yield (
        f"power circulates between the stations: {data.station.to_numpy()[station]} received up to "
        f"{received_mw[worst, station]:.1f} MW (at {worst * step_s(data) / 60.0:.2f} min), and "
        f"{circulating_mwh:.3f} MWh went from station to station, where trains and losses took "
        f"{taken_mwh:.3f} MWh; look at the stations' no_load_voltage_kv and angles"
    )


def _share_from_stations(data: xr.Dataset, received_mw: Floats) -> Floats:
    """Share of what stations receive in each step that trains do not feed back. [1]"""
    drawn_mw = np.nan_to_num(step_values(data, "active_power")) / 1e6
    fed_back_mw, total_mw = np.maximum(-drawn_mw, 0.0).sum(axis=1), received_mw.sum(axis=1)
    left_mw = np.maximum(total_mw - fed_back_mw, 0.0)
    share = np.divide(left_mw, total_mw, out=np.ones_like(total_mw), where=total_mw > 0.0)
    return np.asarray(share)


def _closeness(result: Result) -> Iterator[str]:
    """Trains that stood on each other, or at a node that is no station, which the load flow parts.

    A train that departs, dwells or arrives at a feeding point is no more than its station demands.
    """
    if result.summary["limited"]["short_piece"] <= FEW:
        return
    data, names = result.dataset, result.dataset.train.to_numpy()
    there = np.isfinite(step_values(data, "pantograph_voltage"))
    place_m = np.where(there, step_values(data, "position") + _apart_m(data)[:-1], np.inf)
    order = np.argsort(place_m, axis=1)
    with np.errstate(invalid="ignore"):  # between trains that are not there
        step, pair = np.nonzero(
            np.diff(np.take_along_axis(place_m, order, axis=1), axis=1) < CLOSE_M
        )
    if len(step) > FEW:
        first, second = (names[order[step[0], pair[0] + i]] for i in (0, 1))
        yield (
            f"trains stood closer than {CLOSE_M:g} m to each other and counted as {CLOSE_M:g} m apart, "
            f"in {len(step)} train-steps, first {first} and {second} at "
            f"{step[0] * step_s(data) / 60.0:.2f} min"
        )
    for place, node_m in _nodes_between_stations(result):
        step, train = np.nonzero(np.abs(place_m - node_m) < CLOSE_M)
        if len(step) > FEW:
            yield (
                f"a train stood closer than {CLOSE_M:g} m to the feeding point at "
                f"{place} and counted as {CLOSE_M:g} m away, in {len(step)} "
                f"train-steps, first {names[train[0]]} at {step[0] * step_s(data) / 60.0:.2f} min"
            )


def _passing(result: Result) -> Iterator[str]:
    """Trains that passed through each other on one track, as nothing keeps them apart."""
    found = passings(result)
    if found:
        times = "once" if len(found) == 1 else f"{len(found)} times"
        single = all(line.most_tracks == 1 for line in result.scenario.lines_by_name.values())
        where = "the line has one track" if single else "they run on one track"
        yield (
            f"trains passed through each other {times}, first {found[0].in_words}: {where}, and "
            "nothing keeps trains apart; signalling.single_track does"
        )


def _apart_m(data: xr.Dataset) -> Floats:
    """What puts places on different lines apart, shape (time, train). [m]"""
    return np.asarray(APART_M * train_lines(data))


def _nodes_between_stations(result: Result) -> Iterator[tuple[str, float]]:
    """Nodes where no train is to stop: in words, and their places, put apart by lines. [m]"""
    data, names = result.dataset, line_names(result.dataset)
    owners, nodes_m = lines_of(data, "node"), data.node_position.to_numpy()
    for index, line in enumerate(result.scenario.lines_by_name.values()):
        stations_m = np.array([1e3 * each.position_km for each in line.stations])
        for node_m in np.unique(nodes_m[owners == index]):
            if (np.abs(node_m - stations_m) >= CLOSE_M).all():
                yield on_line(names[index], f"{node_m / 1e3:.2f} km"), APART_M * index + node_m


def _station_powers_mw(result: Result) -> tuple[Floats, Floats]:
    """Active [MW] and reactive [Mvar] power of each station in each step, shape (steps, stations)."""
    names = "station_active_power", "station_reactive_power"
    active, reactive = (np.nan_to_num(step_values(result.dataset, name)) / 1e6 for name in names)
    return active, reactive
