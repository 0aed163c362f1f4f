"""Serve the studio on this computer until it is interrupted."""

import gc
import logging
import os
import socket
import threading
import webbrowser
from collections.abc import Callable
from pathlib import Path
from secrets import token_urlsafe

import uvicorn

from tpss.api import prepare
from tpss.errors import ResultError, ScenarioError
from tpss.studio.app import application
from tpss.studio.desk import Desk
from tpss.studio.live import Live
from tpss.studio.newest import Newest

HOST = "127.0.0.1"
TOKEN_BYTES = 24


class Warmth:
    """Kernels that are compiled, or loaded, beside the server."""

    def __init__(self, live: Live) -> None:
        self._live = live
        self._done = threading.Event()
        threading.Thread(target=self._warm, name="warm-up", daemon=True).start()

    def is_there(self) -> bool:
        """Whether runs begin at once."""
        return self._done.is_set()

    def _warm(self) -> None:
        """Prepare and run the scenario as it stands; one with faults is told of by its page."""
        try:
            prepare(self._live.desk.scenario(self._live.desk.document([]))).run()
        except ScenarioError as error:
            logging.getLogger(__name__).info("not warmed: %s", error)
        finally:
            # The command line collects no garbage; a server runs for hours.
            gc.freeze()
            gc.enable()
            self._done.set()


def serve(
    file: Path, folder: Path | None, port: int, browse: bool, say: Callable[[str], None]
) -> None:
    """Open a file, print its address, and answer its pages until Ctrl-C.

    Parameters
    ----------
    file, folder
        As of `Desk`.
    port : int
        0: any that is free.
    browse : bool
        Whether to open the browser.
    say : callable
        Prints a line.

    Raises
    ------
    ScenarioError
        The file cannot be read.
    ResultError
        The port is taken.
    """
    live, token = Live(Desk(file, folder), Newest()), token_urlsafe(TOKEN_BYTES)
    listening = _listen(port)
    address = f"http://{HOST}:{listening.getsockname()[1]}/{token}/"
    say(f"The studio is at {address}")
    say("Whoever has this address can edit the file. Ctrl-C ends it.")
    if browse:
        threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
    app = application(live, token, Warmth(live).is_there)
    config = uvicorn.Config(
        app, log_level="warning", access_log=False, server_header=False, lifespan="off"
    )
    uvicorn.Server(config).run(sockets=[listening])


def _listen(port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    if os.name != "nt":  # where it would let two servers have one port
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((HOST, port))
        listening.listen()  # whoever comes before the server is up waits for it
    except OSError as error:
        listening.close()
        raise ResultError(f"port {port} is taken; name another one, or none") from error
    return listening
