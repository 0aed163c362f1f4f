"""Legs of the routes: on which line and track trains are, and which sections are above them."""

import math
from collections.abc import Sequence
from typing import Any

from tpss.model.routes import Route
from tpss.model.supply import SupplyPlan
from tpss.record import Records
from tpss.track.leg import Leg


def build_legs(routes: Sequence[Route], lines: Sequence[str], plan: SupplyPlan) -> Records[Leg]:
    """Legs, one row a route; what is left of a row begins nowhere."""
    most = max(len(route.courses) for route in routes)
    rows: Any = Leg.blank(len(routes), most)
    rows["from_m"] = math.inf
    for i, route in enumerate(routes):
        for k, course in enumerate(route.courses):
            line = lines.index(course.line)
            sections = plan.sections_of_line[line]
            rows[i, k] = (course.from_m, course.sign, course.offset_m, line, 1, *sections)
    legs: Records[Leg] = rows
    return legs
