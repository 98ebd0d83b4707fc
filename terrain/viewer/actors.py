"""Actors: the surface with its tints, the block it stands on, and the light from northwest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...tin.topology import edges_at
from ..drawing import choose_origin, make_legend, palette
from ..surface import NORTHWEST, Light, compute_normals, measure_aspects, measure_slopes

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float32Array, Float64Array, Int32Array
    from ...base.georeference import Ground
    from ...base.policies import Tint
    from ...tin import TIN
    from .ortho import Ortho

_PURPOSE = "A preview"

BLOCK_SHARE = 0.025
"""Depth of the block below the lowest point, as a share of the extent."""

_BLOCK_AMBIENT = 0.72
_ORTHO_AMBIENT = 0.68
"""A photograph has shadows of its own: the light adds half as much as to tints."""

_EDGE_OPACITY = 0.42
_FAINTEST_EDGE = 0.04
_CLEAR_SIDE = 16.0
"""Side of a triangle, in design pixels, from which its edges are drawn at full strength."""

_AMBIENT = 0.36
"""The light of printed maps."""

_SUN = 0.58
_FROM_ABOVE = 0.10
_SKY = ((-90.0, 50.0, 0.10), (90.0, 50.0, 0.06))
"""Azimuth from that of the sun and altitude (degrees), and strength: a weak sky beside it."""

_STEEPNESS = math.sin(math.radians(NORTHWEST.altitude))
"""Of the usual sun. For any other the sky above makes up for the difference, so that the tint of
level ground is always that of the legend."""


def place_vertices(tin: TIN, ground: Ground, exaggeration: float) -> Float64Array:
    """Return the vertices as drawn: true to scale on the ground, near the origin."""
    east, north, height = ground.scale
    return (tin.points - choose_origin(tin)) * (east, north, height * exaggeration)


def add_terrain(
    plotter: Any,
    tin: TIN,
    points: Float64Array,
    *,
    edges: bool,
    elevations: tuple[float, float] | None = None,
    tint: Tint = "elevation",
    is_far_off: BoolArray | None = None,
    has_block: bool = True,
) -> tuple[Any, Float64Array]:
    """Add the surface and its block to a plotter; return its actor, and points that must be seen.

    ``points`` are its vertices as drawn, (n, 3); ``elevations`` those of the lowest and the highest
    tint, by default of the TIN; the vertices ``is_far_off``, (n,), need not be in the picture,
    however high or low they are. What must be seen is (k, 3).
    """
    pv = optional.load("pyvista", _PURPOSE)

    ends = (tin.points[:, 2].min(), tin.points[:, 2].max()) if elevations is None else elevations
    surface = pv.PolyData.from_regular_faces(points, np.array(tin.triangles))
    surface.point_data["elevation"] = tin.points[:, 2].copy()
    surface.point_data.active_normals = _average_normals(points, tin.triangles)
    coloring = _choose_tints(pv, surface, tin, tint, (float(ends[0]), float(ends[1])))
    actor = plotter.add_mesh(surface, **coloring, **_choose_lighting(), show_scalar_bar=False)
    actor.prop.interpolation = "Phong"
    if edges:
        actor.prop.show_edges = True
        actor.prop.edge_color = palette.EDGES
    kept = points if is_far_off is None else points[~is_far_off]
    if not has_block:
        return actor, kept
    block = _make_block(pv, tin, points, float(kept[:, 2].min()))
    plotter.add_mesh(block, color=palette.BLOCK, culling="back", **_choose_lighting(_BLOCK_AMBIENT))
    rim = block.points if is_far_off is None else _without(block.points, kept)
    return actor, np.vstack([kept, rim])


def _without(points: Float64Array, kept: Float64Array) -> Float64Array:
    """Return the points of a block, base last, but for corners far above it or below its base."""
    height = points[:, 2]
    rim: Float64Array = points[(height >= height[-1]) & (height <= kept[:, 2].max())]
    return rim


def add_ortho(plotter: Any, tin: TIN, points: Float64Array, ortho: Ortho, surface: Any) -> Any:
    """Lay a picture over the surface, and return its actor; where it has none, the tints are seen.

    ``points`` are the vertices as drawn, (n, 3); the surface is moved back a little.
    """
    pv = optional.load("pyvista", _PURPOSE)

    rows, columns = ortho.shape
    sides = np.array([columns, rows])
    # The picture has a transparent frame of a pixel, so that nothing of its edge is drawn out.
    share = (ortho.place(tin.points) * sides + 1.0) / (sides + 2.0)
    draped = pv.PolyData.from_regular_faces(points, np.array(tin.triangles))
    draped.active_texture_coordinates = np.column_stack([share[:, 0], 1.0 - share[:, 1]])
    draped.point_data.active_normals = _average_normals(points, tin.triangles)
    texture = pv.Texture(np.pad(ortho.decode(), ((1, 1), (1, 1), (0, 0))))
    texture.interpolate, texture.mipmap, texture.repeat = True, True, False
    lighting = _choose_lighting(_ORTHO_AMBIENT)
    actor = plotter.add_mesh(draped, color="white", texture=texture, **lighting)
    actor.prop.interpolation = "Phong"
    actor.ForceTranslucentOn()
    surface.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    surface.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0)
    if surface.prop.show_edges:
        actor.prop.show_edges = True
        actor.prop.edge_color = palette.EDGES
    return actor


def fade_edges(actor: Any, tin: TIN, ground: Ground, pixels: float) -> None:
    """Draw the edges of a surface fainter where triangles are small, or they would hide the tints.

    A length of 1 in the scene has so many design pixels.
    """
    area = tin.triangulation.area * ground.scale[0] * ground.scale[1] / len(tin.triangles)
    side = math.sqrt(2 * area) * pixels
    strength = min(side / _CLEAR_SIDE, 1.0)
    actor.prop.edge_opacity = max(_EDGE_OPACITY * strength, _FAINTEST_EDGE)


def add_lights(plotter: Any, sun: Light = NORTHWEST) -> None:
    """Light the scene, wherever the camera stands: by a sun, and a weak sky around it."""
    pv = optional.load("pyvista", _PURPOSE)

    plotter.remove_all_lights()
    for azimuth, height, strength in _balance_lights(sun):
        turn, rise = math.radians(azimuth), math.radians(height)
        flat = math.cos(rise)
        lamp = pv.Light(light_type="scene light", intensity=strength)
        lamp.position = (flat * math.sin(turn), flat * math.cos(turn), math.sin(rise))
        lamp.focal_point = (0.0, 0.0, 0.0)
        plotter.add_light(lamp)


def _balance_lights(sun: Light) -> list[tuple[float, float, float]]:
    """Return azimuth, altitude and strength of all lights; level ground is always lit alike."""
    steepness = math.sin(math.radians(sun.altitude))
    above = _FROM_ABOVE + _SUN * (_STEEPNESS - steepness)
    strength = _SUN if above >= 0 else (_FROM_ABOVE + _SUN * _STEEPNESS) / steepness
    beside = [((sun.azimuth + turn) % 360.0, height, share) for turn, height, share in _SKY]
    return [(*sun, strength), *beside, (0.0, 90.0, max(above, 0.0))]


def _choose_lighting(ambient: float = _AMBIENT) -> dict[str, float]:
    diffuse = (1.0 - ambient) / (1.0 - _AMBIENT)
    return {"ambient": ambient, "diffuse": diffuse, "specular": 0.0}


def _choose_tints(
    pv: Any, surface: Any, tin: TIN, tint: Tint, ends: tuple[float, float]
) -> dict[str, Any]:
    """Return what a plotter needs to colour a surface, and give it what the colours tell."""
    legend = make_legend(tint, ends, "")
    if legend is None:
        return {"color": palette.PLAIN}
    low, high = legend.ends if legend.ends[0] < legend.ends[1] else (ends[0] - 0.5, ends[0] + 0.5)
    if tint == "slope":
        surface.cell_data[tint] = measure_slopes(compute_normals(tin), "degrees")
    elif tint == "aspect":
        surface.cell_data[tint] = measure_aspects(compute_normals(tin))
    colors = np.column_stack([palette.choose_ramp(tint, 256), np.full(256, 255, np.uint8)])
    table = pv.LookupTable(values=colors, scalar_range=(low, high), nan_color=palette.PLAIN)
    return {"scalars": tint, "cmap": table}


def _average_normals(points: Float64Array, triangles: Int32Array) -> Float32Array:
    """Average the unit normals of the triangles at each vertex, weighted by area in the plane.

    So the steep slivers along a hull, which have hardly any area in the plane, do not darken
    their neighbours.
    """
    first, second, third = (points[triangles[:, k]] for k in range(3))
    faces = np.cross(second - first, third - first)
    faces *= (faces[:, 2] / np.linalg.norm(faces, axis=1))[:, np.newaxis]
    corners = triangles.ravel()
    sums = [np.bincount(corners, np.repeat(part, 3), len(points)) for part in faces.T]
    normals = np.column_stack(sums)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return (normals / np.where(lengths > 0, lengths, 1.0)).astype(np.float32)


def _make_block(pv: Any, tin: TIN, points: Float64Array, lowest: float) -> Any:
    """Return the walls from the boundary down to a level base."""
    start, stop = edges_at(tin.triangles, tin.neighbors < 0).T
    extent = float(np.ptp(points[:, :2], axis=0).max())
    base = lowest - BLOCK_SHARE * extent
    upper = np.concatenate([points[start], points[stop]])
    lower = upper * (1.0, 1.0, 0.0) + (0.0, 0.0, base)
    count = np.arange(len(start))
    walls = np.column_stack([count, 2 * len(start) + count, 3 * len(start) + count])
    walls = np.column_stack([walls, len(start) + count])
    return pv.PolyData.from_regular_faces(np.concatenate([upper, lower]), walls)
