"""Infrastructure of OSRD (railjson 3): what of it counts for trains and their supply.

References
----------
The format is that of https://osrd.fr, version 3.4: lengths in metres, gradients in per mille, positive
uphill from a track's beginning to its end, speeds in m/s.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field

from tpss.errors import Finding, ScenarioError
from tpss.importers.documents import Item, as_model, read_json

REMEDY = "export the infrastructure from OSRD anew, as railjson 3"

Ident = Annotated[str, Field(min_length=1)]
EndName = Literal["BEGIN", "END"]
End = tuple[str, str]
"""A track section, and one of its ends."""


class Slope(Item):
    """A gradient on a part of a track section. [‰]"""

    gradient: float = Field(ge=-100, le=100)
    begin: float
    end: float


class Curve(Item):
    """A curve on a part of a track section. [m]"""

    radius: float
    begin: float
    end: float


class LineNames(Item):
    """Which line and track of a register a section belongs to."""

    line_code: int | str = ""
    line_name: str = ""
    track_name: str = ""


class TrackExtensions(Item):
    """Additions to a track section."""

    sncf: LineNames | None = None


class TrackSection(Item):
    """A piece of track between switches."""

    id: Ident
    length: float = Field(gt=0)
    slopes: tuple[Slope, ...] = ()
    curves: tuple[Curve, ...] = ()
    extensions: TrackExtensions = TrackExtensions()

    @property
    def names(self) -> LineNames:
        """Its line and track; empty ones without the extension."""
        return self.extensions.sncf or LineNames()


class Endpoint(Item):
    """An end of a track section."""

    track: str
    endpoint: EndName


class Label(Item):
    """Name of a switch."""

    label: str = ""


class SwitchExtensions(Item):
    """Additions to a switch."""

    sncf: Label | None = None


class Switch(Item):
    """A connection of ends of track sections."""

    id: Ident
    switch_type: str
    ports: dict[str, Endpoint]
    extensions: SwitchExtensions = SwitchExtensions()

    @property
    def name(self) -> str:
        """Its label, or its id."""
        return (self.extensions.sncf and self.extensions.sncf.label) or self.id


class Connection(Item):
    """Two ports that a train may go between."""

    src: str
    dst: str


class SwitchType(Item):
    """A kind of switch besides those that are built in."""

    id: str
    groups: dict[str, list[Connection]]


class Part(Item):
    """Where an operational point lies on a track."""

    track: str
    position: float


class Identifier(Item):
    """Name and number of an operational point."""

    name: str = ""
    uic: int | None = None


class PointCode(Item):
    """Codes of an operational point."""

    trigram: str = ""
    ch: str = ""


class PointExtensions(Item):
    """Additions to an operational point."""

    identifier: Identifier | None = None
    sncf: PointCode | None = None


class OperationalPoint(Item):
    """A station, or another place that timetables name."""

    id: Ident
    parts: tuple[Part, ...] = ()
    extensions: PointExtensions = PointExtensions()

    @property
    def name(self) -> str:
        """Its name, or its id."""
        return (self.extensions.identifier and self.extensions.identifier.name) or self.id


class TrackRange(Item):
    """A part of a track section, in one direction or in both."""

    track: str
    begin: float
    end: float
    applicable_directions: Literal["BOTH", "START_TO_STOP", "STOP_TO_START"] = "BOTH"


class SpeedSection(Item):
    """A speed limit, perhaps for some kinds of train or routes only. [m/s]"""

    id: str = ""
    speed_limit: float | None = Field(default=None, gt=0)
    speed_limit_by_tag: dict[str, float] = Field(default_factory=dict)
    track_ranges: tuple[TrackRange, ...] = ()
    on_routes: list[str] | None = None


class Electrification(Item):
    """Where there is a contact line, and of which voltage."""

    voltage: str
    track_ranges: tuple[TrackRange, ...] = ()


class NeutralSection(Item):
    """Where trains pass without power, and perhaps with their pantographs lowered."""

    track_ranges: tuple[TrackRange, ...] = ()
    announcement_track_ranges: tuple[TrackRange, ...] = ()
    """Before it, where a board tells them to switch off."""
    lower_pantograph: bool = False


class Infra(Item):
    """An infrastructure; of signalling the number of its parts only."""

    version: str
    track_sections: Annotated[list[TrackSection], Field(min_length=1)]
    switches: tuple[Switch, ...] = ()
    extended_switch_types: tuple[SwitchType, ...] = ()
    operational_points: tuple[OperationalPoint, ...] = ()
    speed_sections: tuple[SpeedSection, ...] = ()
    electrifications: tuple[Electrification, ...] = ()
    neutral_sections: tuple[NeutralSection, ...] = ()
    signals: tuple[Any, ...] = ()
    routes: tuple[Any, ...] = ()
    detectors: tuple[Any, ...] = ()
    buffer_stops: tuple[Any, ...] = ()

    def connections(self, switch: Switch) -> list[tuple[End, End]]:
        """Ends between which trains may go over a switch, the straight or first way first."""
        own = {each.id: each for each in self.extended_switch_types}
        if switch.switch_type in own:
            groups = own[switch.switch_type].groups.values()
            pairs = [(each.src, each.dst) for group in groups for each in group]
        else:
            pairs = BUILT_IN[switch.switch_type]
        ports = switch.ports
        return [
            ((ports[a].track, ports[a].endpoint), (ports[b].track, ports[b].endpoint))
            for a, b in pairs
        ]


BUILT_IN = {
    "link": [("A", "B")],
    "point_switch": [("A", "B1"), ("A", "B2")],
    "crossing": [("A1", "B1"), ("A2", "B2")],
    "single_slip_switch": [("A1", "B1"), ("A2", "B2"), ("A1", "B2")],
    "double_slip_switch": [("A1", "B1"), ("A2", "B2"), ("A1", "B2"), ("A2", "B1")],
}
"""Ports between which trains may go, by the types of switch."""


def read_infra(path: Path) -> Infra:
    """Infrastructure of a file.

    Raises
    ------
    ScenarioError
        The file cannot be read, or has faults.
    """
    document = read_json(path)
    version = document.get("version") if isinstance(document, dict) else None
    if not isinstance(version, str) or not version.startswith("3."):
        shown = "" if version is None else repr(version)
        problem = "not an infrastructure of railjson 3"
        raise ScenarioError([Finding(str(path), "version", shown, problem, REMEDY)])
    infra: Infra = as_model(Infra, document, path, REMEDY)
    findings = [
        Finding(str(path), key, value, problem, REMEDY)
        for key, value, problem in _broken_references(infra)
    ]
    if findings:
        raise ScenarioError(findings)
    return infra


def _broken_references(infra: Infra) -> Iterator[tuple[str, str, str]]:
    known: set[str] = set()
    own = {each.id for each in infra.extended_switch_types}
    for i, section in enumerate(infra.track_sections):
        if section.id in known:
            yield f"track_sections.{i}.id", repr(section.id), "another track section has this id"
        known.add(section.id)
    for i, switch in enumerate(infra.switches):
        key = f"switches.{i}"
        for port, end in switch.ports.items():
            if end.track not in known:
                yield f"{key}.ports.{port}.track", repr(end.track), "there is no such track section"
        if switch.switch_type not in BUILT_IN and switch.switch_type not in own:
            yield f"{key}.switch_type", repr(switch.switch_type), "there is no such type of switch"
            continue
        try:
            infra.connections(switch)
        except KeyError as error:
            yield f"{key}.ports", str(error), "the switch has no such port"
    for i, point in enumerate(infra.operational_points):
        for k, part in enumerate(point.parts):
            if part.track not in known:
                place = f"operational_points.{i}.parts.{k}.track"
                yield place, repr(part.track), "there is no such track section"
    for i, limit in enumerate(infra.speed_sections):
        for k, part_of in enumerate(limit.track_ranges):
            if part_of.track not in known:
                place = f"speed_sections.{i}.track_ranges.{k}.track"
                yield place, repr(part_of.track), "there is no such track section"
