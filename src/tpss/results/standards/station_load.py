"""Load of feeding stations: mean powers, the load duration curve, converters running."""

from collections.abc import Iterable

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.standards.windows import WINDOWS_MIN, highest_mean_table, step_values
from tpss.results.tables import over_time, short_s, step_s


def power_table(dataset: xr.Dataset, windows_min: Iterable[float] = WINDOWS_MIN) -> pd.DataFrame:
    """One row per station and window: highest mean active power, and when; of a time step, the peak."""
    power_mw = step_values(dataset, "station_active_power") / 1e6
    names = {"station": dataset.station.to_numpy()}
    table = highest_mean_table(power_mw, names, step_s(dataset), windows_min)
    return table.rename(columns={"highest": "highest_mean_mw"})


def load_duration_table(dataset: xr.Dataset) -> pd.DataFrame:
    """The load duration curve of each station: the power that it reaches for a time, or exceeds."""
    power_mw = step_values(dataset, "station_active_power") / 1e6
    steps, stations = power_mw.shape
    order = np.argsort(-power_mw, axis=0, kind="stable")
    # The last step, which may be shorter than the others, shortens all that comes after it.
    duration_s = np.arange(1.0, steps + 1.0)[:, np.newaxis] * step_s(dataset)
    duration_s = duration_s - np.cumsum(order == steps - 1, axis=0) * short_s(dataset)
    return pd.DataFrame(
        {
            "station": np.repeat(dataset.station.to_numpy(), steps),
            "duration_min": duration_s.T.ravel() / 60.0,
            "power_mw": np.take_along_axis(power_mw, order, 0).T.ravel(),
        }
    )


def converter_table(dataset: xr.Dataset) -> pd.DataFrame:
    """One row per station and number of converters: how long that number was running."""
    running = step_values(dataset, "active_converters")
    rows = [
        (str(station), int(number), float(over_time((column == number) * 1.0, dataset)) / 60.0)
        for station, column in zip(dataset.station.to_numpy(), running.T, strict=True)
        for number in np.unique(column)
    ]
    return pd.DataFrame(rows, columns=["station", "converters", "duration_min"])
