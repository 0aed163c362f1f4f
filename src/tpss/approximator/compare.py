"""Comparison of an approximator with the table of a study: that of its training, or another."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from tpss.approximator.approximator import Approximator
from tpss.approximator.inputs import Given
from tpss.approximator.model_file import CollapseScore, Score
from tpss.approximator.scores import Cases, Simple, score_collapse, score_figures
from tpss.approximator.train import cases_of, read_table, usable
from tpss.errors import ApproximatorError


@dataclass(frozen=True)
class Comparison:
    """Result of a comparison."""

    tested: int
    which: str
    """Which cases these are, in words."""
    outside: int
    """Cases that were not compared, as they lie outside the trained region."""
    scores: tuple[Score, ...]
    collapse: CollapseScore | None


def compare(model: Approximator, folder: Path) -> Comparison:
    """Predict the cases of a study, and compare.

    Raises
    ------
    StudyError
        The folder is not that of a study, or of another version.
    ApproximatorError
        The study has other outputs, or no case to compare.
    ScenarioError
        The study lacks an input.
    """
    table, origin = read_table(folder)
    used = usable(table)
    data = model.file.data
    is_own = origin.study_hash == data.study_hash
    held_out = used["case"].isin(data.held_out)
    tested = used[held_out] if is_own else used
    cases, outside = cases_inside(model, tested)
    if not cases.carried.any():
        raise ApproximatorError(f"{folder} has no case inside the trained region to compare")
    simple = None
    if is_own:
        simple = Simple(model, cases_inside(model, used[~held_out])[0])
    return Comparison(
        tested=len(cases.carried),
        which=f"of {origin.study} that were held out" if is_own else f"of {origin.study}",
        outside=outside,
        scores=score_figures(model, cases, simple),
        collapse=score_collapse(model, cases, simple),
    )


def cases_inside(model: Approximator, table: pd.DataFrame) -> tuple[Cases, int]:
    """The cases of a study's table inside the trained region, and how many lie outside.

    Raises
    ------
    ApproximatorError
        The table lacks an output.
    """
    names = [output.name for output in model.file.outputs]
    finished = table[table["status"] == "finished"]
    absent = [name for name in names if name not in table or finished[name].isna().any()]
    if absent:
        raise ApproximatorError(
            f"the table has no column {', '.join(absent)}, or not in all cases: its lines differ in "
            "kind from those that the approximator was trained on"
        )
    given = given_by(model, table)
    inside = np.array(
        [not words for words in model.file.domain.objections(given, model.file.inputs)]
    )
    cases = cases_of(table, model.file.inputs.encode(given.inputs), names)
    return cases.of(np.flatnonzero(inside)), int((~inside).sum())


def given_by(model: Approximator, table: pd.DataFrame) -> Given:
    """Inputs of an approximator from a study's table."""
    known = {str(name): table[name] for name in table if model.file.inputs.has(str(name))}
    return model.file.inputs.read(known, "the table")
