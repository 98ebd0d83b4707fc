"""Objects of a scene: a mesh with colors by elevation, and lines as curves."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

if TYPE_CHECKING:
    from .ply import Content, Line
    from .reference import Placement

COLORS = "Elevation"
"""Name of the color attribute, and of the material that shows it."""

_TINTS = ((47, 111, 94), (143, 181, 115), (230, 215, 154), (185, 138, 86), (244, 241, 236))
"""From low to high, sRGB."""

_KINDS = {
    "hard": (0.75, 0.08, 0.08, 1.0),
    "soft": (0.86, 0.30, 0.05, 1.0),
    "boundary": (0.03, 0.03, 0.03, 1.0),
    "hole": (0.2, 0.2, 0.2, 1.0),
    "water": (0.03, 0.16, 0.43, 1.0),
}
_OTHER = (0.26, 0.10, 0.03, 1.0)
_MOST_OBJECTS = 300
"""Lines beyond this number become an object for each kind."""


def add_content(
    context: Any, content: Content, placement: Placement, name: str, line_width: float
) -> Any:
    """Add what a file holds as objects of a new collection; return this.

    Parameters
    ----------
    context : bpy.types.Context
    content : Content
    placement : Placement
    name : str
        Of the file; objects are named after it.
    line_width : float
        Width of lines, metres; 0 for lines without one, which are not rendered.
    """
    collection = bpy.data.collections.new(name)
    context.scene.collection.children.link(collection)
    told = {**placement.to_properties(), "tinsmith_file": name}
    if content.points is not None:
        mesh = make_mesh(name, placement.place(content.points), content.triangles)
        color_by_elevation(mesh, content.points[:, 2])
        _add_object(collection, name, mesh, told)
    for (kind, title), lines in _group(content.lines).items():
        curve = make_curve(title or kind, lines, placement, line_width / 2)
        curve.materials.append(_find_line_material(kind))
        _add_object(collection, title or kind, curve, {**told, "tinsmith_kind": kind})
    return collection


def _add_object(collection: Any, name: str, data: Any, told: dict[str, Any]) -> None:
    made = bpy.data.objects.new(name, data)
    for key, value in told.items():
        made[key] = value
    collection.objects.link(made)


def _group(lines: list[Line]) -> dict[tuple[str, str], list[Line]]:
    """Return lines by kind and name, or by kind alone if these are too many."""
    groups: dict[tuple[str, str], list[Line]] = defaultdict(list)
    for line in lines:
        groups[line.kind, line.name].append(line)
    if len(groups) <= _MOST_OBJECTS:
        return groups
    kinds: dict[tuple[str, str], list[Line]] = defaultdict(list)
    for line in lines:
        kinds[line.kind, ""].append(line)
    return kinds


def make_mesh(name: str, places: Any, triangles: Any) -> Any:
    """Return a mesh; its vertices and triangles have the order of the file."""
    mesh = bpy.data.meshes.new(name)
    count = len(triangles)
    mesh.vertices.add(len(places))
    mesh.vertices.foreach_set("co", places.astype(np.float32).ravel())
    if count:
        mesh.loops.add(3 * count)
        mesh.loops.foreach_set("vertex_index", triangles.ravel())
        mesh.polygons.add(count)
        mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * count, 3, dtype=np.int32))
        if bpy.app.version < (4, 0, 0):
            mesh.polygons.foreach_set("loop_total", np.full(count, 3, np.int32))
    mesh.update(calc_edges=True)
    return mesh


def color_by_elevation(mesh: Any, elevations: Any) -> None:
    """Give a mesh a color at each vertex, from low to high, and a material that shows it."""
    low, high = float(elevations.min()), float(elevations.max())
    share = (elevations - low) / (high - low) if high > low else np.full(len(elevations), 0.5)
    tints = _to_linear(np.array(_TINTS) / 255)
    at = np.linspace(0, 1, len(tints))
    colors = np.ones((len(elevations), 4), np.float32)
    for channel in range(3):
        colors[:, channel] = np.interp(share, at, tints[:, channel])
    attribute = mesh.color_attributes.new(COLORS, "FLOAT_COLOR", "POINT")
    attribute.data.foreach_set("color", colors.ravel())
    mesh.materials.append(_find_surface_material())


def _to_linear(srgb: Any) -> Any:
    """Return linear colors of sRGB (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def _find_surface_material() -> Any:
    found = bpy.data.materials.get(COLORS)
    if found is not None:
        return found
    material = bpy.data.materials.new(COLORS)
    material.use_nodes = True
    nodes = material.node_tree.nodes
    surface = next(one for one in nodes if one.type == "BSDF_PRINCIPLED")
    surface.inputs["Roughness"].default_value = 0.9
    color = nodes.new("ShaderNodeVertexColor")
    color.layer_name = COLORS
    material.node_tree.links.new(color.outputs["Color"], surface.inputs["Base Color"])
    return material


def _find_line_material(kind: str) -> Any:
    name = f"Lines: {kind}"
    found = bpy.data.materials.get(name)
    if found is not None:
        return found
    color = _KINDS.get(kind, _OTHER)
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.diffuse_color = color
    surface = next(one for one in material.node_tree.nodes if one.type == "BSDF_PRINCIPLED")
    surface.inputs["Base Color"].default_value = color
    return material


def make_curve(name: str, lines: list[Line], placement: Placement, radius: float) -> Any:
    """Return a curve of straight pieces, a spline for each line."""
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions = "3D"
    curve.bevel_depth = radius * placement.scale
    curve.bevel_resolution = 0
    for line in lines:
        places = placement.place(line.points)
        is_closed = len(places) > 3 and bool((places[0] == places[-1]).all())
        places = places[:-1] if is_closed else places
        spline = curve.splines.new("POLY")
        spline.points.add(len(places) - 1)
        rows = np.ones((len(places), 4), np.float32)
        rows[:, :3] = places
        spline.points.foreach_set("co", rows.ravel())
        spline.use_cyclic_u = is_closed
    return curve
