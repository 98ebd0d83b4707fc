"""What the commands do: answers, files, options, help."""

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import get_args

import click
import numpy as np
import pytest
from click.testing import CliRunner
from support.commands import run_command as run

import tinsmith as ts
from tinsmith.base.policies import CrossingPolicy, DuplicatePolicy, FeatureKind, TrimPolicy
from tinsmith.cli import group, main
from tinsmith.cli.output.summaries import describe_file_size
from tinsmith.terrain.viewer import picture as drawing

SAMPLES = Path(__file__).parents[2] / "sample_data"
SURVEY = str(SAMPLES / "site_survey.csv")
UTM = ("--crs", "EPSG:32616")
COMMANDS = (
    *("build", "info", "check", "view", "refine", "compare", "edit", "convert"),
    *("volume", "diff", "formats", "plan"),
)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Be in an empty folder that holds the samples, as after a download."""
    (tmp_path / "sample_data").symlink_to(SAMPLES)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(scope="module")
def pyramid(tmp_path_factory):
    path = tmp_path_factory.mktemp("pyramid") / "pyramid.ply"
    points = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 2, 2]]
    ts.io.write(ts.triangulate(points, crs="EPSG:32616"), path)
    return path


# ------------------------------------------------------------------ help


def examples():
    found = []
    for name in (None, *COMMANDS):
        command = main if name is None else main.get_command(click.Context(main), name)
        lines = [line.strip() for line in command.help.splitlines()]
        found += [pytest.param(line, id=line) for line in lines if line.startswith("tinsmith ")]
    return found


@pytest.mark.every_case("slow")
@pytest.mark.slow
@pytest.mark.parametrize("line", examples())
def test_example_of_the_help_runs_as_written(line, folder, request, monkeypatch):
    if line.startswith("tinsmith view"):
        request.getfixturevalue("can_draw")
        monkeypatch.setattr(drawing, "_SUPERSAMPLING", 1)
    if "contours.gpkg --z-field" in line:
        pytest.importorskip("pyogrio")
        dem = ("sample_data/jacksboro.tif", "--stride", 8, "--interval", 40)
        run("contours", *dem, "-o", "contours.gpkg")
    if "before.ply after.ply" in line:
        run("build", SURVEY, *UTM, "-o", "before.ply")
        run("build", SURVEY, *UTM, "--codes", "-o", "after.ply")
    run(*line.split()[1:])
    for name in re.findall(r"-o (\S+)", line):
        assert (folder / name).stat().st_size > 0


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help_with_an_example(name):
    shown = run(name, "--help").output
    assert "Example:" in shown
    assert f"tinsmith {name}" in shown


def test_help_lists_every_command_with_a_sentence():
    shown = run("--help").output
    for name in COMMANDS:
        assert re.search(rf"^  {name} +[A-Z].*\.$", shown, re.MULTILINE)


def test_version_is_the_package_version():
    told = run("--version").output
    assert re.fullmatch(
        rf"tinsmith {ts.__version__} \(core (abi3|cpython-\S+|cp\S+), Python 3\.\d+\.\d+\)\n", told
    )


def test_choices_are_those_of_the_library():
    build = group.main.get_command(None, "build")
    with click.Context(build) as context:
        build.parse_args(context, ["a.csv", "-o", "b.geojson", "--kind", "hull"])
        parameters = build.get_params(context)
    choices = {one.name: one.type.choices for one in parameters if hasattr(one.type, "choices")}
    assert tuple(choices["duplicates"]) == get_args(DuplicatePolicy)
    assert tuple(choices["write__kind"]) == get_args(FeatureKind)
    assert tuple(choices["crossing"]) == get_args(CrossingPolicy)
    assert tuple(choices["trim"]) == get_args(TrimPolicy)


# ------------------------------------------------------------------ build


def test_build_writes_rfc_7946_that_tiles_the_hull(folder):
    pyogrio = pytest.importorskip("pyogrio")
    shapely = pytest.importorskip("shapely")
    run("build", "sample_data/site_survey.csv", *UTM, "-o", "out.geojson")
    meta, _, shapes, _ = pyogrio.raw.read("out.geojson")
    polygons = shapely.from_wkb(shapes)
    assert meta["crs"] in {"EPSG:4326", "EPSG:4979"}  # GDAL's names of WGS 84 without and with z
    assert shapely.is_valid(polygons).all()
    assert shapely.has_z(polygons).all()
    assert shapely.is_ccw(shapely.get_exterior_ring(polygons)).all()
    union = shapely.union_all(shapely.set_precision(shapely.force_2d(polygons), 1e-9))
    hull = shapely.convex_hull(shapely.multipoints(shapely.get_coordinates(polygons)))
    assert shapely.area(polygons).sum() == pytest.approx(hull.area, rel=1e-6)
    assert union.area == pytest.approx(hull.area, rel=1e-6)


def test_build_makes_every_point_a_vertex(folder):
    pyproj = pytest.importorskip("pyproj")
    run("build", "sample_data/site_survey.csv", *UTM, "-o", "out.geojson")
    features = json.loads(Path("out.geojson").read_text())["features"]
    corners = np.array([one["geometry"]["coordinates"][0] for one in features])
    built = {tuple(place) for place in corners[..., :2].reshape(-1, 2)}
    table = np.loadtxt(SURVEY, delimiter=",", skiprows=1, usecols=(1, 2), encoding="utf-8")
    to_globe = pyproj.Transformer.from_crs(32616, 4326, always_xy=True)
    lon, lat = to_globe.transform(table[:, 1], table[:, 0])
    wanted = set(zip(np.round(lon, 9).tolist(), np.round(lat, 9).tolist(), strict=True))
    assert built == wanted
    assert len(built) == 2121


def test_build_summary_accounts_for_the_duplicates(folder):
    result = run("build", "sample_data/site_survey.csv", *UTM, "-o", "out.ply")
    assert result.stdout == ""
    assert "2,123 from sample_data/site_survey.csv" in result.stderr
    assert "2 rows at 2 places" in result.stderr
    assert "0.034: points 1407 (327.766), 3583 (327.800)" in result.stderr
    assert "2,121 vertices, 4,222 triangles" in result.stderr


def test_build_json_is_the_only_thing_on_stdout(folder):
    result = run("build", "sample_data/site_survey.csv", *UTM, "-o", "out.ply", "--json")
    facts = json.loads(result.stdout)
    assert facts["survey"]["points"] == 2123
    assert facts["tin"]["vertices"] == 2121
    assert facts["report"]["merges"][0]["numbers"] == [1407, 3583]
    assert facts["report"]["merges"][0]["rows"] == [562, 2122]
    assert facts["outputs"][0]["bytes"] == Path("out.ply").stat().st_size


def test_build_quiet_says_nothing(folder):
    result = run("build", "sample_data/site_survey.csv", "-o", "out.ply", "--quiet")
    assert result.output == ""


def test_build_report_file_equals_the_report(folder):
    arguments = ("build", "sample_data/site_survey.csv", "-o", "out.ply", "--report", "r.json")
    run(*arguments)
    kept = json.loads(Path("r.json").read_text())
    tin = ts.triangulate(ts.io.read(SURVEY))
    expected = tin.report.to_dict() | {"notes": list(tin.notes)}
    for merge in kept["merges"]:
        merge.pop("numbers")
    assert kept.pop("skipped_lines") == {}
    assert kept.pop("findings") == []
    assert kept.pop("blunders") == []
    assert kept == json.loads(json.dumps(expected))


def test_build_duplicates_and_snap_are_passed_on(folder):
    arguments = ("build", "sample_data/site_survey.csv", "--json", "-q", "-o", "out.ply")
    lowest = json.loads(run(*arguments, "--duplicates", "lowest").stdout)
    assert lowest["report"]["merges"][0]["elevation"] == 327.766
    snapped = json.loads(run(*arguments, "--snap", "3").stdout)
    assert snapped["tin"]["vertices"] == len(ts.triangulate(ts.io.read(SURVEY), snap=3).points)
    assert snapped["tin"]["vertices"] < 2121


def test_build_writes_several_files_of_one_tin(folder):
    outputs = ("-o", "out.ply", "-o", "out.obj", "-o", "hull.geojson")
    run("build", "sample_data/site_survey.csv", *UTM, *outputs, "--kind", "hull")
    assert len(json.loads(Path("hull.geojson").read_text())["features"]) == 1
    np.testing.assert_array_equal(ts.io.read("out.ply").triangles, ts.io.read("out.obj").triangles)


def test_build_of_a_dem_keeps_its_crs(folder):
    pytest.importorskip("rasterio")
    run("build", "sample_data/jacksboro.tif", "--stride", "8", "-o", "out.ply")
    tin = ts.io.read("out.ply")
    assert tin.crs == "EPSG:32616"
    assert len(tin.points) == 52 * 49


def test_build_of_a_window_of_a_dem(folder):
    pytest.importorskip("rasterio")
    window = ("--window", 745_000, 4_010_000, 747_000, 4_011_000)
    run("build", "sample_data/jacksboro.tif", *window, "-o", "out.ply")
    box = ts.io.read("out.ply").bounds
    assert 745_000 <= box.xmin < 745_075
    assert 746_925 < box.xmax <= 747_000
    assert 4_010_000 <= box.ymin < 4_010_075
    assert 4_010_925 < box.ymax <= 4_011_000


def test_build_of_a_tin_names_convert(pyramid, folder):
    result = run("build", pyramid, "-o", "out.ply", code=1)
    assert "tinsmith convert" in result.stderr


# ------------------------------------------------------------------ info, check, convert, view


def test_info_of_a_tin_has_its_measures(pyramid):
    facts = json.loads(run("info", pyramid, "--json").stdout)
    assert (facts["vertices"], facts["triangles"], facts["edges"]) == (5, 4, 8)
    assert facts["area"] == pytest.approx(16.0)
    assert facts["surface_area"] == pytest.approx(16.0 * np.sqrt(2))
    for key in ("min", "mean", "max"):
        assert facts["slope"][key] == pytest.approx(45.0)


@pytest.mark.parametrize(
    ("crs", "vertical", "assumed", "metres"),
    [
        ("EPSG:2274", "unknown", "US survey foot", 1200 / 3937),
        ("EPSG:2274+5703", "metre", None, 1.0),
    ],
)
def test_info_slope_minds_feet(crs, vertical, assumed, metres, tmp_path):
    """Elevations of a CRS in feet are taken for feet, unless its vertical axis says otherwise."""
    height = 2 * (1200 / 3937) / metres
    points = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [2, 2, height]])
    ts.io.write(ts.triangulate(points, crs=crs), tmp_path / "feet.ply")
    facts = json.loads(run("info", tmp_path / "feet.ply", "--json").stdout)
    assert facts["slope"]["mean"] == pytest.approx(45.0)
    assert facts["units"] == {"horizontal": "US survey foot", "vertical": vertical}
    assert facts["elevation"]["unit_assumed"] == assumed


def test_info_in_degrees_claims_no_areas(tmp_path):
    points = [[-84.2, 36.3, 0], [-84.1, 36.3, 0], [-84.2, 36.4, 9]]
    ts.io.write(ts.triangulate(points, crs="EPSG:4326"), tmp_path / "degrees.ply")
    facts = json.loads(run("info", tmp_path / "degrees.ply", "--json").stdout)
    assert facts["surface_area"] is facts["area"] is None
    gradient = 9 / (0.1 * 111_000)
    assert facts["slope"]["mean"] == pytest.approx(np.degrees(np.arctan(gradient)), rel=0.01)
    assert "longitude -84.2" in run("info", tmp_path / "degrees.ply").stdout


def test_info_of_points_has_columns_and_extent(folder):
    facts = json.loads(run("info", "sample_data/site_survey.csv", *UTM, "--json").stdout)
    assert facts["kind"] == "points"
    assert facts["points"] == 2123
    assert facts["crs_name"] == "WGS 84 / UTM zone 16N"
    assert facts["elevation"]["min"] == pytest.approx(316.501)
    assert "description" in facts["attributes"]


def test_info_of_points_without_crs_says_how_to_name_it(folder):
    assert "--crs" in run("info", "sample_data/site_survey.csv").stdout


def test_check_passes_points_and_tin(pyramid, folder):
    assert "exactly Delaunay" in run("check", "sample_data/site_survey.csv").stdout
    assert json.loads(run("check", pyramid, "--json").stdout)["ok"] is True


def test_check_fails_a_tin_that_is_not_delaunay(tmp_path):
    points = [[0, 0, 0], [4, -1, 0], [8, 0, 0], [4, 1, 0]]
    flat = ts.TIN.from_triangles(points, [[0, 1, 2], [0, 2, 3]])
    ts.io.write(flat, tmp_path / "flat.ply")
    result = run("check", tmp_path / "flat.ply", code=1)
    assert "a sound surface, not Delaunay" in result.stderr
    assert "Reason" in result.stdout
    assert json.loads(run("check", tmp_path / "flat.ply", "--json", code=1).stdout)["ok"] is False
    run("check", tmp_path / "flat.ply", "--level", "2")


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".vtp", ".vtu"])
def test_convert_keeps_the_surface(pyramid, tmp_path, suffix):
    if suffix in {".vtp", ".vtu"}:
        pytest.importorskip("pyvista")
    run("convert", pyramid, "-o", tmp_path / f"out{suffix}")
    again = ts.io.read(tmp_path / f"out{suffix}")
    assert again.surface_area == pytest.approx(ts.io.read(pyramid).surface_area, rel=1e-6)


def test_convert_keeps_points_as_points(folder):
    run("convert", "sample_data/site_survey.csv", "-o", "out.xyz")
    np.testing.assert_array_equal(ts.io.read("out.xyz").points, ts.io.read(SURVEY).points)


AS_USUAL = {"view": "oblique", "title": "pyramid", "survey": None, "ortho": None}
"""All else has the defaults of the library."""


@pytest.fixture
def asked(monkeypatch):
    """What ``view`` asks for, and what it shows."""
    made = SimpleNamespace(options=[], shown=[])

    def draw(tin, **options):
        made.options.append((len(tin.points), options))
        return SimpleNamespace(
            show=lambda: made.shown.append(True),
            save=lambda path: path.write_bytes(b"7 bytes"),
            notes=("Mind the gap.",),
        )

    monkeypatch.setattr("tinsmith.terrain.preview", draw)
    return made


@pytest.mark.parametrize("as_json", [False, True])
@pytest.mark.parametrize("writes", [False, True])
def test_view_shows_or_writes(pyramid, tmp_path, asked, as_json, writes):
    picture = tmp_path / "a.png"
    output = ["-o", picture] if writes else []
    result = run("view", pyramid, *output, *(["--json"] if as_json else []))
    assert asked.options == [(5, AS_USUAL)]
    assert asked.shown == ([] if writes else [True])
    assert ("(7 bytes)" in result.stderr) is writes
    assert "Warning: Mind the gap." in result.stderr
    if writes and as_json:
        record = json.loads(result.stdout)
        notes = list(ts.read(pyramid).notes)
        assert record == {"input": str(pyramid), "output": str(picture), "notes": notes}
    else:
        assert result.stdout == ""


@pytest.mark.parametrize(
    ("options", "wanted"),
    [
        (["--top", "--no-lines", "--edges", "--title", "A hill", "--exaggeration", "3"],
         {"view": "top", "lines": False, "edges": True, "title": "A hill", "exaggeration": 3.0}),
        (["--azimuth", "-30", "--tilt", "20.5", "--size", "800x600", "--dpi", "300"],
         {"azimuth": -30.0, "tilt": 20.5, "size": (800, 600), "dpi": 300.0}),
        (["--sun", "250,30", "--background", "dark", "--elevations", "-5,12.5"],
         {"sun": [250.0, 30.0], "background": "dark", "elevations": [-5.0, 12.5]}),
        (["--tint", "slope", "--contours", "0.5"], {"tint": "slope", "contours": 0.5}),
    ],
)  # fmt: skip
def test_view_passes_on_what_is_asked_for(pyramid, asked, options, wanted):
    run("view", pyramid, *options)
    assert asked.options == [(5, AS_USUAL | wanted)]


@pytest.mark.parametrize(
    ("flag", "value", "allowed"),
    [
        ("--size", "800", "width and height, such as 1600x1000"),
        ("--size", "800x", "width and height, such as 1600x1000"),
        ("--size", "100x9000", "width and height, 200 to 5000 pixels each"),
        ("--dpi", "0", "from 36 to 2,400 dots per inch"),
        ("--azimuth", "nan", "a finite number of degrees clockwise from north"),
        ("--tilt", "91", "an angle from 0 to 90 degrees above the horizon"),
        ("--sun", "315", "azimuth and altitude"),
        ("--sun", "315,-1", "0 to 90 above the horizon"),
        ("--sun", "high", "numbers with commas between them"),
        ("--background", "reddish", "white, black, light, dark, or a colour such as '#e8edf2'"),
        ("--contours", "0", "an interval > 0 in the unit of elevations"),
        ("--elevations", "5,2", "the lowest and the highest, in this order"),
        ("--exaggeration", "0", "a finite number > 0"),
    ],
)
def test_view_refuses_what_cannot_be_drawn(pyramid, tmp_path, flag, value, allowed):
    result = run("view", pyramid, "-o", tmp_path / "a.png", flag, value, code=2)
    assert f"Invalid {flag} " in result.stderr
    assert allowed in result.stderr
    assert not list(tmp_path.glob("a*"))


def test_view_tells_an_elevation_far_off(tmp_path):
    points = [f"{x},{y},{5 + 0.1 * x}" for x in range(6) for y in range(6)]
    points[8] = "1,2,9999"
    file = tmp_path / "points.csv"
    file.write_text("x,y,z\n" + "\n".join(points))
    result = run("view", file, "-o", tmp_path / "a.html")
    assert "Warning: 1 elevation far off all others: 9,999." in result.stderr


@pytest.fixture
def drawn(monkeypatch):
    """What ``view`` hands to be drawn."""
    calls = []

    class Shown:
        notes = ()

        def save(self, path):
            Path(path).write_text("drawn")

    def draw(tin, **options):
        calls.append((tin, options))
        return Shown()

    monkeypatch.setattr("tinsmith.terrain.preview", draw)
    return calls


@pytest.mark.parametrize(("name", "most"), [("a.png", 400), ("a.html", 200)])
def test_view_shows_a_sample_of_a_large_raster_and_says_so(
    tmp_path, monkeypatch, drawn, name, most
):
    monkeypatch.setattr("tinsmith.cli.commands.surfaces.view._MOST_CELLS", 400)
    dem = SAMPLES / "jacksboro.tif"
    result = run("view", dem, "-o", tmp_path / name, "--json")
    (tin, options), whole = drawn[0], len(ts.read(dem).points)
    assert len(tin.points) <= most
    told = f"{len(tin.points):,} of {whole:,} cells"
    assert options["title"] == f"jacksboro ({told})"
    assert f"Sampled     {told} are shown; --full shows all" in result.stderr
    assert json.loads(result.stdout)["sample"] == told


@pytest.mark.parametrize("options", [["--full"], ["--stride", "2"]])
def test_view_shows_all_cells_that_are_asked_for(tmp_path, monkeypatch, drawn, options):
    monkeypatch.setattr("tinsmith.cli.commands.surfaces.view._MOST_CELLS", 400)
    dem = SAMPLES / "jacksboro.tif"
    result = run("view", dem, "-o", tmp_path / "a.png", *options)
    stride = 2 if "--stride" in options else 1
    assert len(drawn[0][0].points) == len(ts.read(dem, stride=stride).points)
    assert drawn[0][1]["title"] == "jacksboro"
    assert "Sampled" not in result.stderr


def test_view_of_a_raster_from_standard_input_is_a_sample_too(tmp_path, monkeypatch, drawn):
    monkeypatch.setattr("tinsmith.cli.commands.surfaces.view._MOST_CELLS", 400)
    dem = (SAMPLES / "jacksboro.tif").read_bytes()
    result = CliRunner().invoke(main, ["view", "-", "-o", str(tmp_path / "a.png")], input=dem)
    assert result.exit_code == 0, result.output
    assert len(drawn[0][0].points) <= 400
    assert drawn[0][1]["title"].startswith("Terrain surface (")


def test_view_shows_each_file_of_a_tin_and_points_apart_if_asked(tmp_path, drawn):
    points = np.array([[0, 0, 5], [4, 0, 6], [0, 3, 8], [5, 5, 7.0]])
    for name, rise in (("before", 0.0), ("after_1", 2.0)):
        raised = points + np.array([0.0, 0.0, rise])
        ts.write(ts.triangulate(raised), tmp_path / f"{name}.ply")
        np.savetxt(tmp_path / f"{name}.csv", raised, delimiter=",", header="x,y,z", comments="")
    meshes = [tmp_path / "before.ply", tmp_path / "after_1.ply"]
    tables = [tmp_path / "before.csv", tmp_path / "after_1.csv"]
    out = tmp_path / "a.html"
    run("view", *meshes, "-o", out)
    run("view", *tables, "--compare", "-o", out)
    for given, options in drawn:
        assert [tin.points[0, 2] for tin in given] == [5.0, 7.0]
        assert options["title"] == "before, after 1"
        assert options["survey"] is None
    run("view", *tables, "-o", out)
    assert isinstance(drawn[2][0], ts.TIN)
    result = run("view", tables[0], "--compare", "-o", out, code=2)
    assert "--compare needs two files or more, and there is one." in result.stderr
    missing = [tmp_path / "none.csv"] * 2  # refused before anything is read
    for output in ([], ["-o", tmp_path / "a.png"]):
        result = run("view", *missing, "--compare", *output, code=2)
        assert "--compare shows several surfaces, which only a page can" in result.stderr
    result = run("view", meshes[0], tables[0], "-o", out, code=1)
    assert "holds a TIN, whose triangles cannot be joined" in result.stderr


def test_view_compares_samples_of_rasters_and_says_so(tmp_path, monkeypatch, drawn):
    monkeypatch.setattr("tinsmith.cli.commands.surfaces.view._MOST_CELLS", 400)
    dem = SAMPLES / "jacksboro.tif"
    result = run("view", dem, dem, "--compare", "-o", tmp_path / "a.html")
    told = f"{len(drawn[0][0][0].points):,} of {len(ts.read(dem).points):,} cells"
    assert drawn[0][1]["title"] == f"jacksboro, jacksboro ({told}, {told})"
    assert f"Sampled     {told}, {told} are shown" in result.stderr


def test_view_writes_a_picture(pyramid, tmp_path, can_draw):
    pytest.importorskip("pyvista")
    picture = tmp_path / "out.png"
    options = ("--edges", "--top", "--exaggeration", "2", "--size", "400x300")
    result = run("view", pyramid, "-o", picture, *options)
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert "out.png" in result.stderr


# ------------------------------------------------------------------ formats, plug-ins


def test_formats_lists_every_known_format():
    known = ts.io.known_formats()
    table = run("formats").stdout
    listed = json.loads(run("formats", "--json").stdout)["formats"]
    assert [one["name"] for one in listed] == [one.name for one in known]
    assert all(re.search(rf"^ ?{one.name} ", table, re.MULTILINE) for one in known)
    for one, facts in zip(known, listed, strict=True):
        assert (facts["read"], facts["write"]) == (bool(one.read), bool(one.write))
        assert facts["suffixes"] == list(one.suffixes)
        assert (facts["description"], facts["extra"]) == (one.description, one.extra)
        assert facts["reads"] == (list(one.reads) if one.read else [])
        assert facts["writes"] == (list(one.writes) if one.write else [])
        assert (facts["precision"], facts["losses"]) == (one.precision, one.losses)
        assert (facts["needs"], facts["installed"]) == (one.needs, one.is_installed)
        assert facts["from"] == "tinsmith"


@pytest.mark.parametrize("is_there", [True, False])
def test_formats_tells_what_is_installed(monkeypatch, is_there):
    if not is_there:
        monkeypatch.setattr("tinsmith.base.optional.find_spec", lambda name: None)
    rows = run("formats").stdout.splitlines()
    row = next(number for number, row in enumerate(rows) if row.split()[:1] == ["gmsh"])
    assert rows[row].split()[:4] == ["gmsh", "TIN", "TIN", "tinsmith[mesh]"]
    assert ("not installed" not in rows[row + 1]) == is_there
    assert " installed" in rows[row + 1]


def test_formats_names_the_extras():
    shown = " ".join(run("formats").stdout.split())
    assert "tinsmith[mesh]" in shown
    assert "tinsmith[interop]" in shown


def test_mean_slope_is_weighted_by_area(tmp_path):
    """A level square of 10 by 10, and beside it a strip of 1 by 10 that rises by 1."""
    points = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [11, 0, 1], [11, 10, 1]]
    ts.write(ts.triangulate(points, crs="EPSG:32616"), tmp_path / "a.ply")
    found = json.loads(run("info", tmp_path / "a.ply", "--json").stdout)["slope"]
    assert found["mean"] == pytest.approx(45 * 10 / 110, rel=1e-9)
    assert (found["min"], found["max"]) == (pytest.approx(0), pytest.approx(45))


def test_json_knows_no_infinity_and_no_numpy():
    from tinsmith.cli.output.console import format_json

    given = {"a": float("inf"), "b": [float("nan"), np.float64("-inf")], "c": np.int32(3)}
    assert json.loads(format_json(given)) == {"a": None, "b": [None, None], "c": 3}


def test_every_row_that_was_left_out_is_in_report_and_json(tmp_path):
    path, report = tmp_path / "a.csv", tmp_path / "report.json"
    rows = ["x,y,z", "0,0,1", "4,0,2", "odd,0,2", "0,4,3", "2,2,", "5,5,4"]
    path.write_text("\n".join(rows) + "\n")
    how = ["--skip-bad", "--json", "--report", report, "-o", tmp_path / "a.ply"]
    facts = json.loads(run("build", path, *how).stdout)
    expected = {"bad rows": [4], "points without elevation": [6]}
    assert facts["survey"]["skipped_lines"] == expected
    assert facts["report"]["skipped_lines"] == expected
    assert json.loads(report.read_text())["skipped_lines"] == expected
    info = json.loads(run("info", path, "--skip-bad", "--json").stdout)
    assert info["skipped_lines"] == expected


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (0, "0 bytes"),
        (999, "999 bytes"),
        (1_000, "1.0 kB"),
        (99_900, "99.9 kB"),
        (100_000, "100 kB"),
        (999_000, "999 kB"),
        (1_000_000, "1.0 MB"),
        (123_000_000, "123 MB"),
        (2_500_000_000, "2.5 GB"),
        (3_000_000_000_000, "3000.0 GB"),
    ],
)
def test_sizes_of_files_for_people(tmp_path, size, words):
    path = tmp_path / "sparse"
    with path.open("wb") as file:
        file.truncate(size)
    assert describe_file_size(path) == words


# ------------------------------------------------------------------ another CRS


def test_to_crs_reprojects_what_was_read(tmp_path):
    path = tmp_path / "points.csv"
    path.write_text("x,y,z\n751428,4020862,1032\n751438,4020862,1031\n751428,4020872,1030\n")
    invoke = CliRunner().invoke
    out = str(tmp_path / "out.ply")
    done = invoke(main, ["build", str(path), "--crs", "EPSG:32616", "--to-crs", "32617", "-o", out])
    assert done.exit_code == 0, done.output
    tin = ts.read(out)
    assert tin.crs == "EPSG:32617"
    expected = ts.transform_points(ts.read(path).points, "EPSG:32616", "EPSG:32617")
    assert np.abs(tin.points - expected).max() < 1e-6
    done = invoke(main, ["build", str(path), "--to-crs", "EPSG:32617", "-o", out])
    assert done.exit_code == 1
    assert "not known" in done.output


def test_to_crs_takes_degrees(tmp_path):
    path = tmp_path / "degrees.csv"
    path.write_text("lon,lat,z\n-84.2,36.4,300\n-84.21,36.4,301\n-84.2,36.41,302\n")
    out = str(tmp_path / "out.ply")
    given = ["build", str(path), "--crs", "EPSG:4326", "--to-crs", "EPSG:32616", "-o", out]
    assert CliRunner().invoke(main, given).exit_code == 0
    expected = ts.transform_points([[-84.2, 36.4, 300.0]], "EPSG:4326", "EPSG:32616")
    assert ts.read(out).points[0] == pytest.approx(expected[0])
