"""Numbers of a range, on a coarse grid as often as not, so that things coincide."""

from hypothesis import strategies as st


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of a range, evenly: on a grid of a hundred places, or on one finer than a millionth.

    Hypothesis prefers small numbers in a wide range, so the fine grid is drawn in three digits.
    """
    digits = st.integers(0, 100)
    grid = digits.map(lambda k: round(low + (high - low) * k / 100.0, 9))
    fine = st.tuples(digits, digits, digits).map(
        lambda k: low + (high - low) * (k[0] / 101.0 + k[1] / 1e4 + k[2] / 1e7)
    )
    return st.one_of(grid, fine).map(lambda number: max(low, min(high, number)))
