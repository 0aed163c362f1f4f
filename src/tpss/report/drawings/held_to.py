"""The speed that a train is held to along its journey."""

import numpy as np
import xarray as xr

from tpss.model.profiles import build_profiles, row_seen
from tpss.model.routes import Running, routes_of
from tpss.report.drawings.parts import DASHED, Curve
from tpss.report.palette import BLACK
from tpss.report.sampling import Floats
from tpss.results.result import Result
from tpss.units import si


def speed_limit(result: Result, data: xr.Dataset, x: Floats) -> Curve:
    """Limits as a train meets them, and its own highest speed, over the axis of its journey. [km/h]

    Parameters
    ----------
    result : Result
    data : xarray.Dataset
        What is recorded of the train.
    x : array
        Where each instant lies on the horizontal axis; a change of limit lies in between.
    """
    scenario, service = result.scenario, str(data.service.values)
    train = scenario.trains_by_service()[service]
    route = routes_of(scenario)[[entry.name for entry in scenario.traffic].index(service)]
    seen = row_seen(Running(train, route.courses))
    _, limits = build_profiles(scenario.lines_by_name, [seen])
    from_m, limit_m_s = limits.from_m[0], limits.value[0]
    along_m = data.route_position.to_numpy()
    there = np.isfinite(along_m) & np.isfinite(x) & np.isfinite(data.speed.to_numpy())
    along_m, x = along_m[there], x[there]
    changes_m = from_m[(from_m > along_m[0]) & (from_m < along_m[-1])]
    places_m = np.concatenate([along_m[:1], changes_m, along_m[-1:]])
    holding = np.maximum(np.searchsorted(from_m, places_m, side="right") - 1, 0)
    held_m_s = np.minimum(limit_m_s[holding], si(train, "max_speed_kmh"))
    places = np.interp(places_m, along_m, x)
    return Curve(places, 3.6 * held_m_s, colour=BLACK, dash=DASHED, width=0.7, held=True)
