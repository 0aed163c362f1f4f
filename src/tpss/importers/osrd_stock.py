"""Rolling stock of OSRD as trains: effort curves by the voltages of contact lines, resistance, mass."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field

from tpss.errors import Finding, ScenarioError
from tpss.importers.documents import Item, as_model, read_json

REMEDY = "export the rolling stock from OSRD anew"

SPECIFIC_N_PER_KG = 1.0
"""A resistance at a stand below this is one of each kilogram, above it that of the whole train: none of
either kind is on the other side. [N/kg]"""

ASSUMED = {"efficiency": 0.85, "auxiliary_power_kw": 100.0}
"""What OSRD does not tell of a train."""

ASSUMED_AC = {"power_factor": 1.0}
"""And of one under an alternating current."""


class EffortCurve(Item):
    """Highest force over speed. [m/s], [N]"""

    speeds: Annotated[list[Annotated[float, Field(ge=0)]], Field(min_length=2)]
    max_efforts: list[Annotated[float, Field(ge=0)]]


class Mode(Item):
    """What a train gives under one electrification, or without."""

    default_curve: EffortCurve
    is_electric: bool


class EffortCurves(Item):
    """Curves by the name of an electrification."""

    modes: Annotated[dict[str, Mode], Field(min_length=1)]


class RollingResistance(Item):
    """A + B v + C v², of the train or of each kilogram of it, in SI units."""

    a: float = Field(alias="A", ge=0)
    b: float = Field(alias="B", ge=0)
    c: float = Field(alias="C", ge=0)


class RollingStock(Item):
    """A train, in SI units."""

    name: Annotated[str, Field(min_length=1)]
    mass: Annotated[float, Field(gt=0)]
    length: Annotated[float, Field(ge=0)] = 0.0
    max_speed: Annotated[float, Field(gt=0)]
    const_gamma: Annotated[float, Field(gt=0)] = 0.5
    comfort_acceleration: Annotated[float, Field(gt=0)] | None = None
    inertia_coefficient: Annotated[float, Field(ge=1)] = 1.0
    rolling_resistance: RollingResistance
    effort_curves: EffortCurves


def read_stock(paths: Sequence[Path]) -> dict[str, tuple[RollingStock, Path]]:
    """Rolling stock of files, one each, by name.

    Raises
    ------
    ScenarioError
        A file cannot be read, or has faults.
    """
    found = {}
    for path in paths:
        stock: RollingStock = as_model(RollingStock, read_json(path), path, REMEDY)
        for name, mode in stock.effort_curves.modes.items():
            curve = mode.default_curve
            if len(curve.speeds) != len(curve.max_efforts):
                key = f"effort_curves.modes.{name}.default_curve"
                problem = f"{len(curve.speeds)} speeds and {len(curve.max_efforts)} efforts"
                raise ScenarioError([Finding(str(path), key, "", problem, REMEDY)])
        found[stock.name] = stock, path
    return found


def systems_of(stock: RollingStock, systems: Mapping[str, str]) -> dict[str, EffortCurve]:
    """Curves of a train by the systems of the library under which it runs.

    Parameters
    ----------
    stock : RollingStock
    systems : mapping of str to str
        Systems by the names of electrifications.
    """
    return {
        systems[name]: mode.default_curve
        for name, mode in stock.effort_curves.modes.items()
        if mode.is_electric and name in systems
    }


def train_of(stock: RollingStock, curves: Mapping[str, EffortCurve], system: str) -> dict[str, Any]:
    """Table of a train: its data under a system, those of its others, and what is assumed.

    Parameters
    ----------
    stock : RollingStock
    curves : mapping of str to EffortCurve
        As from `systems_of`; of the system too.
    system : str
    """
    resistance = stock.rolling_resistance
    kg = stock.mass if resistance.a < SPECIFIC_N_PER_KG else 1.0
    mass_t = round(stock.mass / 1e3, 6)
    found = {
        "systems": list(curves),
        "tractive_effort": _effort(curves[system]),
        "mass_t": mass_t,
        "adhesive_mass_t": mass_t,
        "length_m": stock.length,
        "rotating_mass_share": round(stock.inertia_coefficient - 1.0, 6),
        "resistance_a_n": round(resistance.a * kg, 3),
        "resistance_b_n_s_per_m": round(resistance.b * kg, 4),
        "resistance_c_n_s2_per_m2": round(resistance.c * kg, 5),
        "max_speed_kmh": round(3.6 * stock.max_speed, 3),
        "max_retardation_m_s2": stock.const_gamma,
        **ASSUMED,
    }
    if stock.comfort_acceleration is not None:
        found["max_acceleration_m_s2"] = stock.comfort_acceleration
    if not system.startswith("DC"):
        found |= ASSUMED_AC
    others = {other: _differs(other, curve) for other, curve in curves.items() if other != system}
    return {**found, **({"by_system": others} if others else {})}


def _differs(system: str, curve: EffortCurve) -> dict[str, Any]:
    return {"tractive_effort": _effort(curve), **({} if system.startswith("DC") else ASSUMED_AC)}


def _effort(curve: EffortCurve) -> dict[str, list[float]]:
    """Table of tractive effort; of several efforts at one speed the lower one."""
    lowest: dict[float, float] = {}
    for speed_m_s, effort_n in zip(curve.speeds, curve.max_efforts, strict=True):
        speed_kmh = round(3.6 * speed_m_s, 3)
        lowest[speed_kmh] = min(lowest.get(speed_kmh, effort_n), effort_n)
    ordered = sorted(lowest)
    return {"speed_kmh": ordered, "force_kn": [round(lowest[each] / 1e3, 6) for each in ordered]}
