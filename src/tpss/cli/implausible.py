"""Numbers of a train that are possible, but that no train has: units that were mixed up, as a rule."""

from collections.abc import Iterator
from itertools import chain, islice
from typing import Any

import numpy as np

from tpss.kernel import plain
from tpss.model.effort_curve import level_resistance
from tpss.physics.adhesion import Rail, adhesion_limit
from tpss.physics.constants import GRAVITY_M_S2
from tpss.scenario.machine import EffortLimits, EffortTable
from tpss.scenario.rolling_stock import Train
from tpss.units import si

LIGHTEST_T, HEAVIEST_T = 5.0, 12_000.0
"""Masses of whole trains, from a small railcar to ore trains. [t]"""

MOST_FORCE = 2.0
"""Force over what dry rails take from the adhesive mass at a stand; locomotives have up to 1.3. [1]"""

MOST_POWER_KW_PER_T = 120.0
"""Power over mass; a locomotive without a train has up to 80. [kW/t]"""

MOST_RESISTANCE = 0.06
"""Running resistance at the highest speed over weight; a locomotive alone has up to 0.03. [1]"""


def implausible(name: str, train: Train) -> Iterator[str]:
    """Notes on mass, force, power and resistance of a train."""
    if not LIGHTEST_T <= train.mass_t <= HEAVIEST_T:
        yield f"trains.{name}: a whole train of {train.mass_t:g} t is unusual; mass_t is in tonnes"
    yield from islice(chain(_force(name, train), _power(name, train)), 1)  # of one cause, mostly
    yield from _resistance(name, train)


def _force(name: str, train: Train) -> Iterator[str]:
    force_kn, mass_t = highest_force_kn(train), train.adhesive_mass_t
    rails_kn = plain(adhesion_limit)(si(train, "adhesive_mass_t"), 0.0, Rail.DRY) / 1e3
    if force_kn > MOST_FORCE * rails_kn:
        yield (
            f"trains.{name}: its tractive effort of up to {force_kn:g} kN would be "
            f"{force_kn / train.mass_t:.1f} m/s² for {train.mass_t:g} t, and is "
            f"{force_kn / rails_kn:.0f} times what {mass_t:g} t on driven axles pass on to dry rails "
            f"({rails_kn:.0f} kN); forces are in kN"
        )


def _power(name: str, train: Train) -> Iterator[str]:
    power_kw = highest_power_kw(train)
    if power_kw > MOST_POWER_KW_PER_T * train.mass_t:
        yield (
            f"trains.{name}: its power of up to {power_kw:.0f} kW is {power_kw / train.mass_t:.0f} kW "
            f"a tonne; locomotives without a train have up to 80"
        )
    elif train.auxiliary_power_kw > power_kw > 0.0:
        yield (
            f"trains.{name}: its auxiliaries draw {train.auxiliary_power_kw:g} kW, more than the "
            f"{power_kw:.0f} kW of its motors"
        )


def _resistance(name: str, train: Train) -> Iterator[str]:
    resistance_n = level_resistance(train, np.array([si(train, "max_speed_kmh")]))[0]
    share = resistance_n / (si(train, "mass_t") * GRAVITY_M_S2)
    if share > MOST_RESISTANCE:
        yield (
            f"trains.{name}: its running resistance at {train.max_speed_kmh:g} km/h is "
            f"{resistance_n / 1e3:.0f} kN, {100.0 * share:.0f} % of its weight; A, B and C are for the "
            "whole train, in N and m/s"
        )


def highest_force_kn(train: Train) -> float:
    """Highest force of the machine as described; 0 for one that is known by its name. [kN]"""
    effort = train.tractive_effort
    if isinstance(effort, EffortLimits):
        return effort.max_force_kn
    return max(max(row) for row in rows_of(effort)) if isinstance(effort, EffortTable) else 0.0


def highest_power_kw(train: Train) -> float:
    """Highest power of the machine as described; 0 for one that is known by its name. [kW]"""
    effort = train.tractive_effort
    if isinstance(effort, EffortLimits):
        return effort.max_power_kw
    if not isinstance(effort, EffortTable):
        return 0.0
    return max(
        force_kn * speed_kmh / 3.6
        for row in rows_of(effort)
        for force_kn, speed_kmh in zip(row, effort.speed_kmh, strict=True)
    )


def rows_of(effort: EffortTable) -> list[tuple[float, ...]]:
    """The rows over speed of a table of forces."""
    level: list[Any] = [effort.force_kn]
    while isinstance(level[0][0], tuple):
        level = [row for block in level for row in block]
    return level
