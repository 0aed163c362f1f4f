"""What the figures of an audit may be at most, and what is wrong with those of a run."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tpss.audit.balances import ALLOWED_BALANCE
from tpss.driving.data import Driver
from tpss.powerflow.groups import NO_GROUPS
from tpss.powerflow.network import SHORTEST_PIECE_M, TOLERANCE
from tpss.powerflow.system import System, resolution_va
from tpss.step.model import Model

JUDGED = (
    "power_mismatch_va",
    "converter_residual",
    "network_balance",
    "traction_balance",
    "force_balance",
    "motion_error_m",
    "stop_error_m",
)
"""Figures that are judged."""


def usual_limits(base_power_va: float) -> dict[str, float]:
    """Highest value that each figure of a sound run may have, where nothing else limits it.

    Parameters
    ----------
    base_power_va : float
        Base power of the system; the mismatch may be an order above the solver's tolerance. [VA]
    """
    mismatch_va = 10.0 * TOLERANCE * base_power_va
    return dict(
        zip(JUDGED, (mismatch_va, 1e-9, ALLOWED_BALANCE, 1e-9, 1e-9, 1e-6, 1e-3), strict=True)
    )


@dataclass(frozen=True)
class Audit:
    """Figures of a run's audit, and what is wrong with them.

    Attributes
    ----------
    power_mismatch_va : float
        Largest power mismatch over nodes, trains and steps. [VA]
    converter_residual : float
        Largest residual of a station's law. [p.u.]
    network_balance : float
        Energy of the stations less that of trains, stores and losses, relative to the first. [1]
    traction_balance : float
        Work of the motors less resistance, climb, kinetic energy and brakes, relative. [1]
    force_balance : float
        Largest difference between the forces on a train and its mass times acceleration, relative to
        its weight. [1]
    motion_error_m : float
        Largest difference between a train's movement in a step and that of its speeds. [m]
    stop_error_m : float
        Largest distance between where a braking plan ended and its stop. [m]
    lowest_voltage_v, highest_voltage_v : float
        Range of all voltages at pantographs and contact-line nodes, if there are any. [V]
    failures : tuple of str
        Figures beyond their limits, in words; empty for a sound run.
    limits : dict of str to float
        Limits of this run by the names of the figures; one that is missing is not judged.
    """

    power_mismatch_va: float
    converter_residual: float
    network_balance: float
    traction_balance: float
    force_balance: float
    motion_error_m: float
    stop_error_m: float
    lowest_voltage_v: float | None
    highest_voltage_v: float | None
    failures: tuple[str, ...]
    limits: dict[str, float]

    @property
    def passed(self) -> bool:
        """Whether every figure is within its limit."""
        return not self.failures

    def as_dict(self) -> dict[str, Any]:
        """The figures by name."""
        return {
            **vars(self),
            "failures": list(self.failures),
            "limits": dict(self.limits),
            "passed": self.passed,
        }


def judge(
    figures: dict[str, float],
    lowest: float | None,
    highest: float | None,
    limits: dict[str, float],
    system: System,
) -> Audit:
    """An audit from its figures, the range of voltages if there are any, and the limits."""
    failures = (*_beyond_limits(figures, limits), *_out_of_range(lowest, highest, system))
    return Audit(
        **figures,
        lowest_voltage_v=lowest,
        highest_voltage_v=highest,
        failures=failures,
        limits=limits,
    )


def limits_of(model: Model) -> dict[str, float]:
    """Limits of the figures that are judged in a run of this model.

    Over impedances of some microohms, a few metres of line, rounding alone is a visible mismatch; the
    limits of what it touches follow it, and a train between two pieces of line meets the roundings of
    both.  A traction balance billed at the start of a step, or with what slip wastes, does not close,
    and is not judged.
    """
    system = model.network.system
    limits = usual_limits(system.base_power_va)
    blurred = model.network.tolerance / TOLERANCE
    own_ohm_per_m = model.network.sections["impedance_ohm_per_m"]
    if model.network.groups != NO_GROUPS:
        own_ohm_per_m = own_ohm_per_m - model.network.groups.mutual_ohm_per_m
    shortest_ohm = np.abs(own_ohm_per_m).min() * SHORTEST_PIECE_M
    limits["power_mismatch_va"] *= max(
        blurred, 2.0 * resolution_va(shortest_ohm, system) / limits["power_mismatch_va"]
    )
    limits["converter_residual"] *= blurred
    limits["network_balance"] *= blurred
    if not model.options.mean_power or model.options.driver == Driver.AGGRESSIVE:
        del limits["traction_balance"]
    return limits


def _beyond_limits(figures: dict[str, float], limits: dict[str, float]) -> list[str]:
    return [
        f"{name} is {figures[name]:.3g}, limit {limit:g}"
        for name, limit in limits.items()
        if not figures[name] <= limit
    ]


def _out_of_range(lowest_v: float | None, highest_v: float | None, system: System) -> list[str]:
    low, high = system.lowest_voltage_v, system.highest_voltage_v
    if lowest_v is None or highest_v is None or (low <= lowest_v and highest_v <= high):
        return []
    return [f"voltages leave the range of {low:g} to {high:g} V"]
