"""``tinsmith profile`` and ``tinsmith drape`` as people run them."""

import csv
import json
from pathlib import Path

import ezdxf
import numpy as np
import pyogrio
import pytest
import shapely
from support.commands import refuse, run
from support.printed import read_pdf

import tinsmith as ts

SITE = str(Path(__file__).parents[2] / "sample_data" / "site_survey.csv")
LINE = ("--from", 752690, 4024225, "--to", 752850, 4024330)
UTM = "EPSG:32616"


@pytest.fixture
def site(tmp_path):
    tin = ts.triangulate(ts.read(SITE, crs=UTM))
    return ts.write(tin, tmp_path / "site.ply")


def write_lines(path, lines, crs=UTM, **columns):
    shapes = shapely.to_wkb([shapely.LineString(line) for line in lines])
    fields = list(columns)
    data = [np.array(columns[name], object) for name in fields]
    pyogrio.raw.write(
        path, shapes, field_data=data, fields=fields, crs=crs, geometry_type="LineString"
    )
    return path


def read_csv(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_profile_is_a_table_and_a_picture(site, tmp_path):
    table, picture = tmp_path / "a.csv", tmp_path / "a.png"
    out = run("profile", site, *LINE, "-o", table, "-o", picture, "--json")
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    rows = read_csv(table)
    assert facts["rows"] == len(rows) > 50
    assert facts["outputs"] == [str(table), str(picture)]
    tin = ts.read(site)
    expected = ts.profile(tin, [[752690, 4024225], [752850, 4024330]])
    station = [float(row["station (m)"]) for row in rows]
    assert station == expected["station"].tolist()
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_picture_knows_the_crs(site, tmp_path, monkeypatch):
    drawn = []

    def draw(table, **look):
        drawn.append(look["crs"])
        return profile_picture(table, **look)

    profile_picture = ts.profile_picture
    monkeypatch.setattr("tinsmith.terrain.profile_picture", draw)
    out = run("profile", site, *LINE, "-o", tmp_path / "a.png")
    assert out.exit_code == 0, out.output
    assert drawn == [UTM]


def test_several_surfaces_have_names(site, tmp_path):
    tin = ts.read(site)
    raised = ts.write(tin.replace(points=tin.points + np.array([0, 0, 2.0])), tmp_path / "b.ply")
    args = ("profile", site, raised, *LINE, "--name", "old", "--name", "new", "--interval", 10)
    out = run(*args, "-o", tmp_path / "a.json", "-o", tmp_path / "a.png")
    assert out.exit_code == 0, out.output
    text = (tmp_path / "a.json").read_text()
    assert "difference_new" in text
    assert "old" in out.stderr


def test_a_name_is_taken_for_one_surface_too(site, tmp_path):
    out = run("profile", site, *LINE, "--name", "ground", "-o", tmp_path / "a.csv")
    assert out.exit_code == 0, out.output
    assert "crossed_ground" in read_csv(tmp_path / "a.csv")[0]


def test_lines_of_a_file_are_reprojected(site, tmp_path):
    here = [[752690, 4024225], [752850, 4024330]]
    there = ts.transform_points([[*xy, 0.0] for xy in here], UTM, "EPSG:4326")[:, :2]
    lines = write_lines(tmp_path / "lines.gpkg", [there], "EPSG:4326")
    out = run("profile", site, "--line", lines, "-o", tmp_path / "a.csv")
    assert out.exit_code == 0, out.output
    rows = read_csv(tmp_path / "a.csv")
    assert [float(rows[0]["x (m)"]), float(rows[0]["y (m)"])] == pytest.approx(here[0], abs=1e-6)


def test_sections_are_tables_and_lines_in_space(site, tmp_path):
    table, lines = tmp_path / "a.csv", tmp_path / "a.gpkg"
    out = run("profile", site, *LINE, "--sections", 20, 10, "-o", table, "-o", lines)
    assert out.exit_code == 0, out.output
    sections = {row["section"] for row in read_csv(table)}
    assert len(sections) == 11
    meta, _, shapes, _ = pyogrio.raw.read(lines)
    assert len(shapes) == 11
    assert meta["geometry_type"].endswith("Z")


def test_sections_are_drawn_on_a_sheet(site, tmp_path):
    out = run("profile", site, *LINE, "--sections", 20, 10, "-o", tmp_path / "a.png")
    assert out.exit_code == 0, out.output
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_points_are_triangulated_with_their_lines(tmp_path):
    out = run("profile", SITE, "--crs", UTM, "--codes", *LINE, "-o", tmp_path / "a.csv")
    assert out.exit_code == 0, out.output
    crossed = {row["crossed"] for row in read_csv(tmp_path / "a.csv")}
    assert "breakline" in crossed


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (("-o", "a.csv"), "A line is needed"),
        (("--from", 1, 1, "-o", "a.csv"), "A line is needed"),
        ((*LINE, "--line", SITE, "-o", "a.csv"), "A line is needed"),
        (("--from", 1, 1, "--to", 1, 1, "-o", "a.csv"), "no length"),
        (("--from", 1, 1, "--to", "nan", 2, "-o", "a.csv"), "not finite"),
        (("--from", 1, 1, "--to", 2, 2, "-o", "a.csv"), "lies outside the surface"),
        ((*LINE, "--interval", 0, "-o", "a.csv"), "Invalid --interval 0.0"),
        ((*LINE, "--interval", 1e-9, "-o", "a.csv"), "at most 1,000,000"),
        ((*LINE, "--sections", 10, 0, "-o", "a.csv"), "Invalid --sections 0.0"),
        ((*LINE, "--sections", 1, 5, "-o", "a.png"), "at most 60 on a sheet"),
        ((*LINE, "-o", "a.gpkg"), "a Table can be written to"),
        ((*LINE, "--name", "a", "--name", "b", "-o", "a.csv"), "name each once"),
        ((*LINE, "--exaggeration", -1, "-o", "a.png"), "Invalid --exaggeration"),
        ((*LINE, "--exaggeration", 1e9, "-o", "a.csv", "-o", "a.png"), "or less here"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_written(site, tmp_path, arguments, why):
    given = [tmp_path / a if a in ("a.csv", "a.png", "a.gpkg") else a for a in arguments]
    assert why in " ".join(refuse("profile", site, *given).split())
    assert {path.name for path in tmp_path.iterdir()} == {"site.ply"}


def test_inputs_are_not_overwritten(site, tmp_path):
    before = site.read_bytes()
    copy = tmp_path / "a.csv"
    copy.write_bytes(Path(SITE).read_bytes())
    assert "cannot be the output too" in refuse("profile", copy, *LINE, "-o", copy)
    assert "is the input" in refuse("profile", site, *LINE, "-o", site)
    assert site.read_bytes() == before


def test_surfaces_of_one_name_are_told_apart_by_the_user(site, tmp_path):
    text = refuse("profile", site, site, *LINE, "-o", tmp_path / "a.csv")
    assert "Two surfaces are called 'site'" in text


def test_features_are_draped_with_their_columns(site, tmp_path):
    line = [[752690, 4024225], [752850, 4024330]]
    given = write_lines(tmp_path / "roads.gpkg", [line], name=["Main St"])
    out = run("drape", site, given, "-o", tmp_path / "b.gpkg", "--json")
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    assert facts["vertices_draped"] > facts["vertices_given"] == 2
    meta, _, shapes, columns = pyogrio.raw.read(tmp_path / "b.gpkg")
    assert [column.tolist() for column in columns] == [["Main St"]]
    coordinates = shapely.get_coordinates(shapely.from_wkb(shapes), include_z=True)
    assert coordinates == pytest.approx(ts.drape(ts.read(site), line).coordinates)
    assert meta["crs"] == UTM


def test_what_lies_outside_is_refused_told_or_cut(site, tmp_path):
    line = [[752690, 4024225], [753850, 4024330]]
    given = write_lines(tmp_path / "roads.gpkg", [line])
    text = refuse("drape", site, given, "-o", tmp_path / "b.gpkg")
    assert "1 of 1 line lies outside the surface" in text
    assert "--outside" in text
    assert not (tmp_path / "b.gpkg").exists()
    out = run("drape", site, given, "-o", tmp_path / "b.gpkg", "--outside", "cut")
    assert out.exit_code == 0, out.output
    assert "were cut there" in out.stderr


def test_points_and_polygons_are_draped(site, tmp_path):
    for name, shapes, kind in (
        ("points", [shapely.Point(752750, 4024250)], "Point"),
        ("lots", [shapely.box(752700, 4024230, 752720, 4024260)], "Polygon"),
    ):
        path = tmp_path / f"{name}.gpkg"
        pyogrio.raw.write(
            path, shapely.to_wkb(shapes), field_data=[], fields=[], crs=UTM, geometry_type=kind
        )
        out = run("drape", site, path, "-o", tmp_path / f"{name}.geojson", "--projected")
        assert out.exit_code == 0, out.output
        (feature,) = json.loads((tmp_path / f"{name}.geojson").read_text())["features"]
        assert feature["geometry"]["type"] == kind


def test_features_of_several_kinds_are_refused(site, tmp_path):
    path = tmp_path / "mixed.geojson"
    shapes = [
        shapely.Point(752750, 4024250),
        shapely.LineString([[752750, 4024250], [752760, 4024250]]),
    ]
    features = [
        {"type": "Feature", "properties": {}, "geometry": shapely.geometry.mapping(one)}
        for one in shapes
    ]
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    text = refuse("drape", site, path, "-o", tmp_path / "b.gpkg")
    assert "one of lines, and the first one of points" in text


# ---------------------------------------------------------------- sheets


@pytest.fixture
def road(tmp_path):
    """A surface, and a road with two gradient lines in LandXML."""
    x, y = np.meshgrid(np.arange(0.0, 401.0, 20.0), np.arange(0.0, 101.0, 20.0))
    points = np.column_stack([x.ravel() + 500_000, y.ravel() + 4e6, 300 + x.ravel() / 40])
    tin = ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")
    rises = [
        ts.VerticalAlignment([ts.VerticalPoint(0, 300 + k), ts.VerticalPoint(380, 308 + k)], name)
        for k, name in enumerate(("FG", "FG2"))
    ]
    line = [[500_010, 4_000_050], [500_390, 4_000_050]]
    axis = ts.Alignment.from_points(line, name="road", crs="EPSG:32616", verticals=rises)
    ts.write(axis, tmp_path / "road.xml")
    return ts.write(tin, tmp_path / "ground.ply"), tmp_path / "road.xml"


def test_a_long_profile_is_drawn_on_sheets(road, tmp_path):
    ground, axis = road
    pdf, drawing = tmp_path / "a.pdf", tmp_path / "a.dxf"
    out = run("profile", ground, "--line", axis, "--vertical", "FG2", "--scale", 1000, "--paper",
              "A2", "--date", "2026-11-27", "-o", pdf, "-o", drawing, "-o", tmp_path / "a.csv",
              "--json")  # fmt: skip
    assert out.exit_code == 0, out.output
    facts = json.loads(out.stdout)
    assert (facts["scale"], facts["sheets"]) == (1000, 1)
    (page,) = read_pdf(pdf)
    words = {text.text for text in page.texts}
    assert {"FG2", "2026-11-27", "1:100  (10 times)", "+2.105 %, 380.00"} <= words
    layers = {layer.dxf.name for layer in ezdxf.readfile(drawing).layers}
    assert {"ground", "FG2", "GRADIENT"} <= layers
    assert (tmp_path / "a.csv").exists()


def test_options_of_sheets_need_sheets(road, tmp_path):
    ground, axis = road
    table = tmp_path / "a.csv"
    text = refuse("profile", ground, "--line", axis, "--scale", 500, "-o", table, code=2)
    assert "--scale is for a drawn profile: name a file that ends in .pdf, .svg, .dxf." in text
    text = refuse("profile", ground, "--line", axis, "-o", tmp_path / "a.pdf")
    assert "has 2 gradient lines: name one by --vertical, of" in text
    assert "'FG', 'FG2'" in text
    text = refuse("profile", ground, "--line", axis, "--sections", 20, 10, "-o",
                  tmp_path / "a.pdf")  # fmt: skip
    assert ".pdf" in text
