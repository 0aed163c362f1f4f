"""A quantity that rises linearly between two others, and is constant outside."""

from tpss.kernel import inlined


@inlined
def ramp(x: float, low: float, high: float, least: float, most: float) -> tuple[float, float]:
    """Value and slope at `x` of a ramp from `least` at `low` to `most` at `high`.

    Parameters
    ----------
    x : float
    low, high : float
        Its ends, in ascending order; with both the same it is a step, `most` at the end itself.
    least, most : float
        Values up to its beginning, and from its end.
    """
    if x >= high:
        return most, 0.0
    if x <= low:
        return least, 0.0
    slope = (most - least) / (high - low)
    return least + slope * (x - low), slope
