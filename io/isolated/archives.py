"""Compressed files: what is plainly in them is unpacked into a folder of its own, within limits.

A gzip file holds one file. A ZIP archive is read if it holds one set of data: a file, or a file
with others of its name beside it, as a shapefile has.
"""

from __future__ import annotations

import gzip
import re
import shutil
import stat
import tempfile
import zipfile
import zlib
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import IO, TYPE_CHECKING, Any

from ...base.atomic import scratch_folder
from ...base.errors import ReadError, TinsmithError
from ...base.notes import naming_copy, naming_file
from ...base.sentences import FILE, counted
from .spooling import translate_system_errors

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

_GZIP, _ZIP = b"\x1f\x8b", b"PK\x03\x04"
_STARTS = {".gz": _GZIP, ".gzip": _GZIP, ".zip": _ZIP}
"""Suffixes of archives, and how they begin: a workbook is a ZIP archive too, and is none here."""

_CHUNK = 1 << 20
_MOST_FILES = 1000
_LARGEST_RATIO = 300
"""Times by which content may be larger than its archive: text of repeated rows comes to about 100,
zeros to 1,030."""

_LEAST = 1 << 26
"""Bytes that any archive may unpack to, whatever the ratio."""

_SIDE_FILES = frozenset(
    (
        *(".shx", ".dbf", ".prj", ".cpg", ".qpj", ".qix", ".sbn", ".sbx", ".idx", ".qmd", ".qml"),
        *(".xml", ".tfw", ".wld", ".jgw", ".hdr", ".clr", ".stx", ".ovr", ".aux", ".lox", ".sld"),
        *(".txt", ".md", ".pdf", ".html", ".htm", ".csvt", ".dat", ".map", ".id", ".rrd", ".qgz"),
    )
)
"""Suffixes of files that stand beside others; ``.txt`` counts where nothing else is there."""

_DAMAGES = (
    gzip.BadGzipFile,
    zipfile.BadZipFile,
    zlib.error,
    EOFError,
    ValueError,
    RuntimeError,
)

_MEMBER = re.compile(r"/vsizip/(.+?\.zip)/(.+)|zip://(.+?\.zip)!/?(.+)", re.IGNORECASE)
_OFFICE = "[Content_Types].xml"


@contextmanager
def unpack(path: Path) -> Iterator[Path]:
    """Yield a file that can be read: ``path`` itself, or what is compressed in it.

    Yields
    ------
    Path
        Removed at the end if it was unpacked; errors speak of ``path`` all the same.
    """
    start, suffix = _read_start(path), path.suffix.lower()
    if not start.startswith(_STARTS.get(suffix, b"no archive")):
        yield path
        return
    with scratch_folder() as folder:
        with _translate_damages(path):
            unpacker = _unpack_gzip if start.startswith(_GZIP) else _unpack_zip
            inner = unpacker(path, folder)
        with naming_copy(inner, path):
            yield inner


@contextmanager
def unpack_member(place: Any) -> Iterator[Any]:
    """Yield a file of a ZIP archive that GDAL or fsspec would find; anything else as it is.

    Parameters
    ----------
    place : path-like
        Such as ``/vsizip/site.zip/points.csv`` or ``zip://site.zip!points.csv``.

    Raises
    ------
    ReadError
        If there is no such archive, or no such file in it.
    """
    found = _MEMBER.fullmatch(str(place)) if isinstance(place, str | Path) else None
    if found is None:
        yield place
        return
    path, name = Path(found[1] or found[3]), found[2] or found[4]
    if not path.exists() and Path("/", path).exists():  # Path makes one slash of /vsizip//home
        path = Path("/", path)
    with scratch_folder() as folder:
        with _translate_damages(path):
            inner = _unpack_zip(path, folder, name)
        yield inner


@contextmanager
def _translate_damages(path: Path) -> Iterator[None]:
    """Raise what is wrong with an archive as a sentence."""
    with naming_file(path), translate_system_errors(path):
        try:
            yield
        except TinsmithError:
            raise
        except _DAMAGES as error:
            reason = " ".join(str(error).split()).rstrip(".") or type(error).__name__
            raise ReadError(f"{FILE} cannot be unpacked, it may be damaged: {reason}.") from error


def _read_start(path: Path) -> bytes:
    """Return the first bytes; a reader tells better why there are none."""
    try:
        with path.open("rb") as file:
            return file.read(4)
    except (OSError, ValueError):
        return b""


class _Budget:
    """How many bytes may still be unpacked."""

    def __init__(self, path: Path) -> None:
        self._most = max(_LEAST, _LARGEST_RATIO * path.stat().st_size)
        self._left = self._most

    def copy(self, stream: IO[bytes], target: Path) -> None:
        """Copy a stream into a file, and stop where it becomes too large."""
        with target.open("wb") as file:
            while chunk := stream.read(_CHUNK):
                self.spend(len(chunk))
                file.write(chunk)

    def spend(self, count: int) -> None:
        """Take bytes off, of a folder with room for them."""
        self._left -= count
        free = shutil.disk_usage(tempfile.gettempdir()).free
        if self._left < 0 or count > free:
            raise ReadError(
                f"{FILE} unpacks to more than {self._most / 1e6:,.0f} MB, the limit for an "
                "archive of this size: unpack it first, if it is sound.",
            )


def _unpack_gzip(path: Path, folder: Path) -> Path:
    name = Path(path.stem)
    inner = folder / (name if name.suffix else f"{name}.txt")
    budget = _Budget(path)
    with gzip.open(path, "rb") as stream:
        budget.copy(stream, inner)  # type: ignore[arg-type]
    return inner


def _unpack_zip(path: Path, folder: Path, name: str = "") -> Path:
    with zipfile.ZipFile(path) as archive:
        members = _list_members(archive)
        chosen = _find_member(members, name) if name else _choose_member(members)
        budget = _Budget(path)
        stem = _strip(PurePosixPath(chosen.filename))
        for member in members:
            if _strip(PurePosixPath(member.filename)) == stem:
                with archive.open(member) as stream:
                    budget.copy(stream, folder / PurePosixPath(member.filename).name)
    return folder / PurePosixPath(chosen.filename).name


def _list_members(archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    """Return the files of an archive; refuse what reaches outside of it, and what is encrypted."""
    members = [one for one in archive.infolist() if not one.is_dir()]
    if len(members) > _MOST_FILES:
        raise ReadError(
            f"{FILE} holds {len(members):,} files: unpack it, and name the one to read.",
        )
    for one in members:
        name = PurePosixPath(one.filename.replace("\\", "/"))
        is_link = stat.S_ISLNK(one.external_attr >> 16)
        if name.is_absolute() or ".." in name.parts or ":" in one.filename or is_link:
            raise ReadError(
                f"{FILE} holds {one.filename!a}, a place outside of it: it is not unpacked.",
            )
        if one.flag_bits & 1:
            raise ReadError(f"{FILE} is encrypted: unpack it first with its password.")
    return [one for one in members if not _is_hidden(one)]


def _is_hidden(member: zipfile.ZipInfo) -> bool:
    """Whether a file is one that a system adds."""
    parts = PurePosixPath(member.filename).parts
    return "__MACOSX" in parts or parts[-1].startswith(".") or parts[-1] == "Thumbs.db"


def _strip(name: PurePosixPath) -> str:
    """Return folder and name without any suffix: ``a/dem.tif.aux.xml`` is beside ``a/dem.tif``."""
    return str(name.parent / name.name.partition(".")[0]).casefold()


def _find_member(members: Sequence[zipfile.ZipInfo], name: str) -> zipfile.ZipInfo:
    found = [one for one in members if one.filename == name]
    if not found:
        names = ", ".join(one.filename for one in members[:5])
        more = f" and {len(members) - 5:,} more" if len(members) > 5 else ""
        raise ReadError(f"{FILE} has no file '{name}': it holds {names or 'none'}{more}.")
    return found[-1]


def _choose_member(members: Sequence[zipfile.ZipInfo]) -> zipfile.ZipInfo:
    """Return the only file that others stand beside, if there is only one."""
    if any(one.filename == _OFFICE for one in members):
        raise ReadError(
            f"{FILE} is an Office document (such as an Excel workbook): save it as CSV.",
        )
    suffixes = [PurePosixPath(one.filename).suffix.lower() for one in members]
    main = [one for one, suffix in zip(members, suffixes, strict=True) if suffix not in _SIDE_FILES]
    if not main:
        main = [one for one, suffix in zip(members, suffixes, strict=True) if suffix == ".txt"]
    if len(main) == 1:
        return main[0]
    if not main:
        raise ReadError(f"{FILE} holds no data: there is no file in it to read.")
    names = ", ".join(one.filename for one in main[:5])
    more = f" and {counted(len(main) - 5, 'more', 'more')}" if len(main) > 5 else ""
    raise ReadError(
        f"{FILE} holds several files ({names}{more}): unpack it, or name the one to read, as "
        f"'/vsizip/ARCHIVE.zip/{main[0].filename}'.",
    )
