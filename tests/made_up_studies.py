"""Studies that were never run: rows of a table that follow a known law, so that tests take seconds."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

SMALL = {"figures": (16,), "noise": (4,), "collapse": (4,)}
"""Neurons that suffice for the law."""

NOISE = 0.03
"""Standard deviation of the trip times' logarithms around the law, where the gradients vary most."""


def made_up_table(rows: int, seed: int = 1) -> pd.DataFrame:
    """Lines of 60 to 160 km between two stations, with a train every 5 to 30 minutes.

    A trip takes what the speed limit asks for, one part in fifty more for each per mille of climb, and
    a random part that grows with the deviation of the gradients: it is the starting gradient's.  A BT
    line collapses with more than 1.2 trains on 10 km an hour.
    """
    draw = np.random.default_rng(seed)
    length = draw.uniform(60.0, 160.0, rows)
    headway = draw.uniform(5.0, 30.0, rows)
    limit = draw.uniform(60.0, 100.0, rows)
    mean, deviation = draw.uniform(-1.0, 2.0, rows), draw.uniform(0.0, 3.0, rows)
    catenary = draw.choice(["AT", "BT"], rows)
    converters = draw.choice([2, 3, 4, 6], rows)
    trip = law(length, limit, mean)
    noise = draw.standard_normal(rows)
    trip_noisy = trip * np.exp(NOISE * deviation / 3.0 * noise)
    energy = 0.08 * length * trip / headway * np.exp(NOISE * deviation / 3.0 * noise)
    trend, middle = draw.standard_normal((2, rows))
    collapsed = (catenary == "BT") & (length / headway > 12.0)
    table = pd.DataFrame(
        {
            "case": np.arange(rows),
            **dict.fromkeys(("length_km", "route_km", "station_distance_km"), length),
            "stops": 0,
            "converter_stations": 2,
            "converters": 2 * converters,
            "converters_per_station": converters.astype(float),
            "converter_rating_mva": 20.0 * converters,
            "catenary": catenary,
            "catenary_r_ohm_per_km": np.where(catenary == "AT", 0.0335, 0.21),
            "catenary_x_ohm_per_km": np.where(catenary == "AT", 0.031, 0.2),
            "connection_x_ohm": np.where(catenary == "AT", 0.293, 0.0),
            "high_voltage_line": catenary == "BT",
            "transformers": np.where(catenary == "BT", 3, 0),
            "headway_min": headway,
            "trains_per_h": 60.0 / headway,
            "speed_limit_kmh": limit,
            "mean_speed_limit_kmh": limit,
            "train_mass_t": 1470.0,
            "max_motor_current_a": 1250.0,
            "gradient_mean_permille": mean,
            "gradient_std_permille": deviation,
            "steepest_permille": mean + 2.0 * deviation,
            "starting_gradient_permille": mean + deviation * noise,
            "gradient_trend_permille": deviation * trend,
            "gradient_middle_permille": deviation * middle,
            "time_step_min": 0.1,
            "status": np.where(collapsed, "collapsed", "finished"),
            "audit_passed": True,
            "trip_time_min": trip_noisy,
            "mean_speed_kmh": 60.0 * length / trip_noisy,
            "total_energy_mwh": energy,
            "losses_mwh": 0.02 * energy,
            "lowest_voltage_kv": 16.4 - 0.2 * length / headway + 0.01 * noise,
            "peak_loading": 1.5 * length / headway / converters / 10.0 * np.exp(0.01 * noise),
            "station.West.energy_mwh": 0.6 * energy,
            "station.East.energy_mwh": 0.4 * energy,
        }
    )
    outputs = table.columns[table.columns.get_loc("trip_time_min") :]
    table.loc[collapsed, outputs[:2]] = np.nan
    return table


def law(length_km, limit_kmh, mean_permille):
    """Trip time of the made-up lines. [min]"""
    return 60.0 * length_km / limit_kmh * (1.0 + 0.02 * (mean_permille + 1.0))


def write_study(folder: Path, table: pd.DataFrame, **manifest: object) -> Path:
    """A study's folder with this table."""
    (folder / "cases").mkdir(parents=True)
    about = {"table_format": 1, "name": "made-up", "study_hash": "feed", "tpss_version": "0.1.0"}
    (folder / "study.json").write_text(
        json.dumps({**about, "kernel_hash": "beef", **manifest}), "utf-8"
    )
    table.to_parquet(folder / "cases" / f"cases-00000000-{len(table):08d}.parquet", index=False)
    return folder
