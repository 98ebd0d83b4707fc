"""TINs as meshes of PyVista, trimesh and meshio, and their triangles as TINs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.checks import require_tin
from ...base.errors import PointsError, ReadError
from ...base.notes import naming_file
from ...base.products import product
from ...base.sentences import counted, name_file
from ...terrain.drawing import choose_origin
from ...tin import TIN
from ...tin.checking import describe_oddities
from .common import (
    add_notes,
    choose_reference,
    cut_into_fans,
    describe_single_precision,
    format_crs,
    format_unit,
)
from .surface_part import make_surface
from .vtk_child import read_dataset

if TYPE_CHECKING:
    import pyvista

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.policies import FacePolicy

_FACES = {"triangle": 3, "quad": 4}
_WITHOUT_FACES = frozenset({"vertex", "line"})


class _Shifted(NamedTuple):
    """Vertices near zero, and what brings them back exactly."""

    points: Float64Array
    origin: Float64Array


def _shift(tin: TIN) -> _Shifted:
    """Subtract an origin, 0 along an axis where adding it again would not give the same number."""
    origin = choose_origin(tin)
    shifted = tin.points - origin
    is_lost = (shifted + origin != tin.points).any(axis=0)
    origin = np.where(is_lost, 0.0, origin)
    return _Shifted(tin.points - origin, origin)


def _describe(tin: TIN) -> dict[str, str]:
    return {
        "crs": "" if tin.crs is None else format_crs(tin.crs),
        "elevation_unit": format_unit(tin),
    }


@product
def to_pyvista(tin: TIN) -> pyvista.PolyData:
    """Return a TIN as a mesh of PyVista that :func:`from_mesh` takes back bit for bit.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    pyvista.PolyData
        Double-precision points in CRS units, from which the field data ``origin`` was subtracted,
        since graphics cards compute in single precision; the triangles in the TIN's order.
        Point data ``elevation`` and the numbers among the attributes, cell data ``constrained``
        (three flags, of the edge opposite each corner), field data ``crs`` and ``elevation_unit``
        ("" if not known).

    Raises
    ------
    MissingExtraError
        If pyvista is not installed.
    PointsError
        If ``tin`` is none.

    See Also
    --------
    lift : the same true to scale, elevations converted to the unit of eastings.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[500_000, 4e6, 81], [500_040, 4e6, 83], [500_000, 4_000_030, 85]])
    >>> mesh = ts.to_pyvista(tin)
    >>> mesh.field_data["origin"].tolist()
    [500020.0, 4000020.0, 83.0]
    >>> ts.from_mesh(mesh) == tin
    True
    """
    pv = optional.load("pyvista", "Turning a TIN into a mesh of PyVista")
    require_tin(tin)
    shifted = _shift(tin)
    mesh: pyvista.PolyData = pv.PolyData.from_regular_faces(
        shifted.points, tin.triangles.astype(np.int64)
    )
    mesh.point_data["elevation"] = tin.points[:, 2].copy()
    for name, values in tin.attributes.items():
        if values.dtype.kind in "iuf" and name != "elevation":
            mesh.point_data[str(name)] = values.copy()
    mesh.cell_data["constrained"] = tin.constrained.astype(np.uint8)
    mesh.field_data["origin"] = shifted.origin
    for name, text in _describe(tin).items():
        mesh.field_data[name] = [text]
    mesh.set_active_scalars("elevation")
    return mesh


@product
def to_trimesh(tin: TIN) -> Any:
    """Return a TIN as a mesh of trimesh that :func:`from_mesh` takes back bit for bit.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    trimesh.Trimesh
        Its ``metadata`` have the ``origin`` that was subtracted from the points, ``crs`` and
        ``elevation_unit`` ("" if not known). Vertices and faces are in the TIN's order: nothing is
        merged.

    Raises
    ------
    MissingExtraError
        If trimesh is not installed.
    PointsError
        If ``tin`` is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> mesh = ts.to_trimesh(tin)
    >>> len(mesh.faces), mesh.metadata["origin"].tolist()
    (2, [2.0, 2.0, 6.0])
    """
    trimesh = optional.load("trimesh", "Turning a TIN into a mesh of trimesh")
    require_tin(tin)
    shifted = _shift(tin)
    metadata = {"origin": shifted.origin, **_describe(tin)}
    return trimesh.Trimesh(
        vertices=shifted.points, faces=tin.triangles.copy(), process=False, metadata=metadata
    )


@product
def to_meshio(tin: TIN) -> Any:
    """Return a TIN as a mesh of meshio that :func:`from_mesh` takes back bit for bit.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    meshio.Mesh
        Points as they are, nothing subtracted, and one block of triangles. Point data are the
        numbers among the attributes, cell data ``constrained`` (three flags, of the edge opposite
        each corner); ``info`` has ``crs`` and ``elevation_unit``, which no file of meshio keeps.

    Raises
    ------
    MissingExtraError
        If meshio is not installed.
    PointsError
        If ``tin`` is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]], crs="EPSG:32616")
    >>> ts.to_meshio(tin).info["crs"]
    'EPSG:32616'
    """
    meshio = optional.load("meshio", "Turning a TIN into a mesh of meshio")
    require_tin(tin)
    attributes = {
        str(name): values.copy()
        for name, values in tin.attributes.items()
        if values.dtype.kind in "iuf"
    }
    mesh = meshio.Mesh(
        tin.points.copy(),
        [("triangle", tin.triangles.copy())],
        point_data=attributes,
        cell_data={"constrained": [tin.constrained.astype(np.uint8)]},
    )
    mesh.info = _describe(tin)
    return mesh


# ----------------------------------------------------------------------- and back


class _Found(NamedTuple):
    """A mesh of another library."""

    points: Float64Array
    corners: Int64Array
    offsets: Int64Array
    about: Mapping[str, Any]
    flags: BoolArray | None
    attributes: Mapping[str, AnyArray]
    dtype: Any


def from_mesh(
    mesh: Any,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    faces: FacePolicy = "most",
) -> TIN:
    """Return a TIN of the triangles of another library's mesh, which are kept as they are.

    Parameters
    ----------
    mesh : pyvista.PolyData, pyvista.UnstructuredGrid, meshio.Mesh or trimesh.Trimesh
    crs : CRS, str, int or pyproj.CRS, optional
        Declares the CRS; default the one that the mesh has from tinsmith.
    elevation_unit : Unit or str, optional
        Declares the unit of the elevations; default the one that the mesh has from tinsmith.
    faces : {"most", "all", "surface"}
        What becomes of faces without area seen from above, and of those that overlap larger ones:
        "surface" leaves them out, "all" refuses the mesh, and "most" leaves them out where they are
        at most one percent; the report tells how many.

    Returns
    -------
    TIN
        Vertices and triangles in the order of the mesh, clockwise ones turned round; they need not
        be Delaunay. Quadrilaterals and polygons are cut into triangles, which the report tells. An
        ``origin`` that tinsmith subtracted is added again.

    Raises
    ------
    PointsError
        If it is no such mesh, or its faces are no TIN: one has no area seen from above, or they
        overlap.
    CrsError, OptionError
        If a CRS or unit is unknown, or another than that of the mesh.

    Examples
    --------
    >>> import pyvista
    >>> import tinsmith as ts
    >>> ts.from_mesh(pyvista.Plane().triangulate(), crs="EPSG:32616")
    <TIN: 121 vertices, 200 triangles, z 0 to 0, crs EPSG:32616>
    """
    name = Path(type(mesh).__name__)
    try:
        found = _find_faces(mesh)
        with naming_file(name):
            reference = choose_reference(
                crs,
                elevation_unit,
                found_crs=_as_text(found.about.get("crs")),
                found_unit=_as_text(found.about.get("elevation_unit")),
            )
        points = _restore_points(found)
        fans = cut_into_fans(found.corners, found.offsets, points)
    except ReadError as error:
        error.add_file(name)
        raise PointsError(str(error)) from error
    has_flags = found.flags is not None and len(found.flags) == len(fans.triangles)

    def make(kept: BoolArray | slice) -> TIN:
        return TIN.from_triangles(
            points,
            fans.triangles[kept],
            constrained=found.flags[kept] if found.flags is not None and has_flags else None,
            crs=reference.crs,
            elevation_unit=reference.elevation_unit,
            attributes=found.attributes,
        )

    tin, notes = make_surface(make, points, fans.triangles, faces=faces)
    overlaps = next((note for note in notes if note.startswith("Triangles overlap")), "")
    if overlaps:
        raise PointsError(f"'{name}' holds no TIN. {overlaps}")
    rounded = describe_single_precision(points, found.dtype)
    notes += [*rounded, *fans.notes, *describe_oddities(tin)]
    return add_notes(tin, notes)


def _as_text(value: Any) -> str | None:
    return str(value) or None if value is not None else None


def _restore_points(found: _Found) -> Float64Array:
    """Take an exaggeration out of the elevations, and add the origin."""
    points = found.points.copy()
    for name in ("exaggeration", "elevation_scale"):
        factor = np.ravel(found.about.get(name, 1.0))[0]
        if factor != 1.0:
            points[:, 2] /= factor
    origin = np.ravel(np.asarray(found.about.get("origin", np.zeros(3)), np.float64))
    if origin.shape != (3,):
        has = counted(len(origin), "number")
        raise PointsError(f"The origin of the mesh has {has}: three are needed.")
    moved: Float64Array = points + origin
    return moved


def _find_faces(mesh: Any) -> _Found:
    if hasattr(mesh, "GetPointData") and hasattr(mesh, "field_data"):
        return _read_pyvista(mesh)
    if hasattr(mesh, "cells") and hasattr(mesh, "point_data"):
        return _read_meshio(mesh)
    if hasattr(mesh, "faces") and hasattr(mesh, "vertices"):
        faces = np.asarray(mesh.faces, np.int64)
        metadata = getattr(mesh, "metadata", None)
        about = metadata if isinstance(metadata, Mapping) else {}
        offsets = np.arange(0, faces.size + 1, 3)
        points = np.asarray(mesh.vertices, np.float64)
        return _Found(points, faces.ravel(), offsets, about, None, {}, points.dtype)
    raise PointsError(
        f"Invalid mesh of type {type(mesh).__name__}: a PolyData or UnstructuredGrid of PyVista, a "
        "meshio.Mesh or a trimesh.Trimesh is needed."
    )


def _read_pyvista(mesh: Any) -> _Found:
    try:
        value, arrays = read_dataset(mesh)
    except Exception as error:
        raise PointsError(name_file(str(error), type(mesh).__name__)) from error
    names = ("origin", "exaggeration", "elevation_scale")
    attributes = {name: arrays[f"attribute {k}"] for k, name in enumerate(value["attributes"])}
    attributes.pop("elevation", None)
    return _Found(
        arrays["points"],
        arrays["corners"],
        arrays["offsets"],
        {**value, **{name: arrays[name] for name in names if name in arrays}},
        arrays["flags"] != 0 if "flags" in arrays else None,
        attributes,
        value["dtype"],
    )


def _read_meshio(mesh: Any) -> _Found:
    points = np.asarray(mesh.points)
    if points.ndim != 2 or points.shape[1] != 3:
        raise PointsError(
            f"The points of the mesh have shape {points.shape}: (n, 3), with elevations, is needed."
        )
    for block in mesh.cells:
        if block.type not in _FACES.keys() | _WITHOUT_FACES:
            raise PointsError(
                f"The mesh holds cells of type {block.type}: triangles and quadrilaterals can be "
                "taken."
            )
    blocks = [k for k, block in enumerate(mesh.cells) if block.type in _FACES]
    if not blocks:
        raise PointsError("The mesh holds no faces: triangles or quadrilaterals are needed.")
    faces = [np.asarray(mesh.cells[k].data, np.int64) for k in blocks]
    sizes = np.concatenate([np.full(len(one), one.shape[1]) for one in faces])
    flags = [np.asarray(block) for block in mesh.cell_data.get("constrained", [])]
    is_flagged = bool(flags) and all(
        flags[k].shape == (len(one), 3) for k, one in zip(blocks, faces, strict=True)
    )
    count = len(points)
    arrays = {str(name): np.asarray(values) for name, values in mesh.point_data.items()}
    return _Found(
        points.astype(np.float64),
        np.concatenate([one.ravel() for one in faces]),
        np.concatenate([[0], np.cumsum(sizes)]),
        getattr(mesh, "info", None) or {},
        np.concatenate([flags[k] for k in blocks]) != 0 if is_flagged else None,
        {
            name: values
            for name, values in arrays.items()
            if values.shape == (count,) and values.dtype.kind in "biuf"
        },
        points.dtype,
    )
