"""Lidar in chunks is the lidar read at once; boxes of an octree are those of all its points."""

import json

import numpy as np
import pytest
from support.lidar_files import CORNER, make_cloud, write_copc
from support.streams import gather, require_same

import tinsmith as ts
from tinsmith.io.streaming import describe_source, read_box, stream_points

laspy = pytest.importorskip("laspy")

WKT = ts.CRS("EPSG:32616").to_wkt()


@pytest.fixture(scope="module")
def cloud(tmp_path_factory):
    path = tmp_path_factory.mktemp("lidar") / "cloud.laz"
    made = make_cloud(1500)
    made.header.add_crs(_crs())
    made.write(path)
    return path


def _crs():
    import pyproj

    return pyproj.CRS.from_epsg(32616)


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"classes": 2},
        {"classes": [2, 7], "returns": "last"},
        {"returns": [1, "only"], "withheld": True},
        {"every": 7},
        {"classes": 5, "every": 3, "withheld": True},
        {"window": (752_650, 4_024_190, 752_700, 4_024_230)},
        {"attributes": "all"},
        {"attributes": ()},
        {"crs": "EPSG:2274"},
        {"crs": "EPSG:26916", "elevation_unit": "ft"},
        {"elevation_unit": "US survey foot", "every": 2},
        {"classes": 9},
        {"window": (0, 0, 1, 1)},
        {"attributes": "colour"},
        {"crs": "EPSG:4326"},
        {"every": 0},
        {"unknown": 1},
        {"resolution": 1.0},
    ],
    ids=str,
)
def test_chunks_are_the_whole(cloud, options):
    require_same(cloud, **options)


def test_rows_are_the_places_in_the_file(cloud):
    made = laspy.read(cloud)
    keep = (np.asarray(made.classification) == 2) & (np.asarray(made.withheld) == 0)
    found, _ = gather(cloud, 100, classes=2, every=3)
    rows = np.concatenate([one.rows for one in found])
    assert np.array_equal(rows, np.flatnonzero(keep)[::3])


def test_a_file_of_several_blocks(tmp_path):
    """More points than the child reads at a time; most of them withheld in the first block."""
    made = make_cloud(1_200_000)
    withheld = np.asarray(made.withheld).copy()
    withheld[:600_000] = 1
    made.withheld = withheld
    made.write(tmp_path / "large.las")
    survey = require_same(tmp_path / "large.las", chunks=(250_007, 10**9), every=3)
    assert np.array_equal(survey.points, made.xyz[withheld == 0][::3])


@pytest.mark.parametrize("options", [{}, {"crs": "EPSG:2274"}, {"classes": 2, "every": 5}])
def test_a_folder_of_tiles(tmp_path, options):
    for k in range(3):
        made = make_cloud(300, seed=k, point_format=7 if k == 1 else 6)
        made.header.add_crs(_crs())
        made.write(tmp_path / f"tile{k}.{'las' if k == 1 else 'laz'}")
    require_same(tmp_path, chunks=(1000, 77), **options)
    require_same(tmp_path, chunks=(77,), attributes="all", **options)
    header = describe_source(tmp_path)
    assert header.count == 900
    assert header.size == sum(one.stat().st_size for one in tmp_path.iterdir())


def test_coordinates_that_contradict_their_crs(tmp_path):
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.array([0.001, 0.001, 0.01]), CORNER[[1, 0, 2]]
    header.add_crs(_crs())
    made = laspy.LasData(header)
    made.xyz = make_cloud(400).xyz[:, [1, 0, 2]]
    made.write(tmp_path / "turned.las")
    error = require_same(tmp_path / "turned.las")
    assert "exchanged" in str(error)
    assert len(require_same(tmp_path / "turned.las", check_crs=False)) == len(
        ts.read(tmp_path / "turned.las", check_crs=False)
    )


def test_degrees_without_a_crs_are_noted(tmp_path):
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = np.array([1e-7, 1e-7, 0.01]), np.array([-84, 36, 0])
    made = laspy.LasData(header)
    made.xyz = np.array([-84.2, 36.4, 300]) + np.random.default_rng(1).random((50, 3)) * 0.01
    made.write(tmp_path / "degrees.las")
    survey = require_same(tmp_path / "degrees.las", crs="EPSG:32616")
    assert any("degrees of WGS 84" in note for note in survey.notes)


def test_a_damaged_file(tmp_path):
    made = make_cloud(2000)
    made.write(tmp_path / "cut.laz")
    content = (tmp_path / "cut.laz").read_bytes()
    (tmp_path / "cut.laz").write_bytes(content[: len(content) // 2])
    assert isinstance(require_same(tmp_path / "cut.laz"), ts.ReadError)


def test_a_stream_is_left_early(cloud):
    with stream_points(cloud, chunk_points=10) as stream:
        first = next(stream)
        with pytest.raises(ts.ReadError, match="all of its chunks"):
            _ = stream.notes
    assert np.array_equal(first.points, ts.read(cloud).points[:10])
    stream.close()


def test_a_packed_file(cloud, tmp_path):
    import gzip

    packed = tmp_path / "cloud.laz.gz"
    packed.write_bytes(gzip.compress(cloud.read_bytes()))
    require_same(packed, chunks=(400,))
    header = describe_source(packed)
    assert (header.format, header.count, header.size) == ("las", None, packed.stat().st_size)


# ------------------------------------------------------------------- headers and boxes


def test_a_header_tells_of_the_points(cloud):
    header = describe_source(cloud)
    survey = ts.read(cloud, withheld=True)
    assert header.count == len(survey)
    assert header.crs == survey.crs
    assert (header.size, header.mtime_ns) == (cloud.stat().st_size, cloud.stat().st_mtime_ns)
    box = survey.bounds
    assert np.allclose(
        [header.bounds.xmin, header.bounds.ymax], [box.xmin, box.ymax], rtol=0, atol=1e-6
    )
    assert not header.has_boxes


def test_bounds_are_in_the_crs_that_is_wanted(cloud):
    header, survey = describe_source(cloud, crs="EPSG:2274"), ts.read(cloud, crs="EPSG:2274")
    assert header.crs == survey.crs
    assert header.elevation_unit == survey.elevation_unit
    assert (survey.points[:, 0] >= header.bounds.xmin - 1e-3).all()
    assert (survey.points[:, 1] <= header.bounds.ymax + 1e-3).all()
    assert header.bounds.width < survey.bounds.width + 20


@pytest.fixture(scope="module")
def octree(tmp_path_factory):
    return write_copc(tmp_path_factory.mktemp("copc") / "tree.copc.laz", make_cloud(3000), wkt=WKT)


BOXES = [
    (752_650.0, 4_024_190.5, 752_700.25, 4_024_230.0),
    (752_740.0, 4_024_280.0, 752_740.0, 4_024_280.0),
    (-1e300, -1e300, 1e300, 1e300),
    (0.0, 0.0, 1.0, 1.0),
]


@pytest.mark.parametrize("box", BOXES)
@pytest.mark.parametrize(
    "options", [{}, {"classes": 2, "attributes": "all"}, {"elevation_unit": "ft", "returns": 1}]
)
def test_boxes_of_an_octree(octree, box, options):
    assert describe_source(octree, **options).has_boxes
    require_box(octree, box, **options)


def require_box(path, box, **options):
    (whole,), _ = gather(path, 10**9, **options)
    xy = whole.points[:, :2]
    expected = whole.take(((xy >= box[:2]) & (xy <= box[2:])).all(axis=1))
    found = read_box(path, box, **options)
    assert found.points.tobytes() == expected.points.tobytes()
    assert np.array_equal(found.rows, expected.rows)
    for name, values in expected.attributes.items():
        if len(found):
            assert np.array_equal(found.attributes[name], values)
    return found


def test_a_point_on_the_edge_of_a_box_belongs_to_it(octree):
    x, y, _ = ts.read(octree).points[17]
    found = require_box(octree, (x, y, x + 5, y + 5))
    assert (found.points[:, :2] == [x, y]).all(axis=1).any()


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"every": 2}, ts.OptionError, "every"),
        ({"crs": "EPSG:2274"}, ts.ReadError, "reprojected"),
        ({"window": BOXES[0]}, ts.ReadError, "window"),
    ],
)
def test_boxes_that_cannot_be_read_where_they_are(octree, options, error, words):
    with pytest.raises(error, match=words):
        read_box(octree, BOXES[0], **options)


def test_a_file_without_an_octree_has_no_boxes(cloud):
    with pytest.raises(ts.ReadError, match="octree"):
        read_box(cloud, BOXES[0])
    with pytest.raises(ts.OptionError, match="bounds"):
        read_box(cloud, (1, 0, 0, 1))


def test_an_octree_whose_points_lie_elsewhere_is_refused(tmp_path):
    made = make_cloud(3000)
    path = write_copc(tmp_path / "tree.copc.laz", made, wkt=WKT)
    content = bytearray(path.read_bytes())
    place = content.index(b"copc" + bytes(12)) + 16 + 4 + 32
    moved = np.frombuffer(content[place : place + 8], np.float64) + 30.0
    content[place : place + 8] = moved.tobytes()
    path.write_bytes(content)
    with pytest.raises(ts.ReadError, match="outside of the node"):
        read_box(path, BOXES[2])


# ------------------------------------------------------------- virtual point clouds


def write_cloud_of_clouds(folder, names, **more):
    places = [one if ":" in one else f"./{one}" for one in names]
    items = [{"type": "Feature", "assets": {"data": {"href": one, **more}}} for one in places]
    content = {"type": "FeatureCollection", "stac_version": "1.0.0", "features": items}
    (folder / "all.vpc").write_text(json.dumps(content))
    return folder / "all.vpc"


@pytest.fixture
def tiles(tmp_path):
    for k in (2, 1):
        made = make_cloud(300, seed=k)
        made.header.add_crs(_crs())
        made.write(tmp_path / f"tile {k}.laz")
    return tmp_path


@pytest.mark.parametrize("options", [{}, {"classes": 2, "every": 3}, {"crs": "EPSG:2274"}])
def test_a_virtual_point_cloud_is_its_files(tiles, options):
    path = write_cloud_of_clouds(tiles, ["tile%202.laz", "tile 1.laz"], roles=["data"])
    survey = require_same(path, chunks=(77,), **options)
    single = [ts.read(tiles / f"tile {k}.laz", **options).points for k in (2, 1)]
    if "every" not in options:
        assert np.array_equal(survey.points, np.concatenate(single))
    header = describe_source(path, **options)
    assert (header.count, header.crs) == (600, survey.crs)
    assert not header.has_boxes


@pytest.mark.parametrize(
    ("names", "words"),
    [
        ([], "names no files"),
        (["missing.laz"], "no such file"),
        (["https://example.com/a.laz"], "is an address"),
        (["all.vpc"], "no lidar file"),
    ],
)
def test_a_virtual_point_cloud_that_names_what_is_not_there(tiles, names, words):
    error = require_same(write_cloud_of_clouds(tiles, names), chunks=(77,))
    assert words in str(error)


@pytest.mark.parametrize("text", ["{}", "[]", "no JSON", '{"features": [{"assets": 1}]}'])
def test_what_is_no_virtual_point_cloud(tmp_path, text):
    (tmp_path / "a.vpc").write_text(text)
    assert "no virtual point cloud" in str(require_same(tmp_path / "a.vpc", chunks=(7,)))


def test_nothing_is_written_as_a_virtual_point_cloud(tmp_path, cloud):
    with pytest.raises(ts.FormatError, match="unknown suffix"):
        ts.write(ts.read(cloud), tmp_path / "a.vpc")
