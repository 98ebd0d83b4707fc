"""``tinsmith check`` of surfaces of other programs: sound or not, Delaunay or not."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner
from support.face_files import FACE_WRITERS, write_faces

import tinsmith as ts
from tinsmith.cli import main

FLAT = [[0, 0, 1], [400, 0, 2], [500, 300, 3], [0, 400, 4], [40, 50, 9]]
SURFACES = {
    "an edge the wrong way": (FLAT[:4], [[0, 1, 2], [0, 2, 3]], "not Delaunay"),
    "a concave boundary": (FLAT, [[0, 1, 4], [1, 2, 4], [2, 3, 4]], "not Delaunay"),
    "two pieces": ([*FLAT[:3], [900, 0, 1], [999, 0, 1], [900, 99, 2]],
                   [[0, 1, 2], [3, 4, 5]], "not Delaunay"),
}  # fmt: skip


def run(*arguments, code):
    done = CliRunner().invoke(main, ["check", *map(str, arguments)])
    assert done.exit_code == code, done.output
    return done.output


@pytest.mark.each_value
@pytest.mark.parametrize("kind", [*FACE_WRITERS])
@pytest.mark.parametrize("name", SURFACES)
def test_a_sound_surface_is_told_from_a_delaunay_one(tmp_path, kind, name):
    points, faces, lacking = SURFACES[name]
    path, how = write_faces(kind, points, faces, tmp_path)
    flags = [part for key, value in how.items() for part in (f"--{key.replace('_', '-')}", value)]
    said = run(path, *flags, code=1)
    assert f"a sound surface, {lacking}" in said
    assert "not sound" not in said
    assert "Problem" not in said
    found = json.loads(run(path, *flags, "--json", code=1).partition("\nError")[0])
    assert (found["ok"], found["is_surface"]) == (False, True)


def test_a_surface_over_itself_is_not_sound(tmp_path):
    points = [*FLAT[:3], [20, 10, 1], [420, 10, 2], [420, 310, 3]]
    path, _ = write_faces("obj", points, [[0, 1, 2], [3, 4, 5]], tmp_path)
    assert "not sound: " in run(path, code=1)
    assert not ts.check(ts.read(path)).is_surface


def test_a_boundary_that_winds_twice_is_not_sound():
    import math

    angles = [k * math.pi / 2 + 0.1 * (k >= 4) for k in range(8)]
    points = [[0, 0, 1], *([math.cos(a), math.sin(a), 1] for a in angles)]
    tin = ts.TIN.from_triangles(points, [[0, k + 1, (k + 1) % 8 + 1] for k in range(8)])
    assert not ts.check(tin).is_surface


def test_level_1_says_nothing_of_the_surface():
    assert not ts.check(ts.triangulate(FLAT), level=1).is_surface
