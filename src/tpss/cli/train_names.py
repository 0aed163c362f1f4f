"""Names that trains of a scenario may have, known before any of them runs."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from tpss.errors import Finding, ScenarioError, closest, shortened
from tpss.scenario import Scenario
from tpss.scenario.traffic import Traffic

MOST_LISTED = 8
"""Kinds of names that are listed; of more their number is told."""


@dataclass(frozen=True)
class _Names:
    """A name, or with numbers behind it those from 1 up to the highest."""

    text: str
    highest: float = 0.0
    """Infinite where trains depart for ever; 0: the text is the whole name."""

    def has(self, name: str) -> bool:
        if not self.highest:
            return name == self.text
        text, _, number = name.rpartition(" ")
        is_number = number.isdecimal() and str(int(number)) == number
        return text == self.text and is_number and 1 <= int(number) <= self.highest

    def near(self, name: str) -> list[str]:
        """Names to propose in place of another one: with its number, and the first."""
        if not self.highest:
            return [self.text]
        numbered = [f"{self.text} {number}" for number in (name.rpartition(" ")[2], "1")]
        return [each for each in numbered if self.has(each)]

    @property
    def in_words(self) -> str:
        if not self.highest:
            return self.text
        if math.isinf(self.highest):
            return f"{self.text} 1, 2, ..."
        return f"{self.text} 1" + (f" to {self.highest:g}" if self.highest > 1 else "")


def demand_train(name: str, scenarios: Sequence[Scenario]) -> None:
    """Refuse a train that no service has, whenever it departs.

    Raises
    ------
    ScenarioError
    """
    known = list(dict.fromkeys(names for each in scenarios for names in _names(each.traffic)))
    if any(names.has(name) for names in known):
        return
    close = closest(name, [near for names in known for near in names.near(name)])
    hint = f"did you mean {close}? " if close else ""
    source, value = scenarios[0].given_source, repr(shortened(name))
    problem, remedy = "there is no such train", f"{hint}trains: {_listed(known)}"
    raise ScenarioError([Finding(source, "--show", value, problem, remedy)])


def _names(traffic: Iterable[Traffic]) -> Iterator[_Names]:
    """Names of the trains of services: those that depart, and those on the line at the start."""
    for entry in traffic:
        if entry.departure_min is not None:
            yield _Names(entry.name)
        else:
            listed = entry.listed_departures_min
            yield _Names(entry.name, math.inf if listed is None else len(listed))
        if placed := math.inf if entry.already_running else len(entry.initial_trains):
            yield _Names(f"{entry.name} initial", placed)


def _listed(known: Sequence[_Names]) -> str:
    texts = [names.in_words for names in known[:MOST_LISTED]]
    if len(known) > MOST_LISTED:
        texts.append(f"and {len(known) - MOST_LISTED} more")
    return "; ".join(texts)
