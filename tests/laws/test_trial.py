"""A law is tried before it is used."""

import math

import pytest

from laws.own_laws import DROOPS, TUNNEL
from tpss.laws import Law, LawError
from tpss.laws.kinds import CONVERTER, RESISTANCE
from tpss.laws.trial import try_converter, try_law

GIVEN = (20.0, 500e3, 5e3, 50.0, 10.0)


def resistance(function):
    return Law(RESISTANCE, "odd", function, "", "")


def converter(voltage, angle, *slopes):
    def law(power_w, reactive_power_var):
        return (voltage(power_w, reactive_power_var), angle(power_w, reactive_power_var), *slopes)

    return Law(CONVERTER, "odd", law, "", "")


def test_laws_that_find_numbers_pass():
    try_law(TUNNEL, (1.3,), [GIVEN])
    try_converter(DROOPS, (50e-6, 3e-8), 10e6)


def test_what_is_no_number_is_refused_with_where():
    law = resistance(lambda speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2: math.nan)
    with pytest.raises(LawError, match=r"finds resistance_n = nan at speed_m_s = 20, mass_kg"):
        try_law(law, (), [GIVEN])


def test_an_error_of_the_function_is_told():
    law = resistance(
        lambda speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2: 1 / (speed_m_s - 20)
    )
    with pytest.raises(LawError, match=r"fails at speed_m_s = 20.*ZeroDivisionError"):
        try_law(law, (), [GIVEN])


def test_too_many_numbers_are_refused():
    law = resistance(lambda speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2: (1.0, 2.0))
    with pytest.raises(LawError, match=r"finds 2 numbers: let it find \(resistance_n\)"):
        try_law(law, (), [GIVEN])


def test_a_slope_that_is_not_the_law_s_is_refused():
    """The voltage falls by 50 µV/var; the law says 60."""
    law = converter(
        lambda p, q: 16_500.0 - 50e-6 * q, lambda p, q: -3e-8 * p, 0.0, -60e-6, -3e-8, 0.0
    )
    with pytest.raises(LawError, match=r"finds voltage_by_reactive = -6e-05 .* gives -5e-05"):
        try_converter(law, (), 10e6)


def test_a_voltage_that_is_not_positive_within_the_rating_is_refused():
    law = converter(lambda p, q: 16_500.0 - 2e-3 * q, lambda p, q: 0.0, 0.0, -2e-3, 0.0, 0.0)
    with pytest.raises(LawError, match=r"finds voltage_v = -3500 at .*reactive_power_var = 1e\+07"):
        try_converter(law, (), 10e6)
