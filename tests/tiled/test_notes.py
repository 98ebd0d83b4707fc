"""What is told of a surface in tiles is what is told of it in memory, and is in the same files."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from support.many_files import Shuffled

import tinsmith as ts
from tinsmith.tin.tiling import find_differing

LINE = [[2.0, 3.0], [55.0, 48.0]]
PLACES = [[10.0, 10.0], [30.5, 20.25]]

# of the surface in memory, and of the one in tiles, to a file that keeps notes
PRODUCTS = {
    "raster.tif": (
        lambda tin: ts.rasterize(tin, spacing=2.0),
        lambda cloud, path, **way: cloud.rasterize(path, spacing=2.0, **way),
    ),
    "slope.tif": (
        lambda tin: ts.rasterize(tin, spacing=2.0, value="slope"),
        lambda cloud, path, **way: cloud.rasterize(path, spacing=2.0, value="slope", **way),
    ),
    "contours.gpkg": (
        lambda tin: ts.contours(tin, interval=0.5),
        lambda cloud, path, **way: cloud.contours(path, 0.5, **way),
    ),
    "bands.gpkg": (
        lambda tin: ts.contour_bands(tin, interval=0.5),
        lambda cloud, path, **way: cloud.contours(path, 0.5, bands=True, **way),
    ),
    "volume.json": (
        lambda tin: ts.volume(tin, base=1.0),
        lambda cloud, path, **way: cloud.volume(path, base=1.0, **way),
    ),
    "profile.json": (
        lambda tin: ts.profile(tin, LINE),
        lambda cloud, path, **way: cloud.profile(path, LINE, **way),
    ),
}


@pytest.fixture(scope="module")
def survey():
    """Return a survey many of whose points lie at one place."""
    points = np.round(np.random.default_rng(2).random((2_000, 3)) * [60, 50, 3], 0)
    return ts.Survey(points=points, crs="EPSG:32616", elevation_unit="m")


@pytest.mark.parametrize("name", PRODUCTS)
def test_notes_are_those_in_memory(survey, tmp_path, name):
    in_memory, in_tiles = PRODUCTS[name]
    source = ts.write(survey, tmp_path / "points.csv")
    tin = ts.triangulate(ts.read(source, crs="EPSG:32616", elevation_unit="m"))
    whole = in_memory(tin)
    assert any("differ in elevation" in note for note in whole.notes)
    wanted = ts.write(whole, tmp_path / f"whole-{name}").read_bytes()
    cloud = ts.tiles(source, crs="EPSG:32616", elevation_unit="m")
    for tiles in (1, 5):
        path = in_tiles(cloud, tmp_path / name, tiles=tiles, executor=Shuffled(tiles))
        assert path.read_bytes() == wanted.replace(b"whole-", b"")


@pytest.mark.each_value
@pytest.mark.parametrize("tiles", [1, 5])
@pytest.mark.parametrize("is_other", [False, True])
def test_volumes_tell_of_both_surfaces(survey, tmp_path, is_other, tiles):
    plain = replace(survey, points=np.random.default_rng(3).random((500, 3)) * [60, 50, 3])
    files = [ts.write(survey, tmp_path / "a.csv"), ts.write(plain, tmp_path / "b.csv")]
    first, second = files[::-1] if is_other else files
    whole = ts.volume(*(ts.triangulate(ts.read(one)) for one in (first, second)))
    (wanted,) = [note for note in whole.notes if "differ in elevation" in note]
    cloud, executor = ts.tiles(first), Shuffled(tiles)
    path = tmp_path / "volume.json"
    cloud.volume(path, other=ts.tiles(second), tiles=tiles, executor=executor)
    (told,) = [note for note in json.loads(path.read_text())["notes"] if "differ in" in note]
    assert told.startswith("The other surface: ") is is_other
    assert told.partition("Points at")[2] == wanted.partition("Points at")[2]


def test_places_of_a_merge_are_those_of_points_that_are_not_merged(survey):
    report = ts.triangulate(survey).report
    starts = report.merged_offsets[:-1]
    high = np.maximum.reduceat(report.merged_elevations, starts)
    spread = high - np.minimum.reduceat(report.merged_elevations, starts)
    found = find_differing(survey.points)
    assert len(found) == np.count_nonzero(spread)
    assert found[:, 2].sum() == pytest.approx(spread.sum())
    assert len(find_differing(np.empty((0, 3)))) == 0
