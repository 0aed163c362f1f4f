"""A law of one's own: what its function has to take, and the values of its parameters."""

import math

import pytest

from laws.own_laws import CALM, TUNNEL
from tpss.laws import Law, LawError, Parameter, law
from tpss.laws.kinds import DRIVER
from tpss.numerics import called


def test_its_function_takes_what_its_kind_gives_and_its_parameters():
    def hasty(speed_m_s, limit_m_s, position_m):
        return limit_m_s

    with pytest.raises(LawError, match=r"takes \(speed_m_s, limit_m_s, position_m\)") as raised:
        Law(DRIVER, "hasty", hasty, "", "")
    assert "let it take (speed_m_s, limit_m_s, position_m, to_stop_m)" in str(raised.value)


def test_it_has_no_more_parameters_than_a_record_has_places():
    assert law.MOST_PARAMETERS == called.MOST_PARAMETERS == len(called.Called().parameters)
    names = [f"p{k}" for k in range(17)]
    taken = ", ".join(["speed_m_s", "limit_m_s", "position_m", "to_stop_m", *names])
    function = eval(f"lambda {taken}: 1.0")
    with pytest.raises(LawError, match="has 17 parameters: give it 16 at most"):
        Law(DRIVER, "many", function, "", "", tuple(Parameter(name, "") for name in names))


def test_parameters_come_in_their_order_with_defaults():
    assert CALM.values({"share": 0.8}) == (0.8, 4_000.0)
    assert CALM.values({"from_m": 100.0, "share": 1.0}) == (1.0, 100.0)


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ({}, "the law 'calm' has no value of 'share': give parameters = { share = ... }"),
        (
            {"share": 1.5},
            "'share' of the law 'calm' is 1.5: give a value from 0 to 1: of the limit",
        ),
        ({"share": math.nan}, "'share' of the law 'calm' is nan"),
        ({"portion": 0.5}, "has no parameter 'portion': take one of share, from_m"),
    ],
)
def test_other_parameters_are_refused_with_the_remedy(given, problem):
    with pytest.raises(LawError) as raised:
        CALM.values(given)
    assert problem in str(raised.value)


def test_its_digest_is_that_of_the_text_of_its_function():
    def other(speed_m_s, mass_kg, a_n, b_n_s_per_m, c_n_s2_per_m2, factor):
        return a_n

    changed = Law(TUNNEL.kind, "tunnel", other, "", "", TUNNEL.parameters)
    assert len(TUNNEL.digest) == 16
    assert changed.digest != TUNNEL.digest
