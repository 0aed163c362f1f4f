"""Validation cases as data: a folder states what was published, what we run, and how close we must come.

A folder holds

- ``README.md``: a title, and the paragraphs **Source.**, **Stated.** and **Assumed.**: where the figures
  stand, what their scenario is, what had to be assumed and why;
- ``scenario.toml``: a scenario file, and the values that each run and each variant change in it, by the
  key paths of ``tpss run --set``;
- ``expected.toml``: the published value of each quantity in each run, with a tolerance and its reason,
  known misses with their explanation, and the figures to draw.

A folder that lacks any of these is refused, by a `CaseError` that says what to add.
"""

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal, Self, TypeVar

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    ValidationError,
    model_validator,
)

import tpss

from measures import MEASURES

HERE = Path(__file__).parent
PARAGRAPHS = ("Source", "Stated", "Assumed")


def _one_line(text: object) -> object:
    """A text without its line breaks."""
    return " ".join(text.split()) if isinstance(text, str) else text


Prose = Annotated[str, StringConstraints(min_length=20), BeforeValidator(_one_line)]
Changes = dict[str, Any]


class CaseError(Exception):
    """A validation folder is not complete; the message says what is missing."""


class Part(BaseModel):
    """A table of a case's files."""

    model_config = ConfigDict(frozen=True, extra="forbid")


Kind = TypeVar("Kind", bound=Part)


class Plan(Part):
    """What is run: ``scenario.toml``."""

    base: str
    remove: tuple[str, ...] = ()
    changes: Changes = {}
    runs: dict[str, Changes] = Field(min_length=1)
    variants: dict[str, Changes] = Field(min_length=1)


class Quantity(Part):
    """A quantity, its published value in each run, and the rule by which ours agrees."""

    name: str
    unit: str
    decimals: int
    measure: str
    arguments: dict[str, float | str] = {}
    against: str | None = None
    published: dict[str, float] = Field(min_length=1)
    within: float | None = Field(default=None, ge=0)
    within_percent: float | None = Field(default=None, ge=0)
    bound: Literal["at least", "at most"] | None = None
    shown_only: Literal["absolute", "percent"] | None = None
    reason: Prose

    @model_validator(mode="after")
    def _one_rule(self) -> Self:
        rules = (self.within, self.within_percent, self.bound, self.shown_only)
        if sum(rule is not None for rule in rules) != 1:
            raise ValueError("give one of within, within_percent, bound, shown_only")
        return self

    @property
    def in_percent(self) -> bool:
        """Whether differences are relative to the published value."""
        return self.within_percent is not None or self.shown_only == "percent"

    def difference(self, published: float, ours: float) -> float:
        """Ours less published, in percent of the published value or in the quantity's unit."""
        return 100.0 * (ours / published - 1.0) if self.in_percent else ours - published

    def agrees(self, published: float, ours: float) -> bool | None:
        """Whether ours agrees; None for what is only shown."""
        rounding = 1e-9 * max(1.0, abs(published))
        if self.shown_only is not None:
            return None
        if self.bound is not None:
            excess = ours - published if self.bound == "at most" else published - ours
            return excess <= rounding
        allowed = self.within if self.within is not None else self.within_percent
        return allowed is not None and abs(self.difference(published, ours)) <= allowed + rounding


class Miss(Part):
    """A known disagreement, and the best explanation that there is."""

    quantity: str
    run: str
    variants: tuple[str, ...] = Field(min_length=1)
    explanation: Prose


class Drawing(Part):
    """A figure to draw from runs of the case."""

    draw: Literal["journey", "voltage_along_line", "station_powers", "station_loading", "stop"]
    runs: tuple[str, ...] = Field(min_length=1)
    variants: tuple[str, ...] = Field(min_length=1)
    arguments: dict[str, float | str] = {}
    caption: Prose


class Expectation(Part):
    """What is expected: ``expected.toml``."""

    quantities: tuple[Quantity, ...] = Field(min_length=1)
    misses: tuple[Miss, ...] = ()
    figures: tuple[Drawing, ...] = ()


class Case(Part):
    """A validation case."""

    name: str
    title: str
    text: str
    folder: Path
    plan: Plan
    expected: Expectation

    def scenario(self, run: str, variant: str) -> tpss.Scenario:
        """Scenario of a run in a variant."""
        plan = self.plan
        changes = {**plan.changes, **plan.variants[variant], **plan.runs[run]}
        changes.update(dict.fromkeys(plan.remove))
        return tpss.load_scenario(self.folder / plan.base, changes)

    def checks(self) -> Iterator[tuple[Quantity, str, str]]:
        """Every quantity with every run and variant in which it is compared."""
        for quantity in self.expected.quantities:
            for run in quantity.published:
                for variant in self.plan.variants:
                    yield quantity, run, variant

    def miss(self, quantity: Quantity, run: str, variant: str) -> Miss | None:
        """The known miss of a quantity in a run and variant, if it is one."""
        for miss in self.expected.misses:
            if (miss.quantity, miss.run) == (quantity.name, run) and variant in miss.variants:
                return miss
        return None


def load_case(folder: Path) -> Case:
    """Case of a folder.

    Raises
    ------
    CaseError
        A file, a paragraph of provenance, or the reason of a tolerance is missing, or the files
        contradict each other.
    """
    title, text = _read_readme(folder)
    plan = _read_toml(folder, "scenario.toml", Plan)
    expected = _read_toml(folder, "expected.toml", Expectation)
    case = Case(
        name=folder.name, title=title, text=text, folder=folder, plan=plan, expected=expected
    )
    _check_names(case)
    return case


def load_cases() -> list[Case]:
    """All cases, by their names."""
    folders = [folder for folder in HERE.iterdir() if (folder / "scenario.toml").exists()]
    return [load_case(folder) for folder in sorted(folders, key=_natural_order)]


def _natural_order(folder: Path) -> list[Any]:
    kind = ("Table" in folder.name, "Figure" in folder.name)
    pieces = re.split(r"(\d+)", folder.name)
    return [not kind[0], not kind[1], *(int(p) if p.isdigit() else p for p in pieces)]


def _read_readme(folder: Path) -> tuple[str, str]:
    file = folder / "README.md"
    if not file.is_file():
        raise CaseError(f"{folder.name}: README.md is missing; say where the figures come from")
    heading, _, text = file.read_text("utf-8").partition("\n")
    if not heading.startswith("# "):
        raise CaseError(f"{folder.name}: README.md begins without a title; begin it with '# Title'")
    for name in PARAGRAPHS:
        if not re.search(rf"^\*\*{name}\.\*\* \S", text, re.M):
            problem = f"README.md has no paragraph '**{name}.** ...'"
            raise CaseError(f"{folder.name}: {problem}; a case without provenance proves nothing")
    return heading.removeprefix("# ").strip(), text.strip()


def _read_toml(folder: Path, name: str, kind: type[Kind]) -> Kind:
    file = folder / name
    if not file.is_file():
        raise CaseError(f"{folder.name}: {name} is missing")
    document = tomllib.loads(file.read_text("utf-8"))
    try:
        return kind.model_validate(document)
    except ValidationError as error:
        faults = [_in_words(document, fault) for fault in error.errors()]
        raise CaseError("\n".join(f"{folder.name}: {name}: {fault}" for fault in faults)) from error


def _in_words(document: dict[str, Any], fault: Any) -> str:
    place = ".".join(str(key) for key in fault["loc"])
    if fault["loc"][:1] == ("quantities",) and len(fault["loc"]) > 1:
        quantity = document["quantities"][fault["loc"][1]].get("name", "without a name")
        place = f"{place} ({quantity})"
    remedy = ""
    if fault["loc"][-1:] == ("reason",):
        remedy = "; a tolerance without a reason is an opinion: say why it is as wide as it is"
    return f"{place}: {fault['msg']}{remedy}"


def _check_names(case: Case) -> None:
    """Raise a `CaseError` if a run, variant, measure or quantity is named that is not there."""
    runs, variants = set(case.plan.runs), set(case.plan.variants)
    used = [(set(q.published) | ({q.against} - {None}), set()) for q in case.expected.quantities]
    used += [(set(d.runs), set(d.variants)) for d in case.expected.figures]
    used += [({m.run}, set(m.variants)) for m in case.expected.misses]
    for named_runs, named_variants in used:
        if unknown := (named_runs - runs) | (named_variants - variants):
            names = ", ".join(sorted(unknown))
            raise CaseError(f"{case.name}: expected.toml names {names}, which is not run")
    measures = {quantity.measure for quantity in case.expected.quantities}
    if unknown := measures - set(MEASURES):
        known = ", ".join(MEASURES)
        raise CaseError(f"{case.name}: no measure {', '.join(sorted(unknown))}; there are {known}")
    names = {quantity.name for quantity in case.expected.quantities}
    if unknown := {miss.quantity for miss in case.expected.misses} - names:
        raise CaseError(f"{case.name}: a miss of {', '.join(sorted(unknown))}, no such quantity")
