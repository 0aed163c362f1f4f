r"""Currents of autotransformers, and how they are loaded.

Both halves of a winding carry the current I of the link, the neutral, which leads to the rails, 2 I.  At
rated power S the neutral carries S over half of the whole voltage:

.. math:: Ld = 2 I \, U_{1/2} / S .
"""

import numpy as np
import pandas as pd
import xarray as xr

from tpss.model.conductors import AUTOTRANSFORMER, autotransformers_of, half_voltage_v
from tpss.model.supply import layouts_of
from tpss.results.places import line_names, where_told
from tpss.results.standards.windows import highest_means, step_values
from tpss.scenario.scenario import Scenario

WINDOWS_MIN = (15.0, 60.0)
"""Windows of the highest r.m.s. loadings. [min]"""


def autotransformers(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per autotransformer: its currents, and its loading.

    Loadings over windows are r.m.s.; NaN if the run is shorter.  Empty if there are none.
    """
    units = [
        (line, km, each)
        for line in layouts_of(scenario.lines_by_name)
        for km, each in autotransformers_of(scenario.supply, line)
    ]
    windows = [f"rms_{width:g}_min_loading" for width in WINDOWS_MIN]
    columns = (
        "line",
        "position_km",
        "highest_winding_a",
        "highest_neutral_a",
        "peak_loading",
        *windows,
    )
    if not units or "link_current" not in dataset or dataset.sizes["time"] < 2:
        return pd.DataFrame(columns=columns)
    chosen = np.flatnonzero(dataset.link_kind.to_numpy() == AUTOTRANSFORMER)
    current = np.nan_to_num(step_values(dataset, "link_current")[:, chosen])
    rated_a = [each.rated_mva * 1e6 / half_voltage_v(scenario.supply) for _, _, each in units]
    loading = 2.0 * current / np.array(rated_a)
    per_min, names = 60.0 / float(dataset.attrs["time_step_s"]), line_names(dataset)
    means = {
        name: np.sqrt(highest_means(loading**2, width * per_min)[0])
        for name, width in zip(windows, WINDOWS_MIN, strict=True)
    }
    table = {
        "line": [names[line.number] for line, _, _ in units],
        "position_km": [km for _, km, _ in units],
        "highest_winding_a": current.max(axis=0),
        "highest_neutral_a": 2.0 * current.max(axis=0),
        "peak_loading": loading.max(axis=0),
        **means,
    }
    return pd.DataFrame(where_told(table, names))
