"""Converters of different types at one busbar: each has its own law, all have one voltage.

Two types that have droops and reactances in proportion to 1 / rating are one type: they share by rating.
"""

import cmath

import pytest

from tpss.sources.converter import ConverterLaw, converter_residual, terminal_voltage
from tpss.sources.mixed import (
    MixedLaw,
    mixed_is_plausible,
    mixed_reserve,
    mixed_residual,
    set_unloaded_mixed,
    split,
    unloaded_mixed,
)

from alternatives import pair_by_differences

X_G, X_M = 14.42925, 12.467523


def converter(droop=50e-6, generator=X_G, motor=X_M):
    return (16_500.0, droop, generator, motor, 16_500.0, 0.0, 0.0, 0.1)


def station(*types):
    """Types with their numbers of converters and rated powers."""
    whole = sum(units * rating for _, units, rating in types)
    fields = {}
    for name, (law, units, rating) in zip(("first", "second", "third"), types, strict=False):
        fields |= {name: law, f"{name}_units": units, f"{name}_share": units * rating / whole}
    return MixedLaw.array([MixedLaw.row(**fields)])[0]


ALIKE = station((converter(), 2, 10e6), (converter(25e-6, X_G / 2, X_M / 2), 1, 20e6))
"""As four of 10 MVA: the second is as two of the first."""

MIXED = station(
    (converter(), 2, 10e6),
    (converter(20e-6, 5.0, 6.0), 1, 15e6),
    (converter(80e-6, 20.0, 30.0), 3, 5.0e6),
)
STATE = 15.8e3 - 2.1e3j, 900.0 - 420.0j


def test_types_that_are_alike_per_rating_share_by_rating(as_run):
    four = ConverterLaw.array([converter()])[0]
    voltage, _, powers = as_run(split)(12e6 + 8e6j, ALIKE)
    magnitude, direction, *_ = as_run(terminal_voltage)(12e6, 8e6, 4.0, four)
    assert voltage == pytest.approx(magnitude * direction, rel=1e-12)
    assert powers[0] == pytest.approx(6e6 + 4e6j, rel=1e-9)
    assert powers[2] == 0.0


@pytest.mark.parametrize("power", [0j, 20e6 + 8e6j, -15e6 + 2e6j, 3e6 - 25e6j, 60e6 + 40e6j])
def test_all_types_have_the_voltage_of_the_station_and_their_powers_add_up(as_run, power):
    voltage, _, powers = as_run(split)(power, MIXED)
    assert sum(powers) == pytest.approx(power, abs=1e-3)
    for law, units, own in zip(
        (MIXED.first, MIXED.second, MIXED.third), (2.0, 1.0, 3.0), powers, strict=True
    ):
        magnitude, direction, *_ = as_run(terminal_voltage)(own.real, own.imag, units, law)
        assert magnitude * direction == pytest.approx(voltage, abs=1e-7)


def test_derivatives_are_those_of_differences(as_run):
    off = as_run(mixed_residual)
    _, by_voltage, by_current = off(*STATE, MIXED)
    asked = pair_by_differences(lambda v: off(v, STATE[1], MIXED)[0], STATE[0], 1.0)
    assert by_voltage == pytest.approx(asked, rel=1e-6, abs=1e-9)
    asked = pair_by_differences(lambda j: off(STATE[0], j, MIXED)[0], STATE[1], 0.1)
    assert by_current == pytest.approx(asked, rel=1e-6, abs=1e-6)


def test_one_type_is_a_station_of_converters(as_run):
    alone = station((converter(), 3, 10e6))
    law = ConverterLaw.array([converter()])[0]
    found = as_run(mixed_residual)(*STATE, alone)
    asked = as_run(converter_residual)(*STATE, 3.0, law, True)
    assert found[0] == pytest.approx(asked[0], abs=1e-8)
    for own, of_converters in zip(found[1:], asked[1:], strict=True):
        assert own == pytest.approx(of_converters, rel=1e-9)


def test_it_is_as_far_from_falling_out_of_step_as_its_weakest_machines(as_run):
    assert as_run(mixed_is_plausible)(*STATE, MIXED)
    assert as_run(mixed_reserve)(*STATE, MIXED) > 0.0
    assert not as_run(mixed_is_plausible)(1e4 + 0j, -330e3j, station((converter(), 1, 10e6)))


def test_without_load_it_has_the_voltage_that_is_set(as_run):
    own = station((converter(), 2, 10e6), (converter(20e-6), 1, 10e6))
    assert as_run(unloaded_mixed)(own) == (16_500.0, 0.1)
    as_run(set_unloaded_mixed)(16_000.0, 0.0, own)
    voltage, _, _ = as_run(split)(0j, own)
    assert (abs(voltage), cmath.phase(voltage)) == pytest.approx((16_000.0, 0.0), abs=1e-6)
