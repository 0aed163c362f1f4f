"""The command ``tpss schema``: the JSON Schema of the formats of scenarios, plans and geometries."""

import json
import os
from importlib import import_module
from pathlib import Path

from tpss.cli.terminal import tell
from tpss.errors import ResultError
from tpss.files.json_text import read_json_file
from tpss.files.refusals import explained
from tpss.files.whole import write_file

SCHEMAS = {
    "scenario": ("tpss.scenario.schema", "scenario_schema"),
    "plan": ("tpss.planning.schema", "plan_schema"),
    "geometry": ("tpss.conductors.schema", "geometry_schema"),
}
"""Kinds of files that have a schema, and the module and function that make it."""

TITLES = tuple(f"TPSS {kind}" for kind in SCHEMAS)
"""Titles of schemas that TPSS writes."""


def write_schema(out: Path | None, kind: str = "scenario") -> None:
    """Print the schema of a kind of files, or write it into a file, whole or not at all.

    Raises
    ------
    ResultError
        The file cannot be written, or exists and holds something other than a schema of TPSS.
    """
    module, name = SCHEMAS[kind]
    schema = getattr(import_module(module), name)()
    text = json.dumps(schema, indent=2, ensure_ascii=False) + "\n"
    if out is None:
        print(text, end="")
        return
    if os.path.lexists(out) and not _is_our_schema(out):
        raise ResultError(f"{out} exists and is not a schema of TPSS; name another file")
    with explained(out, "name another file"):
        write_file(out, text.encode())
    tell(f"Wrote {out}.  In a {kind}, the first line  #:schema {out.name}  makes editors use it.")


def _is_our_schema(file: Path) -> bool:
    try:
        document = read_json_file(file)
    except (OSError, ValueError):
        return False
    return isinstance(document, dict) and document.get("title") in TITLES
