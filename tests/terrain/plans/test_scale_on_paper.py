"""A plan measures right: read back from the files by readers that know nothing of the drawing."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from support.printed import georeference, read_pdf, read_svg

import tinsmith as ts

SITE = Path(__file__).parents[3] / "sample_data" / "site_survey.csv"
BROWN = "0.4784313725 0.2901960784 0.137254902"
GRAY = "0.4784313725"
CAPITAL = 0.73


@pytest.fixture(scope="module")
def site():
    survey = ts.lines_from_codes(ts.read(SITE, crs="EPSG:32616", elevation_unit="m"))
    return survey, ts.triangulate(survey, max_edge=20.0)


@pytest.fixture
def site_page(site, tmp_path):
    made = ts.plan(site[1], scale=1000, interval=0.5, title="Site survey", date="2026-11-22")
    (file,) = made.save(tmp_path / "site.svg")
    return read_svg(file)


def test_pdf_of_the_site_survey_measures_1_to_500(site, tmp_path):
    made = ts.plan(site[1], scale=500, paper="A1", interval=0.5)
    (file,) = made.save(tmp_path / "site.pdf")
    (page,) = read_pdf(file)
    assert (page.width, page.height) == pytest.approx((841.0, 594.0), abs=1e-6)
    arms = [path for path in page.paths[GRAY] if len(path) == 2 and path[0, 1] > 80.0]
    crosses = np.unique(np.round([path.mean(axis=0) for path in arms], 4), axis=0)
    for axis in (0, 1):
        steps = np.diff(np.unique(crosses[:, axis].round(3)))
        assert 500 * steps / 1000 == pytest.approx(50.0, abs=1e-3)  # the grid has 50 m


def test_the_same_places_on_every_page(site_page, site, tmp_path):
    (file,) = ts.plan(site[1], scale=1000, interval=0.5).save(tmp_path / "site.pdf")
    (page,) = read_pdf(file)
    in_pdf = sorted(tuple(path[0].round(3)) for path in page.paths[BROWN])
    legend = [path for path in page.paths[BROWN] if path[0, 1] < site_page.frame[1]]
    in_svg = [tuple(path[0].round(3)) for path in site_page.paths["index-contours"]]
    assert len(in_pdf) == len(in_svg) + len(legend)
    assert (
        np.isin(np.round([x for x, _ in in_svg], 2), np.round([x for x, _ in in_pdf], 2)).mean()
        > 0.95
    )


def test_ticks_and_labels_give_the_scale(site_page):
    assert georeference(site_page).units_per_mm == pytest.approx((1.0, 1.0), rel=1e-6)


def test_every_label_says_the_elevation_where_it_stands(site_page, site):
    ground = georeference(site_page)
    labels = site_page.named("contour-label")
    assert len(labels) > 10
    for label in labels:
        up = np.radians(label.rotation + 90.0)
        center = label.place + 0.5 * CAPITAL * label.size * np.array([np.cos(up), np.sin(up)])
        found = site[1].interpolate(ground.to_ground(center))
        assert abs(found[0] - float(label.text)) < 0.12  # the label is 2 m high on the ground


def test_labels_are_upright(site_page):
    for label in site_page.named("contour-label"):
        assert -90.0 < (label.rotation + 180.0) % 360.0 - 180.0 <= 90.0


def test_contours_are_broken_where_their_labels_stand(site_page):
    lines = shapely.MultiLineString(site_page.paths["index-contours"])
    for label in site_page.named("contour-label"):
        up = np.radians(label.rotation + 90.0)
        center = label.place + 0.5 * CAPITAL * label.size * np.array([np.cos(up), np.sin(up)])
        assert lines.distance(shapely.Point(center)) > 0.7


@pytest.mark.slow
def test_everything_lies_within_the_frame(site, tmp_path):
    made = ts.plan(site[1], scale=500, paper="A4", interval=0.5, layout="rows")
    low, high = np.array([14.0, 54.0]), np.array([283.0, 196.0])
    for file in made.save(tmp_path / "site.svg")[1:]:
        page = read_svg(file)
        assert page.frame == pytest.approx((*low, *high), abs=1e-5)
        for name in ("contours", "index-contours", "hard-lines", "grid-crosses", "match-lines"):
            for path in page.paths.get(name, []):
                assert (path >= low - 1e-5).all()
                assert (path <= high + 1e-5).all()


def test_contours_on_paper_are_those_of_the_surface(site, tmp_path):
    (file,) = ts.plan(site[1], scale=1000, interval=0.5, labels="none").save(tmp_path / "a.svg")
    page = read_svg(file)
    paths = page.paths["contours"] + page.paths["index-contours"]
    drawn = sum(float(shapely.LineString(path).length) for path in paths)
    lines = ts.contours(site[1], interval=0.5)
    exact = sum(
        float(shapely.LineString(lines.coordinates[a:b, :2]).length)
        for a, b in pairwise(lines.offsets[0])
    )
    assert drawn == pytest.approx(exact, rel=1e-6)  # 1:1000: a metre is a millimetre


def test_water_is_filled_with_its_area(site, site_page):
    (lake,) = site_page.paths["water"]
    chain = next(
        chain
        for chain, kind in zip(site[1].lines.chains(), site[1].lines.kinds, strict=True)
        if kind == "water"
    )
    area = shapely.Polygon(site[1].points[chain, :2]).area
    assert shapely.Polygon(lake).area == pytest.approx(area, rel=1e-6)


@pytest.mark.parametrize(
    ("paper", "points"),
    [
        ("A0", (3370.394, 2383.937)),
        ("A3", (1190.551, 841.890)),
        ("A4", (841.890, 595.276)),
        ("letter", (792.0, 612.0)),
        ("ANSI E", (3168.0, 2448.0)),
        ("ARCH-D", (2592.0, 1728.0)),
        ((900, 600), (2551.181, 1700.787)),
    ],
)
def test_pages_have_the_size_of_the_paper(paper, points, tmp_path):
    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]])
    landscape = None if isinstance(paper, tuple) else "landscape"
    made = ts.plan(tin, paper=paper, orientation=landscape, ground_unit="m", grid="none")
    (file,) = made.save(tmp_path / "plan.pdf")
    (page,) = read_pdf(file)
    assert (page.width, page.height) == pytest.approx(np.array(points) * 25.4 / 72, abs=1e-3)


@pytest.mark.parametrize(
    ("crs", "scale", "metres"),
    [
        ("EPSG:32616", 500, 1.0),
        ("EPSG:2274", 500, 1200 / 3937),  # US survey feet
        ("EPSG:2231", '1" = 40 ft', 1200 / 3937),
        ("EPSG:2222", "1 in = 40'", 0.3048),  # international feet
    ],
)
def test_scales_hold_in_metres_and_in_both_feet(crs, scale, metres, tmp_path):
    from pyproj import Transformer

    area = ts.CRS(crs).area_of_use
    middle = ((area.west + area.east) / 2, (area.south + area.north) / 2)
    x, y = Transformer.from_crs(4326, crs, always_xy=True).transform(*middle)
    size = 100.0 / metres
    tin = ts.triangulate(
        [[x, y, 5], [x + size, y, 6], [x + size, y + size, 8], [x, y + size, 9]], crs=crs
    )
    made = ts.plan(tin, scale=scale, paper="A2")
    (file,) = made.save(tmp_path / "plan.svg")
    page = read_svg(file)
    (ring,) = page.paths["outline"]
    wide, high = np.ptp(ring, axis=0)
    expected = 200.0 if scale == 500 else size / 40 * 25.4  # 40 feet of the CRS are an inch
    assert (wide, high) == pytest.approx((expected, expected), rel=1e-6)
    assert made.scale == pytest.approx(1000 * 100.0 / expected)
    factor = georeference(page).units_per_mm
    assert factor == pytest.approx((size / expected, size / expected), rel=1e-5)


def test_a_foot_crs_has_scales_of_feet_to_the_inch():
    tin = ts.triangulate([[2e6, 5e5, 5], [2e6 + 500, 5e5, 6], [2e6, 5e5 + 300, 8]], crs="EPSG:2274")
    assert ts.plan(tin, paper="ANSI B").scale_text == "1\" = 40'  (1:480)"
