"""The formats: built-in ones and those of plug-ins.

A format is a value; its reader and writer are named, and loaded when first used. Another package
adds one through the entry-point group ``tinsmith.formats``: each entry names a :class:`Format`.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from typing import TYPE_CHECKING, Any

from .._sentences import shown
from ..errors import FormatError
from . import signatures

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

__all__ = [
    "Format",
    "choose_format",
    "find_format",
    "find_format_of_suffix",
    "find_suffixes",
    "find_writer",
    "known_formats",
    "list_suffixes",
    "load_function",
    "require_options",
]

_ENTRY_POINTS = "tinsmith.formats"
_OWN_PARAMETERS = frozenset({"crs", "z_unit", "progress"})
SURFACES = ("TIN", "Survey")
_ONE = {
    "TIN": "a TIN",
    "Survey": "a Survey",
    "Features": "Features",
    "Raster": "a Raster",
    "Table": "a Table",
}
"""What can be written, by the name of its class."""


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
    writes : tuple of str
        What the writer takes: "TIN", "Survey", "Features", "Raster", "Table". Several formats may
        share a suffix, if they hold different things.
    extra : str, optional
        The extra of this package that brings the library it needs.
    sniff : callable, optional
        Whether the first bytes of a file are certainly of this format.

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
    writes: tuple[str, ...] = SURFACES
    extra: str | None = None
    sniff: Callable[[bytes], bool] | None = None

    def options(self, action: str) -> tuple[str, ...]:
        """Return the names of the options of its reader or writer (``"read"``, ``"write"``).

        Examples
        --------
        >>> import tinsmith as ts
        >>> ts.find_format("geojson").options("write")
        ('kind', 'projected')
        """
        target = getattr(self, action)
        return () if target is None else _find_options(load_function(target))


_DELIMITED = Format(
    name="delimited",
    description="Delimited text: survey points as CSV, TXT, XYZ",
    suffixes=(".csv", ".txt", ".xyz", ".tsv", ".pts", ".dat", ".pnt"),
    read="tinsmith.io.delimited.survey_text:read",
    write="tinsmith.io.delimited.survey_text:write",
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
        read="tinsmith.io.raster.dem:read",
        extra="raster",
        sniff=signatures.is_raster,
    ),
    Format(
        name="geojson",
        description="GeoJSON (RFC 7946)",
        suffixes=(".geojson", ".json"),
        write="tinsmith.io.geojson.writing:write",
        writes=(*SURFACES, "Features"),
        sniff=signatures.is_geojson,
    ),
    Format(
        name="ply",
        description="PLY mesh (opens in QGIS, CloudCompare, MeshLab)",
        suffixes=(".ply",),
        read="tinsmith.io.mesh.ply.file:read",
        write="tinsmith.io.mesh.ply.file:write",
        sniff=signatures.is_ply,
    ),
    Format(
        name="obj",
        description="Wavefront OBJ mesh",
        suffixes=(".obj",),
        read="tinsmith.io.mesh.obj:read",
        write="tinsmith.io.mesh.obj:write",
        sniff=signatures.is_obj,
    ),
    Format(
        name="stl",
        description="STL mesh",
        suffixes=(".stl",),
        read="tinsmith.io.mesh.stl:read",
        write="tinsmith.io.mesh.stl:write",
        sniff=signatures.is_stl,
    ),
    Format(
        name="vtk",
        description="VTK XML mesh (opens in ParaView)",
        suffixes=(".vtp", ".vtu"),
        read="tinsmith.io.mesh.vtk:read",
        write="tinsmith.io.mesh.vtk:write",
        extra="view",
        sniff=signatures.is_vtk_xml,
    ),
    Format(
        name="gmsh",
        description="Gmsh mesh, with the edges of rim and lines (for finite element programs)",
        suffixes=(".msh",),
        read="tinsmith.io.mesh.gmsh:read",
        write="tinsmith.io.mesh.gmsh:write",
        extra="mesh",
        sniff=signatures.is_gmsh,
    ),
    Format(
        name="gpkg",
        description="GeoPackage",
        suffixes=(".gpkg",),
        write="tinsmith.io.products.geopackage:write",
        writes=("Features",),
        extra="vector",
    ),
    Format(
        name="flatgeobuf",
        description="FlatGeobuf",
        suffixes=(".fgb",),
        write="tinsmith.io.products.flatgeobuf:write",
        writes=("Features",),
        extra="vector",
    ),
    Format(
        name="shapefile",
        description="Shapefile (with its parts .shx, .dbf, .prj, .cpg)",
        suffixes=(".shp",),
        write="tinsmith.io.products.shapefile:write",
        writes=("Features",),
        extra="vector",
    ),
    Format(
        name="geotiff",
        description="GeoTIFF",
        suffixes=(".tif", ".tiff"),
        write="tinsmith.io.products.geotiff:write",
        writes=("Raster",),
        extra="raster",
    ),
    Format(
        name="cog",
        description="Cloud optimized GeoTIFF",
        suffixes=(".tif", ".tiff"),
        write="tinsmith.io.products.geotiff:write_cog",
        writes=("Raster",),
        extra="raster",
    ),
    Format(
        name="csv",
        description="CSV (RFC 4180) with units in the header",
        suffixes=(".csv", ".tsv", ".txt"),
        write="tinsmith.io.products.csv_tables:write",
        writes=("Table", "Features"),
    ),
    Format(
        name="json",
        description="JSON with units",
        suffixes=(".json",),
        write="tinsmith.io.products.json_tables:write",
        writes=("Table",),
    ),
)


@cache
def known_formats() -> tuple[Format, ...]:
    """Return the built-in formats, then those of installed plug-ins by name.

    Raises
    ------
    FormatError
        If a plug-in cannot be loaded, is no Format, or takes a name that is in use.

    Examples
    --------
    >>> "ply" in [form.name for form in known_formats()]
    True
    """
    formats = list(_BUILT_IN)
    for entry in sorted(entry_points(group=_ENTRY_POINTS), key=lambda entry: entry.name):
        added = _load_plug_in(entry.name, entry.load)
        if any(added.name == one.name for one in formats):
            raise FormatError(f"Plug-in '{entry.name}' takes the name '{added.name}', in use.")
        formats.append(added)
    return tuple(formats)


def _load_plug_in(name: str, load: Callable[[], object]) -> Format:
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
    wanted = name.strip().lower() if isinstance(name, str) else ""
    suffix = wanted if wanted.startswith(".") else f".{wanted}"
    for one in known_formats():
        if one.name == wanted or suffix in one.suffixes:
            return one
    names = tuple(one.name for one in known_formats())
    raise FormatError(f"Unknown format {shown(name)}: one of {', '.join(names)}.", known=names)


def choose_format(suffix: str, action: str) -> Format | None:
    """Return the format of a suffix, one that can do the action first."""
    fitting = [one for one in known_formats() if suffix in one.suffixes]
    able = [one for one in fitting if getattr(one, action) is not None]
    return next(iter(able + fitting), None)


def find_format_of_suffix(path: Path, action: str) -> Format:
    """Return the format of a file's suffix; refuse an unknown one."""
    found = choose_format(path.suffix.lower(), action)
    if found is not None:
        return found
    suffix = f"has the unknown suffix '{path.suffix}'" if path.suffix else "has no suffix"
    raise FormatError(
        f"'{path}' {suffix}: {list_suffixes(action)} can be "
        f"{'read' if action == 'read' else 'written'}; "
        "the option format names one whatever the suffix.",
        known=find_suffixes(action),
    )


def find_writer(path: Path, name: str | None, kinds: Sequence[str]) -> Format:
    """Choose the format to write a file in.

    Parameters
    ----------
    path : Path
    name : str or None
        Of a format, to choose it whatever the suffix.
    kinds : sequence of str
        What is to be written is one of these: "TIN", "Survey", "Features", "Raster", "Table".

    Raises
    ------
    FormatError
        If there is no such format, it cannot be written, or it holds other things.
    """
    known = find_format_of_suffix(path, "write") if name is None else find_format(name)
    fitting = [one for one in known_formats() if one.write is not None and {*kinds} & {*one.writes}]
    wanted = path.suffix.lower() if name is None else _as_suffix(name)
    named = [one for one in fitting if name is not None and one.name == name.strip().lower()]
    found = next(iter(named + [one for one in fitting if wanted in one.suffixes]), None)
    if found is not None:
        return found
    suffixes = tuple(dict.fromkeys(suffix for one in fitting for suffix in one.suffixes))
    if not any(one.write for one in known_formats() if one is known or wanted in one.suffixes):
        what = f"{known.description} can be read, not written"
    else:
        what = f"{known.description} holds {_listed(known.writes)}, not {_listed(kinds)}"
    raise FormatError(
        f"Cannot write '{path}': {what}; {_listed(kinds)} can be written to "
        f"{', '.join(suffixes) or 'no format'}.",
        known=suffixes,
    )


def _as_suffix(name: str) -> str:
    return f".{name.strip().lower().lstrip('.')}"


def _listed(kinds: Sequence[str]) -> str:
    return " or ".join(_ONE.get(kind, kind) for kind in kinds)


def find_suffixes(action: str) -> tuple[str, ...]:
    """Return the suffixes that can be read, or written."""
    suffixes = (
        suffix
        for one in known_formats()
        if getattr(one, action) is not None
        for suffix in one.suffixes
    )
    return tuple(dict.fromkeys(suffixes))


def list_suffixes(action: str) -> str:
    """List the suffixes that can be read, or written, for a sentence."""
    return ", ".join(find_suffixes(action))


def load_function(target: str) -> Callable[..., Any]:
    """Load a reader or writer, ``"module:function"``."""
    module, _, function = target.partition(":")
    loaded: Callable[..., Any] = getattr(import_module(module), function)
    return loaded


def _find_options(function: Callable[..., Any]) -> tuple[str, ...]:
    parameters = inspect.signature(function).parameters.values()
    return tuple(
        one.name
        for one in parameters
        if one.kind is one.KEYWORD_ONLY and one.name not in _OWN_PARAMETERS
    )


def require_options(
    chosen: Format, action: str, function: Callable[..., Any], options: Mapping[str, object]
) -> None:
    """Refuse options that a reader or writer does not have."""
    allowed = _find_options(function)
    accepted = {*allowed, "progress", "z_unit"} & set(inspect.signature(function).parameters)
    unknown = [name for name in options if name not in accepted]
    if not unknown:
        return
    there_are = f"its options are {', '.join(allowed)}" if allowed else "it has no options"
    raise FormatError(
        f"Unknown option '{unknown[0]}' to {action} the format {chosen.name}: {there_are}.",
        known=allowed,
    )
