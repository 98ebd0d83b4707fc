"""STL models for 3D printing: closed, of the right size, and of the right volume."""

from __future__ import annotations

import numpy as np
import pytest
from support.surfaces import hills, punched

import tinsmith as ts
from tinsmith.io.mesh.stl import build_solid

trimesh = pytest.importorskip("trimesh")


@pytest.mark.parametrize("seed", range(12))
def test_a_solid_is_closed_whatever_the_surface(seed):
    """Holes, parts, and parts that touch in one vertex."""
    tin = punched(seed)
    solid = build_solid(tin, tin.points, 2.0)
    mesh = trimesh.Trimesh(solid.points, solid.triangles, process=False)
    assert mesh.is_volume
    z = tin.points[:, 2]
    above = z[tin.triangles].mean(axis=1) - (z[np.unique(tin.triangles)].min() - 2.0)
    assert mesh.volume == pytest.approx((tin.triangle_areas * above).sum(), rel=1e-12)
    assert solid.volume == pytest.approx(mesh.volume, rel=1e-12)


def test_a_model_to_scale(tmp_path):
    tin = hills(unit=None)
    path = ts.write(tin, tmp_path / "a.stl", solid=True, scale=500, thickness=3.0, exaggeration=2)
    mesh = trimesh.load(path)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    size = np.ptp(tin.points, axis=0) * 1000 / 500 * (1, 1, 2) + (0, 0, 3)
    assert mesh.extents == pytest.approx(size, rel=1e-6)
    base = tin.points[:, 2].min() - 3.0 / (2 * 2)  # 3 mm are so many metres of this model
    (row,) = ts.volume(tin, base=base).to_dataframe().to_dict("records")
    assert mesh.volume == pytest.approx(_find_cut(row) * 2 * 2**3, rel=1e-5)


def _find_cut(row):
    """Return the volume of the surface above the base, cubic metres."""
    return next(value for name, value in row.items() if str(name).startswith("cut"))


def test_a_model_of_a_size_takes_feet_into_account(tmp_path):
    tin = hills(crs="EPSG:32616", unit="foot")
    mesh = trimesh.load(ts.write(tin, tmp_path / "a.stl", solid=True, size=150))
    extent = np.ptp(tin.points, axis=0)
    assert mesh.extents[:2].max() == pytest.approx(150, rel=1e-6)
    height = extent[2] * 0.3048 * 150 / extent[:2].max() + 150 / 20 * (
        mesh.extents[:2].max() / 150)  # fmt: skip
    assert mesh.extents[2] == pytest.approx(height, rel=1e-5)


def test_a_solid_without_scale_is_in_the_units_of_the_crs(tmp_path):
    tin = hills(unit=None)
    mesh = trimesh.load(ts.write(tin, tmp_path / "a.stl", solid=True, thickness=5))
    assert mesh.is_volume
    assert mesh.extents == pytest.approx(np.add(np.ptp(tin.points, axis=0), (0, 0, 5)), rel=1e-6)


def test_a_plain_stl_is_as_it_was(tmp_path):
    tin = hills(unit=None)
    assert ts.read(ts.write(tin, tmp_path / "a.stl")).crs == tin.crs


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"scale": 500, "size": 100}, "size"),
        ({"thickness": 3}, "thickness"),
        ({"solid": True, "thickness": 0}, "thickness"),
        ({"scale": -1}, "scale"),
        ({"exaggeration": float("nan")}, "exaggeration"),
        ({"solid": "yes"}, "solid"),
    ],
)
def test_options_that_do_not_fit(tmp_path, options, word):
    with pytest.raises(ts.OptionError, match=word):
        ts.write(hills(unit=None), tmp_path / "a.stl", **options)
    assert not list(tmp_path.iterdir())


def test_a_scale_needs_a_unit(tmp_path):
    with pytest.raises(ts.CrsError, match="unit of the eastings"):
        ts.write(hills(crs=None, unit=None), tmp_path / "a.stl", scale=500)
