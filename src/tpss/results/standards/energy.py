"""Energy of trains as metered on board for billing: in blocks, each direction separately.

Energy that a train draws is consumed, energy that it feeds back is regenerated; neither is negative.

References
----------
[EN50463]_
"""

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.standards.windows import Floats, between_instants, integrals, step_values
from tpss.results.tables import J_PER_MWH, distance_km, short_s, step_s

BLOCK_MIN = 5.0
"""Length of a block. [min]"""


def energy_table(dataset: xr.Dataset, mass_t: Floats) -> pd.DataFrame:
    """One row per train: energies over the run, and consumed less regenerated energy per kilometre.

    Parameters
    ----------
    dataset : xarray.Dataset
    mass_t : Floats, shape (trains,)
        Mass of each whole train. [t]
    """
    energy = {name: powers.sum(axis=0) for name, powers in _energies(dataset).items()}
    travelled_km = distance_km(dataset)
    net_kwh = 1e3 * (energy["consumed_mwh"] - energy["regenerated_mwh"])
    per_km = net_kwh / np.where(travelled_km > 0.0, travelled_km, np.nan)
    return pd.DataFrame(
        {
            "train": dataset.train.to_numpy(),
            "distance_km": travelled_km,
            "mass_t": mass_t,
            **energy,
            "energy_kwh_per_km": per_km,
            "energy_wh_per_t_km": 1e3 * per_km / mass_t,
        }
    )


def energy_blocks(dataset: xr.Dataset, block_min: float = BLOCK_MIN) -> pd.DataFrame:
    """One row per train and block in which it is on the line: its energies.

    Blocks are counted from the start of the run; the last one ends with the run. A time step that
    extends over the end of a block is divided.
    """
    steps, h = dataset.sizes["time"] - 1, step_s(dataset) / 60.0
    edges = np.append(np.arange(0.0, steps * (1.0 - 1e-12), block_min / h), float(steps))
    present = np.isfinite(step_values(dataset, "pantograph_voltage"))
    train, block = np.nonzero(_in_blocks(present.astype(float), edges).T > 0.0)
    energies = {
        name: _in_blocks(energy, edges)[block, train] for name, energy in _energies(dataset).items()
    }
    return pd.DataFrame(
        {
            "train": dataset.train.to_numpy()[train],
            "from_min": edges[block] * h,
            "to_min": np.minimum(edges[block + 1] * h, float(dataset.time[-1]) / 60.0),
            **energies,
        }
    )


def _energies(dataset: xr.Dataset) -> dict[str, Floats]:
    """Energies of every step, shape (steps, trains)."""
    energies = {}
    for name, prefix, unit in (
        ("active_power", "", "mwh"),
        ("reactive_power", "reactive_", "mvarh"),
    ):
        energy = np.nan_to_num(step_values(dataset, name)) * step_s(dataset) / J_PER_MWH
        energy[-1:] *= 1.0 - short_s(dataset) / step_s(dataset)
        energies[f"{prefix}consumed_{unit}"] = np.maximum(energy, 0.0)
        energies[f"{prefix}regenerated_{unit}"] = np.maximum(-energy, 0.0)
    return energies


def _in_blocks(values: Floats, edges: Floats) -> Floats:
    """Sum of the values of steps in blocks, shape (blocks, trains)."""
    return np.diff(between_instants(integrals(values), edges), axis=0)
