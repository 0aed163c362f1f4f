"""What a page may ask its server, each by a name."""

from collections.abc import Callable
from importlib.metadata import version
from typing import Any
from urllib.parse import quote

from tpss import units
from tpss.scenario.schema import scenario_schema
from tpss.studio import equations, outages, pasted, reported, respond, steps, variants
from tpss.studio.changed import as_options, as_python, changes_between
from tpss.studio.charts import CHARTS
from tpss.studio.desk import Content
from tpss.studio.drafts import Draft
from tpss.studio.live import Live
from tpss.studio.saved import difference

Asked = dict[str, Any]

Answer = Callable[[Live, Asked], dict[str, Any]]


def opened(live: Live, _: Asked) -> dict[str, Any]:
    """The file, its draft, and all that a page has to know once."""
    live.desk.reread()
    return {
        "folder": str(live.desk.folder),
        "command": f"tpss studio {live.desk.given}",
        "version": version("tpss"),
        "schema": (schema := scenario_schema()),
        "labels": labels_of(schema),
        "charts": {name: {"title": c.title, "over": c.over} for name, c in CHARTS.items()},
        "explained": list(equations.BEHIND),
        "draft": live.desk.drafts.read().as_dict(),
        **_content(live, live.desk.content),
    }


def labels_of(schema: Asked) -> dict[str, tuple[str, str]]:
    """Words and unit of every key that a schema knows."""
    parts = [schema, *schema["$defs"].values()]
    keys = {key for part in parts for key in part.get("properties", {})}
    return {key: (units.words(key), units.label(key)) for key in sorted(keys)}


def see(live: Live, asked: Asked) -> dict[str, Any]:
    """What comes of edits."""
    return live.see(
        str(asked["page"]), int(asked["number"]), _edits(asked), list(asked.get("charts", []))
    )


def check(live: Live, asked: Asked) -> dict[str, Any]:
    """Step error and notes."""
    return live.check(str(asked["page"]), int(asked["number"]), _edits(asked))


def changes(live: Live, asked: Asked) -> dict[str, Any]:
    """What the edits change, as options of the command line, as a program, and as lines of the file."""
    document = live.desk.document(_edits(asked))
    found = changes_between(live.desk.content.document, document)
    text = live.desk.changed_text(document)
    return {
        "count": len(found),
        "options": as_options(found),
        "python": as_python(live.desk.given, found),
        "toml": difference(live.desk.content.text, text, live.desk.name),
    }


def save(live: Live, asked: Asked) -> dict[str, Any]:
    """Write the edits into the file, unless that was changed meanwhile."""
    return _content(live, live.desk.save(_edits(asked), str(asked["digest"])))


def keep_draft(live: Live, asked: Asked) -> dict[str, Any]:
    """Keep edits that are not saved yet."""
    draft = Draft(
        int(asked["revision"]), str(asked["digest"]), tuple(asked["edits"]), tuple(asked["undone"])
    )
    return {"revision": live.desk.drafts.keep(draft).revision}


def read_draft(live: Live, _: Asked) -> dict[str, Any]:
    """The draft that another page has kept."""
    return live.desk.drafts.read().as_dict()


def read_rows(_: Live, asked: Asked) -> dict[str, Any]:
    """Rows of a pasted text."""
    columns = [(str(key), bool(is_number)) for key, is_number in asked["columns"]]
    return {"rows": pasted.rows_of(str(asked["text"]), str(asked["path"]), columns)}


def variants_of(live: Live, asked: Asked) -> dict[str, Any]:
    """The tray of variants."""
    return variants.compared(live.desk, _edits(asked), _begun(live, asked))


def keep_variant(live: Live, asked: Asked) -> dict[str, Any]:
    """The edits as a variant of the file."""
    return {"variant": variants.kept(live.desk, _edits(asked))}


def outages_of(live: Live, asked: Asked) -> dict[str, Any]:
    """The table of single outages."""
    return outages.compared(live.desk, _edits(asked), _begun(live, asked))


def respond_to(live: Live, asked: Asked) -> dict[str, Any]:
    """Figures over values of a number."""
    path, values = str(asked["path"]), list(asked["values"])
    return respond.respond(live.desk, _edits(asked), path, values, _begun(live, asked))


def fewest_of(live: Live, asked: Asked) -> dict[str, Any]:
    """The smallest number of units that keeps limits."""
    lowest_kv, loading_percent = (
        None if asked.get(key) is None else float(asked[key])
        for key in ("lowest_kv", "loading_percent")
    )
    return respond.fewest(
        live.desk, _edits(asked), str(asked["path"]), lowest_kv, loading_percent,
        _begun(live, asked),
    )  # fmt: skip


def report_of(live: Live, asked: Asked) -> dict[str, Any]:
    """A report or workbook, by the address from which it is taken."""
    file = reported.made(
        live.desk, _edits(asked), str(asked["kind"]), asked["words"], _begun(live, asked)
    )
    return {"name": file.name, "address": f"files/{live.shelf.put(file)}/{quote(file.name)}"}


def equations_of(_: Live, asked: Asked) -> dict[str, Any]:
    """What stands behind a chart."""
    return {"behind": equations.behind(str(asked["chart"]))}


def train_steps_of(live: Live, asked: Asked) -> dict[str, Any]:
    """Every step of a train."""
    return steps.steps_of(live.desk, _edits(asked), str(asked["train"]), _begun(live, asked))


def _begun(live: Live, asked: Asked) -> list[int]:
    """Begin what takes longer, which ends whatever a page's other such request does."""
    return live.newest.begin(f"{asked['page']} {asked['what']}", int(asked["number"]))


ANSWERS: dict[str, Answer] = {
    "opened": opened,
    "see": see,
    "check": check,
    "changes": changes,
    "save": save,
    "keep-draft": keep_draft,
    "read-draft": read_draft,
    "read-rows": read_rows,
    "variants": variants_of,
    "keep-variant": keep_variant,
    "outages": outages_of,
    "respond": respond_to,
    "fewest": fewest_of,
    "report": report_of,
    "equations": equations_of,
    "train-steps": train_steps_of,
}
"""What a page may ask for, by the last part of its address."""


def _content(live: Live, content: Content) -> dict[str, Any]:
    return {"name": live.desk.name, "digest": content.digest, "document": content.document}


def _edits(asked: Asked) -> list[list[Any]]:
    """The edits of a request: pairs of a key path and a value."""
    edits = asked["edits"]
    if not isinstance(edits, list) or not all(
        isinstance(each, list) and len(each) == 2 for each in edits
    ):
        raise TypeError("edits are a list of pairs")
    return edits
