"""The study file: a base scenario, what varies, and how cases are drawn."""

import hashlib
import json
from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from tpss.errors import Finding, ScenarioError
from tpss.laws.registry import laws_named
from tpss.scenario.fields import LINE, Name, Part, Real, Whole, fault
from tpss.scenario.files import read_toml
from tpss.scenario.given_path import named_as_given
from tpss.scenario.inline import inline_files
from tpss.scenario.load import demand_no_scenario
from tpss.scenario.override import copy_of
from tpss.scenario.scenario import Scenario
from tpss.scenario.validate import validate
from tpss.sweep.settings import Settings, apply
from tpss.sweep.timetables import TIMETABLES, is_of_timetables, texts_of
from tpss.sweep.variable import fault_of_drawn_line, faults_of_paths
from tpss.sweep.variation import Variation, flattened


def _between(least: float, most: float) -> AfterValidator:
    """A check that all values of a variation are numbers between two."""

    def check(variation: Variation) -> Variation:
        for value in variation.ends:
            if isinstance(value, bool | str) or not least <= value <= most:
                raise fault("out of range", f"give numbers from {least:g} to {most:g}")
        return variation

    return AfterValidator(check)


class Gradients(Part):
    """A gradient profile that is drawn for every case."""

    line: Name | None = Field(
        default=None, description="Name of the line that gets it; needed where there are several."
    )
    mean_permille: Annotated[Variation, _between(-100.0, 100.0)] = Field(
        description="Mean of the gradient over the line."
    )
    standard_deviation_permille: Annotated[Variation, _between(0.0, 100.0)] = Field(
        description="Standard deviation of the gradient over the line."
    )
    profile: Variation | None = Field(
        default=None,
        description="Seed of the profile; by default each case has its own.",
    )
    piece_km: Real = Field(
        default=1.0, ge=0.01, le=100, description="Length over which the gradient stays the same."
    )
    correlation_km: Real = Field(
        default=5.0,
        ge=0,
        le=1_000,
        description="Distance over which the correlation of the gradient falls to 1/e.",
    )

    @property
    def key(self) -> str:
        """Key of this line in a scenario."""
        return LINE if self.line in (None, LINE) else f"lines.{self.line}"


class StudyFile(Part):
    """A study file of format 1."""

    format: Literal[1] = Field(description="Version of the file format.")
    name: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")] = Field(
        description="Short name."
    )
    description: str = Field(default="", description="What the study is about.")
    scenario: str = Field(description="Scenario file that all cases start from, next to the study.")
    design: Literal["grid", "latin-hypercube", "sobol"] = Field(
        description="How cases are drawn: all combinations, or a number of points of the space."
    )
    cases: Whole | None = Field(
        default=None, ge=1, le=10_000_000, description="Number of cases; a grid has its own."
    )
    seed: Whole = Field(default=0, ge=0, description="Seed of the random numbers.")
    set: Settings = Field(default={}, description="Values that all cases share, by key path.")
    vary: dict[str, Variation] = Field(default={}, description="What varies, by key path.")
    choices: dict[str, Annotated[dict[Name, Settings], Field(min_length=1)]] = Field(
        default={}, description="Sets of values that vary together, by name and option."
    )
    gradients: Gradients | None = Field(default=None, description="Gradient profiles to draw.")

    @model_validator(mode="after")
    def _can_be_drawn(self) -> Self:
        if self.design == "grid" and self.cases is not None:
            raise fault("a grid has as many cases as combinations", "leave cases out")
        if self.design != "grid" and self.cases is None:
            raise fault(f"the {self.design} needs a number of cases", "add cases = 256")
        if not (self.vary or self.choices or self.gradients):
            raise fault("nothing varies", "add a table vary, choices or gradients")
        for name in sorted(set(self.vary) & set(self.choices)):
            raise fault(f"{name} is in vary and in choices", "leave one of them out")
        return self

    @property
    def varied(self) -> list[tuple[str, str, Any]]:
        """Key paths of all that varies, where they stand in the file, and the values at their ends."""
        ranges = [
            (path, f"vary.{path}", value)
            for path, variation in self.vary.items()
            for value in variation.ends
        ]
        return ranges + [
            (path, f"choices.{name}.{option}.{path}", value)
            for name, options in self.choices.items()
            for option, settings in options.items()
            for path, value in settings.items()
        ]


@dataclass(frozen=True)
class Study:
    """A study with its base scenario, ready to draw cases from."""

    file: StudyFile
    base: dict[str, Any]
    """Document of the base scenario, with the files that it names."""
    source: Path
    """The study file."""
    base_source: Path
    timetables: dict[str, str] = field(default_factory=dict)
    """Texts of timetables by the names of their files, if timetables vary."""
    given: str = ""
    """The study file as it was named, by which findings name it; empty: by its absolute path."""

    @property
    def digest(self) -> str:
        """Digest of everything that determines a case.

        A Sobol sequence can be continued, so the number of its cases does not count.
        """
        document = self.file.model_dump(mode="json")
        for key in ("name", "description", *(["cases"] if self.file.design == "sobol" else [])):
            del document[key]
        drawn = document["gradients"]
        if drawn is not None and drawn["line"] is None:
            del drawn["line"]  # a study of one line has the digest that it always had
        more: list[Any] = [self.timetables] if self.timetables else []
        if laws := laws_named([document, self.base]):
            more.append(laws)
        text = json.dumps([document, self.base, *more], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def named_as_given(self) -> AbstractContextManager[None]:
        """Let findings name the study's files as the user did."""
        return named_as_given(self.source, self.given or str(self.source))

    def as_json(self) -> str:
        """The study as text, from which `study_of_json` restores it, on any computer."""
        return json.dumps(
            {
                "file": self.file.model_dump(mode="json", exclude_none=True),
                "base": self.base,
                "source": str(self.source),
                "base_source": str(self.base_source),
                "timetables": self.timetables,
                "given": self.given,
            }
        )


def study_of_json(text: str) -> Study:
    """Study from the text of `Study.as_json`."""
    parts = json.loads(text)
    return Study(
        file=StudyFile.model_validate(parts["file"]),
        base=parts["base"],
        source=Path(parts["source"]),
        base_source=Path(parts["base_source"]),
        timetables=parts.get("timetables", {}),
        given=parts.get("given", ""),
    )


def load_study(path: str | Path) -> Study:
    """Study of a TOML file, with its base scenario.

    Raises
    ------
    ScenarioError
        The file, or the scenario that it names, cannot be read or has faults; all are listed.
    """
    source = Path(path)
    document = read_toml(source)
    demand_no_scenario(document, source, "a study")
    for key in ("set", "vary"):
        if isinstance(document.get(key), dict):
            document[key] = flattened(document[key], is_variation=key == "vary")
    for options in _tables(document.get("choices")):
        for name, settings in options.items():
            if isinstance(settings, dict):
                options[name] = flattened(settings, is_variation=False)
    file = validate(StudyFile, document, source)
    base_source = source.parent / file.scenario
    base, timetables = _load_base(base_source, source, file)
    _demand_variable(file, base, source)
    return Study(file, base, source.absolute(), base_source.absolute(), timetables, str(source))


def _demand_variable(file: StudyFile, base: Mapping[str, Any], source: Path) -> None:
    """Refuse to vary what no case depends on.

    Raises
    ------
    ScenarioError
    """
    paths = {path: f"set.{path}" for path in file.set} | {path: key for path, key, _ in file.varied}
    drawn = file.gradients
    faults = list(faults_of_paths(paths, file.set, base, drawn.key if drawn else "", source))
    if drawn is not None:
        faults += fault_of_drawn_line(drawn.line, base, source)
    if faults:
        raise ScenarioError(faults)


def _load_base(
    base_source: Path, source: Path, file: StudyFile
) -> tuple[dict[str, Any], dict[str, str]]:
    """Document of a valid base scenario with what all cases share, and with the files that it names.

    Timetables that vary stay in it, and the texts of their files are given too; what all cases share is
    then set in each of them, as it may concern the trains of timetables.
    """
    document = _valid_base(base_source, source, file.scenario)
    varied = [(path, value) for path, _, value in file.varied]
    own = {path: value for path, value in file.set.items() if is_of_timetables(path)}
    _set(document, own, source, base_source)
    texts = texts_of(document, varied, base_source)
    kept = copy_of(document.get(TIMETABLES, []))
    inlined = inline_files(document, base_source)
    if inlined.findings:
        raise ScenarioError(inlined.findings)
    base = copy_of(inlined.document)
    base.pop(TIMETABLES, None)  # its trains are entries of the traffic now
    _set(base, {path: v for path, v in file.set.items() if path not in own}, source, base_source)
    if texts:
        document.pop(TIMETABLES, None)
        base = inline_files(document, base_source).document | {TIMETABLES: kept}
    return base, texts


def _valid_base(base_source: Path, source: Path, name: str) -> dict[str, Any]:
    """Document of a valid scenario, as it was written."""
    try:
        document = read_toml(base_source)
        Scenario.from_document(document, base_source)
    except ScenarioError as error:
        problem = f"the base scenario has {len(error.findings)} fault(s), listed below"
        remedy = "correct them, or name another scenario"
        first = Finding(str(source), "scenario", repr(name), problem, remedy)
        raise ScenarioError([first, *error.findings]) from error
    return document


def _set(document: dict[str, Any], settings: Settings, source: Path, base_source: Path) -> None:
    """Put values that all cases share into the base; its faults are now those of the study."""
    if not settings:
        return
    try:
        apply(document, settings, source)
        Scenario.from_document(document, base_source)
    except ScenarioError as error:
        findings = [replace(f, file=str(source), key=f"set.{f.key}") for f in error.findings]
        raise ScenarioError(findings) from error


def _tables(value: Any) -> list[dict[str, Any]]:
    tables = value.values() if isinstance(value, dict) else ()
    return [table for table in tables if isinstance(table, dict)]
