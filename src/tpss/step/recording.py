"""The recording: everything that is kept of a run, one row a step."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tpss.kernel import at, inlined
from tpss.powerflow.bundles import Complexes, widest_of
from tpss.powerflow.links import count_links
from tpss.record import Record, Records
from tpss.step.model import Model
from tpss.step.recorded import (
    LinkRow,
    NodeRow,
    OnBoardRow,
    RailRow,
    RegenerationRow,
    StationRow,
    StoreRow,
    TrainRow,
)
from tpss.step.separation import Separation
from tpss.step.state import Counter, Floats, TrainState

Indices = npt.NDArray[np.int64]

ROUNDING = 1e-9
"""Share of a step that is a rounding of times within it."""


class Call(Record):
    """When a train stood at a stop; NaN: it has not."""

    arrival_s: float
    """When it came to stand. [s]"""
    departure_s: float
    """When it went on. [s]"""


class Recording(NamedTuple):
    """Everything that is kept, one row a step; NaN where there is nothing."""

    trains: Records[TrainRow]
    """Shape (instants, trains)."""
    train_state: npt.NDArray[np.int8]
    nodes: Records[NodeRow]
    """Shape (instants, nodes)."""
    stations: Records[StationRow]
    """Shape (instants, stations)."""
    branch_current: Floats
    """Lumped branches first, then the start and the end of each section."""
    network_losses: Floats
    passes: Indices
    """Evaluations of the network."""
    counters: Indices
    """By `Counter`."""
    calls: Records[Call]
    """Shape (trains, most stops): when each train stood at its stops, if it moves continuously."""
    waits_for: npt.NDArray[np.int32]
    """Shape (instants, trains): train for which each one waits; -1: none.  Empty unless trains are kept
    apart."""
    regeneration: Records[RegenerationRow]
    """Shape (instants, trains).  Empty unless trains have electric brakes."""
    without_power_s: Floats
    """Shape (instants, trains): time that each one has its power off.  Empty without neutral
    sections. [s]"""
    links: Records[LinkRow]
    """Shape (instants, links)."""
    conductors: Complexes
    """Shape (instants, trains, most conductors): voltages of all conductors at each train.  Without any
    instants unless there are bundles of them. [V]"""
    rails: Records[RailRow]
    """Shape (instants, trains).  Empty unless there are such bundles."""
    stores: Records[StoreRow]
    """Shape (instants, stores at the line)."""
    on_board: Records[OnBoardRow]
    """Shape (instants, trains).  Empty unless trains have stores of energy."""


def is_kept_apart(model: Model) -> bool:
    """Whether trains look out for others."""
    return model.signalling.separation != Separation.NONE


@inlined
def lacks_power(step: int, i: int, step_s: float, recording: Recording) -> bool:
    """Whether a train has its power off all through a step of this length. [s]"""
    off_s = recording.without_power_s
    return off_s.shape[0] > 0 and off_s[at(step), at(i)] >= step_s * (1.0 - ROUNDING)


def recording_bytes(model: Model, steps: int, trains: int) -> int:
    """Memory that a recording takes. [byte]"""
    network = model.network
    row = trains * (TrainRow.dtype.itemsize + 1)
    row += network.source_of_node.size * NodeRow.dtype.itemsize
    row += network.sources.size * StationRow.dtype.itemsize
    row += 8 * (network.branches.size + 2 * network.sections.size + 2)
    row += 4 * trains * is_kept_apart(model) + 8 * trains * _has_neutral(model)
    row += count_links(network.links) * LinkRow.dtype.itemsize
    row += 16 * trains * (widest_of(network.bundles) + (widest_of(network.bundles) > 0))
    row += trains * RegenerationRow.dtype.itemsize * _regenerates(model)
    row += network.stores.size * StoreRow.dtype.itemsize
    row += trains * OnBoardRow.dtype.itemsize * _stores_on_board(model)
    return (steps + 1) * row


def _regenerates(model: Model) -> bool:
    return bool((np.asarray(model.types)["regeneration"]["highest_force_n"] > 0.0).any())


def _stores_on_board(model: Model) -> bool:
    return bool((np.asarray(model.types)["on_board"]["store"]["capacity_j"] > 0.0).any())


def _has_neutral(model: Model) -> bool:
    return model.neutral.from_m.shape[1] > 1


def _no_calls(trains: int, stops: int) -> Records[Call]:
    calls = Call.blank(trains, stops)
    calls["arrival_s"], calls["departure_s"] = np.nan, np.nan
    return calls


Memory = Callable[[int], Floats]
"""What gives an array of so many numbers, whatever they are."""


def new_recording(model: Model, steps: int, trains: int, memory: Memory = np.empty) -> Recording:
    """Recording with room for `steps` steps and one instant more.

    Parameters
    ----------
    memory : callable
        Allocates the arrays.
    """
    network, rows = model.network, steps + 1

    def unknown(size: int) -> Floats:
        values = memory(size)
        values.fill(np.nan)
        return values

    def blank(columns: int, kind: type[Record], rows: int = rows) -> Any:
        size = rows * columns * len(kind.dtype.names or ())
        return unknown(size).view(kind.dtype).reshape(rows, columns).view(np.recarray)

    ends = network.branches.size + 2 * network.sections.size
    widest = widest_of(network.bundles)

    def conductors_of_trains() -> Complexes:
        size = rows * trains * widest
        return unknown(2 * size).view(complex).reshape(rows if widest else 0, trains, widest)

    return Recording(
        trains=blank(trains, TrainRow),
        train_state=np.full((rows, trains), TrainState.ABSENT, dtype=np.int8),
        nodes=blank(network.source_of_node.size, NodeRow),
        stations=blank(network.sources.size, StationRow),
        branch_current=unknown(rows * ends).reshape(rows, ends),
        network_losses=unknown(rows),
        passes=np.zeros(rows, dtype=np.int64),
        counters=np.zeros(len(Counter), dtype=np.int64),
        calls=_no_calls(trains, model.stops.shape[1]),
        waits_for=np.full((rows if is_kept_apart(model) else 0, trains), -1, dtype=np.int32),
        regeneration=blank(trains, RegenerationRow, rows if _regenerates(model) else 0),
        without_power_s=np.full((rows if _has_neutral(model) else 0, trains), np.nan),
        links=blank(count_links(network.links), LinkRow),
        conductors=conductors_of_trains(),
        rails=blank(trains, RailRow, rows if widest_of(network.bundles) else 0),
        stores=blank(network.stores.size, StoreRow),
        on_board=blank(trains, OnBoardRow, rows if _stores_on_board(model) else 0),
    )
