"""Converter stations switch converters on and off by their loading, every three minutes."""

import math

from tpss.kernel import at, fused, inlined
from tpss.powerflow.network import NodeFlow
from tpss.sources.kinds import loading
from tpss.step.model import Model
from tpss.step.state import CONTROL_PERIOD_S, State

HIGHEST_LOADING = 0.85
TIME_ROUNDING_S = 1e-6
COUNT_ROUNDING = 1e-9


@inlined
def converters_needed(mean_loading: float, converters: float, installed: int) -> float:
    r"""Converters that would carry the mean power at no more than 85 % loading, at least one.

    .. math:: NoC' = \min(NoC, \lceil \overline{Ld} \, NoC_{used} / 0.85 \rceil)

    Parameters
    ----------
    mean_loading : float
        Mean loading since the last action. [1]
    converters : float
        Number of converters running.
    installed : int
        Number of converters installed.

    References
    ----------
    [Boullanger2009]_, eq. (3.7)-(3.9).
    """
    needed = math.ceil(mean_loading * converters / HIGHEST_LOADING - COUNT_ROUNDING)
    return min(float(installed), max(1.0, needed))


@inlined
def control_converters(time_s: float, model: Model, state: State) -> None:
    """Act at the first instant at or past each multiple of three minutes."""
    clock = state.clock[0]
    if time_s < clock.next_action_s - TIME_ROUNDING_S:
        return
    for s in range(model.network.sources.size):
        source, units = model.network.sources[at(s)], state.flow.sources[at(s)]
        if source.controlled:
            mean = units.loading_sum / clock.loading_steps
            units.running = converters_needed(mean, units.running, source.installed)
        units.loading_sum = 0.0
    clock.loading_steps = 0
    periods = math.floor((time_s + TIME_ROUNDING_S) / CONTROL_PERIOD_S)
    clock.next_action_s = (periods + 1.0) * CONTROL_PERIOD_S


@fused
def station_power(node: NodeFlow, running: float) -> complex:
    """Power P + jQ that the units of a station that run feed into the railway at a node. [VA]"""
    if running == 0.0:  # what leaves a node without a source is a rounding
        return 0j
    return node.voltage_v * node.leaving_current_a.conjugate()


@inlined
def note_loading(model: Model, state: State) -> None:
    """Add this step's loading of each station to the mean that decides the next action."""
    for s in range(model.network.sources.size):
        source, units = model.network.sources[at(s)], state.flow.sources[at(s)]
        power = station_power(state.flow.nodes[at(source.node)], units.running)
        units.loading_sum += loading(power, units.running, source.rating_va)
    state.clock[0].loading_steps += 1
