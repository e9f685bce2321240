"""Serving the studio: one page a tab, on loopback unless asked otherwise, files in a temporary
folder that goes with the server.
"""

import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from secrets import token_urlsafe
from tempfile import TemporaryDirectory
from typing import Any, Literal

from bladegen.errors import StudioError
from bladegen.studio.guard import Guard, is_loopback
from bladegen.studio.library import UPLOAD_BYTES, Library
from bladegen.studio.page.tab import Page
from bladegen.studio.shared import Studio

__all__ = ["PORT", "Serving", "bound", "serve"]

PORT = 8642
ENVELOPE = 2**18  # bytes around the files of an upload
HISTORY = 30  # messages kept for a tab that reconnects
RECONNECT = 15.0  # s that a tab may be away
PREPARING = 60.0  # s that a blade may take before its page is given up
_FIRST = threading.Lock()  # taken by the process's only studio


@dataclass(frozen=True)
class Serving:
    """A studio that is served.

    Parameters
    ----------
    address : str
        What to open, its token included.
    stop : callable
        Ends it.
    """

    address: str
    stop: Callable[[], None]


def bound(host: str, port: int | None) -> socket.socket:
    """Return a socket that listens.

    Parameters
    ----------
    host : str
        A name or number of this machine.
    port : int, optional
        0 takes a free one; without one, `PORT` or, if that is taken, a free one.

    Raises
    ------
    StudioError
        If it cannot be had.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    for wanted in (PORT, 0) if port is None else (port,):
        sock = socket.socket(family, socket.SOCK_STREAM)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            sock.bind((host, wanted))
            sock.listen(64)
        except OSError as error:
            sock.close()
            if wanted == 0 or port is not None:
                hint = "; --port 0 takes a free one" if wanted else ""
                raise StudioError(
                    f"cannot listen at {host}, port {wanted}: {error.strerror}{hint}"
                ) from None
        else:
            return sock
    raise AssertionError


def serve(
    source: str,
    host: str = "127.0.0.1",
    port: int | None = None,
    told: Callable[[Serving], None] = lambda _: None,
    *,
    airfoils: Path | None = None,
) -> None:
    """Serve the studio until it is stopped or interrupted.

    Parameters
    ----------
    source : str
        The blade to begin with, as `bladegen.read` takes it.
    host, port
        Where to listen: see `bound`.
    told : callable
        Told once it is served.
    airfoils : Path, optional
        The folder of the blade's airfoil files, as `bladegen.read` takes it.

    Raises
    ------
    FileError
        If `source` is no blade.
    StudioError
        If the web framework is not installed, there is no such place to listen, or this process
        has served a studio before: NiceGUI's application can be mounted once.
    """
    with TemporaryDirectory(prefix="bladegen-studio-") as name:
        folder = Path(name)
        os.environ["NICEGUI_STORAGE_PATH"] = str(folder / "storage")  # read when it is imported
        try:
            import nicegui  # noqa: F401
            import uvicorn
        except ImportError as error:
            raise StudioError(
                f'needs {error.name or "nicegui"}, which pip install "bladegen[studio]" brings'
            ) from None
        from threadpoolctl import threadpool_limits

        library = Library(folder)
        studio = Studio(folder, library, library.add(source, airfoils))
        library.baseline(studio.first)
        token = None if is_loopback(host) else token_urlsafe(18)
        # small matrices: more threads only wait for each other
        with threadpool_limits(1), bound(host, port) as sock:
            if not _FIRST.acquire(blocking=False):
                raise StudioError(
                    "serves one studio a process, and this process has had one; start another one"
                )
            app = Guard(_application(studio), token, UPLOAD_BYTES + ENVELOPE)
            config = uvicorn.Config(
                app, log_level="warning", lifespan="on", timeout_graceful_shutdown=2
            )
            server = uvicorn.Server(config)

            def stop() -> None:
                server.should_exit = True

            try:
                with _ended_by_a_signal():
                    told(Serving(_address(sock, host, token), stop))
                    server.run(sockets=[sock])
            finally:
                studio.end()


@contextmanager
def _ended_by_a_signal() -> Iterator[None]:
    """Let SIGTERM unwind the stack, so that the temporary folder goes too."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def _address(sock: socket.socket, host: str, token: str | None) -> str:
    name = socket.gethostname() if host in ("0.0.0.0", "::", "") else host
    shown = f"[{name}]" if ":" in name else name
    query = f"?token={token}" if token else ""
    return f"http://{shown}:{sock.getsockname()[1]}/{query}"


def _application(studio: Studio) -> Any:
    """Return the ASGI application of a studio."""
    from fastapi import FastAPI, Request, Response
    from nicegui import ui

    from bladegen.studio.page.panels import build

    app = FastAPI(docs_url=None, redoc_url=None, openapi_url=None)
    style = (Path(__file__).parent / "page" / "studio.css").read_text(encoding="utf-8")

    @app.get("/studio/{name}/{count}/{which}")
    def packet(name: str, count: int, which: Literal["now", "baseline", "beside"]) -> Response:  # noqa: ARG001
        known = studio.packets.get(name, (b"", b"", b""))
        content = known[("now", "baseline", "beside").index(which)]
        return Response(
            content,
            200 if content else 404,
            {"Cache-Control": "no-store"},
            "application/octet-stream",
        )

    @ui.page(
        "/",
        title="bladegen studio",
        favicon=_ICON,
        reconnect_timeout=RECONNECT,
        response_timeout=PREPARING,
    )
    async def index(request: Request) -> None:
        page = Page(studio, str(request.url.query))
        await page.prepared()
        ui.add_css(style)
        build(page)
        studio.visits.begin(page.client)  # from now on its tab may connect

    ui.run_with(
        app,
        title="bladegen studio",
        language="en-US",
        tailwind=True,
        message_history_length=HISTORY,
        show_welcome_message=False,
        binding_refresh_interval=None,
    )
    return app


_ICON = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 32 32"><rect width="32" height="32" '
    'rx="7" fill="#1f6fb8"/><path d="M5 17C8 9 18 11 28 17C20 19 8 23 5 17Z" fill="#fff"/></svg>'
)
