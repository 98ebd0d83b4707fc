"""What a format is: its name and suffixes, what it reads and writes, and by which functions."""

from __future__ import annotations

import inspect
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any, Literal

from ...base import optional
from ...base.errors import FormatError, UnknownOptionError
from ...base.plug_ins import describe_failure
from .options import list_options

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from .options import FormatOption

SURFACES = ("TIN", "Survey")
"""What triangulations and their points can be written as."""

KINDS = ("TIN", "Survey", "Features", "Raster", "Table", "Alignment")
"""What files can hold, by the names of the classes."""

Loss = Literal[
    "crs",  # the coordinate reference system
    "elevation unit",  # the unit of elevations
    "triangles",  # all but the points
    "order",  # the numbers of vertices and triangles, and vertices of no triangle
    "constrained",  # which edges are constrained
    "lines",  # breaklines, boundary, holes and water: their names and kinds
    "survey lines",  # all lines of a survey: breaklines, boundary, holes, erased areas and water
    "erased areas",  # those of a survey alone
    "attributes",  # some columns of a survey, such as texts
    "notes",  # notes of what was guessed
    "report",  # what became of each row that was given, and what undoing edits needs
]
"""What of a TIN or of a survey may be lost, in a word."""

_OWN = "tinsmith"


@dataclass(frozen=True, slots=True, kw_only=True)
class Format:
    """A file format.

    Attributes
    ----------
    name : str
        What ``format=`` calls it: small letters, digits and dashes.
    description : str
        A few words for a list.
    suffixes : tuple of str
        Lower case, with the dot; a writer is chosen by them, a reader where the content is silent.
        The longest that a name ends in counts: ``.city.json`` before ``.json``. A format of
        folders has none.
    read, write : str, optional
        ``"module:function"``, of functions as the notes describe them.
    reads, writes : tuple of str
        What the reader gives, what the writer takes: "TIN", "Survey", "Features", "Raster",
        "Table", "Alignment". Several formats may share a suffix, if they hold different things.
    precision : str
        To which digit coordinates come back from a file that was written; one sentence.
    rounding, relative_rounding : float
        The same for a program: by how much a coordinate may differ from what was written, in CRS
        units, plus a fraction of the longest side of the points' bounds. Both 0: not at all.
    losses : str
        What of a TIN, a Survey or a product the format does not hold; one sentence, empty if none.
    loses : tuple of str
        The same for a program: words of :data:`Loss`.
    extra : str, optional
        The extra of this package that brings the library it needs.
    sniff : callable, optional
        Whether the first bytes of a file are certainly of this format.
    sniff_file : callable, optional
        The same by the path, for files whose first bytes do not tell.
    sniff_folder : callable, optional
        Whether a folder is certainly of this format, by the names in it; a format without it is
        of files.
    side_files : mapping of str to tuple of str
        Files that may stand beside one and belong to it, by its suffix, "" for any: ``".prj"``
        stands in place of the suffix, ``"*.ovr"`` behind the whole name. Of a writer those that it
        replaces or removes.
    find_sources : callable, optional
        Other files that a file names and that are read with it, by its path.
    read_cells : str, optional
        ``"module:function"`` of a function that reads a file of cells as a Raster.
    stream : str, optional
        ``"module:function"`` of a generator that takes what the reader does and gives the points
        chunk by chunk, see :mod:`tinsmith.io.registry.chunks`; the reader gathers them.
    describe : str, optional
        ``"module:function"`` of a function that takes what the reader does and returns a
        SourceHeader, of the file's headers alone.
    read_box : str, optional
        ``"module:function"`` of a function that takes a path, Bounds and what the reader does, and
        reads the points of a box where they are.
    is_text : bool
        Whether a file that was written is text, which a terminal can show.
    has_layers : bool
        Whether files that are written have layers with names.
    holds_classes : bool
        Whether points keep their classes, such as ground, in a file that was written.
    part_names : tuple of str
        Names of files in such a folder, small letters, any of which stands for the folder.
    distribution : str
        Name and version of the plug-in's distribution, set by the registry; else "tinsmith".

    Notes
    -----
    A reader takes ``(path, *, crs=None, elevation_unit=None, <options>)`` and returns a Survey or a
    TIN. ``crs``, a CRS, str, int or pyproj.CRS, declares the CRS of the coordinates,
    ``elevation_unit``, a Unit or str, the unit of elevations; the default of both is what the file
    names. It raises a ReadError if the file is missing or damaged, or its faces are no TIN; a
    CrsError if PROJ does not know the CRS, or the file names another; an OptionError if the unit is
    unknown, or the file names another, or an option has a value that it cannot have.

    A writer takes ``(obj, path, *, <options>)``. It raises a FormatError for what it cannot hold,
    and a WriteError, with the old file left whole, if the new one cannot be written.

    Either raises a MissingExtraError without the library that it needs. One that takes ``progress``
    calls it with the fraction done. What they say of themselves is only what goes beyond this.

    Options of several readers: ``faces``, what becomes of triangles that make no surface, those
    without area seen from above and all but the largest of those that overlap: "surface" leaves
    them out, "all" refuses the file, "most" leaves them out up to one percent of the area;
    ``encoding`` of a text, found by looking if it is not given;
    ``source_crs``, the CRS of the file's coordinates if it is not ``crs``, to which they are
    reprojected; ``nodata``, a number or several, elevations that stand for none, besides those that
    the file declares.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ts.find_format("ply").suffixes
    ('.ply',)
    """

    name: str
    description: str
    suffixes: tuple[str, ...]
    read: str | None = None
    write: str | None = None
    reads: tuple[str, ...] = ("Survey",)
    writes: tuple[str, ...] = SURFACES
    precision: str = ""
    rounding: float = 0.0
    relative_rounding: float = 0.0
    losses: str = ""
    loses: tuple[Loss, ...] = ()
    extra: str | None = None
    sniff: Callable[[bytes], bool] | None = None
    sniff_file: Callable[[Path], bool] | None = None
    sniff_folder: Callable[[Path], bool] | None = None
    side_files: Mapping[str, tuple[str, ...]] = field(default_factory=dict, hash=False)
    find_sources: Callable[[Path], Sequence[Path]] | None = None
    read_cells: str | None = None
    stream: str | None = None
    describe: str | None = None
    read_box: str | None = None
    is_text: bool = False
    has_layers: bool = False
    holds_classes: bool = False
    part_names: tuple[str, ...] = ()
    distribution: str = _OWN

    @property
    def is_built_in(self) -> bool:
        """Whether it belongs to this package, not to a plug-in."""
        return self.distribution == _OWN

    @property
    def needs(self) -> str:
        """What is to be installed for it, as pip calls it; empty for nothing more.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.find_format("gmsh").needs
        'tinsmith[mesh]'
        """
        return f"{_OWN}[{self.extra}]" if self.extra else ""

    @property
    def is_installed(self) -> bool:
        """Whether the libraries that it needs are there; they are not loaded."""
        return self.extra is None or optional.is_installed(self.extra)

    def options(self, action: str) -> tuple[str, ...]:
        """Return the names of the options of its reader or writer (``"read"``, ``"write"``).

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.find_format("geojson").options("write")
        ('kind', 'projected')
        """
        return tuple(one.name for one in self.describe_options(action))

    def describe_options(self, action: str) -> tuple[FormatOption, ...]:
        """Return the options of its reader or writer, with their types and texts.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.find_format("stl").describe_options("write")[0].text
        'Close it with a flat base and walls, for 3D printing.'
        """
        return () if getattr(self, action) is None else list_options(self.load(action))

    def load(self, action: str) -> Callable[..., Any]:
        """Load its reader or writer (``"read"``, ``"write"``).

        Raises
        ------
        FormatError
            If it is that of a plug-in and cannot be loaded, or does not take what it must.

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.find_format("ply").load("write").__name__
        'write'
        """
        target: str = getattr(self, action) or ""
        if self.is_built_in:
            return load_function(target)
        try:
            function = load_function(target)
            missing = _find_missing_parameter(function, action)
        except (Exception, SystemExit) as error:
            raise self._describe_fault(action, describe_failure(error)) from error
        if missing:
            raise self._describe_fault(action, f"'{target}' does not take {missing}")
        return function

    def _describe_fault(self, action: str, reason: str) -> FormatError:
        return FormatError(
            f"Cannot {action} the format {self.name}, of the plug-in {self.distribution}: {reason}."
        )


def load_function(target: str) -> Callable[..., Any]:
    """Load a reader or writer, ``"module:function"``."""
    module, _, function = target.partition(":")
    loaded: Callable[..., Any] = getattr(import_module(module), function)
    return loaded


def _find_missing_parameter(function: Callable[..., Any], action: str) -> str:
    """Return how a reader or writer would be called, if it cannot be called so."""
    signature = inspect.signature(function)
    try:
        if action == "read":
            signature.bind("path", crs=None)
        else:
            signature.bind("obj", "path")
    except TypeError:
        return "(path, *, crs)" if action == "read" else "(obj, path)"
    return ""


def takes_progress(function: Callable[..., Any]) -> bool:
    """Whether a reader or writer tells how far it is."""
    return "progress" in inspect.signature(function).parameters


def require_options(
    chosen: Format, action: str, function: Callable[..., Any], options: Mapping[str, object]
) -> None:
    """Refuse options that a reader or writer does not have."""
    allowed = tuple(one.name for one in list_options(function))
    accepted = {*allowed, "progress", "elevation_unit"} & set(
        inspect.signature(function).parameters
    )
    unknown = [name for name in options if name not in accepted]
    if not unknown:
        return
    raise UnknownOptionError(unknown[0], action, chosen.name, allowed)
