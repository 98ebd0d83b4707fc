"""UGRID 1.0: unstructured meshes in netCDF, which Delft3D FM, xugrid and QGIS read.

Coordinates and elevations are doubles; elevations have the standard name ``altitude`` and their
unit. The CRS is a grid-mapping variable with WKT, EPSG number and what CF asks for. Where a TIN
has lines, its edges have a type: hard, soft, boundary, hole, water, or constrained for those of no
line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import checks, optional
from ...base.atomic import replacing_path
from ...base.crs import CRS, METRE, Unit, find_wkt
from ...base.errors import CrsError, OptionError, ReadError, WriteError
from ...base.policies import LineKind
from ...base.products import product
from ...base.sentences import FILE, counted
from ..isolated import run_isolated
from .common import (
    Mesh,
    build_mesh,
    choose_reference,
    describe_single_precision,
    flag_edges,
    format_unit,
    read_content,
    require_tin,
)
from .linework import Chain, add_lines, chain_edges

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...base.crs import CrsLike, UnitLike
    from ...base.policies import FacePolicy
    from ...base.progress import Tell
    from ...tin import TIN, Survey

_MESH = "mesh2d"
_CRS_VARIABLE = "projected_coordinate_system"
_TYPES = ("none", "constrained", "hard", "soft", "boundary", "hole", "water")
"""Types of edges, by their number in the file."""

_NO_CRS = ("EPSG:0", "EPSG:-1")
"""What programs write where they do not know the CRS."""

_LINE_TYPES: dict[int, LineKind] = {2: "hard", 3: "soft", 4: "boundary", 5: "hole", 6: "water"}


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    surface: str | None = None,
    variable: str | None = None,
    faces: FacePolicy = "most",
) -> TIN | Survey:
    """Read a mesh of a UGRID file.

    CRS and unit default to those of the grid-mapping variable and of the variable of elevations.
    Polygons are cut into triangles, which the report tells; other variables, and fields that change
    in time, are left out. A mesh without faces gives a survey.

    Parameters
    ----------
    surface : str, optional
        Name of the mesh; needed where the file has several.
    variable : str, optional
        Name of the variable that holds the nodes' elevations; needed where its attributes do not
        tell. Depths (``positive`` is "down") change their sign, which the report tells.
    """
    optional.require("netCDF4", "Reading UGRID files")
    if not path.is_file():
        read_content(path)  # says why it cannot be read
    wanted = {"path": str(path.absolute()), "surface": surface, "variable": variable}
    value, arrays = run_isolated(f"{__package__}.ugrid_child:read_mesh", wanted, path=path)
    points, notes = arrays["points"], []
    if value["depth"]:
        points[:, 2] *= -1.0
        notes.append(f"Depths '{value['variable']}' grow downwards: their sign was changed.")
    lost = np.isnan(points[:, 2]) & np.isfinite(points[:, :2]).all(axis=1)
    if lost.any():
        count = int(lost.sum())
        raise ReadError(
            f"{counted(count, 'node')} {'has' if count == 1 else 'have'} no elevation in "
            f"'{value['variable']}' (first: node {int(np.argmax(lost))})."
        )
    unit = value["unit"] if _is_unit(value["unit"]) else None
    stated = [text for text in value["crs"] if text not in _NO_CRS]
    found = _find_known_crs(stated)
    if found is None and stated and crs is None:
        raise CrsError(
            f"{FILE} names the CRS '{stated[0][:60]}', which is unknown: declare it.", crs=stated[0]
        )
    reference = choose_reference(crs, elevation_unit, found_crs=found, found_unit=unit)
    notes += describe_single_precision(points, value["dtype"])
    notes += _require_units(value["xy_units"], reference.crs)
    mesh = Mesh(
        points,
        arrays["corners"],
        arrays["offsets"],
        notes=notes,
        add_lines=lambda tin: _add_edge_types(tin, arrays),
    )
    return build_mesh(mesh, path.name, reference=reference, faces=faces)


def _require_units(units: Sequence[str], crs: CRS | None) -> list[str]:
    """Refuse units of eastings and northings that are not those of the CRS; tell lonely ones."""
    words = [text.lower() for text in units]
    is_degrees = any(word.startswith("degree") for word in words)
    lengths = [Unit.of(text) for text in units if _is_unit(text)]
    unit = next((one for one in lengths if one is not None), None)
    if not is_degrees and (unit is None or (crs is None and unit == METRE)):
        return []
    name = "degrees" if unit is None or is_degrees else unit.name
    if crs is None:
        return [f"Eastings and northings of the file are in {name}, and no CRS is named."]
    if is_degrees == crs.is_geographic and (is_degrees or unit == crs.horizontal_unit):
        return []
    of_crs = "degrees" if crs.is_geographic else crs.horizontal_unit.name
    raise ReadError(
        f"{FILE} has eastings and northings in {name}, and {crs.label} measures in {of_crs}: "
        "its CRS is another one."
    )


def _find_known_crs(texts: Sequence[str]) -> str | None:
    for text in texts:
        try:
            return str(CRS.of(text))
        except CrsError:
            continue
    return None


def _is_unit(text: str) -> bool:
    """Whether a unit is a length; files have others, and none ("-", "1")."""
    try:
        return Unit.of(text or None) is not None
    except OptionError:
        return False


def _add_edge_types(tin: TIN, arrays: Mapping[str, AnyArray]) -> TIN:
    if "edges" not in arrays:
        return tin
    edges, types = arrays["edges"], arrays["types"]
    chains = [
        Chain(chain, kind)
        for number, kind in _LINE_TYPES.items()
        for chain in chain_edges(edges[types == number], len(tin.points))
    ]
    tin = add_lines(tin, chains, "typed edge")
    flagged = edges[(types > 0) & (types < len(_TYPES))]
    flags = flag_edges(tin.triangles, flagged, len(tin.points))
    return tin.replace(constrained=tin.constrained | flags)


def write(surface: TIN, path: Path, *, progress: Tell | None = None) -> None:
    """Write a TIN as UGRID 1.0 in netCDF 4."""
    tin = require_tin(surface, format_name="UGRID")
    netcdf = optional.load("netCDF4", "Writing UGRID files")
    with replacing_path(path) as beside:
        try:
            with netcdf.Dataset(str(beside), "w", format="NETCDF4") as data:
                write_content(data, tin)
        except RuntimeError as error:
            raise WriteError(f"Cannot write {FILE}: {error}.") from error
    if progress is not None:
        progress(1.0)


def write_content(data: Any, tin: TIN) -> None:
    """Write a TIN into a data set of netCDF4 that is open and empty."""
    _write_topology(data, tin)
    is_geographic = tin.crs is not None and tin.crs.is_geographic
    unit = "" if tin.crs is None else _format_cf_unit(tin.crs.horizontal_unit)
    names = ("longitude", "latitude") if is_geographic else (
        "projection_x_coordinate", "projection_y_coordinate")  # fmt: skip
    units = ("degrees_east", "degrees_north") if is_geographic else (unit, unit)
    own = {"mesh": _MESH, "location": "node"}
    mapping = {} if tin.crs is None else {"grid_mapping": _CRS_VARIABLE}
    for axis, column, name, unit in zip("xy", tin.points.T[:2], names, units, strict=True):
        variable = data.createVariable(f"{_MESH}_node_{axis}", "f8", (f"{_MESH}_nNodes",))
        variable.setncatts({"standard_name": name, **own, **mapping})
        if unit:
            variable.setncattr("units", unit)
        variable[:] = column
    level = data.createVariable(f"{_MESH}_node_z", "f8", (f"{_MESH}_nNodes",))
    level.setncatts({"standard_name": "altitude", "long_name": "elevation", "positive": "up"})
    level.setncatts({**own, "coordinates": f"{_MESH}_node_x {_MESH}_node_y", **mapping})
    if tin.elevation_unit is not None and format_unit(tin):
        level.setncattr("units", _format_cf_unit(tin.elevation_unit))
    level[:] = tin.points[:, 2]
    shape = (f"{_MESH}_nFaces", f"{_MESH}_nMax_face_nodes")
    faces = data.createVariable(f"{_MESH}_face_nodes", "i4", shape, fill_value=np.int32(-999))
    faces.setncatts({"cf_role": "face_node_connectivity", "mesh": _MESH, "location": "face",
                     "long_name": "nodes of each face, counter-clockwise",
                     "start_index": np.int32(0)})  # fmt: skip
    faces[:] = tin.triangles
    if tin.constrained.any():
        _write_edges(data, tin)


def _write_topology(data: Any, tin: TIN) -> None:
    data.setncatts({"Conventions": "CF-1.8 UGRID-1.0", "source": "tinsmith"})
    data.createDimension(f"{_MESH}_nNodes", len(tin.points))
    data.createDimension(f"{_MESH}_nFaces", len(tin.triangles))
    data.createDimension(f"{_MESH}_nMax_face_nodes", 3)
    mesh = data.createVariable(_MESH, "i4")
    mesh.setncatts(
        {
            "cf_role": "mesh_topology",
            "long_name": "triangulated irregular network",
            "topology_dimension": np.int32(2),
            "node_coordinates": f"{_MESH}_node_x {_MESH}_node_y",
            "node_dimension": f"{_MESH}_nNodes",
            "face_node_connectivity": f"{_MESH}_face_nodes",
            "face_dimension": f"{_MESH}_nFaces",
            "max_face_nodes_dimension": f"{_MESH}_nMax_face_nodes",
        }
    )
    if tin.crs is not None:
        grid = data.createVariable(_CRS_VARIABLE, "i4")
        crs = tin.crs
        wkt = crs.to_wkt()
        attributes: dict[str, Any] = {
            name: value
            for name, value in crs.to_pyproj().to_cf().items()
            if value is not None and isinstance(value, str | float | int | list | tuple)
        }
        attributes |= {"crs_wkt": wkt, "name": crs.name}
        epsg = crs.to_epsg()
        if epsg is None:
            attributes = attributes | {"wkt": find_wkt(crs, "WKT1_GDAL") or wkt}
        else:
            attributes = attributes | {"epsg": np.int32(epsg), "EPSG_code": f"EPSG:{epsg}"}
        grid.setncatts(attributes)


def _format_cf_unit(unit: Unit) -> str:
    """Return a unit as CF's programs know it; the name where it has no such symbol."""
    known = {"metre": "m", "foot": "ft", "US survey foot": "US_survey_foot"}
    return known.get(unit.name, unit.name)


def _write_edges(data: Any, tin: TIN) -> None:
    from ...tin.topology import edge_keys, ends

    edges, count = tin.edges, len(tin.points)
    types = np.zeros(len(edges), np.int8)
    triangle, corner = np.nonzero(tin.constrained)
    held = np.stack(ends(tin.triangles, triangle, corner), axis=1)
    keys = edge_keys(edges, count)
    types[np.isin(keys, edge_keys(held, count))] = _TYPES.index("constrained")
    own = tin.lines.segments().reshape(-1, 2)
    kinds = np.array([_TYPES.index(kind) for kind in tin.lines.kinds], np.int8)
    order = np.argsort(keys)
    at = order[np.searchsorted(keys, edge_keys(own, count), sorter=order)]
    types[at] = kinds[tin.lines.segment_chains()] if len(own) else 0
    data.createDimension(f"{_MESH}_nEdges", len(edges))
    data.createDimension("Two", 2)
    data.variables[_MESH].setncatts({"edge_node_connectivity": f"{_MESH}_edge_nodes",
                                     "edge_dimension": f"{_MESH}_nEdges"})  # fmt: skip
    nodes = data.createVariable(f"{_MESH}_edge_nodes", "i4", (f"{_MESH}_nEdges", "Two"))
    nodes.setncatts({"cf_role": "edge_node_connectivity", "start_index": np.int32(0)})
    nodes[:] = edges
    flags = data.createVariable(f"{_MESH}_edge_type", "i1", (f"{_MESH}_nEdges",))
    flags.setncatts({"long_name": "line that the edge is of", "mesh": _MESH, "location": "edge",
                     "flag_values": np.arange(len(_TYPES), dtype=np.int8),
                     "flag_meanings": " ".join(_TYPES)})  # fmt: skip
    flags[:] = types


@product
def to_ugrid(tin: TIN) -> Any:
    """Return a TIN as a data set of xarray by the conventions of UGRID.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    xarray.Dataset
        What a UGRID file of the TIN holds: the topology ``mesh2d``, ``mesh2d_node_x``,
        ``mesh2d_node_y`` and ``mesh2d_node_z`` in double precision, ``mesh2d_face_nodes``, the CRS
        in ``projected_coordinate_system``; where there are lines the edges with their type.
        ``xugrid.UgridDataset`` takes it.

    Raises
    ------
    MissingExtraError
        If xarray or netCDF4 is not installed.
    PointsError
        If ``tin`` is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> ts.to_ugrid(tin)["mesh2d_node_z"].values
    array([5., 6., 7., 8.])
    """
    xarray = optional.load("xarray", "Turning a TIN into a data set of UGRID")
    netcdf = optional.load("netCDF4", "Turning a TIN into a data set of UGRID")
    checks.require_tin(tin)
    with netcdf.Dataset("tin.nc", "w", format="NETCDF4", diskless=True, persist=False) as data:
        write_content(data, tin)
        data.set_auto_mask(False)
        variables = {
            name: (one.dimensions, one[...], {key: one.getncattr(key) for key in one.ncattrs()})
            for name, one in data.variables.items()
        }
        about = {key: data.getncattr(key) for key in data.ncattrs()}
    made = xarray.Dataset(variables, attrs=about)
    for one in made.variables.values():  # where xarray looks for it when it writes
        if "_FillValue" in one.attrs:
            one.encoding["_FillValue"] = one.attrs.pop("_FillValue")
    return made.set_coords([name for name in made if str(name).endswith(("_node_x", "_node_y"))])
