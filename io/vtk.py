"""VTK XML files through pyvista: ``.vtp`` (PolyData) and ``.vtu`` (UnstructuredGrid), for ParaView.

Coordinates are written in the CRS as doubles, with nothing subtracted. Cell data are ``slope`` and
``aspect`` (degrees) and ``constrained`` (three flags, of the edge opposite each corner); field data
``crs`` and ``elevation_unit`` ("" if not known), and ``origin``, what a reader must add to the
coordinates: zeros.
"""

from __future__ import annotations

import re
from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..terrain import extras
from ..terrain.slope import aspect, slope
from .atomic import replacing_path
from .errors import ReadError, WriteError
from .meshes import (
    choose_reference,
    fans,
    file_content,
    one_line,
    require_tin,
    survey_of,
    tin_of,
    unit_text,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from numpy.typing import NDArray

    from ..crs import CrsLike, UnitLike
    from ..tin import TIN, Survey

__all__ = ["read", "write"]

_NO_FACES = frozenset({0, 1, 2, 3, 4})  # empty cell, vertices, lines
_FACES = frozenset({5, 7, 9})  # triangle, polygon, quadrilateral
_CLOSEST_PACKING = 1100  # zlib packs no tighter than 1032 to 1
_COUNTS = re.compile(rb'NumberOf\w+="(\d+)"')


def read(path: Path, *, crs: CrsLike | None = None, z_unit: UnitLike | None = None) -> TIN | Survey:
    """Read a VTK XML file of faces.

    Parameters
    ----------
    path : Path
    crs : CRS, str, int or pyproj.CRS, optional
        Declares the CRS; default the field data ``crs``.
    z_unit : Unit or str, optional
        Declares the unit of the elevations; default the one in the field
        data ``elevation_unit``.

    Returns
    -------
    TIN or Survey
        A survey where the file has no faces, its one-column numeric point data as attributes.
        Polygons are cut into triangles. Field data ``origin`` is added to the coordinates, and
        ``exaggeration`` and ``elevation_scale`` taken out of the elevations first.

    Raises
    ------
    MissingExtraError
        If pyvista is not installed.
    ReadError
        If the file is damaged or holds cells that are no faces, or its faces are no TIN.
    CrsError
        If PROJ does not know the CRS, or the file names another.
    OptionError
        If the unit is unknown, or the file names another.
    """
    mesh = _mesh(path)
    points = _true_points(mesh)
    reference = choose_reference(
        crs,
        z_unit,
        path,
        found_crs=_text_field(mesh, "crs"),
        found_unit=_text_field(mesh, "elevation_unit"),
    )
    faces = _faces_of(mesh, path)
    if len(faces.cells) == 0:
        return survey_of(points, path, attributes=_attributes(mesh), reference=reference)
    made = fans(faces.corners, faces.offsets, points, path)
    flags = _flags(mesh, faces.cells, len(made.triangles))
    return tin_of(points, made.triangles, path, constrained=flags, reference=reference)


class _Faces(NamedTuple):
    """Corners of faces, one face after the other, and the number of the cell that each is."""

    corners: NDArray[np.int64]
    offsets: NDArray[np.int64]
    cells: NDArray[np.int64]


def _mesh(path: Path) -> Any:
    pv = extras.pyvista("Reading VTK files")
    readers = {
        b"PolyData": "vtkXMLPolyDataReader",
        b"UnstructuredGrid": "vtkXMLUnstructuredGridReader",
    }
    content = file_content(path)
    if b"</VTKFile>" not in content[-200:]:
        raise ReadError(f"'{path}' is no whole VTK XML file: '</VTKFile>' is missing.", path=path)
    _require_likely_counts(content, path)
    kind = re.search(rb'<VTKFile\b[^>]*\btype="(\w+)"', content[:2000])
    if kind is None or kind[1] not in readers:
        found = "of no type" if kind is None else f"of type {kind[1].decode()}"
        raise ReadError(
            f"'{path}' is a VTK file {found}: PolyData and UnstructuredGrid can be read.", path=path
        )
    reader = _vtk_class(readers[kind[1]])()
    reader.SetFileName(str(path))
    with _errors_caught(pv) as errors:
        reader.Update()
    if errors or reader.GetErrorCode():
        raise ReadError(f"'{path}' is a damaged VTK XML file.", path=path)
    return pv.wrap(reader.GetOutput())


def _vtk_class(name: str) -> Any:
    return getattr(import_module("vtkmodules.vtkIOXML"), name)


def _whole(array: Any) -> NDArray[np.int64]:
    """Return a VTK array of numbers of points or cells."""
    numbers: NDArray[np.int64] = import_module("pyvista").convert_array(array).astype(np.int64)
    return numbers


@contextmanager
def _errors_caught(pv: Any) -> Iterator[list[Any]]:
    """Collect what VTK would print to the terminal."""
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    errors: list[Any] = []
    try:
        with pv.VtkErrorCatcher(raise_errors=False, send_to_logging=False) as catcher:
            yield errors
        errors.extend(catcher.error_events)
    finally:
        vtkLogger.SetStderrVerbosity(before)


def _require_likely_counts(content: bytes, path: Path) -> None:
    """Refuse counts that no file of this size can hold, before memory is asked for."""
    for found in _COUNTS.finditer(content):
        if int(found[1]) > len(content) * _CLOSEST_PACKING:
            raise ReadError(
                f"'{path}' is a damaged VTK XML file: it cannot hold {found[0].decode()}.",
                path=path,
            )


def _true_points(mesh: Any) -> NDArray[np.float64]:
    points = np.array(mesh.points, np.float64).reshape(-1, 3)
    for name in ("exaggeration", "elevation_scale"):
        factor = _number_field(mesh, name, 1)
        if factor is not None and factor[0] > 0:
            points[:, 2] /= factor[0]
    origin = _number_field(mesh, "origin", 3)
    return points if origin is None else points + origin


def _number_field(mesh: Any, name: str, size: int) -> NDArray[np.float64] | None:
    if name not in mesh.field_data:
        return None
    values = np.asarray(mesh.field_data[name])
    fits = values.size == size and values.dtype.kind in "iuf" and np.isfinite(values).all()
    return values.ravel().astype(np.float64) if fits else None


def _text_field(mesh: Any, name: str) -> str | None:
    if name not in mesh.field_data:
        return None
    values = np.asarray(mesh.field_data[name]).ravel()
    return (str(values[0]).strip() or None) if len(values) else None


def _faces_of(mesh: Any, path: Path) -> _Faces:
    from pyvista import PolyData

    if isinstance(mesh, PolyData):
        if mesh.n_strips:
            raise ReadError(f"'{path}' holds triangle strips, which are not read.", path=path)
        polys = mesh.GetPolys()
        first = mesh.GetVerts().GetNumberOfCells() + mesh.GetLines().GetNumberOfCells()
        cells = np.arange(first, first + polys.GetNumberOfCells())
        if len(cells) == 0:
            return _Faces(np.empty(0, np.int64), np.zeros(1, np.int64), cells)
        offsets = _whole(polys.GetOffsetsArray())
        corners = _whole(polys.GetConnectivityArray())
        return _Faces(corners, offsets, cells)
    return _faces_of_grid(mesh, path)


def _faces_of_grid(mesh: Any, path: Path) -> _Faces:
    types = np.asarray(mesh.celltypes)
    odd = ~np.isin(types, list(_NO_FACES | _FACES))
    if odd.any():
        raise ReadError(
            f"'{path}' holds {int(odd.sum())} cells that are no faces (first: cell "
            f"{int(np.argmax(odd))} of VTK type {types[np.argmax(odd)]}): triangles, "
            "quadrilaterals and polygons can be read.",
            path=path,
        )
    cells = np.flatnonzero(np.isin(types, list(_FACES)))
    every = _whole(mesh.GetCells().GetOffsetsArray())
    starts, lengths = every[cells], np.diff(every)[cells]
    offsets = np.zeros(len(cells) + 1, np.int64)
    np.cumsum(lengths, out=offsets[1:])
    slots = np.repeat(starts - offsets[:-1], lengths) + np.arange(offsets[-1])
    corners = _whole(mesh.GetCells().GetConnectivityArray())
    return _Faces(corners[slots], offsets, cells)


def _flags(mesh: Any, cells: NDArray[np.int64], n_triangles: int) -> NDArray[np.bool_] | None:
    """Return the edge flags if the file has them and every face is a triangle."""
    if "constrained" not in mesh.cell_data or len(cells) != n_triangles:
        return None
    flags = np.asarray(mesh.cell_data["constrained"])
    return flags[cells] != 0 if flags.ndim == 2 and flags.shape[1] == 3 else None


def _attributes(mesh: Any) -> dict[str, NDArray[Any]]:
    arrays = {str(name): np.array(values) for name, values in mesh.point_data.items()}
    return {name: a for name, a in arrays.items() if a.ndim == 1 and a.dtype.kind in "biuf"}


def write(surface: TIN, path: Path, *, progress: Callable[[float], None] | None = None) -> None:
    """Write a TIN as VTK XML: an UnstructuredGrid to ``.vtu``, else PolyData.

    Parameters
    ----------
    surface : TIN
    path : Path
    progress : callable, optional
        Called with 1.0 at the end.

    Raises
    ------
    FormatError
        If ``surface`` is no TIN.
    MissingExtraError
        If pyvista is not installed.
    WriteError
        If the file cannot be written.
    """
    tin = require_tin(surface, path, format_name="VTK")
    pv = extras.pyvista("Writing VTK files")
    mesh, class_name = _poly_data(tin, pv), "vtkXMLPolyDataWriter"
    if path.suffix.lower() == ".vtu":
        mesh, class_name = mesh.cast_to_unstructured_grid(), "vtkXMLUnstructuredGridWriter"
    writer = _vtk_class(class_name)()
    writer.SetInputData(mesh)
    writer.SetHeaderTypeToUInt64()  # arrays beyond 4 GB
    writer.SetByteOrderToLittleEndian()
    writer.SetCompressionLevel(1)  # twice as fast as the default, and 3 % larger
    with replacing_path(path) as beside:
        writer.SetFileName(str(beside))
        with _errors_caught(pv) as errors:
            written = writer.Write()
        if not written or writer.GetErrorCode() or errors:
            raise WriteError(
                f"Cannot write '{path}': VTK could not finish the file; is the disk full?",
                path=path,
            )
    # Not while VTK writes: it ends the program when a callback of Python meets Ctrl-C.
    if progress is not None:
        progress(1.0)


def _poly_data(tin: TIN, pv: Any) -> Any:
    mesh = pv.PolyData.from_regular_faces(tin.points.copy(), tin.triangles.astype(np.int64))
    mesh.cell_data["slope"] = slope(tin)
    mesh.cell_data["aspect"] = aspect(tin)
    mesh.cell_data["constrained"] = tin.constrained.astype(np.uint8)
    mesh.field_data["crs"] = ["" if tin.crs is None else one_line(tin.crs)]
    mesh.field_data["elevation_unit"] = [unit_text(tin)]
    mesh.field_data["origin"] = np.zeros(3)
    return mesh
