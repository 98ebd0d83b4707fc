"""Every product through the validators of the formats' own people."""

from __future__ import annotations

import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from support.product_calls import HILL, RESULTS
from support.surfaces import hills
from support.validators import validate

import tinsmith as ts

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")]

_OF_DELFT3D = "A106"
"""The attribute node_dimension, which Delft3D FM writes and the convention does not name."""

GDAL = Path("/usr/lib/python3/dist-packages/osgeo_utils/samples")
"""Where Debian's python3-gdal has GDAL's own validators."""


@pytest.fixture(scope="module")
def made():
    """Return the result of every public function of a surface that has one."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {name: make(HILL) for name, make in RESULTS.items()} | {"lines": hills()}


def write_each(made, kinds, suffix, folder):
    """Write every result of some kinds; empty features are left aside."""
    paths = {}
    for name, one in made.items():
        if isinstance(one, kinds) and not (isinstance(one, ts.Features) and len(one) == 0):
            paths[name] = ts.write(one, folder / f"{name}{suffix}")
    assert len(paths) > 2
    return paths


def find_gdal_validator(name):
    path = GDAL / name
    if not path.is_file():
        pytest.skip(f"GDAL's {name} is not there: Debian's python3-gdal has it")
    return path


def test_geopackages_pass_the_validator_of_gdal(tmp_path, made):
    validator = find_gdal_validator("validate_gpkg.py")
    surfaces = write_each(made, (ts.TIN, ts.Features), ".gpkg", tmp_path)
    surfaces["survey"] = ts.write(ts.Survey(points=HILL.points, crs=HILL.crs), tmp_path / "s.gpkg")
    surfaces["compact"] = ts.write(HILL, tmp_path / "compact.gpkg", compact=True)
    both = ts.write(made["contours"], tmp_path / "both.gpkg")
    surfaces["two layers"] = ts.write(made["catchments"], both)
    faults = {}
    for name, path in surfaces.items():
        done = subprocess.run(
            ["/usr/bin/python3", str(validator), str(path)],
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            faults[name] = done.stdout + done.stderr
    assert not faults


def test_geotiffs_are_cloud_optimized_where_they_say_so(tmp_path, made):
    rio_cogeo = pytest.importorskip("rio_cogeo")
    for name, one in made.items():
        if isinstance(one, ts.Raster):
            path = ts.write(one, tmp_path / f"{name}.tif", format="cog")
            is_valid, errors, told = rio_cogeo.cog_validate(str(path), strict=True)
            assert is_valid, (name, errors, told)


def test_glb_passes_the_validator_of_khronos(tmp_path, made):
    paths = write_each(made, ts.TIN, ".glb", tmp_path)
    paths["exaggerated"] = ts.write(HILL, tmp_path / "high.glb", exaggeration=7.5)
    for frame in ("local", "globe"):
        paths[frame] = ts.write(HILL, tmp_path / f"{frame}.glb", frame=frame)
    assert validate(paths) == {}


def test_geojson_passes_check_geojson(tmp_path, made):
    paths = write_each(made, (ts.TIN, ts.Features), ".geojson", tmp_path)
    points = [[0, 0, 1], [90_000, 0, 2], [0, 90_000, 3], [90_000, 90_000, 4]]
    far = ts.triangulate(np.array(points) + np.array([300_000, 7e6, 0]), crs="EPSG:32601")
    for kind in ("triangles", "edges", "hull"):  # cut at the antimeridian
        paths[kind] = ts.write(far, tmp_path / f"{kind}-cut.geojson", kind=kind)
        assert "Multi" in paths[kind].read_text()
    assert validate(paths) == {}


def test_the_validators_find_faults(tmp_path):
    paths = {"geojson": tmp_path / "a.geojson", "glb": tmp_path / "a.glb"}
    paths["geojson"].write_text('{"type": "FeatureCollection", "features": [{"type": "Point"}]}')
    content = bytearray(ts.write(HILL, paths["glb"]).read_bytes())
    at = content.index(b'"componentType":5126')
    content[at : at + 20] = b'"componentType":5120'
    paths["glb"].write_bytes(content)
    assert validate(paths).keys() == paths.keys()


def test_meshes_keep_to_ugrid(tmp_path, made):
    ugrid_checks = pytest.importorskip("ugrid_checks")
    for name, path in write_each(made, ts.TIN, ".nc", tmp_path).items():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = ugrid_checks.check_dataset(
                str(path), print_summary=False, ignore_codes=[_OF_DELFT3D]
            )
        logger = found.logger
        assert (logger.N_FAILURES, logger.N_WARNINGS) == (0, 0), (name, found.checking_report())


def test_cities_are_read_by_cjio(tmp_path, made):
    for name, path in write_each(made, ts.TIN, ".city.json", tmp_path).items():
        done = subprocess.run(
            [str(Path(sys.executable).with_name("cjio")), str(path), "info"],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, (name, done.stdout, done.stderr)
        assert "TINRelief" in done.stdout, name
