"""What a small job loads: no library that it has no use for. Seconds are for the benchmarks."""

from __future__ import annotations

import json
import sys

import pytest
from support.processes import run

HEAVY = "numpy pandas shapely pyproj rich rasterio pyogrio matplotlib pyvista vtk meshio laspy"
A_COMMAND = "tinsmith.cli.commands.surfaces.build"
NOT_FOR_HELP = f"{HEAVY} importlib.metadata {A_COMMAND} tinsmith.tin tinsmith.io.reading"
NOT_FOR_JOBS = "pandas rich rasterio pyogrio matplotlib pyvista vtk meshio laspy pyarrow"
PARTS = "tinsmith.terrain.plans tinsmith.terrain.charts tinsmith.terrain.viewer"
PROGRAM = """
import json, sys
from tinsmith.cli import main
try:
    main(sys.argv[1:])
except SystemExit as ended:
    assert not ended.code, ended.code
print(json.dumps(sorted(sys.modules)), file=sys.stderr)
"""
ROWS = [(10 * (k % 5), 10 * (k // 5) + k % 3, 100 + k % 7) for k in range(25)]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("startup")
    rows = "".join(f"{752000 + x},{4024000 + y},{z}\n" for x, y, z in ROWS)
    (folder / "survey.csv").write_text(f"easting,northing,elevation\n{rows}")
    modules_after(folder, "build", "survey.csv", "--crs", "EPSG:32616", "-o", "site.ply")
    return folder


def modules_after(folder, *arguments):
    result = run(sys.executable, "-c", PROGRAM, *arguments, cwd=folder)
    assert result.returncode == 0, result.stderr
    return set(json.loads(result.stderr.splitlines()[-1]))


def test_help_loads_no_library_and_no_command(tmp_path):
    assert not modules_after(tmp_path, "--help") & set(NOT_FOR_HELP.split())


def test_help_of_a_command_loads_no_library(tmp_path):
    assert not modules_after(tmp_path, "build", "--help") & set(HEAVY.split())


@pytest.mark.every_case("slow")
@pytest.mark.parametrize(
    "job",
    [
        "build survey.csv --crs EPSG:32616 -o new.ply -o new.geojson",
        "info site.ply",
        "check site.ply",
        "contours site.ply --interval 1 -o contours.geojson",
    ],
)
def test_small_jobs_load_what_they_use(files, job):
    loaded = modules_after(files, *job.split())
    assert not loaded & {*NOT_FOR_JOBS.split(), *PARTS.split(), "tinsmith.tin.paper.comparison"}


def test_triangulating_loads_numpy_alone(tmp_path):
    code = (
        "import sys, tinsmith as ts; ts.triangulate([[0, 0, 1], [4, 0, 2], [0, 3, 4]]);"
        f"print(*sorted(set({HEAVY.split()!r}) & set(sys.modules)))"
    )
    result = run(sys.executable, "-c", code, cwd=tmp_path)
    assert result.stdout.split() == ["numpy"], result.stderr


def test_reading_a_table_loads_no_pandas(files):
    code = "import sys, tinsmith as ts; ts.read('survey.csv'); print('pandas' in sys.modules)"
    assert run(sys.executable, "-c", code, cwd=files).stdout.strip() == "False"
