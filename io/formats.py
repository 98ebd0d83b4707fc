"""The formats and the choice between them: by name, else by content, else by suffix.

A format is a value; its reader and writer are named, and loaded when first used. Another package
adds one through the entry-point group ``tinsmith.formats``: each entry names a :class:`Format`.
"""

from __future__ import annotations

import inspect
import os
from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from .._sentences import printable
from ..crs import CRS, Unit
from ..errors import CrsError, FormatError, MissingExtraError, ReadError, TinsmithError
from ..tin import Survey
from . import signatures
from .local import require_local
from .raster_virtual import is_virtual
from .spooling import as_sentence, ordinary_file, spooled

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..crs import CrsLike, UnitLike
    from ..tin import TIN

__all__ = ["Format", "detect", "find_format", "known_formats", "read", "read_stream", "write"]

_ENTRY_POINTS = "tinsmith.formats"
_OWN_PARAMETERS = frozenset({"crs", "z_unit", "progress"})


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A file format.

    Attributes
    ----------
    name : str
        What ``format=`` calls it.
    description : str
        A few words for a list.
    suffixes : tuple of str
        Lower case, with the dot; a writer is chosen by them, a reader where the content is silent.
    read, write : str, optional
        ``"module:function"``. A reader takes ``(path, *, crs=None, z_unit=None, <options>)``, a CRS
        and a Unit or None, and returns a Survey or a TIN; a writer ``(obj, path, *, <options>)``.
    extra : str, optional
        The extra of this package that brings the library it needs.
    sniff : callable, optional
        Whether the first bytes of a file are certainly of this format.
    """

    name: str
    description: str
    suffixes: tuple[str, ...]
    read: str | None = None
    write: str | None = None
    extra: str | None = None
    sniff: Callable[[bytes], bool] | None = None

    def options(self, action: str) -> tuple[str, ...]:
        """Return the names of the options of its reader or writer (``"read"``, ``"write"``)."""
        target = getattr(self, action)
        return () if target is None else _options(_load(target))


_DELIMITED = Format(
    name="delimited",
    description="Delimited text: survey points as CSV, TXT, XYZ",
    suffixes=(".csv", ".txt", ".xyz", ".tsv", ".pts", ".dat", ".pnt"),
    read="tinsmith.io.delimited:read",
    write="tinsmith.io.delimited:write",
)
_BUILT_IN = (
    _DELIMITED,
    Format(
        name="raster",
        description="Elevation rasters that GDAL reads: GeoTIFF, VRT, IMG, HGT, ASC, netCDF ...",
        suffixes=(
            *(".tif", ".tiff", ".vrt", ".img", ".dem", ".hgt", ".asc", ".grd", ".nc", ".bil"),
            *(".bip", ".bsq", ".flt", ".dt0", ".dt1", ".dt2", ".adf", ".sdat", ".rst", ".bt"),
            *(".jp2", ".png", ".jpg", ".grb", ".grb2", ".ntf"),
        ),
        read="tinsmith.io.raster:read",
        extra="raster",
        sniff=signatures.is_raster,
    ),
    Format(
        name="geojson",
        description="GeoJSON (RFC 7946)",
        suffixes=(".geojson", ".json"),
        write="tinsmith.io.geojson:write",
        sniff=signatures.is_geojson,
    ),
    Format(
        name="ply",
        description="PLY mesh (opens in QGIS, CloudCompare, MeshLab)",
        suffixes=(".ply",),
        read="tinsmith.io.ply:read",
        write="tinsmith.io.ply:write",
        sniff=signatures.is_ply,
    ),
    Format(
        name="obj",
        description="Wavefront OBJ mesh",
        suffixes=(".obj",),
        read="tinsmith.io.obj:read",
        write="tinsmith.io.obj:write",
        sniff=signatures.is_obj,
    ),
    Format(
        name="stl",
        description="STL mesh",
        suffixes=(".stl",),
        read="tinsmith.io.stl:read",
        write="tinsmith.io.stl:write",
        sniff=signatures.is_stl,
    ),
    Format(
        name="vtk",
        description="VTK XML mesh (opens in ParaView)",
        suffixes=(".vtp", ".vtu"),
        read="tinsmith.io.vtk:read",
        write="tinsmith.io.vtk:write",
        extra="view",
        sniff=signatures.is_vtk_xml,
    ),
    Format(
        name="gmsh",
        description="Gmsh mesh, with the edges of rim and lines (for finite element programs)",
        suffixes=(".msh",),
        read="tinsmith.io.gmsh:read",
        write="tinsmith.io.gmsh:write",
        extra="mesh",
        sniff=signatures.is_gmsh,
    ),
)


def read(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 - the word that users of the package know
    crs: CrsLike | None = None,
    z_unit: UnitLike | None = None,
    **options: Any,
) -> Survey | TIN:
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
        :func:`tinsmith.io.transform_points`.
    **options
        Options of the reader, see :meth:`Format.options`.

    Returns
    -------
    Survey or TIN
        A TIN from a mesh format.

    Raises
    ------
    ReadError
        If the file is missing, a folder, empty, not permitted, or its content is faulty.
    FormatError
        If no format fits, or the format has no such option.
    CrsError
        If the CRS is unknown, or another than that of a TIN.
    OptionError
        If the unit is unknown, or another than the one that the file gives.
    MissingExtraError
        If the library that reads the format is not installed.
    """
    require_local(path)
    file = Path(path)
    declared = _declared(crs, z_unit)
    with ordinary_file(file) as local:
        found = _read_file(local, format, declared, options)
    return found if local == file else _renamed(found, local, file)


def _declared(crs: CrsLike | None, z_unit: UnitLike | None) -> dict[str, Any]:
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
    declared = _declared(crs, z_unit)
    with spooled(stream, source) as local:
        return _renamed(_read_file(local, format, declared, options), local, source)


def _read_file(
    file: Path, name: str | None, declared: Mapping[str, Any], options: Mapping[str, Any]
) -> Survey | TIN:
    head = _head(file)
    chosen = detect(file, head) if name is None else find_format(name)
    if chosen.read is None:
        raise FormatError(
            f"'{file}' is {chosen.description}, a format that is written, not read: "
            f"{_names('read')} can be read.",
            known=_known("read"),
        )
    reader = _load(chosen.read)
    of_file = {name: declared[name] for name in declared if name != "crs"} | dict(options)
    _require_options(chosen, "read", reader, of_file)
    try:
        survey: Survey | TIN = reader(file, crs=declared["crs"], **of_file)
    except CrsError as error:
        raise _of_file(error, file) from error
    except OSError as error:  # a file that vanishes, a disk that fails
        if isinstance(error, TinsmithError):
            raise
        raise as_sentence(file, error) from error
    return survey


def _renamed(found: Survey | TIN, copy: Path, file: Path) -> Survey | TIN:
    """Return what was read from a copy as if it had been read from the file."""
    if not isinstance(found, Survey):
        return found
    notes = [note.replace(copy.name, file.name) for note in found.notes]
    return replace(found, source=file.name, notes=notes)


def _of_file(error: CrsError, file: Path) -> CrsError:
    """Return an error of a CRS with the name of the file that it stands in."""
    sentence = str(error) if str(file) in str(error) else f"'{file}': {error}"
    return CrsError(printable(sentence), crs=error.crs)


def write(
    obj: object,
    path: str | os.PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 - as in read
    **options: Any,
) -> Path:
    """Write a TIN or a Survey; the writer is chosen by suffix.

    Parameters
    ----------
    obj : TIN or Survey
    path : path-like
    format : str, optional
        Name of a format, to choose it whatever the suffix.
    **options
        Options of the writer, see :meth:`Format.options`.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    WriteError
        If the file cannot be written; one that was there before is left whole.
    FormatError
        If no format fits, or the format has no such option.
    MissingExtraError
        If the library that writes the format is not installed.
    """
    file = Path(path)
    chosen = _by_suffix(file, "write") if format is None else find_format(format)
    if chosen.write is None:
        raise FormatError(
            f"Cannot write '{file}': {chosen.description} can be read, not written; "
            f"{_names('write')} can be written.",
            known=_known("write"),
        )
    writer = _load(chosen.write)
    _require_options(chosen, "write", writer, options)
    writer(obj, file, **options)
    return file


@cache
def known_formats() -> tuple[Format, ...]:
    """Return the built-in formats, then those of installed plug-ins by name.

    Raises
    ------
    FormatError
        If a plug-in cannot be loaded, is no Format, or takes a name that is in use.
    """
    formats = list(_BUILT_IN)
    for entry in sorted(entry_points(group=_ENTRY_POINTS), key=lambda entry: entry.name):
        added = _from_plug_in(entry.name, entry.load)
        if any(added.name == one.name for one in formats):
            raise FormatError(f"Plug-in '{entry.name}' takes the name '{added.name}', in use.")
        formats.append(added)
    return tuple(formats)


def _from_plug_in(name: str, load: Callable[[], object]) -> Format:
    try:
        added = load()
    except Exception as error:
        raise FormatError(f"Format plug-in '{name}' cannot be loaded: {error}.") from error
    if not isinstance(added, Format):
        raise FormatError(f"Format plug-in '{name}' is a {type(added).__name__}, not a Format.")
    return added


def find_format(name: str) -> Format:
    """Look a format up by its name or one of its suffixes.

    Raises
    ------
    FormatError
        If there is none.

    Examples
    --------
    >>> find_format("csv").name
    'delimited'
    """
    wanted = name.strip().lower()
    suffix = wanted if wanted.startswith(".") else f".{wanted}"
    for one in known_formats():
        if one.name == wanted or suffix in one.suffixes:
            return one
    names = tuple(one.name for one in known_formats())
    raise FormatError(f"Unknown format '{name}': one of {', '.join(names)}.", known=names)


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
    by_suffix = _with_suffix(path.suffix.lower(), "read")
    if by_suffix is not None and (by_suffix.sniff is None or not _is_table(head)):
        return by_suffix
    if by_suffix is not None:
        return _DELIMITED
    if _is_binary(head) and _gdal_recognises(path):
        return find_format("raster")
    return _by_suffix(path, "read")


def _require_not_foreign(path: Path, head: bytes) -> None:
    kind = signatures.foreign_kind(head)
    if kind is not None:
        raise FormatError(
            f"'{path}' is {kind}, which cannot be read: {_names('read')} can.",
            known=_known("read"),
        )


def _is_binary(head: bytes) -> bool:
    return b"\x00" in head


def _is_table(head: bytes) -> bool:
    """Whether the head reads as delimited rows of numbers."""
    from .delimited_marks import looks_like_table

    return looks_like_table(head)


def _gdal_recognises(path: Path) -> bool:
    from .raster import recognises

    try:
        return recognises(path)
    except MissingExtraError:
        return False


def _with_suffix(suffix: str, action: str) -> Format | None:
    """Return the format of a suffix, one that can do the action first."""
    fitting = [one for one in known_formats() if suffix in one.suffixes]
    able = [one for one in fitting if getattr(one, action) is not None]
    return next(iter(able + fitting), None)


def _by_suffix(path: Path, action: str) -> Format:
    found = _with_suffix(path.suffix.lower(), action)
    if found is not None:
        return found
    suffix = f"has the unknown suffix '{path.suffix}'" if path.suffix else "has no suffix"
    raise FormatError(
        f"'{path}' {suffix}: {_names(action)} can be {'read' if action == 'read' else 'written'}; "
        "the option format names one whatever the suffix.",
        known=_known(action),
    )


def _known(action: str) -> tuple[str, ...]:
    return tuple(
        suffix
        for one in known_formats()
        if getattr(one, action) is not None
        for suffix in one.suffixes
    )


def _names(action: str) -> str:
    return ", ".join(_known(action))


def _head(path: Path) -> bytes:
    """Return the first bytes of a file that is there, permitted and not empty."""
    try:
        if path.is_dir():
            raise ReadError(f"'{path}' is a folder: name a file in it.", path=path)
        with path.open("rb") as file:
            head = file.read(signatures.HEAD_BYTES)
    except ReadError:
        raise
    except OSError as error:
        raise as_sentence(path, error) from error
    except ValueError as error:
        raise ReadError(f"Cannot read {str(path)!r}: {error}.", path=path) from error
    if not head:
        raise ReadError(f"'{path}' is empty: there are no points in it.", path=path)
    return head


def _load(target: str) -> Callable[..., Any]:
    module, _, function = target.partition(":")
    loaded: Callable[..., Any] = getattr(import_module(module), function)
    return loaded


def _options(function: Callable[..., Any]) -> tuple[str, ...]:
    parameters = inspect.signature(function).parameters.values()
    return tuple(
        one.name
        for one in parameters
        if one.kind is one.KEYWORD_ONLY and one.name not in _OWN_PARAMETERS
    )


def _require_options(
    chosen: Format, action: str, function: Callable[..., Any], options: Mapping[str, object]
) -> None:
    allowed = _options(function)
    accepted = {*allowed, "progress", "z_unit"} & set(inspect.signature(function).parameters)
    unknown = [name for name in options if name not in accepted]
    if not unknown:
        return
    there_are = f"its options are {', '.join(allowed)}" if allowed else "it has no options"
    raise FormatError(
        f"Unknown option '{unknown[0]}' to {action} the format {chosen.name}: {there_are}.",
        known=allowed,
    )
