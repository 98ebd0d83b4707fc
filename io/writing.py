"""Write files: the writer is chosen by name, else by suffix."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import FormatError
from .registry import (
    find_format,
    find_format_of_suffix,
    find_suffixes,
    list_suffixes,
    load_function,
    require_options,
)

if TYPE_CHECKING:
    import os

__all__ = ["write"]


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
    file = Path(path)
    chosen = find_format_of_suffix(file, "write") if format is None else find_format(format)
    if chosen.write is None:
        raise FormatError(
            f"Cannot write '{file}': {chosen.description} can be read, not written; "
            f"{list_suffixes('write')} can be written.",
            known=find_suffixes("write"),
        )
    writer = load_function(chosen.write)
    require_options(chosen, "write", writer, options)
    writer(obj, file, **options)
    return file
