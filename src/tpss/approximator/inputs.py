"""Which inputs an approximator has, and how they become the numbers of its networks."""

import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
import pandas as pd
from pydantic import Field

from tpss.approximator.forms import NAMED_CATENARY, OWN, Form
from tpss.approximator.network import Array
from tpss.errors import ApproximatorError, Finding, ScenarioError, suggest
from tpss.scenario.fields import Name, Part, Real

SAME = 1e-9
"""Relative difference up to which two numbers count as equal: files round them."""

FEW = 8
"""Up to so many different values of a number are levels, each with its own cell."""


class NumberInput(Part):
    """An input that is a number."""

    kind: Literal["number"] = "number"
    name: Name
    scale: Literal["linear", "log"] = "linear"
    """Whether the networks use the value or its logarithm."""
    low: Real
    high: Real
    edges: tuple[Real, ...]
    """Limits between the cells of the domain."""

    @property
    def cells(self) -> int:
        """Number of cells."""
        return len(self.edges) + 1

    def cell(self, values: Any) -> Any:
        """Cell of each value."""
        return np.searchsorted(self.edges, values)

    def inside(self, values: Any) -> Any:
        """Whether each value lies in the trained range."""
        slack = SAME * max(abs(self.low), abs(self.high))
        return (values >= self.low - slack) & (values <= self.high + slack)

    def scaled(self, values: Any) -> Array:
        """Values scaled to [-1, 1], a column; NaN where a logarithm does not exist.

        References
        ----------
        [Boullanger2009]_, eq. (C.1).
        """
        low, high = self.low, self.high
        if self.scale == "log":
            values = np.log(np.where(values > 0.0, values, np.nan))
            low, high = math.log(low), math.log(high)
        return np.asarray(2.0 * (values - low) / (high - low) - 1.0)[:, None]

    @property
    def range(self) -> str:
        """The trained values, in words."""
        return f"{self.low:.5g} to {self.high:.5g}"


class ChoiceInput(Part):
    """An input that is one of some values."""

    kind: Literal["choice"] = "choice"
    name: Name
    values: Annotated[tuple[Name, ...], Field(min_length=2)]

    @property
    def cells(self) -> int:
        """Number of cells, one per value."""
        return len(self.values)

    def cell(self, values: Any) -> Any:
        """Place of each value, 0 if it is none of them."""
        places = np.zeros(len(values), dtype=np.int64)
        for place, value in enumerate(self.values):
            places[values == value] = place
        return places

    def inside(self, values: Any) -> Any:
        """Whether each value is one of them."""
        return np.isin(values, self.values)

    def scaled(self, values: Any) -> Array:
        """A column for each value but the first, 1 where it occurs and -1 elsewhere."""
        return np.column_stack([2.0 * (values == value) - 1.0 for value in self.values[1:]])

    @property
    def range(self) -> str:
        """The trained values, in words."""
        return " or ".join(self.values)


Input = Annotated[NumberInput | ChoiceInput, Field(discriminator="kind")]


class Multiple(Part):
    """A column that was always the same multiple of an input, and may be given in its place."""

    name: Name
    of: Name
    factor: Real


class Inputs(Part):
    """All inputs of an approximator."""

    varying: Annotated[tuple[Input, ...], Field(min_length=1)]
    multiples: tuple[Multiple, ...]
    fixed: dict[Name, Real | Name]
    """Inputs that were the same in all cases."""

    def read(self, table: Mapping[str, Any], place: str) -> "Given":
        """Values of the inputs from columns of a table; `place` is where they come from.

        Raises
        ------
        ScenarioError
            A column is unknown, missing, or not of numbers; all faults are listed.
        """
        findings, columns = [], {}
        for name, values in table.items():
            if not self.has(name):
                findings.append(self._unknown(name, values, place))
                continue
            try:
                columns[name] = _plain(values, is_text=self._is_text(name))
            except ValueError as error:
                problem, remedy = "not a number", "write a plain number, without a unit"
                findings.append(Finding(place, name, str(error), problem, remedy))
        given = {name for name in table if self.has(name)}
        for each in self.varying:
            if not given & {each.name, *self._multiples_of(each.name)}:
                known = ", ".join(item.name for item in self.varying)
                remedy = f"give it ({each.range}); the inputs are {known}"
                findings.append(Finding(place, each.name, "", "this input is missing", remedy))
        if findings:
            raise ScenarioError(findings)
        inputs = {each.name: self._input(each.name, columns) for each in self.varying}
        return Given(inputs, columns)

    def _input(self, name: str, columns: Mapping[str, Any]) -> Any:
        """Values of an input, from its own column or that of a multiple."""
        if name in columns:
            return columns[name]
        other, factor = next(
            (other, factor)
            for other, factor in self._multiples_of(name).items()
            if other in columns
        )
        return columns[other] / factor

    def _multiples_of(self, name: str) -> dict[str, float]:
        return {each.name: each.factor for each in self.multiples if each.of == name}

    def _is_text(self, name: str) -> bool:
        is_choice = any(each.name == name and each.kind == "choice" for each in self.varying)
        return is_choice or isinstance(self.fixed.get(name), str)

    def has(self, name: str) -> bool:
        """Whether a name is an input, or a multiple of one, or was the same in all cases."""
        names = {each.name for each in (*self.varying, *self.multiples)}
        return name in names or name in self.fixed

    def _unknown(self, name: str, values: Any, place: str) -> Finding:
        known = [each.name for each in (*self.varying, *self.multiples)] + list(self.fixed)
        value = str(next(iter(values), ""))
        problem = "this approximator has no such input"
        return Finding(place, name, value, problem, suggest(name, known))

    def conflicts(self, given: "Given") -> list["Conflict"]:
        """Columns whose values contradict what was always so in the trained cases."""
        conflicts = []
        for name, value in self.fixed.items():
            if name in given.columns:
                values = given.columns[name]
                same = values == value if isinstance(value, str) else _same(values, value)
                conflicts.append(Conflict(name, values, ~same, f"trained at {shown(value)} only"))
        for each in self.multiples:
            if each.name in given.columns:
                values = given.columns[each.name]
                same = _same(values, each.factor * given.inputs[each.of])
                words = f"it was always {each.factor:.6g} times {each.of} where it was trained"
                conflicts.append(Conflict(each.name, values, ~same, words))
        return conflicts

    def encode(self, inputs: Mapping[str, Any]) -> Array:
        """Numbers of the networks, shape (rows, numbers)."""
        return np.column_stack([each.scaled(inputs[each.name]) for each in self.varying])

    @property
    def width(self) -> int:
        """How many numbers the networks are given."""
        return sum(1 if each.kind == "number" else each.cells - 1 for each in self.varying)


class Given(NamedTuple):
    """Values of the inputs to predict from, and all columns as they were given."""

    inputs: dict[str, Any]
    columns: dict[str, Any]

    @property
    def rows(self) -> int:
        """Number of cases."""
        return len(next(iter(self.inputs.values())))


class Conflict(NamedTuple):
    """Values of a column, which of them do not fit, and what would."""

    name: str
    values: Any
    wrong: Any
    words: str


def _plain(column: Any, *, is_text: bool) -> Any:
    """A column as numbers or as text; a `ValueError` holds the first value that is no number."""
    values = np.asarray(column)
    if is_text and values.dtype.kind == "U":
        return values.astype(object)
    if is_text and values.dtype.kind == "b":
        return np.where(values, "true", "false").astype(object)
    if is_text:
        return np.array([text_of(value) for value in values.tolist()], dtype=object)
    with suppress(TypeError, ValueError):
        numbers = values.astype(float)
        if values.dtype != bool and np.isfinite(numbers).all():
            return numbers
    raise ValueError(repr(next(v for v in values.tolist() if not _is_number(v))))


def _same(values: Any, expected: Any) -> Any:
    return np.isclose(values, expected, rtol=SAME, atol=SAME)


def _is_number(value: Any) -> bool:
    if isinstance(value, bool):
        return False
    try:
        return math.isfinite(float(value))
    except (TypeError, ValueError):
        return False


def shown(value: Any) -> str:
    """A number or a text as messages show it."""
    return value if isinstance(value, str) else f"{value:.6g}"


def text_of(value: Any) -> str:
    """A value of a choice as text: true and false as in the files of a study."""
    return str(value).lower() if isinstance(value, bool | np.bool_) else str(value)


def inputs_of_table(table: pd.DataFrame, form: Form) -> Inputs:
    """Inputs that vary in a table.

    Raises
    ------
    ApproximatorError
        Nothing varies, or an input has no value in some of the cases.
    """
    numbers, choices = _candidates(table, form)
    varying: list[NumberInput | ChoiceInput] = []
    multiples: list[Multiple] = []
    fixed: dict[str, float | str] = {}
    for name in numbers:
        column = table[name].to_numpy(dtype=float)
        if np.ptp(column) <= SAME * np.abs(column).max():
            fixed[name] = float(column[0])
            continue
        multiple = _multiple(name, column, varying, table)
        if multiple is not None:
            multiples.append(multiple)
        else:
            varying.append(_number_input(name, column))
    for name in choices:
        values = sorted({text_of(value) for value in table[name].tolist()})
        if len(values) == 1:
            fixed[name] = values[0]
        else:
            varying.append(ChoiceInput(name=name, values=tuple(values)))
    if not varying:
        raise ApproximatorError("no input varies in the table; vary more in the study")
    return Inputs(varying=tuple(varying), multiples=tuple(multiples), fixed=fixed)


def _candidates(table: pd.DataFrame, form: Form) -> tuple[list[str], list[str]]:
    """Numbers and choices of which the table holds values.

    Catenaries of the library are distinguished by their names, others by their impedances.
    """
    absent = [name for name in (*form.numbers, *form.choices) if name not in table]
    if absent:
        raise ApproximatorError(
            f"the table has no column {', '.join(absent)}; it is of another version of TPSS: run the "
            "study again"
        )
    is_named = NAMED_CATENARY not in table or OWN not in set(table[NAMED_CATENARY])
    impedances = [name for name in form.numbers if name.startswith(("catenary_", "connection_"))]
    numbers = [name for name in form.numbers if not (is_named and name in impedances)]
    choices = [name for name in form.choices if is_named or name != NAMED_CATENARY]
    known = [name for name in numbers if table[name].notna().any()]
    gaps = {name: int(table[name].isna().sum()) for name in known}
    incomplete = [f"{name} in {count} case(s)" for name, count in gaps.items() if count]
    if incomplete:
        raise ApproximatorError(
            f"inputs without a value: {', '.join(incomplete)}; split the study there"
        )
    return known, choices


def _multiple(
    name: str, column: Array, varying: Sequence[NumberInput | ChoiceInput], table: pd.DataFrame
) -> Multiple | None:
    for each in varying:
        if each.kind == "number":
            other = table[each.name].to_numpy(dtype=float)
            k = int(np.abs(other).argmax())
            factor = float(column[k] / other[k])
            if factor and np.allclose(column, factor * other, rtol=SAME, atol=SAME):
                return Multiple(name=name, of=each.name, factor=factor)
    return None


def _number_input(name: str, column: Array) -> NumberInput:
    low, high = float(column.min()), float(column.max())
    # Effects of loads and impedances multiply; those of gradients do not.
    scale = "log" if low > 0.0 and not name.endswith("_permille") else "linear"
    levels = np.unique(column)
    if len(levels) <= FEW:
        edges = (levels[:-1] + levels[1:]) / 2.0
    else:
        # A dozen cases in each cell of two inputs leave none of them empty by chance.
        cells = max(1, min(FEW, math.isqrt(len(column) // 12)))
        edges = np.linspace(low, high, cells + 1)[1:-1]
    return NumberInput(name=name, scale=scale, low=low, high=high, edges=tuple(edges.tolist()))
