"""The equations of line constants against closed forms and slow twins."""

from itertools import pairwise

import numpy as np
import pytest
import scipy.integrate
import scipy.special

from tpss.conductors.formulas.bessel import scaled_i, scaled_k
from tpss.conductors.formulas.carson import LAST_OF_SERIES, carson, integral, series
from tpss.conductors.formulas.clem import clem
from tpss.conductors.formulas.deri import deri
from tpss.conductors.formulas.equivalents import autotransformer_line
from tpss.conductors.formulas.inside import by_mean_radius, by_skin_effect
from tpss.conductors.formulas.matrices import (
    membership,
    of_groups,
    potential_coefficients,
    series_impedance,
)

OMEGA = 100.0 * np.pi
PER_M = 4e-7 * np.pi * OMEGA / (2.0 * np.pi)
"""ωμ₀/2π at 50 Hz. [Ω/m]"""


def carson_by_quadrature(k, angle_rad):
    """P + jQ by Carson's integral as it stands, along the real axis."""

    def integrand(u, part):
        value = 1j * np.exp(-k * np.cos(angle_rad) * u) * np.cos(k * np.sin(angle_rad) * u)
        return getattr(value / (u + np.sqrt(u**2 + 1j)), part)

    ends = [0.0, *np.geomspace(0.1, 40.0 / (k * np.cos(angle_rad)), 12)]
    options = {"limit": 500, "epsabs": 1e-14, "epsrel": 1e-11}
    p, q = (
        sum(
            scipy.integrate.quad(integrand, *each, (part,), **options)[0] for each in pairwise(ends)
        )
        for part in ("real", "imag")
    )
    return p + 1j * q


@pytest.mark.parametrize("k", [0.02, 0.3, 1.5, 2.9, 3.1, 6.0, 20.0])
@pytest.mark.parametrize("angle_rad", [0.0, 0.6, 1.2, 1.5])
def test_carson_is_his_integral_on_both_sides_of_the_series_range(k, angle_rad):
    """With ω μ₀ = ρ, k is the distance to the image in metres."""
    rho = 4e-7 * np.pi * OMEGA
    height, across = k * np.cos(angle_rad), k * np.sin(angle_rad)
    found = carson(OMEGA, rho, height, across) * np.pi / rho
    assert found == pytest.approx(carson_by_quadrature(k, angle_rad), abs=1e-11)


def test_series_and_integral_agree_where_one_follows_the_other():
    angles = np.linspace(0.0, np.pi / 2.0, 19)
    k = np.full(19, LAST_OF_SERIES)
    assert series(k, angles) == pytest.approx(integral(k, angles), abs=1e-12)


def test_conductors_low_above_ground_and_far_apart_have_an_integral_too():
    """Along the real axis it would oscillate for ever; it falls as 1/k², as between conductors that the
    earth almost hides from each other."""
    near, far = abs(integral(np.array([50.0, 100.0]), np.pi / 2.0))
    assert far == pytest.approx(near / 4.0, rel=1e-3)


def test_clem_s_return_lies_659_metres_deep_per_root_of_resistivity_over_frequency():
    """Of one wire: R + ωμ₀/8 + j ωμ₀/2π ln(D_e / GMR), D_e = 658.87 √(100/50) = 931.8 m;
    ωμ₀/8 = π² 1e-4 · 50 = 0.0493 Ω/km."""
    gmr_m, radius_m, height_m = 0.005, 0.006, 6.0
    inside = by_mean_radius(OMEGA, 1e-4, radius_m, gmr_m)
    (z,) = series_impedance(OMEGA, [inside], [0.0], [height_m], [radius_m], 100.0, clem).ravel()
    assert z.real == pytest.approx(1e-4 + np.pi**2 * 1e-7 * 50.0, rel=1e-12)
    assert z.imag == pytest.approx(PER_M * np.log(658.87 * np.sqrt(2.0) / gmr_m), rel=1e-6)


@pytest.mark.parametrize(("approximate", "within_ohm_per_km"), [(clem, 1e-3), (deri, 6e-3)])
def test_approximations_are_as_close_to_carson_as_they_are_said_to_be(
    approximate, within_ohm_per_km
):
    places = (OMEGA, 250.0, np.array([1.2, 12.0, 17.0]), np.array([1.4, 0.0, 3.3]))
    difference = 1e3 * abs(approximate(*places) - carson(*places))
    assert 0.0 < difference.max() < within_ohm_per_km


@pytest.mark.parametrize("order", [0, 1])
def test_bessel_functions_are_those_of_scipy(order):
    z = np.geomspace(1e-3, 2e3, 40) * np.exp(0.25j * np.pi)
    phase = np.exp(1j * z.imag)  # scipy scales by the real part alone
    assert scaled_i(order, z) == pytest.approx(scipy.special.ive(order, z) / phase, rel=1e-10)
    assert scaled_k(order, z) == pytest.approx(scipy.special.kve(order, z), rel=1e-10)


def test_direct_current_meets_resistance_only():
    assert by_skin_effect(0.0, 2e-4, 0.006) == 2e-4
    assert by_mean_radius(0.0, 2e-4, 0.006, 0.005) == 2e-4


@pytest.mark.parametrize("inner_m", [0.0, 0.003, 0.0059])
def test_without_skin_effect_a_wire_has_the_inductance_of_even_current(inner_m):
    """0.01 Hz; a solid wire has μ₀/8π = 50 nH/m, whose mean radius is e^(-1/4) r. A thin tube has
    μ₀/2π (a - b)/3a in the limit; both sides of the switch from series to Bessel functions agree."""
    omega = 0.02 * np.pi
    even = by_skin_effect(omega, 2e-4, 0.006, inner_m)
    assert even.real == pytest.approx(2e-4, rel=1e-9)
    inductance = even.imag / omega
    if inner_m == 0.0:
        assert inductance == pytest.approx(50e-9, rel=1e-9)
        mean = by_mean_radius(omega, 2e-4, 0.006, 0.006 * np.exp(-0.25))
        assert even == pytest.approx(mean, rel=1e-9)
    if inner_m == 0.0059:
        assert inductance == pytest.approx(2e-7 * 0.1 / (3.0 * 6.0), rel=0.02)
    at_switch = [by_skin_effect(w, 2e-4, 0.006, inner_m).imag / w for w in (5.0, 5.5)]
    assert at_switch == pytest.approx([inductance, inductance], rel=1e-5)


@pytest.mark.parametrize("inner_m", [0.0, 0.0972])
def test_strong_skin_effect_leaves_the_current_at_the_outside(inner_m):
    """z = (1 + j) ρ / (2π a δ), δ = √(2ρ/ωμ): of a rail at 50 kHz δ = 0.1 mm."""
    radius_m, r = 0.109, 0.0287e-3
    rho = r * np.pi * (radius_m**2 - inner_m**2)
    omega = 1e5 * np.pi
    depth_m = np.sqrt(2.0 * rho / (omega * 100.0 * 4e-7 * np.pi))
    expected = (1.0 + 1.0j) * rho / (2.0 * np.pi * radius_m * depth_m)
    found = by_skin_effect(omega, r, radius_m, inner_m, 100.0)
    assert found == pytest.approx(expected, rel=3.0 * depth_m / radius_m + 1e-3)


def test_a_tube_without_a_hole_is_solid():
    solid = by_skin_effect(OMEGA, 2e-5, 0.02)
    assert by_skin_effect(OMEGA, 2e-5, 0.02, 1e-9) == pytest.approx(solid, rel=1e-9)


def test_the_capacitance_of_a_wire_above_ground():
    """2π ε₀ / ln(2h/r) = 55.633 pF/m / ln 2000 = 7.319 nF/km."""
    (coefficient,) = potential_coefficients([0.0], [6.0], [0.006]).ravel()
    assert 1e12 / coefficient == pytest.approx(7.319, abs=5e-4)


def test_two_like_conductors_of_one_voltage_have_the_mean_of_own_and_common_impedance():
    z = np.array([[3.0 + 5.0j, 1.0 + 2.0j], [1.0 + 2.0j, 3.0 + 5.0j]])
    together = np.linalg.inv(of_groups(z, membership([0, 0])))
    assert together == pytest.approx(np.array([[2.0 + 3.5j]]))


def test_a_conductor_at_earth_is_eliminated_as_kron_does():
    """3 + 5j - (1 + 2j)² / (4 + 6j)."""
    z = np.array([[3.0 + 5.0j, 1.0 + 2.0j], [1.0 + 2.0j, 4.0 + 6.0j]])
    left = np.linalg.inv(of_groups(z, membership([0, -1])))
    assert left == pytest.approx(np.array([[3.0 + 5.0j - (1.0 + 2.0j) ** 2 / (4.0 + 6.0j)]]))


def solved_at(z, tracks, train_km, track, cell_km=10.0, posts=4):
    """Drop of contact line to rails of every track, for 1 A drawn on one, by all nodes at once.

    Conductors are the contact lines, the rails, the feeders; autotransformers of 0.1 µΩ at every
    post; the station holds all voltages at km 0.
    """
    n = 2 * tracks + 1
    places = sorted({*(cell_km * np.arange(posts)), train_km})
    y = np.zeros((n * len(places),) * 2, complex)
    for i, length in enumerate(np.diff(places)):
        piece = np.linalg.inv(z * length)
        a, b = (slice(n * (i + k), n * (i + k + 1)) for k in (0, 1))
        y[a, a] += piece
        y[b, b] += piece
        y[a, b] -= piece
        y[b, a] -= piece
    for i, place in enumerate(places):
        for t in range(tracks) if place % cell_km == 0.0 else ():
            winding = np.zeros(n)
            winding[[t, tracks, tracks + 1 + t]] = 1.0, -2.0, 1.0
            y[n * i : n * (i + 1), n * i : n * (i + 1)] += np.outer(winding, winding) / 2e-7
    at = n * places.index(train_km)
    drawn = np.zeros(len(y))
    drawn[[at + track, at + tracks]] = -1.0, 1.0
    voltage = np.zeros(len(y), complex)
    voltage[n:] = np.linalg.solve(y[n:, n:], drawn[n:])
    return -(voltage[at : at + tracks] - voltage[at + tracks])


@pytest.mark.parametrize("tracks", [1, 2])
@pytest.mark.parametrize("train_km", [3.0, 12.5, 27.0])
def test_a_line_of_autotransformers_is_what_all_of_its_nodes_give(tracks, train_km):
    """Contact line and feeder differ, so that a current flows between them all along the line."""
    x = [*[0.0, 4.5][:tracks], 2.25, *[-3.3, 7.8][:tracks]]
    height = [*[6.2] * tracks, 0.6, *[8.4] * tracks]
    inside = [*[0.09 + 0.01j] * tracks, 0.04 + 0.02j, *[0.13 + 0.02j] * tracks]
    radius = [*[0.2] * tracks, 0.8, *[0.01] * tracks]
    z = 1e3 * series_impedance(OMEGA, np.array(inside) / 1e3, x, height, radius, 100.0, carson)
    half, none = np.eye(tracks) / 2.0, np.zeros((1, tracks))
    along, in_cell = autotransformer_line(
        z, np.vstack([half, none, -half]), np.vstack([half, none - 1.0, half])
    )
    within = train_km % 10.0
    expected = along * train_km + in_cell * within * (10.0 - within) / 10.0
    assert solved_at(z, tracks, train_km, 0) == pytest.approx(expected[:, 0], rel=1e-5)
