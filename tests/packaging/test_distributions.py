"""Wheel and source distribution: what is in them, and that they work where no compiler is."""

from __future__ import annotations

import json
import subprocess
import tarfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
from support.distributions import ROOT, build, build_source, find_needs, install, require_success

import tinsmith as ts

pytestmark = pytest.mark.slow

PACKAGES = {"": "src/tinsmith", "tin": "tin", "io": "io", "terrain": "terrain"}
OWNERS_CARD = {"numpy", "shapely", "pyproj", "rasterio", "pyvista"}
SURVEY = ROOT / "sample_data" / "site_survey.csv"


@pytest.fixture(scope="module")
def distributions(tmp_path_factory):
    return build(tmp_path_factory.mktemp("dist"))


@pytest.fixture(scope="module")
def machine(distributions, tmp_path_factory):
    """The commands of a plain installation, on a machine with nothing but Python and a loader."""
    _, wheel = distributions
    return install(wheel, tmp_path_factory.mktemp("machine"), *find_needs(wheel))


def call(program, *arguments, cwd, **environment):
    """Run a program with no other program in reach, and nothing of this environment."""
    clean = {"PATH": "/nowhere", "HOME": str(cwd), "LANG": "C.UTF-8", **environment}
    return subprocess.run(
        [program, *map(str, arguments)],
        cwd=cwd,
        env=clean,
        capture_output=True,
        text=True,
        check=False,
    )


def tracked(folder):
    listed = require_success(
        subprocess.run(["git", "ls-files", folder], cwd=ROOT, capture_output=True, text=True)
    )
    return {Path(line).relative_to(folder).as_posix() for line in listed.stdout.splitlines()}


def is_shipped(name):
    """Python, types, and the page as it is bundled; no sources of the core or the page."""
    inside = Path(name)
    if inside.parts[0] == "cpp" or "src" in inside.parts[:-1]:
        return False
    return inside.suffix in (".py", ".pyi", ".typed", ".css", ".html", ".js", ".sha256", ".tsv")


def test_the_wheel_holds_the_packages_and_nothing_else(distributions):
    with zipfile.ZipFile(distributions[1]) as archive:
        names = {one for one in archive.namelist() if not one.endswith("/")}
        sizes = sum(one.file_size for one in archive.infolist())
    expected = {
        "/".join(filter(None, ("tinsmith", inside, name)))
        for inside, folder in PACKAGES.items()
        for name in tracked(folder)
        if is_shipped(name)
    }
    rest = names - expected
    assert expected <= names
    cores = {name for name in rest if "/_core." in name and name.endswith((".so", ".pyd"))}
    assert sorted(Path(name).parent.as_posix() for name in cores) == [
        "tinsmith/terrain", "tinsmith/tin",
    ]  # fmt: skip
    kept = {Path(name).name for name in rest - cores}
    assert kept == {"METADATA", "WHEEL", "RECORD", "entry_points.txt", "LICENSE"}
    assert {"tinsmith/py.typed", "tinsmith/terrain/viewer/page/viewer.js"} <= names
    assert sizes < 12_000_000


def test_the_source_distribution_holds_what_a_wheel_is_built_of(distributions):
    with tarfile.open(distributions[0]) as archive:
        names = {one.name.partition("/")[2] for one in archive.getmembers() if one.isfile()}
        sizes = sum(one.size for one in archive.getmembers())
    top = {name for name in names if "/" not in name}
    folders = {name.partition("/")[0] for name in names - top}
    assert folders == {"src", "tin", "io", "terrain"}
    assert {"pyproject.toml", "CMakeLists.txt", "LICENSE", "README.md", "PKG-INFO"} <= top
    assert {f"{one}/{name}" for one in folders for name in tracked(one)} == names - top
    assert sizes < 8_000_000


def test_a_plain_installation_brings_the_libraries_of_the_main_jobs(distributions):
    assert find_needs(distributions[1]) >= OWNERS_CARD
    assert find_needs(distributions[1]) >= {"pyogrio", "ezdxf", "laspy", "pandas", "matplotlib"}
    assert not find_needs(distributions[1]) & {"geopandas", "meshio", "distributed", "xarray"}


def test_the_three_main_jobs_work_without_a_compiler(machine, tmp_path):
    program = machine / "tinsmith"
    told = require_success(call(program, "--version", cwd=tmp_path)).stdout
    assert told.startswith(f"tinsmith {ts.__version__} (core ")
    assert "build" in require_success(call(program, "--help", cwd=tmp_path)).stdout
    build_it = ("build", SURVEY, "--crs", "EPSG:32616", "-o", "site.ply", "-o", "site.geojson")
    require_success(call(program, *build_it, cwd=tmp_path))
    require_success(call(program, "view", "site.ply", "-o", "site.png", cwd=tmp_path))
    require_success(call(program, "view", "site.ply", "-o", "site.html", cwd=tmp_path))
    raster = ("raster", "site.ply", "--spacing", "5", "-o", "site.tif")
    require_success(call(program, *raster, cwd=tmp_path))
    assert (tmp_path / "site.png").read_bytes().startswith(b"\x89PNG")
    expected = ts.triangulate(ts.read(SURVEY, crs="EPSG:32616"))
    assert np.array_equal(ts.read(tmp_path / "site.ply").points, expected.points)
    assert json.loads((tmp_path / "site.geojson").read_text())["features"]
    assert ts.read(tmp_path / "site.tif") is not None
    require_success(call(program, "check", "site.ply", cwd=tmp_path))


@pytest.mark.every_case("slow")
@pytest.mark.parametrize(
    ("brought", "job", "missing"),
    [
        ((), "build site.csv -o site.ply", "numpy"),
        (("numpy",), "build site.csv --crs EPSG:32616 -o site.ply", "pyproj"),
        (("numpy",), "view site.ply -o site.png", "pyvista"),
        (("numpy",), "raster site.ply --spacing 1 -o site.tif", "rasterio"),
    ],
)
def test_light_use_names_what_is_missing(distributions, tmp_path, brought, job, missing):
    (tmp_path / "site.csv").write_text("x,y,z\n0,0,1\n9,0,2\n0,9,3\n9,9,5\n")
    tin = ts.triangulate([[0, 0, 1], [9, 0, 2], [0, 9, 3]])
    ts.write(tin, tmp_path / "site.ply")
    programs = install(distributions[1], tmp_path / "light", "click", *brought)
    result = call(programs / "tinsmith", *job.split(), cwd=tmp_path)
    assert result.returncode == 1
    assert result.stderr.count("\n") == 1
    assert result.stderr.endswith(
        f"needs {missing}, which is not installed: run pip install {missing}.\n"
    )


def test_light_use_builds_with_numpy_alone(distributions, tmp_path):
    (tmp_path / "site.csv").write_text("x,y,z\n0,0,1\n9,0,2\n0,9,3\n9,9,5\n")
    programs = install(distributions[1], tmp_path / "light", "numpy")
    code = "import tinsmith as ts; print(ts.check(ts.triangulate(ts.read('site.csv'))).ok)"
    result = require_success(call(programs / "python", "-c", code, cwd=tmp_path))
    assert result.stdout.strip() == "True"


def test_the_same_sources_make_the_same_distribution(tmp_path):
    digests = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        source = build_source(tmp_path / name, SOURCE_DATE_EPOCH="1700000000")
        digests.append(source.read_bytes())
    assert digests[0] == digests[1]
