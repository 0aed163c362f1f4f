"""Explanations of a run: why it ended early, what would help, what was limited."""

from typing import Any

import numpy as np

from tpss.kernel import plain
from tpss.physics.locomotive import machine_force
from tpss.run.run import INTERRUPTED, Outcome, on_line
from tpss.step.model import Model
from tpss.vehicle.terms import Demand
from tpss.vehicle.train_type import TrainType

ALMOST = 0.99
"""Share of the highest plausible voltage above which the voltages count as too high."""

_STRENGTHEN = (
    "Strengthen the supply (an AT catenary, a high-voltage line, more transformers or feeding "
    "stations), or reduce the traffic (longer headway, lower speed or current limit)."
)
_FEED_LESS = (
    "Reduce the reactive power that is fed into the line by the trains' filters (a "
    "filter_reactance_ohm further from zero) or by the catenary's capacitance."
)

_HELP_THE_TRAIN = (
    "Lower the train's mass, raise its current limit (max_motor_current_a) or adhesive mass, "
    "run on dry rails, or strengthen the supply if the voltage is low; with long time steps, "
    "try a shorter one."
)
_LIMIT_LESS = (
    "Relax the train's current_limitation (higher max_current_a, lower umin2_kv or knee_factor)."
)

_LIMITED = {
    "effort_extrapolated": "the tractive-effort network was used outside its training range, or a table "
    "outside its speeds or voltages",
    "effort_clipped": "the tractive-effort network was negative and cut to 0",
    "bridge_extrapolated": "the reactive-power network was used outside its training range",
    "bridge_clipped": "the reactive-power network left 0 to 1 and was cut",
    "power_factor_extrapolated": "the power-factor network was used outside its training range, or a "
    "curve outside its speeds",
    "efficiency_extrapolated": "the efficiency curve was used outside its speeds",
    "current_limited": "the current limitation at low voltage kept a train below the wanted force",
    "short_piece": "a train stood closer than 1 m to another or to a node and counted as 1 m away",
}


def explain(outcome: Outcome, model: Model) -> dict[str, str]:
    """Problem and advice of a run that did not finish; empty for one that did."""
    time_min = outcome.steps * model.options.step_s / 60.0
    if outcome.status == "collapsed":
        return _collapse(outcome, model, time_min)
    if outcome.status == "stalled":
        return _stall(outcome, model, time_min)
    if outcome.status == INTERRUPTED:
        problem = f"Stopped at {time_min:.2f} min; the result holds what was simulated until then."
        return {"problem": problem, "advice": "Run it again to the end."}
    return {}


def _collapse(outcome: Outcome, model: Model, time_min: float) -> dict[str, str]:
    flow, state = outcome.state.flow, outcome.state
    share = float(state.clock[0].carried_share)
    places = flow.standing[: on_line(state).sum()]
    drawing = state.trains["demand"][places["train"]]
    active_mw = drawing["active_power_w"].sum() / 1e6
    reactive_mvar = drawing["reactive_power_var"].sum() / 1e6
    system = model.network.system
    lowest_kv, highest_kv = system.lowest_voltage_v / 1e3, system.highest_voltage_v / 1e3
    problem = (
        f"At {time_min:.2f} min the line cannot carry its load: {len(places)} trains demand "
        f"{active_mw:.2f} MW and {reactive_mvar:.2f} Mvar, and beyond {100 * share:.1f} % of that the "
        f"load flow has no stable solution with all voltages between {lowest_kv:.2f} and "
        f"{highest_kv:.2f} kV."
    )
    advice = _STRENGTHEN
    if len(places) and share > 0.0:
        voltage_kv = np.abs(places["voltage_v"]) / 1e3
        too_high = voltage_kv.max() > ALMOST * highest_kv
        k = int(np.argmax(voltage_kv) if too_high else np.argmin(voltage_kv))
        train, which = int(places[k].train), "highest" if too_high else "lowest"
        place_km = state.trains[train].motion.position_m / 1e3
        name = outcome.trains[train].name
        problem += f" There, {name} at {place_km:.2f} km has {voltage_kv[k]:.2f} kV, the {which}."
        advice = (
            _FEED_LESS if too_high else f"{advice} The weakest place is near {place_km:.0f} km."
        )
    return {"problem": problem, "advice": advice}


def _stall(outcome: Outcome, model: Model, time_min: float) -> dict[str, str]:
    clock = outcome.state.clock[0]
    if clock.stalled_train < 0:
        problem = f"The studied train has not arrived after {time_min:.0f} min."
        return {"problem": problem, "advice": "Give simulation.duration_min, or check the traffic."}
    train = outcome.state.trains[clock.stalled_train]
    name = outcome.trains[clock.stalled_train].name
    motion, demand = train.motion, train.demand
    doing = "cannot start" if motion.speed_m_s <= 0.0 else "slows down and would roll back"
    problem = (
        f"At {time_min:.2f} min {name} {doing} at {motion.position_m / 1e3:.2f} km: resistance and "
        f"gradient demand {clock.force_needed_n / 1e3:.1f} kN, its machine and adhesion give "
        f"{clock.force_available_n / 1e3:.1f} kN at {demand.voltage_v / 1e3:.2f} kV and "
        f"{motion.speed_m_s * 3.6:.1f} km/h."
    )
    voltages_v = outcome.state.trains["demand"]["voltage_v"][on_line(outcome.state)]
    lowest_kv = voltages_v.min() / 1e3
    problem += f" The lowest voltage on the line is {lowest_kv:.2f} kV."
    unlimited_n = _force_without_current_limitation(demand, model.types[train.train_type])
    if demand.wheel_force_n < unlimited_n:
        share = 100.0 * demand.wheel_force_n / unlimited_n
        problem += (
            f" At this voltage its current limitation passes {share:.0f} % of the wanted force, "
            f"{unlimited_n / 1e3:.1f} kN."
        )
        return {"problem": problem, "advice": f"{_LIMIT_LESS} {_STRENGTHEN}"}
    return {"problem": problem, "advice": _HELP_THE_TRAIN}


def _force_without_current_limitation(demand: Demand, train_type: TrainType) -> float:
    """Force at the wheel rim that driver, adhesion and machine allow at the train's voltage. [N]"""
    motors_n = max(0.0, float(demand.machine_force_n))
    machine_n = plain(machine_force)(
        motors_n, demand.resistance_n, train_type.rotor_mass_kg, train_type.inertia_kg
    )
    return float(min(demand.force_cap_n, max(0.0, machine_n)))


def warnings(summary: dict[str, Any]) -> list[str]:
    """Sentences on what was limited or left its range."""
    return [
        f"{_LIMITED[name]}, in {count} train-steps"
        for name, count in summary["limited"].items()
        if count
    ]
