"""Assemble the model of a scenario from its parts."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tpss.driving.data import SLOPE_CHANGE, Braking, Driver, MotionModel, Options, Stop
from tpss.kernel import switch
from tpss.model.feed_back import demand_room_to_feed_back
from tpss.model.gates import build_gates, no_gates
from tpss.model.halts import build_halts
from tpss.model.held_limits import without_coasting
from tpss.model.legs import build_legs
from tpss.model.neutral import build_neutral
from tpss.model.outages import layout_of, service_of
from tpss.model.phases import demand_one_angle
from tpss.model.profiles import build_profiles, rows_seen
from tpss.model.routes import Route, routes_of, running_trains
from tpss.model.stores import demand_thresholds_in_order
from tpss.model.supply_plan import SupplyPlan
from tpss.model.trains import build_train_types
from tpss.physics.adhesion import Rail
from tpss.record import Records
from tpss.scenario.scenario import Scenario
from tpss.scenario.standards import limits_of_system
from tpss.step.model import Model, RunControl
from tpss.step.separation import Separation, Signalling
from tpss.step.turns import Gates
from tpss.track.gate import Precedence
from tpss.track.leg import Leg
from tpss.units import si

STEP_ROUNDING = 1e-9
"""A dwell or a duration that exceeds whole steps by less than this share of a step ends with them."""


@dataclass(frozen=True)
class Layout:
    """Names and places of what the arrays of a model hold."""

    supply: SupplyPlan
    stations: tuple[str, ...]
    station_m: tuple[float, ...]
    station_line: tuple[int, ...]
    """Index of the line of each."""
    lines: tuple[str, ...]
    routes: tuple[Route, ...]
    legs: Records[Leg]
    most_tracks: int
    """Number of tracks where a line has most."""
    stores: tuple[str, ...] = ()
    """Stores of energy at the line."""
    store_m: tuple[float, ...] = ()
    store_line: tuple[int, ...] = ()
    """Index of the line of each."""


def build_model(scenario: Scenario) -> tuple[Model, Layout]:
    """Model of a scenario in SI units, coupled and without a studied train, and its layout."""
    demand_room_to_feed_back(scenario)
    demand_thresholds_in_order(scenario)
    lines = scenario.lines_by_name
    plan = layout_of(scenario, scenario.outage).plan
    demand_one_angle(scenario, plan)
    routes = routes_of(scenario)
    running = running_trains(scenario, routes)
    types, points = build_train_types(running, limits_of_system(scenario.supply.system))
    gradients, limits = build_profiles(lines, rows_seen(running))
    model = Model(
        options=_options(scenario),
        control=RunControl(),
        gradients=gradients,
        limits=limits,
        neutral=build_neutral(scenario, rows_seen(running)),
        coasting=without_coasting(len(rows_seen(running))),
        stops=_stops(scenario, routes, si(scenario.simulation, "time_step_min")),
        types=types,
        points=points,
        network=service_of(scenario).network,
        legs=build_legs(routes, lines, plan.runs),
        signalling=_signalling(scenario),
        rules=_rules(scenario, routes),
        halts=build_halts(scenario.events, routes),
    )
    return model, Layout(
        supply=plan,
        stations=tuple(station.name for station in scenario.supply.stations),
        station_m=tuple(si(s, "position_km") for s in scenario.supply.stations),
        station_line=tuple(
            list(lines).index(scenario.line_of(s)) for s in scenario.supply.stations
        ),
        lines=tuple(lines),
        routes=tuple(routes),
        legs=model.legs,
        most_tracks=max(line.most_tracks for line in lines.values()),
        stores=tuple(store.name for store in scenario.supply.storage),
        store_m=tuple(si(store, "position_km") for store in scenario.supply.storage),
        store_line=tuple(list(lines).index(scenario.line_of(s)) for s in scenario.supply.storage),
    )


def at_step(model: Model, scenario: Scenario, step_s: float) -> Model:
    """The model of a scenario with another time step, on which nothing else in it depends."""
    options = model.options._replace(step_s=step_s)
    return model._replace(options=options, stops=_stops(scenario, routes_of(scenario), step_s))


def steps_of(duration_s: float, step_s: float) -> int:
    """Steps that a duration takes, a begun one counted whole."""
    return int(np.ceil(duration_s / step_s - STEP_ROUNDING))


def _options(scenario: Scenario) -> Options:
    simulation = scenario.simulation
    return Options(
        step_s=si(simulation, "time_step_min"),
        mean_power=simulation.power_sampling == "mean",
        mean_gradient=simulation.gradient_sampling == "mean",
        adhesion_in_km_h=simulation.adhesion_speed_unit == "km/h",
        rail=switch(Rail[_member(simulation.rail)]),
        driver=switch(Driver[_member(simulation.driver)]),
        braking=switch(Braking[_member(simulation.braking)]),
        motion=switch(MotionModel[_member(simulation.how_trains_move)]),
        slope_change=SLOPE_CHANGE,
    )


def _rules(scenario: Scenario, routes: Sequence[Route]) -> Gates:
    """Gates of the routes, if trains wait for others to pass."""
    signalling = scenario.signalling
    if not signalling.has_gates:
        return no_gates(len(routes))
    return build_gates(routes, scenario.lines_by_name, signalling.margin_m)


def _signalling(scenario: Scenario) -> Signalling:
    given = scenario.signalling
    return Signalling(
        separation=switch(Separation[_member(given.separation)]),
        precedence=switch(Precedence[_member(given.single_track)]),
        reaction_s=given.reaction_s,
        margin_m=given.margin_m,
        block_m=given.block_m or 0.0,
    )


def _member(choice: str) -> str:
    """Name of the member of an enum that a choice of the scenario stands for."""
    return choice.upper().replace("-", "_")


def _stops(scenario: Scenario, routes: Sequence[Route], step_s: float) -> Records[Stop]:
    """Stops, one row a traffic entry, the destination last."""
    most = max(len(entry.stops) for entry in scenario.traffic) + 1
    rows: Any = Stop.blank(len(scenario.traffic), most)
    for i, (entry, route) in enumerate(zip(scenario.traffic, routes, strict=True)):
        for k, (stop, position_m) in enumerate(zip(entry.stops, route.stops_m, strict=False)):
            dwell_s = 60.0 * max(stop.dwell_min, stop.turn_min or 0.0)
            leaves_s = 60.0 * (stop.depart_after_min or 0.0)
            rows[i, k] = (position_m, steps_of(dwell_s, step_s), dwell_s, leaves_s, False)
        rows[i, len(entry.stops) :] = (route.stops_m[-1], 0, 0.0, 0.0, True)
    stops: Records[Stop] = rows
    return stops
