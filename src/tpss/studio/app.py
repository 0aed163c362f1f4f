"""The studio's server: what its page may ask for, each an address of its own."""

import json
from collections.abc import Callable
from functools import partial
from importlib.resources import files
from typing import Any

from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles
from starlette.types import ASGIApp

from tpss.errors import TpssError
from tpss.studio.answers import ANSWERS, Answer
from tpss.studio.drafts import OvertakenError
from tpss.studio.gate import Gate
from tpss.studio.live import Live
from tpss.studio.newest import DroppedError

PAGE = "page"
"""Folder of the page, within the package."""


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
    routes.append(Route("/files/{number:int}/{name}", partial(_file, live)))
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


def _file(live: Live, request: Request) -> Response:
    """A file that was made, for as long as it is kept."""
    file = live.shelf.get(request.path_params["number"])
    if file is None:
        return Response("It is no longer kept: make it again.", 404, media_type="text/plain")
    return Response(file.content, media_type=file.media_type, headers=dict(file.headers))


def _json(told: dict[str, Any], status: int = 200) -> Response:
    """An answer; what is refused by its content is one too, so that browsers log no errors."""
    text = json.dumps(told, separators=(",", ":"), allow_nan=False)
    return Response(text, status, media_type="application/json")
