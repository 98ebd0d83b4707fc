"""Flow, sight, ground, grading, differences and the like in QGIS: results of the package itself."""

from __future__ import annotations

import csv

import numpy as np
import pytest
import shapely
from support import qgis_jobs as qgis
from support.qgis_plugin import drive

import tinsmith as ts

ORIGIN = [500_000.0, 4_000_000.0]
EYE = [752740.0, 4024250.0]
PLACES = [[752740.0, 4024250.0], [752780.0, 4024290.0]]
PAD = [[752740.0, 4024290.0], [752780.0, 4024290.0], [752780.0, 4024315.0], [752740.0, 4024315.0]]
AXIS = [[752740.0, 4024290.0, 327.0], [752780.0, 4024300.0, 328.0]]
TEMPLATE = (
    "side,name,width,slope,use,ratio\nboth,lane,3,-0.02,turns,\nboth,,,,cut,2\nboth,,,,fill,2\n"
)
MIDDLE = [[752735.0, 4024302.5], [752785.0, 4024302.5]]
SECTIONS = [
    [[x, 4024312.0, z + 3], [x, 4024304.0, z], [x, 4024300.0, z], [x, 4024293.0, z + 3]]
    for x, z in ((752745.0, 320.0), (752775.0, 319.0))
]
ACROSS = [[752400.0, 4024260.0], [752760.0, 4024262.5]]
"""A line that begins outside the surface."""
STATIONS = [
    [752740.123456789, 4024290.1, "a, b", 0.1 + 0.2, True, "2024-05-01"],
    [752781.0, 4024261.7, 'the "old"\npeg', None, False, None],
    [752400.0, 4024250.3, "beyond", 7.0, None, "1999-12-31"],
]
"""Easting, northing; columns named note, x, seen and day."""
PATCH = [[752700.0, 4024240.0, 330.0], [752720.0, 4024240.0, 330.0], [752710.0, 4024260.0, 331.0]]


def make_site(folder):
    """Return the TIN of the sample, and layers: its own, a pad, places, a cloud with a building."""
    tin, layers = qgis.make_inputs(folder, qgis.read_survey())
    ts.write(ts.triangulate(PATCH, crs=qgis.UTM), folder / "patch.ply")
    ts.write(make_cloud(), folder / "cloud.gpkg")
    (folder / "template.csv").write_text(TEMPLATE)
    (folder / "turns.json").write_text('[{"station": 0, "left": 0.03, "right": -0.03}]')
    places = ts.Survey(points=np.pad(PLACES, [(0, 0), (0, 1)]), crs=qgis.UTM)
    around = ts.reproject(places, "EPSG:4326")
    degrees = [[qgis.write_wkt("Point", [row[:2]]), []] for row in around.points]
    return tin, layers | {
        "pad": qgis.make_layer("Polygon", [[qgis.write_wkt("Polygon", [*PAD, PAD[0]]), []]]),
        "road": qgis.make_layer("LineStringZ", [[qgis.write_wkt("LineString Z", AXIS), []]]),
        "middle": qgis.make_layer("LineString", [[qgis.write_wkt("LineString", MIDDLE), []]]),
        "sections": qgis.make_layer(
            "LineStringZ", [[qgis.write_wkt("LineString Z", one), []] for one in SECTIONS]
        ),
        "patch": {"kind": "mesh", "path": str(folder / "patch.ply")},
        "cloud": {"kind": "vector", "path": str(folder / "cloud.gpkg")},
        "places": qgis.make_layer("Point", degrees, crs="EPSG:4326"),
    }


def make_cloud():
    """Return inclined ground with a building of 10 m on it, and one point far too high."""
    rng = np.random.default_rng(5)
    xy = rng.random((1500, 2)) * 60
    z = 0.05 * xy[:, 0] + np.where((np.abs(xy - 30) < 5).all(axis=1), 6.0, 0.0)
    z[0] += 40.0
    return ts.Survey(points=np.column_stack([np.add(xy, ORIGIN), z]), crs=qgis.UTM)


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_results_are_those_of_the_package(tmp_path):
    tin, layers = make_site(tmp_path)
    at = ",".join(map(str, EYE))
    slopes = {"ELEVATION": 327, "CUT_SLOPE": 2, "FILL_SLOPE": 3}
    jobs = {
        "hollows": qgis.job("flow", INPUT="ground", MIN_DEPTH=0.2,
                            OUTPUT=tmp_path / "hollows.gpkg"),
        "drops": qgis.job("flow", INPUT="ground", FIND="paths", PLACES="places",
                          OUTPUT=tmp_path / "drops.gpkg"),
        "channels": qgis.job("flow", INPUT="ground", FIND="accumulation", MIN_AREA=200,
                             OUTPUT=tmp_path / "channels.gpkg"),
        "catchments": qgis.job("flow", INPUT="ground", FIND="catchments",
                               OUTPUT=tmp_path / "catchments.gpkg"),
        "seen": qgis.job("sight", INPUT="ground", EYE=f"{at} [{qgis.UTM}]", EYE_HEIGHT=1.7,
                         OUTPUT=tmp_path / "seen.gpkg"),
        "lines": qgis.job("sight", INPUT="ground", EYE=at, EYE_HEIGHT=1.7,
                          TARGETS={"selected": "flat"}, OUTPUT=tmp_path / "lines.gpkg"),
        "low": qgis.job("ground", INPUT="cloud", BUILDING=20, CLASSIFIED=tmp_path / "all.las",
                        OUTPUT=tmp_path / "low.gpkg"),
        "graded": qgis.job("grade", INPUT="ground", PAD="pad",
                           OUTPUT=tmp_path / "graded.ply", **slopes),
        "road": qgis.job("corridor", INPUT="ground", LINE="road",
                         TEMPLATE=str(tmp_path / "template.csv"),
                         SUPERELEVATION=str(tmp_path / "turns.json"),
                         OUTPUT=tmp_path / "road.ply"),
        "bed": qgis.job("riverbed", SECTIONS="sections", LINE="middle", SPACING=5,
                        OUTPUT=tmp_path / "bed.ply"),
        "level": qgis.job("hydroflatten", INPUT="ground", STREAM="pad", CENTRELINE="middle",
                          DOWNSTREAM="along", SPACING=5, OUTPUT=tmp_path / "level.ply"),
        "pasted": qgis.job("paste", BASE="ground", PATCH="patch", OUTPUT=tmp_path / "pasted.nc"),
        "merged": qgis.job("merge", FIRST="patch", SECOND="ground", BLEND=2.5,
                           OUTPUT=tmp_path / "merged.ply"),
        "clipped": qgis.job("clip", INPUT="ground", POLYGONS="pad", OUTPUT=tmp_path / "part.ply"),
        "shifted": qgis.job("coregister", SHIFTED="ground", REFERENCE="ground", UNSTABLE="pad",
                            OUTPUT=tmp_path / "shifted.ply"),
        "suspects": qgis.job("inspect", INPUT="cloud", OUTPUT=tmp_path / "suspects.gpkg"),
        "alone": qgis.job("paste", BASE="ground", OUTPUT=tmp_path / "no.ply"),
        "outside": qgis.job("sight", INPUT="ground", EYE=f"0,0 [{qgis.UTM}]",
                            OUTPUT=tmp_path / "no.gpkg"),
    }  # fmt: skip
    told = drive(tmp_path, layers, jobs)
    assert "Patch: choose a layer or a file" in told.pop("alone")["error"]
    assert "outside the surface" in told.pop("outside")["error"]
    qgis.require_done(told)
    check_flow(told, tin, tmp_path)
    check_sight(told, tin, tmp_path)
    check_points(told, tmp_path)
    check_earthwork(told, tin, tmp_path)


def check_flow(told, tin, folder):
    found = {
        "hollows": ts.depressions(tin, min_depth=0.2),
        "channels": ts.flow_accumulation(tin, min_area=200),
        "catchments": ts.catchments(tin),
    }
    for name, wanted in found.items():
        again = ts.write(wanted, folder / f"wanted {name}.gpkg")
        assert qgis.read_layer(folder / f"{name}.gpkg") == qgis.read_layer(again), name
        layer = qgis.take_layer(told[name], name)
        assert (layer["count"], layer["crs"]) == (len(wanted), qgis.UTM)
        assert len(layer["properties"]) == (name != "hollows")
    drops = ts.flow_path(tin, PLACES)
    _, _, (_, ends, lengths, _) = qgis.read_layer(folder / "drops.gpkg")
    assert ends == drops.columns["end"].tolist()
    assert lengths == pytest.approx(drops.columns["length"], abs=1e-4)


def check_sight(told, tin, folder):
    seen = ts.viewshed(tin, EYE, eye_height=1.7)
    wanted = ts.write(seen, folder / "wanted seen.gpkg")
    assert qgis.read_layer(folder / "seen.gpkg") == qgis.read_layer(wanted)
    layer = qgis.take_layer(told["seen"], "seen")
    assert layer["legend"] == seen.columns["class"].tolist()
    assert layer["colors"] == seen.columns["color"].tolist()
    assert layer["unclassified"] == 0
    targets = qgis.read_survey().points[:300, :2]
    lines = ts.line_of_sight(tin, EYE, targets, eye_height=1.7)
    layer = qgis.take_layer(told["lines"], "lines")
    assert (layer["count"], layer["legend"]) == (300, ["visible", "blocked"])
    assert layer["unclassified"] == 0
    _, shapes, columns = qgis.read_layer(folder / "lines.gpkg")
    _, wanted, values = qgis.read_layer(ts.write(lines, folder / "wanted lines.gpkg"))
    assert shapes == wanted
    np.testing.assert_array_equal(columns, values)


def check_points(told, folder):
    made = ts.ground(make_cloud(), building=20)
    found = ts.read(folder / "low.gpkg", z_field="geometry")
    np.testing.assert_array_equal(found.points, made.survey.points)
    outputs = told["low"]["outputs"]
    assert [outputs[name] for name in ("GROUND", "OTHERS", "NOISE")] == list(made.counts.values())
    assert outputs["OTHERS"] > 10
    classes = ts.read(folder / "all.las", attributes="all").attributes["classification"]
    np.testing.assert_array_equal(classes, made.classification)
    assert qgis.take_layer(told["low"], "low")["count"] == len(made.survey)
    suspects = ts.blunders(make_cloud())
    layer = qgis.take_layer(told["suspects"], "suspects")
    assert (layer["field"], layer["unclassified"], layer["labels"]) == ("certainty", 0, True)
    assert told["suspects"]["outputs"]["SUSPECTS"] == layer["count"] == len(suspects) > 0
    found = ts.read(folder / "suspects.gpkg", z_field="geometry")
    np.testing.assert_array_equal(found.attributes["row"], suspects["row"])


def check_earthwork(told, tin, folder):
    graded = ts.grade(tin, PAD, 327, cut_slope=2, fill_slope=3)
    qgis.assert_same_tin(ts.read(folder / "graded.ply"), graded)
    table = ts.volume(tin, graded)
    outputs = told["graded"]["outputs"]
    assert outputs["CUT"] == pytest.approx(table["cut"][0], rel=1e-12)
    assert outputs["FILL"] == pytest.approx(table["fill"][0], rel=1e-12)
    made = ts.corridor(
        tin,
        AXIS,
        ts.read_template(folder / "template.csv"),
        superelevation=ts.read_superelevation(folder / "turns.json"),
    )
    qgis.assert_same_tin(ts.read(folder / "road.ply"), made)
    assert told["road"]["outputs"]["CUT"] == pytest.approx(ts.volume(tin, made)["cut"][0])
    pasted = ts.paste(tin, ts.triangulate(PATCH, crs=qgis.UTM))
    qgis.assert_same_tin(ts.read(folder / "pasted.nc"), pasted)
    assert qgis.take_layer(told["pasted"], "pasted")["faces"] == len(pasted.triangles)
    assert told["pasted"]["outputs"]["TRIANGLES"] == len(pasted.triangles)
    said = [text for kind, text in told["pasted"]["log"] if kind == "info"]
    assert any("Along the seam" in text for text in said)
    merged = ts.merge([ts.triangulate(PATCH, crs=qgis.UTM), tin], blend=2.5)
    qgis.assert_same_tin(ts.read(folder / "merged.ply"), merged)
    shifted = ts.coregister(tin, tin, unstable=[PAD]).tin
    qgis.assert_same_tin(ts.read(folder / "shifted.ply"), shifted)
    assert qgis.take_layer(told["shifted"], "shifted")["faces"] == len(shifted.triangles)
    bed = ts.riverbed([np.array(one) for one in SECTIONS], MIDDLE, spacing=5, crs=qgis.UTM)
    qgis.assert_same_tin(ts.read(folder / "bed.ply"), bed)
    level = ts.hydroflatten(tin, [PAD], MIDDLE, downstream="along", spacing=5)
    qgis.assert_same_tin(ts.read(folder / "level.ply"), level)
    clipped = ts.clip(tin, [PAD])
    qgis.assert_same_tin(ts.read(folder / "part.ply"), clipped)
    assert qgis.take_layer(told["clipped"], "part")["faces"] == len(clipped.triangles)


# ------------------------------------------------- differences, and elevations of a surface


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_differences_and_elevations_are_those_of_the_package(tmp_path):
    tin, layers = make_site(tmp_path)
    graded = ts.grade(tin, PAD, 327, cut_slope=2, fill_slope=3)
    ts.write(graded, tmp_path / "design.ply")
    rows = [[qgis.write_wkt("Point", [row[:2]]), row[2:]] for row in STATIONS]
    columns = ["note:string", "X:double", "seen:boolean", "day:date"]
    layers |= {
        "design": {"kind": "mesh", "path": str(tmp_path / "design.ply")},
        "across": qgis.make_layer(
            "LineString", [[qgis.write_wkt("LineString", ACROSS), ["k"]]], columns=["name:string"]
        ),
        "stations": qgis.make_layer("Point", rows, columns=columns),
        "taken": qgis.make_layer("Point", [[rows[0][0], [1.0]]], columns=["elevation:double"]),
        "pairs": qgis.make_layer("MultiPoint", [["MultiPoint((1 2), (3 4))", []]]),
        "empty": qgis.make_layer("Point", [[rows[0][0], []], ["Point EMPTY", []]]),
    }
    (tmp_path / "places.csv").write_text("id;lon;lat\n7;-84.2;36.3\n")
    jobs = {
        "difference": qgis.job("diff", BEFORE="ground", AFTER="design", LEVEL_OF_DETECTION=0.25,
                               OUTPUT=tmp_path / "difference.ply", ZONES=tmp_path / "zones.gpkg",
                               TABLE=tmp_path / "differs.csv", PICTURE=tmp_path / "map.png"),
        "raised": qgis.job("diff", BEFORE="ground", AFTER="flat", AFTER_Z_FIELD="high",
                           OUTPUT=tmp_path / "raised.nc"),
        "draped": qgis.job("drape", INPUT="ground", FEATURES="pad", OUTPUT=tmp_path / "rim.gpkg"),
        "inside": qgis.job("drape", INPUT="flat", INPUT_Z_FIELD="high", FEATURES="across",
                           OUTSIDE="cut", OUTPUT=tmp_path / "inside.gpkg"),
        "spots": qgis.job("drape", INPUT="ground", FEATURES="places",
                          OUTPUT=tmp_path / "spots.gpkg"),
        "smooth": qgis.job("interpolate", INPUT="ground", AT="stations", METHOD="natural",
                           EXTRAPOLATE="nearest", OUTPUT=tmp_path / "smooth.csv"),
        "chosen": qgis.job("interpolate", INPUT="flat", INPUT_Z_FIELD="high",
                           AT={"selected": "flat"}, COLUMN="z_tin",
                           OUTPUT=tmp_path / "chosen.csv"),
        "degrees": qgis.job("interpolate", INPUT="ground", AT="places",
                            OUTPUT=tmp_path / "degrees.csv"),
        "file": qgis.job("interpolate", INPUT="ground", AT_FILE=tmp_path / "places.csv",
                         AT_CRS="EPSG:4326", OUTPUT=tmp_path / "file.csv"),
    }  # fmt: skip
    refused = list_refused(tmp_path)
    told = drive(tmp_path, layers, jobs | refused)
    for words in refused:
        assert words in (told.pop(words)["error"] or ""), words
    assert not list(tmp_path.glob("no.*"))
    qgis.require_done(told)
    check_differences(told, tin, graded, tmp_path)
    check_draped(told, tin, tmp_path)
    check_elevations(told, tin, tmp_path)


def list_refused(folder):
    """Return jobs that are refused, by words of the sentence."""
    nowhere = folder / "no.csv"
    return {
        "After: choose a layer or a file": qgis.job("diff", BEFORE="ground",
                                                    OUTPUT=folder / "no.ply"),
        "outside the surface": qgis.job("drape", INPUT="ground", FEATURES="across",
                                        OUTPUT=folder / "no.gpkg"),
        "Points: choose a layer or a file": qgis.job("interpolate", INPUT="ground",
                                                     OUTPUT=nowhere),
        "choose one of them": qgis.job("interpolate", INPUT="ground", AT="places",
                                       AT_FILE=folder / "places.csv", OUTPUT=nowhere),
        "whose CRS is taken": qgis.job("interpolate", INPUT="ground", AT="places",
                                       AT_CRS="EPSG:4326", OUTPUT=nowhere),
        "column 'elevation' already": qgis.job("interpolate", INPUT="ground", AT="taken",
                                               OUTPUT=nowhere),
        "of the layer 'pairs' has 2 points": qgis.job("interpolate", INPUT="ground", AT="pairs",
                                                      OUTPUT=nowhere),
        "of the layer 'empty' has no points": qgis.job("interpolate", INPUT="ground", AT="empty",
                                                       OUTPUT=nowhere),
    }  # fmt: skip


def check_differences(told, tin, graded, folder):
    wanted = ts.difference(tin, graded, level_of_detection=0.25)
    qgis.assert_same_tin(ts.read(folder / "difference.ply"), wanted.tin)
    outputs, statistics = told["difference"]["outputs"], wanted.statistics
    assert [outputs[name] for name in ("CUT", "FILL")] == [wanted.cut, wanted.fill]
    assert [outputs["MEAN"], outputs["RMS"]] == [statistics["mean"][0], statistics["rms"][0]]
    assert outputs["TRIANGLES"] == len(wanted.tin.triangles)
    volumes = ts.volume(tin, graded)
    assert outputs["FILL"] == pytest.approx(volumes["fill"][0], rel=1e-9)
    layer = qgis.take_layer(told["difference"], "difference")
    reach = np.abs(wanted.tin.points[:, 2]).max()
    assert layer["range"] == pytest.approx([-reach, reach], rel=1e-12)
    values = np.array(list(map(float, layer["colors"])))
    colors = list(layer["colors"].values())
    assert values == pytest.approx([-reach, 0, reach], abs=1e-9)
    assert colors == ["#c4533f", "#ffffff", "#3b77b0"]
    zones = qgis.take_layer(told["difference"], "zones")
    assert (zones["field"], zones["unclassified"]) == ("kind", 0)
    again = ts.write(wanted.zones, folder / "wanted zones.gpkg")
    assert qgis.read_layer(folder / "zones.gpkg") == qgis.read_layer(again)
    with (folder / "differs.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert len(row) == len(statistics.columns)
    assert (folder / "map.png").read_bytes().startswith(b"\x89PNG")
    raised = ts.read(folder / "raised.nc")
    assert raised.points[:, 2] == pytest.approx(np.ones(len(raised.points)), abs=1e-9)


def read_vertices(path):
    return shapely.get_coordinates(shapely.from_wkb(qgis.read_layer(path)[1]), include_z=True)


def check_draped(told, tin, folder):
    for name, given, options in (
        ("rim", ts.Features.of_polygons([*PAD, PAD[0]], [0, 5], [0, 1], crs=qgis.UTM), {}),
        ("inside", ts.Features.of_lines(ACROSS, [0, 2], crs=qgis.UTM), {"outside": "cut"}),
    ):
        wanted = ts.drape(tin, given, **options).coordinates
        found = read_vertices(folder / f"{name}.gpkg")
        lift = np.array([0.0, 0.0, 1.0 if name == "inside" else 0.0])
        np.testing.assert_allclose(found, wanted + lift, rtol=0, atol=1e-9)
        assert len(found) > 4
    columns, _, values = qgis.read_layer(folder / "inside.gpkg")
    assert values[columns.index("name")] == ["k"]
    layer = qgis.take_layer(told["inside"], "inside")
    assert (layer["count"], layer["crs"]) == (1, qgis.UTM)
    assert "Z" in layer["shapes"][0].partition("(")[0]
    spots = read_vertices(folder / "spots.gpkg")
    np.testing.assert_allclose(spots[:, :2], PLACES, atol=1e-5)
    np.testing.assert_allclose(spots[:, 2], tin.interpolate(PLACES), atol=1e-4)


def read_rows(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def check_elevations(told, tin, folder):
    at = np.array([row[:2] for row in STATIONS])
    rows = read_rows(folder / "smooth.csv")
    *names, elevation = rows[0]
    assert names == ["x_2", "y", "note", "X", "seen", "day"]
    assert elevation.partition(" (")[0] == "elevation"
    wanted = tin.interpolate(at, method="natural", extrapolate="nearest")
    np.testing.assert_array_equal([float(row[elevation]) for row in rows], wanted)
    np.testing.assert_array_equal([[float(row["x_2"]), float(row["y"])] for row in rows], at)
    assert [row["note"] for row in rows] == [row[2] for row in STATIONS]
    assert [row["X"] for row in rows] == ["0.30000000000000004", "", "7.0"]
    assert [row["seen"] for row in rows] == ["true", "false", ""]
    assert [row["day"] for row in rows] == ["2024-05-01", "", "1999-12-31"]
    layer = qgis.take_layer(told["smooth"], "smooth")
    assert (layer["count"], layer["crs"]) == (3, qgis.UTM)
    assert layer["shapes"][1] == "Point (752781 4024261.70000000018626451)"
    assert told["smooth"]["outputs"]["COUNT"] == 3
    assert told["smooth"]["outputs"]["OUTSIDE"] == 0
    survey = qgis.read_survey().points[:300]
    rows = read_rows(folder / "chosen.csv")
    (column,) = [name for name in rows[0] if name.startswith("z_tin")]
    found = [float(row[column] or "nan") for row in rows]
    np.testing.assert_allclose(found, tin.interpolate(survey[:, :2]) + 1, atol=1e-9)
    assert [int(row["fid"]) for row in rows] == list(range(300))
    rows = read_rows(folder / "degrees.csv")
    found = [float(row[list(row)[-1]]) for row in rows]
    np.testing.assert_allclose(found, tin.interpolate(PLACES), atol=1e-4)
    assert qgis.take_layer(told["degrees"], "degrees")["crs"] == "EPSG:4326"
    (row,) = read_rows(folder / "file.csv")
    assert list(row)[:3] == ["id", "lon", "lat"]
    assert told["file"]["outputs"]["OUTSIDE"] == 1
