"""Files of a scenario from an imported network: lines, a timetable, and a scenario to complete."""

import json
import math
from typing import Any

import tomli_w

from tpss.errors import Finding, ScenarioError
from tpss.importers.feeding import feeding_places
from tpss.importers.network import ImportedNetwork, plain_name
from tpss.importers.services import EXAMPLE, service_tables
from tpss.importers.supplies import DEFAULT_SYSTEM, supply_of
from tpss.importers.texts import comments
from tpss.importers.timetable import begin_of_day, clock, csv_text, end_of_day
from tpss.importers.ways import example_way
from tpss.results.osrd_tracks import tracks_text
from tpss.scenario.scenario import Scenario

TRACKS = "tracks.csv"
TIMETABLE = "timetable.csv"
SCENARIO = "scenario.toml"

AFTERWARDS_MIN = 60.0
"""A simulation goes on so long after the last time that is scheduled. [min]"""

_SCENARIO = """\
format = 1
name = {name}
description = {description}

[simulation]
{simulation}

[lines]
{lines}
# ASSUMED, edit it: {format_name} describes no power supply.  No station is farther than {reach_km:g} km
# from a feeding station.
[supply]
system = {system}
{supply}{trains}
{traffic}"""

_TIMETABLE = f"""
[[timetables]]
file = "{TIMETABLE}"
"""


def files(network: ImportedNetwork) -> dict[str, str]:
    """Texts by file name: the scenario, a file for each line, and what there is besides.

    Raises
    ------
    ScenarioError
        The lines have faults, such as values out of range.
    """
    _check(network)
    texts = {SCENARIO: scenario_text(network)}
    for line in network.lines:
        source = f"{network.format_name}, {network.sources[0].name}"
        texts[f"lines/{line.name}.toml"] = tomli_w.dumps({"source": source, **line.document})
    for name, table in network.stock.items():
        texts[f"trains/{name}.toml"] = tomli_w.dumps(table)
    if network.trains:
        texts[TIMETABLE] = csv_text(network.trains)
    if network.tracks:
        texts[TRACKS] = tracks_text(network.tracks)
    return texts


def scenario_text(network: ImportedNetwork) -> str:
    """The scenario: what was imported, and a supply, trains and traffic to be edited."""
    sources = " and ".join(path.name for path in network.sources)
    kinds = {each.train_type: None for each in network.trains}
    kinds |= {each.train.train_type: None for each in network.services}
    assumed = supply_of(network.system)
    return comments(f"Imported from {sources} of {network.format_name}.", network) + (
        _SCENARIO.format(
            name=_text(network.name),
            description=_text(f"{sources}, from {network.format_name}"),
            simulation=_simulation(network),
            lines="".join(f'{name} = "lines/{name}.toml"\n' for name in network.stations),
            format_name=network.format_name,
            reach_km=assumed.reach_km,
            system=_text(network.system or DEFAULT_SYSTEM),
            supply=_supply(network),
            trains=_trains(network, list(kinds) or ["train"]),
            traffic=_traffic(network),
        )
    )


def _clock_s(network: ImportedNetwork) -> tuple[float, float] | None:
    """When a simulation of the trains begins and ends, after midnight; None without trains."""
    begins = [begin_of_day(network.trains)] if network.trains else []
    begins += [each.first_s for each in network.services]
    if not begins:
        return None
    ends = [end_of_day(network.trains)] if network.trains else []
    ends += [each.end_s for each in network.services]
    return min(begins), max(ends) + 60.0 * AFTERWARDS_MIN


def _simulation(network: ImportedNetwork) -> str:
    hours = _clock_s(network)
    if hours is None:
        return "duration_min = 120.0                # ASSUMED, edit it"
    begin_s, end_s = hours
    minutes = float(math.ceil((end_s - begin_s) / 60.0))
    return (
        f'starts_at = "{clock(begin_s)[:5]}"\n'
        f"duration_min = {minutes:g}.0             # ASSUMED: until an hour after the last time"
    )


def _supply(network: ImportedNetwork) -> str:
    """The contact line, assumed feeding stations, and the neutral sections of the file."""
    assumed = supply_of(network.system)
    stations = []
    for each in feeding_places(network):
        place = f"at = {_text(each.at)}"
        if not each.at:
            place = f"line = {_text(each.line)}\nposition_km = {each.position_km!r}"
        stations.append(assumed.station.format(name=_text(each.name), place=place))
    return f"{assumed.catenary}\n{''.join(stations)}{_neutral_sections(network)}"


def _trains(network: ImportedNetwork, kinds: list[str]) -> str:
    """Tables of the kinds of train: those of imported rolling stock, and assumed ones."""
    assumed, texts = supply_of(network.system).train, []
    names = [plain_name(kind) for kind in kinds]
    if names == ["train"] and network.stock:
        names = list(network.stock)
    for name in names:
        own = f'\n[trains.{name}]\nmodel = "trains/{name}.toml"\n'
        texts.append(own if name in network.stock else assumed.format(key=name))
    return "".join(texts)


def _neutral_sections(network: ImportedNetwork) -> str:
    tables = []
    for each in network.neutral_sections:
        raised = f"raise_s = {each.raise_s!r}\n" if each.raise_s else ""
        tables.append(
            f"\n[[supply.neutral_sections]]\nline = {_text(each.line)}\n"
            f"from_km = {each.from_km!r}\nto_km = {each.to_km!r}\n{raised}"
        )
    return "".join(tables)


def _traffic(network: ImportedNetwork) -> str:
    text = _TIMETABLE if network.trains else ""
    hours = _clock_s(network)
    if hours is not None:
        return text + service_tables(network.services, hours)
    begin, end, via = example_way(network.stations)
    passed = f"via = [{', '.join(map(_text, via))}]\n" if via else ""
    train = next(iter(network.stock), "train")
    return EXAMPLE.format(train=_text(train), begin=_text(begin), end=_text(end), via=passed)


def _text(words: str) -> str:
    return json.dumps(words, ensure_ascii=False)


def _check(network: ImportedNetwork) -> None:
    """Validate the lines in a scenario whose other parts are placeholders.

    Raises
    ------
    ScenarioError
        There are no lines, or they have faults.
    """
    source = network.sources[0]
    if not network.lines:
        problem, remedy = "no line can be made of it", "name a file with more tracks or stations"
        raise ScenarioError([Finding(str(source), "", "", problem, remedy)])
    begin, end, via = example_way(network.stations)
    at = network.lines[0].stations
    document: dict[str, Any] = {
        "format": 1,
        "name": "check",
        "lines": {line.name: line.document for line in network.lines},
        "simulation": {"time_step_min": 1.0, "duration_min": 60.0},
        "supply": {
            "catenary": "BT",
            "converter_stations": [
                {"name": "S", "at": next(iter(at)), "type": "Q48/Q49", "converters": 1}
            ],
        },
        "trains": {"t": {"model": "Rc4-freight-1470t"}},
        "traffic": [
            {"name": "t", "train": "t", "from": begin, "to": end, "via": via, "headway_min": 10.0}
        ],
    }
    Scenario.from_document(document, source)
