"""Ways of GTFS trips along their shapes, where a feed gives no distances at stops.

References
----------
https://gtfs.org/documentation/schedule/reference: ``shapes.txt``, the course of a trip from point to
point.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tpss.importers.gtfs_feed import Feed
from tpss.importers.gtfs_stations import EARTH_KM, Place
from tpss.importers.gtfs_trips import Trip

FARTHEST_KM = 0.5
"""A stop that is farther from the shape of its trip is not on it. [km]"""

Floats = npt.NDArray[np.float64]


def with_shape_distances(
    feed: Feed, trips: Sequence[Trip], places: Mapping[str, Place]
) -> list[Trip]:
    """Trips with distances along their shapes at all stops [km], where they have none but a shape.

    Parameters
    ----------
    feed : Feed
    trips : sequence of Trip
    places : mapping
        Coordinates of the stops.

    Raises
    ------
    ScenarioError
        Points of shapes have faults.
    """
    lacking = {trip.shape for trip in trips if _lacks_distances(trip)} - {""}
    shapes = _shapes(feed, lacking) if lacking else {}
    known: dict[tuple[str, tuple[str, ...]], list[float] | None] = {}
    found = []
    for trip in trips:
        stops = tuple(each.stop for each in trip.stops)
        if trip.shape in shapes and _lacks_distances(trip):
            key = (trip.shape, stops)
            if key not in known:
                known[key] = along_km(shapes[trip.shape], [places[stop] for stop in stops])
            distances = known[key]
            if distances is not None:
                pairs = zip(trip.stops, distances, strict=True)
                trip = replace(trip, stops=[replace(each, distance=km) for each, km in pairs])
        found.append(trip)
    return found


def _lacks_distances(trip: Trip) -> bool:
    return bool(trip.stops) and all(each.distance is None for each in trip.stops)


def _shapes(feed: Feed, wanted: Iterable[str]) -> dict[str, Floats]:
    """Latitudes and longitudes of the points of shapes, in order. [deg]"""
    points: dict[str, list[tuple[float, float, float]]] = defaultdict(list)
    columns = ("shape_id", "shape_pt_lat", "shape_pt_lon", "shape_pt_sequence")
    for row in feed.optional_rows("shapes.txt", *columns):
        if row["shape_id"] in wanted:
            order = row.number("shape_pt_sequence")
            place = (row.number("shape_pt_lat"), row.number("shape_pt_lon"))
            points[row["shape_id"]].append((order, *place))
    return {ident: np.array(sorted(rows))[:, 1:] for ident, rows in points.items() if len(rows) > 1}


def along_km(points: Floats, stops: Sequence[Place]) -> list[float] | None:
    """Distances of stops along a shape, each beyond the one before; None if one is not on it. [km]

    Parameters
    ----------
    points : array (points, 2)
        Latitudes and longitudes.
    stops : sequence of Place
        In the order of travel.
    """
    across = np.cos(np.radians(points[:, 0].mean()))
    scale_km = EARTH_KM * np.pi / 180.0 * np.array([1.0, across])
    plane = points * scale_km
    sides = np.diff(plane, axis=0)
    lengths_km = np.hypot(*sides.T)
    begins_km = np.concatenate([[0.0], np.cumsum(lengths_km)[:-1]])
    squares = np.where(lengths_km > 0.0, lengths_km**2, 1.0)
    distances: list[float] = []
    last_km = 0.0
    for stop in stops:
        to_stop = np.array(stop) * scale_km - plane[:-1]
        shares = np.clip((to_stop * sides).sum(axis=1) / squares, 0.0, 1.0)
        at_km = begins_km + shares * lengths_km
        offsets_km = np.hypot(*(to_stop - shares[:, None] * sides).T)
        offsets_km[at_km < last_km] = np.inf
        nearest = int(np.argmin(offsets_km))
        if offsets_km[nearest] > FARTHEST_KM:
            return None
        last_km = float(at_km[nearest])
        distances.append(last_km)
    return distances
