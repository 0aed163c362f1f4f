"""Assemble the model of a scenario from its parts."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from tpss.driving.data import Braking, Driver, MotionModel, Options, Stop
from tpss.kernel import switch
from tpss.model.directions import running_trains, runs_down
from tpss.model.profiles import build_profiles, rows_seen
from tpss.model.supply import SupplyPlan, build_supply
from tpss.model.trains import build_train_types
from tpss.physics.adhesion import Rail
from tpss.record import Records
from tpss.scenario.scenario import Scenario
from tpss.step.model import Model, RunControl
from tpss.units import si

STEP_ROUNDING = 1e-9
"""A dwell or a duration that exceeds whole steps by less than this share of a step ends with them."""


@dataclass(frozen=True)
class Layout:
    """Names and places of what the arrays of a model hold."""

    supply: SupplyPlan
    stations: tuple[str, ...]
    station_m: tuple[float, ...]


def build_model(scenario: Scenario) -> tuple[Model, Layout]:
    """Model of a scenario in SI units, coupled and without a studied train, and its layout."""
    network, plan = build_supply(scenario.supply, scenario.line.begins_at_km, scenario.line.end_km)
    running = running_trains(scenario)
    types, points = build_train_types(running)
    gradients, limits = build_profiles(scenario.line, rows_seen(running))
    model = Model(
        options=_options(scenario),
        control=RunControl(),
        gradients=gradients,
        limits=limits,
        stops=_stops(scenario, si(scenario.simulation, "time_step_min")),
        types=types,
        points=points,
        network=network,
    )
    return model, Layout(
        supply=plan,
        stations=tuple(station.name for station in scenario.supply.stations),
        station_m=tuple(si(s, "position_km") for s in scenario.supply.stations),
    )


def at_step(model: Model, scenario: Scenario, step_s: float) -> Model:
    """The model of a scenario with another time step, on which nothing else in it depends."""
    options = model.options._replace(step_s=step_s)
    return model._replace(options=options, stops=_stops(scenario, step_s))


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
    )


def _member(choice: str) -> str:
    """Name of the member of an enum that a choice of the scenario stands for."""
    return choice.upper().replace("-", "_")


def _stops(scenario: Scenario, step_s: float) -> Records[Stop]:
    """Stops, one row a traffic entry, the destination last."""
    line = scenario.line
    most = max(len(entry.stops) for entry in scenario.traffic) + 1
    rows: Any = Stop.blank(len(scenario.traffic), most)
    for route, entry in enumerate(scenario.traffic):
        seen = line.mirrored() if runs_down(entry, line) else line
        position_m = {station.name: si(station, "position_km") for station in seen.stations}
        for k, stop in enumerate(entry.stops):
            dwell_s, steps = si(stop, "dwell_min"), steps_of(si(stop, "dwell_min"), step_s)
            leaves_s = 60.0 * (stop.depart_after_min or 0.0)
            rows[route, k] = (position_m[stop.station], steps, dwell_s, leaves_s, False)
        rows[route, len(entry.stops) :] = (position_m[entry.destination], 0, 0.0, 0.0, True)
    stops: Records[Stop] = rows
    return stops
