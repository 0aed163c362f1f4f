"""The line's gradient where a train is."""

import numpy as np

from tpss.report.sampling import Floats
from tpss.results.result import Result


def inclination(result: Result, position_m: Floats) -> Floats:
    """Rise over run at positions on the line; NaN where there is no position. [1]"""
    profile = result.scenario.line.gradients
    from_m = np.array([gradient.from_km for gradient in profile]) * 1e3
    rise = np.array([gradient.permille for gradient in profile]) / 1e3
    index = np.clip(np.searchsorted(from_m, position_m, side="right") - 1, 0, None)
    return np.where(np.isfinite(position_m), rise[np.minimum(index, len(rise) - 1)], np.nan)
