"""The scene as it is handed to the plotter: exaggeration, edges, normals, block, tints, lines."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from tinsmith import TIN, Breakline, Water, triangulate
from tinsmith.base.georeference.scales import find_ground
from tinsmith.terrain.drawing.linework import add_lines
from tinsmith.terrain.drawing.palette import interpolate_tints
from tinsmith.terrain.viewer.actors import (
    _average_normals,
    add_terrain,
    fade_edges,
    place_vertices,
)
from tinsmith.terrain.viewer.relief import choose_exaggeration, measure_relief

pv = pytest.importorskip("pyvista")


class Plotter:
    """Draws nothing and keeps what it was asked for."""

    def __init__(self):
        self.meshes, self.options, self.actors = [], [], []

    def add_mesh(self, mesh, **options):
        self.meshes.append(mesh)
        self.options.append(options)
        mapper = pv.DataSetMapper(mesh)
        self.actors.append(pv.Actor(mapper))
        return self.actors[-1]


def terrain(width, height, *, relief=8.0, count=30, crs=None):
    points = np.random.default_rng(4).random((count, 3)) * (width, height, relief)
    corners = [[x, y, relief / 2] for x in (0, width) for y in (0, height)]
    return triangulate(np.concatenate([points, corners]), crs=crs)


# ------------------------------------------------------------------ exaggeration


@pytest.mark.parametrize("shape", [(1000.0, 10.0), (10.0, 1000.0)])
def test_the_exaggeration_goes_by_the_longer_side(shape):
    tin = triangulate([[0, 0, 0], [shape[0], 0, 1], [0, shape[1], 20], [*shape, 1]])
    ground = find_ground(tin)
    assert choose_exaggeration(tin, ground, measure_relief(tin, ground)) == 5.0


@pytest.mark.parametrize(("relief", "factor"), [(1e-6, 100.0), (0.5, 20.0), (10.0, 1.0)])
def test_the_exaggeration_ends_at_a_hundred(relief, factor):
    tin = triangulate([[0, 0, 0], [100, 0, relief], [0, 100, 0]])
    ground = find_ground(tin)
    assert choose_exaggeration(tin, ground, measure_relief(tin, ground)) == factor


# ------------------------------------------------------------------------- edges


@pytest.mark.parametrize("side", [0.5, 2.0, 8.0, 12.0, 15.9, 16.0, 17.0, 400.0])
def test_edges_fade_with_the_side_of_the_triangles(side):
    """Half the squares of a grid: a side of 16 pixels and more is drawn at full strength."""
    axis = np.arange(5.0)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    tin = triangulate(np.column_stack([x, y, np.zeros(25)]))
    actor = SimpleNamespace(prop=SimpleNamespace(edge_opacity=None))
    fade_edges(actor, tin, find_ground(tin), side)
    assert actor.prop.edge_opacity == pytest.approx(max(0.42 * min(side / 16, 1.0), 0.04))


def test_edges_fade_by_the_length_on_the_ground():
    """In degrees at 60 north an area is half of what it is at the equator."""
    strengths = []
    for latitude in (0.0, 60.0):
        corners = [[x, latitude + y, 0] for x in (0, 0.001) for y in (-0.0005, 0.0005)]
        tin = triangulate(corners, crs="EPSG:4326")
        actor = SimpleNamespace(prop=SimpleNamespace(edge_opacity=None))
        fade_edges(actor, tin, find_ground(tin), 0.1)
        strengths.append(actor.prop.edge_opacity)
    assert strengths[1] == pytest.approx(strengths[0] * math.sqrt(0.5), rel=0.01)
    assert 0.04 < strengths[1] < strengths[0] < 0.42


# ------------------------------------------------------------------------ surface


@pytest.mark.parametrize("edges", [True, False])
def test_surface_and_block_are_handed_over_with_their_colours(edges):
    tin, plotter = terrain(60.0, 40.0), Plotter()
    points = place_vertices(tin, find_ground(tin), 2.0)
    actor, seen = add_terrain(plotter, tin, points, edges=edges)
    surface, block = plotter.meshes
    np.testing.assert_array_equal(surface.regular_faces, tin.triangles)
    np.testing.assert_allclose(surface.points, points, rtol=1e-6)
    np.testing.assert_array_equal(surface.point_data["elevation"], tin.points[:, 2])
    above, below = plotter.options
    table = above["cmap"]
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    assert table.scalar_range == pytest.approx((low, high))
    np.testing.assert_array_equal(table.values[:, :3], interpolate_tints())
    assert (table.values[:, 3] == 255).all()
    assert above["scalars"] == "elevation"
    assert above["show_scalar_bar"] is False
    assert (above["ambient"], above["diffuse"], above["specular"]) == (0.36, 1.0, 0.0)
    assert below["color"] == "#cecbc5"
    assert below["culling"] == "back"
    assert below["ambient"] == 0.72
    assert below["diffuse"] == pytest.approx(0.28 / 0.64)  # lit as strongly in all
    assert actor is plotter.actors[0]
    assert actor.prop.show_edges == edges
    assert actor.prop.interpolation.name == "PHONG"
    if edges:
        assert actor.prop.edge_color.int_rgb == (40, 46, 50)
    assert len(seen) == surface.n_points + block.n_points
    np.testing.assert_allclose(seen[: len(points)], points)
    np.testing.assert_allclose(seen[len(points) :], block.points)


@pytest.mark.parametrize("shape", [(60.0, 40.0), (40.0, 60.0)])
def test_the_block_closes_the_terrain_down_to_a_level_base(shape):
    """Walls that face outwards, whose area is that below the rim."""
    tin, plotter = terrain(*shape), Plotter()
    points = place_vertices(tin, find_ground(tin), 3.0)
    add_terrain(plotter, tin, points, edges=False)
    block = plotter.meshes[1]
    base = points[:, 2].min() - 0.025 * 60.0
    count = block.n_points // 2
    np.testing.assert_allclose(block.points[count:, 2], base, rtol=1e-6)
    np.testing.assert_array_equal(block.points[:count, :2], block.points[count:, :2])
    ring = points[tin.rings[0]]
    following = np.roll(ring, -1, axis=0)
    widths = np.hypot(*(following - ring)[:, :2].T)
    heights = (following + ring)[:, 2] / 2 - base
    assert block.area == pytest.approx((widths * heights).sum(), rel=1e-6)
    walls = block.compute_normals(cell_normals=True, point_normals=False, consistent_normals=False)
    normals = walls.cell_data["Normals"]
    np.testing.assert_allclose(normals[:, 2], 0.0, atol=1e-6)
    outward = walls.cell_centers().points[:, :2] - points[:, :2].mean(axis=0)
    assert ((outward * normals[:, :2]).sum(axis=1) > 0).all()


def test_level_ground_has_the_middle_tint():
    tin, plotter = triangulate([[0, 0, 5], [9, 0, 5], [0, 9, 5]]), Plotter()
    add_terrain(plotter, tin, place_vertices(tin, find_ground(tin), 1.0), edges=False)
    assert plotter.options[0]["cmap"].scalar_range == (4.5, 5.5)


def test_normals_are_means_of_the_triangles_weighted_by_their_area_in_the_plane():
    tin = terrain(10.0, 7.0, relief=9.0)
    sums = np.zeros((len(tin.points), 3))
    for triangle in tin.triangles:
        a, b, c = tin.points[triangle]
        normal = np.cross(b - a, c - a)
        area = normal[2] / 2
        sums[triangle] += area * normal / np.linalg.norm(normal)
    expected = sums / np.linalg.norm(sums, axis=1, keepdims=True)
    found = _average_normals(tin.points, tin.triangles)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, expected, atol=1e-6)


def test_a_vertex_without_triangles_has_no_normal():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], float)
    found = _average_normals(points, np.array([[0, 1, 2]], np.int32))
    assert found.tolist() == [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 0]]


# -------------------------------------------------------------------------- lines


@pytest.mark.parametrize("factor", [1.0, 2.0])
def test_each_kind_of_line_is_drawn_with_its_pen(factor):
    axis = np.linspace(0.0, 100.0, 11)
    x, y = (part.ravel() for part in np.meshgrid(axis, axis))
    tin = triangulate(
        np.column_stack([x, y, np.full(len(x), 10.0)]),
        breaklines=[
            Breakline([[10, 80, 10], [90, 80, 10]]),
            Breakline([[10, 90, 10], [90, 90, 10]], kind="soft"),
        ],
        water=[Water([[20, 20], [40, 20], [40, 40], [20, 40]], 10.0)],
        holes=[[[60, 20], [80, 20], [80, 40], [60, 40]]],
        boundary=[[[0, 0], [100, 0], [100, 100], [0, 100]]],
    )
    plotter = Plotter()
    actors = add_lines(plotter, tin, place_vertices(tin, find_ground(tin), 1.0), factor=factor)
    assert len(actors) == 5
    pens = [(one["color"], one["line_width"] / factor) for one in plotter.options]
    assert [width for _, width in pens] == pytest.approx([1.8, 1.7, 2.0, 2.4, 2.6])
    soft, hard, hole, boundary, water = (color for color, _ in pens)
    assert hole == boundary == "#963a22"
    assert (soft, hard, water) == ("#404448", "#222226", "#185c98")
    assert not any(one["lighting"] or one["pickable"] for one in plotter.options)
    lengths = [length_of(mesh) for mesh in plotter.meshes]
    assert lengths[1:] == pytest.approx([80.0, 80.0, 400.0, 80.0], rel=1e-6)
    dashes = plotter.meshes[0].points.reshape(-1, 2, 3)
    spans = np.linalg.norm(dashes[:, 1] - dashes[:, 0], axis=1)
    assert lengths[0] == pytest.approx(40.0, abs=0.6)
    assert spans.max() == pytest.approx(0.6, rel=1e-5)
    for actor in actors:
        assert actor.mapper.GetResolveCoincidentTopology() == 1


def length_of(mesh):
    ends = mesh.points[mesh.lines.reshape(-1, 3)[:, 1:]]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum()


def test_lines_of_a_tin_without_any_are_none():
    plotter = Plotter()
    tin = TIN.from_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert add_lines(plotter, tin, tin.points) == []
    assert plotter.meshes == []
