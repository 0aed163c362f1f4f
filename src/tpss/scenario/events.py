"""Events of the traffic: all trains held at stations, to start at once."""

from collections.abc import Iterator, Mapping
from typing import Any, Literal, Self

from pydantic import Field, model_validator

from tpss.errors import no_such
from tpss.scenario.clock import Moment
from tpss.scenario.fields import Name, Part, fault
from tpss.scenario.raw import Fault, items, lines_of, table


class Restart(Part):
    """Trains stop at their next stations and stay there, until all of them start at once.

    So the supply is asked for most that it may have to give.
    """

    kind: Literal["restart"] = Field(description="What happens.")
    held_from_min: Moment = Field(
        description="From when on trains go no further than the next station; those that are to depart "
        "stay where they are."
    )
    at_min: Moment = Field(description="When all of them may go on.")
    lines: tuple[Name, ...] = Field(
        default=(), description="Lines at whose stations trains are held; leave it out: all."
    )

    @model_validator(mode="after")
    def _lasts_a_while(self) -> Self:
        if self.at_min <= self.held_from_min:
            raise fault(
                f"trains would start at {self.at_min:g} min and be held from {self.held_from_min:g} min",
                "let at_min be later than held_from_min",
            )
        return self


def check_events(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Faults of events: lines that there are not, and trains that do not look out."""
    known = list(lines_of(document))
    separation = table(document, "signalling").get("separation", "none")
    for i, event in items(document, "events"):
        if separation == "none":
            problem = "trains are held by signals, which they do not see without a separation"
            remedy = 'add separation = "moving-block" or "fixed-block" to [signalling]'
            yield f"events.{i}", "", problem, remedy
        named = event.get("lines")
        for k, name in enumerate(named if isinstance(named, list | tuple) else []):
            if isinstance(name, str) and name not in known:
                yield f"events.{i}.lines.{k}", repr(name), *no_such("line", name, known)
