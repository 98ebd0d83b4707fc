"""Vector layers as other programs leave them: names, units, encodings, kinds of geometry."""

import json
import sqlite3
import struct
import warnings
from contextlib import closing

import numpy as np
import pytest
import shapely

import tinsmith as ts
from tinsmith.io import FormatError, OptionError, ReadError, read, read_lines, read_water

pyogrio = pytest.importorskip("pyogrio")

UTM = "EPSG:32616"
POINTS = np.array(
    [[500_000.0, 4e6, 10], [500_010, 4e6, 11], [500_000, 4_000_010, 12], [500_013, 4_000_013, 13]]
)
TRIANGLES = POINTS[[[0, 1, 2], [1, 3, 2]]]


def write_json(path, *, crs=UTM, flat=True, **columns):
    """Write points and columns as GeoJSON of a projected CRS."""
    name = "urn:ogc:def:crs:" + crs.replace(":", "::")
    features = [
        {
            "type": "Feature",
            "geometry": {"type": "Point", "coordinates": point[: 2 if flat else 3]},
            "properties": {key: values[row] for key, values in columns.items()},
        }
        for row, point in enumerate(POINTS.tolist())
    ]
    member = {"type": "name", "properties": {"name": name}}
    path.write_text(json.dumps({"type": "FeatureCollection", "crs": member, "features": features}))
    return path


def write_wkb(path, *geometries, kind="Unknown", driver="GPKG", **columns):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pyogrio.raw.write(
            str(path),
            np.array(geometries, object),
            [np.array(values) for values in columns.values()],
            list(columns),
            geometry_type=kind,
            crs=UTM,
            driver=driver,
            layer="layer" if driver == "GPKG" else None,
        )
    return path


def pack_ring(corners, kind):
    ring = np.vstack([corners, corners[:1]])
    return struct.pack("<BIII", 1, kind, 1, 4) + ring.astype("<f8").tobytes()


def pack_surface(kind, of):
    parts = b"".join(pack_ring(corners, of) for corners in TRIANGLES)
    return struct.pack("<BII", 1, kind, len(TRIANGLES)) + parts


# ----------------------------------------------------------------------------- columns


def test_columns_that_only_capitals_keep_apart_are_both_kept(tmp_path):
    survey = read(
        write_json(tmp_path / "a.geojson", flat=False, Code=list("ABCD"), code=list("abcd"))
    )
    assert survey.attributes["Code"].tolist() == list("ABCD")
    assert survey.attributes["code"].tolist() == list("abcd")


def test_elevations_in_two_columns_that_capitals_keep_apart_are_refused_until_told(tmp_path):
    path = write_json(tmp_path / "a.geojson", Elev=[1, 2, 3, 4], elev=[101, 102, 103, 104])
    with pytest.raises(ReadError, match=r"they differ: Elev, elev"):
        read(path)
    assert read(path, z_field="Elev").points[:, 2].tolist() == [1, 2, 3, 4]
    assert read(path, z_field="elev").points[:, 2].tolist() == [101, 102, 103, 104]
    with pytest.raises(OptionError, match="ELEV"):
        read(path, z_field="ELEV")


@pytest.mark.parametrize(
    ("name", "crs", "unit"),
    [
        ("elev_ft", UTM, "foot"),
        ("elev_ft", "EPSG:2274", "US survey foot"),
        ("elevation_m", "EPSG:2274", "metre"),
        ("z_m", UTM, "metre"),
    ],
)
def test_a_column_names_the_unit_of_its_elevations(tmp_path, name, crs, unit):
    path = write_json(tmp_path / "a.geojson", crs=crs, **{name: [1, 2, 3, 4]})
    survey = read(path)
    assert survey.elevation_unit.name == unit
    assert f"in {unit} as its name says" in survey.notes[0]
    with pytest.raises(OptionError, match=unit):
        read(path, elevation_unit="yard")


def test_elevations_in_feet_of_a_column_become_metres_with_the_eastings(tmp_path):
    path = write_json(tmp_path / "a.geojson", elev_ft=[100, 200, 300, 400])
    survey = read(path, crs="EPSG:32617")
    np.testing.assert_allclose(survey.points[:, 2], np.array([1, 2, 3, 4]) * 30.48)


def test_a_column_without_a_unit_tells_none(tmp_path):
    for name in ("elev", "Height", "rl", "quota"):
        assert (
            read(write_json(tmp_path / "a.geojson", **{name: [1, 2, 3, 4]})).elevation_unit is None
        )


@pytest.mark.parametrize("flat", [True, False])
def test_elevations_far_from_the_others_are_told_and_left_out_when_asked(tmp_path, flat):
    given = POINTS.copy()
    given[1, 2] = -9999
    path = write_wkb(
        tmp_path / "a.gpkg",
        *shapely.to_wkb(shapely.points(given[:, : 2 if flat else 3]), flavor="iso"),
        kind="Point" if flat else "Point Z",
        elev=given[:, 2],
    )
    survey = read(path)
    assert any("-9999, far from the others (10 to 13)" in note for note in survey.notes)
    survey = read(path, nodata=-9999)
    assert survey.points[:, 2].tolist() == [10, 12, 13]
    assert survey.skipped == {"nodata points": 1}
    with pytest.raises(ReadError, match="no elevation but nodata"):
        read(path, nodata=[-9999, 10, 12, 13])


def test_two_heights_of_water_that_differ_are_refused_until_told(tmp_path):
    ring = shapely.to_wkb(shapely.polygons(POINTS[[0, 1, 3, 2], :2]))
    path = write_wkb(tmp_path / "a.gpkg", ring, kind="Polygon", z=[5.0], height=[2.0])
    with pytest.raises(ReadError, match=r"they differ: z, height"):
        read_water(path)
    assert read_water(path, z="height")[0].z == 2.0


def test_a_height_of_water_in_feet_is_converted(tmp_path):
    ring = shapely.to_wkb(shapely.polygons(POINTS[[0, 1, 3, 2], :2]))
    path = write_wkb(tmp_path / "a.gpkg", ring, kind="Polygon", level_ft=[100.0])
    water = read_water(path, z="level_ft", crs=UTM, target_unit="m")
    assert water[0].z == pytest.approx(30.48)


# ---------------------------------------------------------------------------- geometry


@pytest.mark.parametrize("suffix", [".gpkg", ".shp"])
@pytest.mark.parametrize(
    "geometries",
    [
        [pack_surface(1016, 1017)],  # TIN Z
        [pack_surface(1015, 1003)],  # PolyhedralSurface Z
        [pack_ring(corners, 1017) for corners in TRIANGLES],  # Triangle Z
        [struct.pack("<BII", 1, 1007, 1) + pack_surface(1016, 1017)],  # in a collection
    ],
    ids=["tin", "polyhedral", "triangles", "collection"],
)
def test_surfaces_that_geos_does_not_know_are_read_as_a_tin(tmp_path, suffix, geometries):
    driver = "GPKG" if suffix == ".gpkg" else "ESRI Shapefile"
    tin = read(write_wkb(tmp_path / f"a{suffix}", *geometries, driver=driver))
    corners = np.sort(tin.points[tin.triangles], axis=1)
    assert corners.tolist() == np.sort(TRIANGLES, axis=1).tolist()


def test_surfaces_of_big_endian_and_flagged_kinds():
    from tinsmith.io.vector.well_known_binary import replace_surfaces

    ring = np.vstack([TRIANGLES[0], TRIANGLES[0][:1]])
    inner = struct.pack(">BIII", 0, 0x80000000 + 17, 1, 4) + ring.astype(">f8").tobytes()
    surface = struct.pack(">BII", 0, 0x80000000 + 16, 1) + inner
    shape = shapely.from_wkb(replace_surfaces(surface))
    assert shapely.equals(shape, shapely.multipolygons([shapely.polygons(TRIANGLES[0])]))
    assert shapely.has_z(shape)
    for end in range(len(surface)):
        assert replace_surfaces(surface[:end]) == surface[:end]


def test_a_tin_is_no_lines(tmp_path):
    path = write_wkb(tmp_path / "a.gpkg", pack_surface(1016, 1017))
    with pytest.raises(ReadError, match="another kind"):
        read_lines(path)


@pytest.mark.parametrize("m", [0, 1])
def test_a_layer_of_any_kind_with_elevations_and_measures(tmp_path, m):
    path = write_wkb(
        tmp_path / "a.gpkg", *shapely.to_wkb(shapely.points(POINTS), flavor="iso"), kind="Point Z"
    )
    with closing(sqlite3.connect(path)) as base:
        base.execute("UPDATE gpkg_geometry_columns SET geometry_type_name='GEOMETRY', m=?", [m])
        base.commit()
    assert np.array_equal(read(path).points, POINTS)


def test_measures_are_no_elevations(tmp_path):
    pieces = [struct.pack("<BI3d", 1, 2001, *point) for point in POINTS.tolist()]
    path = write_wkb(tmp_path / "a.fgb", *pieces, driver="FlatGeobuf")
    with pytest.raises(ReadError, match="no elevations"):
        read(path)


@pytest.mark.parametrize("seed", range(20))
def test_records_made_by_arrays_are_those_of_geos(seed):
    from tinsmith.base.results.geometries import build_geometries
    from tinsmith.io.vector.ogr import encode_geometries
    from tinsmith.io.vector.well_known_binary import encode_equal_shapes

    rng = np.random.default_rng(seed)
    width, count, length = int(rng.integers(2, 4)), int(rng.integers(1, 9)), int(rng.integers(4, 7))
    rows = rng.random((count * length, width))
    bounds = np.arange(0, count * length + 1, length)
    rows[bounds[1:] - 1] = rows[bounds[:-1]]
    made = {
        0: lambda: ts.Features.of_points(rows),
        1: lambda: ts.Features.of_lines(rows, bounds),
        2: lambda: ts.Features.of_polygons(rows, bounds, np.arange(count + 1)),
    }[seed % 3]()
    assert encode_equal_shapes(made) is not None
    wanted = shapely.to_wkb(build_geometries(made), output_dimension=width, flavor="iso")
    assert encode_geometries(made).tolist() == wanted.tolist()


# --------------------------------------------------------------------------- shapefiles


def write_shapefile(folder, texts=("Bäume", "Graß", "ž"), *, encoding="UTF-8", said=None):
    path = folder / "a.shp"
    pyogrio.raw.write(
        str(path),
        shapely.to_wkb(shapely.points(POINTS[: len(texts)]), flavor="iso"),
        [np.array(texts, object)],
        ["code"],
        geometry_type="Point Z",
        crs=UTM,
        encoding=encoding,
        driver="ESRI Shapefile",
    )
    if said is None:
        path.with_suffix(".cpg").unlink(missing_ok=True)
        table = path.with_suffix(".dbf")
        content = bytearray(table.read_bytes())
        content[29] = 0  # the driver of the language
        table.write_bytes(content)
    else:
        path.with_suffix(".cpg").write_text(said)
    return path


@pytest.mark.parametrize(
    ("encoding", "said", "words"),
    [
        ("UTF-8", None, "though the file does not say so"),
        ("UTF-8", "ISO-8859-1", "though the file does not say so"),
        ("UTF-8", "UTF-8", ""),
        ("CP1252", "UTF-8", "no UTF-8, which they are said to be"),
        ("ISO-8859-1", None, ""),
        ("ISO-8859-1", "ISO-8859-1", ""),
    ],
)
def test_texts_of_a_shapefile_in_another_encoding_than_it_says(tmp_path, encoding, said, words):
    texts = ["Bäume", "Graß", "ž" if encoding == "UTF-8" else "é"]
    survey = read(write_shapefile(tmp_path, texts, encoding=encoding, said=said))
    assert survey.attributes["code"].tolist() == texts
    assert (words in " ".join(survey.notes)) if words else not survey.notes


def test_a_shapefile_without_its_index_is_refused_by_name(tmp_path):
    path = write_shapefile(tmp_path)
    path.with_suffix(".shx").unlink()
    with pytest.raises(ReadError, match=r"lacks its part 'a\.shx'"):
        read(path)
    assert not path.with_suffix(".shx").exists()


def test_a_shapefile_without_a_crs_and_one_that_is_not_understood(tmp_path):
    path = write_shapefile(tmp_path, said="UTF-8")
    path.with_suffix(".prj").write_text("garbage")
    survey = read(path)
    assert survey.crs is None
    assert survey.notes == ["'a.prj' names a CRS that is not understood: it was left aside."]
    path.with_suffix(".prj").unlink()
    assert read(path).notes == []
    assert read(path, crs=UTM).crs == UTM


# --------------------------------------------------------------------------- MultiPatch


def make_tin(n=60):
    points = POINTS[0] + np.random.default_rng(2).random((n, 3)) * (100, 100, 9)
    return ts.triangulate(points.round(3), crs=UTM)


def test_a_multipatch_holds_the_triangles(tmp_path):
    tin = make_tin()
    path = ts.write(tin, tmp_path / "a.shp", multipatch=True)
    assert struct.unpack_from("<i", path.read_bytes(), 32) == (31,)  # MultiPatch
    again = read(path)
    assert again.crs == tin.crs

    def list_triangles(one):
        return sorted(np.sort(one.points[one.triangles], axis=1).tolist())

    assert list_triangles(again) == list_triangles(tin)


def test_only_a_tin_is_a_multipatch(tmp_path):
    tin = make_tin()
    with pytest.raises(FormatError, match="a survey has none"):
        ts.write(ts.Survey(points=tin.points), tmp_path / "a.shp", multipatch=True)
    with pytest.raises(FormatError, match="no features"):
        ts.write(ts.contours(tin, interval=2), tmp_path / "a.shp", multipatch=True)
    with pytest.raises(FormatError, match="no points"):
        ts.write(tin, tmp_path / "a.shp", multipatch=True, kind="points")
    assert list(tmp_path.iterdir()) == []
