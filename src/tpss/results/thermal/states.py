"""Thermal states of equipment over a run, exact for loads that hold over a step."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from tpss.physics.thermal import Cooling, ageing_rate, follow, hot_spot_rise
from tpss.results.standards.windows import Floats
from tpss.results.thermal.body import Body

LONGEST_PART_S = 15.0
"""Longest part of a step at whose ends the hot spot of a transformer is found. [s]"""


class States(NamedTuple):
    """Thermal states of equipment over a run, a column for each.

    Attributes
    ----------
    start_load : Floats, shape (elements,)
        Load in whose steady state it begins. [1]
    state : Floats, shape (instants, elements)
        Rise of the temperature over that of the rated load; NaN: it is not there. [1]
    highest : Floats, shape (elements,)
        Highest state, within steps too. [1]
    highest_at_s : Floats, shape (elements,)
        When. [s]
    aged_s : Floats, shape (elements,)
        Life that the paper of a transformer has lost, as a time at the normal rate; else NaN. [s]
    """

    start_load: Floats
    state: Floats
    highest: Floats
    highest_at_s: Floats
    aged_s: Floats


def states_of(bodies: Sequence[Body], load: Floats, instants_s: Floats) -> States:
    """States of bodies under loads, shape (steps, bodies); NaN: it is not there, but once it is."""
    lasts_s = np.diff(instants_s)
    there = np.isfinite(load)
    square = np.nan_to_num(load) ** 2
    start = _start_loads(bodies, square, there, lasts_s)
    # What is not there yet keeps the state in which it will begin.
    waits = ~np.logical_or.accumulate(there, axis=0)
    load = np.where(waits, start, np.sqrt(square))
    tau_s = np.array([body.time_constant_s for body in bodies])
    state = np.empty((len(instants_s), len(bodies)))
    for each_s in np.unique(tau_s):
        own = tau_s == each_s
        state[:, own] = follow(load[:, own] ** 2, lasts_s, float(each_s), start[own] ** 2)
    seen = np.zeros(state.shape, dtype=bool)
    seen[:-1] |= there
    seen[1:] |= there
    state[~seen] = np.nan
    hottest = np.nanargmax(state, axis=0) if bodies else np.zeros(0, dtype=int)
    highest = state[hottest, np.arange(len(bodies))]
    found = States(start, state, highest, instants_s[hottest], np.full(len(bodies), np.nan))
    for cooling in dict.fromkeys(body.cooling for body in bodies if body.cooling is not None):
        own = np.array([body.cooling == cooling for body in bodies])
        ambient_c = np.array([body.ambient_c for body in bodies])[own]
        _replace(found, own, load[:, own], instants_s, cooling, ambient_c)
    return found


def _start_loads(bodies: Sequence[Body], square: Floats, there: Floats, lasts_s: Floats) -> Floats:
    """Load before the run: the one that is given, or the r.m.s. load of the run. [1]"""
    given = np.array([body.preload for body in bodies])
    present_s = lasts_s @ there
    mean = np.divide(lasts_s @ square, present_s, out=np.zeros(len(bodies)), where=present_s > 0.0)
    return np.where(np.isnan(given), np.sqrt(mean), given)


def _replace(
    found: States,
    own: Floats,
    load: Floats,
    instants_s: Floats,
    cooling: Cooling,
    ambient_c: Floats,
) -> None:
    """Put the states of transformers with a cooling in the place of those of one time constant.

    Steps are parted, as the hot spot may be highest within one, and as ageing is no straight line.
    """
    lasts_s = np.diff(instants_s)
    parts = int(np.ceil(lasts_s.max() / LONGEST_PART_S - 1e-9))
    fine_s = np.repeat(lasts_s / parts, parts)
    rise_k = hot_spot_rise(np.repeat(load, parts, axis=0), fine_s, found.start_load[own], cooling)
    rate = ageing_rate(rise_k + ambient_c)
    times_s = instants_s[0] + np.concatenate([[0.0], np.cumsum(fine_s)])
    state = rise_k / cooling.rise_k
    found.state[:, own] = state[::parts]
    found.highest[own] = state.max(axis=0)
    found.highest_at_s[own] = times_s[state.argmax(axis=0)]
    found.aged_s[own] = fine_s @ (rate[:-1] + rate[1:]) / 2.0
