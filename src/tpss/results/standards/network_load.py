"""Losses of the network by kind of branch, and currents of branches."""

from collections.abc import Iterable

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.standards.windows import WINDOWS_MIN, highest_mean_table, step_values
from tpss.results.tables import J_PER_MWH, over_time, step_s


def losses_table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per kind of branch: energy lost in all of that kind, and its share of all losses.

    Losses of lumped branches are R I². The contact line, whose current changes from train to train, has
    the remainder of the recorded losses.
    """
    resistance, kinds = dataset.branch_resistance.to_numpy(), dataset.branch_kind.to_numpy()
    is_lumped = np.isfinite(resistance)
    current = step_values(dataset, "branch_current")[:, is_lumped]
    each = over_time(resistance[is_lumped] * current**2, dataset)
    total = float(over_time(step_values(dataset, "network_losses"), dataset))
    parts = {str(kind): total - each.sum() for kind in kinds[~is_lumped]}
    for kind in kinds[is_lumped]:
        parts[str(kind)] = each[kinds[is_lumped] == kind].sum()
    joules = np.array(list(parts.values()))
    return pd.DataFrame(
        {
            "branch_kind": list(parts),
            "energy_mwh": joules / J_PER_MWH,
            "share": joules / (total if total > 0.0 else np.nan),
        }
    )


def current_table(dataset: xr.Dataset, windows_min: Iterable[float] = WINDOWS_MIN) -> pd.DataFrame:
    """One row per branch and window: highest RMS current, and when; of a time step, the peak."""
    squares = step_values(dataset, "branch_current") ** 2
    names = {
        "branch": dataset.branch.to_numpy(),
        "branch_kind": dataset.branch_kind.to_numpy(),
    }
    table = highest_mean_table(squares, names, step_s(dataset), windows_min)
    table["highest"] **= 0.5
    return table.rename(columns={"highest": "highest_rms_a"})
