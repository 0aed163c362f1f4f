"""The studio's server: what its page may ask for, each an address of its own."""

import json
from collections.abc import Callable
from importlib.metadata import version
from importlib.resources import files
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp

from tpss import units
from tpss.errors import TpssError
from tpss.scenario.schema import scenario_schema
from tpss.studio.changed import as_options, as_python, changes_between
from tpss.studio.charts import CHARTS
from tpss.studio.desk import Content
from tpss.studio.drafts import Draft, OvertakenError
from tpss.studio.gate import Gate
from tpss.studio.live import Live
from tpss.studio.newest import DroppedError
from tpss.studio.saved import difference

PAGE = "page"
"""Folder of the page, within the package."""

Asked = dict[str, Any]

Answer = Callable[[Live, Asked], dict[str, Any]]


def application(live: Live, token: str, is_warm: Callable[[], bool]) -> ASGIApp:
    """The server of an open file, which answers below its token only.

    Parameters
    ----------
    live : Live
    token : str
    is_warm : callable
        Whether kernels are ready to run.
    """
    routes: list[BaseRoute] = [
        Route(f"/api/{name}", _endpoint(live, answer), methods=["POST"])
        for name, answer in ANSWERS.items()
    ]
    routes.append(Route("/api/ready", lambda _: JSONResponse({"ready": is_warm()})))
    folder = str(files("tpss.studio") / PAGE)
    routes.append(Mount("/", StaticFiles(directory=folder, html=True)))
    return Gate(Starlette(routes=routes), token)


def _endpoint(live: Live, answer: Answer) -> Callable[[Request], Any]:
    async def respond(request: Request) -> Response:
        try:
            asked = json.loads(await request.body() or b"{}")
            if not isinstance(asked, dict):
                raise TypeError("not an object")
            told = await run_in_threadpool(answer, live, asked)
        except (ValueError, KeyError, TypeError, RecursionError) as error:
            return _json({"refused": f"not understood: {type(error).__name__}: {error}"}, 400)
        except DroppedError as error:
            return _json({"refused": str(error), "dropped": True})
        except OvertakenError as error:
            return _json({"refused": str(error), "overtaken": True})
        except TpssError as error:
            return _json({"refused": str(error)})
        except OSError as error:
            return _json({"refused": f"{error.filename}: {error.strerror}"})
        return _json(told)

    return respond


def _json(told: dict[str, Any], status: int = 200) -> Response:
    """An answer; what is refused by its content is one too, so that browsers log no errors."""
    text = json.dumps(told, separators=(",", ":"), allow_nan=False)
    return Response(text, status, media_type="application/json")


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


ANSWERS: dict[str, Answer] = {
    "opened": opened,
    "see": see,
    "check": check,
    "changes": changes,
    "save": save,
    "keep-draft": keep_draft,
    "read-draft": read_draft,
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
