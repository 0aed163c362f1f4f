"""A result beside measured series: aligned in time, and what they have in common."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from tpss.errors import ResultError
from tpss.measured.begin import Begin, begin_of
from tpss.measured.columns import Column
from tpss.measured.figures import Aligned, Figures, Window, durations_of, figures_of, windows_of
from tpss.measured.grid import Grid, Pairs, aligned_means, common_grid
from tpss.measured.held import WHOLE, Held
from tpss.measured.load import Measured, Stamps, read_measured
from tpss.measured.offset import Offset, find_offset
from tpss.measured.quantities import QUANTITIES, simulated_values
from tpss.results.result import Result
from tpss.scenario.clock import clock_at


@dataclass(frozen=True, eq=False)
class MeasuredComparison:
    """A result compared with measured series.

    Attributes
    ----------
    result : Result
    file : Path
        The measured series.
    grid : Grid
        Intervals over which means are compared.
    series : tuple of Aligned
    begins : str
        What the time of the file is at minute 0 of the run, with the offset.
    offset : Offset, optional
        The offset that was looked for.
    notes : tuple of str
        What is told: how the file was read, its gaps, what is left out.
    """

    result: Result
    file: Path
    grid: Grid
    series: tuple[Aligned, ...]
    begins: str
    offset: Offset | None
    notes: tuple[str, ...]

    @cached_property
    def figures(self) -> pd.DataFrame:
        """One row per series: means, errors, energies; its columns are those of `Figures`."""
        rows = [figures_of(each, self.grid.step_s) for each in self.series]
        return pd.DataFrame(rows, columns=list(Figures._fields))

    @cached_property
    def windows(self) -> pd.DataFrame:
        """One row per series and window: highest mean powers, lowest mean voltages."""
        grid = self.grid
        rows = [row for each in self.series for row in windows_of(each, grid.begin_s, grid.step_s)]
        return pd.DataFrame(rows, columns=list(Window._fields))

    @cached_property
    def durations(self) -> pd.DataFrame:
        """Duration curves: for how long which value is reached or exceeded, by series."""
        tables = []
        for each in self.series:
            measured, simulated = durations_of(each)
            table = pd.DataFrame({"measured": measured, "simulated": simulated})
            minutes = np.arange(1.0, len(table) + 1.0) * self.grid.step_s / 60.0
            table.insert(0, "duration_min", minutes)
            table.insert(0, "unit", each.shown.unit)
            table.insert(0, "series", each.name)
            tables.append(table)
        return pd.concat(tables, ignore_index=True)

    @cached_property
    def aligned(self) -> pd.DataFrame:
        """Means over the common intervals, one row per interval; empty where they are not known."""
        from_min = self.grid.edges_s[:-1] / 60.0
        columns: dict[str, Any] = {"from_min": from_min}
        starts_s = self.result.scenario.simulation.start_s
        if starts_s is not None:
            columns["clock"] = [clock_at(minute, starts_s) for minute in from_min.tolist()]
        for each in self.series:
            columns[f"{each.name} measured [{each.shown.unit}]"] = each.measured
            columns[f"{each.name} simulated [{each.shown.unit}]"] = each.simulated
        return pd.DataFrame(columns)

    def as_dict(self) -> dict[str, Any]:
        """How the two were compared: what a reader of the tables has to know."""
        offset: Mapping[str, Any] | None = None if self.offset is None else self.offset._asdict()
        return {
            "scenario": self.result.scenario.name,
            "file": self.file.name,
            "begins": self.begins,
            "offset": None if offset is None else {k: _plain(v) for k, v in offset.items()},
            "interval_min": self.grid.step_s / 60.0,
            "from_min": self.grid.begin_s / 60.0,
            "intervals": self.grid.intervals,
            "notes": list(self.notes),
        }

    def save(self, folder: str | Path, *, force: bool = False) -> list[Path]:
        """Write tables and how they came about into a folder, all of them or none.

        They are aligned.csv, figures.csv, windows.csv, durations.csv and comparison.json.

        Raises
        ------
        ResultError
            Files exist and may not be replaced, or the folder cannot be written.
        """
        from tpss.files.several import save_files
        from tpss.measured.save import contents

        return save_files(Path(folder), contents(self), force)


def _plain(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


def compare_with_measurements(
    result: Result,
    file: str | Path,
    *,
    columns: str | Path | None = None,
    begins: str | None = None,
    find_offset_min: float | None = None,
    stamps: Stamps = "begin",
    step_min: float | None = None,
) -> MeasuredComparison:
    """Compare a result with measured series of stations, trains or nodes.

    Both are series of values that hold for a while.  They are compared by their means over common
    intervals, in each of which both must be known all through: an interval that a gap touches is left
    out as a whole, and told.

    Parameters
    ----------
    result : Result
    file : path
        CSV: a column of times, and columns ``QUANTITY:ELEMENT [UNIT]`` such as
        ``station_active_power:West [MW]``.  Quantities are station_active_power,
        station_reactive_power, station_voltage, active_power, reactive_power, pantograph_voltage and
        node_voltage.
    columns : path, optional
        TOML file that explains columns with other headings.
    begins : str, optional
        What the time of the file is at minute 0 of the run: a time of the clock, a date with one, or
        minutes of a file that counts; by default the scenario's ``starts_at``, or minute 0.
    find_offset_min : float, optional
        Look for the offset of the file's clock up to this on both sides, by least squares. [min]
    stamps : {"begin", "end"}
        Whether the time of a value is the beginning of the interval over which it holds, or its end.
    step_min : float, optional
        Length of the common intervals; by default the longer one of both steps. [min]

    Returns
    -------
    MeasuredComparison

    Raises
    ------
    ScenarioError
        The file or the one that explains its columns has faults, or shares no time with the run.
    ResultError
        The audit of the result failed, no step was simulated, or a length of time does not fit.
    """
    _demand_usable(result)
    _demand_positive("find_offset_min", find_offset_min)
    _demand_positive("step_min", step_min)
    place, map_file = Path(file), None if columns is None else Path(columns)
    measured = read_measured(place, map_file, stamps, result)
    run_step_s = float(result.dataset.attrs["time_step_s"])
    step_s = _step_s(step_min, measured, run_step_s)
    begin = begin_of(
        measured,
        float(result.dataset.time[-1]),
        result.scenario.simulation.start_s,
        begins,
        find_offset_min is not None,
    )
    run = {column: _simulated(column, result) for column in measured.series}
    zero_s, offset = begin.seconds, None
    if find_offset_min is not None:
        pairs = _pairs(measured, run, zero_s)
        offset = _offset(measured, pairs, 60.0 * find_offset_min, run_step_s)
        zero_s += offset.seconds
    pairs = _pairs(measured, run, zero_s)
    grid = common_grid(measured, pairs, zero_s, step_s, run_step_s)
    series = aligned_means(measured, pairs, grid)
    return MeasuredComparison(
        result,
        place,
        grid,
        tuple(series),
        measured.times.in_words(round(zero_s, 2)),
        offset,
        (*measured.notes, *_notes(begin, offset, grid, series)),
    )


def _demand_usable(result: Result) -> None:
    if not result.audit["passed"]:
        raise ResultError(
            "the audit of the result failed, so its figures cannot be trusted and are not compared: "
            + "; ".join(result.audit["failures"])
        )
    if result.dataset.sizes["time"] < 2:
        raise ResultError("no time step was simulated, so there is nothing to compare")


def _demand_positive(name: str, value: float | None) -> None:
    if value is not None and not 0.0 < value < math.inf:
        raise ResultError(
            f"{name} = {value} is not positive; give minutes above 0, or leave it out"
        )


def _step_s(step_min: float | None, measured: Measured, run_step_s: float) -> float:
    """Length of the common intervals; shorter ones than the longer step would tell nothing new. [s]"""
    longer_s = max(run_step_s, measured.step_s)
    if step_min is None:
        return longer_s
    if 60.0 * step_min < longer_s * (1.0 - WHOLE):
        whose = "file" if measured.step_s > run_step_s else "run"
        raise ResultError(
            f"intervals of {step_min:g} min are shorter than the steps of the {whose}, of "
            f"{longer_s / 60.0:g} min; give --step at least these, or leave it out"
        )
    return 60.0 * step_min


def _simulated(column: Column, result: Result) -> Held:
    instants_s = result.dataset.time.to_numpy().astype(float)
    values = simulated_values(QUANTITIES[column.quantity], column.element, result)
    return Held(instants_s[:-1], instants_s[1:], values)


def _pairs(measured: Measured, run: Mapping[Column, Held], zero_s: float) -> Pairs:
    """Measured and simulated series, both in the run's time, whose minute 0 is at a time of the file."""
    return {
        column: (Held(held.begin_s - zero_s, held.end_s - zero_s, held.values), run[column])
        for column, held in measured.series.items()
    }


def _offset(measured: Measured, pairs: Pairs, range_s: float, run_step_s: float) -> Offset:
    finer_s = min(measured.step_s, run_step_s)
    if range_s < finer_s:
        raise ResultError(
            f"an offset cannot be looked for within ±{range_s:g} s, less than a step of {finer_s:g} s; "
            "give --find-offset more minutes"
        )
    offset = find_offset([*pairs.values()], range_s, measured.step_s, run_step_s)
    if offset is None:
        raise measured.fault(
            "no series varies in the time that it shares with the run, so no offset can be found",
            "leave --find-offset out, give --begins closer to the run's begin, or a wider range",
        )
    return offset


def _notes(begin: Begin, offset: Offset | None, grid: Grid, series: list[Aligned]) -> list[str]:
    """What is told of the alignment."""
    notes = list(begin.notes)
    if offset is not None and offset.at_end:
        notes.append(
            "the offset lies at an end of the range in which it was looked for: a better one may lie "
            "beyond; give --find-offset a wider range"
        )
    lacking: dict[tuple[int, int, int], list[str]] = {}
    for each in series:
        counts = (
            grid.intervals - each.compared,
            int(np.isnan(each.measured).sum()),
            int(np.isnan(each.simulated).sum()),
        )
        lacking.setdefault(counts, []).append(each.name)
    for (left_out, unknown, absent), names in lacking.items():
        if left_out:
            notes.append(
                f"{left_out} of {grid.intervals} intervals are left out of {', '.join(names)}: in "
                f"{unknown} the measurement has a gap, in {absent} nothing is simulated"
            )
    return notes
