"""Line constants: what a geometry comes to at a frequency, by groups of conductors."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from tpss.conductors.catenary import catenary_of
from tpss.conductors.equivalents import Equivalent, equivalents_of
from tpss.conductors.formulas.earth_return import METHODS
from tpss.conductors.formulas.inside import by_mean_radius, by_skin_effect
from tpss.conductors.formulas.matrices import (
    membership,
    of_groups,
    potential_coefficients,
    series_impedance,
)
from tpss.conductors.formulas.vacuum import Complex, Real
from tpss.conductors.geometry import Conductor, Geometry
from tpss.errors import Finding, ScenarioError
from tpss.units import si

HIGHEST_HZ = 10_000.0
"""Highest frequency: beyond it the earth is no longer a conductor alone. [Hz]"""

ORDER = ("contact", "positive", "feeder", "rails")
"""Groups, in the order of rows and columns; those of a track follow each other."""


@dataclass(frozen=True, eq=False)
class LineConstants:
    """Line constants of a geometry at a frequency; tables in Ω and µS a kilometre, arrays in SI."""

    geometry: Geometry
    frequency_hz: float
    internal_impedance: Complex
    """Impedances of the field within each conductor. [Ω/m]"""
    conductor_impedance: Complex
    """Series impedances of all conductors, with their returns through the earth. [Ω/m]"""
    conductor_potential: Real
    """Potential coefficients of all conductors. [m/F]"""
    groups: tuple[str, ...]
    """Names of the groups: with their track, if there are several."""
    impedance: Complex
    """Series impedances of the groups. [Ω/m]"""
    capacitance: Real
    """Capacitances of the groups. [F/m]"""

    @property
    def r_ohm_per_km(self) -> pd.DataFrame:
        """Resistances of the groups, and those that two have in common. [Ω/km]"""
        return self._table(1e3 * self.impedance.real)

    @property
    def x_ohm_per_km(self) -> pd.DataFrame:
        """Reactances of the groups. [Ω/km]"""
        return self._table(1e3 * self.impedance.imag)

    @property
    def b_us_per_km(self) -> pd.DataFrame:
        """Susceptances of the groups: the current into each at a voltage of one. [µS/km]"""
        return self._table(1e9 * 2.0 * math.pi * self.frequency_hz * self.capacitance)

    @cached_property
    def equivalents(self) -> tuple[Equivalent, ...]:
        """What stands for the line as one conductor a track, its return included."""
        return equivalents_of(self.geometry, self.conductor_impedance, self.frequency_hz)

    @property
    def catenary(self) -> dict[str, Any]:
        """Table for `supply.catenary` of a scenario of the same frequency.

        Of autotransformers where every track has a feeder, otherwise of rails as the geometry says.
        What tracks have in common is in it where that is positive: a scenario knows no other.

        Raises
        ------
        ScenarioError
            A catenary of a scenario cannot have these values.
        """
        return catenary_of(self)

    def _table(self, matrix: Real) -> pd.DataFrame:
        names = list(self.groups)
        return pd.DataFrame(matrix, index=names, columns=names)


def line_constants(geometry: Geometry, frequency_hz: float | None = None) -> LineConstants:
    """Impedances and capacitances of a line, from its geometry.

    Parameters
    ----------
    geometry : Geometry
        As `tpss.load_geometry` gives it.
    frequency_hz : float, optional
        Frequency, 0 of direct current; by default that of the geometry. [Hz]

    Returns
    -------
    LineConstants

    Raises
    ------
    ScenarioError
        There is no frequency, or the constants are those of no passive line.
    """
    frequency = geometry.frequency_hz if frequency_hz is None else frequency_hz
    if frequency is None or not 0.0 <= frequency <= HIGHEST_HZ:
        raise ScenarioError([_no_frequency(geometry, frequency)])
    omega = 2.0 * math.pi * frequency
    all_of_them = geometry.conductors
    places = (
        [each.x_m for each in all_of_them],
        [each.mean_height_m for each in all_of_them],
        [si(each.wire, "radius_mm") for each in all_of_them],
    )
    inside = np.array([_internal_impedance(each, omega) for each in all_of_them])
    earth = (geometry.earth_resistivity_ohm_m, METHODS[geometry.method])
    impedance = series_impedance(omega, inside, *places, *earth)
    potential = potential_coefficients(*places)
    names, numbers = grouped(geometry)
    member = membership(numbers)
    found = LineConstants(
        geometry,
        frequency,
        inside,
        impedance,
        potential,
        names,
        np.asarray(np.linalg.inv(of_groups(impedance, member)), np.complex128),
        np.asarray(of_groups(potential, member), np.float64),
    )
    _demand_passive(found)
    return found


def _internal_impedance(conductor: Conductor, omega_rad_s: float) -> complex:
    """Impedance of the field within a conductor, worn and at its temperature. [Ω/m]"""
    wire, r_ohm_per_m = conductor.wire, si(conductor, "r_ohm_per_km")
    radius_m = si(wire, "radius_mm")
    if wire.gmr_mm is not None:
        return by_mean_radius(omega_rad_s, r_ohm_per_m, radius_m, si(wire, "gmr_mm"))
    inner_m, permeability = si(wire, "inner_radius_mm"), wire.relative_permeability
    return by_skin_effect(omega_rad_s, r_ohm_per_m, radius_m, inner_m, permeability)


def grouped(geometry: Geometry) -> tuple[tuple[str, ...], list[int]]:
    """Names of all groups, and the number of each conductor's; -1: none."""
    several = len(geometry.tracks) > 1
    keys = [
        (group, track)
        for track in geometry.tracks
        for group in ORDER
        if any((each.group, each.track) == (group, track) for each in geometry.conductors)
    ]
    names = tuple(f"{group} {track}" if several else group for group, track in keys)
    number = {key: i for i, key in enumerate(keys)}
    return names, [number.get((each.group, each.track), -1) for each in geometry.conductors]


def _no_frequency(geometry: Geometry, frequency_hz: float | None) -> Finding:
    place = (str(geometry.source), "frequency_hz")
    if frequency_hz is None:
        remedy = "add it to the file, or give --frequency; 0 of direct current"
        return Finding(*place, "", "no frequency is given", remedy)
    return Finding(*place, f"{frequency_hz:g}", "out of range", f"give 0 to {HIGHEST_HZ:g} Hz")


def _demand_passive(found: LineConstants) -> None:
    """Refuse matrices by which a line would give off power, or energy of its fields."""
    held = [
        ("R", found.impedance.real, "Ω/m"),
        ("X", found.impedance.imag, "Ω/m"),
        ("C", found.capacitance, "F/m"),
    ]
    findings = [
        Finding(
            str(found.geometry.source),
            "conductors",
            "",
            f"no passive line: the smallest eigenvalue of {name} is {lowest:.3g} {unit}, not positive",
            _remedy(found.geometry.method),
        )
        for name, matrix, unit in held
        if (name != "X" or found.frequency_hz > 0.0)
        and not (lowest := float(np.linalg.eigvalsh(matrix).min())) > 0.0
    ]
    if findings:
        raise ScenarioError(findings)


def _remedy(method: str) -> str:
    if method != "carson":
        return f'take method = "carson": {method} fails far apart, or over earth that conducts well'
    return "check radius_mm, gmr_mm and the places of the conductors"
