"""Surfaces in CRSs whose axes point west and south, compared with their twins east and north.

EPSG:5514 is EPSG:5513 with axes to the east and north; for Lo19 the twin is the same projection
without turned axes. So both have the same surface at coordinates that differ by sign and order.
"""

import json
import re

import numpy as np
import pytest
from pyproj import Transformer

import tinsmith as ts
from tinsmith.base.georeference.axes import find_axes
from tinsmith.terrain.viewer.html_repr import draw_map

LO19 = "+proj=tmerc +lat_0=0 +lon_0=19 +k=1 +x_0=0 +y_0=0 +ellps=WGS84 +units=m +type=crs"
TWINS = {
    "EPSG:2048": (LO19, (-52_000.0, -3_760_000.0)),
    "EPSG:5513": ("EPSG:5514", (-743_000.0, -1_043_000.0)),
}
EXCHANGE = {
    "EPSG:2048": lambda e, n: (-e, -n),  # westing, southing
    "EPSG:5513": lambda e, n: (-n, -e),  # southing, westing
}


@pytest.fixture(params=TWINS)
def twins(request, rng):
    """Return a TIN in a CRS to the west and south, and the same one to the east and north."""
    code = request.param
    twin, (east, north) = TWINS[code]
    e = east + np.append([0, 300, 0, 300], rng.integers(0, 300, 60)).astype(float)
    n = north + np.append([0, 0, 200, 200], rng.integers(0, 200, 60)).astype(float)
    z = 100 + 0.05 * (e - east) + 6 * np.sin((n - north) / 40) + rng.random(64)
    usual = ts.triangulate(np.column_stack([e, n, z]), crs=twin, elevation_unit="m")
    points = np.column_stack([*EXCHANGE[code](*usual.points[:, :2].T), usual.points[:, 2]])
    turned = ts.TIN.from_triangles(points, usual.triangles, crs=code, elevation_unit="m")
    return turned, usual


@pytest.fixture
def rng():
    return np.random.default_rng(27)


def _sort_polygons(features):
    return features.columns["area"].round(6).tolist(), features.columns["label"].tolist()


@pytest.mark.parametrize("code", TWINS)
def test_the_twin_is_the_same_ground(code):
    twin, (east, north) = TWINS[code]
    longitude, latitude = Transformer.from_crs(twin, 4326, always_xy=True).transform(east, north)
    found = Transformer.from_crs(4326, code, always_xy=True).transform(longitude, latitude)
    assert np.allclose(found, EXCHANGE[code](east, north), atol=1.5)  # datums differ by little


@pytest.mark.parametrize(
    ("code", "axes"),
    [
        ("EPSG:32616", ("east", "north")),
        ("EPSG:3844", ("east", "north")),  # told north first, handed over east first
        ("EPSG:2048", ("west", "south")),
        ("EPSG:29371", ("west", "south")),
        ("EPSG:5513", ("south", "west")),
        ("EPSG:2065", ("south", "west")),
        ("EPSG:3052", ("west", "north")),
        ("EPSG:2218", ("north", "west")),
        ("EPSG:3031", ("east", "north")),  # around the pole
        ("EPSG:4326", ("east", "north")),
        ("EPSG:2048+5773", ("west", "south")),
    ],
)
def test_axes_of_a_crs(code, axes):
    assert find_axes(ts.CRS(code)) == axes


def test_aspects_are_clockwise_from_north(twins):
    turned, usual = twins
    assert np.allclose(ts.aspect(turned), ts.aspect(usual))
    assert np.allclose(ts.aspect(turned, per="vertex"), ts.aspect(usual, per="vertex"))
    assert np.allclose(ts.slope(turned), ts.slope(usual))
    pairs = (sorted(zip(*_sort_polygons(ts.aspect_classes(one)), strict=True)) for one in twins)
    assert next(pairs) == next(pairs)


@pytest.mark.parametrize("value", ["aspect", "hillshade", "slope"])
@pytest.mark.parametrize("smooth", [True, False])
def test_rasters_of_relief_are_the_same_at_the_same_places(twins, value, smooth):
    turned, usual = (
        ts.rasterize(one, spacing=10.0, value=value, smooth=smooth, azimuth=300.0) for one in twins
    )
    crs = str(twins[0].crs)
    bands = [np.asarray(next(iter(one.bands.values()))[:, :], float) for one in (turned, usual)]
    expected = bands[1][::-1, ::-1] if crs == "EPSG:2048" else bands[1].T
    assert bands[0].shape == expected.shape
    assert np.isfinite(expected).sum() > 200
    assert np.allclose(bands[0], expected, equal_nan=True, atol=1e-9)


def test_hillshades_are_lit_from_the_same_side(twins):
    turned, usual = (ts.hillshade(one, spacing=10.0) for one in twins)
    cells = usual.bands["hillshade"]
    is_turned = str(twins[0].crs) == "EPSG:2048"
    expected = cells[::-1, ::-1] if is_turned else cells.T
    assert np.array_equal(turned.bands["hillshade"], expected)


def test_cards_show_north_up(twins):
    turned, usual = (draw_map(one).astype(int) for one in twins)
    assert turned.shape == usual.shape
    assert np.abs(turned - usual).max() <= 1
    cards = [one._repr_html_() for one in twins]
    assert "Westing" in cards[0]
    assert "Easting" in cards[1]
    assert "Westing" not in cards[1]


def test_cards_of_features_and_rasters_show_north_up(twins):
    def picture(shown):
        return re.search(r'base64,([^"]+)', shown._repr_html_()).group(1)

    rasters = [ts.rasterize(one, spacing=10.0) for one in twins]
    assert picture(rasters[0]) == picture(rasters[1])
    surveys = [ts.Survey(points=one.points, crs=one.crs) for one in twins]
    assert picture(surveys[0]) == picture(surveys[1])
    lines = ts.contours(twins[0], interval=1.0)
    twin = ts.Features.of_lines(
        _to_twin(lines.coordinates, twins[0].crs), lines.offsets[0], crs=twins[1].crs
    )
    assert picture(lines) == picture(twin)


def _to_twin(places, crs):
    """Return places of a CRS in those of its twin; the exchange undoes itself."""
    first, second = EXCHANGE[str(crs)](places[:, 0], places[:, 1])
    return np.column_stack([first, second, places[:, 2:]])


def test_a_page_shows_north_up(twins):
    turned, usual = (_read_page(one) for one in twins)
    for part in ("origin", "scale", "elevations", "exaggeration", "relief"):
        assert turned[part] == usual[part], part
    assert _list_corners(turned) == _list_corners(usual)
    assert turned["axes"] != usual["axes"]
    assert usual["axes"] == [["Easting", 1.0], ["Northing", 1.0]]
    assert turned["axes"] == [["Westing", -1.0], ["Southing", -1.0]]


def _read_page(tin):
    page = ts.preview(tin).to_html()
    return json.loads(re.search(r'id="terrain"[^>]*>(.*?)</script>', page, re.S).group(1))


def _list_corners(page):
    surface = page["surfaces"][0]
    return surface["vertices"]


def test_sections_tell_left_from_right(twins):
    turned, usual = twins
    low, high = usual.points.min(axis=0), usual.points.max(axis=0)
    middle = (low + high)[:2] / 2
    line = middle + np.array([[-60.0, -20.0], [70.0, 30.0]])
    other = np.column_stack(EXCHANGE[str(turned.crs)](*line.T))
    expected = ts.cross_sections(usual, line, interval=40.0, left=20.0, right=50.0)
    found = ts.cross_sections(turned, other, interval=40.0, left=20.0, right=50.0)
    assert len(expected) > 20
    assert np.allclose(found["offset"], expected["offset"], atol=1e-6)
    assert np.allclose(found["elevation"], expected["elevation"], atol=1e-6)


def test_plans_have_north_up_and_are_labelled_in_the_crs(twins, tmp_path):
    sheets, frames = [], []
    for name, tin in zip(("turned", "usual"), twins, strict=True):
        made = ts.plan(tin, scale=2500, paper="A4", title="Yard", grid="lines", ground_unit=None)
        made.save(tmp_path / f"{name}.svg")
        sheets.append((tmp_path / f"{name}.svg").read_text())
        frames.append(made.frames)
    drawn = [_list_groups(sheet) for sheet in sheets]
    assert drawn[0].keys() == drawn[1].keys()
    for group in ("contour-lines", "north-arrow", "frame", "outline", "grid-lines"):
        assert drawn[0].get(group) == drawn[1].get(group), group
    assert any(re.search(r">\d+ W<", sheet) for sheet in sheets[:1])
    assert re.search(r">\d+ S<", sheets[0])
    assert re.search(r">-\d+ E<", sheets[1])
    corners = frames[0][0]
    assert np.allclose(np.column_stack(EXCHANGE[str(twins[0].crs)](*corners.T)), frames[1][0])


def _list_groups(sheet):
    """Return the paths of each named group of an SVG."""
    found = re.findall(r'<g id="([a-z-]+)">(.*?)</g>', sheet, re.S)
    return {name: re.findall(r' d="([^"]*)"', content) for name, content in found}


@pytest.mark.parametrize("kind", ["contours", "bands", "relief", "blunders", "earthwork"])
def test_maps_have_north_up_and_are_labelled_in_the_crs(twins, kind):
    turned, usual = (_draw(one, kind) for one in twins)
    axes = turned.axes[0], usual.axes[0]
    assert np.allclose(axes[0].get_xlim(), axes[1].get_xlim())
    assert np.allclose(axes[0].get_ylim(), axes[1].get_ylim())
    assert axes[0].get_xlabel().startswith("westing")
    assert axes[0].get_ylabel().startswith("southing")
    assert axes[1].get_xlabel().startswith("easting")
    labels = [
        [float(one.get_text().replace("\N{MINUS SIGN}", "-")) for one in ax.get_xticklabels()]
        for ax in axes
    ]
    assert labels[0] == [-value for value in labels[1]]
    images = [np.ma.filled(ax.images[0].get_array().astype(float), -1) for ax in axes]
    assert images[0].shape == images[1].shape
    assert np.mean(np.abs(images[0] - images[1]) > 1) < 0.002  # cells on edges


def _list_labels(axes):
    texts = [label.get_text() for label in axes.get_xticklabels()]
    return [float(text.replace("\N{MINUS SIGN}", "-")) for text in texts]


def _draw(tin, kind):
    if kind == "contours":
        return ts.contour_map(tin, ts.contours(tin, interval=1.0))
    if kind == "bands":
        return ts.contour_map(tin, bands=ts.contour_bands(tin, interval=1.0))
    if kind == "relief":
        return ts.relief_map(tin, ts.aspect_classes(tin))
    if kind == "blunders":
        return ts.blunder_map(tin, ts.blunders(tin))
    higher = tin.points + np.array([0.0, 0.0, 1.0])
    other = ts.TIN.from_triangles(higher, tin.triangles, crs=tin.crs, elevation_unit="m")
    return ts.earthwork_map(ts.difference(tin, other), ground=tin)


def test_usual_axes_leave_a_surface_as_it_is():
    from tinsmith.terrain.drawing.north_up import draw_north_up

    tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
    assert draw_north_up(tin) is tin
    assert draw_north_up(None) is None
