"""Stations along the routes at which events hold trains."""

import math
from collections.abc import Sequence

import numpy as np

from tpss.model.routes import Route
from tpss.scenario.events import Restart
from tpss.step.halts import Halts, no_halts
from tpss.units import si


def build_halts(events: Sequence[Restart], routes: Sequence[Route]) -> Halts:
    """Times and places of events.

    Parameters
    ----------
    events : sequence of Restart
    routes : sequence of Route
    """
    if not events:
        return no_halts(len(routes))
    rows = [[_places_m(route, event.lines) for route in routes] for event in events]
    most = max(len(places) for row in rows for places in row)
    places_m = np.full((len(events), len(routes), most + 1), math.inf)
    for e, row in enumerate(rows):
        for i, places in enumerate(row):
            places_m[e, i, : len(places)] = places
    times_s = [(si(event, "held_from_min"), si(event, "at_min")) for event in events]
    return Halts(np.array(times_s), places_m)


def _places_m(route: Route, lines: Sequence[str]) -> list[float]:
    """Positions of the stations of a route, of those on some lines only, if these are named. [m]"""
    found = set()
    for number, hop in enumerate(route.way.hops):
        if lines and hop.line not in lines:
            continue
        course = route.course_of(number)
        found |= {course.position_m(1e3 * km) for km in (hop.begin_km, hop.end_km)}
    return sorted(found)
