"""What is let in: requests of the studio's own page at its address, and nothing else."""

from secrets import compare_digest
from urllib.parse import urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOCAL_NAMES = ("127.0.0.1", "localhost")
"""Names by which a browser may address the server; any other is that of a page which was led here."""

MOST_BYTES = 4_000_000
"""Of the body of a request."""

OF_THIS_PAGE = ("same-origin", "none")
"""Values of ``Sec-Fetch-Site`` of the page's own requests, and of an address that was typed."""

HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""Of every answer: nothing is loaded from elsewhere, shown within another page, or kept."""


class Gate:
    """Application that hands on requests below the address with the token, and refuses all others.

    Parameters
    ----------
    app : ASGI application
        What answers; it sees paths behind the token.
    token : str
    """

    def __init__(self, app: ASGIApp, token: str) -> None:
        self.app = app
        self.prefix = f"/{token}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request."""
        if scope["type"] == "lifespan":
            await self.app(scope, receive, send)
            return
        refusal = self._refusal(scope) if scope["type"] == "http" else (404, "")
        if refusal is not None:
            status, words = refusal
            await PlainTextResponse(words, status, dict(HEADERS))(scope, receive, send)
            return
        inside = {**scope, "root_path": self.prefix}
        await self.app(inside, _bounded(receive), _with_headers(send))

    def _refusal(self, scope: Scope) -> tuple[int, str] | None:
        """Status and words with which a request is refused, if it is."""
        headers, path = Headers(scope=scope), scope["path"]
        if not _is_local(headers.get("host", "")):
            return 421, "not an address of this server"
        if not compare_digest(path[: len(self.prefix) + 1].encode(), f"{self.prefix}/".encode()):
            return 404, "nothing here: open the address that tpss studio printed"
        origin = headers.get("origin")
        if origin is not None and origin != f"http://{headers['host']}":
            return 403, "asked from another page"
        if headers.get("sec-fetch-site", "none") not in OF_THIS_PAGE:
            return 403, "asked from another page"
        length = headers.get("content-length", "0")
        if not length.isdecimal() or int(length) > MOST_BYTES:
            return 413, f"more than {MOST_BYTES:,} bytes"
        return None


def _is_local(host: str) -> bool:
    return urlsplit(f"//{host}").hostname in LOCAL_NAMES


def _bounded(receive: Receive) -> Receive:
    """Receives a body, whose end is cut off if it is longer than it said."""
    taken = 0

    async def receive_some() -> Message:
        nonlocal taken
        message = await receive()
        taken += len(message.get("body", b""))
        if taken > MOST_BYTES:
            return {"type": "http.disconnect"}
        return message

    return receive_some


def _with_headers(send: Send) -> Send:
    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return send_with_headers
