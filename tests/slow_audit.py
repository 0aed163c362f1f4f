"""The audit of `tpss.audit` once more, in array operations over all steps at once."""

import math

import numpy as np
import numpy.typing as npt

import tpss
from slow_motion_audit import force_balance, motion_error_m, traction_balance
from slow_network_audit import converter_residual, network_balance, phasors, power_mismatch_va
from tpss.audit.verdict import JUDGED, Audit, judge, limits_of, usual_limits
from tpss.run.run import Outcome, advance_to_end, outcome_of, run_of
from tpss.step.model import Model

Floats = npt.NDArray[np.float64]

BASE_VA = 10e6
"""Power to which the limit of the power mismatch refers. [VA]"""

ROUNDINGS = 4.0
"""Roundings of the largest power by which two orders of operations may differ. [1]"""

OF_A_LIMIT = 1e-3
"""The audit's figures are themselves rounding errors, which another order of operations changes."""


def assert_agree(found: Audit, expected: Audit, limits: dict[str, float]) -> None:
    """Assert that two audits agree, as far as rounding errors can."""
    usual = usual_limits(BASE_VA)
    for name in JUDGED:
        own, other = getattr(found, name), getattr(expected, name)
        # What is not judged may be large, and what a forgery has spoilt not a number.
        gap = OF_A_LIMIT * limits.get(name, usual[name]) + 1e-9 * abs(other)
        assert abs(own - other) <= gap or (math.isnan(own) and math.isnan(other)), name
    for name in ("lowest_voltage_v", "highest_voltage_v", "passed"):
        assert getattr(found, name) == getattr(expected, name), name


def audit_of(scenario: tpss.Scenario) -> tuple[Audit, dict[str, float]]:
    """Audit of the run of a scenario, and the limits by which it is judged."""
    prepared = tpss.prepare(scenario)
    start, model = prepared.start, prepared.start.model
    run = run_of(start, prepared.clock)
    outcome = outcome_of(run, advance_to_end(run, start), start.studied)
    # What rounding leaves of a power is in proportion to the largest one: stations a metre apart may
    # feed each other with gigawatts.
    rows, limits = outcome.recording.stations, limits_of(model)
    powers = np.hypot(rows["station_active_power"], rows["station_reactive_power"])[: run.step]
    rounding_va = ROUNDINGS * np.finfo(float).eps * float(powers.max(initial=0.0))
    limits["power_mismatch_va"] += rounding_va / OF_A_LIMIT
    plan = prepared.layout.supply
    return audit(outcome, model, np.where(plan.at_line_level, plan.node_level, np.nan)), limits


def audit(outcome: Outcome, model: Model, node_level: Floats) -> Audit:
    """Audit a run.

    Parameters
    ----------
    outcome : Outcome
    model : Model
    node_level : Floats, shape (nodes,)
        Own voltage of each node over that of the contact line; nodes at another level do not count
        for the voltage range.
    """
    trains, nodes = outcome.recording.trains, outcome.recording.nodes
    at_line_level = phasors(nodes, "node")[:, node_level == 1.0]
    phasor = np.concatenate([phasors(trains, "pantograph").ravel(), at_line_level.ravel()])
    voltages = np.sqrt(phasor.real**2 + phasor.imag**2)
    voltages = voltages[np.isfinite(voltages) & (voltages > 0.0)]  # without a source there is none
    figures: dict[str, float] = {
        "power_mismatch_va": power_mismatch_va(outcome, model),
        "converter_residual": converter_residual(outcome, model.network),
        "network_balance": network_balance(outcome, model),
        "traction_balance": traction_balance(outcome, model),
        "force_balance": force_balance(outcome, model),
        "motion_error_m": motion_error_m(outcome, model),
        "stop_error_m": float(outcome.state.clock[0].stop_error_m),
    }
    lowest = float(voltages.min()) if voltages.size else None
    highest = float(voltages.max()) if voltages.size else None
    return judge(figures, lowest, highest, limits_of(model), model.network.system)
