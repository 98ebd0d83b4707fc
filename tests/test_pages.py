"""The commands that the pages of docs/ show run, in a folder with the files they speak of.

Where a page shows what a command says, that is compared; ``RENEW=1`` writes it anew.
"""

import contextlib
import os
import re
import shlex
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from support.blocks import ROOT, list_pages, list_sessions, name_page, read_blocks, remove_code
from support.blocks import list_commands as list_lines
from support.lidar_files import make_cloud, write_copc
from support.orthos import write_grey

import tinsmith as ts
from tinsmith.cli import main
from tinsmith.cli.paths import split_output
from tinsmith.terrain.viewer import picture

PLUG_IN = ROOT / "docs/examples/tinsmith-x3d/README.md"  # run by its own test, once installed
README = ROOT / "README.md"  # run by test_repository, as a user runs it
PAGES = [page for page in list_pages() if page not in (PLUG_IN, README)]
CRS = "EPSG:32616"
MIDDLE = np.array([752_760.0, 4_024_270.0])
SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])


def list_commands(page):
    return [line for line in list_lines(page) if line.startswith("tinsmith ")]


def make_rings(*rings):
    coordinates = np.concatenate([MIDDLE + centre + half * SQUARE for *centre, half in rings])
    offsets = np.arange(0, 5 * len(rings) + 1, 5)
    return ts.Features.of_polygons(coordinates, offsets, np.arange(len(rings) + 1), crs=CRS)


def make_lines(*lines, name):
    coordinates = MIDDLE + np.concatenate(lines)
    offsets = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
    return ts.Features.of_lines(coordinates, offsets, crs=CRS, name=name)


def make_lidar(folder):
    """Write two tiles around the window that the page names, and an octree."""
    (folder / "tiles").mkdir()
    for k in range(2):
        cloud = make_cloud(200, seed=k)
        cloud.change_scaling(offsets=np.array([512_000.0, 5_403_000, 300]))
        cloud.xyz = [512_100, 5_403_100, 300] + np.random.default_rng(k).random((200, 3)) * 500
        cloud.write(folder / "tiles" / f"{k}.laz")
    write_copc(folder / "cloud.copc.laz", make_cloud(400))


def write_others(ground):
    """Write a road with its axis, places, a raster, an ortho, a field file without a header."""
    _, _, rows = (ROOT / "sample_data/site_survey.csv").read_text().partition("\n")
    Path("field.csv").write_text(rows)
    shutil.copy(ROOT / "sample_data/codes/junction.csv", "road.csv")
    east, north = ts.read("road.csv", crs=CRS).points[:, :2].mean(axis=0)
    ends = np.array([[east - 60, north], [east + 60, north]])
    ts.write(ts.Features.of_lines(ends, [0, 2], crs=CRS, name="axis"), "centreline.gpkg")
    Path("places.csv").write_text("x,y\n752700,4024250\n752800,4024300\n")
    ts.write(ts.rasterize(ground, spacing=2.0), "other.tif")
    ts.write(ts.contours(ground, interval=1.0), "lines.gpkg")
    write_grey(ground, "ortho.tif")
    corners = np.array([752_760.0, 4_024_302.0]) + [20, 12] * SQUARE
    pad = ts.Features.of_polygons(corners, [0, 5], [0, 1], crs=CRS, name="pad")
    ts.write(pad, "pad.geojson")
    corners = np.array([752_755.0, 4_024_300.0]) + [4, 4] * SQUARE
    ts.write(ts.Features.of_polygons(corners, [0, 5], [0, 1], crs=CRS), "fixed.geojson")


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Return a folder with the files that the pages speak of, made once."""
    folder = tmp_path_factory.mktemp("files")
    with contextlib.chdir(folder):
        write_files()
    return folder


def write_street():
    """Write a road with its profile, and tables of its cross section; a wall as two lines."""
    tops = [(0, 321), (110, 323.5), (244, 324.2)]
    gradient = ts.VerticalAlignment([ts.VerticalPoint(*one) for one in tops], "FG")
    corners = MIDDLE + np.array([[-115, -25], [0, -5], [128, -10]])
    street = ts.Alignment.from_points(corners, radii=150, crs=CRS, verticals=[gradient])
    ts.write(street, "street.xml")
    lanes = [f"{at},both,lane,{width},-0.025,turns," for at, width in ((60, 2), (150, 3))]
    slopes = ["both,,,,cut,1", "both,,,,fill,1"]
    rows = ["station,side,name,width,slope,use,ratio", *lanes, *(f",{row}" for row in slopes)]
    Path("stations.csv").write_text("\n".join(rows) + "\n")
    Path("turns.csv").write_text("station,left,right\n80,-0.025,-0.025\n120,0.03,-0.03\n")
    line = MIDDLE + np.array([[-40.0, 20.0], [-10.0, 20.0]])
    wall = [np.column_stack([line, [z, z]]) for z in (331.0, 327.0)]
    ts.write(ts.Features.of_lines(np.concatenate(wall), [0, 2, 4], crs=CRS), "walls.dxf")


def write_river():
    """Write cross sections with their centreline, and a stream on the site."""
    shape = np.array([[0, 10, 321], [0, 6, 318], [0, 4, 318], [0, 0, 321]])
    moves = np.column_stack([np.array([0.0, 30, 70]), [0, 0, 0], [0, -0.6, -1.4]])
    sections = shape + np.append(MIDDLE, 0.0) + moves[:, None]
    offsets = [0, 4, 8, 12]
    ts.write(ts.Features.of_lines(np.concatenate(sections), offsets, crs=CRS), "sections.gpkg")
    line = MIDDLE + np.array([[-1.0, 5], [71, 5]])
    ts.write(ts.Features.of_lines(line, [0, 2], crs=CRS), "stream-line.gpkg")
    ring = MIDDLE + [60, 4] * SQUARE
    ts.write(ts.Features.of_polygons(ring, [0, 5], [0, 1], crs=CRS), "stream.gpkg")


def write_files():
    Path("sample_data").symlink_to(ROOT / "sample_data")
    survey = ts.read("sample_data/site_survey.csv", crs=CRS)
    ground = ts.triangulate(survey)
    pad = ts.read("sample_data/design_pad.csv", crs=CRS)
    ts.write(survey, "points.csv")
    for name in ("site.ply", "site.gpkg"):
        ts.write(ground, name)
    ts.write(ts.triangulate(ts.lines_from_codes(pad)), "pad.ply")
    ts.write(make_lines([[-60, -30], [0, 5], [60, 40]], name="axis"), "axis.gpkg")
    road = ts.Alignment.from_points(
        MIDDLE + np.array([[-60, -30], [0, 5], [60, 40]]), radii=9, crs=CRS
    )
    ts.write(road, "road.xml")
    write_street()
    write_river()
    crest = np.array([[-30.0, -10.0, 325.0], [30.0, 10.0, 325.0]])
    crest[:, :2] += MIDDLE
    ts.write(ts.Features.of_lines(crest, [0, 2], crs=CRS), "crest.gpkg")
    rows = [
        "side,name,width,slope,use,ratio",
        "both,lane,2,-0.02,,",
        "both,,,,cut,1",
        "both,,,,fill,1",
    ]
    Path("template.csv").write_text("\n".join(rows) + "\n")
    stakes = MIDDLE + np.array([[0.0, 0.0], [5.0, 5.0]])
    rows = [f"{101 + k},{x},{y}" for k, (x, y) in enumerate(stakes.tolist())]
    Path("stakes.csv").write_text("\n".join(["point,easting,northing", *rows]) + "\n")
    ts.write(make_lines([[-60, 20], [60, -20]], [[0, -30], [5, 30]], name="roads"), "roads.gpkg")
    ts.write(make_lines([[-20, -10], [20, 0]], name="kerbs"), "plan.gpkg")
    ts.write(make_lines([[-20, 10], [20, 15]], name="soft"), "soft.shp")
    ts.write(make_rings((0, 0, 70)), "site.geojson")
    ts.write(make_rings((-40, -35, 10)), "toe.geojson")
    corners = (MIDDLE + 60 * SQUARE[:4]).tolist()
    Path("corners.csv").write_text("x,y\n" + "".join(f"{x},{y}\n" for x, y in corners))
    Path("pegs.csv").write_text("x,y\n752790,4024300\n752800,4024305\n")
    ts.write(make_rings((-20, 0, 15), (20, 5, 12)), "parcels.geojson")
    ts.write(make_rings((-40, -30, 3)), "shafts.gpkg")
    ts.write(make_rings((40, 30, 4)), "cars.shp")
    ts.write(make_rings((-40, 30, 5)), "ponds.gpkg")
    hills = np.concatenate([np.zeros(2), [3.0]]) * np.ones((len(survey.points), 1))
    hills[:, 2] *= np.sin(survey.points[:, 0] / 9) + np.cos(survey.points[:, 1] / 7)
    for name, move in (("old", 0.0), ("new", np.array([0.5, -0.25, 0.1]))):
        ts.write(ts.triangulate(survey.points + hills + move, crs=CRS), f"{name}.gpkg")
    shutil.copy("parcels.geojson", "slides.geojson")
    write_others(ground)
    make_lidar(Path())
    shutil.copytree(ROOT / "tests" / "data" / "meshes" / "esri_tin_holes", "old_tin")


@pytest.fixture
def folder(files, tmp_path, monkeypatch):
    """Return a folder with a copy of the files, the one in which commands run.

    Pictures have the size that a page asks for, and are drawn without finer pixels to average.
    """
    shutil.copytree(files, tmp_path, symlinks=True, dirs_exist_ok=True)
    monkeypatch.setattr(picture, "_SUPERSAMPLING", 1)
    monkeypatch.chdir(tmp_path)
    return tmp_path


# ------------------------------------------------------------------------------ commands run

LOSSES = pytest.mark.filterwarnings(
    "ignore::tinsmith.base.errors.LossWarning"
)  # told, as they should be


def run_line(command):
    """Run a line in this process, to no file; return its exit code and what it says."""
    words = shlex.split(re.split(r" >>? ", command)[0])
    done = CliRunner().invoke(main, words[1:])
    return done.exit_code, done.output


@pytest.mark.every_case("slow")
@pytest.mark.slow
@LOSSES
@pytest.mark.parametrize("page", [*filter(list_commands, PAGES)], ids=name_page)
def test_commands_of_the_pages_run(page, folder, can_draw):
    for command in list_commands(page):
        code, said = run_line(command)
        assert code == 0, f"{command}\n{said}"
        words = shlex.split(command)
        outputs = [words[k + 1] for k, word in enumerate(words) if word == "-o"]
        if "--plan" in words:  # which tells what a run would do
            continue
        assert all(split_output(folder / name)[0].exists() for name in outputs), command


@pytest.mark.every_case("slow")
@pytest.mark.slow
@LOSSES
@pytest.mark.parametrize("page", [*filter(list_sessions, PAGES)], ids=name_page)
def test_what_commands_say_is_what_the_pages_show(page, folder, can_draw):
    text = page.read_text()
    for command, shown in list_sessions(page):
        code, said = run_line(command)
        assert (code != 0) == said.startswith("Error"), said
        if os.environ.get("RENEW"):
            text = text.replace(f"$ {command}\n{shown}", f"$ {command}\n{said}")
        else:
            assert level_figures(said) == level_figures(shown), command
    page.write_text(text)


def level_figures(said):
    """Return what a command says without what differs from run to run: seconds and bytes."""
    said = re.sub(r"(?m)^(Time +)[\d.]+ m?s$", r"\1a moment", said)
    return re.sub(r"\(\d[\d.,]* [kM]?(B|bytes)\)", "(size)", said).strip()


# --------------------------------------------------------------------------- all is looked at

LANGUAGES = {"python", "pycon", "sh", "bash", "console", "toml", "json", "js", "cpp", "text"}
RUN_ELSEWHERE = ("tinsmith", "qgis_process", "docker", "rattler-build", "eval")


@pytest.mark.parametrize("page", list_pages(), ids=name_page)
def test_blocks_name_their_language(page):
    """A block without one would be run by no test."""
    found = {block.line: block.language for block in read_blocks(page)}
    odd = {
        line: language
        for line, language in found.items()
        if language not in LANGUAGES and not language.startswith("{")
    }
    assert odd == {}, f"the language must be one of {sorted(LANGUAGES)}"
    rest = remove_code(page.read_text())
    indented = re.findall(r"^    (?:tinsmith|import|ts\.|make|python|\$) .*", rest, re.MULTILINE)
    assert indented == [], "fence it, with its language"


@pytest.mark.parametrize("page", [*filter(list_lines, list_pages())], ids=name_page)
def test_other_commands_of_the_pages_are_there(page):
    """What a test does not run: goals of make, scripts, modules, extras of the package."""
    goals = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.MULTILINE))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for line in list_lines(page):
        words = shlex.split(line, comments=True)
        if words[0] == "make":
            assert {word for word in words[1:] if "=" not in word} <= goals, line
        elif "pip" in words:
            extras = ",".join(re.findall(r"\[([\w,]+)\]", line)).split(",")
            assert set(extras) - {""} <= set(project["optional-dependencies"]), line
        elif words[0] == "python":
            assert words[1] == "-m" or (ROOT / words[1]).exists(), line
        else:
            assert words[0] in RUN_ELSEWHERE, f"no test knows what to make of: {line}"
