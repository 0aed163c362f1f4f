"""What a load flow solved outside the kernels asks of trains and converter stations."""

import cmath
from typing import Any

import numpy as np
import numpy.typing as npt

from tpss.kernel import kernel
from tpss.physics.converter import terminal_voltage
from tpss.physics.locomotive import electrical_demand
from tpss.powerflow.network import Loads

Floats = npt.NDArray[np.float64]


@kernel
def find_demands(voltage_v: Floats, standing: Any, loads: Loads, demands: Floats) -> None:
    """Powers that the trains along the line draw, and their slopes.

    Parameters
    ----------
    voltage_v : Floats, shape (trains on the line,)
        At their pantographs, in the order of `standing`. [V]
    standing : records
        `Flow.standing`.
    demands : Floats, shape (trains on the line, 4)
        Written: P, Q, P', Q'. [W], [var], [W/V], [var/V]
    """
    for k in range(voltage_v.size):
        train = loads.trains[standing[k].train]
        active, reactive, active_slope, reactive_slope = electrical_demand(
            voltage_v[k], loads.types[train.train_type], train, loads.machine[0]
        )
        demands[k, 0] = active
        demands[k, 1] = reactive
        demands[k, 2] = active_slope
        demands[k, 3] = reactive_slope


@kernel
def find_terminals(power: Floats, sources: Any, flow_sources: Any, terminals: Floats) -> None:
    """Voltages and angles of the converter stations at their powers, and their slopes.

    Parameters
    ----------
    power : Floats, shape (stations, 2)
        P and Q fed into the railway. [W], [var]
    sources, flow_sources : records
        `Network.sources` and `Flow.sources`.
    terminals : Floats, shape (stations, 5)
        Written: U, θ, dU/dQ, dθ/dP, dθ/dQ. [V], [rad], [V/var], [rad/W], [rad/var]
    """
    for s in range(sources.size):
        voltage, direction, voltage_by_q, angle_by_p, angle_by_q = terminal_voltage(
            power[s, 0], power[s, 1], flow_sources[s].converters, sources[s]
        )
        terminals[s, 0] = voltage
        terminals[s, 1] = cmath.phase(direction)
        terminals[s, 2] = voltage_by_q
        terminals[s, 3] = angle_by_p
        terminals[s, 4] = angle_by_q
