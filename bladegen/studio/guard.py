"""Who may talk to the studio, and how much they may send: ASGI layers around the application.

On loopback a request must name the loopback host, so that no page from elsewhere can reach the
studio through a name that it owns.  Elsewhere every request must hold the token: once in the
address, which sets a cookie, and in that cookie from then on.  A WebSocket must come from a page
of the studio's own.
"""

from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from secrets import compare_digest
from typing import Any
from urllib.parse import parse_qsl, urlencode, urlsplit

__all__ = ["LOOPBACK", "Guard", "is_loopback"]

LOOPBACK = ("127.0.0.1", "localhost", "::1")
COOKIE = "bladegen_studio"

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]


def is_loopback(host: str) -> bool:
    """Tell whether a host to listen at is this machine's own loopback."""
    return host in LOOPBACK


class TooMuchError(Exception):
    """A request's body is larger than allowed."""


@dataclass(frozen=True)
class Guard:
    """An application behind its rules.

    Parameters
    ----------
    app : callable
        The ASGI application.
    token : str, optional
        What a request must hold; None on loopback, where the host's name is looked at.
    most : int
        Bytes that a request's body may have.
    """

    app: App
    token: str | None
    most: int

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or answer it with 403 or 413, or a redirect that sets the cookie."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {
            key.decode("latin-1").lower(): value.decode("latin-1")
            for key, value in scope["headers"]
        }
        if self.token is not None and scope["type"] == "http":
            query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
            given = dict(query).get("token")
            if given is not None and compare_digest(given.encode(), self.token.encode()):
                kept = urlencode([(key, value) for key, value in query if key != "token"])
                await _answer(
                    send,
                    303,
                    "",
                    location=scope["path"] + ("?" + kept if kept else ""),
                    **{
                        "set-cookie": f"{COOKIE}={self.token}; Path=/; HttpOnly; SameSite=Strict",
                        "referrer-policy": "no-referrer",
                    },
                )
                return
        reason = self._refused(scope["type"], headers)
        if reason and scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": reason})
        elif reason:
            await _answer(send, 403, reason)
        else:
            await self._bounded(scope, headers, receive, send)

    def _refused(self, kind: str, headers: dict[str, str]) -> str:
        """Say why a request is not taken; "" if it is."""
        host = headers.get("host", "")
        origin = headers.get("origin")
        if kind == "websocket" and origin and urlsplit(origin).netloc != host:
            return "this page is not the studio's own"
        if self.token is None:
            name = urlsplit(f"//{host}").hostname or ""
            return "" if is_loopback(name) else "the studio is reached as localhost"
        try:
            morsel = SimpleCookie(headers.get("cookie", "")).get(COOKIE)
        except CookieError:
            morsel = None
        known = morsel is not None and compare_digest(morsel.value.encode(), self.token.encode())
        return "" if known else "the address must hold the token that bladegen studio printed"

    async def _bounded(
        self, scope: Scope, headers: dict[str, str], receive: Receive, send: Send
    ) -> None:
        """Pass a request on, as long as its body is not too large."""
        words = f"the request has more than {self.most >> 20} MB"
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > self.most:
            await _answer(send, 413, words)
            return
        taken, begun = 0, False

        async def counted() -> MutableMapping[str, Any]:
            nonlocal taken
            message = await receive()
            if message["type"] == "http.request":
                taken += len(message.get("body", b""))
                if taken > self.most:
                    raise TooMuchError
            return message

        async def watched(message: MutableMapping[str, Any]) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            await self.app(scope, counted, watched)
        except TooMuchError:
            if not begun:
                await _answer(send, 413, words)


async def _answer(send: Send, status: int, words: str, **headers: str) -> None:
    body = f"bladegen studio: {words}\n".encode() if words else b""
    sent = {
        "content-type": "text/plain; charset=utf-8",
        "content-length": str(len(body)),
        **headers,
    }
    await send(
        {
            "type": "http.response.start",
            "status": status,
            "headers": [(key.encode(), value.encode("latin-1")) for key, value in sent.items()],
        }
    )
    await send({"type": "http.response.body", "body": body})
