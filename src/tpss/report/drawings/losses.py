"""Losses of the network over time."""

from collections.abc import Mapping

from tpss.report.drawings.parts import TIME, Curve, Drawing, Panel
from tpss.results.result import Result


def losses(runs: Mapping[str, Result]) -> Drawing:
    """Losses of contact line, transformers and high-voltage line over time.

    Parameters
    ----------
    runs : mapping of str to Result
        Results to overlay, by label.
    """
    curves = []
    for k, (label, result) in enumerate(runs.items()):
        data = result.dataset
        minutes, megawatts = data.time.to_numpy() / 60.0, data.network_losses.to_numpy() / 1e6
        curves.append(Curve(minutes, megawatts, label or "losses", k, k, held=True))
    return Drawing(TIME, [Panel("losses [MW]", curves, from_zero=True)], panel_inch=2.0)
