"""Line constants against computed and published cases, through the format of the file."""

from pathlib import Path

import numpy as np
import pytest

import tpss
from tpss.conductors.formulas.earth_return import METHODS
from tpss.conductors.formulas.inside import by_mean_radius
from tpss.conductors.formulas.matrices import membership, of_groups, series_impedance
from tpss.conductors.load import geometry_of

from conductor_cases import (
    BUNDLED,
    CAPACITANCE_F_PER_KM,
    CONDUCTORS,
    DOUBLE_TRACK_OF_THE_COURSE,
    EARTH_OHM_M,
    EQUIVALENTS,
    KRON_50_HZ,
    ORDER,
    OWN_AND_COMMON_OF_THE_COURSE,
    PRIMITIVE_50_HZ,
    PUBLISHED,
    WIRES,
)

DIGITS = 1e-9
"""The cases have ten digits. [Ω/km]"""

PRINTED = 1e-4
"""The published tables have four decimals; two of them are cut off, not rounded. [Ω/mile]"""

M_PER_FT, KM_PER_MILE = 0.3048, 1.609344


def constants_of(conductors, frequency_hz, **others):
    document = {"conductors": conductors, **others}
    return tpss.line_constants(geometry_of(document, Path("case.toml")), frequency_hz)


def single_track(frequency_hz, method="carson"):
    return constants_of(
        CONDUCTORS, frequency_hz, method=method, earth_resistivity_ohm_m=EARTH_OHM_M
    )


@pytest.mark.parametrize(("frequency_hz", "method"), BUNDLED)
def test_contact_line_rails_and_feeder_of_a_2x25_kv_track(frequency_hz, method):
    found = single_track(frequency_hz, method)
    r, x = (each.loc[ORDER, ORDER] for each in (found.r_ohm_per_km, found.x_ohm_per_km))
    expected = np.array(BUNDLED[frequency_hz, method])
    assert (r + 1j * x).to_numpy() == pytest.approx(expected, abs=DIGITS)


def test_all_of_its_conductors():
    found = 1e3 * single_track(50.0).conductor_impedance
    assert found == pytest.approx(np.array(PRIMITIVE_50_HZ), abs=DIGITS)


def test_its_earth_wire_at_zero_voltage_is_not_a_bundled_one():
    """Kron's reduction of one conductor, all others being groups of their own."""
    omega = 100.0 * np.pi
    wires = [each["wire"] for each in CONDUCTORS]
    inside = [
        by_mean_radius(omega, each["r_ohm_per_km"] / 1e3, each["radius_mm"], each["gmr_mm"])
        for each in wires
    ]
    places = ([each[key] for each in CONDUCTORS] for key in ("x_m", "height_m"))
    radii_m = [each["radius_mm"] / 1e3 for each in wires]
    impedance = series_impedance(omega, inside, *places, radii_m, EARTH_OHM_M, METHODS["carson"])
    kept = np.linalg.inv(of_groups(impedance, membership([0, 1, 2, 3, 4, -1])))
    assert 1e3 * kept == pytest.approx(np.array(KRON_50_HZ), abs=DIGITS)


@pytest.mark.parametrize("frequency_hz", EQUIVALENTS)
def test_what_stands_for_the_line_without_autotransformers(frequency_hz):
    found = {each.name: 1e3 * each.own for each in single_track(frequency_hz).equivalents}
    expected = EQUIVALENTS[frequency_hz]
    earthed = expected["contact_with_rails_at_earth_potential"]
    insulated = expected["contact_with_all_return_in_rails"]
    assert found["rails-earthed"] == pytest.approx(earthed, abs=DIGITS)
    assert found["rails-insulated"] == pytest.approx(insulated, abs=DIGITS)


@pytest.mark.parametrize("frequency_hz", EQUIVALENTS)
def test_the_case_s_autotransformers_are_those_of_like_contact_line_and_feeder(frequency_hz):
    """Its formula leaves out what flows between both because they differ,
    q = (z_c - z_f - 2 z_cr + 2 z_fr)² / 16 z_ll: 3 % of z_L, which in all but moves to z_s.
    """
    found = single_track(frequency_hz)
    z = 1e3 * found.impedance[np.ix_(*2 * [[found.groups.index(each) for each in ORDER]])]
    far, near = np.array([0.5, 0.0, -0.5]), np.array([0.5, -1.0, 0.5])
    unlike = (far @ z @ near) ** 2 / (near @ z @ near)
    equivalents = {each.name: 1e3 * each.own for each in found.equivalents}
    expected = EQUIVALENTS[frequency_hz]
    along, in_cell = equivalents["autotransformers"], equivalents["autotransformers-in-cell"]
    assert along + unlike == pytest.approx(expected["at_long_distance"], abs=DIGITS)
    assert in_cell - unlike == pytest.approx(expected["at_saw_tooth"], abs=DIGITS)
    assert 0.0 < abs(unlike) < 0.04 * abs(along)


def test_a_double_track_of_25_kv_with_what_both_have_in_common():
    """Its formulas are the first terms, with logarithms to base 10: three decimals are given."""
    found = constants_of(
        DOUBLE_TRACK_OF_THE_COURSE, 50.0, method="clem", earth_resistivity_ohm_m=300.0
    )
    (earthed,) = (each for each in found.equivalents if each.name == "rails-earthed")
    own, common = OWN_AND_COMMON_OF_THE_COURSE
    assert 1e3 * earthed.own == pytest.approx(own, abs=7e-4)
    assert 1e3 * earthed.mutual == pytest.approx(common, abs=7e-4)


def test_the_capacitances_of_the_2x25_kv_track():
    """Farad a kilometre; the susceptance is 2π f C."""
    found = single_track(50.0)
    capacitance = found.b_us_per_km.loc[ORDER, ORDER].to_numpy() / (2e6 * np.pi * 50.0)
    assert capacitance == pytest.approx(np.array(CAPACITANCE_F_PER_KM), rel=1e-8, abs=1e-18)


@pytest.mark.parametrize("name", PUBLISHED)
def test_kersting_s_and_the_ieee_s_lines_to_the_last_printed_digit(name):
    """Phases are groups of their own, the neutral lies at earth all along; 60 Hz, 100 Ω m."""
    (phase, neutral), places_ft, printed, computed = PUBLISHED[name]
    conductors = [
        {
            "name": wire,
            "group": "earth" if wire == "n" else "contact",
            "track": 1 if wire == "n" else track,
            "x_m": x_ft * M_PER_FT,
            "height_m": height_ft * M_PER_FT,
            "wire": of_feet(neutral if wire == "n" else phase),
        }
        for track, (wire, (x_ft, height_ft)) in enumerate(places_ft.items(), 1)
    ]
    found = KM_PER_MILE * 1e3 * constants_of(conductors, 60.0, method="clem").impedance
    assert found == pytest.approx(np.array(printed), abs=PRINTED)
    assert found == pytest.approx(np.array(computed), abs=1e-7)


def of_feet(wire):
    """A wire of the case; its radius is of no account without capacitances."""
    r_ohm_per_mile, gmr_ft = WIRES[wire]
    gmr_mm = 1e3 * gmr_ft * M_PER_FT
    return {
        "r_ohm_per_km": r_ohm_per_mile / KM_PER_MILE,
        "gmr_mm": gmr_mm,
        "radius_mm": 1.3 * gmr_mm,
    }
