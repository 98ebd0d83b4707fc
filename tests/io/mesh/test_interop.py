"""Meshes of PyVista, trimesh and meshio: there and back bit for bit, and theirs as TINs."""

from __future__ import annotations

import copy

import meshio
import numpy as np
import pytest
import pyvista
import trimesh
from support.surfaces import hills

import tinsmith as ts

MAKERS = (ts.to_pyvista, ts.to_trimesh, ts.to_meshio)
ROOF = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 3], [0, 4, 3]], float)


def arrays_of(tin):
    return tin.points.tobytes(), tin.triangles.tobytes(), tin.crs, tin.elevation_unit


@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize("seed", range(4))
def test_there_and_back_bit_for_bit(make, seed):
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.integers(-6, 7, 3)
    points = rng.random((50, 3)) * size + rng.choice([0, 1 / 3, 5e5, -4.2e6], 3)
    tin = ts.triangulate(
        points, crs=[None, "EPSG:2274"][seed % 2], elevation_unit=["m", "ft"][seed % 2]
    )
    back = ts.from_mesh(make(tin))
    assert arrays_of(back) == arrays_of(tin)
    assert list(back.report.notes) == []
    assert ts.check(back).ok


@pytest.mark.parametrize("make", MAKERS)
def test_large_coordinates_are_near_zero_for_the_graphics_card(make):
    tin = hills(crs="EPSG:32616")
    mesh = make(tin)
    points = mesh.vertices if make is ts.to_trimesh else mesh.points
    if make is ts.to_meshio:
        np.testing.assert_array_equal(points, tin.points)
        return
    origin = mesh.metadata["origin"] if make is ts.to_trimesh else mesh.field_data["origin"]
    np.testing.assert_array_equal(np.asarray(points) + origin, tin.points)
    assert np.abs(points).max() < 10 * max(np.ptp(tin.points, axis=0))


def test_constrained_edges_and_attributes_go_along():
    survey = ts.Survey(points=ROOF, attributes={"number": [4, 5, 6, 7], "code": list("abcd")})
    tin = ts.triangulate(survey, breaklines=[ROOF[[0, 2]]], crs="EPSG:32616")
    for make in (ts.to_pyvista, ts.to_meshio):
        back = ts.from_mesh(make(tin))
        np.testing.assert_array_equal(back.constrained, tin.constrained)
        assert back.attributes["number"].tolist() == [4, 5, 6, 7]
    assert ts.to_pyvista(tin)["elevation"].tolist() == ROOF[:, 2].tolist()


def test_a_lifted_tin_comes_back_without_its_exaggeration():
    tin = ts.triangulate(np.add(ROOF, [5e5, 4e6, 100]), crs="EPSG:2274", elevation_unit="m")
    back = ts.from_mesh(ts.lift(tin, exaggeration=2))
    np.testing.assert_allclose(back.points, tin.points, rtol=1e-12)
    assert (back.crs, back.elevation_unit) == (tin.crs, tin.elevation_unit)


def test_files_of_the_libraries_keep_the_surface(tmp_path):
    tin = hills(crs="EPSG:32616")
    ts.to_pyvista(tin).save(tmp_path / "a.vtp")
    assert ts.read(tmp_path / "a.vtp").points.tobytes() == tin.points.tobytes()
    assert ts.from_mesh(pyvista.read(tmp_path / "a.vtp")).crs == tin.crs
    ts.to_meshio(tin).write(tmp_path / "a.vtu")
    back = ts.from_mesh(
        meshio.read(tmp_path / "a.vtu"), crs=tin.crs, elevation_unit=tin.elevation_unit
    )
    assert arrays_of(back) == arrays_of(tin)


def test_triangles_of_others_are_kept():
    """The other diagonal of a quadrilateral, which is not Delaunay, and one turned round."""
    kite = np.array([[0, 0, 1], [4, -1, 2], [8, 0, 3], [4, 1, 4]], float)
    faces = np.array([[0, 1, 2], [0, 3, 2]])
    meshes = [
        pyvista.PolyData.from_regular_faces(kite, faces),
        pyvista.PolyData.from_regular_faces(kite, faces).cast_to_unstructured_grid(),
        trimesh.Trimesh(kite, faces, process=False),
        meshio.Mesh(kite, [("triangle", faces), ("line", [[0, 2]]), ("vertex", [[1]])]),
    ]
    for mesh in meshes:
        tin = ts.from_mesh(mesh, crs="EPSG:32616")
        assert tin.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert tin.is_edge(0, 2)
        assert tin.crs == "EPSG:32616"


def test_quadrilaterals_are_cut_and_told():
    meshes = [
        pyvista.PolyData.from_regular_faces(ROOF, [[0, 1, 2, 3]]),
        meshio.Mesh(ROOF, [("quad", [[0, 1, 2, 3]])]),
    ]
    for mesh in meshes:
        tin = ts.from_mesh(mesh)
        assert len(tin) == 2
        assert "cut into triangles" in tin.report.notes[0]


def test_single_precision_is_told():
    mesh = pyvista.Plane(center=(500_000, 4_000_000, 10), i_size=100, j_size=100).triangulate()
    assert mesh.points.dtype == np.float32
    assert "numbers of 32 bits" in ts.from_mesh(mesh).report.notes[0]


def test_another_crs_than_that_of_the_mesh_is_refused():
    for make in MAKERS:
        mesh = make(hills(crs="EPSG:32616", unit="m"))
        assert ts.from_mesh(mesh, crs="EPSG:32616").crs == "EPSG:32616"
        with pytest.raises(ts.CrsError, match="EPSG:32617 is another CRS"):
            ts.from_mesh(mesh, crs="EPSG:32617")
        with pytest.raises(ts.OptionError, match="unit of elevations 'foot'"):
            ts.from_mesh(mesh, elevation_unit="ft")


def overlapping():
    points = np.array([[0, 0, 1], [4, 0, 1], [0, 4, 1], [1, 1, 5], [5, 1, 5], [1, 5, 5]], float)
    return pyvista.PolyData.from_regular_faces(points, [[0, 1, 2], [3, 4, 5]])


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (pyvista.Sphere(), "no area|overlap|edge"),
        (pyvista.Cube().triangulate(), "no area in the plane"),
        (trimesh.creation.icosphere(1), "no area|overlap|edge"),
        (overlapping(), "'PolyData' holds no TIN. Triangles overlap"),
        (pyvista.ImageData(dimensions=(2, 2, 2)), "neither a PolyData nor an UnstructuredGrid"),
        (pyvista.ImageData(dimensions=(2, 2, 2)).cast_to_unstructured_grid(), "is no face"),
        (pyvista.PolyData(ROOF), "shape"),
        (meshio.Mesh(ROOF, [("tetra", [[0, 1, 2, 3]])]), "cells of type tetra"),
        (meshio.Mesh(ROOF, [("line", [[0, 1]])]), "holds no faces"),
        (meshio.Mesh(ROOF[:, :2], [("triangle", [[0, 1, 2]])]), r"shape \(4, 2\)"),
        (meshio.Mesh(ROOF, [("triangle", [[0, 1, 9]])]), "names vertex 9"),
        (5, "Invalid mesh of type int"),
        (np.eye(3), "Invalid mesh of type ndarray"),
    ],
)
def test_what_is_no_tin_is_refused(mesh, words):
    with pytest.raises(ts.PointsError, match=words) as caught:
        ts.from_mesh(mesh)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("make", MAKERS)
def test_a_mesh_shares_nothing_with_the_tin(make):
    tin = hills()
    before = copy.copy(tin)
    mesh = make(tin)
    points = mesh.vertices if make is ts.to_trimesh else mesh.points
    points[:] = 0
    if make is not ts.to_pyvista:  # whose faces are read-only
        faces = mesh.faces if make is ts.to_trimesh else mesh.cells[0].data
        faces[:] = 0
    assert tin == before
    with pytest.raises(ts.PointsError, match="Invalid TIN"):
        make(5)
