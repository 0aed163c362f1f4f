"""Switching during a run: another network of the same shapes takes the place of the one before."""

import math
from typing import NamedTuple

from tpss.powerflow.network import Network
from tpss.step.converter_control import HIGHEST_LOADING
from tpss.step.state import State

ROUNDING = 1e-9
"""An instant that is before a switching by less than this share of a step is at it."""


class Switching(NamedTuple):
    """A network, and when it takes the place of the one before."""

    time_s: float
    network: Network

    def step(self, step_s: float) -> int:
        """The step from which it holds: the first whose instant is at the time or after it."""
        return math.ceil(self.time_s / step_s - ROUNDING)


def take_over(before: Network, after: Network, step: int, state: State) -> None:
    """Let a network take the place of another one from a step on.

    The load flow of that step begins as that of a first one: what the stations feed may jump, and is
    held against no step before it.
    """
    for s in range(after.sources.size):
        if after.sources[s].installed != before.sources[s].installed:
            _change_units(s, after, state)
    state.clock[0].fresh_step = step
    state.flow.nodes["last_leaving_a"] = 0.0
    state.flow.search["last_drawn_va"] = 0.0


def _change_units(s: int, after: Network, state: State) -> None:
    """Let other units of a station run than before.

    Where the loading controls them, those that run go on as far as they are in service, and carry what
    was carried; a station that was out counts as fully loaded, as it would otherwise be switched off
    before it has been seen.
    """
    source, units = after.sources[s], state.flow.sources[s]
    was, installed = float(units.running), float(source.installed)
    units.running = min(was, installed) if source.controlled and was > 0.0 else installed
    if was == 0.0:
        units.loading_sum = HIGHEST_LOADING * int(state.clock[0].loading_steps)
    elif units.running > 0.0:
        units.loading_sum *= was / units.running
