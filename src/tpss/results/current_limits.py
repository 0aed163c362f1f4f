"""How long stations were at the highest current of their converters."""

from collections.abc import Sequence

import numpy as np

from tpss.run.run import Outcome
from tpss.sources.bounded import ROUND
from tpss.step.model import Model


def at_current_limit(
    outcome: Outcome, model: Model, stations: Sequence[str]
) -> dict[str, dict[str, float]]:
    """Time [min] and highest current [% of the limit] of each station that has a limit.

    A station counts as at its limit from where its voltage begins to fall.

    Parameters
    ----------
    outcome : Outcome
    model : Model
    stations : sequence of str
        Names of the model's sources.
    """
    sources = model.network.sources
    limit_a = sources["bounds"]["highest_current_a"]
    if np.isinf(limit_a).all() or outcome.steps == 0:
        return {}
    rows = outcome.recording.stations[: outcome.steps]
    nodes = outcome.recording.nodes[: outcome.steps][:, sources["node"]]
    size_va = np.hypot(rows["station_active_power"], rows["station_reactive_power"])
    voltage_v = np.hypot(nodes["node_real"], nodes["node_imag"])
    running = np.maximum(rows["active_converters"], 1)
    # A station that is out has no voltage.
    current_a = np.divide(size_va, voltage_v, out=np.zeros_like(size_va), where=voltage_v > 0.0)
    share = current_a / running / limit_a
    lasted_s = np.diff(outcome.instants_s)
    return {
        name: {
            "time_min": float(lasted_s[share[:, i] > 1.0 - ROUND].sum()) / 60.0,
            "highest_percent": 100.0 * float(share[:, i].max()),
        }
        for i, name in enumerate(stations)
        if np.isfinite(limit_a[i])
    }
