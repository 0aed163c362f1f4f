"""Result of a simulation, with tables, evidence for standards, and saving."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import pandas as pd
import xarray as xr

from tpss.events import tell
from tpss.extras import demand
from tpss.results import store, tables
from tpss.results.autotransformers import autotransformers
from tpss.results.converter_losses import converter_losses
from tpss.results.file_kinds import Kind
from tpss.results.judged_rails import JudgedRails
from tpss.results.regeneration import regeneration
from tpss.results.shown import as_table, in_a_line
from tpss.results.standards.evidence import Evidence, gather
from tpss.results.stops import stops
from tpss.results.storage import storage
from tpss.results.thermal.judge import Thermal, thermal_of
from tpss.results.transformer_losses import transformer_losses
from tpss.results.waits import waits
from tpss.scenario.scenario import Scenario

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STANDARDS = "standards"
"""Part of the summary that takes as long as all else, and is computed on demand."""

THERMAL = "thermal"
"""Part of the summary of a run in which something has a rating, likewise."""


@dataclass(frozen=True)
class Result:
    """The result of a simulation.

    Attributes
    ----------
    scenario : Scenario
        The scenario as run.
    dataset : xarray.Dataset
        Everything that was recorded; each variable carries its unit and a long name.
    figures : dict
        The summary, with or without its part ``standards``.
    """

    scenario: Scenario
    dataset: xr.Dataset
    figures: dict[str, Any]

    def __repr__(self) -> str:
        return in_a_line(self.figures, self.dataset.sizes["train"])

    def _repr_html_(self) -> str:
        return as_table(self.figures, self.dataset.sizes["train"])

    @cached_property
    def summary(self) -> dict[str, Any]:
        """Key figures, the audit, the run's provenance, and figures of `standards` and `thermal`."""
        if STANDARDS in self.figures:
            return self.figures
        figures = {**self.figures, STANDARDS: self.standards.as_dict()}
        if self.equipment.elements:
            figures[THERMAL] = self.equipment.as_dict()
        return figures

    @property
    def status(self) -> str:
        """``finished``, ``collapsed``, ``stalled``, ``deadlocked`` or ``interrupted``."""
        return str(self.figures["status"])

    @property
    def audit(self) -> dict[str, Any]:
        """Figures of the audit; ``passed`` says whether all are within their limits."""
        audit: dict[str, Any] = self.figures["audit"]
        return audit

    @cached_property
    def trips(self) -> pd.DataFrame:
        """One row per train: times, distance, energy, lowest voltage."""
        return tables.trips(self.dataset)

    @cached_property
    def stops(self) -> pd.DataFrame:
        """One row per train and station where it stops: arrival, departure, dwell."""
        return stops(self.dataset, self.scenario)

    @cached_property
    def waits(self) -> pd.DataFrame:
        """One row per time that a train stood because of others; empty unless trains are kept apart."""
        kept_apart = self.scenario.signalling.separation != "none"
        return waits(self.dataset if kept_apart else self.dataset.isel(train=slice(0)))

    @cached_property
    def stations(self) -> pd.DataFrame:
        """One row per feeding station: energy, peaks, loading, converters."""
        return tables.stations(self.dataset)

    @cached_property
    def regeneration(self) -> pd.DataFrame:
        """One row per train: what it brakes and where that goes; empty without electric brakes."""
        return regeneration(self.dataset, self.scenario)

    @cached_property
    def judged_rails(self) -> JudgedRails:
        """Rails that are conductors of their own, held against their limits."""
        return JudgedRails(self.dataset, self.scenario)

    @cached_property
    def rails(self) -> pd.DataFrame:
        """One row per place: voltage of the rails to earth; empty unless they are conductors."""
        return self.judged_rails.voltages

    @cached_property
    def stray_current(self) -> pd.DataFrame:
        """One row per line: current that leaves the rails of a direct current; otherwise empty."""
        return self.judged_rails.stray_current

    @cached_property
    def autotransformers(self) -> pd.DataFrame:
        """One row per autotransformer: its currents and its loading; empty if there are none."""
        return autotransformers(self.dataset, self.scenario)

    @cached_property
    def converter_losses(self) -> pd.DataFrame:
        """One row per converter station that describes losses: the 50 Hz side; otherwise empty."""
        return converter_losses(self.dataset, self.scenario)

    @cached_property
    def transformer_losses(self) -> pd.DataFrame:
        """One row per transformer station that tells its losses without load; otherwise empty."""
        return transformer_losses(self.dataset, self.scenario)

    @cached_property
    def storage(self) -> pd.DataFrame:
        """One row per store of energy: what it took, gave and lost; empty without any."""
        return storage(self.dataset, self.scenario)

    @cached_property
    def equipment(self) -> Thermal:
        """Judgement of the equipment that has a rating, with its thermal state at every instant."""
        return thermal_of(self.dataset, self.scenario)

    @cached_property
    def thermal(self) -> pd.DataFrame:
        """One row per piece of equipment with a rating: how hot it gets, and whether it bears that."""
        return self.equipment.table

    @cached_property
    def thermal_windows(self) -> pd.DataFrame:
        """One row per piece of equipment with a rating and window: its highest r.m.s. load."""
        return self.equipment.windows

    @cached_property
    def train_steps(self) -> pd.DataFrame:
        """One row per train and instant: motion, forces, voltage, powers."""
        return tables.train_steps(self.dataset)

    @cached_property
    def standards(self) -> Evidence:
        """Key figures by the definitions of the standards: voltages, energies, loads, violations."""
        return gather(self.dataset, self.scenario, self.judged_rails)

    def with_standards(self, changes: Mapping[str, Any]) -> "Result":
        """The same run, judged by other criteria.

        Parameters
        ----------
        changes : mapping of str to value
            Key paths below the scenario's ``standards``, such as ``"peak_from_min"`` or
            ``"voltage_limits.umin1_kv"``, and their new values; None removes a key.

        Raises
        ------
        ScenarioError
            The changed scenario has faults.
        """
        paths = {f"standards.{path}": value for path, value in changes.items()}
        on_demand = {STANDARDS, THERMAL}
        others = {key: value for key, value in self.figures.items() if key not in on_demand}
        return replace(self, scenario=self.scenario.with_(paths), figures=others)

    def save(self, folder: str | Path | None = None, *, force: bool = False) -> Path:
        """Save into a folder, which is written whole or not at all.

        Parameters
        ----------
        folder : path, optional
            Folder to make; by default the first of ``results/<name>-001``, ``-002``, ... that is
            free.
        force : bool
            Whether an existing result folder may be replaced.

        Returns
        -------
        Path
            The folder.

        Raises
        ------
        ResultError
            The folder exists, or cannot be written.
        """
        place = None if folder is None else Path(folder)
        saved = store.save(self.scenario, self.dataset, self.summary, place, force)
        tell("saved", scenario=self.scenario.name, folder=str(saved))
        return saved

    def to_csv(self, folder: str | Path, *, force: bool = False) -> list[Path]:
        """Write all tables into a folder, as a CSV file each.

        Parameters
        ----------
        folder : path
            Made if it does not exist.
        force : bool
            Whether files of these names may be replaced.

        Raises
        ------
        ResultError
            A file exists, or the folder cannot be written.
        """
        from tpss.results.export import export

        return export(self, Kind.CSV, Path(folder), force=force)

    def to_parquet(self, folder: str | Path, *, force: bool = False) -> list[Path]:
        """Write all tables into a folder, as a Parquet file each; as `to_csv`, and pyarrow is needed."""
        from tpss.results.export import export

        return export(self, Kind.PARQUET, Path(folder), force=force)

    def to_excel(self, file: str | Path, *, force: bool = False) -> Path:
        """Write all tables into a workbook of Excel, as a sheet each, behind a summary and the scenario.

        Parameters
        ----------
        file : path
            Its name ends in ``.xlsx``.
        force : bool
            Whether a file that is there may be replaced.

        Raises
        ------
        ResultError
            The file exists or cannot be written, has another ending, or a table is too long for a sheet.
        """
        from tpss.results.export import export_workbook

        return export_workbook(self, Path(file), force=force)

    def report(self, file: str | Path, *, force: bool = False) -> Path:
        """Write a report as one file of HTML; `tpss.write_report` can do more.

        Raises
        ------
        ResultError
            The file exists, or cannot be written.
        """
        demand("report")
        from tpss.report.html import write_report

        return write_report(self, file, force=force)

    def plot(
        self,
        figure: str = "voltage",
        train: str | None = None,
        against: Literal["distance", "time"] = "distance",
    ) -> "Figure":
        """Draw a figure.

        Parameters
        ----------
        figure : str
            As of ``tpss plot --figure``, such as ``"time-distance"``, ``"journey"`` or ``"stations"``.
        train : str, optional
            The train of figures of a single one; the studied one by default.
        against : {"distance", "time"}
            Quantity of the horizontal axis of a journey.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; its ``savefig`` writes it.

        Raises
        ------
        ResultError
            The audit failed, or there is no such figure, train or quantity, or nothing to draw.
        """
        demand("figures")
        from tpss.report.figures.catalogue import draw

        return draw(figure, self, train, against)


def load_result(folder: str | Path) -> Result:
    """Load a result written by `Result.save` or ``tpss run``.

    Raises
    ------
    ResultError
        The folder holds no result, or a damaged one.
    """
    return Result(*store.load(Path(folder)))
