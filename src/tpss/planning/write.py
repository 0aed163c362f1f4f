"""The folder of an answer: plan.json for machines and for the next question, tables for people."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from tpss.errors import PlanError
from tpss.files.json_text import read_json_file
from tpss.files.refusals import explained, reason
from tpss.files.whole import write_file
from tpss.planning import tables
from tpss.planning.answer import Answer
from tpss.planning.case_folder import CaseFolder
from tpss.planning.cases import CaseList
from tpss.planning.excel import WORKBOOK, excel_of
from tpss.planning.finer import Compared, finer_sentences, finer_table
from tpss.planning.first_costs import first_costs
from tpss.planning.learnt import Learnt
from tpss.planning.load import Plan, plan_of
from tpss.planning.plan import SIMULATION
from tpss.planning.prove import Grade
from tpss.planning.sentence import sentences
from tpss.planning.solve import Model, model_of
from tpss.planning.turning import Turn
from tpss.planning.uncounted import estimated, uncounted, unknown
from tpss.results.csv_texts import csv_of
from tpss.scenario.given_path import from_here, named_as_given
from tpss.sweep.folder import REMEDY
from tpss.sweep.versions import versions

PLAN, TABLES = "plan.json", "tables"

FORMAT_KEY, FORMAT = "plan_format", 1
"""Key and number of the format of ``plan.json``."""


def write_answer(
    folder: Path,
    answer: Answer,
    turns: Sequence[Turn],
    finer: Sequence[Sequence[Compared]] = (),
) -> None:
    """Write an answer into the folder of its cases.

    Parameters
    ----------
    folder : Path
    answer : Answer
    turns : sequence of Turn
        Where first decisions turn.
    finer : sequence
        First decisions at a finer step.

    Raises
    ------
    PlanError
        It cannot be written.
    """
    found = {
        "decisions": tables.decisions(answer),
        "first_decisions": tables.first_decisions(answer),
        "first_costs": first_costs(answer),
        "best_plans": tables.best_plans(answer),
        "costs": tables.costs(answer),
        "regret": tables.regret(answer),
        "values": tables.values(answer),
        "configurations": tables.configurations(answer.model),
        "switching_values": switching_table(answer.model, turns),
        "finer_step": finer_table(answer, finer),
    }
    with explained(folder, REMEDY, PlanError, within=True):
        (folder / TABLES).mkdir(exist_ok=True)
        for name, table in found.items():
            write_file(
                folder / TABLES / f"{name}.csv",
                csv_of(table),
            )
        write_file(folder / TABLES / WORKBOOK, excel_of(found, answer.model.plan.file.economics))
        document = _as_json(answer, turns, found) | {"finer": finer_sentences(answer, finer)}
        write_file(folder / PLAN, json.dumps(document, indent=1, allow_nan=False).encode())


def _as_json(
    answer: Answer, turns: Sequence[Turn], found: Mapping[str, pd.DataFrame]
) -> dict[str, Any]:
    model = answer.model
    economics = model.plan.file.economics
    return {
        FORMAT_KEY: FORMAT,
        "name": model.plan.file.name,
        "answer": sentences(answer, turns),
        "claim": answer.claim,
        **_proof(answer),
        "by_estimate": list(estimated(model)),
        "not_counted": list(uncounted(model)),
        "currency": economics.currency,
        "price_year": economics.price_year,
        "expected_cost": answer.best.cost,
        "bound": answer.best.bound,
        "gap": answer.best.gap,
        "is_closed": answer.is_closed,
        "values": {
            str(row["value"]): _plain(row["cost"]) for row in found["values"].to_dict("records")
        },
        "mean_future": tables.mean_future(answer).to_dict("records"),
        "decisions": [
            {str(k): _plain(v) for k, v in row.items()}
            for row in found["decisions"].to_dict("records")
        ],
        **versions(),
        "source": str(model.plan.source),
        "plan": model.plan.document,
    }


def _proof(answer: Answer) -> dict[str, Any]:
    """What the claim of a plan stands on that is proved by bounds; nothing of others."""
    proof = answer.proof
    if proof.grade is Grade.EXHAUSTIVE:
        return {}
    return {
        "not_known": list(unknown(answer.model)),
        "proof": {
            "grade": proof.grade.value,
            "holds": proof.holds,
            "simulated_cases": proof.simulated,
            "cases": proof.cases,
            "violations": len(proof.violations),
            "audited": proof.audited,
        },
    }


def _plain(value: Any) -> Any:
    """A value that JSON knows: None for what is no number."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def switching_table(model: Model, turns: Sequence[Turn]) -> pd.DataFrame:
    """Values at which first decisions turn, and to what; empty where they do not in the range."""
    rows = []
    for turn in turns:
        names = tables.configuration_names(model, turn.area)
        found = turn.found
        rows.append(
            {
                "area": model.problem.areas[turn.area].name,
                "key": turn.key,
                "now": found.now,
                "first": names[found.first],
                "below": found.below,
                "below_to": None if found.below_to is None else names[found.below_to],
                "above": found.above,
                "above_to": None if found.above_to is None else names[found.above_to],
            }
        )
    columns = ["area", "key", "now", "first", "below", "below_to", "above", "above_to"]
    return pd.DataFrame(rows, columns=columns)


def read_document(folder: Path) -> dict[str, Any]:
    """What ``plan.json`` of a folder says.

    Raises
    ------
    PlanError
        It is no folder of an answer, or one of another version's format.
    """
    try:
        document = read_json_file(folder / PLAN)
    except (OSError, ValueError) as error:
        raise PlanError(
            f"{folder} is not the folder of a plan that was solved ({PLAN}: {reason(error)}); name one "
            "that tpss plan run has written"
        ) from error
    if not isinstance(document, dict) or document.get(FORMAT_KEY) != FORMAT:
        raise PlanError(
            f"{folder / PLAN} was written by another version of TPSS; run the plan again"
        )
    return document


def read_model(folder: Path, changes: dict[str, Any]) -> Model:
    """Model of a folder, with values of its plan set by key path, from the cases that it holds.

    Raises
    ------
    PlanError
        It is no folder of an answer, or cases that the changed plan needs were not simulated.
    ScenarioError
        The changed plan has faults.
    """
    document = read_document(folder)
    source = Path(document["source"])
    given = from_here(source)
    with named_as_given(source, given):
        plan = replace(plan_of(document["plan"], source), given=given)
        return _model_within(folder, plan.with_(changes) if changes else plan)


def _model_within(folder: Path, plan: Plan) -> Model:
    """Model of a plan from the cases that a folder holds."""
    case_list = CaseList(plan)
    table = CaseFolder(folder).table()
    missing = sum(case.digest not in table.index for case in case_list.cases)
    if missing and case_list.plan.file.evaluate.by == SIMULATION:
        raise PlanError(
            f"{missing:,} of {len(case_list.cases):,} cases were not simulated: the plan or its "
            "scenarios have changed in more than prices; run tpss plan run again, which adds them"
        )
    return model_of(case_list, table, Learnt(folder))
