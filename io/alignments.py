"""Read alignments: axes of LandXML, of drawings, and polylines of vector files."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING, Any

from ..base.atomic import as_path
from ..base.errors import OptionError, ReadError
from ..base.notes import naming_file
from ..base.sentences import FILE, counted
from ..terrain import Alignment
from .isolated import as_local_file, translate_system_errors
from .registry import find_format

if TYPE_CHECKING:
    import os
    from pathlib import Path

    from ..base.crs import CrsLike, UnitLike

_HEAD = 4096


def read_alignment(
    path: str | os.PathLike[str] | IO[Any],
    name: str | int | None = None,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    unit: UnitLike | None = None,
    layer: str | None = None,
) -> Alignment:
    """Read an alignment: of LandXML, the axis of a DXF drawing, or a polyline of another file.

    Parameters
    ----------
    path : path-like or file object
    name : str or int, optional
        Of LandXML the name of the alignment, or its number in the file, from 1; needed if there are
        several.
    crs : CRS, str, int or pyproj.CRS, optional
        Declares that of a file that names none. LandXML and DXF are not reprojected, for arcs would
        be no arcs; the vertices of a polyline are.
    elevation_unit : Unit or str, optional
        Unit of elevations, where the file does not say.
    unit : Unit or str, optional
        Of LandXML and DXF the unit of all lengths, where the file does not say, or where it says
        another one than its CRS.
    layer : str, optional
        Of DXF names or patterns of layers, with commas between; of a vector file its layer.

    Returns
    -------
    Alignment

    Raises
    ------
    ReadError
        If the file is missing or damaged, has no alignment, several and no name is given, or a
        curve whose form is not known; if what it says of an element does not fit together by more
        than 0.05 CRS units; if lines of a drawing are not one axis.
    OptionError
        If there is no alignment of that name, or a unit is not that of the file.
    CrsError
        If the file is in another CRS, or coordinates are angles.
    MissingExtraError
        If ezdxf is not installed, or pyogrio for vector files.

    Notes
    -----
    Of LandXML lines, arcs, and spirals of the types clothoid, bloss, cosine, sinusoid, biquadratic,
    cubic and sineHalfWave are read, with station equations and vertical alignments (parabolas,
    unsymmetrical ones, and arcs). Elements begin and end where the file puts them; their lengths,
    radii, centres and tangents have to agree. Arcs of DXF (ARC, and bulges of LWPOLYLINE and
    POLYLINE) are arcs; splines and ellipses become chords within 0.0001 units. Polylines are those
    of vector files; the rows of a text table are the vertices of one, in their order.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> road = ts.Alignment.from_points([[0, 0], [100, 0], [100, 100]], radii=40, name="axis")
    >>> with TemporaryDirectory() as folder:
    ...     ts.read_alignment(ts.write(road, Path(folder, "road.xml"), unit="m"))
    <Alignment axis: 3 elements, from 0 to 182.832>
    """
    with as_local_file(path) as place, naming_file(as_path(place)):
        file = as_path(place)
        with translate_system_errors(file), file.open("rb") as stream:
            head = stream.read(_HEAD)
        kind = _find_kind(head)
        if kind == "landxml" and layer is not None:
            raise OptionError("layer", layer, allowed="None: LandXML has no layers")
        if kind != "landxml" and name is not None:
            raise OptionError("name", name, allowed="None: only LandXML names its alignments")
        if kind == "vector":
            if unit is not None:
                raise OptionError("unit", unit, allowed="None: the file has the unit of its CRS")
            return _read_polyline(file, layer, crs, elevation_unit)
        given: dict[str, Any] = {"crs": crs, "elevation_unit": elevation_unit, "unit": unit}
        if kind == "dxf":
            from .cad.dxf import alignment_reading as drawings

            return drawings.read_alignment(file, layer, **given)
        from .cad.landxml import read_alignment as read_landxml

        return read_landxml(file, name, **given)


def holds_alignments(path: Path) -> bool:
    """Whether a file is of a format that has alignments with names; False if it is not there."""
    try:
        with path.open("rb") as stream:
            return _find_kind(stream.read(_HEAD)) == "landxml"
    except OSError:
        return False


def _find_kind(head: bytes) -> str:
    for name in ("landxml", "dxf"):
        sniff = find_format(name).sniff
        if sniff is not None and sniff(head):
            return name
    return "vector"


def _read_polyline(
    file: Path, layer: str | None, crs: CrsLike | None, elevation_unit: UnitLike | None
) -> Alignment:
    """Return the only line of a vector file; its elevations are left aside."""
    from .vector import read_plain_lines

    lines, own, notes = read_plain_lines(file, layer=layer, crs=crs)
    if len(lines) != 1:
        raise ReadError(
            f"{FILE} has {counted(len(lines), 'line')}: an alignment is made of one; choose a layer"
            " or a file that has one."
        )
    return Alignment.from_points(
        lines[0].coords,
        name=lines[0].name or "",
        crs=own,
        elevation_unit=elevation_unit,
        notes=notes,
    )
