"""Explanations of a run: why it ended early, what would help, what was limited."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from tpss.kernel import plain
from tpss.physics.locomotive import machine_force
from tpss.powerflow.network import Ending
from tpss.run.run import INTERRUPTED, Outcome, on_line
from tpss.sources.kinds import SourceKind
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

_TRIED = (
    "Tried were a start from the step before, from base voltage, the loads raised together from zero by "
    "ever smaller steps, and stations made alike and brought apart."
)
_TRY_OTHERS = "Try a shorter time step."
_ALIGN = (
    "Bring the stations' no_load_voltage_kv and grid_angle_deg closer together, lower their reactances, "
    "run more converters, or lower the catenary's and the cables' capacitance."
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


def explain(outcome: Outcome, model: Model, stations: Sequence[str]) -> dict[str, str]:
    """Problem and advice of a run that did not finish; empty for one that did.

    Parameters
    ----------
    outcome : Outcome
    model : Model
    stations : sequence of str
        Names of the feeding stations.
    """
    time_min = outcome.steps * model.options.step_s / 60.0
    if outcome.status == "collapsed":
        if outcome.state.flow.search[0].without_load:
            return _no_state_without_load(outcome, model, time_min, stations)
        return _collapse(outcome, model, time_min, stations)
    if outcome.status == "stalled":
        return _stall(outcome, model, time_min)
    if outcome.status == INTERRUPTED:
        problem = f"Stopped at {time_min:.2f} min; the result holds what was simulated until then."
        return {"problem": problem, "advice": "Run it again to the end."}
    return {}


def _collapse(
    outcome: Outcome, model: Model, time_min: float, stations: Sequence[str]
) -> dict[str, str]:
    flow, state = outcome.state.flow, outcome.state
    share, ending = float(state.clock[0].carried_share), flow.search[0].ending
    places = flow.standing[: on_line(state).sum()]
    drawing = state.trains["demand"][places["train"]]
    active_mw = drawing["active_power_w"].sum() / 1e6
    reactive_mvar = drawing["reactive_power_var"].sum() / 1e6
    system = model.network.system
    lowest_kv, highest_kv = system.lowest_voltage_v / 1e3, system.highest_voltage_v / 1e3
    asked = f"{len(places)} trains demand {active_mw:.2f} MW and {reactive_mvar:.2f} Mvar"
    band = f"with all voltages between {lowest_kv:.2f} and {highest_kv:.2f} kV"
    cannot = f"At {time_min:.2f} min the line cannot carry its load: {asked}, and beyond "
    advice = _STRENGTHEN
    if ending == Ending.LOST:
        problem = (
            f"At {time_min:.2f} min no solution of the load flow was found: {asked}. {_TRIED} The loads "
            f"could be raised to {100 * share:.1f} % {band}, and why not further is not known."
        )
        advice = f"{_TRY_OTHERS} {_STRENGTHEN}"
    elif ending == Ending.OUT_OF_STEP:
        problem = (
            f"{cannot}{100 * share:.1f} % of that {_least_in_step(outcome, model, stations)} falls out "
            "of step: the load angle of its machines would pass 90 degrees."
        )
    else:
        problem = (
            f"{cannot}{100 * share:.1f} % of that the load flow has no stable solution {band}."
        )
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


def _no_state_without_load(
    outcome: Outcome, model: Model, time_min: float, stations: Sequence[str]
) -> dict[str, str]:
    """Words for a supply whose stations do not agree on a state, whatever the trains do."""
    ending = outcome.state.flow.search[0].ending
    if ending == Ending.OUT_OF_STEP:
        which = _least_in_step(outcome, model, stations)
        why = f"{which} falls out of step, as the load angle of its machines would pass 90 degrees"
    else:
        law = model.network.sources.converter
        phasor = np.where(
            model.network.sources.kind == SourceKind.GRID,
            model.network.sources.grid.no_load_voltage_v,
            law.no_load_voltage_v * np.exp(1j * law.grid_angle_rad),
        )
        order = np.argsort(-np.abs(phasor - phasor.mean()), kind="stable")
        which = " and ".join(stations[s] for s in order[:2])
        why = f"the no-load voltages or angles of the stations are too far apart, most of all of {which}"
    if ending == Ending.LOST:
        problem = (
            f"At {time_min:.2f} min no state of the supply was found even without trains; {why}."
        )
    else:
        problem = f"At {time_min:.2f} min the supply has no state even without trains: {why}."
    return {"problem": problem, "advice": _ALIGN}


def _least_in_step(outcome: Outcome, model: Model, stations: Sequence[str]) -> str:
    """Name of the station whose machines are closest to a load angle of 90 degrees, or beyond."""
    flow, sources = outcome.state.flow, model.network.sources
    nodes, law, running = flow.nodes[sources.node], sources.converter, flow.sources.running
    with np.errstate(all="ignore"):
        reactive_var = (nodes.voltage_v * nodes.leaving_current_a.conj()).imag / running
        own_v = law.no_load_voltage_v - law.droop_v_per_var * reactive_var
        along = (own_v**2 + law.generator_reactance_ohm * reactive_var) / own_v**2
    along[(sources.kind != SourceKind.CONVERTER) | np.isnan(along)] = np.inf
    return stations[int(np.argmin(along))]


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
