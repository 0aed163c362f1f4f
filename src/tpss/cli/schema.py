"""The command ``tpss schema``: the JSON Schema of the scenario format."""

import json
import os
from pathlib import Path

from tpss.errors import ResultError
from tpss.files.refusals import explained
from tpss.files.whole import write_file
from tpss.scenario.schema import TITLE, scenario_schema


def write_schema(out: Path | None) -> None:
    """Print the schema, or write it into a file, whole or not at all.

    Raises
    ------
    ResultError
        The file cannot be written, or exists and holds something other than a schema of TPSS.
    """
    text = json.dumps(scenario_schema(), indent=2, ensure_ascii=False) + "\n"
    if out is None:
        print(text, end="")
        return
    if os.path.lexists(out) and not _is_our_schema(out):
        raise ResultError(f"{out} exists and is not a schema of TPSS; name another file")
    with explained(out, "name another file"):
        write_file(out, text.encode())
    print(
        f"Wrote {out}.  In a scenario, the first line  #:schema {out.name}  makes editors use it."
    )


def _is_our_schema(file: Path) -> bool:
    try:
        document = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(document, dict) and document.get("title") == TITLE
