"""The sample data: where they lie, what they hold, and that their scripts make them again."""

from __future__ import annotations

import csv
import runpy
import subprocess
import sys
from collections import Counter
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import tinsmith as ts

SAMPLES = Path(__file__).parents[1] / "sample_data"
CROSS_MOUNTAIN = (-84.23056, 36.19833, 1077.0)
JACKSBORO = (-84.184, 36.330, 325.0)


def run_script(name: str, output: Path) -> None:
    command = [sys.executable, str(SAMPLES / name), str(output)]
    subprocess.run(command, check=True, capture_output=True)


@pytest.fixture(scope="module")
def rows() -> list[list[str]]:
    with (SAMPLES / "site_survey.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def test_survey_is_made_again_byte_for_byte(tmp_path):
    run_script("make_site_survey.py", tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == (SAMPLES / "site_survey.csv").read_bytes()


def test_junction_is_made_again_byte_for_byte(tmp_path):
    run_script("make_junction.py", tmp_path)
    made = (tmp_path / "junction.csv").read_bytes()
    assert made == (SAMPLES / "codes" / "junction.csv").read_bytes()


def test_kerbs_of_the_junction_are_arcs_of_12_m():
    survey = ts.read(SAMPLES / "codes" / "junction.csv", crs="EPSG:32616", elevation_unit="m")
    made = ts.lines_from_codes(survey, code_table=SAMPLES / "codes" / "words.toml")
    lines = {line.name: line.coords[:, :2] - (752_100, 4_024_400) for line in made.breaklines}
    for name, centre in (("EP1", (38, 42)), ("EP2", (74, 42))):
        xy = lines[name]
        is_bent = (xy[:, 1] > 30.001) & (xy[:, 1] < 41.999)
        assert is_bent.sum() == 19  # 20 chords of 4.5°, which rise by 9 mm
        assert np.allclose(np.hypot(*(xy[is_bent] - centre).T), 12, atol=1e-6)
    assert made.findings == []
    assert ts.check(ts.triangulate(made), points=made).ok


def test_survey_has_five_columns_and_lies_on_its_site(rows):
    assert rows[0] == ["Point", "Northing", "Easting", "Elevation", "Description"]
    assert {len(row) for row in rows} == {5}
    neh = np.array([row[1:4] for row in rows[1:]], float)
    assert len(neh) == 2123
    assert np.ptp(neh, axis=0) == pytest.approx([180, 250, 17], abs=4)
    assert neh.mean(axis=0) == pytest.approx([4_024_270, 752_765, 324], abs=10)


def test_survey_has_exactly_two_duplicates(rows):
    places = Counter((row[1], row[2]) for row in rows[1:])
    shared = [place for place, count in places.items() if count > 1]
    groups = [[row for row in rows[1:] if (row[1], row[2]) == place] for place in shared]
    assert [len(group) for group in groups] == [2, 2]
    reshot, repeat = sorted(groups, key=lambda group: group[0] == group[1])
    assert float(reshot[1][3]) - float(reshot[0][3]) == pytest.approx(0.034)
    assert repeat[0] == repeat[1]


def test_survey_numbers_rise_with_gaps_and_quotes_survive(rows):
    numbers = np.array([int(row[0]) for row in rows[1:]])
    assert (np.diff(numbers) >= 0).all()
    assert numbers[-1] - numbers[0] > len(numbers)
    assert 'MH "MANHOLE, 600mm"' in {row[4] for row in rows}


def test_road_has_its_cross_fall_and_the_ditch_its_depth(rows):
    heights = {
        code: np.array([float(row[3]) for row in rows if row[4].split()[0] == code])
        for code in ("EP1", "CL1", "EP2", "FL1", "TOB2", "WE1")
    }
    assert np.mean(heights["CL1"] - heights["EP1"]) == pytest.approx(0.025 * 3.5, abs=0.01)
    assert np.mean(heights["CL1"] - heights["EP2"]) == pytest.approx(0.025 * 3.5, abs=0.01)
    assert heights["TOB2"].mean() - heights["FL1"].mean() > 0.5
    assert np.ptp(heights["WE1"]) < 0.06


def test_dem_opens_with_crs_spacing_and_nodata():
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open(SAMPLES / "jacksboro.tif") as file:
        elevation = file.read(1, masked=True)
        assert file.crs.to_epsg() == 32616
        assert file.res == (75.0, 75.0)
        assert file.nodata == -9999.0
        assert "SRTM" in file.tags()["SOURCE"]
    assert elevation.shape == (411, 388)
    assert 240 < elevation.min() < elevation.max() < 1077
    assert elevation.count() == elevation.size


@pytest.mark.parametrize(("place", "tolerance"), [(CROSS_MOUNTAIN, 10), (JACKSBORO, 10)])
def test_dem_lies_where_the_map_says(place, tolerance):
    rasterio = pytest.importorskip("rasterio")
    pyproj = pytest.importorskip("pyproj")
    to_utm = pyproj.Transformer.from_crs(4326, 32616, always_xy=True)
    with rasterio.open(SAMPLES / "jacksboro.tif") as file:
        (value,) = next(file.sample([to_utm.transform(*place[:2])]))
    assert value == pytest.approx(place[2], abs=tolerance)


def test_summit_is_the_highest_cell():
    rasterio = pytest.importorskip("rasterio")
    pyproj = pytest.importorskip("pyproj")
    to_globe = pyproj.Transformer.from_crs(32616, 4326, always_xy=True)
    with rasterio.open(SAMPLES / "jacksboro.tif") as file:
        elevation = file.read(1, masked=True)
        x, y = file.xy(*np.unravel_index(elevation.argmax(), elevation.shape))
    assert to_globe.transform(x, y) == pytest.approx(CROSS_MOUNTAIN[:2], abs=0.001)


def test_dem_equals_the_source_interpolated_at_independently_projected_centres():
    rasterio = pytest.importorskip("rasterio")
    pyproj = pytest.importorskip("pyproj")
    source = source_grid()
    to_globe = pyproj.Transformer.from_crs(32616, 4326, always_xy=True)
    with rasterio.open(SAMPLES / "jacksboro.tif") as file:
        elevation = file.read(1, masked=True)
        rows, columns = np.nonzero(~elevation.mask)
        lon, lat = to_globe.transform(*file.xy(rows, columns))
    expected = source(np.stack([lat, lon], axis=1))
    difference = np.abs(elevation.compressed() - expected)
    assert np.isfinite(difference).all()
    assert difference.max() < 0.051


def source_grid():
    cbook = pytest.importorskip("matplotlib.cbook")
    interpolate = pytest.importorskip("scipy.interpolate")
    with cbook.get_sample_data("jacksboro_fault_dem.npz") as data:
        values, step = data["elevation"].astype(float), float(data["dx"])
        west, north = float(data["xmin"]), float(data["ymax"])
    lat = north - (np.arange(values.shape[0]) + 0.5) * step
    lon = west + (np.arange(values.shape[1]) + 0.5) * step
    return interpolate.RegularGridInterpolator(
        (lat[::-1], lon), values[::-1], bounds_error=False, fill_value=np.nan
    )


@pytest.mark.slow
def test_dem_is_made_again(tmp_path):
    """Pixels, not bytes: the compressor belongs to the GDAL that happens to be installed."""
    rasterio = pytest.importorskip("rasterio")
    pytest.importorskip("matplotlib")
    for name in ("again.tif", "and_again.tif"):
        run_script("make_jacksboro.py", tmp_path / name)
    with (
        rasterio.open(tmp_path / "again.tif") as again,
        rasterio.open(SAMPLES / "jacksboro.tif") as committed,
    ):
        assert again.profile == committed.profile
        assert again.tags() == committed.tags()
        np.testing.assert_allclose(again.read(1), committed.read(1), atol=0.11)
    assert (tmp_path / "again.tif").read_bytes() == (tmp_path / "and_again.tif").read_bytes()


def test_pond_bed_lies_below_its_water():
    script = runpy.run_path(str(SAMPLES / "make_site_survey.py"))
    u, v = script["POND_CENTER"]
    bed = float(script["elevation"](np.array(u), np.array(v)))
    assert bed == pytest.approx(script["POND_LEVEL"] - script["POND_DEPTH"], abs=1e-9)


def test_design_is_made_again_byte_for_byte(tmp_path):
    run_script("make_design.py", tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == (SAMPLES / "design_pad.csv").read_bytes()


@pytest.fixture(scope="module")
def design():
    """The ground and the pad, as TINs."""
    return [
        ts.triangulate(
            ts.lines_from_codes(ts.read(SAMPLES / name, crs="EPSG:32616", elevation_unit="m"))
        )
        for name in ("site_survey.csv", "design_pad.csv")
    ]


def test_design_meets_the_ground_all_around(design):
    ground, pad = design
    (ring,) = pad.rings
    assert len(ring) > 90
    above = pad.points[ring, 2] - ground.interpolate(pad.points[ring, :2])
    assert np.abs(above).max() < 0.002


def test_side_slopes_are_1_in_2_in_cut_and_1_in_2_and_a_half_in_fill(design):
    _, pad = design
    steep = np.tan(np.radians(ts.slope(pad)))
    areas = pad.triangle_areas
    for run in (1 / 2.0, 1 / 2.5, 0.01):
        assert areas[np.abs(steep - run) < 0.03].sum() > 20


def test_cut_and_fill_of_the_design_are_those_of_a_fine_grid(design):
    """Without the overlay: elevations of both at the centres of cells of 0.1 m."""
    ground, pad = design
    box, step = pad.bounds, 0.1
    x, y = (
        np.arange(low + step / 2, high, step)
        for low, high in ((box.xmin, box.xmax), (box.ymin, box.ymax))
    )
    centres = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    height = pad.interpolate(centres) - ground.interpolate(centres)
    height = height[~np.isnan(height)]
    table = ts.volume(ground, pad)
    assert table["fill"][0] == pytest.approx(height[height > 0].sum() * step**2, rel=2e-3)
    assert table["cut"][0] == pytest.approx(-height[height < 0].sum() * step**2, rel=2e-3)


def test_cut_and_fill_of_the_design_are_those_of_shapely(design):
    """Cells cut by GEOS; planes by least squares; each part's volume by its centroid."""
    shapely = pytest.importorskip("shapely")
    ground, pad = design
    cells = [shapely.polygons(tin.points[tin.triangles, :2]) for tin in design]
    pairs = shapely.STRtree(cells[0]).query(cells[1], predicate="intersects").T
    volumes = {1: 0.0, -1: 0.0}
    origin = np.array([pad.bounds.xmin, pad.bounds.ymin])
    for b, a in pairs:
        cell = shapely.intersection(cells[0][a], cells[1][b])
        if cell.geom_type != "Polygon" or cell.is_empty:
            continue
        plane = plane_of(pad, b, origin) - plane_of(ground, a, origin)
        corners = np.array(cell.exterior.coords) - origin
        for sign in volumes:
            volumes[sign] += volume_above(corners, sign * plane)
    table = ts.volume(ground, pad)
    assert table["fill"][0] == pytest.approx(volumes[1], rel=1e-7)
    assert table["cut"][0] == pytest.approx(volumes[-1], rel=1e-7)


def plane_of(tin, triangle, origin):
    xyz = tin.points[tin.triangles[triangle]]
    return np.linalg.solve(np.column_stack([xyz[:, :2] - origin, np.ones(3)]), xyz[:, 2])


def volume_above(corners, plane):
    """Integrate the positive part of a linear function over a convex ring, by triangles."""
    values = corners @ plane[:2] + plane[2]
    kept = []
    for p, q, u, v in zip(corners[:-1], corners[1:], values[:-1], values[1:], strict=True):
        kept += [(*p, u)] if u >= 0 else []
        kept += [(*(p + u / (u - v) * (q - p)), 0.0)] if u * v < 0 else []
    total = 0.0
    for first, second in pairwise(kept[1:]):
        a, b, c = np.array(kept[0]), np.array(first), np.array(second)
        doubled = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]
        total += abs(doubled) / 2 * (a[2] + b[2] + c[2]) / 3
    return total
