"""What transformer stations at one busbar of the grid do to each other, as impedances."""

import numpy as np
import numpy.typing as npt

from tpss.physics.three_phase import impedance_between
from tpss.scenario.supply import Supply, TransformerStation
from tpss.units import si

Complexes = npt.NDArray[np.complex128]


def mutual_impedances_ohm(supply: Supply) -> Complexes | None:
    """Voltage that each station loses over the current of another one. [Ω], shape (stations, stations)

    None where no two stations share a grid, or grids are infinite.  Row k is the station that loses it;
    the diagonal is 0, as what a station does to itself is a part of its own law.
    """
    stations = supply.stations
    mutual_ohm = np.zeros((len(stations), len(stations)), dtype=complex)
    for k, first in enumerate(stations):
        for j, second in enumerate(stations):
            if k != j and share_a_grid(first, second):
                mutual_ohm[k, j] = _mutual_ohm(first, second)  # type: ignore[arg-type]
    return mutual_ohm if mutual_ohm.any() else None


def share_a_grid(first: object, second: object) -> bool:
    """Whether two feeding stations stand at one busbar of a grid that has an impedance."""
    return (
        isinstance(first, TransformerStation)
        and isinstance(second, TransformerStation)
        and first.grid_busbar == second.grid_busbar
        and first.grid_short_circuit_mva is not None
    )


def grid_impedance_ohm(station: TransformerStation) -> complex:
    """Impedance of a phase of the grid at its own voltage, 0 of an infinite one. [Ω]"""
    if station.grid_short_circuit_mva is None or station.grid_kv is None:
        return 0j
    size_ohm = si(station, "grid_kv") ** 2 / si(station, "grid_short_circuit_mva")
    direction = complex(station.grid_r_over_x, 1.0)
    return size_ohm * direction / abs(direction)


def _mutual_ohm(first: TransformerStation, second: TransformerStation) -> complex:
    """Z_1 of the grid on the railway's side, times what the two windings have in common. [Ω]"""
    ratios = si(first, "no_load_voltage_kv") * si(second, "no_load_voltage_kv")
    per_phase_ohm = grid_impedance_ohm(first) * ratios / si(first, "grid_kv") ** 2
    return per_phase_ohm * impedance_between(str(first.phases), str(second.phases))
