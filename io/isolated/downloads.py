"""Addresses in the network: copied to a temporary file, and only where the caller asks for it."""

from __future__ import annotations

import http.client
import re
import urllib.error
import urllib.request
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from ...base.atomic import scratch_folder
from ...base.errors import ReadError
from ...base.notes import naming_copy

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

_WEB = re.compile(r"(https?):/+(?=[^/])", re.IGNORECASE)
"""A path that was an address has lost one of its slashes."""

_SECONDS = 60.0
"""Without a byte for so long, a server is given up."""

_CHUNK = 1 << 20
_UNNAMED = "download.txt"


def is_web_address(path: str | os.PathLike[str]) -> bool:
    """Whether a path is an address of HTTP.

    Examples
    --------
    >>> is_web_address("https://example.org/survey.csv"), is_web_address("survey.csv")
    (True, False)
    """
    return _WEB.match(str(path)) is not None


@contextmanager
def download(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield a copy of what an address holds, under the name that it has there.

    Parameters
    ----------
    path : path-like
        An address of HTTP or HTTPS; redirections lead to such addresses only.
    """
    address = _WEB.sub(r"\1://", str(path), count=1)
    with scratch_folder() as folder:
        name = PurePosixPath(unquote(urlsplit(address).path)).name
        copy = Path(folder, re.sub(r"[^\w.-]", "_", name)[-100:].lstrip(".") or _UNNAMED)
        try:
            _copy(address, copy)
        except (OSError, ValueError, http.client.HTTPException) as error:
            if isinstance(error, urllib.error.HTTPError):
                error.close()  # it is the answer, too
            reason = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
            raise ReadError(f"Cannot read '{address}': {reason}.", path=Path(copy.name)) from error
        with naming_copy(copy, Path(copy.name)):
            yield copy


def _copy(address: str, copy: Path) -> None:
    with _make_opener().open(address, timeout=_SECONDS) as answer, copy.open("wb") as file:
        stated = answer.headers.get("Content-Length")
        count = 0
        while chunk := answer.read(_CHUNK):
            count += file.write(chunk)
    if stated is not None and count != int(stated):
        raise OSError(0, f"the connection ended after {count:,} of {int(stated):,} bytes")


def _make_opener() -> Any:
    """Return what opens addresses of HTTP alone: neither files nor FTP, redirected to or not."""
    opener = urllib.request.OpenerDirector()
    for handler in (
        urllib.request.ProxyHandler,
        urllib.request.UnknownHandler,
        urllib.request.HTTPHandler,
        urllib.request.HTTPSHandler,
        urllib.request.HTTPDefaultErrorHandler,
        urllib.request.HTTPRedirectHandler,
        urllib.request.HTTPErrorProcessor,
    ):
        opener.add_handler(handler())
    return opener
