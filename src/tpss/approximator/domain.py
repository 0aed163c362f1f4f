"""Domain of an approximator: the region of its inputs that the trained cases fill."""

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import combinations
from typing import Annotated, Any

import numpy as np
from pydantic import StringConstraints

from tpss.approximator.inputs import ChoiceInput, Conflict, Given, Inputs, NumberInput, shown
from tpss.scenario.fields import Part

Cells = Annotated[str, StringConstraints(pattern=r"^[01]+(/[01]+)*$")]
"""Cells of two inputs, 1 where trained cases lie: a row for each of the first, rows apart by /."""

_Input = NumberInput | ChoiceInput


class Domain(Part):
    """The range of every input, and for every two inputs the cells in which trained cases lie.

    Two inputs may each be in range and yet never have been seen together, such as an AT catenary
    with a number of transformers that only BT lines had.  Combinations of three inputs are not checked.
    """

    pairs: tuple[Cells, ...]
    """For every two inputs, the first with each later one, then the second, and so on."""

    def objections(self, given: Given, inputs: Inputs) -> list[str]:
        """Reasons why each row lies outside; empty where it does not."""
        reasons: dict[int, list[str]] = {}
        for wrong, words in self._faults(given, inputs):
            for row in np.flatnonzero(wrong).tolist():
                reasons.setdefault(row, []).append(words(row))
        if not reasons:
            return [""] * given.rows
        return ["; ".join(reasons.get(row, ())) for row in range(given.rows)]

    def _faults(self, given: Given, inputs: Inputs) -> Iterator[tuple[Any, Callable[[int], str]]]:
        """Possible reasons: which rows they apply to, and their text for a row."""
        for each in inputs.varying:
            values = given.inputs[each.name]
            yield ~each.inside(values), partial(_out_of_range, each, values)
        for conflict in inputs.conflicts(given):
            yield conflict.wrong, partial(_in_conflict, conflict)
        for one, other, seen in self._together(given.inputs, inputs):
            yield ~seen, partial(_never_together, one, other, given.inputs)

    def _together(
        self, values: Mapping[str, Any], inputs: Inputs
    ) -> Iterator[tuple[_Input, _Input, Any]]:
        """For every two inputs, whether their values were seen together."""
        cells = [each.cell(values[each.name]) for each in inputs.varying]
        numbered = combinations(range(len(cells)), 2)
        for (i, j), pair in zip(numbered, self.pairs, strict=True):
            filled = _table(pair)
            if not filled.all():
                yield inputs.varying[i], inputs.varying[j], filled[cells[i], cells[j]]


def domain_of(values: Mapping[str, Any], inputs: Inputs) -> Domain:
    """Domain that the trained cases fill."""
    cells = [(each.cell(values[each.name]), each.cells) for each in inputs.varying]
    pairs = []
    for (first, rows), (second, columns) in combinations(cells, 2):
        filled = np.zeros((rows, columns), dtype=int)
        filled[first, second] = 1
        pairs.append("/".join("".join(map(str, row)) for row in filled.tolist()))
    return Domain(pairs=tuple(pairs))


def fits(domain: Domain, inputs: Inputs) -> bool:
    """Whether a domain has cells for the inputs."""
    shapes = [(a.cells, b.cells) for a, b in combinations(inputs.varying, 2)]
    filled = [[len(row) for row in pair.split("/")] for pair in domain.pairs]
    return filled == [[columns] * rows for rows, columns in shapes]


def _table(pair: str) -> Any:
    return np.array([[cell == "1" for cell in row] for row in pair.split("/")])


def _out_of_range(each: _Input, values: Any, row: int) -> str:
    return f"{each.name} = {shown(values[row])}: trained at {each.range}"


def _in_conflict(conflict: Conflict, row: int) -> str:
    return f"{conflict.name} = {shown(conflict.values[row])}: {conflict.words}"


def _never_together(one: _Input, other: _Input, values: Mapping[str, Any], row: int) -> str:
    pair = " with ".join(f"{each.name} = {shown(values[each.name][row])}" for each in (one, other))
    return f"{pair}: never seen together"
