"""Gmsh files: what a plain reader of the format finds in them, and what ours makes of others."""

import sys

import meshio
import numpy as np
import pytest

import tinsmith as ts


@pytest.fixture
def tin():
    rng = np.random.default_rng(3)
    points = rng.random((60, 3)) * [100, 100, 5] + [500_000.1, 4_000_000.2, 300]
    wall = points[[3, 9, 20]] + [0.5, 0.5, 0]
    lines = [ts.Breakline(wall, name='the "wall"'), ts.Breakline(points[[5, 40]])]
    return ts.triangulate(points, breaklines=lines, crs="EPSG:32616")


def sections(path):
    """Read the format as its manual tells: lines between $Name and $EndName."""
    found, name = {}, None
    for line in path.read_text().splitlines():
        if line.startswith("$End"):
            name = None
        elif line.startswith("$"):
            name = line[1:]
            found[name] = []
        else:
            found[name].append(line)
    return found


def test_nodes_elements_and_groups(tin, tmp_path):
    path = ts.write(tin, tmp_path / "site.msh")
    read = sections(path)
    assert read["MeshFormat"] == ["2.2 0 8"]
    assert int(read["Nodes"][0]) == len(tin.points)
    nodes = np.array([line.split()[1:] for line in read["Nodes"][1:]], float)
    np.testing.assert_array_equal(nodes, tin.points)
    names = {
        int(line.split()[1]): line.split(maxsplit=2)[2].strip('"')
        for line in read["PhysicalNames"][1:]
    }
    lines, triangles = {}, []
    for line in read["Elements"][1:]:
        _, kind, n_tags, group, *rest = map(int, line.split())
        corners = [node - 1 for node in rest[n_tags - 1 :]]
        if kind == 1:
            lines.setdefault(names[group], set()).add(frozenset(corners))
        else:
            assert (kind, names[group]) == (2, "surface")
            triangles.append(corners)
    np.testing.assert_array_equal(triangles, tin.triangles)
    hull = tin.hull.tolist()
    assert lines.pop("boundary") == {
        frozenset(e) for e in zip(hull, hull[1:] + hull[:1], strict=True)
    }
    chains = {
        name: {frozenset(step.tolist()) for step in np.stack([chain[:-1], chain[1:]], axis=1)}
        for name, chain in zip(["the _wall_", "hard 1"], tin.lines.chains(), strict=True)
    }
    assert lines == chains


def test_what_is_written_is_read_again(tin, tmp_path):
    path = ts.write(tin, tmp_path / "site.msh")
    read = ts.read(path, crs="EPSG:32616")
    np.testing.assert_array_equal(read.points, tin.points)
    np.testing.assert_array_equal(read.triangles, tin.triangles)
    inside = tin.neighbors >= 0
    np.testing.assert_array_equal(read.constrained[inside], tin.constrained[inside])
    assert read.constrained[~inside].all()
    assert read.crs == "EPSG:32616"


def test_the_same_tin_gives_the_same_bytes(tin, tmp_path):
    one, other = ts.write(tin, tmp_path / "a.msh"), ts.write(tin, tmp_path / "b.msh")
    assert one.read_bytes() == other.read_bytes()


def test_content_tells_the_format(tin, tmp_path):
    path = ts.write(tin, tmp_path / "site.msh")
    renamed = path.rename(tmp_path / "site.dat")
    assert len(ts.read(renamed).triangles) == len(tin.triangles)


@pytest.mark.parametrize("binary", [False, True])
def test_newer_versions_of_the_format_are_read(tin, tmp_path, binary):
    path = tmp_path / "new.msh"
    meshio.gmsh.write(
        path,
        meshio.Mesh(tin.points, [("triangle", tin.triangles)]),
        fmt_version="4.1",
        binary=binary,
    )
    np.testing.assert_array_equal(ts.read(path).triangles, tin.triangles)


def test_points_alone_are_a_survey(tin, tmp_path):
    path = tmp_path / "points.msh"
    meshio.gmsh.write(path, meshio.Mesh(tin.points, []), fmt_version="2.2", binary=False)
    np.testing.assert_array_equal(ts.read(path).points, tin.points)


@pytest.mark.parametrize("keep", [0.0, 0.3, 0.6, 0.95])
def test_a_file_cut_short_is_a_sentence(tin, tmp_path, keep, capfd):
    path = ts.write(tin, tmp_path / "site.msh")
    content = path.read_bytes()
    path.write_bytes(content[: max(30, int(keep * len(content)))])
    with pytest.raises(ts.ReadError, match=r"site\.msh"):
        ts.read(path)
    assert capfd.readouterr() == ("", "")


def test_a_survey_and_other_things_are_refused(tin, tmp_path):
    with pytest.raises(ts.FormatError, match="not a Survey; triangulate it first"):
        ts.write(ts.Survey(points=tin.points), tmp_path / "a.msh")
    assert not (tmp_path / "a.msh").exists()


def test_without_meshio_the_extra_is_named(tin, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(ts.MissingExtraError, match=r"tinsmith\[mesh\]"):
        ts.write(tin, tmp_path / "a.msh")
    assert list(tmp_path.iterdir()) == []


SHAPES = {
    "triangle": [[0, 0], [4, 0], [0, 4]],
    "triangle6": [[0, 0], [4, 0], [0, 4], [2, 0], [2, 2], [0, 2]],
    "quad": [[0, 0], [4, 0], [4, 4], [0, 4]],
    "quad8": [[0, 0], [4, 0], [4, 4], [0, 4], [2, 0], [4, 2], [2, 4], [0, 2]],
    "quad9": [[0, 0], [4, 0], [4, 4], [0, 4], [2, 0], [4, 2], [2, 4], [0, 2], [2, 2]],
}
"""Nodes in the order of the manual: corners, those amid the edges from corner 0 on, the centre."""


def write_cells(path, blocks, points):
    tags = {f"gmsh:{what}": [np.ones(len(cells), int) for _, cells in blocks]
            for what in ("physical", "geometrical")}  # fmt: skip
    mesh = meshio.Mesh(np.asarray(points, float), blocks, cell_data=tags)
    mesh.write(path, file_format="gmsh22", binary=False)
    return path


@pytest.mark.parametrize("kind", SHAPES)
def test_faces_of_every_kind_become_triangles(tmp_path, kind):
    xy = np.array(SHAPES[kind], float)
    points = np.column_stack([xy, xy @ [0.5, 0.25]])
    tin = ts.read(write_cells(tmp_path / "a.msh", [(kind, [list(range(len(xy)))])], points))
    assert tin.area == (8 if "triangle" in kind else 16)
    assert np.array_equal(np.unique(tin.triangles), np.arange(len(xy)))  # nodes amid edges count
    assert ts.check(tin, level=1).ok
    assert not any("overlap" in note for note in tin.notes)
    assert any("cut into triangles" in note for note in tin.notes) == ("quad" in kind)


def test_faces_of_several_kinds_are_one_surface(tmp_path):
    points = [[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1], [8, 0, 2]]
    blocks = [("quad", [[0, 1, 2, 3]]), ("line", [[1, 2]]), ("triangle", [[1, 4, 2]])]
    tin = ts.read(write_cells(tmp_path / "a.msh", blocks, points))
    assert (len(tin.triangles), tin.area) == (3, 24)
    assert tin.is_edge([1], [2]).all()
    assert tin.constrained.sum() == 2


def test_cells_that_are_no_faces_are_told_or_refused(tmp_path):
    points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4], [9, 0, 0]]
    solid = ("tetra", [[0, 1, 2, 3]])
    with pytest.raises(ts.ReadError, match=r"no faces, but other cells \(1 of the kind tetra\)"):
        ts.read(write_cells(tmp_path / "a.msh", [solid], points))
    path = write_cells(tmp_path / "b.msh", [("triangle", [[1, 4, 2]]), solid], points)
    assert "Not read: other cells (1 of the kind tetra)." in ts.read(path).notes
    curved = ("triangle10", [[*range(5), *range(5)]])
    with pytest.raises(ts.ReadError, match="1 of the kind triangle10"):
        ts.read(write_cells(tmp_path / "c.msh", [curved], points))
