"""docs/examples/tinsmith-ifc, installed as its own distribution and used as one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support import matrix

import tinsmith as ts

pytestmark = pytest.mark.slow

EXAMPLE = Path(__file__).parents[3] / "docs" / "examples" / "tinsmith-ifc"


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Return the folder of an installed plug-in."""
    folder = tmp_path_factory.mktemp("installed")
    source = shutil.copytree(EXAMPLE, folder / "source")
    target = folder / "packages"
    how = ["--no-deps", "--no-build-isolation", "--no-index", "--quiet", "--target", str(target)]
    done = subprocess.run(
        [sys.executable, "-m", "pip", "install", *how, str(source)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return target


def run(installed, *arguments, code=0):
    script = "from tinsmith.cli import main; main()"
    surroundings = os.environ | {"PYTHONPATH": str(installed), "COLUMNS": "120"}
    command = [sys.executable, "-c", script, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, env=surroundings)
    assert done.returncode == code, done.stderr
    return done


def test_the_plug_in_is_listed(installed):
    listed = json.loads(run(installed, "formats", "--json").stdout)["formats"]
    (found,) = [one for one in listed if one["name"] == "ifc"]
    assert (found["reads"], found["writes"], found["suffixes"]) == ([], ["TIN"], [".ifc"])
    assert found["from"] == "tinsmith-ifc 0.1.0"
    shown = run(installed, "--help")
    assert shown.stdout.split("Commands of plug-ins:")[1].split()[0] == "ifc-summary"
    assert shown.stderr == ""


@pytest.mark.parametrize("crs", ["EPSG:32616", "EPSG:2274"])
def test_a_tin_becomes_a_site_at_its_place(installed, tmp_path, crs):
    ifcopenshell = pytest.importorskip("ifcopenshell")
    tin = matrix.make_tin().replace(crs=crs)
    path = tmp_path / "a.ifc"
    run(installed, "convert", ts.write(tin, tmp_path / "a.gpkg"), "-o", path)
    model = ifcopenshell.open(path)
    (faces,) = model.by_type("IfcTriangulatedFaceSet")
    (place,) = model.by_type("IfcMapConversion")
    (site,) = model.by_type("IfcSite")
    assert (np.array(faces.CoordIndex) - 1).tolist() == tin.triangles.tolist()
    assert place.TargetCRS.Name == crs
    origin = [place.Eastings, place.Northings, place.OrthogonalHeight]
    scale = 1.0 if crs == "EPSG:32616" else 3937 / 1200  # metres as US survey feet
    np.testing.assert_allclose(
        np.array(faces.Coordinates.CoordList) + origin, tin.points * [1, 1, scale], rtol=1e-15
    )
    assert site.Representation.Representations[0].Items[0] == faces
    units = model.by_type("IfcConversionBasedUnit")
    assert [one.Name for one in units] == ([] if scale == 1.0 else ["US survey foot"])
    told = run(installed, "ifc-summary", path).stdout
    assert f"{len(tin.points)} vertices, {len(tin.triangles)} triangles" in told


def test_the_file_is_valid_and_the_same_each_time(installed, tmp_path):
    validate = pytest.importorskip("ifcopenshell.validate")
    import ifcopenshell

    given = ts.write(matrix.make_tin(), tmp_path / "a.gpkg")
    for name in ("a.ifc", "b.ifc"):
        run(installed, "convert", given, "-o", tmp_path / name)
    assert (tmp_path / "a.ifc").read_bytes() == (tmp_path / "b.ifc").read_bytes()
    logger = validate.json_logger()
    validate.validate(ifcopenshell.open(tmp_path / "a.ifc"), logger)
    assert logger.statements == []


def test_what_it_cannot_write_is_refused(installed, tmp_path):
    degrees = ts.triangulate([[9, 50, 1], [9.1, 50, 2], [9, 50.1, 3]], crs=4326)
    given = ts.write(degrees, tmp_path / "a.gpkg")
    done = run(installed, "convert", given, "-o", tmp_path / "a.ifc", code=1)
    assert "IFC needs eastings and northings" in done.stderr
    assert not (tmp_path / "a.ifc").exists()
    points = ts.write(ts.Survey(points=np.eye(3)), tmp_path / "a.csv")
    done = run(installed, "convert", points, "-o", tmp_path / "a.ifc", code=1)
    assert "'tinsmith build'" in done.stderr
