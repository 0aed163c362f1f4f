"""Random ratings of all that gets hot, and the judgement of it, once more: in plain loops."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import strategies as st

from tpss import Result
from tpss.results.thermal.elements import Element

from .ranges import numbers
from .types import converter_types, own_table

Draw = Any
Document = dict[str, Any]

PRELOADS = st.sampled_from([None, 0.0, 50.0, 120.0])


@st.composite
def overloads(draw: Draw, least: int = 0) -> list[Document]:
    """Allowed overloads, the lowest and longest first."""
    percents = draw(st.lists(numbers(101.0, 250.0), min_size=least, max_size=3, unique=True))
    minutes = draw(
        st.lists(numbers(0.02, 60.0), min_size=len(percents), max_size=len(percents), unique=True)
    )
    pairs = zip(sorted(percents), sorted(minutes, reverse=True), strict=True)
    return [{"percent": percent, "minutes": lasts} for percent, lasts in pairs]


@st.composite
def by_time_constant(draw: Draw, least: int = 0) -> Document:
    """A rating of one time constant."""
    rating = {"time_constant_min": draw(numbers(0.2, 90.0)), "overloads": draw(overloads(least))}
    preload = draw(PRELOADS)
    return rating if preload is None else {**rating, "preload_percent": preload}


@st.composite
def of_transformers(draw: Draw, least: int = 0) -> Document:
    """A rating by cooling, or by a time constant."""
    if draw(st.booleans()):
        return draw(by_time_constant(least))
    return {
        "cooling": draw(st.sampled_from(["ONAN", "ONAF"])),
        "ambient_c": draw(numbers(-30.0, 40.0)),
        "overloads": draw(overloads(least)),
    }


@st.composite
def of_wires(draw: Draw, least: int = 0) -> Document:
    """A rating of a contact line, with or without temperatures."""
    warms = (
        {} if draw(st.booleans()) else {"reference_c": 80.0, "ambient_c": draw(numbers(-20, 70))}
    )
    return {"continuous_a": draw(numbers(20.0, 800.0)), **draw(by_time_constant(least)), **warms}


MOTORS = st.builds(
    lambda amperes, more, minutes: {
        "continuous_a": amperes, "short_time_a": more * amperes, "short_time_min": minutes,
    },
    numbers(200.0, 2000.0), numbers(1.05, 3.0), numbers(0.5, 30.0),
)  # fmt: skip


def with_ratings(draw: Draw, document: Document, least: int = 0) -> None:
    """Give equipment of every kind a rating, or none; converters and transformers some overloads."""
    supply = document["supply"]
    if draw(st.booleans()):
        own_table(supply, "catenary", "catenaries")["rating"] = draw(of_wires(least))
    for kind in converter_types(document):
        if draw(st.booleans()):
            kind["rating"] = draw(by_time_constant(least))
    for station in supply.get("transformer_stations", ()):
        if draw(st.booleans()):
            station["transformer"]["rating"] = draw(of_transformers(least))
    high_voltage = supply.get("high_voltage_line")
    for key, name in (("line_transformer", "16MVA"), ("station_transformer", "25MVA")):
        if high_voltage is not None and draw(st.booleans()):
            high_voltage.setdefault(key, name)
            rating = {"rating_mva": draw(numbers(0.5, 25.0)), **draw(of_transformers(least))}
            own_table(high_voltage, key, "transformers")["rating"] = rating
    for train in document["trains"].values():
        knows_its_motors = "model" in train or "max_motor_voltage_v" in train
        if knows_its_motors and "regeneration" not in train and draw(st.booleans()):
            train["motor_rating"] = draw(MOTORS)
            if train.get("motor_voltage", "new") == "new" and draw(st.booleans()):
                warm = draw(st.sampled_from([0.0, 70.0, 100.0]))
                train["motor_rating"] |= {"spared": True, "preload_percent": warm}


def judge_ratings(result: Result) -> None:
    """Highest states and highest loads over windows of all equipment, step after step."""
    judgement = result.equipment
    if not len(judgement.elements):
        return
    instants_s = result.dataset.time.to_numpy()
    windows = result.thermal_windows.groupby("element")
    for k, (element, row) in enumerate(
        zip(judgement.elements, result.thermal.itertuples(), strict=True)
    ):
        load = judgement.load[:, k]
        if element.body.cooling is None:
            judge_state(element, row, load, instants_s)
        if element.train >= 0 and _spares_its_motors(result, element.train):
            assert row.verdict == "within", f"{element.name} are spared, and too hot"
        for window in windows.get_group(element.name).itertuples():
            judge_window(element.name, window, np.nan_to_num(load), instants_s)


def _spares_its_motors(result: Result, train: int) -> bool:
    """Whether the driver of a train keeps its motors from getting too hot."""
    service = str(result.dataset.service.to_numpy()[train])
    rating = result.scenario.trains_by_service()[service].motor_rating
    return rating is not None and rating.spared


def judge_state(element: Element, row: Any, load: Any, instants_s: Any) -> None:
    """A state that follows the square of the load, from that of the r.m.s. load or a given one."""
    there = np.isfinite(load)
    lasts_s, body = np.diff(instants_s), element.body
    start = body.preload
    if math.isnan(start):
        total = sum(s * k * k for s, k in zip(lasts_s[there], load[there], strict=True))
        start = math.sqrt(total / lasts_s[there].sum())
    state = highest = start**2
    first = int(np.argmax(there))
    last = len(load) - int(np.argmax(there[::-1]))
    for length_s, k in zip(lasts_s[first:last], np.nan_to_num(load)[first:last], strict=True):
        state = k * k + (state - k * k) * math.exp(-length_s / body.time_constant_s)
        highest = max(highest, state)
    assert row.highest_state_percent == pytest.approx(100.0 * highest, rel=1e-6, abs=1e-6), (
        f"thermal state of {element.name}"
    )


def judge_window(name: str, window: Any, load: Any, instants_s: Any) -> None:
    """A highest r.m.s. load is that over its window, and that of no window from an instant is higher."""
    width_s, begin_s = 60.0 * window.window_min, instants_s[0]
    if instants_s[-1] - begin_s < width_s * (1.0 - 1e-6):
        assert math.isnan(window.highest_rms_percent)
        return
    if math.isnan(window.highest_rms_percent):  # as long as the run, to the rounding of the clock
        assert abs(instants_s[-1] - begin_s - width_s) < 1e-6 * width_s
        return

    def rms_percent(from_s: float) -> float:
        within_s = np.diff(np.clip(instants_s, from_s, from_s + width_s))
        return 100.0 * math.sqrt(float(load**2 @ within_s) / width_s)

    found = window.highest_rms_percent
    assert rms_percent(60.0 * window.from_min) == pytest.approx(found, rel=1e-6, abs=1e-4), name
    last_s = instants_s[-1] - width_s
    for from_s in [*instants_s[instants_s <= last_s], last_s]:
        assert rms_percent(from_s) <= found * (1.0 + 1e-6) + 1e-4, f"{name} from {from_s} s"
