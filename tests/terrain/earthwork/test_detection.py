"""The level of detection: volumes beyond it, zones and lines at it; against closed forms."""

from __future__ import annotations

from statistics import NormalDist

import numpy as np
import pytest

import tinsmith as ts

UTM = np.array([752_640.0, 4_024_180.0, 320.0])
Z95 = NormalDist().inv_cdf(0.975)


def square(elevations, *, side=4.0, origin=(0.0, 0.0, 0.0), **columns):
    corners = np.array([[0, 0], [side, 0], [side, side], [0, side]])
    points = np.column_stack([corners, elevations]) + origin
    return ts.triangulate(ts.Survey(points=points, attributes=columns))


def rough(n, seed, *, relief=1.0):
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2)) * 100
    points = np.column_stack([xy, np.sin(xy[:, 0] / 9) + relief * rng.random(n)])
    return ts.triangulate(ts.Survey(points=points, attributes={"sz": 0.02 + 0.2 * rng.random(n)}))


def sums_by_kind(found, column):
    zones = found.zones.columns
    kinds = zones["kind"].astype(str)
    return {
        kind: float(zones[column][kinds == kind].sum()) for kind in ("cut", "fill", "unchanged")
    }


@pytest.mark.parametrize("origin", [np.zeros(3), UTM])
def test_a_ramp_beyond_a_level_of_detection(origin):
    """2 x - 3 over 4 m: beyond 0.5 from x = 0 to 1.25 and from 1.75 on."""
    flat, ramp = square([3, 3, 3, 3], origin=origin), square([0, 8, 8, 0], origin=origin)
    table = ts.volume(flat, ramp, level_of_detection=0.5)
    found = {name: float(table[name][0]) for name in table.columns if "thresh" in name}
    assert found["thresholded_cut"] == pytest.approx(4 * 1.25 * (3 + 0.5) / 2, rel=1e-9)
    assert found["thresholded_fill"] == pytest.approx(4 * 2.25 * (5 + 0.5) / 2, rel=1e-9)
    assert found["thresholded_cut_area"] == pytest.approx(5, rel=1e-9)
    assert found["thresholded_fill_area"] == pytest.approx(9, rel=1e-9)
    assert found["thresholded_net"] == pytest.approx(24.75 - 8.75, rel=1e-9)
    assert table["cut"][0] == pytest.approx(9, rel=1e-9)  # the whole, as without
    difference = ts.difference(flat, ramp, level_of_detection=0.5)
    assert ts.check(difference.tin).ok
    assert sums_by_kind(difference, "area") == pytest.approx(
        {"cut": 5, "fill": 9, "unchanged": 2}, rel=1e-9
    )
    east = difference.zero_line.coordinates[:, 0] - origin[0]
    assert sorted({round(float(x), 6) for x in east}) == [1.25, 1.75]
    assert difference.unchanged.any()


def test_a_plane_below_a_pyramid():
    points = [[-3, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0], [0, 0, 3]]
    table = ts.volume(ts.triangulate(points), base=1.0, level_of_detection=0.5)
    # Above 1.5 a pyramid of half the size, whose cut is from level 1; below 0.5 its frame.
    assert table["thresholded_cut"][0] == pytest.approx(4.5 + 9 * 0.5, rel=1e-9)
    assert table["thresholded_cut_area"][0] == pytest.approx(9, rel=1e-9)
    assert table["thresholded_fill_area"][0] == pytest.approx(36 - 25, rel=1e-9)


@pytest.mark.parametrize("level", [0.1, 0.1 + 0.2])
def test_a_difference_of_just_the_level_is_unchanged(level):
    """5.1 less 5 is more than 0.1 in doubles: that is rounding, no change."""
    flat, above = square([5.0] * 4), square([5.0 + level] * 4)
    table = ts.volume(flat, above, level_of_detection=level)
    assert table["thresholded_fill"][0] == 0.0
    found = ts.difference(flat, above, level_of_detection=level)
    assert found.zones.columns["kind"].tolist() == ["unchanged"]
    assert found.unchanged.all()


def test_errors_and_a_confidence_make_the_level():
    flat, ramp = square([3, 3, 3, 3]), square([0, 8, 8, 0])
    errors = {"standard_error": 0.3, "other_standard_error": 0.4}
    table = ts.volume(flat, ramp, confidence=0.95, **errors)
    assert table["level_of_detection"][0] == pytest.approx(Z95 * 0.5, rel=1e-12)
    known = ts.volume(flat, ramp, level_of_detection=Z95 * 0.5)
    assert table["thresholded_cut"] == pytest.approx(known["thresholded_cut"], rel=1e-12)
    shifted = ts.volume(
        flat, ramp, confidence=0.95, standard_error=ts.ErrorModel(0.3, systematic=0.4)
    )
    assert shifted["level_of_detection"][0] == pytest.approx(Z95 * 0.5, rel=1e-12)


def test_a_level_that_varies_with_the_errors():
    """Errors of 0.1 x over a level 0.5 above: beyond the level up to x = 5 / z."""
    errors = np.array([0.0, 0.4, 0.4, 0.0])
    flat = square([3, 3, 3, 3], sz=errors)
    table = ts.volume(flat, base=3.5, standard_error="sz", confidence=0.95)
    assert table["thresholded_fill_area"][0] == pytest.approx(4 * 5 / Z95, rel=1e-9)
    assert table["level_of_detection"][0] == pytest.approx(0.2 * Z95, rel=1e-9)
    found = ts.difference(flat, base=3.5, standard_error="sz", confidence=0.95)
    assert sums_by_kind(found, "area")["fill"] == pytest.approx(4 * 5 / Z95, rel=1e-9)


OPTIONS = [
    {"level_of_detection": 0.3},
    {"standard_error": 0.1, "other_standard_error": 0.1, "confidence": 0.95},
    {"standard_error": "sz", "other_standard_error": "sz", "confidence": 0.9},
    {"standard_error": "sz", "confidence": 0.68},
]
REGIONS = [None, {"west": [[0, 0], [80, 0], [50, 100]], "hole": [[20, 20], [90, 20], [70, 80]]}]


@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("regions", REGIONS, ids=["whole", "regions"])
def test_zones_are_the_volumes_beyond_the_level(options, regions):
    tin, other = rough(120, 1), rough(100, 2)
    found = ts.difference(tin, other, regions=regions, **options)
    table = ts.volume(tin, other, regions=regions, **options)
    assert ts.check(found.tin).ok
    volumes, areas = sums_by_kind(found, "volume"), sums_by_kind(found, "area")
    for kind in ("cut", "fill"):
        assert volumes[kind] == pytest.approx(table[f"thresholded_{kind}"].sum(), rel=1e-9)
        assert areas[kind] == pytest.approx(table[f"thresholded_{kind}_area"].sum(), rel=1e-9)
    assert sum(volumes.values()) == pytest.approx((table["cut"] + table["fill"]).sum(), rel=1e-9)
    for name in table.columns:
        if name != "region":
            assert found.volumes[name] == pytest.approx(table[name], rel=1e-12), name


def test_cells_of_a_fine_raster_agree():
    """By counting: 2,000 x 2,000 places of which each is beyond the level or not."""
    tin, other = rough(50, 3), rough(40, 4)
    table = ts.volume(tin, other, level_of_detection=0.4)
    x, y = np.meshgrid((np.arange(2000) + 0.5) / 20, (np.arange(2000) + 0.5) / 20)
    places = np.column_stack([x.ravel(), y.ravel()])
    apart = other.interpolate(places) - tin.interpolate(places)
    apart = apart[~np.isnan(apart)]
    filled = apart[apart > 0.4]
    assert table["thresholded_fill"][0] == pytest.approx(filled.sum() / 400, rel=2e-3)
    assert table["thresholded_fill_area"][0] == pytest.approx(len(filled) / 400, rel=2e-3)


def test_noise_below_the_tolerance_leaves_no_lines():
    """A floor surveyed twice, with half a millimetre of noise, beside a heap."""
    rng = np.random.default_rng(5)
    x, y = (a.ravel() for a in np.meshgrid(np.arange(21.0), np.arange(21.0)))
    heap = np.maximum(3 - np.hypot(x - 10, y - 10), 0.0)
    before = ts.triangulate(np.column_stack([x, y, 0.0005 * rng.standard_normal(441)]))
    after = ts.triangulate(np.column_stack([x, y, heap + 0.0005 * rng.standard_normal(441)]))
    assert len(ts.difference(before, after).zero_line) > 20
    found = ts.difference(before, after, level_of_detection=0.005)
    assert len(found.zero_line) == 1
    assert sorted(found.zones.columns["kind"]) == ["fill", "unchanged"]


def test_the_map_tells_errors_and_level():
    tin, other = rough(50, 3), rough(40, 4)
    found = ts.difference(
        tin, other, standard_error=0.1, other_standard_error=0.1, level_of_detection=0.4
    )
    figure = ts.earthwork_map(found)
    first, second = figure.axes[0].get_title(loc="left").split("\n")
    assert "±" in first
    assert second.startswith("Beyond a level of detection of 0.4: cut ")
    unchanged = ts.difference(tin, tin, level_of_detection=0.1)
    assert len(ts.earthwork_map(unchanged).axes) == 1  # without a scale


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"level_of_detection": 0.0}, "a difference > 0 in the unit of elevations"),
        ({"level_of_detection": np.nan}, "a difference > 0"),
        ({"confidence": 1.0, "standard_error": 0.1}, "a probability > 0 and < 1"),
        ({"confidence": 0.95}, "None without a `standard_error`"),
        ({"confidence": 0.9, "level_of_detection": 0.1, "standard_error": 0.1}, "None where"),
    ],
)
@pytest.mark.parametrize("measure", [ts.volume, ts.difference])
def test_what_is_no_level_is_refused(measure, options, sentence):
    with pytest.raises(ts.OptionError, match=sentence):
        measure(rough(10, 1), base=0.5, **options)
