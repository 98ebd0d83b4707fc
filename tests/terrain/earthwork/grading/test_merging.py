"""Merged surfaces: priority, strips in which elevations are means, steps and gaps that are told."""

import re

import numpy as np
import pytest

import tinsmith as ts

UTM = np.array([500_000.0, 4_000_000.0])


def make_sheet(west, seed, z=0.0, *, width=100.0, n=500, **options):
    """Return random ground of 80 m north to south, with corners, raised by ``z``."""
    rng = np.random.default_rng(seed)
    xy = rng.random((n, 2)) * [width, 80] + [west, 0]
    corners = np.add([[0, 0], [width, 0], [width, 80], [0, 80]], [west, 0])
    xy = np.concatenate([xy, corners])
    heights = 100 + z + 3 * np.sin(xy[:, 0] / 9) + 2 * np.cos(xy[:, 1] / 11)
    survey = ts.Survey(
        points=np.column_stack([xy + UTM, heights]), attributes={"sheet": np.full(len(xy), seed)}
    )
    return ts.triangulate(survey, crs="EPSG:32616", elevation_unit="m", **options)


def places(n=20_000, width=170.0):
    return np.random.default_rng(5).random((n, 2)) * [width, 80] + UTM


@pytest.mark.parametrize("blend", [0.0, 6.0])
def test_each_surface_is_where_it_has_priority(blend):
    west, east = make_sheet(0, 1, 0.4), make_sheet(70, 2)
    merged = ts.merge([west, east], blend=blend)
    assert ts.check(merged).ok
    assert merged.area == pytest.approx(170 * 80)
    xy = places()
    x = xy[:, 0] - UTM[0]
    new, upper, lower = (tin.interpolate(xy) for tin in (merged, west, east))
    is_upper = x < 100 - blend - 1e-6
    assert np.abs(new - upper)[is_upper].max() < 1e-7
    if blend:
        in_the_middle = (x > 100 + 1e-6) & (np.abs(xy[:, 1] - UTM[1] - 40) < 30)
        assert np.abs(new - lower)[in_the_middle].max() < 1e-7
    else:
        cut = east.points[east.triangles][:, :, 0].min(axis=1) < UTM[0] + 100
        beyond = (x > 100) & ~cut[east.locate(xy)]
        assert np.abs(new - lower)[beyond].max() < 1e-7


def test_in_the_strip_vertices_have_the_weighted_mean():
    west, east = make_sheet(0, 1, 0.4), make_sheet(70, 2)
    merged = ts.merge([west, east], blend=12.0)
    given = {tuple(xy) for tin in (west, east) for xy in tin.points[:, :2].tolist()}
    is_given = np.array([tuple(xy) in given for xy in merged.points[:, :2].tolist()])
    points = merged.points[is_given]
    far = UTM[0] + 100 - points[:, 0]
    in_strip = (far > 0) & (far < 12) & (np.abs(points[:, 1] - UTM[1] - 40) < 40)
    points, share = points[in_strip], far[in_strip] / 12
    assert len(points) > 50
    sheets = merged.attributes["sheet"][is_given][in_strip]
    assert set(sheets.tolist()) == {1.0, 2.0}
    wanted = share * west.interpolate(points[:, :2])
    wanted += (1 - share) * east.interpolate(points[:, :2])
    assert np.abs(points[:, 2] - wanted).max() < 1e-9


def test_the_steps_along_the_seam_are_told():
    x, y = np.meshgrid([0.0, 10, 20], [0.0, 10])
    lower = ts.triangulate(np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]))
    ring = [[0, 0, 1.0], [10, 0, 1.0], [10, 10, 3.0], [0, 10, 3.0]]
    told = ts.merge([ts.triangulate(ring), lower]).report.notes[-1]
    assert told == (
        "Surface 1 lies over 100 square units of those after it; along the seam they differ by 2 "
        "on average, 3 at most, at 10 10."
    )
    ring = [[0, 0, -1.0], [10, 0, -1.0], [10, 10, 3.0], [0, 10, 3.0]]
    told = ts.merge([ts.triangulate(ring), lower], blend=4).report.notes[-1]
    assert "by 1.25 on average, 3 at most, at 10 10; blended over 4." in told  # by the sign


def test_the_first_of_several_counts():
    sheets = [make_sheet(0, 1, 0.5), make_sheet(70, 2), make_sheet(40, 3, -0.5, width=60)]
    merged = ts.merge(sheets, blend=3.0)
    assert ts.check(merged).ok
    rest = ts.merge([sheets[0], ts.merge(sheets[1:], blend=3.0)], blend=3.0)
    np.testing.assert_array_equal(merged.points, rest.points)
    np.testing.assert_array_equal(merged.triangles, rest.triangles)
    assert [note.split(" lies")[0] for note in merged.report.notes] == ["Surface 1", "Surface 2"]


def test_neighbours_are_joined_and_gaps_are_told():
    frame = make_sheet(0, 1, holes=[np.array([[20, 20], [60, 20], [60, 60], [20, 60]]) + UTM])
    inner = ts.triangulate(
        np.column_stack([np.array([[20, 20], [60, 20], [60, 55], [20, 55]]) + UTM, np.full(4, 99)]),
        crs="EPSG:32616",
        elevation_unit="m",
    )
    merged = ts.merge([inner, frame])
    assert merged.area == pytest.approx(80 * 100 - 40 * 5)
    assert "lies over none of those after it" in merged.report.notes[-1]
    sides = [
        ts.triangulate(np.column_stack([np.array(ring) + UTM, np.zeros(len(ring))]))
        for ring in (
            [[0, 0], [30, 0], [30, 10], [0, 10]],
            [[0, 20], [30, 20], [30, 30], [0, 30]],
            [[0, 10], [10, 10], [10, 20], [0, 20]],
            [[20, 10], [30, 10], [30, 20], [20, 20]],
        )
    ]
    merged = ts.merge(sides)
    assert merged.area == pytest.approx(800)
    told = merged.report.notes[-1]
    assert told.startswith("1 gap between the surfaces, 100 square units, is left")
    apart = ts.merge([sides[0], sides[1]]).report.notes[-1]
    assert apart == "The surfaces do not all touch: there are 2 parts."


def test_lines_stay_up_to_the_seam():
    def line(west, east, name):
        ends = np.column_stack([np.add(UTM, [[west, 40], [east, 40]]), [101, 101]])
        return ts.Breakline(ends, name=name)

    west = make_sheet(0, 1, breaklines=[line(5, 95, "kerb")])
    east = make_sheet(70, 2, breaklines=[line(75, 165, "ditch")])
    merged = ts.merge([west, east], blend=6.0)
    lengths = dict.fromkeys(merged.lines.names, 0.0)
    for chain, name in zip(merged.lines.chains(), merged.lines.names, strict=True):
        lengths[name] += np.hypot(*np.diff(merged.points[chain, :2], axis=0).T).sum()
    assert lengths["kerb"] == pytest.approx(90)
    assert lengths["ditch"] == pytest.approx(65)
    assert lengths["seam"] > 80


def test_elevations_come_in_the_unit_of_the_first():
    west, east = make_sheet(0, 1), make_sheet(70, 2)
    in_feet = east.replace(points=east.points / [1, 1, 0.3048], elevation_unit="ft")
    merged = ts.merge([west, in_feet], blend=5.0)
    wanted = ts.merge([west, east], blend=5.0)
    np.testing.assert_allclose(merged.points, wanted.points, atol=1e-9)
    assert any(re.search(r"surface 2 were converted", note) for note in merged.report.notes)


def test_refusals():
    west, east = make_sheet(0, 1, n=30), make_sheet(70, 2, n=30)
    with pytest.raises(ts.OptionError, match="number of surfaces 1"):
        ts.merge([west])
    with pytest.raises(ts.OptionError, match="surfaces"):
        ts.merge(west)
    with pytest.raises(ts.OptionError, match="blend"):
        ts.merge([west, east], blend=-1)
    with pytest.raises(ts.CrsError):
        ts.merge([west, east.replace(crs="EPSG:32617")])
    degrees = ts.triangulate([[7, 50, 1], [7.1, 50, 1], [7, 50.1, 1]], crs="EPSG:4326")
    with pytest.raises(ts.CrsError, match="angles"):
        ts.merge([degrees, degrees], blend=1.0)
