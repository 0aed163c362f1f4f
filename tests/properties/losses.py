"""Random losses of converters, by coefficients and curves, and what stations take, once more."""

import math
from typing import Any

from hypothesis import strategies as st

from tpss import Result

from .ranges import numbers
from .types import converter_types

Draw = Any
Document = dict[str, Any]

COEFFICIENTS = st.fixed_dictionaries(
    {"idle_kw": numbers(0.0, 500.0)},
    optional={
        "linear_percent": numbers(0.0, 5.0),
        "quadratic_percent": numbers(0.0, 10.0),
        "feedback_quadratic_percent": numbers(0.0, 10.0),
        "origin": st.sampled_from(["estimate", "measurement"]),
    },
)


@st.composite
def curves(draw: Draw) -> Document:
    """A measured curve, from no load on, that may end below the loads of a run."""
    loads = draw(st.lists(numbers(1.0, 300.0), min_size=1, max_size=4, unique=True))
    losses = draw(st.lists(numbers(0.0, 900.0), min_size=len(loads) + 1, max_size=len(loads) + 1))
    points = zip([0.0, *sorted(loads)], sorted(losses), strict=True)
    return {"curve": [{"load_percent": load, "loss_kw": kw} for load, kw in points]}


def with_losses(draw: Draw, document: Document) -> None:
    """Let some types of converters lose something, and some stations have auxiliaries."""
    for kind in converter_types(document):
        if draw(st.booleans()):
            kind["losses"] = draw(st.one_of(COEFFICIENTS, curves()))
    supply = document["supply"]
    for station in (*supply.get("converter_stations", ()), *supply.get("mixed_stations", ())):
        if draw(st.booleans()):
            station["station_kw"] = draw(numbers(0.0, 200.0))


def judge_losses(result: Result) -> None:
    """Energy from the grid, found step by step from what was recorded, of stations of one type."""
    data, table = result.dataset, result.converter_losses.set_index("station")
    hours = (data.time.diff("time").to_numpy() / 3600.0).tolist()
    recorded = [
        data[name].to_numpy()
        for name in ("station_active_power", "station_reactive_power", "active_converters")
    ]
    for s, station in enumerate(result.scenario.supply.converter_stations):
        losses = station.type.losses
        described = losses is not None or station.station_kw is not None
        assert (station.name in table.index) == described
        if not described:
            continue
        taken_mwh = lost_mwh = 0.0
        for k, length_h in enumerate(hours):
            active, reactive, running = (float(values[k, s]) for values in recorded)
            lost_mw = 0.0
            if running > 0.0:
                apparent_mva = math.hypot(active, reactive) / 1e6 / running
                lost_mw = running * _of_one_mw(station.type, apparent_mva, active < 0.0)
                lost_mw += (station.station_kw or 0.0) / 1e3
            taken_mwh += length_h * (active / 1e6 + lost_mw)
            lost_mwh += length_h * lost_mw
        row = table.loc[station.name]
        close_mwh = 1e-9 * (abs(taken_mwh) + lost_mwh) + 1e-9
        balance_mwh = row.from_grid_mwh - row.to_grid_mwh - row.burnt_mwh
        assert abs(row.losses_mwh - lost_mwh) < close_mwh, f"losses of {station.name}"
        assert abs(balance_mwh - taken_mwh) < close_mwh, f"what {station.name} takes"


def _of_one_mw(kind: Any, apparent_mva: float, feeds_back: bool) -> float:
    """Losses of one converter at an apparent power. [MW]"""
    losses = kind.losses
    if losses is None:
        return 0.0
    share = apparent_mva / kind.rating_mva
    if losses.curve is None:
        percent = losses.quadratic_percent or 0.0
        if feeds_back and losses.feedback_quadratic_percent is not None:
            percent = losses.feedback_quadratic_percent
        of_load = (losses.linear_percent or 0.0) * share + percent * share**2
        return (losses.idle_kw or 0.0) / 1e3 + kind.rating_mva * of_load / 100.0
    points = [(point.load_percent / 100.0, point.loss_kw / 1e3) for point in losses.curve]
    pieces = list(zip(points, points[1:], strict=False))
    (x0, y0), (x1, y1) = next((piece for piece in pieces if share < piece[1][0]), pieces[-1])
    return y0 + (y1 - y0) / (x1 - x0) * (share - x0)
