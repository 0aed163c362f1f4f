"""Every published value is met within its tolerance, and the page that says so is up to date."""

import pytest

from cases import load_cases
from outcomes import compare, compare_all
from write_page import page, stale

CASES = load_cases()


def checks():
    """Every judged value; a known miss must miss, or its explanation is out of date."""
    for case in CASES:
        for quantity, run, variant in case.checks():
            if quantity.shown_only:
                continue
            miss = case.miss(quantity, run, variant)
            marks = (
                [pytest.mark.xfail(reason=miss.explanation, raises=AssertionError)] if miss else []
            )
            name = f"{case.name}, {quantity.name}, {run}, {variant}"
            yield pytest.param(case, quantity, run, variant, id=name, marks=marks)


@pytest.mark.parametrize(("case", "quantity", "run", "variant"), list(checks()))
def test_a_published_value_is_met(case, quantity, run, variant):
    outcome = compare(case, quantity, run, variant)
    assert outcome.agrees, (
        f"{outcome.ours:.6g} {quantity.unit} where {outcome.published:.6g} is published; "
        f"{quantity.reason}"
    )


def test_the_page_and_its_figures_are_up_to_date():
    outcomes = {case.name: compare_all(case) for case in CASES}
    assert not stale(page(CASES, outcomes), CASES)
