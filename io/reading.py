"""Read files: the reader is chosen by name, else by content, else by suffix."""

from __future__ import annotations

import logging
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import IO, TYPE_CHECKING, Any, NamedTuple, cast, overload

from ..base.atomic import as_path
from ..base.checks import as_flag
from ..base.crs import CRS, Unit
from ..base.errors import (
    FormatError,
    MissingExtraError,
    OptionError,
    ReadError,
    TinsmithError,
)
from ..base.notes import naming_file
from ..base.plug_ins import describe_failure, warn_of_plug_in
from ..base.progress import Progress
from ..base.sentences import FILE, counted, inflect, printable
from ..tin import TIN, Survey
from .isolated import (
    as_bytes,
    describe_system_error,
    is_file_object,
    name_stream,
    open_ordinary_file,
    require_local,
    spool,
    translate_system_errors,
    unpack,
    unpack_member,
)
from .lidar import is_virtual_cloud, list_named_files
from .lidar import list_tiles as list_lidar_tiles
from .raster import is_virtual
from .registry import Format, lookup, require_options, signatures, takes_progress
from .reprojection import checking_crs

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from ..base.crs import CrsLike, UnitLike
    from ..base.progress import Tell

_NO_FALLBACKS: Mapping[str, Any] = MappingProxyType({})
_SHOWN = 5
_LOGGER = logging.getLogger("tinsmith")


class Asked(NamedTuple):
    """What a caller says of a file: format, CRS and unit, options, fallbacks, and progress."""

    format: str | None
    declared: Mapping[str, Any]
    options: Mapping[str, Any]
    fallbacks: Mapping[str, Any] = _NO_FALLBACKS
    progress: Tell | None = None


def ask(
    fallbacks: Mapping[str, Any] = _NO_FALLBACKS,
    *,
    format: str | None = None,  # noqa: A002 - as in read
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    **options: Any,
) -> Asked:
    """Return what a caller says of a file, by options of :func:`read` and fallbacks for them."""
    unit = Unit.of(elevation_unit)
    declared = {"crs": CRS.of(crs)} | ({} if unit is None else {"elevation_unit": unit})
    return Asked(format, declared, options, fallbacks)


@overload
def read(
    path: str | os.PathLike[str] | IO[Any],
    *,
    format: str | None = None,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    remote: bool = False,
    check_crs: bool = True,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Any: ...


@overload
def read(
    path: Sequence[str | os.PathLike[str]],
    *,
    format: str | None = None,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    remote: bool = False,
    check_crs: bool = True,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Survey: ...


def read(
    path: str | os.PathLike[str] | IO[Any] | Sequence[str | os.PathLike[str]],
    *,
    format: str | None = None,  # noqa: A002 - the word that users of the package know
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    remote: bool = False,
    check_crs: bool = True,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Any:
    r"""Read elevation points or a TIN; the reader is chosen by content and suffix.

    Parameters
    ----------
    path : path-like, file object, or sequence of path-like
        A file, a file object of bytes or text that holds one, or a folder: a format of its own,
        tiles of lidar, or files of points of one format. Several files, or those of a folder, are
        one survey, whose attribute ``source_file`` says where each point is from. What is
        compressed (``.gz``, ``.zip``) is unpacked, if one set of data is in it;
        ``/vsizip/site.zip/points.csv`` names one of several files.
    format : str, optional
        Name of a format, to choose it whatever the file looks like.
    crs : CRS, str, int or pyproj.CRS, optional
        Coordinate reference system. It declares that of a file which has none; points of a file
        with another one are reprojected to it, a TIN with another one is refused.
    elevation_unit : Unit or str, optional
        Unit of the file's elevations ("m", "ft", "US survey foot"), where the file itself does not
        say. After a reprojection they have the unit of ``crs``: see
        :func:`tinsmith.transform_points`.
    remote : bool
        Whether paths may be addresses of HTTP or HTTPS, which are copied to a temporary file.
        Nothing is fetched otherwise.
    check_crs : bool
        Refuse coordinates that contradict their CRS: that lie in its area of use only with easting
        and northing exchanged, or only as degrees, or are in another unit by what the file says.
        False takes them as they are, with a note.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0: within files of lidar, rasters and
        delimited text, else file by file. What it raises ends the call.
    **options
        Options of the reader, which ``tinsmith formats NAME`` explains. Of text: ``columns``,
        ``delimiter``, ``decimal``, ``comment``, ``encoding``, ``skip_bad``, ``source_crs``,
        ``nodata``; of instruments ``code_blocks``, ``oriented``, ``refraction``; of rasters
        ``band``, ``cells``, ``stride``, ``most_cells``, ``fill``, ``nodata``, ``window``; of lidar
        ``classes``, ``returns``, ``resolution``, ``every``, ``withheld``, ``attributes``,
        ``window``; of vector layers ``layer``, ``z_field``, ``where``, ``lines_as``, ``nodata``; of
        LandXML, 12d and DXF ``unit``, ``content``, ``surface``, ``layer``, ``texts``,
        ``tolerance``; of meshes ``faces``, ``surface``, ``variable``, ``join``, ``tile``,
        ``positive``, ``frame``.

    Returns
    -------
    Survey or TIN
        A TIN from a mesh format; of several files always a Survey. Type checkers take what one file
        holds for either, as the file decides.

    Raises
    ------
    ReadError
        If the file is missing, a folder, empty, not permitted, or its content is faulty.
    FormatError
        If no format fits, or the format has no such option.
    CrsError
        If the CRS is unknown, or another than that of a TIN; if coordinates contradict it; if
        several files are in several and ``crs`` does not say which is wanted.
    OptionError
        If there is no path; if an option has a value that it cannot have; if the unit is unknown,
        or another than the one that the file gives.
    MissingExtraError
        If the library that reads the format is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> rows = ["number,easting,northing,elevation", "1,0,0,5", "2,4,0,6", "3,0,3,8"]
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder, "site.csv")
    ...     size = path.write_text("\n".join(rows))
    ...     ts.read(path, crs="EPSG:32616")
    <Survey: 3 points from site.csv, attributes number, crs EPSG:32616>
    """
    return read_with_fallbacks(
        path,
        {},
        format=format,
        crs=crs,
        elevation_unit=elevation_unit,
        remote=remote,
        check_crs=check_crs,
        progress=progress,
        **options,
    )


def read_with_fallbacks(
    path: str | os.PathLike[str] | IO[Any] | Sequence[str | os.PathLike[str]],
    fallbacks: Mapping[str, Any],
    *,
    remote: bool = False,
    check_crs: bool = True,
    progress: Callable[[float], None] | None = None,
    **how: Any,
) -> Survey | TIN:
    """Read a file as :func:`read`, with options that count for the formats which have them.

    Parameters
    ----------
    path : path-like, file object, or sequence of path-like
    fallbacks : mapping of str to object
        Options of readers; one that the chosen reader does not have is left out.
    **how
        As of :func:`read`.
    """
    remote = as_flag("remote", remote)
    done = Progress(progress)
    if is_file_object(path):
        known = lookup.find_format(how["format"]).suffixes if how.get("format") is not None else ()
        name = name_stream(path, known)
        found = read_stream(as_bytes(path), name, fallbacks, check_crs=check_crs, **how)
        done.end()
        return _log(found, name)
    asked = ask(fallbacks, **how)._replace(progress=done.stage(0.0, 1.0))
    places = path if isinstance(path, list | tuple) else [cast("str | os.PathLike[str]", path)]
    with ExitStack() as copies:
        if remote:
            places = [copies.enter_context(_localise(place)) for place in places]
        places = [copies.enter_context(unpack_member(place)) for place in places]
        with done.passing_on(), checking_crs(check_crs):
            found = _read_several(require_paths(places), asked)
    done.end()
    return _log(found, str(path))


def _log(found: Survey | TIN, name: str) -> Survey | TIN:
    """Tell the logger what was read, and what was assumed; return it."""
    if _LOGGER.isEnabledFor(logging.INFO):
        _LOGGER.info("Read %s: %r", printable(name), found)
        for note in found.notes:
            _LOGGER.info("%s: %s", printable(name), note)
    return found


@contextmanager
def _localise(place: str | os.PathLike[str]) -> Iterator[str | os.PathLike[str]]:
    """Yield a copy of what an address holds; anything else as it is."""
    from .isolated import download, is_web_address  # HTTP costs time to load

    if not (isinstance(place, str | Path) and is_web_address(place)):
        yield place
        return
    with download(place) as copy:
        yield copy


def _name_folder(survey: Survey, folder: Path, tiles: Sequence[Path]) -> Survey:
    """Return the survey of a folder's files, with a note of those that were not read."""
    others = sorted(one.name for one in folder.iterdir() if _is_visible_file(one))
    names = [name for name in others if name not in {one.name for one in tiles}]
    if not names:
        return replace(survey, source=folder.name)
    more = f" and {len(names) - _SHOWN:,} more" if len(names) > _SHOWN else ""
    read = inflect(f"{counted(len(tiles), 'file')} [was|were] read", len(tiles))
    note = f"In '{folder.name}' {read}, and not {', '.join(names[:_SHOWN])}"
    return replace(survey, source=folder.name, notes=[*survey.notes, f"{printable(note)}{more}."])


def require_paths(paths: Sequence[Any]) -> list[Path]:
    """Return local paths, at least one."""
    if not paths:
        raise OptionError("path", paths, "the name of a file, or a list of at least one")
    for one in paths:
        require_local(one)
    return [as_path(one) for one in paths]


def _read_several(paths: Sequence[Path], asked: Asked) -> Survey | TIN:
    """Read files as one survey; a single one as what it is."""
    done = Progress(asked.progress)
    found = []
    for number, path in enumerate(paths):
        part = done.stage(number / len(paths), (number + 1) / len(paths))
        found.append(_read_path(path, asked._replace(progress=part)))
        done((number + 1) / len(paths))
    return found[0] if len(found) == 1 else join_files(found, paths)


def read_points(
    path: str | os.PathLike[str] | IO[Any] | Sequence[str | os.PathLike[str]], **options: Any
) -> Survey:
    """Read elevation points: :func:`read` for programs that need to know what they get.

    Parameters
    ----------
    path : path-like, file object, or sequence of path-like
    **options
        As of :func:`read`.

    Returns
    -------
    Survey

    Raises
    ------
    ReadError
        If the file holds a TIN; else as :func:`read`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> survey = ts.Survey(points=[[0, 0, 5], [4, 0, 6], [0, 3, 8]])
    >>> with TemporaryDirectory() as folder:
    ...     ts.read_points(ts.write(survey, Path(folder, "points.csv")), crs="EPSG:32616")
    <Survey: 3 points from points.csv, crs EPSG:32616>
    """
    found = read(path, **options)
    if isinstance(found, Survey):
        return found
    raise ReadError(f"'{_name(path)}' holds a TIN, not points alone: read_tin reads it.")


def read_tin(path: str | os.PathLike[str] | IO[Any], **options: Any) -> TIN:
    """Read a TIN: :func:`read` for programs that need to know what they get.

    Parameters
    ----------
    path : path-like or file object
    **options
        As of :func:`read`.

    Returns
    -------
    TIN

    Raises
    ------
    ReadError
        If the file holds points alone; else as :func:`read`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
    >>> with TemporaryDirectory() as folder:
    ...     ts.read_tin(ts.write(tin, Path(folder, "surface.ply"))) == tin
    True
    """
    found = read(path, **options)
    if isinstance(found, TIN):
        return found
    raise ReadError(f"'{_name(path)}' holds points alone, no TIN: triangulate makes one of them.")


def _name(path: Any) -> str:
    return name_stream(path) if is_file_object(path) else str(path)


def join_files(found: Sequence[Survey | TIN], paths: Sequence[Path]) -> Survey:
    """Return the surveys of files as one.

    Raises
    ------
    ReadError
        If one is a TIN.
    CrsError
        As :func:`tinsmith.read`.
    """
    surveys = []
    for one, path in zip(found, paths, strict=True):
        if isinstance(one, TIN):
            raise ReadError(
                f"'{path}' holds a TIN, whose triangles cannot be joined with others: several "
                "files are read as one only where all hold points.",
                path=path,
            )
        surveys.append(one)
    from .reprojection import join_surveys

    return join_surveys(surveys, _name_apart(paths))


def _name_apart(paths: Sequence[Path]) -> list[str]:
    """Return the names of files, with their folders where names alone are the same."""
    names = [path.name for path in paths]
    return names if len({*names}) == len(names) else [str(path) for path in paths]


def _read_path(file: Path, asked: Asked) -> Survey | TIN:
    if is_folder(file) and (tiles := list_tiles(file, asked.format)):
        found = _read_several(tiles, asked)
        return _name_folder(found, file, tiles) if isinstance(found, Survey) else found
    with naming_file(file), open_ordinary_file(file) as local, unpack(local) as inner:
        found = _read_file(inner, asked)
    return found if inner == file else _restore_source(found, inner, file)


def read_stream(
    stream: IO[bytes],
    name: str,
    fallbacks: Mapping[str, Any] = _NO_FALLBACKS,
    *,
    check_crs: bool = True,
    **how: Any,
) -> Survey | TIN:
    """Read elevation points or a TIN from a stream, such as standard input; as :func:`read`.

    Parameters
    ----------
    stream : binary file object
    name : str
        What reports and errors call it.
    fallbacks : mapping of str to object
        As of :func:`read_with_fallbacks`.
    """
    source, asked = Path(name), ask(fallbacks, **how)
    with (
        naming_file(source),
        spool(stream, source) as local,
        unpack(local) as inner,
        checking_crs(check_crs),
    ):
        return _restore_source(_read_file(inner, asked), inner, source)


def _read_file(file: Path, asked: Asked) -> Survey | TIN:
    call = prepare_call(file, asked)
    reader = call.format.load("read")
    if asked.progress is not None and takes_progress(reader):
        call.options["progress"] = asked.progress
    with blaming(call.format, file):
        found = reader(file, **call.options)
    if isinstance(found, Survey | TIN):
        require_unit(found.crs, call.stated, asked.options)
        return found if isinstance(found, Survey) else found.with_source(file.name)
    reason = f"it gives a {type(found).__name__}, no Survey and no TIN"
    raise _blame_plug_in(call.format, reason)


class Call(NamedTuple):
    """The format of a file, and what its reader is to be called with."""

    format: Format
    options: dict[str, Any]
    stated: Unit | None
    """Unit of lengths that the caller tells, and the reader has no option for."""


def prepare_call(file: Path, asked: Asked) -> Call:
    """Choose the format of a file, and check the options of its reader."""
    chosen = _choose_format(file, asked.format, asked.options)
    if chosen.read is None:
        raise FormatError(
            f"{FILE} is {chosen.description}, a format that is written, not read: "
            f"{lookup.list_suffixes('read')} can be read.",
            known=lookup.find_suffixes("read"),
        )
    of_file, stated = _take_options(chosen, asked.declared, asked.options)
    require_options(chosen, "read", chosen.load("read"), of_file)
    usual = asked.fallbacks
    of_file |= {name: usual[name] for name in chosen.options("read") if name in usual}
    return Call(chosen, {"crs": asked.declared["crs"], **of_file}, stated)


@contextmanager
def blaming(chosen: Format, file: Path) -> Iterator[None]:
    """Raise errors of the system, and those of a plug-in, as sentences about a file."""
    try:
        yield
    except OSError as error:  # a file that vanishes, a disk that fails
        if isinstance(error, TinsmithError):
            raise
        raise describe_system_error(file, error) from error
    except Exception as error:
        if chosen.is_built_in or isinstance(error, TinsmithError):
            raise
        raise _blame_plug_in(chosen, describe_failure(error)) from error


def _take_options(
    chosen: Format, declared: Mapping[str, Any], options: Mapping[str, Any]
) -> tuple[dict[str, Any], Unit | None]:
    """Return the options of a reader, and the unit of lengths where it has no option for it.

    That is then the unit of elevations, unless it is told by itself.
    """
    taken = {name: value for name, value in declared.items() if name != "crs"} | dict(options)
    if "unit" in chosen.options("read"):
        return taken, None
    stated = Unit.of(taken.pop("unit", None))
    if stated is not None:
        taken.setdefault("elevation_unit", stated)
    return taken, stated


def require_unit(crs: CRS | None, stated: Unit | None, options: Mapping[str, Any]) -> None:
    """Refuse a unit of lengths that the CRS of the coordinates does not have.

    Raises
    ------
    OptionError
    """
    if stated is None or crs is None or "source_crs" in options:
        return
    if crs.is_geographic or crs.horizontal_unit != stated:
        unit = crs.horizontal_unit.name
        raise OptionError("unit", stated.name, f"{unit}, the unit of {crs.label}")


def _blame_plug_in(one: Format, reason: str) -> ReadError:
    return ReadError(
        f"Cannot read {FILE}: the reader of the format {one.name}, of the plug-in "
        f"{one.distribution}, fails ({reason})."
    )


def _choose_format(file: Path, name: str | None, options: Iterable[str] = ()) -> Format:
    """Return the format of a file that is there and not empty, or of a folder."""
    named = None if name is None else lookup.find_format(name, "read")
    if is_folder(file):
        known = [one for one in lookup.known_formats() if one.read and one.sniff_folder is not None]
        if named in known:
            return named
        shown = [one for one in known if named is None and _recognises(one, one.sniff_folder, file)]
        if shown:
            return lookup.choose_clear(shown, f"The folder '{file}'")
        raise ReadError(f"'{file}' is a folder: name a file in it.", path=file)
    head = _read_head(file)
    if named is not None:
        return named if named.name == name else _tell_apart(named, file, head)
    return _find_format_of_part(file) or detect(file, head, options)


def _tell_apart(named: Format, file: Path, head: bytes) -> Format:
    """Return the format of a suffix that several have: the one that the content shows."""
    alike = [
        one
        for one in lookup.known_formats()
        if one.read is not None and {*one.suffixes} & {*named.suffixes}
    ]
    shown = (
        one
        for one in alike
        if _recognises(one, one.sniff, head) or _recognises(one, one.sniff_file, file)
    )
    return next(shown, named)


def _find_format_of_part(file: Path) -> Format | None:
    """Return the format of a folder of which a file is a part, as its name tells."""
    name = file.name.lower()
    return next((one for one in lookup.known_formats() if name in one.part_names), None)


def list_tiles(folder: Path, name: str | None) -> list[Path]:
    """Return the files of points in a folder that is no format of its own, in order of their names.

    Raises
    ------
    ReadError
        If they are of several formats.
    """
    named = None if name is None else lookup.find_format(name, "read")
    whole = [one for one in lookup.known_formats() if one.read and one.sniff_folder is not None]
    if named in whole or any(_recognises(one, one.sniff_folder, folder) for one in whole):
        return []
    files = sorted(one for one in folder.iterdir() if _is_visible_file(one))
    found = {file: lookup.choose_format(_drop_packing(file), "read") for file in files}
    known = {file: one for file, one in found.items() if one and "Survey" in one.reads}
    kinds = {one.name for one in known.values()} if named is None else {named.name}
    tiles = [file for file, one in known.items() if one.name in kinds]
    if len(kinds) > 1:
        first = {one.name: file.name for file, one in reversed(known.items())}
        stated = ", ".join(f"'{file}' ({kind})" for kind, file in sorted(first.items()))
        raise ReadError(
            f"The folder '{folder}' has files of several formats: {stated}; name the files, or the "
            "format that is wanted.",
            path=folder,
        )
    return tiles


def _is_visible_file(file: Path) -> bool:
    return not file.name.startswith(".") and file.is_file()


def _drop_packing(file: Path) -> Path:
    """Return a name without the suffix of a compressed file."""
    return file.with_suffix("") if file.suffix.lower() in (".gz", ".zip") else file


def list_files(path: Path, name: str | None = None) -> list[Path]:
    """Return the files of points that a path stands for: itself, or those in a folder.

    A virtual point cloud stands for those that it names.

    Parameters
    ----------
    path : Path
    name : str, optional
        Of a format.

    Raises
    ------
    ReadError
        If it is a folder without files of points, or with files of several formats.
    """
    if not is_folder(path):
        with naming_file(path):
            return list_named_files(path) if is_virtual_cloud(path) else [path]
    found = list_tiles(path, name) or list_lidar_tiles(path)
    if not found:
        raise ReadError(f"The folder '{path}' has no files of points.", path=path)
    return found


def is_folder(file: Path) -> bool:
    """Whether a path is a folder that can be looked at."""
    try:
        return file.is_dir()
    except (OSError, ValueError):  # as the reader of its first bytes tells better
        return False


def _restore_source(found: Survey | TIN, copy: Path, file: Path) -> Survey | TIN:
    """Return what was read from a copy as if it had been read from the file."""
    if not isinstance(found, Survey):
        return found
    notes = [note.replace(copy.name, file.name) for note in found.notes]
    return replace(found, source=file.name, notes=notes)


def detect(path: Path, head: bytes, options: Iterable[str] = ()) -> Format:
    """Choose the format to read a file with.

    Parameters
    ----------
    path : Path
    head : bytes
        The first bytes of the file.
    options : iterable of str
        Names of options for the reader, such as ``layer`` for one layer of a file of several.

    Raises
    ------
    FormatError
        If neither content nor suffix is known, or a plug-in claims what another format does.

    Notes
    -----
    1. A signature in the content decides, whatever the suffix; one that a built-in format knows
       is not a plug-in's to claim. Of several formats the first is chosen that has the options.
    2. A text that names other files or services, or of a format that is not read, is refused;
       a virtual raster is read under its own suffix.
    3. A table of numbers is delimited text where the suffix names a format that the content
       would have shown, so that an ``.asc`` may be a grid or a list of points.
    4. Otherwise the suffix decides; that of a virtual point cloud does before the content, which is
       that of any GeoJSON.
    5. A file of unknown suffix is a raster if GDAL says so.
    """
    if is_virtual_cloud(path):
        return lookup.find_format("las")
    shown = [
        one
        for one in lookup.known_formats()
        if _recognises(one, one.sniff, head) or _recognises(one, one.sniff_file, path)
    ]
    if shown:
        able = [one for one in shown if one.read and {*options} <= {*one.options("read")}]
        return _choose_recognised(able or shown, path)
    if is_virtual(path):
        return lookup.find_format("raster")
    kind = signatures.find_foreign_kind(head)
    if kind is not None:
        raise FormatError(
            f"{FILE} is {kind}, which cannot be read: {lookup.list_suffixes('read')} can.",
            known=lookup.find_suffixes("read"),
        )
    by_suffix = lookup.choose_format(path, "read")
    if by_suffix is not None and (by_suffix.sniff is None or not _is_table(head)):
        return by_suffix
    if by_suffix is not None:
        return lookup.find_format("delimited")
    if b"\x00" in head and _is_gdal_raster(path):
        return lookup.find_format("raster")
    return lookup.find_format_of_suffix(path, "read")


def _choose_recognised(shown: Sequence[Format], path: Path) -> Format:
    """Return the first built-in format, else the only one of plug-ins."""
    first = shown[0]
    if not first.is_built_in:
        return lookup.choose_clear(shown, f"The content of {FILE}")
    for other in shown[1:]:
        if not other.is_built_in:
            reason = f"it claims '{path}' too, which is read as {first.name}; format= chooses"
            warn_of_plug_in(f"format '{other.name}'", other.distribution, reason)
    return first


def _recognises(one: Format, sniff: Callable[[Any], bool] | None, content: object) -> bool:
    """Whether a format's own function recognises a content; one that fails does not."""
    if sniff is None:
        return False
    try:
        return bool(sniff(content))
    except Exception as error:
        if one.is_built_in:
            raise
        reason = (
            f"it failed to look at a file ({describe_failure(error)}), which it is not used for"
        )
        warn_of_plug_in(f"format '{one.name}'", one.distribution, reason)
        return False


def _is_table(head: bytes) -> bool:
    """Whether the head reads as delimited rows of numbers."""
    from .delimited import looks_like_table

    return looks_like_table(head)


def _is_gdal_raster(path: Path) -> bool:
    from .raster import is_raster

    try:
        return is_raster(path)
    except MissingExtraError:
        return False


def _read_head(path: Path) -> bytes:
    """Return the first bytes of a file that is there, permitted and not empty."""
    with translate_system_errors(path):
        try:
            with path.open("rb") as file:
                head = file.read(signatures.HEAD_BYTES)
        except ValueError as error:
            raise ReadError(f"Cannot read {FILE}: {error}.") from error
    if not head:
        raise ReadError(f"{FILE} is empty: there are no points in it.")
    return head
