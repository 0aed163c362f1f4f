"""Trains that pulled where the description of their machine has ended: which, and how far."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tpss import library
from tpss.results.result import Result
from tpss.results.standards.windows import Floats, step_values
from tpss.scenario.machine import EffortTable
from tpss.scenario.rolling_stock import Train
from tpss.scenario.supply.system import system_named
from tpss.vehicle.effort.network import CURRENT, SPEED, VOLTAGE

EFFORT = "effort_extrapolated"
"""What the recording counts of it."""

ROUNDING = 1e-9
"""Share by which a value may pass an end and still be at it."""


class Span(NamedTuple):
    """Values that the description of a machine covers."""

    unit: str
    lowest: float
    highest: float
    ends: str
    """What ends there, and what holds beyond."""
    may_be_above: bool
    """Whether nobody need know that it was passed above."""


def extrapolations(result: Result) -> list[str]:
    """A sentence for each type of train and end of its tractive effort that it has passed."""
    types = dict.fromkeys(entry.train for entry in result.scenario.traffic)
    return [note for name in types for note in _of_type(name, result)]


def _of_type(name: str, result: Result) -> Iterator[str]:
    data, scenario = result.dataset, result.scenario
    nominal_kv = system_named(scenario.supply.system).nominal_kv
    services = [entry.name for entry in scenario.traffic if entry.train == name]
    own = np.isin(data.service.to_numpy(), services)
    pulls = step_values(data, "tractive_force")[:, own] > 0.0
    values = {
        "km/h": step_values(data, "speed")[:, own] * 3.6,
        "kV": step_values(data, "pantograph_voltage")[:, own] / 1e3,
    }
    train = scenario.trains[name]
    highest_a = library.networks()["tractive_effort"]["input_max"][CURRENT]
    if train.tractive_effort == "Rc4" and (train.max_motor_current_a or 0.0) > highest_a:
        yield (
            f"{name} has a max_motor_current_a of {train.max_motor_current_a:g} A, beyond the "
            f"{highest_a:g} A to which the tractive-effort network of the Rc4 was trained"
        )
    for span in _spans(train, nominal_kv):
        yield from _beyond(name, span, values[span.unit], pulls)


def _beyond(name: str, span: Span, values: Floats, pulls: npt.NDArray[np.bool_]) -> Iterator[str]:
    """Sentences on the two ends of a span."""
    below = pulls & (values < span.lowest * (1.0 - ROUNDING))
    above = pulls & (values > span.highest * (1.0 + ROUNDING))
    if below.any():
        yield (
            f"{name} pulled below {span.lowest:g} {span.unit}, down to {values[below].min():.4g} "
            f"{span.unit}, in {below.sum()} train-steps: {span.ends}"
        )
    if above.any() and not span.may_be_above:
        yield (
            f"{name} pulled above {span.highest:g} {span.unit}, up to {values[above].max():.4g} "
            f"{span.unit}, in {above.sum()} train-steps: {span.ends}"
        )


def _spans(train: Train, nominal_kv: float) -> Iterator[Span]:
    """What the description of a machine covers; limits of force and power hold anywhere.

    Above its highest voltage a machine gives its full force, so a table that reaches the nominal voltage
    is none the worse for a higher one.
    """
    effort = train.tractive_effort
    if isinstance(effort, EffortTable):
        ends = "its table of tractive effort ends there, and its outer values hold"
        yield Span("km/h", effort.speed_kmh[0], effort.speed_kmh[-1], ends, False)
        if effort.voltage_kv is not None:
            low, high = effort.voltage_kv[0], effort.voltage_kv[-1]
            yield Span("kV", low, high, ends, high >= nominal_kv)
    elif effort == "Rc4":
        network = library.networks()["tractive_effort"]
        ends = "the tractive-effort network of the Rc4 was not trained there"
        for i, unit in ((SPEED, "km/h"), (VOLTAGE, "kV")):
            yield Span(unit, network["input_min"][i], network["input_max"][i], ends, False)
