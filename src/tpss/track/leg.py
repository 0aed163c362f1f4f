"""Legs: the stretches of a route on one track of one line, which say where on it a train is.

A train's position is a coordinate along its own route, which grows as it goes, so that drivers and
brakes know one direction and one line.  On a leg the place on the line, its kilometre in metres, is

.. math:: p = \\sigma x + x_0,

with the sign σ of the direction and an offset.  The first leg has no offset: on a route of one leg the
position is the place, or minus it.
"""

import math
from typing import Any

from tpss.kernel import at, fused, inlined, plain
from tpss.record import Record, Records


class Leg(Record):
    """A stretch of a route on one track of one line."""

    from_m: float
    """Position along the route at which it begins; infinite: there is none. [m]"""
    sign: float
    """1.0 towards rising kilometres, -1.0 towards falling ones."""
    offset_m: float
    """Place on the line where the position is 0. [m]"""
    line: int
    """Index of the line."""
    track: int
    """Number of the track, counted from 1."""
    first_section: int
    """Bounds of the sections of contact line above it."""
    end_section: int


def along_one_line(sections: int) -> Records[Leg]:
    """The leg of a route along a line of so many sections, towards rising kilometres."""
    legs: Any = Leg.array([(-math.inf, 1.0, 0.0, 0, 1, 0, sections)]).reshape(1, 1)
    one: Records[Leg] = legs
    return one


@inlined
def leg_at(position_m: float, near: int, route: int, legs: Records[Leg]) -> int:
    """Leg of a route at a position; where one ends, the next one has begun.

    Parameters
    ----------
    position_m : float
        Position along the route. [m]
    near : int
        Leg from which to search, none beyond it.
    route : int
        Index of the route.
    legs : records of Leg
        Shape (routes, most legs).
    """
    while near + 1 < legs.shape[1] and position_m >= legs[at(route), at(near + 1)].from_m:
        near += 1
    return near


def leg_of(position_m: float, route: int, legs: Records[Leg]) -> Leg:
    """Leg of a route at a position, for the host. [m]"""
    return legs[route, plain(leg_at)(position_m, 0, route, legs)]


@fused
def place_on_line(position_m: float, leg: Leg) -> float:
    """Place on the line, that of its kilometre posts, at a position along a route. [m]"""
    return leg.sign * position_m + leg.offset_m
