"""Flats of contours: found, mended nearer to the truth, and never beyond a contour."""

import numpy as np
import pytest
import shapely
from contourpy import contour_generator

import tinsmith as ts
from tinsmith.terrain.inspection.flat_triangles.regions import KINDS, find_regions

SIDE = 60.0


def neck(x, y):
    """Two hills with a saddle between them."""
    hills = [np.exp(-((x - at) ** 2 + y**2) / 500.0) for at in (-25.0, 25.0)]
    return 100 + 30 * (hills[0] + hills[1])


GROUNDS = {
    "cone": lambda x, y: 95 - np.hypot(x, y),
    "pit": lambda x, y: 105 + np.hypot(x, y),
    "dome": lambda x, y: 100 - (x**2 + y**2) / 60,
    "ridge": lambda x, y: 100 + 0.5 * x - np.abs(y - 0.37),
    "valley": lambda x, y: 100 + 0.5 * x + np.abs(y - 0.37),
    "neck": neck,
}
INTERVAL = 10.0


def contours(ground, interval=INTERVAL):
    """Return contours of a function, by another program, as lines of (k, 3)."""
    axis = np.linspace(-SIDE, SIDE, 81)
    x, y = np.meshgrid(axis, axis)
    z = ground(x, y)
    tracer = contour_generator(x, y, z)
    lines = []
    for level in np.arange(np.ceil(z.min() / interval), np.ceil(z.max() / interval)) * interval:
        for line in tracer.lines(level):
            kept = np.vstack([line[:-1:2], line[-1:]])
            if len(kept) > 3:
                lines.append(np.column_stack([kept, np.full(len(kept), level)]))
    return lines


def build(lines):
    return ts.triangulate(ts.Survey(points=np.concatenate(lines), breaklines=lines))


def find_errors(ground, tin):
    places = np.random.default_rng(1).uniform(-SIDE * 0.95, SIDE * 0.95, (5000, 2))
    z = tin.interpolate(places)
    return (z - ground(*places.T))[~np.isnan(z)]


def are_flat(tin):
    z = tin.points[tin.triangles, 2]
    return (z == z[:, :1]).all(axis=1)


@pytest.mark.parametrize("name", GROUNDS)
def test_the_mended_surface_is_nearer_to_the_truth(name):
    tin = build(contours(GROUNDS[name]))
    mended = ts.mend_flats(tin)
    before, after = (
        np.sqrt(np.mean(find_errors(GROUNDS[name], one) ** 2)) for one in (tin, mended)
    )
    assert are_flat(tin).sum() > 10
    left = mended.triangle_areas[are_flat(mended)]
    assert left.sum() < 1e-9 * tin.area  # beside straight contours, between their roundings
    assert after < 0.9 * before
    assert ts.check(mended, level=3).ok


@pytest.mark.parametrize("name", GROUNDS)
def test_added_points_lie_between_two_contours_and_are_marked(name):
    tin = build(contours(GROUNDS[name]))
    mended = ts.mend_flats(tin)
    added = mended.attributes["origin"] == "added"
    assert np.array_equal(mended.points[~added], tin.points)
    steps = mended.points[added, 2] / INTERVAL
    assert (np.abs(steps - np.rint(steps)) > 0).all()
    span = np.ptp(mended.points[mended.triangles, 2], axis=1)
    assert span.max() <= max(INTERVAL, np.ptp(tin.points[tin.triangles, 2], axis=1).max())
    assert_no_contour_is_crossed(tin, mended)
    assert f"{added.sum():,} points were added" in mended.report.notes[-1]
    left = are_flat(mended).sum()
    assert mended.report.notes[-1].endswith(
        f"{left} flat triangle{' is' if left == 1 else 's are'} left."
    )


def assert_no_contour_is_crossed(tin, mended):
    """Around an added point all that was given is at the contour below it, or the one above."""
    added = mended.attributes["origin"] == "added"
    for start, end in mended.edges[added[mended.edges].any(axis=1)].tolist():
        low = np.floor(mended.points[start if added[start] else end, 2] / INTERVAL) * INTERVAL
        z = mended.points[[start, end], 2]
        assert low <= z.min() <= z.max() <= low + INTERVAL


@pytest.mark.parametrize(
    ("name", "landform"),
    [("cone", "peak"), ("pit", "pit"), ("ridge", "ridge"), ("valley", "valley")],
)
def test_landforms_are_named(name, landform):
    tin = build(contours(GROUNDS[name]))
    found = ts.flats(tin)
    assert landform in found.columns["landform"].tolist()
    shapes = found.to_shapely()
    assert shapely.is_valid(shapes).all()
    assert shapely.area(shapes) == pytest.approx(found.columns["area"])
    is_flat = are_flat(tin)
    assert found.columns["triangles"].sum() == is_flat.sum()
    assert found.columns["area"].sum() == pytest.approx(tin.triangle_areas[is_flat].sum())


def test_a_peak_goes_on_with_the_slope_around_it():
    tin = build(contours(GROUNDS["cone"]))
    mended = ts.mend_flats(tin)
    top = mended.points[:, 2].max()
    assert 92 < top < 95  # the cone's tip is at 95, the highest contour at 90, the next at 100


def test_a_ridge_rises_straight_to_the_next_contour():
    tin = build(contours(GROUNDS["ridge"]))
    mended = ts.mend_flats(tin)
    axis = np.column_stack([np.linspace(-35, 35, 200), np.full(200, 0.37)])
    error = mended.interpolate(axis) - GROUNDS["ridge"](*axis.T)
    assert np.abs(error).max() < 1.0
    assert np.abs(tin.interpolate(axis) - GROUNDS["ridge"](*axis.T)).max() > 4.0


def test_nothing_is_mended_where_the_contours_do_not_tell():
    """Of points without lines nobody knows which edges are contours."""
    lines = contours(GROUNDS["ridge"])
    tin = ts.triangulate(np.concatenate(lines))
    unclear = ts.flats(tin)
    assert set(unclear.columns["landform"].tolist()) == {"unclear"}
    mended = ts.mend_flats(tin)
    assert are_flat(mended).sum() == are_flat(tin).sum()
    assert not (mended.attributes["origin"] == "added").any()


def test_water_is_no_flat_to_mend():
    ring = [[0, 0], [10, 0], [10, 10], [0, 10]]
    points = [[-9, -9, 3], [19, -9, 4], [19, 19, 5], [-9, 19, 6]]
    tin = ts.triangulate(points, water=[ts.Water(ring, 1.0)])
    assert are_flat(tin).any()
    assert len(ts.flats(tin)) == 0
    assert len(ts.mend_flats(tin).points) == len(tin.points)


def test_marks_of_the_survey_and_of_earlier_points_stay():
    lines = contours(GROUNDS["neck"])
    points = np.concatenate(lines)
    columns = {"origin": np.array(["map 7"] * len(points))}
    survey = ts.Survey(points=points, breaklines=lines, attributes=columns)
    mended = ts.mend_flats(ts.triangulate(survey))
    assert set(mended.row_attributes["origin"].tolist()) == {"map 7"}
    added = mended.attributes["origin_"] == "added"
    again = ts.mend_flats(mended)
    assert (again.attributes["origin_"] == "added").sum() >= added.sum() > 0


def test_a_surface_without_flats_stays_as_it_is():
    tin = ts.triangulate(np.random.default_rng(1).random((50, 3)))
    assert len(ts.flats(tin)) == 0
    mended = ts.mend_flats(tin)
    assert np.array_equal(mended.points, tin.points)
    assert not (mended.attributes["origin"] == "added").any()


def test_the_order_of_lines_changes_nothing():
    lines = contours(GROUNDS["neck"])
    one = ts.mend_flats(build(lines))
    other = ts.mend_flats(build(lines[::-1]))
    sets = [{tuple(point) for point in np.round(tin.points, 9).tolist()} for tin in (one, other)]
    assert sets[0] == sets[1]


@pytest.mark.parametrize("function", [ts.flats, ts.mend_flats])
def test_what_is_no_tin_is_refused(function):
    with pytest.raises(ts.PointsError, match="Invalid TIN"):
        function([[0, 0, 1]])


def test_a_cap_rises_to_the_next_level_although_the_contour_around_it_is_missing():
    """Of two hills one lacks the contour below its highest: the other one tells the interval."""
    angles = np.linspace(0, 2 * np.pi, 25)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    circle[-1] = circle[0]
    lines = [
        np.column_stack([circle * (45 - level) + (east, 0), np.full(25, level)])
        for east in (0, 100)
        for level in (10.0, 20.0, 30.0)
        if (east, level) != (100, 20.0)
    ]
    found = find_regions(build(lines))
    is_peak = found.kinds == KINDS.index("peak")
    assert is_peak.sum() == 2
    assert (found.rises[is_peak] == 10.0).all()
