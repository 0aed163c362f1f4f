"""Energy saved over minutes used, a panel for each service."""

import numpy as np
import pandas as pd

from tpss.report.drawings.parts import Curve, Drawing, Panel

MOST_PANELS = 6
"""Services that are drawn, the first ones."""


def savings_drawing(table: pd.DataFrame) -> Drawing:
    """Energy that trains save over the time that they use, by manner of driving.

    Parameters
    ----------
    table : pandas.DataFrame
        As of `spare_time_savings`; not empty.
    """
    panels = [
        Panel(f"{service}\nsaved [%]", _curves(rows), from_zero=True)
        for service, rows in list(table.groupby("service", sort=False))[:MOST_PANELS]
    ]
    return Drawing("time used [min]", panels, panel_inch=2.2)


def _curves(rows: pd.DataFrame) -> list[Curve]:
    return [
        Curve(
            np.append(0.0, own.spare_min.to_numpy()), np.append(0.0, own.saved_percent.to_numpy()),
            str(manner), k, k,
        )
        for k, (manner, own) in enumerate(rows.groupby("manner", sort=False))
    ]  # fmt: skip
