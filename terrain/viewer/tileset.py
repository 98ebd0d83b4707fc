"""A tileset of 3D Tiles in the page of previews: read by the browser, level by level."""

from __future__ import annotations

import json
import os
import threading
import webbrowser
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload
from urllib.parse import quote

from ...base.atomic import as_path, replacing
from ...base.errors import ReadError, RenderError, WriteError
from .options import PreviewOptions
from .page import FOLDER, describe_tileset, make_document, serve
from .presentation import PAGE_SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.policies import Tint

INDEX = "tileset.json"
"""How a tileset is called in its folder."""

_VERSIONS = ("1.0", "1.1")
_HEAD = 65_536
"""Bytes in which a tileset tells what it is."""


class TilesetPreview:
    """A tileset, ready to be shown; made by :func:`tinsmith.preview_tileset`.

    Examples
    --------
    >>> import tinsmith as ts, json, tempfile
    >>> from pathlib import Path
    >>> root = {"boundingVolume": {"sphere": [0, 0, 0, 9]}, "geometricError": 0}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     index = Path(folder, "tileset.json")
    ...     _ = index.write_text(json.dumps({"asset": {"version": "1.1"}, "root": root}))
    ...     ts.preview_tileset(folder, title="Hill").path.name
    'tileset.json'
    """

    def __init__(self, path: Path, options: PreviewOptions, notes: tuple[str, ...]) -> None:
        self.path = path
        self.notes = notes
        self._look = options

    def to_html(self, address: str = INDEX) -> str:
        """Return the page, which asks for the tileset at an address, relative to its own.

        Examples
        --------
        >>> import tinsmith as ts, json, tempfile
        >>> from pathlib import Path
        >>> root = {"boundingVolume": {"sphere": [0, 0, 0, 9]}, "geometricError": 0}
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     index = Path(folder, "tileset.json")
        ...     _ = index.write_text(json.dumps({"asset": {"version": "1.1"}, "root": root}))
        ...     '"tiles/tileset.json"' in ts.preview_tileset(folder).to_html("tiles/tileset.json")
        True
        """
        return make_document(describe_tileset(address, self._look))

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the page (.html), which names the tileset by its way from there.

        A browser lets a page read what lies beside it only from a web server. Opened from a file,
        the page asks for the folder of the tileset.

        Parameters
        ----------
        path : path

        Returns
        -------
        pathlib.Path
            The file written: whole, or the old one is left as it was.

        Raises
        ------
        OptionError
            If the path is none.
        RenderError
            If the file cannot be written, or there is no way from it to the tileset.

        Examples
        --------
        >>> import tinsmith as ts, json, tempfile
        >>> from pathlib import Path
        >>> root = {"boundingVolume": {"sphere": [0, 0, 0, 9]}, "geometricError": 0}
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     index = Path(folder, "tileset.json")
        ...     _ = index.write_text(json.dumps({"asset": {"version": "1.1"}, "root": root}))
        ...     ts.preview_tileset(folder).save(f"{folder}/a.html").name
        'a.html'
        """
        file = as_path(path, "output")
        if file.suffix.lower() not in PAGE_SUFFIXES:
            raise RenderError(
                f"Cannot show a tileset in '{file}': it is shown in a page, whose name must end in "
                f"{' or '.join(PAGE_SUFFIXES)}."
            )
        if not file.parent.is_dir():
            raise RenderError(f"Cannot write '{file}': there is no folder '{file.parent}'.")
        try:
            way = os.path.relpath(self.path.resolve(), file.parent.resolve())
        except ValueError:
            raise RenderError(
                f"Cannot write '{file}': it must be on the drive of the tileset '{self.path}'."
            ) from None
        try:
            with replacing(file, binary=False) as stream:
                stream.write(self.to_html(quote(Path(way).as_posix())))
        except WriteError as error:
            raise RenderError(str(error)) from error
        return file

    @contextmanager
    def serve(self) -> Iterator[str]:
        """Serve page and tileset to browsers on this machine until the block ends.

        Yields the address, of 127.0.0.1 and a free port: no other machine can ask.

        Examples
        --------
        >>> import tinsmith as ts, json, tempfile
        >>> from pathlib import Path
        >>> root = {"boundingVolume": {"sphere": [0, 0, 0, 9]}, "geometricError": 0}
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     index = Path(folder, "tileset.json")
        ...     _ = index.write_text(json.dumps({"asset": {"version": "1.1"}, "root": root}))
        ...     with ts.preview_tileset(folder).serve() as address: address[:17]
        'http://127.0.0.1:'
        """
        page = self.to_html(f"{FOLDER}/{quote(self.path.name)}")
        with serve(page, self.path.resolve().parent) as address:
            yield address

    def show(self) -> None:
        """Serve it, open it in the browser, and go on serving until it is interrupted (Ctrl+C).

        Raises
        ------
        RenderError
            If no browser is found, or nothing can be served.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.preview_tileset("terrain").show()  # doctest: +SKIP
        """
        with self.serve() as address:
            if not webbrowser.open(address):
                raise RenderError("No browser was found to show the tileset in.")
            try:
                threading.Event().wait()
            except KeyboardInterrupt:
                return


@overload
def preview_tileset(
    path: str | os.PathLike[str],
    *,
    output: None = None,
    title: str | None = None,
    exaggeration: float | None = None,
    elevations: tuple[float, float] | None = None,
    tint: Tint = "elevation",
    contours: float | None = None,
) -> TilesetPreview: ...


@overload
def preview_tileset(
    path: str | os.PathLike[str],
    *,
    output: str | os.PathLike[str],
    title: str | None = None,
    exaggeration: float | None = None,
    elevations: tuple[float, float] | None = None,
    tint: Tint = "elevation",
    contours: float | None = None,
) -> Path: ...


def preview_tileset(
    path: str | os.PathLike[str],
    *,
    output: str | os.PathLike[str] | None = None,
    title: str | None = None,
    exaggeration: float | None = None,
    elevations: tuple[float, float] | None = None,
    tint: Tint = "elevation",
    contours: float | None = None,
) -> TilesetPreview | Path:
    """Show a tileset of 3D Tiles in a page, with its levels as the view needs them.

    Parameters
    ----------
    path : path
        Of ``tileset.json``, or of the folder that holds it.
    output : path, optional
        Page (.html) to write at once. Default: write nothing, and return a TilesetPreview.
    title : str, optional
        Default the name of the folder.
    exaggeration : float, optional
        Factor on heights at the start. Default: a round number that lifts the relief to a tenth of
        the extent or more, 1 where it is steep enough.
    elevations : tuple of float, optional
        Lowest and highest elevation of the tints, metres; default those of the coarsest level.
    tint : {"elevation", "slope", "aspect", "plain"}, optional
        What colours tell at the start.
    contours : float, optional
        Interval of contour lines at the start, metres; default none.

    Returns
    -------
    TilesetPreview or pathlib.Path
        The file written, if ``output`` is given. A TilesetPreview has ``save``, ``serve`` and
        ``show``.

    Raises
    ------
    OptionError
        If an option is outside what is allowed.
    ReadError
        If there is no tileset, or it is not 3D Tiles 1.0 or 1.1.
    RenderError
        If the page cannot be written.

    Notes
    -----
    The page reads the tileset itself, in the browser: contents in GLB (glTF 2.0) and b3dm, with
    tilesets in tilesets, not compressed by Draco or meshopt, without implicit tiling. It asks for
    nothing outside the folder of the tileset. On the globe it shows places by longitude, latitude
    and height above the ellipsoid. What is measured is measured on the levels that are shown, whose
    geometric error it tells.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ts.preview_tileset("sample_data")
    Traceback (most recent call last):
    tinsmith.base.errors.ReadError: There is no 'tileset.json' in 'sample_data'.
    """
    index = _find_index(as_path(path))
    notes = _read_notes(index)
    named = title or index.resolve().parent.name.replace("_", " ") or None
    chosen = PreviewOptions.of(
        title=named, exaggeration=exaggeration, elevations=elevations, tint=tint, contours=contours
    )
    made = TilesetPreview(index, chosen, notes)
    return made if output is None else made.save(output)


def is_tileset(path: Path) -> bool:
    """Tell whether a path is that of a tileset, or of a folder that holds one."""
    if path.is_dir():
        return (path / INDEX).is_file()
    if path.suffix.lower() != ".json" or not path.is_file():
        return False
    with path.open("rb") as file:
        head = file.read(_HEAD)
    return b'"asset"' in head and b'"geometricError"' in head


def _find_index(path: Path) -> Path:
    if path.is_dir():
        path = path / INDEX
        if not path.is_file():
            raise ReadError(f"There is no '{INDEX}' in '{path.parent}'.")
    if not path.is_file():
        raise ReadError(f"There is no file '{path}'.")
    return path


def _read_notes(path: Path) -> tuple[str, ...]:
    """Return what a tileset tells of its data, after a look at what it is."""
    try:
        found: Any = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError) as error:
        raise ReadError(f"'{path}' is no tileset: {error}.") from error
    asset = found.get("asset") if isinstance(found, dict) else None
    version = asset.get("version") if isinstance(asset, dict) else None
    if not isinstance(asset, dict) or not isinstance(found.get("root"), dict) or version is None:
        raise ReadError(
            f"'{path}' is no tileset of 3D Tiles: it has no 'asset' with a version, or no 'root'."
        )
    if version not in _VERSIONS:
        allowed = " and ".join(_VERSIONS)
        raise ReadError(f"'{path}' is 3D Tiles {str(version)[:40]!r}: {allowed} are shown.")
    extras = asset.get("extras")
    notes = extras.get("notes") if isinstance(extras, dict) else None
    return tuple(one for one in notes if isinstance(one, str)) if isinstance(notes, list) else ()
