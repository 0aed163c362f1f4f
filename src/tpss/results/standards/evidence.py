"""Key figures of a run by the definitions of the standards."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.judged_rails import JudgedRails
from tpss.results.rails import has_rails
from tpss.results.standards import (
    energy,
    network_load,
    station_load,
    useful_voltage,
    voltage_limits,
)
from tpss.results.standards.low_voltage import LowVoltagePlace, find_low_voltage_places
from tpss.results.standards.neutral_sections import AcrossNeutral, across_neutral_sections
from tpss.results.standards.unbalance import (
    Unbalance,
    unbalance_in_words,
    unbalance_of,
    unbalance_violations,
)
from tpss.results.standards.violations import Violation, find_violations, voltage_in_words
from tpss.results.standards.voltage_limits import Excursion, find_excursions
from tpss.results.standards.windows import WINDOWS_MIN, Floats, table_of
from tpss.scenario.scenario import Scenario
from tpss.scenario.standards import Standards

MOST_WORDS = 10
"""Highest number of violations that a summary lists in words."""


@dataclass(frozen=True, eq=False)
class Evidence:
    """Key figures of a run by the definitions of EN 50122, EN 50163, EN 50388 and EN 50463.

    They are evidence for an assessment, which is more than a simulation: limits, durations and
    minima come from the scenario's ``standards`` and are to be checked against the edition in
    force. All tables are of pandas; a figure that the run is too short for is NaN, and `notes` says
    so.

    Attributes
    ----------
    dataset : xarray.Dataset
        What was recorded.
    standards : Standards
        The part of the scenario by which it is judged.
    line_speed_kmh : float
        Highest speed limit of the line, which chooses the least mean useful voltage. [km/h]
    ends_km : mapping
        Beginnings and ends of the lines by their names, an empty one for a single line. [km]
    mass_t : array, shape (trains,)
        Mass of each whole train. [t]
    busbars : sequence of Unbalance
        Busbars of the grid whose transformer stations tell their phases.
    across : sequence of AcrossNeutral
        Neutral sections between phases that are told.
    of_rails : JudgedRails, optional
        Rails that are conductors of their own.
    """

    dataset: xr.Dataset
    standards: Standards
    line_speed_kmh: float
    ends_km: useful_voltage.Ends
    mass_t: Floats
    busbars: Sequence[Unbalance] = ()
    across: Sequence[AcrossNeutral] = ()
    of_rails: JudgedRails | None = None

    @cached_property
    def voltage(self) -> pd.DataFrame:
        """EN 50163, one row per train: time beyond each limit, longest time, verdict."""
        limits = self.standards.voltage_limits
        return voltage_limits.voltage_table(self.dataset, self._excursions, limits)

    @cached_property
    def excursions(self) -> pd.DataFrame:
        """EN 50163, one row per uninterrupted time of a train beyond a limit: when, where, how far."""
        return table_of(self._excursions, Excursion)

    @cached_property
    def low_voltage_places(self) -> pd.DataFrame:
        """EN 50163, one row per stretch of line below Umin2 or Umin1: how low, when, which trains."""
        places = find_low_voltage_places(self._excursions, self.standards.voltage_limits)
        return table_of(places, LowVoltagePlace)

    @cached_property
    def useful_voltage_zones(self) -> pd.DataFrame:
        """EN 50388, one row per zone: mean useful voltage in the peak window."""
        zones: Iterable[Any] = self.standards.zones
        told = len(self.ends_km) > 1
        sections = [
            useful_voltage.Section(z.name, z.line if told else "", z.from_km, z.to_km)
            for z in zones
        ]
        sections = sections or useful_voltage.feeding_sections(self.dataset, self.ends_km)
        return useful_voltage.zone_table(
            self.dataset, sections, self.ends_km, self._window, self.least_useful_voltage_kv
        )

    @cached_property
    def useful_voltage_trains(self) -> pd.DataFrame:
        """EN 50388, one row per train: mean useful voltage in the peak window."""
        return useful_voltage.train_table(self.dataset, self._window, self.least_useful_voltage_kv)

    @property
    def dimensioning_train(self) -> str | None:
        """EN 50388, the train with the lowest mean useful voltage of those present for 60 s."""
        train = useful_voltage.dimensioning_train(self.useful_voltage_trains)
        return None if train is None else train[0]

    @property
    def least_useful_voltage_kv(self) -> float | None:
        """EN 50388, the least mean useful voltage on this line. [kV]"""
        limits = self.standards.voltage_limits
        is_fast = self.line_speed_kmh > useful_voltage.FAST_KMH
        return limits.mean_useful_fast_kv if is_fast else limits.mean_useful_kv

    @cached_property
    def energy(self) -> pd.DataFrame:
        """EN 50463, one row per train: energy consumed and regenerated, active and reactive."""
        return energy.energy_table(self.dataset, self.mass_t)

    @cached_property
    def energy_blocks(self) -> pd.DataFrame:
        """EN 50463, the same in blocks of five minutes."""
        return energy.energy_blocks(self.dataset)

    @cached_property
    def station_power(self) -> pd.DataFrame:
        """One row per station and window: highest mean power; that of a time step is the peak."""
        return station_load.power_table(self.dataset)

    @cached_property
    def load_duration(self) -> pd.DataFrame:
        """Load duration curve of every station: for how long which power is reached or exceeded."""
        return station_load.load_duration_table(self.dataset)

    @cached_property
    def converters(self) -> pd.DataFrame:
        """One row per station and number of converters: how long that number was running."""
        return station_load.converter_table(self.dataset)

    @cached_property
    def losses(self) -> pd.DataFrame:
        """One row per kind of branch (contact line, transformer and so on): energy lost in it."""
        return network_load.losses_table(self.dataset)

    @cached_property
    def branch_current(self) -> pd.DataFrame:
        """One row per branch and window: highest RMS current; that of a time step is the peak."""
        return network_load.current_table(self.dataset)

    @cached_property
    def unbalance(self) -> pd.DataFrame:
        """One row per busbar of the grid whose stations tell their phases: unbalance, phase currents."""
        return table_of(self.busbars, Unbalance)

    @cached_property
    def neutral_sections(self) -> pd.DataFrame:
        """One row per neutral section between two phases: the voltage across it."""
        return table_of(self.across, AcrossNeutral)

    @property
    def unbalance_in_words(self) -> str:
        """Unbalance of the busbar that is closest to its limit; empty if none is told."""
        return unbalance_in_words(self.busbars)

    @cached_property
    def violations(self) -> pd.DataFrame:
        """A row for each violation of a limit, in figures and in words, the worst first."""
        return table_of(self._violations, Violation)

    @property
    def voltage_in_words(self) -> str:
        """That no train was beyond a permanent limit, or for how long one was, within the allowed time.

        Empty if there is a violation, see `violations`, or if no voltage was recorded.
        """
        seen = np.isfinite(self.dataset.pantograph_voltage.to_numpy()).any()
        if not seen or any(each.violation for each in self._excursions):
            return ""
        return voltage_in_words(self._excursions, self.standards.voltage_limits)

    @property
    def notes(self) -> list[str]:
        """Notes on missing figures."""
        run_min = float(self.dataset.time[-1]) / 60.0
        the_run = f"the run ({round(run_min, 2):g} min)"
        notes = []
        longer = [f"{window:g}" for window in WINDOWS_MIN if window > run_min * (1.0 + 1e-9)]
        if longer:
            notes.append(
                f"Windows of {', '.join(longer)} min are longer than {the_run}: their means are NaN"
            )
        if self._window is None:
            begin, end = self.standards.peak_from_min, self.standards.peak_to_min
            upto = "the end of the run" if end is None else f"{end:g} min"
            notes.append(
                f"The peak window of {begin:g} min to {upto} is not within {the_run}: "
                "mean useful voltages are NaN"
            )
        if self.dataset.attrs["status"] != "finished":
            notes.append("The run ended early: all figures are of the time until then")
        return notes

    def as_dict(self) -> dict[str, Any]:
        """The figures for a summary, of plain types only."""
        return {
            "voltage": self._voltage_figures(),
            "mean_useful_voltage": self._useful_voltage_figures(),
            "losses_mwh": _plain(self.losses.branch_kind, self.losses.energy_mwh),
            "station_power_mw": self._station_powers(),
            "violations": len(self._violations),
            "worst_violations": [each.words for each in self._violations[:MOST_WORDS]],
            "notes": self.notes,
        }

    def _voltage_figures(self) -> dict[str, float | int]:
        figures: dict[str, float | int] = {}
        for bound in voltage_limits.bounds(self.standards.voltage_limits):
            own = [each for each in self._excursions if each.limit == bound.name]
            key = f"{bound.side}_{bound.name.lower()}"
            figures[f"trains_{key}"] = len({each.train for each in own})
            figures[f"longest_{key}_min"] = max((each.duration_min for each in own), default=0.0)
        return figures

    def _station_powers(self) -> dict[str, dict[str, float | None]]:
        table = self.station_power
        labels = [f"{window:g} min" for window in table.window_min]
        rows = list(zip(table.station, labels, table.highest_mean_mw, strict=True))
        return {
            str(station): _plain(*zip(*((w, mw) for s, w, mw in rows if s == station), strict=True))
            for station in dict.fromkeys(table.station)
        }

    def _useful_voltage_figures(self) -> dict[str, Any]:
        zones = self.useful_voltage_zones
        train = useful_voltage.dimensioning_train(self.useful_voltage_trains)
        name, mean_kv = train or (None, None)
        return {
            "zones_kv": _plain(zones.zone, zones.mean_useful_kv),
            "dimensioning_train": name,
            "dimensioning_train_kv": mean_kv,
            "minimum_kv": self.least_useful_voltage_kv,
        }

    @cached_property
    def _excursions(self) -> list[Excursion]:
        return find_excursions(self.dataset, self.standards.voltage_limits)

    @cached_property
    def _violations(self) -> list[Violation]:
        found = find_violations(
            self._excursions,
            self.useful_voltage_zones,
            self.useful_voltage_trains,
            self.standards.voltage_limits,
        )
        of_rails = self.of_rails.violations if self.of_rails is not None else ()
        return [*found, *of_rails, *unbalance_violations(self.busbars)]

    @property
    def _window(self) -> slice | None:
        return useful_voltage.steps_in_window(
            self.dataset, self.standards.peak_from_min, self.standards.peak_to_min
        )


def _plain(names: Iterable[Any], values: Iterable[float]) -> dict[str, float | None]:
    """Values by name; None for one that is not a number."""
    return {
        str(name): float(value) if np.isfinite(value) else None
        for name, value in zip(names, values, strict=True)
    }


def gather(dataset: xr.Dataset, scenario: Scenario, of_rails: JudgedRails) -> Evidence:
    """Evidence of a run, whose rails are judged already."""
    trains, lines = scenario.trains_by_service(), scenario.lines_by_name
    several = len(lines) > 1
    return Evidence(
        dataset=dataset,
        standards=scenario.standards,
        line_speed_kmh=max(
            limit.speed_kmh
            for line in scenario.lines_by_name.values()
            for limit in line.speed_limits
        ),
        ends_km={
            name if several else "": (line.begins_at_km, line.end_km)
            for name, line in lines.items()
        },
        mass_t=np.array([trains[name].mass_t for name in dataset.service.to_numpy()], dtype=float),
        busbars=unbalance_of(dataset, scenario),
        across=across_neutral_sections(dataset, scenario),
        of_rails=of_rails if has_rails(dataset) else None,
    )
