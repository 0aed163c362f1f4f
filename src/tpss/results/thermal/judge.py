"""The judgement of equipment: its thermal states and loads over windows, against what it bears."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import xarray as xr

from tpss.results.places import line_names
from tpss.results.standards.windows import Floats, highest_means_between, step_values, table_of
from tpss.results.thermal.body import S_PER_MIN
from tpss.results.thermal.cause import Traffic
from tpss.results.thermal.elements import (
    Element,
    Loaded,
    Readings,
    has_ratings,
    rated_elements,
)
from tpss.results.thermal.states import States, states_of
from tpss.scenario.scenario import Scenario

WINDOWS_MIN = (1.0, 5.0, 15.0, 30.0, 60.0, 120.0)
"""Windows of the highest r.m.s. loads. [min]"""

ROUNDING = 1e-9
"""Share of what is allowed by which a figure may exceed it without being over."""

WITHIN, OVER = "within", "over"

OF_THE_RUN, GIVEN = "r.m.s. load of the run", "preload_percent"
"""Where the load before the run comes from."""


class Window(NamedTuple):
    """The highest r.m.s. load of a piece of equipment over a window; NaN where the run is shorter."""

    element: str
    kind: str
    window_min: float
    highest_rms_percent: float
    allowed_rms_percent: float
    """NaN: it is not judged over this window."""
    from_min: float


class Judged(NamedTuple):
    """What a run does to a piece of equipment; NaN where there is no such figure."""

    element: str
    kind: str
    line: str
    position_km: float
    start_load_percent: float
    start: str
    highest_state_percent: float
    allowed_state_percent: float
    state_at_min: float
    highest_temperature_c: float
    allowed_temperature_c: float
    loss_of_life_min: float
    window_min: float
    highest_rms_percent: float
    allowed_rms_percent: float
    from_min: float
    verdict: str
    trains: str


def thermal_of(dataset: xr.Dataset, scenario: Scenario) -> "Thermal":
    """Judgement of the equipment of a run; an empty one if nothing has a rating or no step was made."""
    loaded: list[Loaded] = []
    if has_ratings(scenario) and dataset.sizes["time"] > 1:
        names, services = (dataset[each].to_numpy().tolist() for each in ("train", "service"))
        trains = list(zip(names, services, strict=True))
        loaded = rated_elements(Readings(partial(step_values, dataset), trains), scenario)
    return Thermal.of(loaded, np.asarray(dataset.time.to_numpy(), dtype=float), dataset)


@dataclass(frozen=True, eq=False)
class Thermal:
    """Judgement of the equipment of a run.

    Attributes
    ----------
    elements : sequence of Element
    load : Floats, shape (steps, elements)
        NaN where an element is not there. [1]
    instants_s : Floats, shape (steps + 1,)
        Instants of the run. [s]
    dataset : xarray.Dataset, optional
        Says which trains were where, for `judged` and the tables.
    """

    elements: Sequence[Element]
    load: Floats
    instants_s: Floats
    dataset: xr.Dataset | None = None

    @classmethod
    def of(
        cls, loaded: Sequence[Loaded], instants_s: Floats, dataset: xr.Dataset | None = None
    ) -> "Thermal":
        """Judgement of equipment and its loads."""
        none = np.empty((len(instants_s) - 1, 0))
        load = np.column_stack([each for _, each in loaded]) if loaded else none
        return cls([element for element, _ in loaded], load, instants_s, dataset)

    @cached_property
    def states(self) -> States:
        """Thermal states over the run."""
        return states_of([each.body for each in self.elements], self.load, self.instants_s)

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per piece of equipment."""
        return table_of(self.judged, Judged)

    @cached_property
    def windows(self) -> pd.DataFrame:
        """One row per piece of equipment and window: its highest r.m.s. load."""
        return table_of([window for own in self._windows for window in own], Window)

    @cached_property
    def judged(self) -> list[Judged]:
        """What the run does to each piece of equipment."""
        if not self.elements or self.dataset is None:
            return []
        traffic, lines = Traffic.of(self.dataset), line_names(self.dataset)
        return [self._judge(k, traffic, lines) for k in range(len(self.elements))]

    @cached_property
    def hottest(self) -> list[int]:
        """Indices of the equipment, that which comes closest to what it bears, or beyond it, first."""
        return sorted(range(len(self.elements)), key=lambda k: -self.uses[k])

    @cached_property
    def uses(self) -> list[float]:
        """What each has of what it bears, as a highest state or load: above 1 it is over. [1]"""
        return [
            max(state / each.body.allowed_state, share)
            for state, each, share in zip(
                self.states.highest.tolist(), self.elements, self._shares, strict=True
            )
        ]

    @cached_property
    def _shares(self) -> list[float]:
        """Highest r.m.s. load over the window of an overload of each, over what that allows. [1]

        Only these windows are looked at, which takes less time than all that the tables have.
        """
        shares = [0.0] * len(self.elements)
        by_window: dict[float, list[tuple[int, float]]] = {}
        for k, each in enumerate(self.elements):
            for load, lasts_s in each.body.overloads:
                by_window.setdefault(lasts_s, []).append((k, load))
        for lasts_s, own in by_window.items():
            square = np.nan_to_num(self.load[:, [k for k, _ in own]]) ** 2
            ((highest, _),) = highest_means_between(square, self.instants_s, [lasts_s])
            for (k, load), mean in zip(own, highest.tolist(), strict=True):
                if not math.isnan(mean):
                    shares[k] = max(shares[k], math.sqrt(mean) / load)
        return shares

    @cached_property
    def _windows(self) -> list[list[Window]]:
        """Windows of each piece of equipment, its own overloads' too, in ascending order."""
        if not self.elements:
            return []
        own_min = [
            sorted({*WINDOWS_MIN, *(lasts_s / S_PER_MIN for _, lasts_s in each.body.overloads)})
            for each in self.elements
        ]
        square = np.nan_to_num(self.load) ** 2
        widths = sorted({minutes for own in own_min for minutes in own})
        means = highest_means_between(
            square, self.instants_s, [minutes * S_PER_MIN for minutes in widths]
        )
        found = dict(zip(widths, means, strict=True))
        return [
            [
                Window(
                    each.name,
                    each.kind,
                    minutes,
                    100.0 * math.sqrt(found[minutes][0][k]),
                    100.0 * each.body.allowed_load(minutes * S_PER_MIN),
                    float(found[minutes][1][k]) / S_PER_MIN,
                )
                for minutes in own
            ]
            for k, (each, own) in enumerate(zip(self.elements, own_min, strict=True))
        ]

    def _judge(self, k: int, traffic: Traffic, lines: Sequence[str]) -> Judged:
        element, states, body = self.elements[k], self.states, self.elements[k].body
        state, at_s = float(states.highest[k]), float(states.highest_at_s[k])
        worst = _worst(self._windows[k])
        if _share(worst) > state / body.allowed_state:
            from_s = worst.from_min * S_PER_MIN
            to_s = from_s + worst.window_min * S_PER_MIN
        else:  # what heated it: the load of the last time constant
            to_s = max(at_s, float(self.instants_s[1]))
            from_s = to_s - body.time_constant_s
        return Judged(
            element=element.name,
            kind=element.kind,
            line=lines[element.line] if element.line >= 0 else "",
            position_km=element.position_km,
            start_load_percent=100.0 * float(states.start_load[k]),
            start=OF_THE_RUN if math.isnan(body.preload) else GIVEN,
            highest_state_percent=100.0 * state,
            allowed_state_percent=100.0 * body.allowed_state,
            state_at_min=at_s / S_PER_MIN,
            highest_temperature_c=body.ambient_c + body.rise_k * state,
            allowed_temperature_c=body.ambient_c + body.rise_k * body.allowed_state,
            loss_of_life_min=float(states.aged_s[k]) / S_PER_MIN,
            window_min=worst.window_min,
            highest_rms_percent=worst.highest_rms_percent,
            allowed_rms_percent=worst.allowed_rms_percent,
            from_min=worst.from_min,
            verdict=OVER if self.uses[k] > 1.0 + ROUNDING else WITHIN,
            trains=traffic.cause(element, from_s, to_s),
        )

    def as_dict(self) -> dict[str, Any]:
        """The judgement for a summary, of plain types only; the hottest first."""
        ordered = [self.judged[k] for k in self.hottest]
        return {
            "judged": len(ordered),
            "over": sum(each.verdict == OVER for each in ordered),
            "elements": {each.element: _plain(each) for each in ordered},
        }


def _share(worst: Window) -> float:
    """Highest r.m.s. load over a window, over the one that is allowed; 0 where none is judged. [1]"""
    share = worst.highest_rms_percent / worst.allowed_rms_percent
    return 0.0 if math.isnan(share) else share


def _worst(windows: Sequence[Window]) -> Window:
    """The window in which most of what is allowed is used; without a judged one, one of NaN."""
    worst = max(windows, key=_share)
    if _share(worst) > 0.0:
        return worst
    return Window(worst.element, worst.kind, math.nan, math.nan, math.nan, math.nan)


def _plain(judged: Judged) -> dict[str, Any]:
    """Figures of a piece of equipment, without those that it has not, or that are infinite."""
    figures = {key: value for key, value in judged._asdict().items() if key != "element"}
    return {
        key: value
        for key, value in figures.items()
        if value != "" and (isinstance(value, str) or math.isfinite(value))
    }
