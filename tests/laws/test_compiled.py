"""Compiled code calls a law by its address, plain Python the function itself."""

import pytest

from laws.own_laws import DROOPS, TUNNEL
from tpss.kernel import kernel
from tpss.laws import Law, LawError
from tpss.laws.compiled import called
from tpss.laws.kinds import RESISTANCE
from tpss.numerics.called import Called, find_number, find_six_numbers

GIVEN = (20.0, 500e3, 5e3, 50.0, 10.0)


@kernel
def _one(law, given):
    return find_number(law, given)[0]


@kernel
def _six(law, given):
    return find_six_numbers(law, given)


def test_a_number_is_found_with_the_parameters_of_its_record(as_run):
    """5 kN + 50 · 20 N + 1.5 · 10 · 20² N = 12 kN."""
    laws = Called.array([called(TUNNEL, (1.5,)), called(TUNNEL, (1.0,))])
    assert as_run(_one)(laws[0], GIVEN) == 12e3
    assert as_run(_one)(laws[1], GIVEN) == 10e3


def test_six_numbers_are_found(as_run):
    law = Called.array([called(DROOPS, (50e-6, 3e-8))])[0]
    expected = DROOPS.function(2e6, 1e6, 50e-6, 3e-8)
    assert as_run(_six)(law, (2e6, 1e6)) == pytest.approx(expected, rel=1e-15)


def test_a_law_is_compiled_once():
    assert called(TUNNEL, (1.5,))[0] == called(TUNNEL, (2.0,))[0] != 0


def test_what_numba_does_not_know_is_refused_with_the_remedy():
    def listed(speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2):
        return float(input("a number"))

    with pytest.raises(LawError, match=r"cannot be compiled: .*use arithmetic, conditions"):
        called(Law(RESISTANCE, "listed", listed, "", ""), ())
