"""The commands that the pages of docs/ show run, in a folder with the files they speak of."""

import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from support.lidar_files import make_cloud, write_copc

import tinsmith as ts
from tinsmith.cli import main

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"```(?:ba)?sh\n(.*?)```", re.DOTALL)
PAGES = [page for page in sorted((ROOT / "docs").glob("*.md")) if BLOCK.search(page.read_text())]
CRS = "EPSG:32616"
MIDDLE = np.array([752_760.0, 4_024_270.0])
SQUARE = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]])


def list_commands(page):
    text = "\n".join(BLOCK.findall(page.read_text())).replace("\\\n", " ")
    return [line for line in text.splitlines() if line.startswith("tinsmith ")]


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


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder with the files that the pages speak of."""
    (tmp_path / "sample_data").symlink_to(ROOT / "sample_data")
    monkeypatch.chdir(tmp_path)
    survey = ts.read("sample_data/site_survey.csv", crs=CRS)
    ground = ts.triangulate(survey)
    pad = ts.read("sample_data/design_pad.csv", crs=CRS)
    ts.write(survey, "points.csv")
    for name in ("site.ply", "site.gpkg"):
        ts.write(ground, name)
    ts.write(ts.triangulate(ts.lines_from_codes(pad)), "pad.ply")
    ts.write(make_lines([[-60, -30], [0, 5], [60, 40]], name="axis"), "axis.gpkg")
    ts.write(make_lines([[-60, 20], [60, -20]], [[0, -30], [5, 30]], name="roads"), "roads.gpkg")
    ts.write(make_lines([[-20, -10], [20, 0]], name="kerbs"), "plan.gpkg")
    ts.write(make_lines([[-20, 10], [20, 15]], name="soft"), "soft.shp")
    ts.write(make_rings((0, 0, 70)), "site.geojson")
    ts.write(make_rings((-40, -30, 3)), "shafts.gpkg")
    ts.write(make_rings((40, 30, 4)), "cars.shp")
    ts.write(make_rings((-40, 30, 5)), "ponds.gpkg")
    make_lidar(tmp_path)
    shutil.copytree(ROOT / "tests" / "data" / "meshes" / "esri_tin_holes", "old_tin")
    return tmp_path


@pytest.mark.filterwarnings("ignore::tinsmith.errors.LossWarning")  # told, as they should be
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_of_the_pages_run(page, folder, can_draw):
    commands = list_commands(page)
    assert commands
    for command in commands:
        words = shlex.split(command)[1:]
        done = CliRunner().invoke(main, words)
        assert done.exit_code == 0, f"{command}\n{done.output}"
        outputs = [words[k + 1] for k, word in enumerate(words) if word == "-o"]
        assert all((folder / name).exists() for name in outputs), command
