"""Side files: what stands beside a file and belongs to it, by the formats that are known."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import TYPE_CHECKING

from ...base.atomic import replacing_files
from ...base.crs import CRS
from ...base.errors import CrsError, ReadError, WriteError
from ...base.sentences import FILE
from .lookup import find_format, known_formats, list_claims

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from .format import Format

_PROJECTION = ".prj"


def list_sources(path: Path) -> list[Path]:
    """Return the files that are read with a file: those beside it, and others that it names.

    Only those that are there, of any format that reads files of such a name.
    """
    formats = [one for one in known_formats() if one.read is not None]
    claims = list_claims(formats, path)
    found = [beside for beside in _list_beside(path, claims) if os.path.lexists(beside)]
    for one in claims:
        if one.find_sources is not None:
            try:
                found += one.find_sources(path)
            except (OSError, ReadError):  # which reading it tells
                continue
    return found


def is_replaceable_folder(path: Path) -> bool:
    """Whether a folder is there, of a format whose writer replaces such folders."""
    of_folders = [one for one in known_formats() if one.write and not one.suffixes]
    sniffs = [one.sniff_folder for one in of_folders if one.sniff_folder is not None]
    return path.is_dir() and any(sniff(path) for sniff in sniffs)


def list_written_beside(path: Path) -> list[Path]:
    """Return the files that may be replaced or removed where a file is written."""
    formats = [one for one in known_formats() if one.write is not None]
    return _list_beside(path, list_claims(formats, path))


def _list_beside(path: Path, formats: Iterable[Format]) -> list[Path]:
    """Return the names of side files, in small letters and in capitals."""
    if not path.name:
        return []
    names: dict[Path, None] = {}
    for one in formats:
        for end in _list_ends(one, path):
            for written in (end, end.upper()):
                if written.startswith("*"):
                    names[path.with_name(path.name + written[1:])] = None
                else:
                    names[path.with_suffix(written)] = None
    names.pop(path, None)
    return list(names)


def _list_ends(one: Format, path: Path) -> tuple[str, ...]:
    of_all = one.side_files.get("", ())
    return (*of_all, *one.side_files.get(path.suffix.lower(), ()))


@contextmanager
def replacing_data_set(path: Path, name: str) -> Iterator[Path]:
    """Yield a path of the same name in a new folder, for writers of a file with side files.

    Parameters
    ----------
    path : Path
    name : str
        Of the format, whose side files of an earlier file are replaced or removed.

    Yields
    ------
    Path
        As :func:`tinsmith.base.atomic.replacing_files`.

    Raises
    ------
    WriteError
        Also if a side file belongs to another data set, which would be changed with it; a .prj that
        tells the same CRS is left as it is.
    """
    ends = _list_ends(find_format(name, "write"), path)
    parts = [path.suffix + end[1:] if end.startswith("*") else end for end in ends]
    with replacing_files(path, parts=parts) as new:
        yield new
        target = path.resolve()
        for part in list(parts):
            there = target.with_name(target.stem + part)
            owner = _find_owner(there, target) if there.exists() else None
            if owner is not None:
                _require_same(new.with_name(new.stem + part), there, owner)
                parts.remove(part)


def _find_owner(there: Path, target: Path) -> Path | None:
    for other in sorted(there.parent.iterdir()):
        is_like = there.name.startswith(other.stem) and other not in (there, target)
        if is_like and other.is_file() and there in _list_beside(other, _list_readers(other)):
            return other
    return None


def _list_readers(path: Path) -> list[Format]:
    return list_claims([one for one in known_formats() if one.read is not None], path)


def _require_same(made: Path, there: Path, owner: Path) -> None:
    """Refuse to replace a side file of another data set; one that says the same is not written."""
    if made.exists() and _are_same(made, there):
        made.unlink()
        return
    raise WriteError(
        f"Cannot write {FILE}: '{there.name}' beside it would be replaced, which belongs to "
        f"'{owner.name}'; give the output another name.",
    )


def _are_same(made: Path, there: Path) -> bool:
    if made.read_bytes() == there.read_bytes():
        return True
    if made.suffix.lower() != _PROJECTION:
        return False
    try:
        one, other = (CRS(file.read_text("utf-8")) for file in (made, there))
    except (CrsError, UnicodeDecodeError):
        return False
    return one.is_same(other)
