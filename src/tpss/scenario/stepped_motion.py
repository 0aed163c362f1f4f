"""What a scenario may not ask for where trains move in steps.

The checks read the document as it was written, see `scenario.raw`.
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tpss.scenario.raw import Fault, table
from tpss.scenario.simulation import made_of_stepped_motion

Asked = tuple[str, str, str, str]
"""Key path and value of what is asked for, its problem, and a remedy beside leaving out the choice that
makes trains move in steps, which the problem names at ``{}``."""


def check_stepped_motion(document: Mapping[str, Any]) -> Iterator[Fault]:
    """What is asked for beside a choice that makes trains move in steps."""
    simulation = table(document, "simulation")
    choices = ['motion = "stepped"'] if simulation.get("motion") == "stepped" else []
    choices += made_of_stepped_motion(simulation.get)
    if not choices:
        return
    for asked in UNKNOWN:
        for key, value, problem, remedy in asked(document):
            yield key, value, problem.format(choices[0]), f"{remedy}leave {choices[0]} out"


def _separation(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Trains that are kept apart: it knows no authorities."""
    wanted = table(document, "signalling").get("separation", "none")
    if wanted != "none":
        yield "signalling.separation", repr(wanted), "does not go with {}", ""


def _bands(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Retardations that depend on the speed: its plans know a single one."""
    for name, train in _trains(document):
        if table(train, "max_retardation_m_s2"):
            problem = "one for each band of speeds, which {} does not know"
            yield f"trains.{name}.max_retardation_m_s2", "", problem, "give a number, or "


def _electric_brakes(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Trains that feed back: it knows no brakes for a part of a step."""
    for name, train in _trains(document):
        if table(train, "regeneration"):
            yield f"trains.{name}.regeneration", "", "does not go with {}", ""


def _own_stores(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Trains with stores on board: their limits are those of a whole step's means."""
    for name, train in _trains(document):
        if table(train, "storage"):
            yield f"trains.{name}.storage", "", "does not go with {}", ""


def _own_drivers(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Drivers by a law of another package: its drivers decide about whole steps."""
    for name, train in _trains(document):
        if table(train, "driver"):
            yield f"trains.{name}.driver", "", "does not go with {}", ""


def _without_contact_line(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Stretches without contact line: trains may stand anywhere there."""
    if table(document, "supply").get("without_contact_line"):
        problem = "trains may come to stand there, within a step, which {} does not know"
        yield "supply.without_contact_line", "", problem, ""


def _neutral_sections(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Neutral sections: a train has power in whole steps."""
    if table(document, "supply").get("neutral_sections"):
        problem = "trains pass them for a part of a step, which {} does not know"
        yield "supply.neutral_sections", "", problem, ""


def _coasting(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Trains that coast: it knows no driving without force for a part of a step."""
    for key in ("traffic", "timetables"):
        entries = document.get(key)
        for number, entry in enumerate(entries if isinstance(entries, list) else ()):
            wanted = entry.get("spare_time") if isinstance(entry, Mapping) else None
            if wanted in ("coasting", "least-energy"):
                yield f"{key}.{number}.spare_time", repr(wanted), "does not go with {}", ""


def _protection(document: Mapping[str, Any]) -> Iterator[Asked]:
    """Stations that trip: trains may be left without power, and stand anywhere."""
    if table(document, "protection").get("trip") is True:
        problem = "may leave trains without power, which {} does not know"
        yield "protection.trip", "true", problem, ""


def _trains(document: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    for name, train in table(document, "trains").items():
        if isinstance(train, Mapping):
            yield name, train


UNKNOWN: tuple[Callable[[Mapping[str, Any]], Iterator[Asked]], ...] = (
    _bands,
    _separation,
    _neutral_sections,
    _electric_brakes,
    _own_stores,
    _own_drivers,
    _without_contact_line,
    _coasting,
    _protection,
)
"""What is looked for, in the order of the findings."""
