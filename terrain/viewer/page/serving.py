"""A page and the files beside it, for a browser on this machine and for nobody else."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from functools import partial
from http import HTTPStatus
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from ....base.errors import RenderError

if TYPE_CHECKING:
    import io
    from collections.abc import Iterator
    from pathlib import Path

FOLDER = "tileset"
"""Under which name the files stand beside the page."""

_HOST = "127.0.0.1"


class _Handler(SimpleHTTPRequestHandler):
    """Gives the page at "/", and files of one folder below it; lists nothing, writes no log."""

    protocol_version = "HTTP/1.1"

    server: ThreadingHTTPServer

    def __init__(self, *given: Any, page: bytes, **options: Any) -> None:
        self._page = page
        super().__init__(*given, **options)

    def send_head(self) -> Any:
        """Answer a request, unless it came by another name: then a site elsewhere sent it."""
        if self.headers.get("Host") != f"{_HOST}:{self.server.server_port}":
            self.send_error(HTTPStatus.FORBIDDEN)
            return None
        path = urlsplit(self.path).path
        if path == "/":
            return self._send_page()
        if not path.startswith(f"/{FOLDER}/"):
            self.send_error(HTTPStatus.NOT_FOUND)
            return None
        self.path = path.removeprefix(f"/{FOLDER}")
        return super().send_head()

    def _send_page(self) -> io.BytesIO:
        import io

        self.send_response(HTTPStatus.OK)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(self._page)))
        self.end_headers()
        return io.BytesIO(self._page)

    def list_directory(self, path: Any) -> None:
        """Tell nothing of what a folder holds."""
        del path
        self.send_error(HTTPStatus.NOT_FOUND)

    def log_message(self, *given: Any) -> None:
        """Stay silent."""


@contextmanager
def serve(page: str, folder: Path) -> Iterator[str]:
    """Serve a page, and a folder under the name of :data:`FOLDER`; yield the address of the page.

    Only programs on this machine can ask (127.0.0.1), by a free port, until the block ends.
    """
    handler = partial(_Handler, page=page.encode(), directory=str(folder))
    try:
        server = ThreadingHTTPServer((_HOST, 0), handler)
    except OSError as error:
        raise RenderError(f"Cannot serve the page on {_HOST}: {error}.") from error
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield f"http://{_HOST}:{server.server_port}/"
    finally:
        server.shutdown()
        server.server_close()
        thread.join()
