"""Pages in a real browser: the system's Chromium, driven by Playwright, with the network off."""

from __future__ import annotations

import atexit
import base64
import contextlib
import functools
import hashlib
import json
import re
import shutil
import threading
import zlib
from contextlib import contextmanager
from functools import cache
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import numpy as np
import pytest

_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")
_NO_WEBGL = ("--disable-gpu", "--disable-3d-apis")
_PATIENCE = 500_000
"""Milliseconds: a browser that draws without a graphics card is slow on a busy machine."""


@contextmanager
def open_page(path, *, webgl=True, ready="window.terrain", **context_options):
    """Open a page from a file; an error or a warning on its console fails the test."""
    said = []
    options = {"offline": True, "viewport": {"width": 1200, "height": 800}, **context_options}
    context = _launch_browser(webgl).new_context(**options)
    try:
        context.set_default_timeout(_PATIENCE)
        page = context.new_page()
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("console", lambda line: said.append(line.text) if line.type == "error" else None)
        page.on("request", lambda request: _note_request(request.url, said))
        page.goto(path.as_uri())
        page.evaluate(f"{ready}.then(() => true)")
        yield page
    finally:
        context.close()
    assert [line for line in said if webgl or "WebGL" not in line] == []


@contextmanager
def open_served(folder, name, *, answers=None, ready="window.terrain", **context_options):
    """Open a page from a server on this machine; nothing else may be asked for.

    ``answers`` are other answers than the files: paths with a status, bytes, or an event that is
    waited for. The page has the paths that were asked for as ``page.asked``. Where it is expected
    to fail, ``ready`` is something else.
    """
    said = []
    with _serve_folder(folder, answers or {}) as (address, asked):
        options = {"viewport": {"width": 1200, "height": 800}, **context_options}
        context = _launch_browser(True).new_context(**options)
        try:
            context.set_default_timeout(_PATIENCE)
            page = context.new_page()
            page.on("pageerror", lambda error: said.append(str(error)))
            page.on(
                "request",
                lambda one: None if one.url.startswith(address) else _note_request(one.url, said),
            )
            page.asked = asked
            page.goto(address + name)
            page.evaluate(f"{ready}.then(() => true)")
            yield page
        finally:
            context.close()
    assert said == []


def wait_until(page, condition):
    """Wait until something holds; what Playwright has for it a page's policy forbids."""
    page.evaluate(
        f"""new Promise((done) => {{
      const look = async () => ((await ({condition})) ? done() : setTimeout(look, 20));
      void look(); }})"""
    )


@contextmanager
def _serve_folder(folder, answers):
    asked = []

    class Handler(SimpleHTTPRequestHandler):
        def do_GET(self):
            path = self.path.lstrip("/")
            asked.append(path)
            answer = answers.get(path)
            if isinstance(answer, threading.Event):
                answer.wait(60)
            if isinstance(answer, int):
                self.send_error(answer)
            elif isinstance(answer, bytes):
                self.send_response(200)
                self.send_header("Content-Length", str(len(answer)))
                self.end_headers()
                self.wfile.write(answer)
            else:
                with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                    super().do_GET()

        def log_message(self, *_):
            pass

    handler = functools.partial(Handler, directory=str(folder))
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, args=(0.05,), daemon=True)
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_address[1]}/", asked
    finally:
        server.shutdown()
        server.server_close()


@cache
def _launch_browser(webgl):
    """Start a browser, of which a process has one with and one without WebGL."""
    browser_path = shutil.which("chromium") or shutil.which("chromium-browser")
    if browser_path is None:
        pytest.skip("chromium is not installed")
    arguments = ["--no-sandbox", *(_WEBGL if webgl else _NO_WEBGL)]
    return _start_driver().chromium.launch(
        executable_path=browser_path, args=arguments, timeout=_PATIENCE
    )


@cache
def _start_driver():
    """Start Playwright's driver, of which a process has one."""
    from playwright.sync_api import sync_playwright

    driver = sync_playwright().start()
    atexit.register(driver.stop)
    return driver


def _note_request(url, said):
    if not url.startswith(("file:", "data:", "blob:")):
        said.append(f"asked for {url}")


def unpack(packed):
    """The other side of packing, in numpy and as plainly as can be."""
    count = packed["rows"] * packed["columns"]
    data = zlib.decompress(base64.b64decode(packed["data"])) if packed["planes"] else b""
    planes = np.frombuffer(data, np.uint8).reshape(packed["planes"], count).astype(np.int64)
    zigzag = sum((plane << (8 * k) for k, plane in enumerate(planes)), np.zeros(count, np.int64))
    return ((zigzag >> 1) ^ -(zigzag & 1)).reshape(packed["rows"], packed["columns"])


def read_content(page):
    """Return what a page is given."""
    found = re.search(r'<script type="application/json" id="terrain">(.*?)</script>', page, re.S)
    return json.loads(found[1])


def digest_sources(folder):
    """Return the digest of all from which the bundle is made."""
    digest = hashlib.sha256()
    for path in sorted([*folder.glob("src/**/*.ts"), folder / "package-lock.json"]):
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


if __name__ == "__main__":
    from pathlib import Path

    folder = Path(__file__).parents[2] / "terrain" / "viewer" / "page"
    print(digest_sources(folder))  # noqa: T201
