"""Commands that compute in tiles write and say what they do in memory."""

from __future__ import annotations

import json
import shutil

import numpy as np
import pytest
import rasterio
import shapely
from click.testing import CliRunner
from support.many_files import KeptProcesses, write_lidar

import tinsmith as ts
from tinsmith.cli import main, tiling
from tinsmith.cli.command_list import SUMMARIES
from tinsmith.tiled.running.executors import Processes

COMMANDS = {
    "raster": ["--spacing", "5", "-o", "out.tif"],
    "contours": ["--interval", "5", "-o", "out.csv"],
    "volume": ["--base", "300", "-o", "out.csv"],
    "profile": ["--from", "500010", "4000010", "--to", "500290", "4000190", "-o", "out.csv"],
    "interpolate": ["--at", "PLACES", "-o", "out.csv"],
    "drape": ["ROADS", "--outside", "nan", "-o", "out.fgb"],
    "slope": ["--statistics", "--unit", "percent", "-o", "out.csv"],
}
"""Of each command the options with which it computes in tiles; PLACES and ROADS are files."""

WHOLE = {
    "raster": (["--max-edge", "9"], ["--snap", "0.1"], ["--to-crs", "EPSG:32617"]),
    "contours": (["--smooth", "0.1"], ["--simplify", "0.1"], ["--labels"], ["-o", "out.png"]),
    "volume": (["-o", "out.gpkg"], ["-o", "out.png"]),
    "profile": (["--sections", "10", "20"], ["-o", "out.png"]),
    "interpolate": (["--method", "natural"], ["--extrapolate", "nearest"]),
    "drape": (["--snap", "0.1"],),
    "slope": (["--max-edge", "9"],),
}
"""Further options that need all points at a time."""

POINT_RASTERS = (
    ["--value", "count"],
    ["--value", "count", "--classes", "2"],
    ["--value", "height", "--classes", "2"],
    ["--value", "height", "--classes", "2", "--above-classes", "5"],
)
"""Options of rasters of points."""

TILED = ["--tiles", "3", "--workers", "2", "-q"]

OF_FOLDERS = {"build", "ground", "simplify"}
"""Commands whose tiles make what memory makes otherwise, such as a folder of files."""


ROADS = [[500_010, 4_000_010], [500_290, 4_000_190], [500_100, 4_000_150], [500_100, 3_999_000]]
PLACES = "name,easting,northing\na,500100,4000100\nb,500123.4,4000077\nc,1,1\n"


@pytest.fixture(scope="module")
def lidar(tmp_path_factory):
    """Return a folder of lidar tiles."""
    return write_lidar(tmp_path_factory.mktemp("lidar"))


@pytest.fixture(scope="module")
def given(tmp_path_factory):
    """Return the files that stand behind options, by the words for them."""
    folder = tmp_path_factory.mktemp("given")
    (folder / "places.csv").write_text(PLACES)
    roads = ts.Features.of_lines(ROADS, [0, 2, 4], columns={"name": ["a", "b"]}, crs="EPSG:32616")
    ts.write(roads, folder / "roads.geojson")
    return {"PLACES": folder / "places.csv", "ROADS": folder / "roads.geojson"}


@pytest.fixture(scope="module")
def commands(given):
    """Return the options of each command, with the names of files."""
    return {name: [given.get(word, word) for word in words] for name, words in COMMANDS.items()}


@pytest.fixture(scope="module", autouse=True)
def kept_processes():
    """Use the processes of one command for the next, but for one test below."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("tinsmith.tiled.running.run_options.Processes", KeptProcesses)
        yield
    KeptProcesses.end()


@pytest.fixture(scope="module")
def folder_of_processes(tmp_path_factory):
    """Return the folder in which the kept processes are, by which they know relative paths."""
    return tmp_path_factory.mktemp("here")


@pytest.fixture
def here(folder_of_processes, monkeypatch):
    """Work in an empty folder, and return it."""
    monkeypatch.chdir(folder_of_processes)
    for one in folder_of_processes.iterdir():
        shutil.rmtree(one) if one.is_dir() else one.unlink()
    return folder_of_processes


def run(command, *words):
    """Run a command in this process."""
    return CliRunner().invoke(main, [command, *map(str, words)])


def write_lines(folder):
    """Write a breakline and a boundary with elevations, and the boundary without; return them."""
    origin = np.array([500_000.0, 4_000_000.0, 0.0])
    line = origin + np.array([[5, 30, 301], [120, 90, 309], [295, 180, 299]])
    ring = np.array([[20, 20, 300], [280, 25, 303], [270, 180, 311], [25, 170, 305]])
    box = shapely.Polygon(origin + ring)
    lines = ts.Features.of_lines(line, [0, 3], crs="EPSG:32616")
    files = [ts.write(lines, folder / "lines.gpkg")]
    for name, shape in (("site", box), ("flat", shapely.force_2d(box))):
        path = folder / f"{name}.geojson"
        crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32616"}}
        feature = {"type": "Feature", "properties": {}, "geometry": shapely.geometry.mapping(shape)}
        content = {"type": "FeatureCollection", "crs": crs, "features": [feature]}
        path.write_text(json.dumps(content))
        files.append(path)
    return files


def write_wide_boundary(folder):
    """Write a boundary without elevations of which a part lies beyond the points; return it."""
    path = folder / "wide.gpkg"
    corners = [[500_010, 4_000_010], [500_400, 4_000_100], [500_150, 4_000_195]]
    ring = [*corners, corners[0]]
    boundary = ts.Features.of_polygons(ring, [0, 4], [0, 1], [0, 1], crs="EPSG:32616")
    return ts.write(boundary, path)


def test_every_command_with_tiles_is_here():
    with_tiles = set()
    for name in SUMMARIES:
        options = main.get_command(None, name).params
        if "--tiles" in [flag for one in options for flag in one.opts]:
            with_tiles.add(name)
    assert with_tiles - OF_FOLDERS == set(COMMANDS) == set(WHOLE)
    assert with_tiles >= OF_FOLDERS


@pytest.mark.parametrize("command", COMMANDS)
def test_outputs_and_records_are_those_in_memory(command, lidar, here, commands):
    options = [lidar, "--classes", "2", "--json", *commands[command]]
    whole = run(command, *options)
    assert whole.exit_code == 0, whole.output
    (path,) = here.iterdir()
    content = path.read_bytes()
    path.unlink()
    tiled = run(command, *options, "--tiles", "3", "--workers", "2", "-q")
    assert tiled.exit_code == 0, tiled.output
    assert [one.name for one in here.iterdir()] == [path.name]
    if command not in ("raster", "drape"):  # with notes, which name files one by one in tiles
        assert path.read_bytes() == content
    told, wanted = json.loads(tiled.stdout), json.loads(whole.stdout)
    apart = ("notes", "input", "inputs")
    for name in wanted:
        if name not in apart:
            assert told[name] == wanted[name], name
    assert any("Classes of the points" in note for note in told["notes"])


@pytest.mark.parametrize("words", POINT_RASTERS)
def test_rasters_of_points_are_those_in_memory(words, lidar, here):
    options = [lidar, "--spacing", "7", *words, "--json", "-o"]
    whole, tiled = run("raster", *options, "whole.tif"), run("raster", *options, "t.tif", *TILED)
    assert (whole.exit_code, tiled.exit_code) == (0, 0), whole.output + tiled.output
    with rasterio.open(here / "whole.tif") as one, rasterio.open(here / "t.tif") as other:
        assert one.read(1).tobytes() == other.read(1).tobytes()
        assert str(one.profile) == str(other.profile)
        assert one.descriptions == other.descriptions
    told, wanted = json.loads(tiled.stdout), json.loads(whole.stdout)
    for name in wanted:
        if name not in ("notes", "outputs"):
            assert told[name] == wanted[name], name
    assert told["bands"] == [words[1]]
    assert sorted(one.name for one in here.iterdir()) == ["t.tif", "whole.tif"]


def test_heights_leave_noise_out_unless_it_is_asked_for(lidar, here):
    points = ts.read(lidar).points[:40] + np.array([0.0, 0.0, 500.0])
    classes = np.full(40, 18, np.uint8)
    noisy = here / "noisy"
    noisy.mkdir()
    for one in lidar.iterdir():
        (noisy / one.name).write_bytes(one.read_bytes())
    survey = ts.Survey(points=points, attributes={"classification": classes}, crs="EPSG:32616")
    ts.write(survey, noisy / "noise.laz")
    words = [noisy, "--classes", "2", "--value", "height", "--spacing", "20", "-o", "out.tif"]
    for more in ([], TILED):
        found = []
        for chosen in ([], ["--above-classes", "18"]):
            done = run("raster", *words, *chosen, *more, "--json")
            assert done.exit_code == 0, done.output
            with rasterio.open("out.tif") as dataset:
                found.append(np.nanmax(dataset.read(1)))
        assert found[0] < 5.0 < 490.0 < found[1]


def test_surface_terrain_and_canopy_height_are_three_bands_of_one_command(lidar, here):
    words = ["raster", lidar, "--classes", "2", "--value", "canopy", "--spacing", "5", "--json"]
    done = run(*words, "-o", "canopy.tif")
    assert done.exit_code == 0, done.output
    ground = ts.triangulate(ts.read(lidar, classes=2))
    classes = [number for number in range(256) if number not in (7, 18)]
    wanted = ts.rasterize_canopy(ground, ts.read(lidar, classes=classes), spacing=5)
    with rasterio.open("canopy.tif") as file:
        assert file.descriptions == ("dsm", "dtm", "chm")
        for number, values in enumerate(wanted.bands.values(), start=1):
            np.testing.assert_array_equal(file.read(number), values)
    told = json.loads(done.stdout)
    assert told["bands"] == ["dsm", "dtm", "chm"]
    assert set(wanted.notes) <= set(told["notes"])
    done = run(*words, "-o", "tiled.tif", "--tiles", 3)
    assert done.exit_code == 1
    assert "Tiles cannot be computed with --value canopy: all points are needed" in done.output


def test_the_ground_below_a_canopy_is_found_where_no_class_tells_it(here):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(40.0), np.arange(40.0)))
    house = (abs(x - 20) < 6) & (abs(y - 20) < 6)
    points = np.column_stack([x + 500_000, y + 4_000_000, np.where(house, 6.0, 0.0)])
    ts.write(ts.Survey(points=points, crs="EPSG:32616"), here / "cloud.laz")
    words = ["raster", "cloud.laz", "--find-ground", "--value", "canopy", "--spacing", 1]
    done = run(*words, "-o", "canopy.tif", "--json")
    assert done.exit_code == 0, done.output
    with rasterio.open("canopy.tif") as file:
        height = file.read(3)
    assert sorted(set(np.round(height[np.isfinite(height)], 6).tolist())) == [0.0, 6.0]
    assert (np.round(height, 6) == 6.0).sum() == house.sum()
    assert any("not ground" in note for note in json.loads(done.stdout)["notes"])


@pytest.mark.parametrize("more", [[], ["--tiles", "3"]])
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--value", "height"], "needs to know the ground"),
        (["--value", "count", "--smooth"], "--smooth is of surfaces"),
        (["--value", "count", "--at", "mean"], "--at is of surfaces"),
        (["--value", "count", "--boundary", "LIDAR"], "--boundary is of surfaces"),
        (["--value", "height", "--classes", "2", "--method", "natural"], "--method is of"),
        (["--value", "canopy"], "--value canopy needs to know the ground"),
        (["--value", "canopy", "--classes", "2", "--find-ground"], "give one of them"),
        (["--value", "canopy", "--find-ground", "--operator", "horn"], "--operator is of"),
        (["--value", "slope", "--find-ground"], "--find-ground is for --value height and canopy"),
        (["--value", "count", "--above", "LIDAR"], "--above is for --value height"),
        (["--above-classes", "5"], "--above-classes is for --value height"),
        (["--value", "height", "--classes", "2", "--above-classes", "300"], "from 0 to 255"),
        (["--value", "height", "--above", "PLACES", "--above-classes", "5"], "has no classes"),
    ],
)
def test_options_of_points_and_of_surfaces_are_not_mixed(words, sentence, more, lidar, given, here):
    (here / "places.csv").write_text("x,y,z\n500100,4000100,350\n")
    files = {"LIDAR": lidar, "PLACES": here / "places.csv"}
    words = [files.get(word, word) for word in words]
    done = run("raster", lidar, "--spacing", "5", "-o", "out.tif", *words, *more)
    assert done.exit_code == 2, done.output
    assert sentence in " ".join(done.output.split())
    assert [one.name for one in here.iterdir()] == ["places.csv"]


@pytest.mark.each_value
@pytest.mark.parametrize("kind", ["own elevations", pytest.param("draped", marks=pytest.mark.slow)])
@pytest.mark.parametrize("command", COMMANDS)
def test_lines_of_files_are_those_in_memory(command, kind, lidar, here, tmp_path_factory, commands):
    line, site, flat = write_lines(tmp_path_factory.mktemp("lines"))
    words = [lidar, "--classes", "2", "--json", *commands[command], "--breaklines", line]
    words += ["--boundary", site, "--lines-elevation-unit", "m"]
    if kind == "draped":
        words += ["--holes", flat, "--drape"]
        words[words.index(site)] = write_wide_boundary(flat.parent)
    whole = run(command, *words)
    assert whole.exit_code == 0, whole.output
    (path,) = here.iterdir()
    content = path.read_bytes()
    path.unlink()
    tiled = run(command, *words, "--tiles", "3", "--workers", "2", "-q")
    assert tiled.exit_code == 0, tiled.output
    if command not in ("raster", "drape"):  # with notes, which name files one by one in tiles
        assert path.read_bytes() == content
    told, wanted = json.loads(tiled.stdout), json.loads(whole.stdout)
    for name in wanted:
        if name not in ("notes", "input", "inputs"):
            assert told[name] == wanted[name], name
    path.unlink()
    wrong = [run(command, *words, "--holes", here, *more) for more in ((), ("--tiles", "3"))]
    assert [one.exit_code for one in wrong] == [1, 1]
    assert json.loads(wrong[0].stdout)["error"] == json.loads(wrong[1].stdout)["error"]
    assert list(here.iterdir()) == []


@pytest.mark.parametrize(("command", "words"), [(c, w) for c in WHOLE for w in WHOLE[c]])
def test_what_needs_all_points_is_refused_with_tiles(command, words, lidar, here, commands):
    done = run(command, lidar, "--classes", "2", *commands[command], *words, "--tiles", "3")
    assert done.exit_code == 1, done.output
    assert "Tiles cannot be computed with" in done.output
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("command", COMMANDS)
def test_plans_do_nothing(command, lidar, here, commands):
    done = run(command, lidar, *commands[command], "--plan", "--json", "--workers", "2")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert told["points"] == 6_000
    assert told["workers"] == 2
    assert list(here.iterdir()) == []


def test_files_are_read_in_place(lidar, here):
    from support.sources_in_place import write_octree

    octree = write_octree(here / "a.copc.laz")
    options = ["--classes", "2", "--spacing", "5", "--workers", "1", "-o"]
    planned = json.loads(
        run("raster", octree, *options, "out.tif", "--in-place", "--plan", "--json").stdout
    )
    assert (planned["files_in_place"], planned["files_copied"], planned["disk_bytes"]) == (1, {}, 0)
    done = run("raster", lidar, *options, "out.tif", "--in-place", "--plan")
    assert '0 files; copied: 3, "has no octree (COPC)"' in " ".join(done.output.split())
    for name, more in (("a.tif", []), ("b.tif", ["--in-place"])):
        done = run("raster", octree, *options, name, "--tiles", "3", *more)
        assert done.exit_code == 0, done.output
    assert (here / "a.tif").read_bytes() == (here / "b.tif").read_bytes()


def test_tiles_are_chosen_where_memory_is_short(lidar, here, monkeypatch):
    monkeypatch.setattr(tiling, "_SMALL", 0)
    options = [lidar, "--classes", "2", *COMMANDS["volume"]]
    assert "computed in tiles" not in run("volume", *options).output
    monkeypatch.setattr("tinsmith.io.isolated.limits.measure_free_memory", lambda: 10**6)
    done = run("volume", *options)
    assert done.exit_code == 0, done.output
    assert "it was computed in tiles, with the same result" in " ".join(done.output.split())


def test_a_run_goes_on_with_the_same_options_only(lidar, here):
    options = [lidar, "--classes", "2", "--spacing", "5", "-o", "out.tif"]
    (here / "out.tif.run").mkdir()
    (here / "out.tif.run" / "mine.txt").write_text("mine")
    done = run("raster", *options, "--tiles", "2")
    assert done.exit_code == 1
    assert "it holds something else" in done.output
    assert [one.name for one in (here / "out.tif.run").iterdir()] == ["mine.txt"]
    done = run("raster", *options, "--tiles", "2", "--run", "elsewhere")
    assert done.exit_code == 0, done.output
    assert not (here / "elsewhere").exists()
    assert run("raster", *options, "--tiles", "2", "--dask", "tcp://127.0.0.1:9").exit_code == 1


@pytest.mark.parametrize("words", [["--tiles", "0"], ["--workers", "x"], ["--memory", "1"]])
def test_wrong_values_of_options(words, lidar, here):
    done = run("raster", lidar, *COMMANDS["raster"], *words)
    assert done.exit_code == 2, done.output
    assert words[0] in done.output
    assert list(here.iterdir()) == []


def test_points_from_standard_input_and_without_output_are_refused(lidar, here):
    done = run("raster", "-", *COMMANDS["raster"], "--tiles", "2")
    assert (done.exit_code, "standard input" in done.output) == (1, True)
    done = run("volume", lidar, "--base", "5", "--tiles", "2")
    assert (done.exit_code, "need an output file" in done.output) == (1, True)


def test_ground_of_a_folder_is_a_folder(lidar, here):
    planned = run("ground", lidar, "-o", "out", "--plan", "--json")
    assert (planned.exit_code, json.loads(planned.stdout)["points"]) == (0, 6_000)
    assert list(here.iterdir()) == []
    done = run("ground", lidar, "-o", "out", "--tiles", "3", "--workers", "1", "--json")
    assert done.exit_code == 0, done.output
    told = json.loads(done.stdout)
    assert told["outputs"] == ["out/out.vpc"]
    whole = json.loads(run("ground", lidar, "-o", "whole.laz", "--json").stdout)
    assert told["classes"] == whole["classes"]
    assert sorted(one.name for one in (here / "out").iterdir()) == [
        *("out.vpc", "tile0.laz", "tile1.laz", "tile2.laz")
    ]


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (["--tiles", "2", "-o", "a", "-o", "b"], 2, "name one by -o"),
        (["--tiles", "2", "-o", "out.laz"], 2, "has a suffix of files"),
        (["--tiles", "2", "-o", "out", "--as-points"], 1, "with --as-points"),
        (["-o", "out.laz", "--reach", "9"], 2, "--reach is for tiles"),
    ],
)
def test_ground_refuses_what_tiles_have_not(words, code, sentence, lidar, here):
    done = run("ground", lidar, *words)
    assert done.exit_code == code, done.output
    assert sentence in " ".join(done.output.split())
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("is_folder", [True, False])
def test_volumes_to_a_design_are_those_in_memory(is_folder, lidar, here, tmp_path_factory):
    folder = tmp_path_factory.mktemp("design")
    points = ts.read(lidar).points[::9] + np.array([0.5, 0.25, 1.0])
    design = ts.write(ts.Survey(points=points, crs="EPSG:32616"), folder / "design.laz")
    options = [lidar, folder if is_folder else design, "--json"]
    whole = run("volume", *options, "-o", "whole.csv")
    assert whole.exit_code == 0, whole.output
    tiled = run("volume", *options, "-o", "tiled.csv", "--tiles", "3", "--workers", "2", "-q")
    assert tiled.exit_code == 0, tiled.output
    assert (here / "tiled.csv").read_bytes() == (here / "whole.csv").read_bytes()
    assert json.loads(tiled.stdout)["rows"] == json.loads(whole.stdout)["rows"]
    assert len([*here.iterdir()]) == 2


@pytest.mark.filterwarnings("ignore:The elevations are not known above")
@pytest.mark.parametrize(
    ("words", "index"),
    [
        ([], "surface.json"),
        (["--output-format", "3dtiles"], "tileset.json"),
        (["--output-format", "quantized-mesh", "--max-level", "15"], "layer.json"),
    ],
)
def test_surfaces_become_folders(words, index, lidar, here):
    options = [lidar, "--classes", "2", "-o", "made", "--tiles", "3", "--workers", "2"]
    done = run("build", *options, *words, "--json", "-q")
    assert done.exit_code == 0, done.output
    assert [one.name for one in here.iterdir()] == ["made"]
    assert (here / "made" / index).is_file()
    assert json.loads(done.stdout)["outputs"] == ["made"]
    done = run("build", *options, *words, "--plan", "--json")
    assert json.loads(done.stdout)["points"] == 6_000


def test_simplified_in_tiles(lidar, here):
    options = ["simplify", lidar, "--classes", "2", "--tolerance", "0.3", "-o"]
    for count, name in ((1, "a.ply"), (3, "b.ply")):
        done = run(*options, name, "--tiles", count, "--workers", "2", "--json")
        assert done.exit_code == 0, done.output
        assert json.loads(done.stdout)["outputs"] == [name]
    assert (here / "a.ply").read_bytes() == (here / "b.ply").read_bytes()
    planned = run(*options, "c.ply", "--plan", "--json")
    assert json.loads(planned.stdout)["points"] == 6_000
    for words in (["c.ply", "--hold", "surface"], ["c.ply", "-o", "d.ply"], ["c.obj"]):
        done = run(*options, *words, "--tiles", "3")
        assert done.exit_code in (1, 2), done.output
    assert sorted(one.name for one in here.iterdir()) == ["a.ply", "b.ply"]


def test_surfaces_become_the_file_of_memory(lidar, here, monkeypatch):
    monkeypatch.setattr("tinsmith.tiled.running.run_options.Processes", Processes)
    options = [lidar, "--classes", "2"]
    done = run("build", *options, "-o", "made.ply", "--tiles", "3", "--workers", "2", "--json")
    assert done.exit_code == 0, done.output
    assert [one.name for one in here.iterdir()] == ["made.ply"]
    assert "Attributes of points are not kept in tiles." in json.loads(done.stdout)["notes"]
    tin = ts.triangulate(ts.read(lidar, classes=2, attributes=[]))
    ts.write(tin, here / "whole.ply")
    assert (here / "made.ply").read_bytes() == (here / "whole.ply").read_bytes()


@pytest.mark.filterwarnings("ignore:The elevations are not known above")
def test_3d_tiles_have_a_tolerance_and_squares_of_a_size(lidar, here):
    words = [
        lidar,
        "--classes",
        "2",
        "--output-format",
        "3dtiles",
        "--tiles",
        "2",
        "--workers",
        "1",
    ]
    scales = ["--tolerance", "0.5", "--node-points", "256"]
    done = run("build", *words, "-o", "made", *scales, "-q")
    assert done.exit_code == 0, done.output
    way = {"tolerance": 0.5, "node_points": 256, "tiles": 2, "workers": 1}
    ts.tiles(lidar, classes=2).write(here / "wanted", **way)
    files = {name: sorted((here / name).rglob("*.*")) for name in ("made", "wanted")}
    assert len(files["made"]) == len(files["wanted"]) > 5
    for one, other in zip(files["made"], files["wanted"], strict=True):
        assert one.read_bytes() == other.read_bytes()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--tolerance", "0.5", "-o", "a.ply"], "--tolerance is for 3D Tiles, which need --tiles"),
        (["--node-points", "9", "--tiles", "2", "-o", "a"], "--node-points is for --output-format"),
        (["--node-points", "0", "--tiles", "2", "-o", "a"], "--node-points"),
        (
            ["--output-format", "quantized-mesh", "--node-points", "99", "--tiles", "2", "-o", "a"],
            "--node-points is for --output-format 3dtiles",
        ),
    ],
)
def test_options_of_3d_tiles_are_of_nothing_else(words, sentence, lidar, here):
    done = run("build", lidar, *words)
    assert done.exit_code == 2, done.output
    assert sentence in " ".join(done.output.split())
    assert list(here.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (["--tiles", "3"], 1, "Tiles cannot be computed with classes, but --statistics can be"),
        (["--statistics", "--aspect"], 2, "--aspect is for classes"),
        (["--statistics", "--breaks", "5"], 2, "--breaks is for classes"),
    ],
)
def test_classes_of_slope_are_not_of_tiles(words, code, sentence, lidar, here):
    done = run("slope", lidar, "-o", "out.csv", *words)
    assert done.exit_code == code, done.output
    assert sentence in " ".join(done.output.split())
    assert list(here.iterdir()) == []


@pytest.mark.parametrize(
    "words",
    [
        ["-o", "out.obj"],
        ["-o", "out.laz"],
        ["-o", "made", "--output-format", "obj"],
        ["-o", "made", "--max-edge", "9"],
        ["-o", "made", "--report", "report.json"],
        ["-o", "made", "--from-contours"],
        ["-o", "made", "-o", "other"],
        [],
    ],
)
def test_surfaces_that_cannot_be_folders_of_tiles_are_refused(words, lidar, here):
    done = run("build", lidar, "--classes", "2", "--tiles", "3", *words)
    assert done.exit_code in (1, 2), done.output
    assert done.exception is None or isinstance(done.exception, SystemExit)
    assert list(here.iterdir()) == []
