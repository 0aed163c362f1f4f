"""What a train is under the system of the supply: its data by system, and limits that follow from it."""

from collections.abc import Iterator, Mapping
from typing import Any

from tpss import library
from tpss.errors import suggest
from tpss.scenario.completed import completed
from tpss.scenario.raw import Fault, table
from tpss.scenario.rolling_stock import BY_SYSTEM, Train
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS, system_named


def known_system(document: Mapping[str, Any]) -> str | None:
    """System of a document's supply; None if that has a fault of its own."""
    system = table(document, "supply").get("system", DEFAULT_SYSTEM)
    known = isinstance(system, str) and system in library.entries(SYSTEMS)
    return str(system) if known else None


def under_its_system(document: dict[str, Any]) -> dict[str, Any]:
    """A document whose trains are as they are under the system of its supply.

    What a train says of that system takes the place of what it says elsewhere, and of what its model
    says; of other systems nothing is left.  Current limitations that give no nominal voltage have that
    of the system, its knee, and its lowest voltage.
    """
    system, trains = known_system(document), document.get("trains")
    if system is None or not isinstance(trains, dict):
        return document
    return {**document, "trains": {name: _under(train, system) for name, train in trains.items()}}


def _under(train: Any, system: str) -> Any:
    if not isinstance(train, Mapping):
        return train
    own, of_model = (table(table(each, BY_SYSTEM), system) for each in (train, _model(train)))
    general = {key: value for key, value in train.items() if key != BY_SYSTEM}
    merged = completed(own, completed(general, of_model))
    if not isinstance(train.get(BY_SYSTEM, {}), Mapping):
        merged[BY_SYSTEM] = train[BY_SYSTEM]  # whose type is at fault
    return merged if system == DEFAULT_SYSTEM else _limited(merged, system)


def _model(train: Mapping[str, Any]) -> Mapping[str, Any]:
    """Values of a train's library model, if it has one."""
    return library.entries("locomotives").get(str(train.get("model")), {})


def _limited(train: dict[str, Any], system: str) -> dict[str, Any]:
    limitation = table(train, "current_limitation")
    if not limitation or "un_kv" in limitation:
        return train
    values, limits = system_named(system), library.values("voltage_limits", system)
    usual = {
        "un_kv": values.nominal_kv,
        "knee_factor": values.knee_factor,
        "umin2_kv": limits["umin2_kv"],
    }
    return {**train, "current_limitation": {**usual, **limitation}}


def check_systems(document: Mapping[str, Any]) -> Iterator[Fault]:
    """Trains on a system that they are not made for, and data of systems that there are not."""
    system = known_system(document)
    for name, train in table(document, "trains").items():
        if isinstance(train, Mapping):
            yield from _of_other_systems(f"trains.{name}", train, system)


def _of_other_systems(place: str, train: Mapping[str, Any], system: str | None) -> Iterator[Fault]:
    by_system, known = table(train, BY_SYSTEM), library.entries(SYSTEMS)
    for each, values in by_system.items():
        where = f"{place}.{BY_SYSTEM}.{each}"
        if each not in known:
            yield where, "", "no such system", suggest(each, known)
        elif not isinstance(values, Mapping):
            yield where, repr(values), "no table", "write the keys of a train that differ there"
        else:
            for key in values:
                if key not in Train.model_fields or key in (BY_SYSTEM, "systems", "model"):
                    yield f"{where}.{key}", "", "no key of a train there", "leave it out"
    own = train.get("systems")
    made_for = own if own is not None else _model(train).get("systems")
    listed = isinstance(made_for, list | tuple) and all(isinstance(each, str) for each in made_for)
    if system is None or not listed or not made_for or system in made_for:
        return
    key = "systems" if own is not None else "model"
    problem = f"a train for {', '.join(made_for)}, and the system of the supply is {system}"
    remedy = "choose another train, or give systems that it runs under, with by_system what differs"
    yield f"{place}.{key}", repr(train[key]), problem, remedy
