"""The fraction done that long calls tell, and what it must not change."""

from itertools import pairwise

import numpy as np
import pytest

import tinsmith as ts
from tinsmith._progress import Progress

N_POINTS = 40_000


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(7)
    xy = rng.random((N_POINTS, 2)) * 1000
    return np.column_stack([xy, np.sin(xy[:, 0] / 90) * 9 + xy[:, 1] / 50])


@pytest.fixture(scope="module")
def tins(points):
    return ts.triangulate(points), ts.triangulate(points[::3] + np.array([3, 5, 0.5]))


RING = [[100, 100], [900, 100], [900, 900], [100, 900]]
LINE = [[200, 150], [500, 600], [700, 800]]
GRID = {"spacing": 1.0, "threads": 2}

# What is called with the points, two TINs and progress; the least number of fractions told.
CALLS = {
    "triangulate": (lambda p, _, **to: ts.triangulate(p, threads=1, **to), 6),
    "triangulate, two threads": (lambda p, _, **to: ts.triangulate(p, threads=2, **to), 2),
    "triangulate, lines": (
        lambda p, _, **to: ts.triangulate(p, boundary=[RING], breaklines=[LINE], **to),
        4,
    ),
    "triangulate, snapped": (lambda p, _, **to: ts.triangulate(p, snap=0.5, **to), 2),
    "rasterize": (lambda _, tins, **to: ts.rasterize(tins[0], **GRID, **to), 5),
    "rasterize, means": (lambda _, tins, **to: ts.rasterize(tins[0], **GRID, at="mean", **to), 5),
    "rasterize, natural": (
        lambda _, tins, **to: ts.rasterize(tins[0], spacing=9, method="natural", **to),
        1,
    ),
    "rasterize, lazy": (lambda _, tins, **to: ts.rasterize(tins[0], spacing=5, lazy=True, **to), 1),
    "contours": (lambda _, tins, **to: ts.contours(tins[0], 1.0, **to), 3),
    "contours, smooth": (lambda _, tins, **to: ts.contours(tins[0], 5.0, smooth=0.2, **to), 4),
    "volume": (lambda _, tins, **to: ts.volume(*tins, threads=1, **to), 10),
    "volume, regions": (lambda _, tins, **to: ts.volume(*tins, regions=[RING], **to), 3),
    "volume, level": (lambda _, tins, **to: ts.volume(tins[0], base=5.0, **to), 1),
    "difference": (lambda _, tins, **to: ts.difference(tins[1], tins[1], **to), 4),
}


def list_arrays(made):
    """Return all arrays of a result."""
    if isinstance(made, ts.TIN):
        return [made.points, made.triangles, made.neighbors, made.vertex_of]
    if isinstance(made, ts.Survey):
        return [made.points, *made.attributes.values()]
    if isinstance(made, ts.Difference):
        return [*list_arrays(made.tin), np.array([made.cut, made.fill])]
    if isinstance(made, ts.Raster):
        return [band[:, :] for band in made.bands.values()]
    if isinstance(made, ts.Features):
        return [made.coordinates, *made.columns.values()]
    return [made[name] for name in made.columns]


def assert_same(one, other):
    for a, b in zip(list_arrays(one), list_arrays(other), strict=True):
        np.testing.assert_array_equal(a, b)


def assert_ascends(fractions):
    assert fractions[-1] == 1.0
    assert all(0.0 < a < b for a, b in pairwise(fractions))


@pytest.mark.parametrize("name", CALLS)
def test_fractions_ascend_to_one_and_change_nothing(name, points, tins):
    call, least = CALLS[name]
    fractions = []
    told = call(points, tins, progress=fractions.append)
    assert_ascends(fractions)
    assert len(fractions) >= least
    assert_same(told, call(points, tins))


class Enough(Exception):
    """What a caller raises to end a call."""


@pytest.mark.parametrize("after", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("name", CALLS)
def test_what_it_raises_ends_the_call(name, after, points, tins):
    before = [array.copy() for tin in tins for array in list_arrays(tin)]
    fractions = []

    def stop(fraction):
        fractions.append(fraction)
        if fraction >= after:
            raise Enough

    with pytest.raises(Enough):
        CALLS[name][0](points, tins, progress=stop)
    assert sum(fraction >= after for fraction in fractions) == 1, "told after it had raised"
    for a, b in zip(before, (x for tin in tins for x in list_arrays(tin)), strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("wrong", [1, "yes", True, [print]])
@pytest.mark.parametrize("name", CALLS)
def test_what_cannot_be_called_is_refused(name, wrong, points, tins):
    with pytest.raises(ts.OptionError, match=r"Invalid progress .* it must be a function"):
        CALLS[name][0](points, tins, progress=wrong)


def test_calls_within_the_function_are_allowed(points):
    inner = []

    def build(fraction):
        inner.append(ts.triangulate(points[:2000], threads=1))

    tin = ts.triangulate(points, threads=2, progress=build)
    assert tin == ts.triangulate(points)
    assert all(one == inner[0] for one in inner)


# ------------------------------------------------------------------------- reading


@pytest.fixture(scope="module")
def tiles(tmp_path_factory, points):
    pytest.importorskip("laspy")
    folder = tmp_path_factory.mktemp("tiles")
    paths = []
    for number, part in enumerate(np.array_split(points, 2)):
        survey = ts.Survey(points=part.round(2), crs=ts.CRS.of("EPSG:32616"))
        paths.append(ts.write(survey, folder / f"{number}.las"))
    return paths


@pytest.mark.parametrize("options", [{}, {"every": 7}, {"window": (0, 0, 500, 500)}])
def test_lidar_is_read_with_fractions(tiles, options):
    fractions = []
    told = ts.read(tiles[0].parent, progress=fractions.append, **options)
    assert_ascends(fractions)
    assert len(fractions) >= 2
    assert fractions[0] == pytest.approx(0.5)
    assert_same(told, ts.read(tiles[0].parent, **options))


def test_reading_ends_when_it_is_told_to(tiles):
    def stop(fraction):
        raise Enough

    with pytest.raises(Enough):
        ts.read(tiles, progress=stop)
    assert len(ts.read(tiles)) == N_POINTS


@pytest.mark.parametrize("count", [1, 3])
def test_other_formats_tell_file_by_file(tmp_path, points, count):
    paths = [
        ts.write(ts.Survey(points=points[k : k + 50]), tmp_path / f"{k}.csv") for k in range(count)
    ]
    fractions = []
    ts.read(paths, crs="EPSG:32616", progress=fractions.append)
    assert fractions == pytest.approx([(k + 1) / count for k in range(count)])
    assert_ascends(fractions)


def test_reading_refuses_what_cannot_be_called(tiles):
    with pytest.raises(ts.OptionError, match="Invalid progress 7"):
        ts.read(tiles[0], progress=7)


# -------------------------------------------------------------------------- stages


def test_stages_tell_only_what_is_more():
    seen = []
    done = Progress(seen.append)
    first, second = done.stage(0.0, 0.5), done.stage(0.5, 1.0)
    for fraction in (0.0, 0.5, 0.4, 1.0):
        first(fraction)
    for fraction in (0.0, 0.5, 1.0):
        second(fraction)
    done(0.3)
    done.end()
    assert seen == [0.25, 0.5, 0.75, 1.0]


def test_nobody_listens():
    done = Progress(None)
    assert done.stage(0.0, 1.0) is None
    done(0.5)
    done.end()
