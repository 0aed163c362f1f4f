"""The command ``tpss schema``: the JSON Schema of the formats of scenarios and plans."""

import json
import os
from pathlib import Path
from typing import Any

from tpss.errors import ResultError
from tpss.files.refusals import explained
from tpss.files.whole import write_file
from tpss.scenario.schema import TITLE, scenario_schema

TITLES = (TITLE, "TPSS plan")
"""Titles of schemas that TPSS writes."""


def write_schema(out: Path | None, plan: bool = False) -> None:
    """Print the schema of scenarios, or of plans, or write it into a file, whole or not at all.

    Raises
    ------
    ResultError
        The file cannot be written, or exists and holds something other than a schema of TPSS.
    """
    schema = _plan_schema() if plan else scenario_schema()
    text = json.dumps(schema, indent=2, ensure_ascii=False) + "\n"
    if out is None:
        print(text, end="")
        return
    if os.path.lexists(out) and not _is_our_schema(out):
        raise ResultError(f"{out} exists and is not a schema of TPSS; name another file")
    with explained(out, "name another file"):
        write_file(out, text.encode())
    kind = "plan" if plan else "scenario"
    print(f"Wrote {out}.  In a {kind}, the first line  #:schema {out.name}  makes editors use it.")


def _plan_schema() -> dict[str, Any]:
    from tpss.planning.schema import plan_schema

    return plan_schema()


def _is_our_schema(file: Path) -> bool:
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(document, dict) and document.get("title") in TITLES
