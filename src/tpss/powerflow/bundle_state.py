"""The state of bundles, the voltages of all conductors at their trains, as it is kept and moved.

Each function is what one of the load flow's is for the nodes; without bundles there is nothing to do.
"""

from typing import Any

from tpss.kernel import at, kernel, where_any
from tpss.numerics.pairs import Pair, scaled
from tpss.powerflow.bundles import BundleFlow, Bundles, Complexes


@kernel
def _copy(values: Complexes, to: Complexes) -> None:
    """Copy an array of the shape of another one."""
    for i in range(values.shape[0]):
        for c in range(values.shape[1]):
            to[at(i), at(c)] = values[at(i), at(c)]


def _nothing(*_: Any) -> None:
    """Where there are no bundles."""


@where_any(without=_nothing)
def mark_bundles(own: BundleFlow) -> None:
    """`newton.mark_base` of the trains."""
    _copy(own.voltage_v, own.base_v)


@where_any(without=_nothing)
def step_bundles(own: BundleFlow, size: float) -> None:
    """`newton.take_step` of the trains."""
    for i in range(own.voltage_v.shape[0]):
        if own.is_under[at(i)]:
            for c in range(own.voltage_v.shape[1]):
                step_v = scaled(own.direction_v[at(i), at(c)], size)
                own.voltage_v[at(i), at(c)] = own.base_v[at(i), at(c)] + step_v


@where_any(without=_nothing)
def stay_with_bundles(own: BundleFlow) -> None:
    """`linked._stay` of the trains."""
    own.direction_v[:] = 0.0


@where_any(without=_nothing)
def predict_bundles(own: BundleFlow) -> None:
    """`solve.predict` of the trains."""
    for i in range(own.known.size):
        for c in range(own.voltage_v.shape[1]):
            if own.known[at(i)] > 0:
                last_v = own.last_v[at(i), at(c)]
                own.voltage_v[at(i), at(c)] = 2.0 * last_v - own.before_v[at(i), at(c)]


@where_any(without=_nothing)
def remember_bundles(own: BundleFlow, first: int) -> None:
    """`solve.remember` of the trains; what is known of those that are gone is forgotten."""
    for i in range(own.known.size):
        if not own.is_under[at(i)]:
            own.known[at(i)] = 0
            continue
        for c in range(own.voltage_v.shape[1]):
            voltage_v = own.voltage_v[at(i), at(c)]
            follows = own.known[at(i)] > 0 and not first
            own.before_v[at(i), at(c)] = own.last_v[at(i), at(c)] if follows else voltage_v
            own.last_v[at(i), at(c)] = voltage_v
        own.known[at(i)] = 1


@where_any(without=_nothing)
def set_bundles_aside(own: BundleFlow) -> None:
    """`path.set_aside` of the trains."""
    _copy(own.voltage_v, own.aside_v)


@where_any(without=_nothing)
def take_bundles_back(own: BundleFlow) -> None:
    """`path.take_back` of the trains."""
    _copy(own.aside_v, own.voltage_v)


@where_any(without=_nothing)
def keep_bundles(own: BundleFlow) -> None:
    """`path.keep` of the trains."""
    _copy(own.good_v, own.passed_v)
    _copy(own.voltage_v, own.good_v)


@where_any(without=_nothing)
def predict_bundles_on_path(own: BundleFlow, ahead: float) -> None:
    """`path.predict_on_path` of the trains."""
    for i in range(own.known.size):
        for c in range(own.voltage_v.shape[1]):
            good_v = own.good_v[at(i), at(c)]
            step_v = scaled(good_v - own.passed_v[at(i), at(c)], ahead)
            own.voltage_v[at(i), at(c)] = good_v + step_v


@where_any(without=_nothing)
def mirror_bundles(own: BundleFlow) -> None:
    """`path.mirror_on_path` of the trains."""
    for i in range(own.known.size):
        for c in range(own.voltage_v.shape[1]):
            good_v = own.good_v[at(i), at(c)]
            own.voltage_v[at(i), at(c)] = 2.0 * good_v - own.voltage_v[at(i), at(c)]


def _not_flat(_bundles: Bundles, _n: int, voltage_v: complex) -> complex:
    """`flat_voltage` where there are no bundles. [V]"""
    return voltage_v


@where_any(without=_not_flat)
def flat_voltage(bundles: Bundles, n: int, voltage_v: complex) -> complex:
    """Voltage of node `n` without load, where that of a contact line is another. [V]"""
    return scaled(voltage_v, bundles.flat_pu[at(n)])


def _all_lie_in_band(*_: Any) -> bool:
    """`lies_in_band` where there are no bundles."""
    return True


@where_any(without=_all_lie_in_band)
def lies_in_band(bundles: Bundles, n: int) -> bool:
    """Whether node `n` is one of those whose voltage is held against the band."""
    return bool(bundles.flat_pu[at(n)] == 1.0)


def _at_node(_bundles: Bundles, _s: int, voltage_v: complex, _current_a: complex) -> complex:
    """`terminal_voltage` where there are no bundles. [V]"""
    return voltage_v


@where_any(without=_at_node)
def terminal_voltage(bundles: Bundles, s: int, voltage_v: complex, current_a: complex) -> complex:
    """Voltage between the terminals of source `s`, from that of its node and its current. [V]"""
    return voltage_v - scaled(current_a, bundles.inner_ohm[at(s)])


def _as_at_node(_bundles: Bundles, _s: int, _by_voltage: Pair, by_current: Pair) -> Pair:
    """`through_terminals` where there are no bundles."""
    return by_current


@where_any(without=_as_at_node)
def through_terminals(bundles: Bundles, s: int, by_voltage: Pair, by_current: Pair) -> Pair:
    """Derivative of a law over the current of source `s`, also by the voltage of its terminals."""
    ohm = bundles.inner_ohm[at(s)]
    return (
        by_current[0] - scaled(by_voltage[0], ohm),
        by_current[1] - scaled(by_voltage[1], ohm),
    )
