"""Write files: the writer is chosen by name, else by suffix."""

from __future__ import annotations

import logging
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, TypeVar, overload

from ..base.atomic import as_path
from ..base.errors import FormatError, OptionError, TinsmithError, WriteError
from ..base.notes import naming_copy, naming_file
from ..base.plug_ins import describe_failure
from ..base.products import product
from ..base.progress import Progress
from ..base.results import Features, Raster, Table
from ..terrain import Alignment
from ..tin import Surface, Survey
from .isolated import is_file_object, name_stream, writing_into
from .registry import find_writer, require_options, takes_progress, warn_of_lost_lines

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterator

    from .registry import Format

    Stream = TypeVar("Stream", bound=IO[Any])

_LOGGER = logging.getLogger("tinsmith")
_KINDS = {
    "TIN": Surface,
    "Survey": Survey,
    "Features": Features,
    "Raster": Raster,
    "Table": Table,
    "Alignment": Alignment,
}


@overload
def write(
    obj: object,
    path: str | os.PathLike[str],
    *,
    format: str | None = None,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Path: ...
@overload
def write(
    obj: object,
    path: Stream,
    *,
    format: str,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Stream: ...
@product
def write(
    obj: object,
    path: Any,
    *,
    format: str | None = None,  # noqa: A002 - as in read
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> Any:
    """Write a TIN, a Survey or a product; the writer is chosen by what it is and the suffix.

    Parameters
    ----------
    obj : TIN, Survey, Features, Raster, Table or Alignment
    path : path-like or file object
        Where to write; an object of bytes, or of text for formats that are, gets the whole file at
        its place, which must be one.
    format : str, optional
        Name of a format, to choose it whatever the suffix; a file object needs it.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, which is told once the file is whole and in
        its place; before that, what it raises ends the call, and there is no new file.
    **options
        Options of the writer, which ``tinsmith formats NAME`` explains. Of text and tables:
        ``columns``, ``delimiter``, ``header``, ``decimals``; of rasters ``dtype``, ``nodata``,
        ``overviews``, ``compression``, ``band``, ``tile_encoding``, ``gaps``, ``min_zoom``,
        ``max_zoom``; of vector files ``kind``, ``layer``, ``append``,
        ``overwrite``, ``compact``, ``projected``, ``multipatch``; of LandXML and DXF ``name``,
        ``unit``, ``version``, ``labels``, ``label_height``; of meshes ``ortho``, ``exaggeration``,
        ``scale``, ``solid``, ``thickness``, ``size``, ``precision``, ``max_level``, ``gzipped``,
        ``positive``, ``frame``.

    Returns
    -------
    Path or file object
        The file written, or the object given.

    Raises
    ------
    WriteError
        If the file cannot be written; one that was there before is left whole.
    FormatError
        If no format fits, it holds other things, or it has no such option.
    MissingExtraError
        If the library that writes the format is not installed.

    Warns
    -----
    LossWarning
        If the format cannot hold all that there is, such as the lines of a survey, attributes of
        its points or the whole names of columns; with ``kind="points"`` lines are left out without
        a word.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]], crs="EPSG:32616")
    >>> with TemporaryDirectory() as folder:
    ...     ts.write(ts.contours(tin, interval=1.0), Path(folder, "contours.xml")).name
    'contours.xml'
    """
    is_object = is_file_object(path)
    if is_object and format is None:
        allowed = "the name of a format, such as 'ply', where a file object is written"
        raise OptionError("format", format, allowed)
    file = Path(name_stream(path)) if is_object else as_path(path)
    chosen = find_writer(file, format, (find_kind(obj, file),))
    writer = chosen.load("write")
    require_options(chosen, "write", writer, options)
    done = Progress(progress)
    if progress is not None and takes_progress(writer):
        options["progress"] = done.stage(0.0, 1.0)
    opened = _open_copy(path, file, chosen) if is_object else nullcontext(file)
    with opened as place, done.passing_on(), naming_file(place):
        try:
            writer(obj, place, **options)
        except Exception as error:
            if chosen.is_built_in or isinstance(error, TinsmithError):
                raise
            raise WriteError(
                f"Cannot write '{place}': the writer of the format {chosen.name}, of the plug-in "
                f"{chosen.distribution}, fails ({describe_failure(error)}).",
                path=place,
            ) from error
        if isinstance(obj, Survey) and options.get("kind") != "points":
            warn_of_lost_lines(obj, chosen)
    done.end()
    _LOGGER.info("Wrote %s as %s: %r", file, chosen.name, obj)
    return path if is_object else file


@contextmanager
def _open_copy(stream: Any, name: Path, chosen: Format) -> Iterator[Path]:
    """Yield a file for what a file object gets; sentences speak of its name."""
    with writing_into(stream, chosen) as copy, naming_copy(copy, name):
        yield copy


def find_kind(obj: object, path: Path) -> str:
    """Return the name of what is to be written, "TIN", "Survey", "Table" or the like.

    Raises
    ------
    FormatError
        If it is none of these.
    """
    for name, kind in _KINDS.items():
        if isinstance(obj, kind):
            return name
    raise FormatError(
        f"Cannot write '{path}': it is of type {type(obj).__name__}, and neither a TIN nor a "
        "Survey, Features, Raster, Table or Alignment.",
        known=tuple(_KINDS),
    )
