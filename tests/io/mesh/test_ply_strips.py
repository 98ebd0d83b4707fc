"""Strips of triangles in PLY, as a plain reading of each gives them."""

from __future__ import annotations

import numpy as np
import pytest

import tinsmith as ts

POINTS = [[x, y, x + 2 * y] for x in range(4) for y in range(4)]


def write_strips(path, strips, element="tristrips", name="vertex_indices", faces=()):
    head = f"ply\nformat ascii 1.0\nelement vertex {len(POINTS)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    rows = "".join(" ".join(map(str, one)) + "\n" for one in POINTS)
    for kind, found, called in (("face", faces, "vertex_indices"), (element, strips, name)):
        if found:
            head += f"element {kind} {len(found)}\nproperty list int int {called}\n"
            rows += "".join(f"{len(one)} {' '.join(map(str, one))}\n" for one in found)
    path.write_text(head + "end_header\n" + rows)
    return path


def unfold(strip):
    """Return the triangles of a strip: each further vertex makes one with the two before."""
    triangles, before = [], []
    for vertex in strip:
        before = [] if vertex == -1 else [*before, vertex]
        if len(before) >= 3 and len(set(before[-3:])) == 3:
            triangles.append(before[-3:])
    return triangles


BAND = [0, 4, 1, 5, 2, 6, 3, 7]
OTHER = [4, 8, 5, 9, 6, 10, 7, 11]
CASES = {
    "one": [BAND],
    "two rows": [BAND, OTHER],
    "with a restart": [[*BAND, -1, *OTHER]],
    "joined by repeated vertices": [[*BAND, 7, 4, *OTHER]],
    "restarts at both ends": [[-1, *BAND, -1]],
    "an odd place of a restart": [[0, 4, 1, -1, *OTHER]],
    "an empty row": [[], BAND],
}


@pytest.mark.parametrize("element", ["tristrips", "tristrip"])
@pytest.mark.parametrize("case", CASES)
def test_strips_are_triangles(tmp_path, case, element):
    tin = ts.read(write_strips(tmp_path / "a.ply", CASES[case], element))
    expected = [sorted(one) for strip in CASES[case] for one in unfold(strip)]
    assert [sorted(one) for one in tin.triangles.tolist()] == expected
    assert list(tin.notes) == [note for note in tin.notes if "no triangle" in note]


def test_the_directions_of_strips_turn_in_turn(tmp_path):
    from tinsmith.io.mesh.ply.body import Ragged
    from tinsmith.io.mesh.ply.file import _cut_strips

    found = _cut_strips(Ragged(np.array(BAND), np.array([0, len(BAND)])))
    corners = np.array(POINTS)[found.items.reshape(-1, 3)][..., :2]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert len(set(np.sign(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).tolist())) == 1


def test_strips_stand_behind_faces(tmp_path):
    tin = ts.read(write_strips(tmp_path / "a.ply", [OTHER], faces=[[0, 4, 1], [1, 4, 5]]))
    assert len(tin.triangles) == 2 + 6


def test_faces_under_another_name_are_refused(tmp_path):
    path = write_strips(tmp_path / "a.ply", [[0, 4, 1]], "face", "corners")
    with pytest.raises(ts.ReadError, match=r"properties 'corners', .* list vertex_indices"):
        ts.read(path)


def test_elements_that_are_not_read_are_told(tmp_path):
    survey = ts.read(write_strips(tmp_path / "a.ply", [[0, 4, 1], [1, 2]], "patches"))
    assert "Not read: 2 rows of 'patches'." in survey.notes
