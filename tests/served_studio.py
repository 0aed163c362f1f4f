"""The studio as it is served, and a browser that shows it."""

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import uvicorn

from tpss.studio.app import application
from tpss.studio.desk import Desk
from tpss.studio.live import Live
from tpss.studio.newest import Newest

TOKEN = "a-secret"
SIZES = {"wide": {"width": 1280, "height": 900}, "narrow": {"width": 390, "height": 844}}
PATIENCE_MS = 30_000


@contextmanager
def serving(file: Path, port: int = 0) -> Iterator[str]:
    """Serve a file, and give its address."""
    listening = socket.socket()
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listening.bind(("127.0.0.1", port))
    app = application(Live(Desk(file), Newest()), TOKEN, lambda: True)
    server = uvicorn.Server(uvicorn.Config(app, log_level="error", lifespan="off", ws="none"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield f"http://127.0.0.1:{listening.getsockname()[1]}/{TOKEN}/"
    server.should_exit = server.force_exit = True
    thread.join()
    listening.close()


@dataclass
class Shown:
    """A page of the studio, what it said, and what it asked for."""

    tab: Any
    home: str
    faults: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)

    def open(self) -> "Shown":
        self.tab.set_default_timeout(PATIENCE_MS)
        self.tab.on("console", lambda message: self.faults.append(message.text))
        self.tab.on("pageerror", lambda error: self.faults.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.goto(self.home)
        self.tab.wait_for_selector("body[data-number]")
        return self

    def field(self, name: str) -> Any:
        return self.tab.get_by_role("textbox", name=name, exact=True)

    def button(self, name: str) -> Any:
        return self.tab.get_by_role("button", name=name)

    def slider(self, name: str) -> Any:
        return self.tab.get_by_role("slider", name=name, exact=True)

    def tile(self, name: str) -> str:
        return str(self.tab.locator(".tile", has_text=name).inner_text())

    def wait_for(self, expression: str) -> None:
        """Wait until an expression is true; asked from outside, as the page forbids `eval`."""
        ends = time.monotonic() + PATIENCE_MS / 1e3
        while not self.tab.evaluate(expression):
            assert time.monotonic() < ends, expression
            self.tab.wait_for_timeout(20)

    def wait_for_value(self, name: str, value: str) -> None:
        """Wait until a field shows a value."""
        found = self.field(name)
        ends = time.monotonic() + PATIENCE_MS / 1e3
        while found.input_value() != value:
            assert time.monotonic() < ends, found.input_value()
            self.tab.wait_for_timeout(20)

    def settle(self) -> None:
        """Wait until the page shows what comes of its last edit, and has kept its draft."""
        self.wait_for("document.body.dataset.settled === 'true'")
