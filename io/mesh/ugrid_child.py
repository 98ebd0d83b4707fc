"""UGRID files through netCDF4, as the child process reads them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.sentences import FILE, counted
from ..isolated import Answer, Refusal

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...base.arrays import Float64Array, Int64Array

_ELEVATIONS = frozenset(
    {"altitude", "height_above_reference_ellipsoid", "height_above_mean_sea_level",
     "height_above_geopotential_datum", "surface_altitude", "ground_level_altitude"}
)  # fmt: skip
"""Standard names of what grows upwards."""

_DEPTHS = frozenset(
    {"depth", "sea_floor_depth", "sea_floor_depth_below_geoid",
     "sea_floor_depth_below_mean_sea_level", "sea_floor_depth_below_sea_surface",
     "sea_floor_depth_below_geopotential_datum"}
)  # fmt: skip
_CRS_NAMES = ("projected_coordinate_system", "wgs84", "crs", "spatial_ref")
"""What programs call the variable of the CRS where no attribute points to it."""

_CRS_TEXTS = ("crs_wkt", "wkt", "spatial_ref", "EPSG_code")
_LARGEST_EXACT = 2.0**53


def prepare() -> None:
    """Load the library."""
    import_module("netCDF4")


def read_mesh(path: str, *, surface: str | None, variable: str | None) -> Answer:
    """Return the points and faces of a mesh, of several the one that is named.

    The value holds the ``mesh``, the ``variable`` of elevations, by default the one that its
    attributes tell, and whether it is a ``depth``, its ``unit``, texts of the CRS to try,
    ``xy_units`` and the ``dtype`` of eastings and northings. The arrays hold ``points``,
    ``corners`` of the faces, their ``offsets``, and where the file has them ``edges`` and their
    ``types``.
    """
    with import_module("netCDF4").Dataset(path) as data:
        mesh = _find_mesh(data, surface)
        places = _find_coordinates(data, mesh)
        x, y = (_read_numbers(one) for one in _find_coordinates(data, mesh))
        if len(x) != len(y):
            raise Refusal(
                f"{FILE} is a damaged UGRID file: {counted(len(x), 'easting')} and "
                f"{counted(len(y), 'northing')}."
            )
        level = _find_elevations(data, mesh, len(x), variable)
        z = _read_numbers(level)
        name = _get_text(mesh, "face_node_connectivity")
        table = _read_table(_get_variable(data, name, mesh, "faces"))
        dimension = _get_text(mesh, "face_dimension")
        if bool(dimension) and data.variables[name].dimensions[1] == dimension:
            table = table.T
        held = table >= 0
        first_gap = np.where(held.all(axis=1), table.shape[1], np.argmin(held, axis=1))
        corner = np.arange(table.shape[1]) < first_gap[:, None]
        corners, offsets = table[corner], np.concatenate([[0], np.cumsum(first_gap)])
        candidates = _get_text(level, "positive").lower()
        value = {
            "mesh": mesh.name,
            "variable": level.name,
            "depth": (
                candidates == "down" if candidates else _get_text(level, "standard_name") in _DEPTHS
            ),
            "unit": _get_text(level, "units"),
            "crs": _find_crs(data, (level, *places)),
            "xy_units": [_get_text(one, "units") for one in places],
            "dtype": "float32" if any(one.dtype == np.float32 for one in places) else "float64",
        }
        arrays = {"points": np.column_stack([x, y, z]), "corners": corners, "offsets": offsets}
        return Answer(value, arrays | _read_edges(data, mesh, len(x)))


def _get_text(variable: Any, name: str) -> str:
    if name not in variable.ncattrs():
        return ""
    value = variable.getncattr(name)
    return value.strip() if isinstance(value, str) else str(np.asarray(value).ravel()[:1].tolist())


def _list_names(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def _find_mesh(data: Any, surface: str | None) -> Any:
    meshes = {
        name: one
        for name, one in data.variables.items()
        if _get_text(one, "cf_role") == "mesh_topology" and _get_text(one, "face_node_connectivity")
    }
    if not meshes:
        raise Refusal(
            f"{FILE} holds no UGRID mesh of faces: no variable has cf_role 'mesh_topology' and "
            "face_node_connectivity."
        )
    if surface is None and len(meshes) > 1:
        raise Refusal(
            f"{FILE} holds {len(meshes)} meshes: name one as surface, {_list_names(meshes)}."
        )
    if surface is not None and surface not in meshes:
        raise Refusal(
            f"{FILE} holds no mesh '{surface}': there {'is' if len(meshes) == 1 else 'are'} "
            f"{_list_names(meshes)}."
        )
    return meshes[next(iter(meshes)) if surface is None else surface]


def _get_variable(data: Any, name: str, mesh: Any, role: str) -> Any:
    if name not in data.variables:
        raise Refusal(
            f"{FILE} is a damaged UGRID file: mesh '{mesh.name}' names '{name}' as its {role}, "
            "and there is no such variable."
        )
    return data.variables[name]


def _find_coordinates(data: Any, mesh: Any) -> tuple[Any, Any]:
    names = _get_text(mesh, "node_coordinates").split()
    if len(names) < 2:
        raise Refusal(
            f"{FILE} is a damaged UGRID file: mesh '{mesh.name}' names no node_coordinates."
        )
    found = [_get_variable(data, name, mesh, "node_coordinates") for name in names]
    axes = [_find_axis(one) for one in found]
    if "x" in axes and "y" in axes:
        return found[axes.index("x")], found[axes.index("y")]
    return found[0], found[1]


def _find_axis(variable: Any) -> str:
    """Return what a variable of coordinates is by its attributes: x, y or z, else nothing."""
    name, unit = _get_text(variable, "standard_name"), _get_text(variable, "units").lower()
    if name in ("projection_x_coordinate", "longitude") or unit.startswith(
        ("degrees_e", "degree_e")
    ):
        return "x"
    if name in ("projection_y_coordinate", "latitude") or unit.startswith(
        ("degrees_n", "degree_n")
    ):
        return "y"
    return "z" if name in _ELEVATIONS | _DEPTHS else ""


def _read_numbers(variable: Any) -> Float64Array:
    """Return the numbers of a variable of one dimension, NaN where it has none."""
    if variable.ndim != 1 or np.dtype(variable.dtype).kind not in "iuf":
        raise Refusal(
            f"the variable '{variable.name}' has {counted(variable.ndim, 'dimension')} "
            f"and type {variable.dtype}: one row of numbers is needed, one for each node."
        )
    return np.ma.filled(np.ma.asarray(variable[:]).astype(np.float64), np.nan)


def _find_elevations(data: Any, mesh: Any, count: int, wanted: str | None) -> Any:
    if wanted is not None:
        if wanted in data.variables and data.variables[wanted].shape == (count,):
            return data.variables[wanted]
        fitting = [name for name, one in data.variables.items() if one.shape == (count,)]
        raise Refusal(
            f"{FILE} has no variable '{wanted}' with a number for each of {count} nodes: "
            f"{_list_names(fitting) or 'nothing'} has."
        )
    own = [one for one in data.variables.values()
           if one.shape == (count,) and _is_at_nodes(one, data, mesh)]  # fmt: skip
    candidates = [one for one in own if _get_text(one, "standard_name") == "altitude"]
    candidates = candidates or [
        one for one in own if _find_axis(one) == "z" or _get_text(one, "positive")
    ]
    candidates = candidates or [
        one for one in own if one.name in (f"{mesh.name}_node_z", f"{mesh.name}_z")
    ]
    if len(candidates) == 1:
        return candidates[0]
    what = "no elevations of its nodes are told" if not candidates else (
        f"{_list_names(one.name for one in candidates)} may be the elevations")  # fmt: skip
    others = _list_names(one.name for one in own) or "there is none with one number for each node"
    raise Refusal(f"{what}: name the variable that they are in ({others}).")


def _is_at_nodes(variable: Any, data: Any, mesh: Any) -> bool:
    """Whether a variable belongs to the nodes of the mesh, and is no coordinate in the plane."""
    named = _get_text(mesh, "node_coordinates").split()
    if _find_axis(variable) in ("x", "y") or variable.name in named[:2]:
        return False
    return (
        variable.dimensions == data.variables[named[0]].dimensions
        and _get_text(variable, "location") in ("", "node")
        and _get_text(variable, "mesh") in ("", mesh.name)
        and np.dtype(variable.dtype).kind in "iuf"
    )


def _read_table(variable: Any) -> Int64Array:
    """Return a table of node numbers from 0 on; -1 where there is none."""
    if variable.ndim != 2 or np.dtype(variable.dtype).kind not in "iuf":
        raise Refusal(
            f"{FILE} is a damaged UGRID file: '{variable.name}' is no table of node numbers."
        )
    if "start_index" not in variable.ncattrs():
        start = 0
    else:
        start = int(np.asarray(variable.getncattr("start_index")).ravel()[0])
    found = np.ma.filled(np.ma.asarray(variable[:]).astype(np.float64), -np.inf)
    found = np.where(np.isnan(found), -np.inf, found)
    beyond = np.isfinite(found) & (
        (np.abs(found) > _LARGEST_EXACT) | (found != np.floor(found)) | (found < start)
    )
    fills = found < 0  # some programs fill with -1 or -999, and do not say so
    if (beyond & ~fills).any():
        wrong = found[beyond & ~fills][0]
        raise Refusal(
            f"{FILE} is a damaged UGRID file: '{variable.name}' names the node {wrong:g}, and "
            f"they are whole numbers from {start} on."
        )
    return np.where(fills, -1, np.where(fills, 0, found) - start).astype(np.int64)


def _read_edges(data: Any, mesh: Any, n_nodes: int) -> dict[str, Int64Array]:
    """Return the edges with a type, as this package writes them; nothing where there are none."""
    name = _get_text(mesh, "edge_node_connectivity")
    types = data.variables.get(f"{mesh.name}_edge_type")
    if name not in data.variables or types is None or not _get_text(types, "flag_meanings"):
        return {}
    try:
        edges = _read_table(data.variables[name])
    except Refusal:
        return {}
    sound = edges.shape == (*types.shape[:1], 2) and np.dtype(types.dtype).kind in "iu"
    if not sound or ((edges < 0) | (edges >= n_nodes)).any():
        return {}
    return {"edges": edges, "types": np.ma.filled(np.ma.asarray(types[:]), 0).astype(np.int64)}


def _find_crs(data: Any, variables: Sequence[Any]) -> list[str]:
    """Return the texts that tell the CRS, the best first."""
    names = [_get_text(one, "grid_mapping").split(":")[0].strip() for one in variables]
    found = next((name for name in [*names, *_CRS_NAMES] if name in data.variables), None)
    if found is None:
        return []
    variable = data.variables[found]
    texts = [_get_text(variable, name) for name in _CRS_TEXTS]
    if "epsg" in variable.ncattrs():
        number = np.asarray(variable.getncattr("epsg")).ravel()[0]
        texts.append(f"EPSG:{int(number)}" if np.isreal(number) and number > 0 else "")
    return [text for text in texts if text]
