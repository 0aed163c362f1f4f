"""Random scenarios whose trains and stations follow laws of somebody's own."""

import math
from random import Random
from typing import Any

from hypothesis import strategies as st

from tpss.laws import KINDS, Law, Parameter, register

from .strategies import moves_continuously

Document = dict[str, Any]


def _resistance_n(speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2, factor, start_share):
    """More air resistance, and at standstill a part of the weight that soon goes."""
    davis = a_n + b_n_s_per_m * speed_m_s + factor * c_n_s2_per_m2 * speed_m_s**2
    return davis + start_share * 9.81 * mass_kg * math.exp(-speed_m_s / 2.0)


def _wish_m_s(speed_m_s, limit_m_s, position_m, to_stop_m, share, from_m, wave_m):
    """A share of the limit before stops; elsewhere now more, now less than the limit."""
    if to_stop_m < from_m:
        return share * limit_m_s
    return (0.9 + 0.2 * math.sin(position_m / wave_m)) * limit_m_s


def _voltage(power_w, reactive_power_var, no_load_v, fall_v_per_var, bent, lag_rad_per_w):
    """A droop that bends, and an angle that follows the power."""
    fall = fall_v_per_var * (1.0 + bent * reactive_power_var)
    by_reactive = -fall_v_per_var * (1.0 + 2.0 * bent * reactive_power_var)
    voltage_v = no_load_v - fall * reactive_power_var
    return voltage_v, -lag_rad_per_w * power_w, 0.0, by_reactive, -lag_rad_per_w, 0.0


LAWS = [
    Law(
        KINDS["resistance"], "random", _resistance_n, "", "",
        (Parameter("factor", ""), Parameter("start_share", "")),
    ),
    Law(
        KINDS["driver"], "random", _wish_m_s, "", "",
        (Parameter("share", ""), Parameter("from_m", ""), Parameter("wave_m", "")),
    ),
    Law(
        KINDS["converter"], "random", _voltage, "", "",
        (
            Parameter("no_load_v", ""), Parameter("fall_v_per_var", ""), Parameter("bent", ""),
            Parameter("lag_rad_per_w", ""),
        ),
    ),
]  # fmt: skip


def scenarios_by_own_laws(sound: st.SearchStrategy[Document]) -> st.SearchStrategy[Document]:
    """Sound scenarios, some of whose trains and stations follow laws of their own."""
    for law in LAWS:
        register(law)
    return sound.map(_with_laws)


def _with_laws(document: Document) -> Document:
    draw = Random(repr(document))
    hurried = {
        entry["train"]
        for entry in document["traffic"]
        if entry.get("spare_time")
        or entry.get("supplement_percent")
        or entry.get("supplement_min_per_100km")
    }
    for name, train in document["trains"].items():
        if draw.random() < 0.6:
            values = {"factor": draw.uniform(0.3, 3.0), "start_share": draw.uniform(0.0, 0.004)}
            train["resistance_law"] = {"law": "random", "parameters": values}
        if (
            moves_continuously(document["simulation"])
            and name not in hurried
            and draw.random() < 0.6
        ):
            train["driver"] = {
                "law": "random",
                "parameters": {
                    "share": draw.choice([0.0, 0.3, 0.8, 1.0, 1.2]),
                    "from_m": draw.choice([0.0, 50.0, 2e3, 1e6]),
                    "wave_m": draw.choice([1e-3, 300.0, 1e9]),
                },
            }
    for station in document["supply"].get("converter_stations", ()):
        if draw.random() < 0.6 and _may_have_a_law(station):
            _give_law(draw, station)
    return document


def _may_have_a_law(station: Document) -> bool:
    kind = station["type"]
    limited = isinstance(kind, dict) and "current_limit_percent" in kind
    grid = station.get("grid_reactance_ohm") or station.get("grid_reactive_power_mvar")
    return not (limited or grid or station.get("feedback") == "none")


def _give_law(draw: Random, station: Document) -> None:
    kind = station["type"]
    rated_va, no_load_v = 10e6, 16.5e3
    if isinstance(kind, dict):
        rated_va, no_load_v = 1e6 * kind["rating_mva"], 1e3 * kind["no_load_voltage_kv"]
    station["law"] = {
        "law": "random",
        "parameters": {
            "no_load_v": no_load_v,
            "fall_v_per_var": draw.uniform(0.0, 0.1) * no_load_v / rated_va,
            "bent": draw.uniform(-0.3, 0.3) / rated_va,
            "lag_rad_per_w": draw.uniform(0.0, 0.6) / rated_va,
        },
    }
