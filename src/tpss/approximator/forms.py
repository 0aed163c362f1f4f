"""Forms of an approximator: inputs and outputs, by the columns of a study's table."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import pandas as pd

TRAINS, TRAINS_SPEED = "trains", "trains_speed_kmh"
"""Inputs of the original form that the table does not contain; see `with_traffic`."""

LOST = ("converter_losses_mwh", "drawn_from_grid_mwh")
"""Figures of cases in which converters say what they lose."""

FED_BACK = ("braking.fed_back_mwh", "fed_back_to_grid_mwh")
"""Figures of cases in which trains have electric brakes; the first one of no others."""

_SUPPLY = ("converters_per_station", "converters", "converter_rating_mva", "transformers")
_CATENARY = ("catenary_r_ohm_per_km", "catenary_x_ohm_per_km", "connection_x_ohm")
_GRADIENTS = ("gradient_mean_permille", "gradient_std_permille")
_PROFILE = (
    "starting_gradient_permille",
    "gradient_trend_permille",
    "gradient_middle_permille",
)
"""Statistics of where it is steep, beyond mean and standard deviation."""


@dataclass(frozen=True)
class Form:
    """Inputs that may vary, in the order in which they are preferred, and outputs."""

    numbers: tuple[str, ...]
    choices: tuple[str, ...]
    outputs: tuple[str, ...]
    of_each_station: tuple[str, ...]
    """Figures of each feeding station that are outputs too."""
    where_told: tuple[str, ...] = ()
    """Outputs where a study tells them: see `LOST` and `FED_BACK`."""

    def outputs_of(self, columns: Sequence[str]) -> list[str]:
        """Outputs for a table with these columns."""
        stations = [
            name
            for name in columns
            if name.startswith("station.") and name.rpartition(".")[2] in self.of_each_station
        ]
        return [*self.outputs, *stations]


_AGGREGATED = Form(
    numbers=(
        "station_distance_km",
        "length_km",
        "route_km",
        "converter_stations",
        "stops",
        *_SUPPLY,
        *_CATENARY,
        "headway_min",
        "speed_limit_kmh",
        "mean_speed_limit_kmh",
        "train_mass_t",
        "max_motor_current_a",
        *_GRADIENTS,
    ),
    choices=("catenary", "high_voltage_line"),
    outputs=(
        "mean_speed_kmh",
        "trip_time_min",
        "total_energy_mwh",
        "losses_mwh",
        "lowest_voltage_kv",
        "peak_loading",
    ),
    of_each_station=("energy_mwh",),
    where_told=(*LOST, *FED_BACK),
)

AGGREGATED, VARIED = "aggregated", "varied"

FORMS = {
    AGGREGATED: _AGGREGATED,
    VARIED: replace(
        _AGGREGATED, numbers=(), choices=(), of_each_station=("energy_mwh", "peak_loading")
    ),
    "profile": replace(_AGGREGATED, numbers=(*_AGGREGATED.numbers, *_PROFILE)),
    "original": Form(
        numbers=(
            "station_distance_km",
            *_SUPPLY,
            *_CATENARY,
            TRAINS,
            TRAINS_SPEED,
            *_GRADIENTS,
        ),
        choices=("catenary", "high_voltage_line"),
        outputs=("mean_speed_kmh",),
        of_each_station=(),
    ),
}
"""``varied``: inputs are what a study varies.  ``profile``: with statistics of where it is steep.
``original``: what TPSA was first designed for, the highest mean speed of a train added to a line.
"""

NAMED_CATENARY, OWN = "catenary", "own"


def with_traffic(table: pd.DataFrame) -> pd.DataFrame:
    """The table with the number and the speed of the trains that run on the line.

    Both are known before a simulation: the trains of all services with a headway, as if each ran at
    the speed limit on the route of the studied train.
    """
    speed = table["mean_speed_limit_kmh"]
    trains = table["trains_per_h"] * table["route_km"] / speed
    return table.assign(**{TRAINS: trains, TRAINS_SPEED: speed})
