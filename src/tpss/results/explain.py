"""Explanations of a run: why it ended early, what would help, what was limited."""

import cmath
import math
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from tpss.kernel import plain
from tpss.powerflow.network import Ending
from tpss.results.advice import STRENGTHEN, forces_on, stall_advice, what_binds
from tpss.run.run import INTERRUPTED, Outcome, Run, are_on_line
from tpss.scenario.scenario import Scenario
from tpss.sources.kinds import SourceKind, unloaded
from tpss.step.model import Model, RunControl
from tpss.step.state import Status
from tpss.track.leg import leg_of, place_on_line
from tpss.units import on_line
from tpss.vehicle.train import Train

ALMOST = 0.99
"""Share of the highest plausible voltage above which the voltages count as too high."""

_FEED_LESS = (
    "Reduce the reactive power that is fed into the line by the trains' filters (a "
    "filter_reactance_ohm further from zero) or by the catenary's capacitance."
)

_UNLOADED = (
    "Less traffic does not help. Feed the line near its open end, shorten it there, or lower what "
    "raises the voltage: the catenary's capacitance_nf_per_km, or no_load_voltage_kv of the stations."
)
_TRIED = (
    "Tried were starts from the step before, the trains' voltages as unknowns too, from base voltage, "
    "the loads raised together from zero by ever smaller steps, and stations made alike and brought "
    "apart."
)
_TRY_OTHERS = "Try a shorter time step."
_ALIGN = (
    "Bring the stations' no_load_voltage_kv and grid_angle_deg closer together, lower their reactances, "
    "run more converters, or lower the catenary's and the cables' capacitance."
)

_LIMITED = {
    "effort_extrapolated": "the tractive-effort network was used outside its training range, or a table "
    "outside its speeds or voltages",
    "effort_clipped": "the tractive-effort network was negative and cut to 0",
    "bridge_extrapolated": "the reactive-power network was used outside its training range",
    "bridge_clipped": "the reactive-power network left 0 to 1 and was cut",
    "power_factor_extrapolated": "the power-factor network was used outside its training range, or a "
    "curve outside its speeds",
    "efficiency_extrapolated": "an efficiency curve was used outside its speeds, or beyond its loads",
    "too_near": "trains were nearer to others, or to where they had to wait, than they could brake for",
    "least_wish": "the law of a driver wanted less than 1 km/h, or gave no number, and 1 km/h was taken",
    "motors_spared": "drivers took all that they allow motors to bear, to spare them",
    "current_limited": "the current limitation at low voltage kept a train below the wanted force",
}


def explain(outcome: Outcome, model: Model, scenario: Scenario) -> dict[str, str]:
    """Problem and advice of a run that did not finish; empty for one that did."""
    time_min = outcome.steps * model.options.step_s / 60.0
    stations = [station.name for station in scenario.supply.stations]
    if outcome.status == "collapsed":
        if outcome.state.flow.search[0].without_load:
            unloaded = _collapse_without_load(model, time_min)
            return unloaded or _no_state_without_load(outcome, model, time_min, stations)
        return _collapse(outcome, model, time_min, stations, list(scenario.lines_by_name))
    if outcome.status == "stalled":
        return _stall(outcome, model, scenario, time_min)
    if outcome.status == "deadlocked":
        return _deadlock(outcome, model, scenario, time_min)
    if outcome.status == INTERRUPTED:
        problem = f"Stopped at {time_min:.2f} min; the result holds what was simulated until then."
        return {"problem": problem, "advice": "Run it again to the end."}
    return {}


def _collapse(
    outcome: Outcome, model: Model, time_min: float, stations: Sequence[str], lines: Sequence[str]
) -> dict[str, str]:
    flow, state = outcome.state.flow, outcome.state
    share, ending = float(state.clock[0].carried_share), flow.search[0].ending
    places = flow.standing[: are_on_line(state).sum()]
    drawing = state.trains["demand"][places["train"]]
    active_mw = drawing["active_power_w"].sum() / 1e6
    reactive_mvar = drawing["reactive_power_var"].sum() / 1e6
    if share <= 0.0 and (unloaded := _collapse_without_load(model, time_min)):
        return unloaded
    system = model.network.system
    lowest_kv, highest_kv = system.lowest_voltage_v / 1e3, system.highest_voltage_v / 1e3
    who = "1 train demands" if len(places) == 1 else f"{len(places)} trains demand"
    asked = f"{who} {active_mw:.2f} MW and {reactive_mvar:.2f} Mvar"
    band = f"with all voltages between {lowest_kv:.2f} and {highest_kv:.2f} kV"
    cannot = f"At {time_min:.2f} min the line cannot carry its load: {asked}, and beyond "
    advice = STRENGTHEN
    if ending == Ending.LOST:
        problem = (
            f"At {time_min:.2f} min no solution of the load flow was found: {asked}. {_TRIED} The loads "
            f"could be raised to {100 * share:.1f} % {band}, and why not further is not known."
        )
        advice = f"{_TRY_OTHERS} {STRENGTHEN}"
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
        line, place_km = _place(state.trains[train], model, lines)
        name = outcome.trains[train].name
        here = on_line(line, f"{place_km:.2f} km")
        problem += f" There, {name} at {here} has {voltage_kv[k]:.2f} kV, the {which}."
        weakest = on_line(line, f"{place_km:.0f} km")
        advice = _FEED_LESS if too_high else f"{advice} The weakest place is near {weakest}."
    return {"problem": problem, "advice": advice}


def _place(train: Train, model: Model, lines: Sequence[str]) -> tuple[str, float]:
    """Line, where there are several, and place of a train. [km]"""
    position_m = float(train.motion.position_m)
    leg = leg_of(position_m, int(train.route), model.legs)
    line = lines[leg.line] if len(lines) > 1 else ""
    return line, plain(place_on_line)(position_m, leg) / 1e3


def _collapse_without_load(model: Model, time_min: float) -> dict[str, str] | None:
    """What to say of a line whose voltage leaves the band without any train; None of another."""
    highest_kv = model.network.system.highest_voltage_v / 1e3
    found = _voltage_without_load(model, math.inf)
    if found is None or found[0] <= model.network.system.highest_voltage_v:
        return None
    voltage_v, position_m = found
    problem = (
        f"At {time_min:.2f} min the line has no solution with all voltages below {highest_kv:.2f} kV, "
        f"not even without trains: it would have {voltage_v / 1e3:.2f} kV at {position_m / 1e3:.2f} km"
    )
    if model.network.sections["susceptance_s_per_m"].max() > 0.0:
        problem += ". The charging current of its catenary raises the voltage"
    return {"problem": f"{problem}.", "advice": _UNLOADED}


def _voltage_without_load(model: Model, highest_v: float) -> tuple[float, float] | None:
    """Highest voltage of the contact line's nodes without trains [V], and where that is [m].

    None if the load flow has no solution with all voltages below a highest one.
    """
    system = model.network.system._replace(highest_voltage_v=highest_v)
    network = model.network._replace(system=system)
    run = Run(model._replace(network=network, control=RunControl()), [], 1)
    run.advance_to(1)
    if run.status != Status.RUNNING:
        return None
    sections, rows = network.sections, np.asarray(run.recording.nodes)[0]
    ends = np.concatenate([sections["start_node"], sections["end_node"]])
    voltages_v = np.hypot(rows["node_real"], rows["node_imag"])[ends]
    highest = int(voltages_v.argmax())
    places_m = np.concatenate([sections["start_m"], sections["end_m"]])
    return float(voltages_v[highest]), float(places_m[highest])


def _no_state_without_load(
    outcome: Outcome, model: Model, time_min: float, stations: Sequence[str]
) -> dict[str, str]:
    """Words for a supply whose stations do not agree on a state, whatever the trains do."""
    ending = outcome.state.flow.search[0].ending
    if ending == Ending.OUT_OF_STEP:
        which = _least_in_step(outcome, model, stations)
        why = f"{which} falls out of step, as the load angle of its machines would pass 90 degrees"
    else:
        why = _why_unlike(model, stations)
    if ending == Ending.LOST:
        problem = (
            f"At {time_min:.2f} min no state of the supply was found even without trains; {why}."
        )
    else:
        problem = f"At {time_min:.2f} min the supply has no state even without trains: {why}."
    return {"problem": problem, "advice": _ALIGN if len(stations) > 1 else _UNLOADED}


def _why_unlike(model: Model, stations: Sequence[str]) -> str:
    """Which stations differ most without load; one alone has nothing to carry but charging currents."""
    if len(stations) == 1:
        return f"all that {stations[0]} carries then is the charging current of catenary and cables"
    sources = [model.network.sources[s] for s in range(len(stations))]
    phasors = np.array([cmath.rect(*plain(unloaded)(source)) for source in sources])
    order = np.argsort(-np.abs(phasors - phasors.mean()), kind="stable")
    which = " and ".join(stations[s] for s in order[:2])
    return (
        f"the no-load voltages or angles of the stations are too far apart, most of all of {which}"
    )


def _least_in_step(outcome: Outcome, model: Model, stations: Sequence[str]) -> str:
    """Name of the station whose machines are closest to a load angle of 90 degrees, or beyond."""
    flow, sources = outcome.state.flow, model.network.sources
    nodes, law, running = flow.nodes[sources.node], sources.converter, flow.sources.running
    with np.errstate(all="ignore"):
        reactive_var = (nodes.voltage_v * nodes.leaving_current_a.conj()).imag / running
        own_v = law.no_load_voltage_v - law.droop_v_per_var * reactive_var
        along = (own_v**2 + law.generator_reactance_ohm * reactive_var) / own_v**2
    of_converters = np.isin(sources.kind, (SourceKind.CONVERTER, SourceKind.BOUNDED))
    along[~of_converters | np.isnan(along)] = np.inf
    return stations[int(np.argmin(along))]


def _stall(outcome: Outcome, model: Model, scenario: Scenario, time_min: float) -> dict[str, str]:
    clock = outcome.state.clock[0]
    if clock.stalled_train < 0:
        problem = f"The studied train has not arrived after {time_min:.0f} min."
        advice = "Give simulation.duration_min, or check the traffic."
        if outcome.state.clock[0].unfed > 0:
            problem += " It stands without power, and no outage ends later."
            advice = (
                "Give simulation.duration_min, let the outage end, or leave a station in service."
            )
        return {"problem": problem, "advice": advice}
    train = outcome.state.trains[clock.stalled_train]
    scheduled = outcome.trains[clock.stalled_train]
    motion, demand, kind = train.motion, train.demand, model.types[train.train_type]
    line, place_km = _place(train, model, list(scenario.lines_by_name))
    doing = "cannot start" if motion.speed_m_s <= 0.0 else "slows down and would roll back"
    problem = (
        f"At {time_min:.2f} min {scheduled.name} {doing} at {on_line(line, f'{place_km:.2f} km')}: "
        f"resistance and gradient demand {clock.force_needed_n / 1e3:.1f} kN, its machine and adhesion "
        f"give {clock.force_available_n / 1e3:.1f} kN at {demand.voltage_v / 1e3:.2f} kV and "
        f"{motion.speed_m_s * 3.6:.1f} km/h."
    )
    forces = forces_on(train, kind, float(clock.force_needed_n))
    if forces.current_binds:
        share = 100.0 * forces.given_n / forces.unlimited_n
        problem += (
            f" At this voltage its current limitation passes {share:.0f} % of the wanted force, "
            f"{forces.unlimited_n / 1e3:.1f} kN."
        )
    else:
        problem += what_binds(forces)
    voltages_v = outcome.state.trains["demand"]["voltage_v"][are_on_line(outcome.state)]
    problem += f" The lowest voltage on the line is {voltages_v.min() / 1e3:.2f} kV."
    described = scenario.trains_by_service()[scheduled.service]
    return {"problem": problem, "advice": stall_advice(forces, demand, kind, described, model)}


def _deadlock(
    outcome: Outcome, model: Model, scenario: Scenario, time_min: float
) -> dict[str, str]:
    """Which trains wait for each other, in a circle, and where."""
    holdings, lines = outcome.state.turns.holdings, list(scenario.lines_by_name)
    chain = [int(outcome.state.clock[0].deadlocked_train)]
    while (whom := int(holdings[chain[-1]].waits_for)) not in chain:
        chain.append(whom)
    circle = chain[chain.index(whom) :]
    told = []
    for i, other in zip(circle, [*circle[1:], circle[0]], strict=True):
        line, place_km = _place(outcome.state.trains[i], model, lines)
        here = on_line(line, f"{place_km:.2f} km")
        told.append(f"{outcome.trains[i].name} at {here} for {outcome.trains[other].name}")
    return {
        "problem": f"At {time_min:.2f} min trains wait for each other: {', '.join(told)}.",
        "advice": "Let them cross elsewhere: give stations where they meet more tracks, or change the "
        "times of the trains that come first.",
    }


def warnings(summary: dict[str, Any], but: Collection[str] = ()) -> list[str]:
    """Sentences on what was limited or left its range, but for names that are told otherwise."""
    return [
        f"{_LIMITED[name]}, in {count} train-steps"
        for name, count in summary["limited"].items()
        if count and name in _LIMITED and name not in but
    ]
