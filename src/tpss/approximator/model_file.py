"""The file of an approximator: JSON of numbers and text, which is checked and never executed."""

import json
import tempfile
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, ValidationError, model_validator

from tpss.approximator.domain import Domain, fits
from tpss.approximator.inputs import Inputs
from tpss.approximator.network import Ensemble
from tpss.errors import ApproximatorError, Finding, ScenarioError, shortened
from tpss.files.checked import takes_checksum, with_checksum
from tpss.files.json_text import parse_json
from tpss.files.read import read_bytes
from tpss.files.refusals import ANOTHER, explained, reason
from tpss.files.whole import write_file
from tpss.scenario.fields import Name, Part, Real, Whole, fault

FORMAT, VERSION = "tpss-approximator", 3

READ = (2, VERSION)
"""Versions of the format that are read: the second does not say what was left out."""

MOST_BYTES = 200_000_000
"""Largest file that is read: a hundred times as large as those that are written. [byte]"""

MOST_WEIGHT = 1e9
"""Largest weight of a network whose inputs and outputs are scaled to 1."""


class Weights(Part):
    """Weights of an `Ensemble`."""

    w0: tuple[tuple[tuple[Real, ...], ...], ...]
    w1: tuple[tuple[tuple[Real, ...], ...], ...]
    b1: tuple[tuple[Real, ...], ...]
    w2: tuple[tuple[tuple[Real, ...], ...], ...]
    b2: tuple[tuple[Real, ...], ...]

    @model_validator(mode="after")
    def _have_one_shape(self) -> Self:
        try:
            shapes = [np.array(each, dtype=float).shape for each in self._all()]
            (m0, i0, o0), (m, i, n), (m1, n1), (m2, n2, o), (m3, o3) = shapes
        except ValueError:
            raise fault("weights that are not tables of numbers", REMEDY) from None
        if max(float(np.abs(each).max(initial=0.0)) for each in self._all()) > MOST_WEIGHT:
            raise fault("weights beyond all use", REMEDY)
        if not (m and m == m0 == m1 == m2 == m3 and i == i0 and n == n1 == n2 and o == o0 == o3):
            raise fault(f"weights of shapes {shapes}, which do not fit together", REMEDY)
        return self

    def _all(self) -> tuple[Any, ...]:
        return self.w0, self.w1, self.b1, self.w2, self.b2

    def ensemble(self) -> Ensemble:
        """The ensemble."""
        return Ensemble(*(np.array(each, dtype=float) for each in self._all()))


REMEDY = "train it again, or fetch the file again from where it came from"


class Output(Part):
    """An output of an approximator, and its uncertainty."""

    name: Name
    scale: Literal["linear", "log", "drop"]
    """Whether the networks use the value, its logarithm, or that of its distance below `reference`."""
    reference: Real
    """Reference of drops."""
    low: Real
    high: Real
    """Transformed values that are scaled to -1 and 1."""
    usual: Annotated[Real, Field(gt=0)]
    """How far the members disagree at most in most cases, in sizes of the errors."""
    factor: Annotated[Real, Field(ge=0)]
    """Half the interval, in deviations."""


class Score(Part):
    """How well an output was predicted in cases that were held out."""

    name: Name
    unit: Literal["%", ""]
    """% if the errors are relative."""
    median: Real
    ninetieth: Real
    """90th percentile of the errors."""
    coverage: Real
    """Share of the cases inside their intervals."""
    half_width: Real
    """Median of half the interval."""
    linear_ninetieth: Real | None
    nearest_ninetieth: Real | None
    """90th percentile of the errors of linear regression, and of the nearest trained case."""


class CollapseScore(Part):
    """How well collapses were predicted, in cases that were held out."""

    share: Real
    """Of the cases that collapsed or stalled."""
    accuracy: Real
    brier: Real
    linear_accuracy: Real | None
    nearest_accuracy: Real | None


class Data(Part):
    """What an approximator was trained on."""

    study: Name
    study_hash: Name
    cases: Whole
    """Cases of the study's table."""
    used: Whole
    """Cases that were simulated and passed their audit."""
    carried: Whole
    """Of these, cases in which the line carried its load."""
    held_out: tuple[Whole, ...]
    """Numbers of the cases that were not trained on."""
    time_step_min: Real
    seed: Whole
    tpss_version: Name
    kernel_hash: Name
    """Of the program that made the table."""
    definition: str = ""
    """The study as text, from which its cases can be made; empty if that is not known."""


class ModelFile(Part):
    """An approximator."""

    format: Literal["tpss-approximator"]
    version: Literal[2, 3]
    made_by: dict[Name, Name]
    """Versions of the programs that trained it."""
    form: Name
    data: Data
    inputs: Inputs
    domain: Domain
    outputs: Annotated[tuple[Output, ...], Field(min_length=1)]
    left_out: tuple[Name, ...] = ()
    """What the study varies and the inputs do not describe: its effect is in the intervals only."""
    untold: tuple[Name, ...] = ()
    """Figures that some cases lack, or that are the same in all: they are not predicted."""
    tried: dict[Name, dict[Name, Real]]
    """Errors for cases not seen, by what the networks predict and by their number of neurons."""
    figures: Weights
    noise: Weights
    """Networks that predict the logarithm of the size of the figures' errors."""
    collapse: Weights | None
    """None if the line carried its load in every case."""
    scores: tuple[Score, ...]
    collapse_score: CollapseScore | None

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        names = [each.name for each in self.inputs.varying]
        if len(set(names)) < len(names):
            raise fault("an input that occurs twice", REMEDY)
        if not {each.of for each in self.inputs.multiples} <= set(names):
            raise fault("a multiple of something that is not an input", REMEDY)
        if any(each.factor == 0.0 for each in self.inputs.multiples):
            raise fault("a multiple by 0", REMEDY)
        if any(each.kind == "number" and not each.low < each.high for each in self.inputs.varying):
            raise fault("an input without a range", REMEDY)
        logs = [
            each for each in self.inputs.varying if each.kind == "number" and each.scale == "log"
        ]
        if any(each.low <= 0.0 for each in logs):
            raise fault("a logarithm of a number that is not positive", REMEDY)
        if not fits(self.domain, self.inputs):
            raise fault("a domain of other inputs", REMEDY)
        count = len(self.outputs)
        for weights, outputs in ((self.figures, count), (self.noise, count), (self.collapse, 1)):
            shape = None if weights is None else (len(weights.w1[0]), len(weights.b2[0]))
            if shape not in (None, (self.inputs.width, outputs)):
                raise fault("networks of other inputs or outputs", REMEDY)
        return self


def read_model(path: Path) -> ModelFile:
    """The content of an approximator's file.

    Raises
    ------
    ApproximatorError
        It cannot be read, or is not such a file.
    ScenarioError
        It is one, and damaged; all faults are listed.
    """
    document = _document(path)
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise ApproximatorError(
            f"{path} is not the file of an approximator; name one that tpss approximate train has "
            "written"
        )
    if document.get("version") not in READ:
        raise ApproximatorError(
            f"{path} was written by another version of TPSS: its format is {document.get('version')!r}, "
            f"this version reads {' and '.join(map(str, READ))}; train it again"
        )
    is_as_written = takes_checksum(document)
    try:
        model = ModelFile.model_validate(document)
    except ValidationError as error:
        raise ScenarioError([_finding(dict(d), path) for d in error.errors()]) from error
    if not is_as_written:
        raise ApproximatorError(f"{path} is damaged: its checksum is another; {REMEDY}")
    return model


def _document(path: Path) -> Any:
    try:
        return parse_json(read_bytes(path, MOST_BYTES))
    except OSError as error:
        raise ApproximatorError(f"{path} cannot be read: {reason(error)}") from error
    except ValueError as error:
        raise ApproximatorError(
            f"{path} is not the file of an approximator, or damaged ({error}); {REMEDY}"
        ) from error


def _finding(detail: dict[str, Any], path: Path) -> Finding:
    key = ".".join(str(part) for part in detail["loc"])
    value = shortened(repr(detail["input"])) if detail["type"] != "missing" else ""
    return Finding(str(path), key, value, f"the file is damaged: {detail['msg']}", REMEDY)


def check_target(path: Path, force: bool) -> None:
    """Refuse a file that could not be written, before the work begins.

    Raises
    ------
    ApproximatorError
    """
    with _unwritable(path):
        if path.is_dir():
            raise ApproximatorError(f"{path} is a folder; give --out the name of a file")
        if path.exists() and not force:
            raise ApproximatorError(f"{path} exists; {ANOTHER}, or --force to replace it")
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path.parent):
            pass


def write_bytes(path: Path, content: bytes) -> None:
    """Write a file, whole or not at all.

    Raises
    ------
    ApproximatorError
    """
    with _unwritable(path):
        write_file(path, content)


def _unwritable(path: Path) -> AbstractContextManager[None]:
    """Raise an error of the system as one of an approximator's file."""
    return explained(path, f"free space, or {ANOTHER}", ApproximatorError)


def text_of_model(model: ModelFile) -> str:
    """The file as text, with all digits of its numbers, and a checksum."""
    checked = with_checksum(model.model_dump(mode="json"))
    return json.dumps(checked, indent=None, separators=(",", ":")) + "\n"
