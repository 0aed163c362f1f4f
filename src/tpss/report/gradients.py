"""Gradients where trains are."""

import numpy as np

from tpss.report.sampling import Floats
from tpss.scenario.line import Line


def inclination(line: Line, position_m: Floats) -> Floats:
    """Rise over run at positions on a line; NaN where there is no position. [1]"""
    from_m = np.array([gradient.from_km for gradient in line.gradients]) * 1e3
    rise = np.array([gradient.permille for gradient in line.gradients]) / 1e3
    index = np.clip(np.searchsorted(from_m, position_m, side="right") - 1, 0, None)
    return np.where(np.isfinite(position_m), rise[np.minimum(index, len(rise) - 1)], np.nan)
