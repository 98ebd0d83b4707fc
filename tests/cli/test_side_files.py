"""Files are guarded with all that stands beside them: only the outputs that are named change."""

import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import tinsmith as ts
from tinsmith.base.atomic import replacing_path, scratch_folder
from tinsmith.cli import main
from tinsmith.io.registry.lookup import known_formats
from tinsmith.io.registry.side_files import list_sources, list_written_beside

pytestmark = pytest.mark.filterwarnings("ignore::tinsmith.LossWarning")

CRS = "EPSG:32616"
OTHER = "EPSG:32617"
POINTS = np.array([[752_700 + x, 4e6 + y, 5.0 + 0.1 * x] for x in range(4) for y in range(4)])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(name, crs=CRS):
    """Write the points, or cells, as a file in a CRS."""
    tin = ts.triangulate(POINTS, crs=crs, elevation_unit="m")
    if name.endswith((".tif", ".asc")):
        ts.write(ts.rasterize(tin, spacing=1.0), name)
    else:
        ts.write(ts.Features.of_points(POINTS, crs=crs, elevation_unit="m"), name)


def contents():
    return {path.name: path.read_bytes() for path in Path().iterdir() if path.is_file()}


def run(*arguments):
    return CliRunner().invoke(main, [str(one) for one in arguments])


@pytest.mark.parametrize("first", ["site.shp", "site.tif", "site.asc"])
@pytest.mark.parametrize("output", ["site.shp", "site.tif", "site.asc", "site.obj"])
def test_a_command_leaves_every_other_file_as_it_was(folder, first, output):
    if first == output:
        return
    write(first)
    for name in ("site.tif.aux.xml", "site.mtl", "site.dbf"):
        if not Path(name).exists():
            Path(name).write_text("x,y,z\n")
    before = contents()
    verb = "raster" if output.endswith((".tif", ".asc")) else "convert"
    arguments = ["--spacing", "1"] if verb == "raster" else []
    found = run(verb, first, *arguments, "--to-crs", OTHER, "-o", output, "-q")
    after = contents()
    changed = {name for name in before if after.get(name) != before[name]}
    assert found.exit_code in (0, 1, 2), found.output
    assert not changed or found.exit_code == 0
    own = {path.name for path in list_written_beside(Path(output))}
    of_input = {path.name for path in list_sources(Path(first))} | {first}
    assert changed <= own - of_input


@pytest.mark.parametrize("crs", [CRS, OTHER])
def test_the_projection_of_another_data_set_is_not_replaced(folder, crs):
    write("site.shp")
    before = contents()
    tin = ts.triangulate(POINTS, crs=crs, elevation_unit="m")
    raster = ts.rasterize(tin, spacing=1.0)
    if crs == CRS:  # which the file says already
        ts.write(raster, "site.asc")
        assert ts.read("site.asc").crs.is_same(CRS)
    else:
        with pytest.raises(ts.WriteError, match=r"'site\.prj' .* belongs to 'site\.shp'"):
            ts.write(raster, "site.asc")
        assert not Path("site.asc").exists()
    after = contents()
    assert {name: after[name] for name in before} == before


def test_a_raster_without_a_crs_does_not_take_that_of_another(folder):
    write("site.shp")
    bare = ts.rasterize(ts.triangulate(POINTS), spacing=1.0)
    with pytest.raises(ts.WriteError, match="belongs to"):
        ts.write(bare, "site.asc")


def test_parts_of_an_earlier_file_are_replaced(folder):
    write("site.shp", crs=OTHER)
    write("site.shp", crs=CRS)
    assert ts.read("site.shp").crs == CRS
    write("grid.asc", crs=OTHER)
    write("grid.asc", crs=CRS)
    assert ts.read("grid.asc").crs.is_same(CRS)


def test_a_table_beside_a_shapefile_is_an_input_of_its_own(folder):
    Path("u.dbf").write_text("x,y,z\n0,0,1\n4,0,2\n0,4,3\n")
    before = contents()
    found = run("build", "u.dbf", "--format", "delimited", "--crs", CRS, "-o", "u.shp")
    assert found.exit_code == 2
    assert "'u.dbf' is the input" in found.output
    assert contents() == before


def test_a_data_set_that_is_no_input_keeps_its_parts(folder):
    write("site.shp")
    Path("other.csv").write_text("x,y,z\n0,0,1\n4,0,2\n0,4,3\n")
    before = contents()
    found = run("raster", "other.csv", "--crs", OTHER, "--spacing", "1", "-o", "site.asc")
    assert found.exit_code == 1
    assert "belongs to 'site.shp'" in found.output
    assert contents() == before


def test_rasters_of_a_mosaic_are_inputs(folder):
    write("tile.tif")
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open("tile.tif") as tile:
        transform, (rows, columns) = tile.transform, tile.shape
    Path("all.vrt").write_text(
        f'<VRTDataset rasterXSize="{columns}" rasterYSize="{rows}"><SRS>{CRS}</SRS>'
        f"<GeoTransform>{', '.join(map(str, transform.to_gdal()))}</GeoTransform>"
        '<VRTRasterBand dataType="Float64" band="1"><SimpleSource>'
        '<SourceFilename relativeToVRT="1">tile.tif</SourceFilename><SourceBand>1</SourceBand>'
        "</SimpleSource></VRTRasterBand></VRTDataset>"
    )
    before = contents()
    found = run("raster", "all.vrt", "--spacing", "2", "-o", "tile.tif")
    assert found.exit_code == 2, found.output
    assert "part of 'all.vrt'" in found.output
    assert contents() == before


def test_files_of_a_folder_that_is_read_are_inputs(folder):
    Path("pts").mkdir()
    for name, x in (("a.csv", 0), ("b.csv", 9)):
        Path("pts", name).write_text(f"x,y,z\n{x},0,1\n{x + 4},0,2\n{x},4,3\n")
    before = Path("pts/a.csv").read_bytes()
    found = run("build", "pts", "-o", "pts/a.csv")
    assert found.exit_code == 2
    assert "'pts/a.csv' is a file of 'pts', the input" in found.output
    assert Path("pts/a.csv").read_bytes() == before
    assert run("build", "pts", "-o", "pts/c.ply").exit_code == 0


def test_writers_that_write_beside_say_so():
    """What a writer makes beside its file is among the side files of its format."""
    assert {one.name for one in known_formats() if one.write and one.side_files} == {
        *("geotiff", "cog", "asc", "shapefile", "obj", "tin", "gpkg"),
    }


@pytest.mark.parametrize("name", ["site.shp", "site.asc", "site.tif", "site.gpkg", "site.fgb"])
def test_what_stands_beside_a_file_after_writing_is_known(folder, name):
    write(name)
    made = {path.name for path in Path().iterdir()} - {name}
    assert made <= {path.name for path in list_written_beside(Path(name))}
    assert made <= {path.name for path in list_sources(Path(name))}


# ---------------------------------------------------------------- what a killed run leaves


def kill_while_writing(name):
    """Kill a program while it writes a file, and return what it has left."""
    program = (
        "import sys, time; from pathlib import Path; from tinsmith.base.atomic import *\n"
        f"with replacing_path(Path({name!r})) as beside, scratch_folder() as folder:\n"
        "    beside.write_text('half'); print(folder, flush=True); time.sleep(60)\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True
    ) as child:
        scratch = child.stdout.readline().strip()
        child.send_signal(signal.SIGKILL)
    return Path(scratch)


def test_what_a_killed_run_left_is_named_by_the_next(folder, monkeypatch):
    (folder / "tmp").mkdir()
    monkeypatch.setenv("TMPDIR", str(folder / "tmp"))
    monkeypatch.setattr("tempfile.tempdir", str(folder / "tmp"))
    Path("s.csv").write_text("x,y,z\n0,0,1\n4,0,2\n0,4,3\n")
    scratch = kill_while_writing("site.ply")
    left = [one.name for one in Path().iterdir() if one.name.startswith(".site-")]
    assert len(left) == 1
    found = run("build", "s.csv", "-o", "site.ply")
    assert found.exit_code == 0
    assert f"'{left[0]}' was left by a run that did not end" in " ".join(found.output.split())
    assert scratch.name in "".join(found.output.split())
    Path(left[0]).unlink()
    scratch.rmdir()
    found = run("build", "s.csv", "-o", "site.ply")
    assert "was left" not in found.output


def test_files_of_this_run_are_no_leftovers(folder):
    from tinsmith.cli.paths import describe_leftovers

    with scratch_folder(), replacing_path(Path("a.ply")) as beside:
        beside.write_text("x")
        assert len(describe_leftovers([Path("a.ply")])) == 1  # another run may be writing
    assert describe_leftovers([Path("a.ply"), Path(".a-settings.ply")]) == []
