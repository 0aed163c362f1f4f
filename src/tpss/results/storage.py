"""Stores of energy at the line and on board: what they took and gave, and what is left in them."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.places import line_names, lines_of, where_told
from tpss.results.regeneration import OWN_STORAGE
from tpss.results.standards.windows import Floats, step_values
from tpss.results.tables import over_time
from tpss.scenario.scenario import Scenario
from tpss.scenario.storage import EnergyStore

J_PER_KWH = 3.6e6

LARGEST_MOVE = 0.2
"""Share of its capacity that a store may take or give in a step without a note. [1]"""

EMPTIER = 0.01
"""Share of their capacity by which all stores may end emptier than they began without a note. [1]"""

AT_LINE, ON_BOARD = "at the line", "on board"

COLUMNS = (
    "store", "place", "kind", "position_km", "capacity_kwh", "start_kwh", "end_kwh", "charged_kwh",
    "discharged_kwh", "losses_kwh", "peak_charge_kw", "peak_discharge_kw", "lowest_soc", "highest_soc",
    "largest_move",
)  # fmt: skip
"""Columns of the table of stores, but for the line, where there are several."""


class Store(NamedTuple):
    """A store over a run."""

    name: str
    """Its own, or that of its train."""
    place: str
    given: EnergyStore
    position_km: float
    """NaN on board. [km]"""
    line: str
    """Empty where there is one line, and on board."""
    energy_j: Floats
    """Energy at all instants, NaN where its train is not there. [J]"""
    power_w: Floats
    """Power that it takes in each step, not positive where it gives. [W]"""
    lost_w: Floats
    """What it loses in each step. [W]"""

    @property
    def ends_j(self) -> tuple[float, float]:
        """Energy at its first and at its last instant. [J]"""
        there = self.energy_j[np.isfinite(self.energy_j)]
        return (float(there[0]), float(there[-1])) if there.size else (np.nan, np.nan)

    @property
    def largest_move(self) -> float:
        """Most that it took or gave in a step, as a share of its capacity. [1]"""
        moved_j = np.abs(np.diff(self.energy_j))
        return float(np.nanmax(moved_j, initial=0.0)) / self.given.capacity_j


def has_stores(dataset: xr.Dataset) -> bool:
    """Whether a run had stores, at the line or on board."""
    return "store" in dataset.coords or OWN_STORAGE in dataset


def stores_of(dataset: xr.Dataset, scenario: Scenario) -> Iterator[Store]:
    """All stores of a run, those at the line first."""
    if "store" in dataset.coords:
        names, owners = line_names(dataset), lines_of(dataset, "store")
        several = len(scenario.lines_by_name) > 1
        energy_j = dataset.stored_energy.to_numpy()
        power_w, lost_w = (step_values(dataset, name) for name in ("store_power", "store_losses"))
        for m, given in enumerate(scenario.supply.storage):
            line = names[owners[m]] if several else ""
            yield Store(
                given.name, AT_LINE, given, given.position_km, line,
                energy_j[:, m], power_w[:, m], lost_w[:, m],
            )  # fmt: skip
    if OWN_STORAGE in dataset:
        energy_j = dataset.train_stored_energy.to_numpy()
        power_w, lost_w = (
            step_values(dataset, name) for name in (OWN_STORAGE, "train_storage_losses")
        )
        trains = scenario.trains_by_service()
        named = zip(dataset.train.to_numpy(), dataset.service.to_numpy(), strict=True)
        for i, (name, service) in enumerate(named):
            own = trains[str(service)].storage
            if own is not None:
                yield Store(
                    str(name), ON_BOARD, own, np.nan, "",
                    energy_j[:, i], power_w[:, i], lost_w[:, i],
                )  # fmt: skip


def storage(dataset: xr.Dataset, scenario: Scenario) -> pd.DataFrame:
    """One row per store of energy: what it took, gave and lost; empty without any.

    Energies are those at its terminals, but for what it holds.  A state of charge is the energy over the
    usable one.
    """
    found = list(stores_of(dataset, scenario))
    table = pd.DataFrame([_row(each, dataset) for each in found], columns=list(COLUMNS))
    told = where_told({"line": np.array([each.line for each in found])}, line_names(dataset))
    for name, values in told.items():
        table.insert(3, name, values)
    return table


def _row(store: Store, dataset: xr.Dataset) -> tuple[object, ...]:
    powers = {
        "charged": np.maximum(store.power_w, 0.0),
        "discharged": np.maximum(-store.power_w, 0.0),
        "lost": store.lost_w,
    }
    charged, discharged, lost = (
        float(over_time(np.nan_to_num(each)[:, None], dataset)[0]) / J_PER_KWH
        for each in powers.values()
    )
    capacity_j, (start_j, end_j) = store.given.capacity_j, store.ends_j
    soc = store.energy_j / capacity_j
    known = np.isfinite(soc).any()
    return (
        store.name, store.place, store.given.kind, store.position_km, capacity_j / J_PER_KWH,
        start_j / J_PER_KWH, end_j / J_PER_KWH, charged, discharged, lost,
        np.nanmax(powers["charged"], initial=0.0) / 1e3,
        np.nanmax(powers["discharged"], initial=0.0) / 1e3,
        np.nanmin(soc) if known else np.nan, np.nanmax(soc) if known else np.nan, store.largest_move,
    )  # fmt: skip


TOTALS = ("charged_kwh", "discharged_kwh", "losses_kwh", "start_kwh", "end_kwh")
"""Columns that are summed over stores."""


def totals(table: pd.DataFrame) -> dict[str, dict[str, float]]:
    """Sums over all stores by their places, of `TOTALS`; empty without any."""
    sums = table.groupby("place", sort=False)[list(TOTALS)].sum()
    return {str(place): dict(zip(TOTALS, row, strict=True)) for place, *row in sums.itertuples()}


def in_words(table: pd.DataFrame) -> list[str]:
    """What the stores did together, in a line for each place where there are any."""
    return [
        f"Stores {place}: took {sums['charged_kwh']:.2f} kWh, gave {sums['discharged_kwh']:.2f} kWh, "
        f"lost {sums['losses_kwh']:.2f} kWh; they hold {sums['end_kwh']:.2f} kWh at the end, "
        f"{sums['start_kwh']:.2f} kWh at the beginning"
        for place, sums in totals(table).items()
    ]


def storage_notes(dataset: xr.Dataset, scenario: Scenario) -> Iterator[str]:
    """Stores that end emptier than they began, and those of which a step moves a large part."""
    found = list(stores_of(dataset, scenario))
    fallen_j = sum(start_j - end_j for start_j, end_j in (each.ends_j for each in found))
    if fallen_j > EMPTIER * sum(each.given.capacity_j for each in found):
        yield (
            f"the stores hold {fallen_j / J_PER_KWH:.2f} kWh less at the end than at the beginning, "
            "which the stations did not feed: compare runs at the same energy, or with soc_start at "
            "that of the end"
        )
    fast = max(found, key=lambda each: each.largest_move, default=None)
    if fast is not None and fast.largest_move > LARGEST_MOVE:
        yield (
            f"a step moved up to {100.0 * fast.largest_move:.0f} % of the capacity of {fast.name}: its "
            "limits bite early, as they are those of the energy at the step's beginning; a shorter "
            "time_step_min shows by how much"
        )
