"""A whole scenario: the line, its supply, its trains, its traffic, and how to simulate them."""

import hashlib
import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, Self

import tomli_w
from pydantic import Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from tpss import library
from tpss.errors import Finding, ScenarioError, no_such
from tpss.files.single import save_file
from tpss.printable import document_in_nfc
from tpss.scenario.direct_current import without_reactive_power
from tpss.scenario.events import Restart
from tpss.scenario.fields import LINE, Name, OnLine, Part, Version, fault, unique
from tpss.scenario.given_path import named_as_given
from tpss.scenario.line import Line
from tpss.scenario.of_the_system import under_its_system
from tpss.scenario.outage_faults import outage_faults
from tpss.scenario.outages import Outage, Outages
from tpss.scenario.override import copy_of, override
from tpss.scenario.own_library import folder_in_use, using
from tpss.scenario.protection import Protection
from tpss.scenario.rolling_stock import Train
from tpss.scenario.signalling import Signalling
from tpss.scenario.simulation import Simulation
from tpss.scenario.standards import Standards
from tpss.scenario.supply import Supply
from tpss.scenario.supply.system import DEFAULT_SYSTEM, SYSTEMS
from tpss.scenario.timetable import Timetable
from tpss.scenario.traffic import Traffic
from tpss.scenario.validate import validate_with_notes
from tpss.scenario.variants import Variants, apply_variant

READ_IN = ("timetables",)
"""Keys whose files have been read into others."""


class Scenario(Part):
    """A validated, frozen scenario of format 1.

    Created by `tpss.load_scenario` or `Scenario.from_document`, which also check the parts against
    each other.  `with_` gives a changed copy.
    """

    format: Version = Field(description="Version of the file format.")
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")] = Field(
        description="Short name, used for result folders."
    )
    description: str = Field(default="", description="What the scenario is about.")
    simulation: Simulation = Field(
        default={}, validate_default=True, description="How the simulation runs."
    )
    lines: dict[Name, Line] = Field(
        default={},
        description="Railway lines by name, which meet at stations of the same name.",
    )
    line: Line | None = Field(
        default=None, validate_default=True, description="The railway line, if there is one only."
    )
    supply: Supply = Field(description="Everything that feeds the trains.")
    trains: Annotated[dict[Name, Train], Field(min_length=1)] = Field(
        description="Types of train by name, at least one."
    )
    traffic: Annotated[tuple[Traffic, ...], Field(min_length=1), unique("name")] = Field(
        description="Services, at least one; the first train of the first one is studied."
    )
    timetables: tuple[Timetable, ...] = Field(
        default=(),
        description="Files of trains that run too, each at its own times.",
    )
    signalling: Signalling = Field(
        default={}, validate_default=True, description="What keeps trains apart."
    )
    events: tuple[Restart, ...] = Field(
        default=(), description="Times in which trains are held, to start at once."
    )
    standards: Standards = Field(
        default={}, validate_default=True, description="Criteria by which the result is judged."
    )
    protection: Protection = Field(
        default={},
        validate_default=True,
        description="What is disconnected when it passes what it may carry.",
    )
    outages: Outages = Field(
        default=(),
        description="Outages of the supply; one applies if `simulation.outage` names it.",
    )
    variants: Variants = Field(
        default={}, description="Variants by name: the scenario with some changes."
    )

    @field_validator("line")
    @classmethod
    def _there_is_a_line(cls, line: Line | None, info: ValidationInfo) -> Line | None:
        if line is None and info.data.get("lines") == {}:
            raise fault("it is missing", "add it, or lines by their names")
        if line is not None and LINE in info.data.get("lines", {}):
            raise fault(f"lines.{LINE} has its name", "give that line another name")
        return line

    @model_validator(mode="before")
    @classmethod
    def _judge_by_the_limits_of_the_system(cls, given: Any) -> Any:
        """Use the voltage limits of the supply's system, unless the standards name others."""
        if not isinstance(given, dict):
            return given
        supply, standards = given.get("supply", {}), given.get("standards", {})
        if not isinstance(supply, dict) or not isinstance(standards, dict):
            return given  # which has a fault of its own
        limits, system = standards.get("voltage_limits", {}), supply.get("system", DEFAULT_SYSTEM)
        if not isinstance(limits, dict) or not isinstance(system, str):
            return given
        if system not in library.entries(SYSTEMS):
            return given
        standards = {**standards, "voltage_limits": {"system": system, **limits}}
        judged = under_its_system({**given, "standards": standards})
        return without_reactive_power(judged)

    _document: dict[str, Any] = PrivateAttr(default_factory=dict)
    _source: Path = PrivateAttr(default=Path("scenario"))
    _given: str = PrivateAttr(default="scenario")
    _file_notes: tuple[str, ...] = PrivateAttr(default=())
    _library: Path | None = PrivateAttr(default=None)

    @classmethod
    def from_document(cls, document: Mapping[str, Any], source: str | Path = "scenario") -> Self:
        """Scenario from a mapping with the keys of a scenario file.

        Parameters
        ----------
        document : mapping
            Keys and values as in a TOML file.
        source : path
            File to name in errors; paths in the document are relative to its folder.

        Raises
        ------
        ScenarioError
            The document has faults; the error lists all of them.
        """
        return cls.from_own_document(document_in_nfc(copy_of(document)), source)

    @classmethod
    def from_own_document(cls, document: dict[str, Any], source: str | Path) -> Self:
        """`from_document` for a document that the caller gives up, and so need not be copied.

        Raises
        ------
        ScenarioError
            As `from_document`.
        """
        scenario, notes = validate_with_notes(cls, document, Path(source))
        faults = outage_faults(
            scenario.outages,
            scenario.simulation,
            scenario.supply,
            scenario.lines_by_name,
            str(source),
        )
        if faults:
            raise ScenarioError(faults)
        scenario._document = document
        # A change of the working folder must not lead to other files.
        scenario._source, scenario._given = Path(source).absolute(), str(source)
        scenario._file_notes, scenario._library = notes, folder_in_use()
        return scenario

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Copy with other parts, which are not checked; `with_` checks them."""
        copy = super().model_copy(update=update, deep=deep)
        if update:
            copy._document = {}
        return copy

    @property
    def _own_document(self) -> dict[str, Any]:
        """The document that it was made from; of one that was not, what it says."""
        return self._document or self.as_document()

    @property
    def source(self) -> Path:
        """File that the scenario was read from, or a name in its place."""
        return self._source

    @property
    def given_source(self) -> str:
        """Its file as it was named, by which findings name it."""
        return self._given

    @property
    def file_notes(self) -> tuple[str, ...]:
        """What is told of how its files were read, such as gradients derived from altitudes."""
        return self._file_notes

    def with_(self, changes: Mapping[str, Any]) -> Self:
        """Validated copy with some values changed.

        Parameters
        ----------
        changes : mapping of str to value
            Key paths, such as ``"simulation.time_step_min"`` or ``"traffic.0.headway_min"``, and
            their new values; None removes a key.  List items are named by their numbers or their
            names, ``*`` is all of them, ``+`` one more.

        Raises
        ------
        ScenarioError
            The changed scenario has faults.
        """
        with named_as_given(self._source, self._given):
            document = override(self._own_document, changes, self._source)
            return self._of_own_file(document)

    def _of_own_file(self, document: dict[str, Any]) -> Self:
        """A scenario of another document, as if that stood in the file of this one."""
        with using(self._library):
            scenario = type(self).from_own_document(document, self._source)
        scenario._given = self._given
        return scenario

    def variant(self, name: str) -> Self:
        """A variant of the scenario: a scenario of its own, named after both.

        Raises
        ------
        ScenarioError
            There is no such variant, or it has faults.
        """
        if name not in self.variants:
            remedy = "variants: " + (", ".join(self.variants) or "none; add [variants.NAME]")
            problem = "the scenario has no such variant"
            raise ScenarioError([Finding(self._given, "variants", repr(name), problem, remedy)])
        with named_as_given(self._source, self._given):
            document = apply_variant(self._own_document, name, self.variants[name], self._source)
        try:
            return self._of_own_file(document)
        except ScenarioError as error:
            place = f"{self._given} (variant {name})"
            findings = [replace(finding, file=place) for finding in error.findings]
            raise ScenarioError(findings) from error

    @property
    def lines_by_name(self) -> dict[str, Line]:
        """All lines, that of the key ``line`` called so."""
        return self.lines if self.line is None else {LINE: self.line, **self.lines}

    @property
    def only_line(self) -> Line:
        """The line of a scenario with one.

        Raises
        ------
        ScenarioError
            There are several.
        """
        lines = list(self.lines_by_name.values())
        if len(lines) > 1:
            problem, remedy = "several lines, where this works with one", "keep one of them"
            raise ScenarioError([Finding(self._given, "lines", "", problem, remedy)])
        return lines[0]

    def line_of(self, part: OnLine) -> str:
        """Name of the line on which something stands."""
        return part.line or next(iter(self.lines_by_name))

    def with_outage(self, name: str) -> Self:
        """The scenario with one of its outages: a scenario of its own, named after both.

        Raises
        ------
        ScenarioError
            There is no such outage.
        """
        outage = next((each for each in self.outages if each.name == name), None)
        if outage is None:
            problem, remedy = no_such("outage", name, [each.name for each in self.outages])
            raise ScenarioError([Finding(self._given, "outages", repr(name), problem, remedy)])
        return self.with_({"simulation.outage": name, "name": f"{self.name}-{outage.slug}"})

    @property
    def outage(self) -> Outage | None:
        """The outage that applies, if any."""
        chosen = self.simulation.outage
        return next((each for each in self.outages if each.name == chosen), None)

    def trains_by_service(self) -> dict[str, Train]:
        """Type of train of each service, by its name."""
        return {entry.name: self.trains[entry.train] for entry in self.traffic}

    def __eq__(self, other: object) -> bool:
        """Whether two scenarios say the same, wherever they were read from."""
        return isinstance(other, Scenario) and self.as_document() == other.as_document()

    def __hash__(self) -> int:
        return hash(json.dumps(self.as_document(), sort_keys=True))

    def __repr__(self) -> str:
        stations = sum(len(line.stations) for line in self.lines_by_name.values())
        parts = (
            (len(self.lines_by_name), "line"), (stations, "station"),
            (len(self.supply.stations), "feeding station"), (len(self.traffic), "service"),
        )  # fmt: skip
        told = ", ".join(f"{count} {what}{'s' * (count != 1)}" for count, what in parts)
        return f"<Scenario {self.name!r}: {told}>"

    __str__ = __repr__

    def to_toml(self) -> str:
        """The scenario as run, with everything it took from files, library and defaults, as TOML."""
        return tomli_w.dumps(self.as_document())

    def save(self, file: str | Path, *, force: bool = False) -> Path:
        """Write `to_toml` into a file, which `tpss.load_scenario` and the command line read.

        Parameters
        ----------
        file : path
        force : bool
            Whether a file that is there may be replaced.

        Raises
        ------
        ResultError
            The file exists, or cannot be written.
        """
        return save_file(Path(file), self.to_toml().encode(), force)

    def digest(self) -> str:
        """Digest of all that the scenario says, wherever it was read from, its name left out."""
        apart = {"name", "description", "variants"} | self._without_effect | set(READ_IN)
        text = self.model_dump_json(by_alias=True, exclude_none=True, exclude=apart)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    @property
    def _without_effect(self) -> set[str]:
        """Outages, where none applies."""
        return {"outages"} if self.simulation.outage is None else set()

    def as_document(self) -> dict[str, Any]:
        """The scenario as run, with everything it took from files, library and defaults."""
        unused = {key for key in ("variants", "outages") if not getattr(self, key)} | set(READ_IN)
        return self.model_dump(mode="json", by_alias=True, exclude_none=True, exclude=unused)
