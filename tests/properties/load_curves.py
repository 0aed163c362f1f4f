"""Random efficiencies over load: flat ones, ones that fall towards low loads, and uneven ones."""

from random import Random
from typing import Any

from tpss.vehicle.part_load import MOST_LOADS, falls_with_power

Document = dict[str, Any]


def _curve(draw: Random) -> Document:
    """A curve that no fault is found in: values are brought together until it is none."""
    loads = sorted({round(draw.uniform(0.5, 99.0), 1) for _ in range(draw.randint(1, 6))})
    loads = [*loads, draw.choice([100.0, 100.0, 130.0])][-MOST_LOADS:]
    values = [draw.uniform(0.2, 1.0) for _ in loads]
    if draw.random() < 0.5:
        values.sort()
    while any(falls_with_power(loads, values, sign) is not None for sign in (1.0, -1.0)):
        values = [0.5 * (value + values[-1]) for value in values]
    return {"load_percent": loads, "value": values}


def give_curves_over_load(draw: Random, document: Document) -> None:
    """Let the efficiency of some trains follow their load, by brakes of their own or not."""
    for train in document["trains"].values():
        if draw.random() < 0.67:
            continue
        train["efficiency_over_load"] = _curve(draw)
        effort = train.get("tractive_effort", {})
        if "max_power_kw" not in effort or draw.random() < 0.3:
            train["efficiency_over_load"]["rated_power_kw"] = draw.uniform(300.0, 8000.0)
        if "regeneration" in train and draw.random() < 0.5:
            train["regeneration"]["efficiency_over_load"] = _curve(draw)
