"""Read files: the reader is chosen by name, else by content, else by suffix."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from .._sentences import printable
from ..crs import CRS, Unit
from ..errors import CrsError, FormatError, MissingExtraError, ReadError, TinsmithError
from ..tin import Survey
from .isolated.local_files import require_local
from .isolated.spooling import describe_system_error, open_ordinary_file, spool
from .raster.virtual import is_virtual
from .registry import (
    Format,
    choose_format,
    find_format,
    find_format_of_suffix,
    find_suffixes,
    known_formats,
    list_suffixes,
    load_function,
    require_options,
    signatures,
)

if TYPE_CHECKING:
    import os
    from collections.abc import Mapping

    from ..crs import CrsLike, UnitLike
    from ..tin import TIN

__all__ = ["detect", "read", "read_stream"]


def read(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 - the word that users of the package know
    crs: CrsLike | None = None,
    z_unit: UnitLike | None = None,
    **options: Any,
) -> Any:
    """Read elevation points or a TIN; the reader is chosen by content and suffix.

    Parameters
    ----------
    path : path-like
    format : str, optional
        Name of a format, to choose it whatever the file looks like.
    crs : CRS, str, int or pyproj.CRS, optional
        Coordinate reference system. It declares that of a file which has none; points of a file
        with another one are reprojected to it, a TIN with another one is refused.
    z_unit : Unit or str, optional
        Unit of the file's elevations ("m", "ft", "US survey foot"), where the file itself does not
        say. After a reprojection they have the unit of ``crs``: see
        :func:`tinsmith.transform_points`.
    **options
        Options of the reader, see :meth:`Format.options`.

    Returns
    -------
    Survey or TIN
        A TIN from a mesh format. Type checkers take it for either, as the file decides.

    Raises
    ------
    ReadError
        If the file is missing, a folder, empty, not permitted, or its content is faulty.
    FormatError
        If no format fits, or the format has no such option.
    CrsError
        If the CRS is unknown, or another than that of a TIN.
    OptionError
        If an option has a value that it cannot have; if the unit is unknown, or another than the
        one that the file gives.
    MissingExtraError
        If the library that reads the format is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(tin, Path(folder, "surface.ply"))
    ...     ts.read(Path(folder, "surface.ply"))
    <TIN: 3 vertices, 1 triangle, z 5 to 8, crs EPSG:32616>
    """
    require_local(path)
    file = Path(path)
    declared = _collect_declared(crs, z_unit)
    with open_ordinary_file(file) as local:
        found = _read_file(local, format, declared, options)
    return found if local == file else _restore_source(found, local, file)


def _collect_declared(crs: CrsLike | None, z_unit: UnitLike | None) -> dict[str, Any]:
    """Return what the caller says of the coordinates, as options of a reader."""
    unit = Unit.of(z_unit)
    return {"crs": CRS.of(crs)} | ({} if unit is None else {"z_unit": unit})


def read_stream(
    stream: IO[bytes],
    name: str,
    *,
    format: str | None = None,  # noqa: A002 - as in read
    crs: CrsLike | None = None,
    z_unit: UnitLike | None = None,
    **options: Any,
) -> Survey | TIN:
    """Read elevation points or a TIN from a stream, such as standard input; as :func:`read`.

    Parameters
    ----------
    stream : binary file object
    name : str
        What reports and errors call it.
    """
    source = Path(name)
    declared = _collect_declared(crs, z_unit)
    with spool(stream, source) as local:
        return _restore_source(_read_file(local, format, declared, options), local, source)


def _read_file(
    file: Path, name: str | None, declared: Mapping[str, Any], options: Mapping[str, Any]
) -> Survey | TIN:
    head = _read_head(file)
    chosen = detect(file, head) if name is None else find_format(name)
    if chosen.read is None:
        raise FormatError(
            f"'{file}' is {chosen.description}, a format that is written, not read: "
            f"{list_suffixes('read')} can be read.",
            known=find_suffixes("read"),
        )
    reader = load_function(chosen.read)
    of_file = {name: declared[name] for name in declared if name != "crs"} | dict(options)
    require_options(chosen, "read", reader, of_file)
    try:
        survey: Survey | TIN = reader(file, crs=declared["crs"], **of_file)
    except CrsError as error:
        raise _name_file(error, file) from error
    except OSError as error:  # a file that vanishes, a disk that fails
        if isinstance(error, TinsmithError):
            raise
        raise describe_system_error(file, error) from error
    return survey


def _restore_source(found: Survey | TIN, copy: Path, file: Path) -> Survey | TIN:
    """Return what was read from a copy as if it had been read from the file."""
    if not isinstance(found, Survey):
        return found
    notes = [note.replace(copy.name, file.name) for note in found.notes]
    return replace(found, source=file.name, notes=notes)


def _name_file(error: CrsError, file: Path) -> CrsError:
    """Return an error of a CRS with the name of the file that it stands in."""
    sentence = str(error) if str(file) in str(error) else f"'{file}': {error}"
    return CrsError(printable(sentence), crs=error.crs)


def detect(path: Path, head: bytes) -> Format:
    """Choose the format to read a file with.

    Parameters
    ----------
    path : Path
    head : bytes
        The first bytes of the file.

    Raises
    ------
    FormatError
        If neither content nor suffix is known.

    Notes
    -----
    1. A signature in the content decides, whatever the suffix.
    2. A text that names other files or services, or of a format that is not read, is refused;
       a virtual raster is read under its own suffix.
    3. A table of numbers is delimited text where the suffix names a format that the content
       would have shown, so that an ``.asc`` may be a grid or a list of points.
    4. Otherwise the suffix decides.
    5. A file of unknown suffix is a raster if GDAL says so.
    """
    for one in known_formats():
        if one.sniff is not None and one.sniff(head):
            return one
    if is_virtual(path):
        return find_format("raster")
    _require_not_foreign(path, head)
    by_suffix = choose_format(path.suffix.lower(), "read")
    if by_suffix is not None and (by_suffix.sniff is None or not _is_table(head)):
        return by_suffix
    if by_suffix is not None:
        return find_format("delimited")
    if _is_binary(head) and _is_gdal_raster(path):
        return find_format("raster")
    return find_format_of_suffix(path, "read")


def _require_not_foreign(path: Path, head: bytes) -> None:
    kind = signatures.find_foreign_kind(head)
    if kind is not None:
        raise FormatError(
            f"'{path}' is {kind}, which cannot be read: {list_suffixes('read')} can.",
            known=find_suffixes("read"),
        )


def _is_binary(head: bytes) -> bool:
    return b"\x00" in head


def _is_table(head: bytes) -> bool:
    """Whether the head reads as delimited rows of numbers."""
    from .delimited.marks import looks_like_table

    return looks_like_table(head)


def _is_gdal_raster(path: Path) -> bool:
    from .raster.dem import is_raster

    try:
        return is_raster(path)
    except MissingExtraError:
        return False


def _read_head(path: Path) -> bytes:
    """Return the first bytes of a file that is there, permitted and not empty."""
    try:
        if path.is_dir():
            raise ReadError(f"'{path}' is a folder: name a file in it.", path=path)
        with path.open("rb") as file:
            head = file.read(signatures.HEAD_BYTES)
    except ReadError:
        raise
    except OSError as error:
        raise describe_system_error(path, error) from error
    except ValueError as error:
        raise ReadError(f"Cannot read {str(path)!r}: {error}.", path=path) from error
    if not head:
        raise ReadError(f"'{path}' is empty: there are no points in it.", path=path)
    return head
