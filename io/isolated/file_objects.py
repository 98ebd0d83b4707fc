"""File objects in place of files: read from a temporary copy, written to when a file is whole."""

from __future__ import annotations

import io
import shutil
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from ...base.atomic import scratch_folder
from ...base.errors import FormatError, OptionError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..registry import Format

_CHUNK = 1 << 20
_NAMELESS = "stream"


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
