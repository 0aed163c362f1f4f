"""Files of a scenario from tracks and trains of TTOBench, with comments on the import."""

import tomli_w

from tpss.errors import Finding, ScenarioError
from tpss.importers.texts import comments
from tpss.importers.ttobench import Imported
from tpss.tables.kinds import GRADIENTS

_SCENARIO = """\
# {track} with {train}, imported from TTOBench.  Track and train are in separate files.
format = 1
name = "{name}"
description = "{train} on {track}"
line = "{track}.toml"

[simulation]
time_step_min = 0.02
until = "first-departure-arrives"

# ASSUMED, edit it: TTOBench describes no power supply.
[supply]
frequency_hz = 16.7
catenary = "BT"                     # or "AT", a table, or a file of your own

[[supply.converter_stations]]
name = "{first}"
position_km = {begin_km}
type = "Q48/Q49"
converters = 1

[[supply.converter_stations]]
name = "{last}"
position_km = {end_km}
type = "Q48/Q49"
converters = 1

[trains.{train}]
model = "{train}.toml"              # any key of the file may be overridden here

# ASSUMED, edit it: TTOBench describes no timetable{dwells}.
[[traffic]]
name = "{service}"
train = "{train}"
from = "{first}"
to = "{last}"
headway_min = 30.0
stops = [{stops}]
"""


def files(tracks: list[Imported], trains: list[Imported]) -> dict[str, str]:
    """Texts by file name: a line for each track, a train for each train, a scenario for each pair.

    Raises
    ------
    ScenarioError
        Two of the imported files have the same id.
    """
    texts: dict[str, str] = {}
    findings = []
    for part in (*tracks, *trains):
        if f"{part.name}.toml" in texts:
            problem, remedy = "another of the files has this id", "give each its own id"
            findings.append(Finding(str(part.source), "metadata.id", part.name, problem, remedy))
        texts |= _line_files(part) if part in tracks else _train_files(part)
    if findings:
        raise ScenarioError(findings)
    for track in tracks:
        for train in trains:
            texts[f"{scenario_name(track, train)}.toml"] = _scenario(track, train)
    return texts


def scenario_name(track: Imported, train: Imported) -> str:
    """Name of the scenario of a pair, and of its file."""
    return f"{track.name}-{train.name}"


def _line_files(track: Imported) -> dict[str, str]:
    profile = f"{track.name}_gradients.csv"
    line = {key: value for key, value in track.document.items() if key != "gradients"}
    rows = [f"{row['from_km']:.10g},{row['permille']:.10g}" for row in track.document["gradients"]]
    head = [
        "# Gradients apply from their positions on, positive uphill.",
        GRADIENTS.header,
    ]
    return {
        f"{track.name}.toml": _comments(track)
        + tomli_w.dumps({"source": _source(track), "gradients_file": profile, **line}),
        profile: "\n".join([*head, *rows, ""]),
    }


def _train_files(train: Imported) -> dict[str, str]:
    text = tomli_w.dumps({"source": _source(train), **train.document})
    return {f"{train.name}.toml": _comments(train) + text}


def _source(part: Imported) -> str:
    return f"TTOBench, {part.source.name}"


def _comments(part: Imported) -> str:
    return comments(f"Imported from {part.source.name} of TTOBench.", part)


def _scenario(track: Imported, train: Imported) -> str:
    stations = [station["name"] for station in track.document["stations"]]
    between = [f'{{ station = "{name}", dwell_min = 0.5 }}' for name in stations[1:-1]]
    return _SCENARIO.format(
        name=scenario_name(track, train),
        track=track.name,
        train=train.name,
        first=stations[0],
        last=stations[-1],
        begin_km=track.document.get("begins_at_km", 0.0),
        end_km=track.document["stations"][-1]["position_km"],
        service=f"{stations[0]}-{stations[-1]}",
        stops=", ".join(between),
        dwells=" and no dwells" if between else "",
    )
