"""The fraction done that long calls tell, and what it must not change."""

from itertools import pairwise

import numpy as np
import pytest
from support.product_arrays import list_arrays

import tinsmith as ts
from tinsmith.base.progress import Progress

N_POINTS = 40_000


@pytest.fixture(scope="module")
def points():
    rng = np.random.default_rng(7)
    xy = rng.random((N_POINTS, 2)) * 1000
    return np.column_stack([xy, np.sin(xy[:, 0] / 90) * 9 + xy[:, 1] / 50])


@pytest.fixture(scope="module")
def tins(points):
    return ts.triangulate(points), ts.triangulate(points[::3] + np.array([3, 5, 0.5]))


@pytest.fixture(scope="module")
def contoured():
    """Contours of a hill with a saddle, with flat triangles in its bends and on its tops."""
    x, y = np.meshgrid(np.arange(0.0, 100.0, 4.0), np.arange(0.0, 100.0, 4.0))
    z = 20 * np.exp(-((x - 30) ** 2 + (y - 40) ** 2) / 500)
    z += 15 * np.exp(-((x - 70) ** 2 + (y - 60) ** 2) / 300)
    lines = ts.contours(ts.triangulate(np.column_stack([x.ravel(), y.ravel(), z.ravel()])), 2.0)
    parts = np.split(lines.coordinates, lines.offsets[1:-1])
    return ts.triangulate(ts.Survey(points=np.concatenate(parts), breaklines=parts))


RING = [[100, 100], [900, 100], [900, 900], [100, 900]]
LINE = [[200, 150], [500, 600], [700, 800]]
GRID = {"spacing": 1.0, "threads": 2}

PAD = [[400, 400], [600, 400], [600, 600], [500, 540], [400, 600]]
EYE = [500, 500]
SLOPES = {"cut_slope": 2, "fill_slope": 3}

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
    "refine": (lambda _, tins, **to: ts.refine(tins[1], max_area=40.0, **to), 6),
    "ground": (lambda p, _, **to: ts.ground(p, cell=2.0, **to), 15),
    "catchments": (lambda _, tins, **to: ts.catchments(cut_corner(tins[1]), **to), 4),
    "flow": (lambda _, tins, **to: ts.flow_accumulation(cut_corner(tins[1]), **to), 4),
    "blunders": (lambda p, _, **to: ts.blunders(ts.Survey(points=p), **to), 5),
    "blunders, TIN": (lambda _, tins, **to: ts.blunders(tins[1], **to), 4),
    "grade": (lambda _, tins, **to: ts.grade(tins[0], PAD, 10.0, **SLOPES, **to), 6),
    "simplify": (lambda _, tins, **to: ts.simplify(tins[1], tolerance=1.0, **to), 4),
    "viewshed": (lambda _, tins, **to: ts.viewshed(cut_corner(tins[1]), EYE, **to), 3),
    "merge": (lambda p, tins, **to: ts.merge([cut_middle(p), *tins[:1]], **to), 1),
    "clip": (lambda _, tins, **to: ts.clip(tins[0], [RING], **to), 5),
    "paste": (lambda p, tins, **to: ts.paste(tins[0], cut_middle(p), **to), 5),
}


def cut_middle(points):
    """Return the TIN of the points in the middle, raised."""
    return ts.triangulate(points[np.abs(points[:, :2] - 500).max(axis=1) < 200] + [0, 0, 2])


def cut_corner(tin):
    """Return the TIN of the first points."""
    return ts.triangulate(tin.points[:2000])


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


@pytest.mark.each_value
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


def test_flats_are_mended_with_fractions(contoured):
    fractions = []
    told = ts.mend_flats(contoured, progress=fractions.append)
    assert_ascends(fractions)
    assert len(fractions) == 4
    assert_same(told, ts.mend_flats(contoured))
    assert len(told.points) > len(contoured.points)


@pytest.mark.each_value
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
def test_other_formats_tell_file_by_file(tmp_path, tins, count):
    survey = ts.Survey(points=tins[1].points[:50], crs=ts.CRS.of("EPSG:32616"))
    paths = [ts.write(survey, tmp_path / f"{k}.gpkg") for k in range(count)]
    fractions = []
    ts.read(paths, progress=fractions.append)
    assert fractions == pytest.approx([(k + 1) / count for k in range(count)])
    assert_ascends(fractions)


def write_rows(path, points, form):
    path.write_text("".join(form.format(i, *row) for i, row in enumerate(points.tolist())))
    return path


@pytest.mark.parametrize(
    ("form", "least"),
    [("{0},{1:.3f},{2:.3f},{3:.3f}\n", 4), ('{0},{1:.3f},{2:.3f},{3:.3f},6" PIPE\n', 20)],
)
def test_text_is_read_with_fractions(tmp_path, points, form, least):
    path = write_rows(tmp_path / "points.csv", points, form)
    fractions = []
    told = ts.read(path, columns="PENZD"[: form.count(",") + 1], progress=fractions.append)
    assert_ascends(fractions)
    assert len(fractions) >= least
    assert len(told) == N_POINTS


@pytest.fixture(scope="module")
def dem(tmp_path_factory):
    """A raster of several strips."""
    pytest.importorskip("rasterio")
    plane = ts.triangulate([[0, 0, 5], [2400, 0, 6], [2400, 2400, 8], [0, 2400, 9]])
    raster = ts.rasterize(plane.replace(crs=ts.CRS.of("EPSG:32616")), spacing=1.0, lazy=True)
    return ts.write(raster, tmp_path_factory.mktemp("dem") / "dem.tif")


def test_rasters_are_read_with_fractions(dem):
    fractions = []
    told = ts.read(dem, stride=8, progress=fractions.append)
    assert_ascends(fractions)
    assert len(fractions) >= 3
    assert_same(told, ts.read(dem, stride=8))


@pytest.mark.parametrize("error", [OSError, ts.ReadError, KeyboardInterrupt])
def test_whatever_it_raises_comes_out_of_reading(tiles, dem, tmp_path, points, error):
    raised = error("enough")

    def stop(fraction):
        raise raised

    text = write_rows(tmp_path / "points.csv", points[:99], "{1:.3f},{2:.3f},{3:.3f}\n")
    for path in (tiles[0], dem, text):
        with pytest.raises(error) as caught:
            ts.read(path, progress=stop)
        assert caught.value is raised


# ------------------------------------------------------------------------- writing


SUFFIXES = (".ply", ".laz", ".geojson", ".geojsons", ".gpkg", ".xyz", ".xml", ".dxf", ".fgb")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_files_are_written_with_fractions(tmp_path, tins, suffix):
    tin = ts.triangulate(tins[1].points[:500], crs="EPSG:32616")
    fractions = []
    told = ts.write(tin, tmp_path / f"told{suffix}", progress=fractions.append)
    assert_ascends(fractions)
    plain = ts.write(tin, tmp_path / f"plain{suffix}")
    if suffix not in (".gpkg", ".xml"):  # which hold the name of the file
        assert told.read_bytes() == plain.read_bytes()


@pytest.mark.parametrize("suffix", [".ply", ".geojsons"])
@pytest.mark.parametrize("error", [Enough, OSError, ts.WriteError, KeyboardInterrupt])
def test_a_file_that_was_not_finished_is_not_there(tmp_path, tins, suffix, error):
    raised = error("enough")

    def stop(fraction):
        raise raised

    tin = tins[1].replace(crs=ts.CRS.of("EPSG:32616"))
    with pytest.raises(error) as caught:
        ts.write(tin, tmp_path / f"made{suffix}", progress=stop)
    assert caught.value is raised
    assert list(tmp_path.iterdir()) == []


def test_writing_refuses_what_cannot_be_called(tmp_path, tins):
    with pytest.raises(ts.OptionError, match="Invalid progress 7"):
        ts.write(tins[0], tmp_path / "made.ply", progress=7)
    assert list(tmp_path.iterdir()) == []


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
