"""Faults between the conductors of a line, each named with its remedy."""

import math
from collections.abc import Iterator
from itertools import combinations

from tpss.conductors.geometry import Conductor, Geometry
from tpss.errors import Finding

_Fault = tuple[str, str, str, str]
"""Key path, value, problem and remedy."""


def geometry_faults(geometry: Geometry, source: str) -> list[Finding]:
    """Faults of a geometry that no conductor has alone."""
    each = (_of_groups, _of_heights, _of_places)
    return [Finding(source, *found) for faults in each for found in faults(geometry)]


def _of_groups(geometry: Geometry) -> Iterator[_Fault]:
    if not geometry.tracks:
        problem = "no conductor is of the group contact"
        yield "conductors", "", problem, 'write group = "contact" at the contact wire'
        return
    for i, each in enumerate(geometry.conductors):
        if each.group not in ("contact", "earth") and each.track not in geometry.tracks:
            problem = f"{each.name} belongs to a track without a contact line"
            known = ", ".join(map(str, geometry.tracks))
            remedy = f"tracks with one: {known}; or add a conductor of the group contact"
            yield f"conductors.{i}.track", str(each.track), problem, remedy


def _of_heights(geometry: Geometry) -> Iterator[_Fault]:
    for i, each in enumerate(geometry.conductors):
        lowest_m, radius_m = each.height_m - each.sag_m, each.wire.radius_mm / 1e3
        if lowest_m <= radius_m:
            place = "below ground" if lowest_m <= 0.0 else "in the ground"
            sagging = f", and sags by {each.sag_m:g} m" if each.sag_m else ""
            problem = f"{each.name} lies {place}: it has a radius of {radius_m:g} m{sagging}"
            remedy = "give the height of its middle above ground, of rails that above the formation"
            yield f"conductors.{i}.height_m", f"{each.height_m:g}", problem, remedy


def _of_places(geometry: Geometry) -> Iterator[_Fault]:
    for (i, one), (j, other) in combinations(enumerate(geometry.conductors), 2):
        apart_m = _distance(one, other)
        radii_m = (one.wire.radius_mm + other.wire.radius_mm) / 1e3
        if apart_m == 0.0:
            problem = f"{one.name} and {other.name} are at one place"
        elif apart_m < radii_m:
            problem = (
                f"{one.name} and {other.name} are {apart_m:g} m apart, less than both radii, "
                f"{radii_m:g} m"
            )
        else:
            continue
        remedy = f"move one of them (conductors.{i} or conductors.{j}), or correct radius_mm"
        yield f"conductors.{j}.x_m", f"{other.x_m:g}", problem, remedy


def _distance(one: Conductor, other: Conductor) -> float:
    """Distance of two conductors at their mean heights. [m]"""
    return math.hypot(one.x_m - other.x_m, one.mean_height_m - other.mean_height_m)
