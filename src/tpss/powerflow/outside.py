"""What a load flow solved outside the kernels asks of trains and sources."""

import numpy as np
import numpy.typing as npt

from tpss.kernel import kernel
from tpss.powerflow.load import find_demand
from tpss.powerflow.network import Loads, SourceFlow, Standing
from tpss.record import Records
from tpss.sources.kinds import Source, residual

Floats = npt.NDArray[np.float64]
Complexes = npt.NDArray[np.complex128]


@kernel
def find_demands(
    voltage_v: Floats, standing: Records[Standing], loads: Loads, demands: Floats
) -> None:
    """Powers that the trains along the line draw, and their slopes.

    Parameters
    ----------
    voltage_v : Floats, shape (trains on the line,)
        At their pantographs, in the order of `standing`. [V]
    standing : records of Standing
    loads : Loads
    demands : Floats, shape (trains on the line, 4)
        Written: P, Q, P', Q'. [W], [var], [W/V], [var/V]
    """
    for k in range(voltage_v.size):
        train = loads.trains[standing[k].train]
        active, reactive, active_slope, reactive_slope = find_demand(
            voltage_v[k], True, train, loads
        )
        demands[k, 0] = active
        demands[k, 1] = reactive
        demands[k, 2] = active_slope
        demands[k, 3] = reactive_slope


@kernel
def find_residuals(
    voltage_v: Complexes,
    current_a: Complexes,
    sources: Records[Source],
    flow_sources: Records[SourceFlow],
    residuals: Complexes,
) -> None:
    """Residuals of the sources' laws at their voltages and currents, and their derivatives.

    Parameters
    ----------
    voltage_v, current_a : Complexes, shape (sources,)
        Voltage, and current into the network. [V], [A]
    sources, flow_sources : records of Source, of SourceFlow
    residuals : Complexes, shape (sources, 5)
        Written: the residual [V], its pairs over voltage [1] and over current [Ω].
    """
    for s in range(sources.size):
        value, (v_p, v_q), (j_p, j_q) = residual(
            voltage_v[s], current_a[s], flow_sources[s].running, sources[s], True
        )
        residuals[s, 0] = value
        residuals[s, 1] = v_p
        residuals[s, 2] = v_q
        residuals[s, 3] = j_p
        residuals[s, 4] = j_q
