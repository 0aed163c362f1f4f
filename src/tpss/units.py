"""The one table of unit suffixes: what a name's suffix means, and its factor to SI.

Files, the scenario's fields and the columns of tables carry engineering units in their names
(``length_km``); the program computes in SI.  A scenario is converted once, in `tpss.model`, through
`si`.
"""

import math
from collections.abc import Iterable
from functools import cache

SUFFIXES: dict[str, tuple[str, float]] = {
    # suffix: (label, factor to SI)
    "_wh_per_t_km": ("Wh/t km", 3.6e-3),
    "_kwh_per_km": ("kWh/km", 3.6e3),
    "_min_per_100km": ("min/100 km", 6e-4),
    "_percent": ("%", 1e-2),
    "_ohm_per_km": ("Ω/km", 1e-3),
    "_ma_per_m": ("mA/m", 1e-3),
    "_s_per_km": ("S/km", 1e-3),
    "_us_per_km": ("µS/km", 1e-9),
    "_nf_per_km": ("nF/km", 1e-12),
    "_n_s_per_m": ("N s/m", 1.0),
    "_n_s2_per_m2": ("N s²/m²", 1.0),
    "_kv_per_mvar": ("kV/Mvar", 1e-3),
    "_kw_per_v": ("kW/V", 1e3),
    "_permille": ("‰", 1e-3),
    "_m_s2": ("m/s²", 1.0),
    "_ohm_m": ("Ω m", 1.0),
    "_per_k": ("1/K", 1.0),
    "_mvarh": ("Mvarh", 3.6e9),
    "_mvar": ("Mvar", 1e6),
    "_mwh": ("MWh", 3.6e9),
    "_kwh": ("kWh", 3.6e6),
    "_mva": ("MVA", 1e6),
    "_kva": ("kVA", 1e3),
    "_ohm": ("Ω", 1.0),
    "_kmh": ("km/h", 1.0 / 3.6),
    "_min": ("min", 60.0),
    "_deg": ("°", math.pi / 180.0),
    "_km": ("km", 1e3),
    "_mm": ("mm", 1e-3),
    "_kn": ("kN", 1e3),
    "_kv": ("kV", 1e3),
    "_kw": ("kW", 1e3),
    "_mw": ("MW", 1e6),
    "_kg": ("kg", 1.0),
    "_pu": ("p.u.", 1.0),
    "_hz": ("Hz", 1.0),
    "_t": ("t", 1e3),
    "_a": ("A", 1.0),
    "_c": ("°C", 1.0),
    "_v": ("V", 1.0),
    "_f": ("F", 1.0),
    "_n": ("N", 1.0),
    "_s": ("s", 1.0),
    "_m": ("m", 1.0),
}


@cache
def suffix(name: str) -> str:
    """Longest unit suffix of a name, which may be nothing but a unit, or an empty string."""
    return max((s for s in SUFFIXES if f"_{name}".endswith(s)), key=len, default="")


def label(name: str) -> str:
    """Unit of a field as it is written for people; empty for a pure number."""
    return SUFFIXES[suffix(name)][0] if suffix(name) else ""


def words(name: str) -> str:
    """A name in words, without its unit."""
    return name.removesuffix(suffix(name)).replace("_", " ")


def heading(name: str) -> str:
    """A name as the heading of a column, such as ``energy [MWh]``."""
    return f"{words(name)} [{label(name)}]" if suffix(name) else words(name)


def si_factor(name: str) -> float:
    """Factor from the unit of a name to that of SI.

    Raises
    ------
    KeyError
        The name has no unit suffix.
    """
    return SUFFIXES[suffix(name)][1]


def si(source: object, name: str) -> float:
    """Value of the field `name` of `source` in SI units.

    Raises
    ------
    KeyError
        The name has no unit suffix.
    """
    return float(getattr(source, name)) * si_factor(name)


def si_of_each(items: Iterable[object], name: str) -> list[float]:
    """Values of the field `name` of each item in SI units."""
    factor = si_factor(name)
    return [getattr(item, name) * factor for item in items]


def kilometres(km: float) -> str:
    """A position or a length [km] as it is shown: in six digits, beyond 1000 km to the metre."""
    digits = len(str(int(min(abs(km), 1e9)))) + 3
    return f"{km:.{max(6, digits)}g}"


def on_line(line: str, text: str) -> str:
    """A place in words, after the name of its line if that is told."""
    return f"{line} {text}" if line else text


def si_list(source: object, name: str) -> list[float]:
    """Values of the field `name` of `source`, a list of numbers, in SI units."""
    factor = si_factor(name)
    return [float(value) * factor for value in getattr(source, name)]
