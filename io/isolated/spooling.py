"""Files of this machine; pipes as files: what can be read once is copied to a temporary file."""

from __future__ import annotations

import re
import shutil
import stat
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING

from ...base.atomic import scratch_folder
from ...base.errors import ReadError, TinsmithError
from ...base.notes import naming_copy

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

_CHUNK = 1 << 20


@contextmanager
def open_ordinary_file(path: Path) -> Iterator[Path]:
    """Yield a file that can be opened several times: ``path`` itself, or a copy of what it sends.

    Parameters
    ----------
    path : Path
        A file, or a pipe (named, ``/dev/stdin``, a shell's process substitution).

    Yields
    ------
    Path
        Removed at the end if it is a copy; errors speak of ``path`` all the same.

    Raises
    ------
    ReadError
        If there is a device or a socket, or the pipe cannot be read.
    """
    if not is_pipe(path):
        yield path
        return
    with translate_system_errors(path):
        stream = path.open("rb")
    with stream, spool(stream, path) as copy:
        yield copy


@contextmanager
def spool(stream: IO[bytes], path: Path) -> Iterator[Path]:
    """Copy a stream to a temporary file of the same suffix, and yield that.

    Parameters
    ----------
    stream : binary file object
    path : Path
        What errors speak of. Without a suffix, the content is taken to be text if it shows no
        other format.

    Raises
    ------
    ReadError
        If the stream cannot be read, or there is no room for it.
    """
    with scratch_folder() as folder:
        copy = Path(folder) / f"piped{path.suffix or '.txt'}"
        with translate_system_errors(path), copy.open("wb") as file:
            shutil.copyfileobj(stream, file, _CHUNK)
        with naming_copy(copy, path):
            yield copy


def describe_system_error(path: Path, error: OSError) -> ReadError:
    """Return the error of the system as one of the toolkit."""
    if isinstance(error, FileNotFoundError):
        return ReadError(f"There is no file '{path}'.", path=path)
    if isinstance(error, PermissionError):
        return ReadError(f"'{path}' may not be read: permission denied.", path=path)
    return ReadError(f"Cannot read '{path}': {error.strerror or error}.", path=path)


@contextmanager
def translate_system_errors(path: Path) -> Iterator[None]:
    """Raise errors of the system as sentences about ``path``; those of the toolkit pass."""
    try:
        yield
    except TinsmithError:
        raise
    except OSError as error:
        raise describe_system_error(path, error) from error


def require_readable(path: Path) -> None:
    """Raise a ReadError where no file is there, or it may not be read."""
    with translate_system_errors(path):
        path.open("rb").close()


def is_pipe(path: Path) -> bool:
    """Whether a path is a pipe; files, folders and what is missing are left to the reader."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return False
    if stat.S_ISCHR(mode) or stat.S_ISBLK(mode) or stat.S_ISSOCK(mode):
        what = "a socket" if stat.S_ISSOCK(mode) else "a device or a terminal"
        raise ReadError(f"'{path}' is {what}: a file or a pipe is needed.", path=path)
    return stat.S_ISFIFO(mode)


_ELSEWHERE = re.compile(r"[A-Za-z][A-Za-z0-9+.-]+:/|/vsi[a-z0-9_]+/|\\vsi")
"""A scheme of two letters or more (one is a drive), or a virtual file system of GDAL."""


def require_local(path: str | os.PathLike[str]) -> None:
    """Refuse an address in the network, or in a virtual file system of GDAL.

    Examples
    --------
    >>> require_local("survey.csv")
    """
    if _ELSEWHERE.match(str(path)):
        raise ReadError(
            f"'{path}' is an address, and only files of this machine are read: download it first, "
            "or let the option `remote` do so where points or a TIN are read.",
            path=Path(path),
        )
