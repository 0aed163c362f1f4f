"""A scenario with its converters switched by their loading, against the same with all of them on."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from tpss.api import prepare
from tpss.converter_control.break_even import break_even_va
from tpss.errors import Finding, ScenarioError
from tpss.results.grid_side import LossLaw, law_of
from tpss.results.result import Result
from tpss.results.standards.windows import Floats
from tpss.run.run import Progress
from tpss.scenario.fields import library_name
from tpss.scenario.scenario import Scenario
from tpss.units import si

ALL_ON, LOADING = "all-on", "loading"
"""Controls that are compared, as a scenario names them."""

DAY_MIN = 1440.0


@dataclass(frozen=True)
class Comparison:
    """Two runs that differ in the control of converters alone."""

    all_on: Result
    by_loading: Result

    @property
    def runs(self) -> dict[str, Result]:
        """Both, by their controls."""
        return {ALL_ON: self.all_on, LOADING: self.by_loading}

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per station that describes losses: what it loses in a day, and what switching saves.

        A day is one with the traffic of the run all through.  Stations with one converter, or several
        types, are in it too: nothing is switched there, but power moves from one station to another.
        """
        lost = {key: self._per_day(run, "losses_mwh") for key, run in self.runs.items()}
        switched = self.by_loading.converter_losses
        loading = self.by_loading.stations.set_index("station").peak_loading
        stations = self.by_loading.scenario.supply.stations
        installed = {station.name: station.installed for station in stations}
        return pd.DataFrame(
            {
                "station": switched.station,
                "converters": [installed[name] for name in switched.station],
                "all_on_mwh": lost[ALL_ON],
                "by_loading_mwh": lost[LOADING],
                "saved_mwh": lost[ALL_ON] - lost[LOADING],
                "starts": self._per_day(self.by_loading, "starts"),
                "peak_loading": loading[switched.station].to_numpy(),
            }
        )

    @property
    def saved_at_the_grid_mwh(self) -> float:
        """What these stations take less from the grid in a day, less what they give back. [MWh]

        It differs from what converters save by what the network loses more or less.
        """
        taken = {
            key: float(np.sum(self._per_day(run, "from_grid_mwh")))
            - float(np.sum(self._per_day(run, "to_grid_mwh")))
            for key, run in self.runs.items()
        }
        return taken[ALL_ON] - taken[LOADING]

    @cached_property
    def break_even(self) -> pd.DataFrame:
        """Up to which power one converter less loses less, by types and numbers of converters.

        At that power stand the loading of all of them, and that of one less.
        """
        rows = []
        for name, (law, most) in self._laws.items():
            for n in range(2, most + 1):
                power_va = break_even_va(n, law)
                share = power_va / law.rating_va
                rows.append((name, n, power_va / 1e6, share / n, share / (n - 1)))
        columns = ["type", "converters", "power_mva", "loading", "loading_of_one_less"]
        return pd.DataFrame(rows, columns=columns)

    @property
    def _laws(self) -> dict[str, tuple[LossLaw, int]]:
        """Losses of the types of converters, and the most that a station has, by names."""
        found: dict[str, tuple[LossLaw, int]] = {}
        supply = self.by_loading.scenario.supply
        own = supply.converter_types or {}
        for station in supply.converter_stations:
            kind = station.type
            if kind.losses is None:
                continue
            law = law_of(kind.losses, si(kind, "rating_mva"))
            named = (name for name, each in own.items() if each == kind)
            name = next(named, library_name("converters", kind))
            if found.get(name, (law, 0))[0] != law:  # several own types
                name = f"{name} of {station.name}"
            found[name] = law, max(found.get(name, (law, 0))[1], station.converters)
        return found

    def _per_day(self, run: Result, column: str) -> Floats:
        """A column of the stations' table, for a day."""
        days = run.summary["duration_min"] / DAY_MIN
        return np.asarray(run.converter_losses[column].to_numpy(dtype=float) / days)


def compare_controls(
    scenario: Scenario,
    progress: Callable[[Progress], None] | None = None,
    interrupted: Sequence[int] | None = None,
) -> Comparison:
    """Run a scenario with all converters on, and with all stations switched by their loading.

    Parameters
    ----------
    scenario : Scenario
        Without a time step, that of the run with all converters on is chosen for both.
    progress, interrupted : optional
        As of `Prepared.run`; of both runs.

    Raises
    ------
    ScenarioError
        No station describes losses of its converters.
    """
    if all(each.type.losses is None for each in scenario.supply.converter_stations):
        problem = "no station describes what its converters lose, so switching them saves nothing"
        remedy = (
            "give their type losses, such as losses = { idle_kw = 300.0 }, or take "
            '"Q48/Q49 with losses (estimate)"'
        )
        place = "supply.converter_stations"
        raise ScenarioError([Finding(scenario.given_source, place, "", problem, remedy)])
    first = prepare(_with(scenario, ALL_ON))
    second = prepare(_with(first.scenario, LOADING))
    return Comparison(*(prepared.run(progress, interrupted) for prepared in (first, second)))


def _with(scenario: Scenario, control: str) -> Scenario:
    return scenario.with_({"supply.converter_stations.*.control": control})
