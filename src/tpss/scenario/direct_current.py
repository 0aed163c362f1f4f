"""Trains on a line of direct current: they have no reactive power, and no machine of another line."""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss import library
from tpss.scenario.raw import Fault, number, table
from tpss.scenario.rolling_stock import Train
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS, system_named

UNITY = {"power_factor": 1.0, "auxiliary_power_factor": 1.0}
"""What a train on such a line has, given or not."""

ALTERNATING = {
    "filter_reactance_ohm": "a filter for alternating",
    "transformer_primary_kv": "a transformer, which takes alternating",
    "transformer_secondary_v": "a transformer, which takes alternating",
}
"""Keys of trains that belong to an alternating current."""


def is_direct(document: Mapping[str, Any]) -> bool:
    """Whether the supply of a document is one of direct current."""
    system = table(document, "supply").get("system", DEFAULT_SYSTEM)
    known = isinstance(system, str) and system in library.entries(SYSTEMS)
    return known and system_named(system).is_direct


def without_reactive_power(document: dict[str, Any]) -> dict[str, Any]:
    """A document in which trains on direct current have power factors of 1, unless they say others."""
    trains = document.get("trains")
    if not is_direct(document) or not isinstance(trains, dict):
        return document
    unity = {
        name: {**UNITY, **train} if isinstance(train, dict) else train
        for name, train in trains.items()
    }
    return {**document, "trains": unity}


def check_direct_current(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains on direct current that have something of an alternating current."""
    if not is_direct(document):
        return
    system = table(document, "supply")["system"]
    for name, train in table(document, "trains").items():
        if isinstance(train, Mapping):
            yield from _of_train(f"trains.{name}", train, system)


def _of_train(place: str, train: Mapping[str, Any], system: str) -> Iterator[Fault]:
    for part, where in ((train, place), (table(train, "regeneration"), f"{place}.regeneration")):
        for key in UNITY:
            if key in part and number(part, key) != 1.0:
                problem = f"direct current, that of the system {system}, has no reactive power"
                yield f"{where}.{key}", repr(part[key]), problem, "leave it out"
    for key, words in ALTERNATING.items():
        if key in train and train[key] != Train.model_fields[key].default:
            yield f"{place}.{key}", repr(train[key]), f"{words} current", "leave it out"
    if train.get("reactive_power") == "double-bridge":
        problem = "bridges of a train for alternating current"
        yield f"{place}.reactive_power", "'double-bridge'", problem, "leave it out"
    model = library.entries("locomotives").get(str(train.get("model")), {})
    if train.get("tractive_effort", model.get("tractive_effort")) == "Rc4":
        problem = "a machine for 15 kV alternating current"
        remedy = "give max_force_kn and max_power_kw, or a table, or another model"
        yield f"{place}.tractive_effort", "'Rc4'", problem, remedy
