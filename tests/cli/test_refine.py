"""``tinsmith refine`` as people run it."""

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
from support.commands import refuse, run

import tinsmith as ts

SITE = str(Path(__file__).parents[2] / "sample_data" / "site_survey.csv")


def test_a_survey_becomes_a_mesh_that_other_programs_open(tmp_path):
    out = run(
        *("refine", SITE, "--codes", "--crs", "EPSG:32616", "--max-area", 20),
        *("-o", tmp_path / "a.msh", "-o", tmp_path / "a.vtu", "--json"),
    )
    assert out.exit_code == 0, out.output
    answer = json.loads(out.stdout)
    assert answer["tin"]["quality"]["min_angle"]["min"] >= 25 - 1e-9
    mesh, grid = meshio.read(tmp_path / "a.msh"), pyvista.read(tmp_path / "a.vtu")
    assert len(mesh.cells_dict["triangle"]) == grid.n_cells == answer["tin"]["triangles"]
    assert {"surface", "boundary", "RDG1"} <= set(mesh.field_data)
    sizes = grid.compute_cell_sizes()["Area"]
    flat = sizes * np.cos(np.radians(grid.cell_data["slope"]))
    assert flat.max() <= 20 * (1 + 1e-9)


def test_a_tin_is_refined_as_it_is(tmp_path):
    tin = ts.triangulate(np.random.default_rng(1).random((50, 3)) * 100)
    path = ts.write(tin, tmp_path / "tin.ply")
    out = run("refine", path, "--min-angle", 30, "--max-side", 5, "-o", tmp_path / "fine.ply")
    assert out.exit_code == 0, out.output
    assert "Angles" in out.stderr
    fine = ts.read(tmp_path / "fine.ply")
    ends = fine.points[fine.edges, :2]
    assert np.hypot(*(ends[:, 1] - ends[:, 0]).T).max() <= 5 * (1 + 1e-9)
    assert ts.check(fine, level=3).ok


def test_triangles_that_stay_bad_are_told_with_their_numbers_and_why(tmp_path):
    points = tmp_path / "needle.xyz"
    points.write_text("0 0 1\n100 0 1\n100 2 1\n")
    out = run("refine", points, "-o", tmp_path / "a.ply", "--json")
    assert out.exit_code == 0
    (group,) = json.loads(out.stdout)["report"]["unmended"]
    assert group["why"] == "lines or the boundary meet there under a small angle"
    angles = ts.tin.quality(ts.read(tmp_path / "a.ply")).min_angle
    assert group["triangles"] == np.flatnonzero(angles < 25).tolist()
    assert group["count"] == len(group["triangles"]) > 0
    assert group["least_angle"] == pytest.approx(angles.min())
    assert f"{group['count']} triangle" in out.stderr
    assert "under a small angle" in out.stderr


def test_degrees_are_refused(tmp_path):
    corners = [[-84.1, 36.3, 300], [-84.0, 36.3, 310], [-84.0, 36.4, 320]]
    tin = ts.tin.TIN.from_triangles(corners, [[0, 1, 2]], crs="EPSG:4326")
    path = ts.write(tin, tmp_path / "degrees.ply")
    out = run("refine", path, "-o", tmp_path / "a.msh")
    assert out.exit_code == 1
    assert "is in degrees" in out.stderr
    assert not (tmp_path / "a.msh").exists()


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["--min-angle", "40"], 2, "Invalid --min-angle 40.0"),
        (["--max-area", "-2"], 2, "Invalid --max-area -2.0"),
        (["--max-area", "1e-9"], 1, "more than 10,000,000 vertices"),
        (["--max-vertices", "2000"], 1, "more than 2,000 vertices"),
        (["--max-side", "x"], 2, "'x' is not a valid float"),
    ],
)
def test_bad_options_are_a_sentence_and_leave_no_file(tmp_path, options, code, words):
    path = tmp_path / "a.msh"
    assert words in refuse("refine", SITE, *options, "-o", path, code=code, folder=tmp_path)
