r"""What transformer stations do to the three-phase grid, found from what was recorded.

A station of the phases w (`physics.three_phase`), with the voltages E without load and U of the grid,
takes from the phases

.. math:: I_p = w_p \frac{E}{U} J e^{j \theta}

where J is the current that it feeds and θ the angle of its voltage without load.  The stations of a
busbar add up.  With the impedance Z of the grid, equal for both sequences, its unbalance is

.. math:: u_2 = \frac{|Z I_2|}{|U/\sqrt 3 - Z I_1|}

Limits of validity: the currents of the transformers without load are left out.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from tpss.model.outages import layout_of
from tpss.model.phases import phases_of
from tpss.model.shared_grids import grid_impedance_ohm
from tpss.physics.three_phase import angle_of, sequences, winding_of
from tpss.results.standards.windows import Floats, step_values
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import TransformerStation
from tpss.units import si

Complexes = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Busbar:
    """A busbar of the grid in every step.

    Attributes
    ----------
    name : str
    stations : tuple of str
        Transformer stations that stand there.
    phase_currents_a : array, shape (steps, 3)
        Currents into the stations from the phases R, S, T, at the grid's voltage; R has angle 0. [A]
    unbalance : array, shape (steps,)
        Negative-sequence voltage over positive-sequence voltage. [1]
    current_unbalance : array, shape (steps,)
        Negative-sequence current over positive-sequence current; NaN without current. [1]
    limit : float
        Highest mean of the unbalance over 10 min. [1]
    """

    name: str
    stations: tuple[str, ...]
    phase_currents_a: Complexes
    unbalance: Floats
    current_unbalance: Floats
    limit: float


def station_currents_a(dataset: xr.Dataset, scenario: Scenario) -> Complexes:
    """Currents that the stations feed, shape (steps, stations); 0 of one that is out. [A]

    Each counts its angle from the station's own voltage without load.
    """
    nodes = layout_of(scenario, scenario.outage).plan.sources
    at = dataset.isel(node=nodes, time=slice(0, -1))
    voltage_v = at.node_voltage.to_numpy() * np.exp(1j * at.node_angle.to_numpy())
    active, reactive = (
        np.nan_to_num(step_values(dataset, name))
        for name in ("station_active_power", "station_reactive_power")
    )
    fed = (active + 1j * reactive) != 0.0
    current = np.zeros(fed.shape, dtype=complex)
    current[fed] = np.conj((active + 1j * reactive)[fed] / voltage_v[fed])
    return current


def busbars(dataset: xr.Dataset, scenario: Scenario) -> Iterator[Busbar]:
    """Busbars whose stations tell their phases, in the order of the stations."""
    told = [
        (s, station)
        for s, station in enumerate(scenario.supply.stations)
        if isinstance(station, TransformerStation) and phases_of(station)
    ]
    if not told:
        return
    current_a = station_currents_a(dataset, scenario)
    for name in dict.fromkeys(station.grid_busbar for _, station in told):
        own = [(s, station) for s, station in told if station.grid_busbar == name]
        numbers, stations = zip(*own, strict=True)
        yield busbar_of(stations, current_a[:, list(numbers)])


def _phase_currents_a(current_a: Complexes, station: TransformerStation) -> Complexes:
    """Currents that a station takes from the phases, shape (steps, 3). [A]"""
    phases = str(station.phases)
    ratio = si(station, "no_load_voltage_kv") / si(station, "grid_kv")
    turned = current_a * np.exp(1j * angle_of(phases)) * ratio
    return np.asarray(turned[:, None] * winding_of(phases))


def busbar_of(stations: Sequence[TransformerStation], current_a: Complexes) -> Busbar:
    """A busbar from what its stations feed.

    Parameters
    ----------
    stations : sequence of TransformerStation
        Of one busbar; they tell their phases.
    current_a : array of complex, shape (steps, stations)
        Currents into the railway, each against the voltage of its own station without load. [A]

    References
    ----------
    [Fortescue1918]_
    """
    first = stations[0]
    each_a = [_phase_currents_a(own, s) for own, s in zip(current_a.T, stations, strict=True)]
    phase_a = np.sum(each_a, axis=0)
    positive_a, negative_a = sequences(phase_a)
    impedance_ohm = grid_impedance_ohm(first)
    positive_v = si(first, "grid_kv") / math.sqrt(3.0) - impedance_ohm * positive_a
    flows = positive_a != 0.0
    ratio = np.full(positive_a.shape, np.nan)
    ratio[flows] = np.abs(negative_a[flows]) / np.abs(positive_a[flows])
    return Busbar(
        name=first.grid_busbar,
        stations=tuple(station.name for station in stations),
        phase_currents_a=phase_a,
        unbalance=np.abs(impedance_ohm * negative_a) / np.abs(positive_v),
        current_unbalance=ratio,
        limit=si(first, "unbalance_limit_percent"),
    )
