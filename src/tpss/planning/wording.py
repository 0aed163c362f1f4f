"""States of traffic, components of costs and varied numbers of a plan, in short words for figures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tpss import units
from tpss.planning.served import NO_TRAFFIC
from tpss.planning.states import State
from tpss.planning.tables import INVESTMENT
from tpss.planning.yearly_use import ENERGY, FED_BACK, FIXED, LATE, LOST, NOT_RUN

MOST_KEYS = 3
"""Values by which states of traffic are told apart in words; with more of them they are numbered."""

LONGEST = 32
"""Letters of a value that are shown."""

COMPONENTS = {
    ENERGY: "energy",
    FED_BACK: "energy fed back",
    LOST: "minutes lost to the voltage",
    LATE: "minutes late",
    NOT_RUN: "trains not run",
    FIXED: "fixed costs",
    INVESTMENT: "building and renewals",
}
"""Components of costs, and their words; behind some stands the type of train."""


@dataclass(frozen=True)
class Traffic:
    """States of traffic in words."""

    axis: str
    """What tells them apart, with its unit in brackets where there is one."""
    short: Mapping[str, str]
    """By their names: below that heading."""
    full: Mapping[str, str]
    """By their names: where they stand alone."""
    numbered: bool
    """Whether they have numbers, which must be explained."""


def traffic_in_words(states: Mapping[str, State]) -> Traffic:
    """Words for states of traffic; those in which all are alike are left out.

    Parameters
    ----------
    states : mapping of str to State
        By their names.
    """
    paths = list(dict.fromkeys(path for state in states.values() for path in state.values))
    differing = [
        path for path in paths if len({str(s.values.get(path)) for s in states.values()}) > 1
    ]
    told = differing or paths
    nothing = {NO_TRAFFIC: NO_TRAFFIC}
    if len(told) > MOST_KEYS:
        numbered = {name: f"traffic {k}" for k, name in enumerate(states, 1)} | nothing
        return Traffic("traffic", numbered, numbered, numbered=True)
    full = {name: _in_words(state, told) or name for name, state in states.items()} | nothing
    if len(told) != 1:
        short = {name: words.replace(", ", "\n") for name, words in full.items()}
        return Traffic("traffic", short, full, numbered=False)
    path = told[0]
    short = {name: _value(state.values.get(path)) for name, state in states.items()} | nothing
    return Traffic(_axis(path), short, full, numbered=False)


def mean_in_words(
    rows: Sequence[Mapping[str, Any]], traffic: Mapping[str, Mapping[str, State]]
) -> str:
    """What the mean future of a plan is; empty if there is none.

    Parameters
    ----------
    rows : sequence of mappings
        Traffic by area and stage, as `tpss.planning.tables.mean_future` has it.
    traffic : mapping
        States by area and name.
    """
    if not rows:
        return ""
    parts = []
    for area, states in traffic.items():
        words = traffic_in_words(states).full
        own = ", ".join(
            f"{words[str(row['traffic'])]} in {row['stage']}" for row in rows if row["area"] == area
        )
        parts.append(f"{area}: {own}" if len(traffic) > 1 else own)
    return (
        "The mean future has the mean prices of each stage, and of the traffic of the plan the one "
        f"with the number of trains nearest to the mean: {'; '.join(parts)}."
    )


def in_order(states: Mapping[str, State]) -> list[str]:
    """Names of states, the least traffic first where one number tells that."""
    paths = {path for state in states.values() for path in state.values}
    values = [next(iter(state.values.values()), None) for state in states.values()]
    if len(paths) != 1 or not all(isinstance(value, int | float) for value in values):
        return list(states)
    falls = units.suffix(next(iter(paths)).split(".")[-1]) == "_min"
    return sorted(states, key=lambda name: next(iter(states[name].values.values())), reverse=falls)


def _in_words(state: State, paths: list[str]) -> str:
    places = {_place(path) for path in paths}
    parts = []
    for path in paths:
        key = path.split(".")[-1]
        where = f"{_place(path)} " if len(places) > 1 else ""
        unit = f" {units.label(key)}" if units.label(key) else ""
        parts.append(f"{where}{units.words(key)} {_value(state.values.get(path))}{unit}")
    return ", ".join(parts)


def _axis(path: str) -> str:
    key = path.split(".")[-1]
    of = f" of {_place(path)}" if _place(path) else ""
    unit = f" [{units.label(key)}]" if units.label(key) else ""
    return f"{units.words(key)}{of}{unit}"


def _place(path: str) -> str:
    """Which of the traffic a path is about."""
    within = path.removeprefix("traffic.").split(".")[:-1]
    return " ".join("all trains" if part == "*" else part for part in within)


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    text = str(value).removesuffix(".csv")
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def component_in_words(component: str) -> str:
    """A component of costs, such as ``lost_minute.freight``."""
    key, _, train = component.partition(".")
    words = COMPONENTS[key]
    return f"{words}, {train}" if train else words


def number(value: float) -> str:
    """A number that is varied, in four digits: a cost, a price, a rate or a probability."""
    return f"{value:,.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.4g}"


def varied_in_words(key: str) -> str:
    """A number of the plan that is varied, by its key path."""
    first, _, rest = key.partition(".")
    if first == "scenarios":
        return f"probability of {rest.removesuffix('.probability')}"
    if first == "measures":
        return f"cost of {rest.removesuffix('.cost')}"
    name, _, train = rest.partition(".")
    words = name.replace("_", " ").replace("kwh", "kWh")
    return f"{words}, {train}" if train else words
