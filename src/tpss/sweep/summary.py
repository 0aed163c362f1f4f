"""Key figures of a study's table."""

from dataclasses import dataclass

import pandas as pd

SHOWN = {
    "trip_time_min": "trip time [min]",
    "mean_speed_kmh": "mean speed [km/h]",
    "total_energy_mwh": "energy of all stations [MWh]",
    "losses_mwh": "losses [MWh]",
    "converter_losses_mwh": "losses of converters [MWh]",
    "drawn_from_grid_mwh": "drawn from the grid [MWh]",
    "fed_back_to_grid_mwh": "fed back to the grid [MWh]",
    "braking.braked_mwh": "braked [MWh]",
    "braking.friction_mwh": "braked by friction [MWh]",
    "braking.refused_mwh": "refused by the line [MWh]",
    "braking.rheostat_mwh": "burnt in rheostats of trains [MWh]",
    "braking.fed_back_mwh": "fed back by trains [MWh]",
    "braking.used_by_others_mwh": "of it used by others [MWh]",
    "braking.burnt_in_stations_mwh": "of it burnt in stations [MWh]",
    "thermal.contact_line_use_percent": "of what contact lines bear [%]",
    "thermal.transformer_use_percent": "of what transformers bear [%]",
    "thermal.converter_use_percent": "of what converters bear [%]",
    "thermal.rectifier_use_percent": "of what rectifiers bear [%]",
    "thermal.motor_use_percent": "of what motors bear [%]",
    "thermal.hot_spot_c": "hottest transformer [°C]",
    "thermal.loss_of_life_min": "life lost by a transformer [min]",
    "unbalance_percent": "unbalance of a grid over 10 min [%]",
    "rail_permanent_v": "rails to earth over 300 s [V]",
    "rail_short_v": "rails to earth in a second or a step [V]",
    "stray_ma_per_m": "stray current of a line [mA/m]",
    "trips": "trips [1]",
    "lowest_voltage_kv": "lowest voltage [kV]",
    "mean_useful_voltage_kv": "mean useful voltage [kV]",
    "peak_loading": "peak loading [1]",
}
"""Columns whose spread is shown, over the cases that finished."""


@dataclass(frozen=True)
class Summary:
    """What a table holds."""

    cases: int
    """Cases of the study; some may be missing."""
    status: dict[str, int]
    """Number of cases by their status."""
    spread: pd.DataFrame
    """Lowest, median and highest value of columns that have any, of the cases that finished."""
    audits_failed: int
    problems: dict[str, int]
    """Problems of cases that could not be run, and how often they occur."""
    work_s: float
    """Time of all cases, added up over the workers."""

    @property
    def done(self) -> int:
        """Number of cases in the table."""
        return sum(self.status.values())


def summarise(table: pd.DataFrame, cases: int) -> Summary:
    """Key figures of a table."""
    finished = table[table.status == "finished"]
    columns = {
        label: finished[name]
        for name, label in SHOWN.items()
        if name in finished and finished[name].notna().any()
    }
    unusable = table[~table.status.isin(("finished", "collapsed", "stalled"))]
    return Summary(
        cases=cases,
        status={str(name): int(n) for name, n in table.status.value_counts().items()},
        spread=pd.DataFrame(
            {
                "lowest": {label: values.min() for label, values in columns.items()},
                "median": {label: values.median() for label, values in columns.items()},
                "highest": {label: values.max() for label, values in columns.items()},
            }
        ),
        audits_failed=int((table.audit_passed == False).sum()),  # noqa: E712, it may be null
        problems={str(text): int(n) for text, n in unusable.problem.value_counts().items()},
        work_s=float((table["timing.build_s"] + table["timing.run_s"]).sum()),
    )
