"""The columns of a study's table: inputs and outputs of a case, and its provenance."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, get_type_hints

import pyarrow as pa

from tpss.audit.verdict import JUDGED
from tpss.results import grid_and_rails
from tpss.results.key_figures import LIMITED, KeyFigures, ServiceFigures, StationFigures
from tpss.results.regeneration import TOTALS
from tpss.results.thermal.figures import FIGURES
from tpss.sweep.inputs import Inputs
from tpss.sweep.variation import Variation

INVALID, FAILED = "invalid", "failed"
"""States of cases that could not be simulated: invalid scenarios, and faults of the program."""

TIMINGS = {
    "timing.build_s": pa.float64(),  # scenario and model
    "timing.run_s": pa.float64(),
    "timing.ended": pa.timestamp("ms", tz="UTC"),
}
"""Columns that differ from run to run."""

_TYPE = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), str: pa.string()}

OUTPUTS = {
    "status": pa.string(),
    "problem": pa.string(),
    "collapsed": pa.bool_(),
    "stalled": pa.bool_(),
    "duration_min": pa.float64(),
    "steps": pa.int64(),
    "carried_share": pa.float64(),
    "trip_time_min": pa.float64(),
    "mean_speed_kmh": pa.float64(),
    "total_energy_mwh": pa.float64(),
    "losses_mwh": pa.float64(),
    "converter_losses_mwh": pa.float64(),
    "drawn_from_grid_mwh": pa.float64(),
    "fed_back_to_grid_mwh": pa.float64(),
    **{f"braking.{name}": pa.float64() for name in TOTALS},
    **{f"thermal.{name}": pa.float64() for name in FIGURES},
    **{name: pa.float64() for name in grid_and_rails.FIGURES},
    "trips": pa.int64(),
    "tripped": pa.string(),
    "lowest_voltage_kv": pa.float64(),
    "lowest_voltage_km": pa.float64(),
    "lowest_voltage_min": pa.float64(),
    "mean_useful_voltage_kv": pa.float64(),
    "dimensioning_train_kv": pa.float64(),
    "peak_power_mw": pa.float64(),
    "peak_loading": pa.float64(),
    "mean_passes": pa.float64(),
    "most_passes": pa.int64(),
    "audit_passed": pa.bool_(),
    **{f"audit.{name}": pa.float64() for name in JUDGED},
    **{f"limited.{name}": pa.int64() for name in LIMITED},
}

MADE_BY = {
    "scenario_hash": pa.string(),
    "study_hash": pa.string(),
    "tpss_version": pa.string(),
    "kernel_hash": pa.string(),
}


@dataclass(frozen=True)
class Names:
    """Names that occur in the columns of a study."""

    stations: tuple[str, ...]
    services: tuple[str, ...]


def schema_of(parameters: dict[str, Variation], names: Names) -> pa.Schema:
    """Columns of a study's table, with their types."""
    return pa.schema(
        {
            "case": pa.int64(),
            **{f"set.{name}": _parameter_type(each) for name, each in parameters.items()},
            **{name: _TYPE[kind] for name, kind in get_type_hints(Inputs).items()},
            **OUTPUTS,
            **_of_each("station", names.stations, StationFigures),
            **_of_each("service", names.services, ServiceFigures),
            **MADE_BY,
            **TIMINGS,
        }
    )


def _parameter_type(parameter: Variation) -> pa.DataType:
    """Type of a parameter's column: flags, numbers, or text for anything else."""
    if parameter.is_text:
        return pa.string()
    values = parameter.ends
    if all(isinstance(value, bool) for value in values):
        return pa.bool_()
    return pa.int64() if all(isinstance(value, int) for value in values) else pa.float64()


def _of_each(kind: str, names: Iterable[str], figures: type) -> dict[str, pa.DataType]:
    hints = get_type_hints(figures)
    own = [field.name for field in fields(figures) if field.name != "name"]
    return {f"{kind}.{name}.{field}": _TYPE[hints[field]] for name in names for field in own}


def parameter_columns(parameters: dict[str, Variation], values: dict[str, Any]) -> dict[str, Any]:
    """The values of the parameters in a case."""
    return {
        f"set.{name}": str(value) if parameters[name].is_text else value
        for name, value in values.items()
    }


def output_columns(figures: KeyFigures) -> dict[str, Any]:
    """Outputs of a case."""
    lowest, audit = figures.lowest_voltage, figures.audit.as_dict()
    return {
        "problem": "; ".join(figures.audit.failures) or None,
        "collapsed": figures.status == "collapsed",
        "stalled": figures.status == "stalled",
        **{name: getattr(figures, name) for name in OUTPUTS if hasattr(figures, name)},
        "lowest_voltage_kv": lowest.voltage_kv if lowest else math.nan,
        "lowest_voltage_km": lowest.position_km if lowest else math.nan,
        "lowest_voltage_min": lowest.time_min if lowest else math.nan,
        "peak_power_mw": _highest(station.peak_power_mw for station in figures.stations),
        "peak_loading": _highest(station.peak_loading for station in figures.stations),
        "audit_passed": figures.audit.passed,
        **{f"audit.{name}": audit[name] for name in JUDGED},
        **{f"limited.{name}": count for name, count in figures.limited.items()},
        **{f"braking.{name}": energy for name, energy in figures.braking.items()},
        **{f"thermal.{name}": value for name, value in figures.thermal.items()},
        **figures.grid_and_rails,
        "trips": None if figures.tripped is None else len(figures.tripped),
        "tripped": "; ".join(figures.tripped or ()) or None,
        **_figures_of_each("station", figures.stations),
        **_figures_of_each("service", figures.services),
    }


def _figures_of_each(
    kind: str, items: Iterable[StationFigures | ServiceFigures]
) -> dict[str, float | int]:
    return {
        f"{kind}.{item.name}.{name}": value
        for item in items
        for name, value in vars(item).items()
        if name != "name"
    }


def _highest(values: Iterable[float]) -> float:
    numbers = [value for value in values if not math.isnan(value)]
    return max(numbers, default=math.nan)


def table_of(rows: list[dict[str, Any]], schema: pa.Schema) -> pa.Table:
    """Table of cases; missing values are null."""
    columns = {
        # As in pandas, NaN becomes null, so that every reader sees the same.
        field.name: pa.array([row.get(field.name) for row in rows], field.type, from_pandas=True)
        for field in schema
    }
    return pa.table(columns, schema=schema)
