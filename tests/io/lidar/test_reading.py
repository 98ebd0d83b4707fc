"""Lidar is read as laspy reads it, and what is left out is told."""

import struct
import warnings
from pathlib import Path

import numpy as np
import pyproj
import pytest
from support import refusals
from support.lidar_files import CORNER, make_cloud, write_copc

import tinsmith as ts
from tinsmith.io import CrsError, OptionError, ReadError, read
from tinsmith.io.lidar.reading import read as read_lidar

laspy = pytest.importorskip("laspy")

DATA = Path(__file__).parents[2] / "data"
REAL = ("autzen_crop.laz", "isprs_samp11_crop.laz")


@pytest.fixture
def cloud(tmp_path):
    made = make_cloud()
    made.write(tmp_path / "cloud.laz")
    return made


def refuse(path, error=ReadError, **options):
    return refusals.refuse("", read_lidar, path, error=error, **options)


# ------------------------------------------------------------------------ as laspy


@pytest.mark.parametrize("name", REAL)
def test_real_files_give_the_doubles_of_laspy(name):
    expected = laspy.read(DATA / name)
    survey = read(DATA / name)
    keep = np.asarray(expected.withheld) == 0
    assert np.array_equal(survey.points, expected.xyz[keep])
    for attribute in ("classification", "intensity", "return_number", "number_of_returns"):
        assert np.array_equal(survey.attributes[attribute], expected[attribute][keep])


def test_a_crs_is_that_of_the_keys_or_of_the_text():
    assert read(DATA / "isprs_samp11_crop.laz").crs == "EPSG:32632"
    autzen = read(DATA / "autzen_crop.laz")
    assert autzen.crs.name == "NAD_1983_HARN_Lambert_Conformal_Conic"
    assert autzen.crs.horizontal_unit.name == "foot"


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize(
    ("version", "point_format"),
    [("1.1", 0), ("1.1", 1), ("1.2", 2), ("1.2", 3), ("1.3", 4), ("1.3", 5), ("1.4", 1)]
    + [("1.4", k) for k in range(6, 11)],
)
def test_every_version_and_format_of_points(tmp_path, version, point_format, suffix):
    made = make_cloud(version=version, point_format=point_format)
    path = tmp_path / f"cloud{suffix}"
    made.write(path)
    survey = read(path, attributes="all", withheld=True)
    assert np.array_equal(survey.points, laspy.read(path).xyz)
    for name, values in survey.attributes.items():
        assert np.array_equal(values, np.asarray(made[name])), name


def test_version_1_0_is_read(tmp_path):
    made = make_cloud(version="1.1", point_format=1)
    made.write(tmp_path / "old.las")
    content = bytearray((tmp_path / "old.las").read_bytes())
    content[25] = 0
    (tmp_path / "old.las").write_bytes(content)
    assert np.array_equal(read(tmp_path / "old.las", withheld=True).points, made.xyz)


def test_extra_bytes_come_when_asked_for(tmp_path, cloud):
    cloud.add_extra_dim(laspy.ExtraBytesParams(name="height above ground", type=np.float32))
    cloud["height above ground"] = np.arange(len(cloud.points), dtype=np.float32)
    cloud.write(tmp_path / "extra.laz")
    survey = read(tmp_path / "extra.laz", attributes="height above ground", withheld=True)
    assert list(survey.attributes) == ["height above ground"]
    assert np.array_equal(survey.attributes["height above ground"], np.arange(len(cloud.points)))
    assert "height above ground" in read(tmp_path / "extra.laz", attributes="all").attributes
    assert read(tmp_path / "extra.laz", attributes=()).attributes == {}


# ---------------------------------------------------------------------- the selection


def keep_of(cloud):
    return np.asarray(cloud.withheld) == 0


def test_withheld_points_are_left_out_and_counted(tmp_path, cloud):
    survey = read(tmp_path / "cloud.laz")
    assert np.array_equal(survey.points, cloud.xyz[keep_of(cloud)])
    assert survey.skipped == {"points marked as withheld": int((~keep_of(cloud)).sum())}
    assert len(read(tmp_path / "cloud.laz", withheld=True)) == len(cloud.points)


def test_a_note_tells_of_the_classes_that_were_taken(tmp_path, cloud):
    (note,) = read(tmp_path / "cloud.laz").notes
    count = int((np.asarray(cloud.classification)[keep_of(cloud)] == 2).sum())
    assert f"2 ground ({count})" in note
    assert "All were taken" in note
    (note,) = read(tmp_path / "cloud.laz", classes=2).notes
    assert note.endswith("taken: 2.")


# ASPRS, LAS Specification 1.4 R15, tables 9 and 17, the first words of each meaning.
MEANINGS = (
    *("never classified", "unclassified", "ground", "low", "medium", "high", "building"),
    *("low noise", "key", "water", "rail", "road", "overlap", "wire", "wire", "tower"),
    *("wire", "bridge", "high noise"),
)


def test_classes_have_the_names_of_the_specification(tmp_path):
    made = make_cloud(len(MEANINGS))
    made.classification = np.arange(len(MEANINGS), dtype=np.uint8)
    made.withheld = np.zeros(len(MEANINGS), np.uint8)
    made.write(tmp_path / "all.las")
    (note,) = (one for one in read(tmp_path / "all.las").notes if one.startswith("Classes"))
    listed = note.partition(": ")[2].partition(". ")[0].split(", ")
    for number, (told, meaning) in enumerate(zip(listed, MEANINGS, strict=True)):
        assert told.startswith(f"{number} {meaning}")


@pytest.mark.parametrize("given", [2, [2], "2", (7, 2), "2,7", "7 2", np.array([2])])
def test_classes(tmp_path, cloud, given):
    numbers = {"2": [2], "2,7": [2, 7], "7 2": [2, 7]}.get(str(given), np.atleast_1d(given))
    keep = keep_of(cloud) & np.isin(np.asarray(cloud.classification), np.asarray(numbers, int))
    survey = read(tmp_path / "cloud.laz", classes=given)
    assert np.array_equal(survey.points, cloud.xyz[keep])
    assert survey.skipped["points of other classes"] == (keep_of(cloud) & ~keep).sum()


@pytest.mark.parametrize("given", ["first", "last", "only", 2, (1, 3), "first,only", ["last", 1]])
def test_returns(tmp_path, cloud, given):
    number, total = np.asarray(cloud.return_number), np.asarray(cloud.number_of_returns)
    tests = {"first": number == 1, "last": number == total, "only": total == 1}
    words = given.split(",") if isinstance(given, str) else np.atleast_1d(np.array(given, object))
    keep = np.zeros(len(number), bool)
    for word in words:
        keep |= tests[word] if isinstance(word, str) else number == word
    survey = read(tmp_path / "cloud.laz", returns=given)
    assert np.array_equal(survey.points, cloud.xyz[keep & keep_of(cloud)])


def test_a_window_has_its_edges(tmp_path, cloud):
    xyz = cloud.xyz
    low, high = xyz[7, :2], xyz[11, :2]
    box = ts.Bounds(*np.minimum(low, high), *np.maximum(low, high))
    keep = ((xyz[:, :2] >= [box.xmin, box.ymin]) & (xyz[:, :2] <= [box.xmax, box.ymax])).all(1)
    assert keep[[7, 11]].all()
    for window in (box, (box.xmin, box.ymin, box.xmax, box.ymax)):
        survey = read(tmp_path / "cloud.laz", window=window, withheld=True)
        assert np.array_equal(survey.points, xyz[keep])


def test_every_counts_the_points_that_are_left(tmp_path, cloud, monkeypatch):
    keep = keep_of(cloud) & (np.asarray(cloud.classification) == 2)
    survey = read(tmp_path / "cloud.laz", classes=2, every=7)
    assert np.array_equal(survey.points, cloud.xyz[keep][::7])


def test_every_goes_on_over_chunks(monkeypatch, tmp_path, cloud):
    from tinsmith.io.lidar import las_child

    monkeypatch.setattr(las_child, "_CHUNK", 64)
    wanted = {"classes": None, "returns": None, "window": None, "resolution": None, "every": 7,
              "withheld": True, "attributes": []}  # fmt: skip
    parts = list(las_child.read_points(str(tmp_path / "cloud.laz"), wanted=wanted))
    assert len(parts) == 8
    found = np.concatenate([part.arrays["xyz"] for part in parts])
    assert np.array_equal(found[:, 0], np.asarray(cloud.X)[::7])


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("classes", -1),
        ("classes", 256),
        ("classes", "ground"),
        ("classes", []),
        ("classes", True),
        ("returns", "second"),
        ("returns", 0),
        ("returns", 16),
        ("returns", []),
        ("window", (0, 0, 1)),
        ("window", (1, 0, 0, 1)),
        ("window", (0, 0, np.nan, 1)),
        ("window", 3),
        ("every", 0),
        ("every", 1.5),
        ("resolution", 0),
        ("resolution", np.inf),
        ("resolution", 1.0),
    ],
)
def test_wrong_options(tmp_path, cloud, option, value):
    assert option in refuse(tmp_path / "cloud.laz", OptionError, **{option: value})


def test_an_unknown_attribute_is_refused_with_those_there_are(tmp_path, cloud):
    message = refuse(tmp_path / "cloud.laz", attributes=["colour"])
    assert "'colour'" in message
    assert "gps_time" in message


def test_a_selection_that_leaves_nothing_says_what_there_is(tmp_path, cloud):
    message = refuse(tmp_path / "cloud.laz", classes=9)
    assert "of another class" in message
    assert "2 ground (" in message
    assert "outside the window" in refuse(tmp_path / "cloud.laz", window=(0, 0, 1, 1))


# ----------------------------------------------------------------------------- COPC


@pytest.fixture
def octree(tmp_path):
    made = make_cloud(2000)
    return made, write_copc(tmp_path / "tree.copc.laz", made)


def as_set(points):
    return {tuple(row) for row in points.tolist()}


def test_an_octree_is_read_whole(octree):
    made, path = octree
    survey = read(path, withheld=True)
    assert len(survey) == 2000
    assert as_set(survey.points) == as_set(made.xyz)


@pytest.mark.parametrize(("resolution", "levels"), [(40, 1), (32, 1), (31, 2), (16, 2), (15, 3)])
def test_a_resolution_takes_levels(octree, resolution, levels):
    _, path = octree
    with laspy.CopcReader.open(str(path)) as reader:
        expected = reader.query(resolution=resolution)
        assert len(expected) == sum(len(reader.query(level=k)) for k in range(levels))
    survey = read(path, resolution=resolution, withheld=True)
    assert as_set(survey.points) == as_set(np.stack([expected[a] for a in "xyz"], axis=1))


def test_a_window_of_an_octree_is_that_of_all_its_points(octree):
    made, path = octree
    box = (752_650.0, 4_024_190.5, 752_700.25, 4_024_230.0)
    xyz = made.xyz
    keep = ((xyz[:, :2] >= box[:2]) & (xyz[:, :2] <= box[2:])).all(axis=1)
    survey = read(path, window=box, withheld=True)
    assert as_set(survey.points) == as_set(xyz[keep])
    wide = read(path, window=(-1e300, -1e300, 1e300, 1e300), withheld=True)
    assert as_set(wide.points) == as_set(xyz)


def test_classes_of_an_octree(octree):
    made, path = octree
    keep = keep_of(made) & (np.asarray(made.classification) == 2)
    survey = read(path, classes=2, resolution=1)
    assert as_set(survey.points) == as_set(made.xyz[keep])


# ---------------------------------------------------------------------------- folders


def test_a_folder_of_tiles_is_one_survey(tmp_path):
    made = [make_cloud(300, seed=k) for k in range(3)]
    for k, one in enumerate(made):
        one.write(tmp_path / f"tile{k}.{'las' if k == 1 else 'LAZ'}")
    (tmp_path / "._tile0.laz").write_bytes(b"a shadow")
    (tmp_path / "readme.txt").write_text("tiles")
    survey = read(tmp_path, withheld=True)
    assert np.array_equal(survey.points, np.concatenate([one.xyz for one in made]))
    assert survey.attributes["intensity"].tolist() == [v for one in made for v in one.intensity]
    assert survey.source == tmp_path.name


def test_tiles_of_several_crs_need_the_one_that_is_wanted(tmp_path):
    points = CORNER + np.random.default_rng(1).random((20, 3)) * 50
    ours = ts.Survey(points=points, crs="EPSG:32616")
    theirs = ts.Survey(
        points=ts.transform_points(points, "EPSG:32616", "EPSG:26916"), crs="EPSG:26916"
    )
    ts.write(ours, tmp_path / "a.laz")
    ts.write(theirs, tmp_path / "b.laz")
    message = refuse(tmp_path, CrsError)
    assert "EPSG:32616 and EPSG:26916" in message
    survey = read_lidar(tmp_path, crs="EPSG:32616")
    assert np.allclose(survey.points, np.concatenate([points, points]), atol=1e-5, rtol=0)


def test_a_tile_without_crs_is_not_mixed_with_others(tmp_path):
    points = CORNER + np.random.default_rng(1).random((20, 3)) * 50
    ts.write(ts.Survey(points=points, crs="EPSG:32616"), tmp_path / "a.laz")
    ts.write(ts.Survey(points=points), tmp_path / "b.laz")
    assert "none is named" in refuse(tmp_path, CrsError)
    assert "none is named" in refuse(tmp_path, CrsError, crs="EPSG:32616")


# --------------------------------------------------------------------------------- CRS


def with_keys(path, *keys, texts=b""):
    made = make_cloud(20, version="1.2", point_format=1)
    content = struct.pack("<4H", 1, 1, 0, len(keys))
    content += b"".join(struct.pack("<4H", key, 0, 1, value) for key, value in keys)
    made.header.vlrs.append(laspy.VLR("LASF_Projection", 34735, "", content))
    made.write(path)
    return path


@pytest.mark.each_value
@pytest.mark.parametrize("target", [None, "EPSG:32616", "EPSG:2274"])
@pytest.mark.parametrize("second", [9001, 9003])
@pytest.mark.parametrize("first", [9001, 9003])
@pytest.mark.parametrize("systems", [(32616, 32616), (32616, 2274), (2274, 32616)])
def test_elevations_of_tiles_are_in_one_unit(tmp_path, systems, first, second, target):
    """What lies 304.32 feet or metres high lies as high among other tiles, in metres."""
    if target is None and systems[0] != systems[1]:
        target = "EPSG:26916"
    with_keys(tmp_path / "a.las", (3072, systems[0]), (4099, first))
    with_keys(tmp_path / "b.las", (3072, systems[1]), (4099, second))
    apart = [read(tmp_path / name, crs=target) for name in ("a.las", "b.las")]
    both = read_lidar(tmp_path, crs=target)
    metres = [one.points[:, 2] * one.elevation_unit.metres for one in apart]
    found = both.points[:, 2] * both.elevation_unit.metres
    assert np.allclose(found, np.concatenate(metres), rtol=1e-12, atol=0)
    converted = any(note.startswith("The elevations of 'b.las' were") for note in both.notes)
    assert converted == (apart[0].elevation_unit != apart[1].elevation_unit)


@pytest.mark.parametrize("target", [None, "EPSG:32616"])
def test_a_tile_without_unit_is_not_mixed_with_others(tmp_path, target):
    with_keys(tmp_path / "a.las", (3072, 32616))
    with_keys(tmp_path / "b.las", (3072, 32616), (4099, 9003))
    assert "unknown and US survey foot" in refuse(tmp_path, crs=target)
    with_keys(tmp_path / "b.las", (3072, 32616), (4099, 9001))
    assert read_lidar(tmp_path, crs=target, elevation_unit="m").elevation_unit.name == "metre"


@pytest.mark.parametrize(
    ("keys", "crs", "unit"),
    [
        ([(1024, 1), (3072, 32616)], "EPSG:32616", None),
        ([(3072, 32616), (4099, 9001)], "EPSG:32616", "metre"),
        ([(3072, 2274), (4099, 9003)], "EPSG:2274", "US survey foot"),
        ([(3072, 32616), (4096, 5703)], "EPSG:32616+5703", "metre"),
        ([(3072, 2274), (4096, 5703), (4099, 9003)], "EPSG:8778", "US survey foot"),
        ([(3072, 2274), (4096, 6360)], "EPSG:8778", "US survey foot"),
        ([(3072, 2274), (3076, 9003)], "EPSG:2274", None),
    ],
)
def test_keys_of_geotiff(tmp_path, keys, crs, unit):
    survey = read(with_keys(tmp_path / "keys.las", *keys))
    assert survey.crs.is_same(crs)
    assert (survey.elevation_unit and survey.elevation_unit.name) == unit


def test_keys_that_contradict_themselves_are_refused_until_told(tmp_path):
    path = with_keys(tmp_path / "keys.las", (3072, 32616), (3076, 9003))
    assert "US survey foot" in refuse(path)
    survey = read(path, crs="EPSG:32616")
    assert survey.crs == "EPSG:32616"
    assert any("not used" in note for note in survey.notes)


@pytest.mark.parametrize(
    ("vertical", "unit", "name"), [(5773, 9002, "foot"), (32001, 9003, "US survey foot")]
)
def test_a_vertical_crs_in_another_unit_or_not_known_is_told(tmp_path, vertical, unit, name):
    """The unit that is named counts."""
    path = with_keys(tmp_path / "keys.las", (3072, 32616), (4096, vertical), (4099, unit))
    survey = read(path)
    assert survey.crs == "EPSG:32616"
    assert survey.elevation_unit.name == name
    assert any(str(vertical) in note for note in survey.notes)


def test_an_own_projection_in_keys_is_understood_by_gdal(tmp_path):
    pytest.importorskip("rasterio")
    with laspy.open(DATA / "autzen_crop.laz") as file:
        made = file.read()
    wkt = next(v for v in made.header.vlrs if getattr(v, "record_id", 0) == 2112)
    made.header.vlrs.remove(wkt)
    made.write(tmp_path / "keys.laz")
    found, told = read(tmp_path / "keys.laz"), read(DATA / "autzen_crop.laz")
    assert np.array_equal(found.points, told.points)
    moved = [ts.transform_points(one.points, one.crs, "EPSG:4326") for one in (found, told)]
    assert np.abs(moved[0] - moved[1]).max() < 1e-5
    assert found.crs.horizontal_unit == told.crs.horizontal_unit


def test_degrees_are_refused_with_a_zone_and_reprojected_when_told(tmp_path):
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales = np.array([1e-7, 1e-7, 0.01])
    header.add_crs(pyproj.CRS("EPSG:4326"))
    made = laspy.LasData(header)
    made.xyz = np.array([-84.2, 36.4, 300.0]) + np.random.default_rng(1).random((20, 3)) * 1e-3
    made.write(tmp_path / "degrees.las")
    assert "EPSG:32616" in refuse(tmp_path / "degrees.las")
    survey = read(tmp_path / "degrees.las", crs="EPSG:32616", withheld=True)
    expected = ts.transform_points(made.xyz, "EPSG:4326", "EPSG:32616")
    assert np.abs(survey.points - expected).max() < 1e-6


def test_a_crs_that_is_not_understood_needs_the_right_one(tmp_path):
    made = make_cloud(20)
    wkt = laspy.vlrs.known.WktCoordinateSystemVlr('PROJCS["nonsense"')
    made.header.vlrs.append(wkt)
    made.write(tmp_path / "odd.laz")
    assert "odd.laz" in refuse(tmp_path / "odd.laz", CrsError)
    assert read(tmp_path / "odd.laz", crs="EPSG:32616").crs == "EPSG:32616"


def as_key_record(*keys):
    content = struct.pack("<4H", 1, 1, 0, len(keys))
    content += b"".join(struct.pack("<4H", key, 0, 1, value) for key, value in keys)
    return laspy.VLR("LASF_Projection", 34735, "", content)


def as_text_record(crs):
    return laspy.vlrs.known.WktCoordinateSystemVlr(pyproj.CRS(crs).to_wkt("WKT1_GDAL"))


def with_records(path, *records, offsets=None):
    made = make_cloud(20)
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales = made.header.scales
    header.offsets = made.header.offsets if offsets is None else np.array(offsets)
    header.vlrs.extend(records)
    laspy.LasData(header, made.points).write(path)
    return path


@pytest.mark.parametrize(
    "records",
    [
        [as_text_record("EPSG:32617"), as_key_record((1024, 1), (3072, 32616))],
        [as_key_record((1024, 1), (3072, 32616)), as_text_record("EPSG:2274")],
        [as_text_record("EPSG:32616"), as_text_record("EPSG:32617")],
    ],
)
def test_records_that_name_different_crs_are_refused_until_told(tmp_path, records):
    path = with_records(tmp_path / "two.las", *records)
    message = refuse(path, CrsError)
    assert "names two CRSs that differ" in message
    assert "about (7527" in message
    survey = read(path, crs="EPSG:32616")
    assert survey.crs == "EPSG:32616"
    assert np.abs(survey.points[:, 0] - 752_740).max() < 200
    assert any("two CRSs" in note for note in survey.notes)


@pytest.mark.parametrize(
    ("text", "key"), [("EPSG:32616", 32616), ("EPSG:6345", 26916), ("EPSG:32616+5703", 32616)]
)
def test_records_that_agree_within_a_metre_are_one(tmp_path, text, key):
    path = with_records(tmp_path / "one.las", as_text_record(text), as_key_record((3072, key)))
    assert read(path).crs.is_same(text)


def test_keys_tell_the_unit_of_elevations_that_the_text_does_not(tmp_path):
    keys = as_key_record((1024, 1), (3072, 2274), (4099, 9003))
    survey = read(with_records(tmp_path / "feet.las", as_text_record("EPSG:2274"), keys))
    assert survey.elevation_unit.name == "US survey foot"
    text = as_text_record("EPSG:32616+5703")
    path = with_records(tmp_path / "both.las", text, as_key_record((3072, 32616), (4099, 9002)))
    assert "metre by its WKT and in foot by its keys" in refuse(path)


def test_a_geocentric_crs_of_projected_coordinates_needs_the_right_one(tmp_path):
    path = with_records(tmp_path / "odd.las", as_text_record("EPSG:4978"))
    message = refuse(path, CrsError)
    assert "Geocentric" in message
    assert "declare the CRS of its coordinates, which are about (7527" in message
    survey = read(path, crs="EPSG:32616")
    assert survey.crs == "EPSG:32616"
    assert any("Geocentric" in note for note in survey.notes)


def test_geocentric_coordinates_are_refused_whatever_is_declared(tmp_path):
    middle = (-1_276_000.0, -4_717_000, 4_085_000)
    path = with_records(tmp_path / "earth.las", as_text_record("EPSG:4978"), offsets=middle)
    for options in ({}, {"crs": "EPSG:32616"}):
        assert "centre of the Earth indeed" in refuse(path, CrsError, **options)


def test_degrees_that_cannot_be_degrees_are_refused_as_such(tmp_path):
    path = with_records(tmp_path / "odd.las", as_key_record((1024, 2), (2048, 4326)))
    assert "the CRS of the file is another one" in refuse(path, CrsError)


def test_points_beyond_the_bounds_of_the_header_are_told(tmp_path, cloud):
    cloud.write(tmp_path / "a.las")
    assert not any("bounds" in note for note in read(tmp_path / "a.las").notes)
    notes = read(patched(tmp_path / "a.las", 131, "<3d", 0.001, 0.001, 10.0)).notes
    assert any("outside the bounds that 'patched.las' gives" in note for note in notes)
    notes = read(patched(tmp_path / "a.las", 179, "<6d", *[0.0] * 6)).notes  # none given
    assert not any("bounds" in note for note in notes)


def test_extra_bytes_of_several_numbers_come_apart(tmp_path, cloud):
    cloud.add_extra_dim(laspy.ExtraBytesParams("tint", "3u1"))
    cloud.tint = np.arange(3 * len(cloud.points)).reshape(-1, 3) % 251
    cloud.write(tmp_path / "a.las")
    found = read(tmp_path / "a.las", attributes=["tint"], withheld=True).attributes
    assert list(found) == ["tint[0]", "tint[1]", "tint[2]"]
    assert np.array_equal(np.stack(list(found.values()), axis=1), cloud.tint)


# ------------------------------------------------------------------------ header lies


def patched(path, place, form, *values):
    content = bytearray(path.read_bytes())
    struct.pack_into(form, content, place, *values)
    changed = path.with_name(f"patched{path.suffix}")
    changed.write_bytes(content)
    return changed


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize(
    ("place", "form", "values", "words"),
    [
        (247, "<Q", [2**60], "points"),
        (247, "<Q", [501], "be"),
        (107, "<I", [499], "another place"),
        (96, "<I", [2**31], "begin at byte"),
        (96, "<I", [10], "begin at byte"),
        (94, "<H", [200], "header"),
        (94, "<H", [60000], "begin at byte"),
        (100, "<I", [2**31], "records are said"),
        (105, "<H", [10], "bytes"),
        (25, "<B", [7], "LAS 1.7"),
        (24, "<B", [2], "LAS 2.4"),
        (104, "<B", [33], "format"),
        (131, "<d", [0.0], "scales"),
        (139, "<d", [np.nan], "scales"),
        (155, "<d", [np.inf], "offsets"),
        (155, "<d", [1e308], None),
        (235, "<QI", [2**40, 3], "extended records"),
        (235, "<QI", [375, 2**31], "records are said"),
    ],
)
def test_headers_that_lie_are_refused(tmp_path, cloud, suffix, place, form, values, words):
    cloud.write(tmp_path / f"sound{suffix}")
    path = patched(tmp_path / f"sound{suffix}", place, form, *values)
    if words is None:
        assert np.isfinite(read_lidar(path).points).all()
        return
    assert words in refuse(path)


def test_offsets_in_sentences_are_written_to_the_millimetre(tmp_path, cloud):
    cloud.write(tmp_path / "sound.las")
    path = patched(tmp_path / "sound.las", 131, "<6d", 0.0, 0.01, 0.01, 500000.0, 4024250.125, 0.0)
    assert "the scales 0, 0.01, 0.01 and the offsets 500000, 4024250.125, 0, " in refuse(path)


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_files_that_are_cut_short_are_refused(tmp_path, cloud, suffix):
    cloud.write(tmp_path / f"sound{suffix}")
    content = (tmp_path / f"sound{suffix}").read_bytes()
    for length in (4, 100, 226, 300, 374, 380, len(content) // 2, len(content) - 1):
        path = tmp_path / f"short{suffix}"
        path.write_bytes(content[:length])
        assert "short" in refuse(path)


def test_more_points_than_the_header_tells_are_told(tmp_path, cloud):
    cloud.write(tmp_path / "sound.las")
    content = bytearray((tmp_path / "sound.las").read_bytes())
    struct.pack_into("<I", content, 107, 400)
    struct.pack_into("<Q", content, 247, 400)
    (tmp_path / "sound.las").write_bytes(content)
    survey = read(tmp_path / "sound.las", withheld=True)
    assert np.array_equal(survey.points, cloud.xyz[:400])
    assert any("100 more" in note for note in survey.notes)


def test_no_points(tmp_path):
    make_cloud(0).write(tmp_path / "none.las")
    assert "no points" in refuse(tmp_path / "none.las")


def test_points_that_memory_cannot_hold_are_refused_before_any_is_asked_for(
    tmp_path, cloud, monkeypatch
):
    from tinsmith.io.registry import chunks

    monkeypatch.setattr(chunks, "measure_free_memory", lambda: 24 * 499)
    assert "499 are the most" in refuse(tmp_path / "cloud.laz")


def test_reading_gives_no_warnings(tmp_path, cloud):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read(tmp_path / "cloud.laz")
