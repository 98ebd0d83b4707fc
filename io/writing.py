"""Write files: the writer is chosen by name, else by suffix."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._atomic import as_path
from .._plug_ins import describe_failure
from ..errors import FormatError, TinsmithError, WriteError
from ..terrain.results import Features, Raster, Table
from ..tin import TIN, Survey
from .registry import find_writer, require_options

if TYPE_CHECKING:
    import os

__all__ = ["find_kind", "write"]

_KINDS = {"TIN": TIN, "Survey": Survey, "Features": Features, "Raster": Raster, "Table": Table}


def write(
    obj: object,
    path: str | os.PathLike[str],
    *,
    format: str | None = None,  # noqa: A002 - as in read
    **options: Any,
) -> Path:
    """Write a TIN, a Survey or a product; the writer is chosen by what it is and the suffix.

    Parameters
    ----------
    obj : TIN, Survey, Features, Raster or Table
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
        If no format fits, it holds other things, or it has no such option.
    MissingExtraError
        If the library that writes the format is not installed.

    Warns
    -----
    LossWarning
        If the format cannot hold all that there is, such as the whole names of columns.

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
    file = as_path(path)
    chosen = find_writer(file, format, (find_kind(obj, file),))
    writer = chosen.load("write")
    require_options(chosen, "write", writer, options)
    try:
        writer(obj, file, **options)
    except Exception as error:
        if chosen.is_built_in or isinstance(error, TinsmithError):
            raise
        raise WriteError(
            f"Cannot write '{file}': the writer of the format {chosen.name}, of the plug-in "
            f"{chosen.distribution}, fails ({describe_failure(error)}).",
            path=file,
        ) from error
    return file


def find_kind(obj: object, path: Path) -> str:
    """Return the name of what is to be written, "TIN", "Survey", "Features", "Raster" or "Table".

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
        "Survey, Features, Raster or Table.",
        known=tuple(_KINDS),
    )
