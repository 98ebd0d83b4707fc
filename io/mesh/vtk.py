"""VTK XML files through pyvista: ``.vtp`` (PolyData) and ``.vtu`` (UnstructuredGrid), for ParaView.

Coordinates are written in the CRS as doubles, with nothing subtracted. Cell data are ``slope`` and
``aspect`` (degrees) and ``constrained`` (three flags, of the edge opposite each corner); field data
``crs`` and ``elevation_unit`` ("" if not known), and ``origin``, what a reader must add to the
coordinates: zeros.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import replacing_path
from ...base.errors import ReadError, WriteError
from ...base.sentences import FILE
from ...terrain.relief import aspect, slope
from ..isolated import run_isolated
from . import common
from .common import Mesh, mesh_reader
from .vtk_child import catch_errors, load_vtk_class

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array
    from ...base.progress import Tell
    from ...tin import TIN

_KINDS = ("PolyData", "UnstructuredGrid")
_SHOWN_LETTERS = 60
_CLOSEST_PACKING = 1100  # zlib packs no tighter than 1032 to 1
_COUNTS = re.compile(rb'NumberOf\w+="(\d+)"')


@mesh_reader
def read(path: Path) -> Mesh:
    """Read a VTK XML file of faces.

    CRS and unit default to the field data ``crs`` and ``elevation_unit``. Polygons are cut into
    triangles; cells that are no faces are refused. Field data ``origin`` is added to the
    coordinates, and ``exaggeration`` and ``elevation_scale`` taken out of the elevations first. A
    file without faces gives a survey, with its one-column numeric point data as attributes.
    """
    # Let a child read the file, once its beginning and end are those of a whole one.
    optional.require("pyvista", "Reading VTK files")
    content = common.read_content(path)
    if b"</VTKFile>" not in content[-200:]:
        raise ReadError(f"{FILE} is no whole VTK XML file: '</VTKFile>' is missing.")
    most = len(content) * _CLOSEST_PACKING
    for found in _COUNTS.finditer(content):
        digits = found[1].lstrip(b"0")
        if len(digits) > len(str(most)) or int(digits or b"0") > most:
            said = found[0].decode()
            shown = said if len(said) <= _SHOWN_LETTERS else f"{said[:_SHOWN_LETTERS]}..."
            raise ReadError(f"{FILE} is a damaged VTK XML file: it cannot hold {shown}.")
    kind = re.search(rb'<VTKFile\b[^>]*\btype="(\w+)"', content[:2000])
    if kind is None or kind[1].decode() not in _KINDS:
        what = "of no type" if kind is None else f"of type {kind[1].decode()}"
        raise ReadError(f"{FILE} is a VTK file {what}: PolyData and UnstructuredGrid can be read.")
    value, arrays = run_isolated(
        f"{__package__}.vtk_child:read_mesh",
        {"path": str(path.absolute()), "kind": kind[1].decode()},
        path=path,
    )
    notes = common.describe_single_precision(arrays["points"], value["dtype"])
    points = _restore_points(arrays)
    about = {"crs": value["crs"], "elevation_unit": value["elevation_unit"], "notes": notes}
    if len(arrays["cells"]) == 0:
        names = enumerate(value["attributes"])
        return Mesh(
            points, attributes={name: arrays[f"attribute {k}"] for k, name in names}, **about
        )
    flags = arrays["flags"] != 0 if "flags" in arrays else None
    return Mesh(points, arrays["corners"], arrays["offsets"], flags, **about)


def _restore_points(arrays: Mapping[str, AnyArray]) -> Float64Array:
    """Take an exaggeration out of the elevations, and add the origin."""
    points = arrays["points"]
    origin = arrays.get("origin")
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
        for name in ("exaggeration", "elevation_scale"):
            factor = arrays.get(name)
            if factor is not None and factor[0] > 0:
                points[:, 2] /= factor[0]
        return points if origin is None else points + origin


def write(surface: TIN, path: Path, *, progress: Tell | None = None) -> None:
    """Write a TIN as VTK XML: an UnstructuredGrid to ``.vtu``, else PolyData."""
    tin = common.require_tin(surface, format_name="VTK")
    pv = optional.load("pyvista", "Writing VTK files")
    mesh, class_name = _make_poly_data(tin, pv), "vtkXMLPolyDataWriter"
    if path.suffix.lower() == ".vtu":
        mesh, class_name = mesh.cast_to_unstructured_grid(), "vtkXMLUnstructuredGridWriter"
    writer = load_vtk_class(class_name)()
    writer.SetInputData(mesh)
    writer.SetHeaderTypeToUInt64()  # arrays beyond 4 GB
    writer.SetByteOrderToLittleEndian()
    writer.SetCompressionLevel(1)  # twice as fast as the default, and 3 % larger
    with replacing_path(path) as beside:
        writer.SetFileName(str(beside))
        with catch_errors(pv) as errors:
            written = writer.Write()
        if not written or writer.GetErrorCode() or errors:
            raise WriteError(
                f"Cannot write {FILE}: VTK could not finish the file; is the disk full?"
            )
    # Not while VTK writes: it ends the program when a callback of Python meets Ctrl-C.
    if progress is not None:
        progress(1.0)


def _make_poly_data(tin: TIN, pv: Any) -> Any:
    mesh = pv.PolyData.from_regular_faces(tin.points.copy(), tin.triangles.astype(np.int64))
    mesh.cell_data["slope"] = slope(tin)
    mesh.cell_data["aspect"] = aspect(tin)
    mesh.cell_data["constrained"] = tin.constrained.astype(np.uint8)
    mesh.field_data["crs"] = ["" if tin.crs is None else common.format_crs(tin.crs)]
    mesh.field_data["elevation_unit"] = [common.format_unit(tin)]
    mesh.field_data["origin"] = np.zeros(3)
    return mesh
