"""File objects in place of files: read from a temporary copy, written to when a file is whole."""

from __future__ import annotations

import io
import re
import shutil
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ...base.atomic import scratch_folder
from ...base.errors import FormatError, OptionError
from ...base.notes import naming_copy
from .archives import unpack_member

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..registry import Format

_CHUNK = 1 << 20
_NAMELESS = "stream"
_HEAD = 4096
_BINARY = (".gpkg", ".fgb", ".parquet", ".zip")
_STARTS = {
    b"SQLite format 3\0": ".gpkg",
    b"fgb": ".fgb",
    b"PAR1": ".parquet",
    b"PK\x03\x04": ".zip",
    b"{": ".geojson",
    b"[": ".json",
    b"<": ".xml",
}
_DXF_START = re.compile(rb"(?:999\r?\n.*\r?\n)*0\r?\nSECTION|AutoCAD Binary DXF")


def is_file_object(given: Any) -> bool:
    """Whether something is a file object, of bytes or of text: not a dataset with a ``read``."""
    return callable(getattr(given, "readable", None)) and hasattr(given, "read")


def as_bytes(stream: Any) -> IO[bytes]:
    """Return a file object that gives bytes: text becomes UTF-8.

    Raises
    ------
    OptionError
        If it cannot be read: it is closed, or opened for writing.
    """
    try:
        is_open = not getattr(stream, "closed", False) and stream.readable()
        if is_open and isinstance(stream, io.TextIOBase):
            return io.BytesIO(stream.read().encode("utf-8"))
    except (ValueError, OSError):  # closed below its wrapper, or no text in its encoding
        is_open = False
    if not is_open:
        raise OptionError("path", stream, "a file object that can be read, or the name of a file")
    found: IO[bytes] = stream
    return found


def name_stream(stream: Any, suffixes: tuple[str, ...] = ()) -> str:
    """Return what sentences call a file object: its name, with a suffix of its format."""
    name = getattr(stream, "name", None)
    if isinstance(name, str) and Path(name).name:
        return Path(name).name
    return f"{_NAMELESS}{suffixes[0] if suffixes else ''}"


@contextmanager
def as_local_file(path: Any) -> Iterator[Any]:
    """Yield a copy of what a file object or a member of an archive holds; a path as it is.

    The copy of a file object without a name has the suffix of what its content shows, of a table
    if it shows nothing else.
    """
    if not is_file_object(path):
        with unpack_member(path) as member:
            yield member
        return
    content = io.BytesIO(as_bytes(path).read())
    name = Path(name_stream(path))
    if not name.suffix:
        name = name.with_suffix(_find_suffix(content.getbuffer()[:_HEAD].tobytes()))
    with scratch_folder() as folder:  # which notes name by its name, too
        copy = Path(folder, name.name)
        copy.write_bytes(content.getbuffer())
        with naming_copy(copy, name):
            yield copy


def _find_suffix(head: bytes) -> str:
    """Return the suffix of a format of lines or tables, by the first bytes of a file."""
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    for start, suffix in _STARTS.items():
        if (head if suffix in _BINARY else text).startswith(start):
            return suffix
    return ".dxf" if _DXF_START.match(text) else ".csv"


@contextmanager
def writing_into(stream: Any, chosen: Format) -> Iterator[Path]:
    """Yield the path of a temporary file, whose bytes are written to a file object at the end.

    Nothing is written where the block ends with an error.

    Raises
    ------
    OptionError
        If the file object takes no bytes, or text and the format is none.
    FormatError
        If the format has several files.
    """
    try:
        is_open = not getattr(stream, "closed", False) and stream.writable()
    except ValueError:
        is_open = False
    if not is_open:
        raise OptionError("path", stream, "a file object that can be written, or a name of a file")
    if isinstance(stream, io.TextIOBase) and not chosen.is_text:
        allowed = f"a file object of bytes, as the format {chosen.name} is binary"
        raise OptionError("path", stream, allowed)
    with scratch_folder() as folder:
        path = folder / f"{_NAMELESS}{next(iter(chosen.suffixes), '')}"
        yield path
        made = sorted(one.name for one in folder.iterdir())
        if made != [path.name] or path.is_dir():
            raise FormatError(
                f"A file object holds one file, and the format {chosen.name} has several: "
                f"{', '.join(made)}."
            )
        if isinstance(stream, io.TextIOBase):
            stream.write(path.read_bytes().decode("utf-8"))
            return
        with path.open("rb") as file:
            shutil.copyfileobj(file, stream, _CHUNK)
