"""Surveys and TINs move to another CRS; what PROJ cannot do here is said, not done silently."""

import numpy as np
import pyproj
import pytest
from shapely import Polygon

import tinsmith as ts
from tinsmith import CrsError, OptionError
from tinsmith.io.reprojection.placement import place
from tinsmith.io.reprojection.quality import judge

UTM, FEET = "EPSG:32616", "EPSG:2274"
CORNER = np.array([752_640.0, 4_024_180.0, 300.0])


def make_survey(**more):
    points = (CORNER + np.random.default_rng(1).random((150, 3)) * (900, 700, 30)).round(3)
    return ts.Survey(points=points, crs=UTM, elevation_unit="m", **more)


def make_lines():
    points = make_survey().points
    square = CORNER[:2] + np.array([[100, 100], [300, 100], [300, 250], [100, 250]])
    return {
        "breaklines": [
            ts.Breakline(points[[0, 9]], name="kerb"),
            ts.Breakline(points[[3, 70], :2], kind="soft", priority=2),
        ],
        "boundary": [CORNER[:2] + np.array([[-9, -9], [950, -9], [950, 750], [-9, 750]])],
        "holes": [Polygon(square + 400)],
        "erase": [square + 200],
        "water": [ts.Water(square, 310.0, name="pond")],
    }


def proj(points, source, target):
    """Move points without this package, in the plane."""
    moved = pyproj.Transformer.from_crs(source, target, always_xy=True).transform(*points.T[:2])
    return np.stack(moved, axis=1)


def test_points_are_where_proj_puts_them():
    survey = make_survey()
    moved = ts.reproject(survey, FEET)
    assert np.array_equal(moved.points[:, :2], proj(survey.points, UTM, FEET))
    assert moved.points[:, 2] == pytest.approx(survey.points[:, 2] * 3937 / 1200, rel=1e-14)
    assert moved.crs == FEET
    assert moved.elevation_unit.name == "US survey foot"
    assert moved.attributes == survey.attributes


def test_lines_move_with_the_points():
    moved = ts.reproject(make_survey(**make_lines()), FEET)
    given = make_lines()
    assert [one.name for one in moved.breaklines] == ["kerb", ""]
    assert [one.priority for one in moved.breaklines] == [0, 2]
    assert moved.breaklines[1].coords.shape == (2, 2)
    assert np.array_equal(moved.boundary[0], proj(given["boundary"][0], UTM, FEET))
    assert moved.water[0].z == pytest.approx(310 * 3937 / 1200)
    expected = proj(np.array(given["holes"][0].exterior.coords), UTM, FEET)
    assert np.array_equal(moved.holes[0][0], expected)


@pytest.mark.parametrize("lines", [{}, make_lines()])
def test_a_tin_is_the_fresh_build_of_its_reprojected_points(lines):
    survey = make_survey(**lines)
    tin = ts.triangulate(survey, max_edge=400.0, snap=0.01)
    moved = ts.reproject(tin, FEET)
    feet = 3937 / 1200
    fresh = ts.triangulate(ts.reproject(survey, FEET), max_edge=400.0 * feet, snap=0.01 * feet)
    assert np.array_equal(moved.points, fresh.points)
    assert np.array_equal(moved.triangles, fresh.triangles)
    assert np.array_equal(moved.constrained, fresh.constrained)
    assert list(moved.lines.names) == list(fresh.lines.names)
    assert ts.check(moved).ok
    assert tin.crs == UTM


def test_edits_are_part_of_it_and_go_on():
    tin = ts.triangulate(make_survey())
    tin.insert([[*CORNER[:2] + 50.5, 311.0]])
    tin.remove([3])
    moved = ts.reproject(tin, "EPSG:32617")
    assert ts.check(moved).ok
    assert len(moved.points) == len(tin.points)
    moved.insert([moved.points[:3].mean(axis=0)])
    moved.undo()
    assert np.array_equal(moved.points, ts.reproject(tin, "EPSG:32617").points)


def test_triangles_of_a_file_are_kept():
    tin = ts.triangulate(make_survey())
    given = ts.TIN.from_triangles(tin.points, tin.triangles[::-1], crs=UTM, elevation_unit="m")
    moved = ts.reproject(given, "EPSG:32617")
    assert np.array_equal(moved.triangles, given.triangles)
    assert np.array_equal(moved.points[:, :2], proj(tin.points, UTM, "EPSG:32617"))
    assert moved.crs == "EPSG:32617"


def test_a_crs_that_is_not_known_and_degrees_are_refused():
    survey = make_survey()
    with pytest.raises(CrsError, match="not known"):
        ts.reproject(ts.Survey(points=survey.points), UTM)
    with pytest.raises(CrsError, match="degrees"):
        ts.reproject(ts.triangulate(survey), "EPSG:4326")
    with pytest.raises(OptionError, match="foot"):
        ts.reproject(survey, FEET, elevation_unit="ft")


def test_there_and_back_is_where_it_was():
    survey = make_survey()
    back = ts.reproject(ts.reproject(survey, FEET), UTM)
    assert np.abs(back.points - survey.points).max() < 1e-6


# ----------------------------------------------------------------- what PROJ cannot do


def test_a_vertical_datum_without_its_grid_is_refused():
    points = make_survey().points
    for source, target in ((f"{UTM}+5703", "EPSG:4979"), ("EPSG:4979", f"{UTM}+5703")):
        there = points if source != "EPSG:4979" else [[-84.2, 36.4, 300.0]]
        with pytest.raises(CrsError, match="vertical datum"):
            ts.transform_points(there, source, target)


def test_a_vertical_unit_alone_needs_no_grid():
    survey = ts.Survey(points=make_survey().points, crs=f"{UTM}+5703")
    moved = ts.reproject(survey, "EPSG:8778")
    assert moved.points[:, 2] == pytest.approx(survey.points[:, 2] * 3937 / 1200, rel=1e-12)
    assert moved.elevation_unit.name == "US survey foot"


def test_a_better_transformation_that_needs_a_grid_is_told(tmp_path):
    points = np.array([[3_513_000.0, 5_404_000.0, 250.0]])
    placed = place(
        points,
        source=ts.CRS("EPSG:31467"),
        target=ts.CRS("EPSG:25832"),
    )
    assert any("BETA2007" in note for note in placed.notes)
    inside = np.array([[752_700.0, 4_024_200.0, 250.0]])
    assert not place(inside, source=ts.CRS(UTM), target=ts.CRS("EPSG:32617")).notes


def test_a_datum_that_is_left_out_is_told():
    transformer = pyproj.Transformer.from_crs("EPSG:4267", "EPSG:4269", always_xy=True)
    transformer.transform(-100.0, 40.0)
    quality = judge(ts.CRS("EPSG:4267"), ts.CRS("EPSG:4269"), transformer)
    if "ballpark" in transformer.get_last_used_operation().description.lower():
        assert "datum was left out" in quality.note
    else:
        assert "left out" not in (quality.note or "")


# ---------------------------------------------------------------------- known points


@pytest.mark.parametrize(
    ("crs", "easting", "northing", "longitude", "latitude"),
    [
        # Corner examples of EPSG Guidance Note 7-2, and landmarks from national map services
        ("EPSG:2193", 1_748_795.0, 5_427_610.0, 174.7767, -41.2887),
        ("EPSG:31467", 3_513_000.0, 5_404_000.0, 9.1755, 48.7733),
        ("EPSG:3812", 649_690.0, 670_350.0, 4.3632, 50.8457),
        ("EPSG:27700", 530_034.0, 180_381.0, -0.1276, 51.5074),
        ("EPSG:28992", 155_000.0, 463_000.0, 5.38763888, 52.15616055),
    ],
)
def test_eastings_come_first_whatever_the_authority_says(
    crs, easting, northing, longitude, latitude
):
    (found,) = ts.transform_points([[longitude, latitude, 0.0]], "EPSG:4326", crs)
    assert found[:2] == pytest.approx([easting, northing], abs=400)
    (back,) = ts.transform_points([found], crs, "OGC:CRS84")
    assert back[:2] == pytest.approx([longitude, latitude], abs=1e-7)
