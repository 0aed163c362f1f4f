"""What transformer stations lose, and what they take from the grid and give back to it."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.standards.windows import Floats, step_values, table_of
from tpss.results.tables import J_PER_MWH, over_time
from tpss.results.three_phase import station_currents_a
from tpss.scenario.scenario import Scenario
from tpss.scenario.supply import TransformerStation
from tpss.units import si


class TransformerLosses(NamedTuple):
    """Energies of a transformer station, at the terminals of its transformers on the grid's side."""

    station: str
    from_grid_mwh: float
    to_grid_mwh: float
    burnt_mwh: float
    load_mwh: float
    """Lost in the windings of its transformers. [MWh]"""
    no_load_mwh: float
    """Lost by its transformers without load. [MWh]"""
    grid_mwh: float
    """Lost in the resistance of the grid, before its terminals. [MWh]"""


def transformer_losses(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per transformer station of those that tell their losses without load.

    What comes from the grid, less what goes there, is what the station feeds, plus what its transformers
    lose, plus what its resistor burns.  What the grid loses before its terminals is told beside that;
    with the losses by load it is `station_losses`.
    """
    return table_of(list(_rows(dataset, scenario)), TransformerLosses)


def _rows(dataset: xr.Dataset, scenario: Scenario) -> Iterator[TransformerLosses]:
    told = {
        s: station
        for s, station in enumerate(scenario.supply.stations)
        if isinstance(station, TransformerStation) and station.transformer.no_load_loss_kw > 0.0
    }
    if not told:
        return
    current_a = np.abs(station_currents_a(dataset, scenario))
    fed, lost, units = (
        np.nan_to_num(step_values(dataset, name))
        for name in ("station_active_power", "station_losses", "active_converters")
    )
    for s, station in told.items():
        own = fed[:, s], lost[:, s], units[:, s], current_a[:, s]
        yield _row(station, *own, dataset)


def _row(
    station: TransformerStation,
    fed_w: Floats,
    lost_w: Floats,
    units: Floats,
    current_a: Floats,
    dataset: xr.Dataset,
) -> TransformerLosses:
    unit, runs = station.transformer, units > 0.0
    ohm = unit.r_pu * si(station, "no_load_voltage_kv") ** 2 / si(unit, "rated_mva")
    load_w = np.where(runs, ohm * current_a**2 / np.where(runs, units, 1.0), 0.0)
    no_load_w = units * si(unit, "no_load_loss_kw")
    taken_w = fed_w + load_w + no_load_w
    given_w = np.maximum(-taken_w, 0.0)
    burns = station.feedback != "grid"
    of_all = (np.maximum(taken_w, 0.0), 0.0 * given_w if burns else given_w)
    more = (given_w if burns else 0.0 * given_w, load_w, no_load_w, lost_w - load_w)
    energies = (float(over_time(watts, dataset)) / J_PER_MWH for watts in (*of_all, *more))
    return TransformerLosses(station.name, *energies)
