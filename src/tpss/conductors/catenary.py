"""The catenary of a scenario that stands for a line of many conductors."""

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import tomli_w
from pydantic import ValidationError

from tpss.conductors.equivalents import (
    AUTOTRANSFORMERS,
    EARTH,
    EARTHED,
    INSULATED,
    Equivalent,
    with_autotransformers,
)
from tpss.errors import Finding, ScenarioError
from tpss.scenario.supply import Catenary

if TYPE_CHECKING:
    from tpss.conductors.constants import LineConstants

DIGITS = 6
"""Significant digits that are written."""


def chosen(constants: "LineConstants") -> Equivalent:
    """Equivalent that a catenary is made of: autotransformers where there are, or what `rails` says."""
    found = {each.name: each for each in constants.equivalents}
    rails = EARTHED if constants.geometry.rails == "earthed" else INSULATED
    return next(
        found[name] for name in (AUTOTRANSFORMERS, rails, INSULATED, EARTH) if name in found
    )


def capacitance(constants: "LineConstants") -> float:
    r"""Capacitance of a track to the earth: all contact lines have one voltage. [F/m]

    With autotransformers the feeders have the opposite voltage, :math:`c = v^T C v / n`; without them
    they are not connected, and have no charge in all.  Rails lie at earth.
    """
    geometry = constants.geometry
    signs = {"contact": 1.0, "positive": 1.0, "rails": 0.0, "earth": 0.0}
    if with_autotransformers(geometry) and geometry.has("rails"):
        signs["feeder"] = -1.0
    taken = [i for i, each in enumerate(geometry.conductors) if each.group in signs]
    voltage = np.array([signs[geometry.conductors[i].group] for i in taken])
    charge = np.linalg.solve(constants.conductor_potential[np.ix_(taken, taken)], voltage)
    return float(voltage @ charge) / len(geometry.tracks)


def catenary_of(constants: "LineConstants") -> dict[str, Any]:
    """Table for `supply.catenary` of a scenario; see `LineConstants.catenary`.

    Raises
    ------
    ScenarioError
        A catenary of a scenario cannot have these values.
    """
    z = chosen(constants)
    table: dict[str, Any] = {
        "r_ohm_per_km": _rounded(1e3 * z.own.real),
        "x_ohm_per_km": _rounded(1e3 * z.own.imag),
    }
    if constants.frequency_hz > 0.0:  # a capacitance has no effect on direct current
        table["capacitance_nf_per_km"] = _rounded(1e12 * capacitance(constants))
    table |= {
        f"mutual_{axis}_ohm_per_km": _rounded(1e3 * value)
        for axis, value in in_common(z).items()
        if value > 0.0
    }
    if conductors := conductors_of(constants):
        table["conductors"] = conductors
    try:
        Catenary.model_validate(table)
    except ValidationError as error:
        remedy = "check r_ohm_per_km and the places of the conductors"
        findings = [
            Finding(str(constants.geometry.source), _key(each), "", each["msg"], remedy)
            for each in error.errors(include_url=False)
        ]
        raise ScenarioError(findings) from error
    return table


def conductors_of(constants: "LineConstants") -> dict[str, Any] | None:
    """Table of the conductors of a catenary; None where a scenario knows none of these.

    It knows one or two tracks with contact line and rails, and with feeders or without, of an
    alternating current.  A positive feeder counts to the contact line, to which it is tied.
    """
    tracks, names = constants.geometry.tracks, list(constants.groups)
    kinds = [name.partition(" ")[0] for name in names]
    whole = all(kinds.count(kind) in (0, len(tracks)) for kind in ("contact", "rails", "feeder"))
    if constants.frequency_hz == 0.0 or len(tracks) > 2 or not whole or "rails" not in kinds:
        return None
    merged = [name.replace("positive", "contact") for name in names]
    kept = list(dict.fromkeys(merged))
    sums = np.array([[float(each == name) for each in merged] for name in kept])
    impedance = np.linalg.inv(sums @ np.linalg.inv(constants.impedance) @ sums.T)
    susceptance = 2.0 * math.pi * constants.frequency_hz * sums @ constants.capacitance @ sums.T
    return {
        "names": kept,
        "r_ohm_per_km": _rounded_rows(1e3 * impedance.real),
        "x_ohm_per_km": _rounded_rows(1e3 * impedance.imag),
        "b_us_per_km": _rounded_rows(1e9 * susceptance),
    }


def _rounded_rows(matrix: Any) -> list[list[float]]:
    return [[_rounded(float(value)) for value in row] for row in matrix]


def in_common(equivalent: Equivalent) -> dict[str, float]:
    """Resistance r and reactance x that two tracks have in common; of a single track none. [Ω/m]"""
    mutual = equivalent.mutual
    return {} if mutual is None else {"r": mutual.real, "x": mutual.imag}


def _key(error: Any) -> str:
    return f"supply.catenary.{error['loc'][-1]}" if error["loc"] else "supply.catenary"


def catenary_text(constants: "LineConstants") -> str:
    """Text of a file that `supply.catenary` of a scenario may name.

    Raises
    ------
    ScenarioError
        As `catenary_of`.
    """
    z = chosen(constants)
    source = (
        f"line constants of {constants.geometry.source.name} at {constants.frequency_hz:g} Hz, "
        f"{constants.geometry.method}: {z.meaning}"
    )
    table = catenary_of(constants)
    conductors = table.pop("conductors", None)
    text = tomli_w.dumps({"source": source, **table})
    return text if conductors is None else f"{text}\n{_conductors_text(conductors)}"


def _conductors_text(conductors: dict[str, Any]) -> str:
    """Table of the conductors, a row of a matrix on a line."""
    lines = ["[conductors]", f"names = {json.dumps(conductors['names'])}"]
    for key in ("r_ohm_per_km", "x_ohm_per_km", "b_us_per_km"):
        rows = ",\n".join(f"    {json.dumps(row)}" for row in conductors[key])
        lines.append(f"{key} = [\n{rows},\n]")
    return "\n".join(lines) + "\n"


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else value
