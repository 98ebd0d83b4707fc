"""More points than memory holds: lidar tiles to a raster of the ground, beside decoding alone.

``python -m benchmarks.many_files FOLDER --points 1e8 --tiles 10`` writes LAZ tiles into the folder
once, then measures in turn, each in processes of its own: decoding the tiles with laspy, as many
processes as cores; the same tiles to a raster of 1 m by ``tinsmith raster``, with its peak memory
over all processes. ``--format csv`` takes one file of delimited text with the same points instead.
``--beside`` computes the raster of the ground points in one text file by both ``tinsmith raster``
and ``gdal_grid -a linear`` (10^6 points take GDAL minutes), and tells how much they differ.
``--in-place`` makes rasters of an octree (COPC) of that many points, of its ground as GeoParquet,
and of a cloud optimized GeoTIFF of as many cells, copied and read in place, and tells what the
folder of the run takes.
"""

from __future__ import annotations

import argparse
import filecmp
import os
import resource
import shutil
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Self

import numpy as np
import rasterio

from .datasets.lidar_tiles import make_ground, make_lidar_tiles, make_text
from .datasets.octrees import write_octree
from .datasets.row_groups import write_row_groups
from .report.tables import TEXT, Table, add_option

COLUMNS = {
    "what": TEXT,
    "points": "{:,}",
    "seconds": "{:.1f}",
    "M points/s": "{:.2f}",
    "of decoding": "{:.2f}",
    "peak MB": "{:,.0f}",
}
PLACES = {
    "what": TEXT,
    "points": "{:,}",
    "seconds": "{:.1f}",
    "core seconds": "{:.1f}",
    "peak MB": "{:,.0f}",
    "disk MB": "{:,.0f}",
}
IN_TILES = ("--tiles", "1")
"""Whatever memory there is."""
_INTERVAL = 0.05


def decode(path: Path) -> int:
    """Decode a file as fast as laspy can in one thread, and return its points."""
    import laspy

    count = 0
    backend = laspy.LazBackend.Lazrs
    with laspy.open(path, laz_backend=backend) as reader:
        for points in reader.chunk_iterator(1_000_000):
            count += len(points.array["X"])
    return count


def decode_all(tiles: list[Path], workers: int) -> int:
    """Decode all tiles, a process for each core."""
    with ProcessPoolExecutor(workers) as pool:
        return sum(pool.map(decode, tiles))


class PeakMemory:
    """The most memory that a process and all its children hold at a time: a context."""

    def __init__(self, process: int) -> None:
        self._process = process
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self.megabytes = 0.0

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *failure: object) -> None:
        self._ended.set()
        self._thread.join()

    def _watch(self) -> None:
        while not self._ended.wait(_INTERVAL):
            found = sum(_measure_own(one) for one in _list_family(self._process))
            self.megabytes = max(self.megabytes, found / 1e3)


def _list_family(process: int) -> list[int]:
    """Return a process and all its descendants."""
    found, waiting = [], [process]
    while waiting:
        one = waiting.pop()
        found.append(one)
        try:
            tasks = list(Path(f"/proc/{one}/task").iterdir())
            for task in tasks:
                waiting += map(int, (task / "children").read_text().split())
        except OSError:
            continue
    return found


def _measure_own(process: int) -> int:
    """Return the memory of a process in kB, its share of what is shared with others."""
    try:
        lines = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0
    sizes = {line.split(":")[0]: line.split()[1] for line in lines[1:]}
    return int(sizes.get("Pss_Anon", 0)) + int(sizes.get("Pss_Shmem", 0))


class PeakDisk(PeakMemory):
    """The most that a folder holds at a time: a context."""

    def __init__(self, folder: Path) -> None:
        super().__init__(0)
        self._folder = folder

    def _watch(self) -> None:
        while not self._ended.wait(_INTERVAL):
            found = sum(_measure_size(one) for one in self._folder.rglob("*"))
            self.megabytes = max(self.megabytes, found / 1e6)


def _measure_size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:  # gone since
        return 0


def time_program(command: list[str]) -> tuple[float, float]:
    """Run a program; return seconds and the peak of memory."""
    begin = time.perf_counter()
    process = subprocess.Popen(command)
    with PeakMemory(process.pid) as peak:
        code = process.wait()
    if code:
        raise SystemExit(f"{' '.join(command)} ended with {code}")
    return time.perf_counter() - begin, peak.megabytes


def rasterize(source: Path, output: Path, workers: int, *more: str) -> tuple[float, float]:
    """Make a raster by the command; return seconds and the peak of memory."""
    command = [sys.executable, "-m", "tinsmith", "raster", str(source), "--spacing", "1"]
    command += ["-o", str(output), "--workers", str(workers), "--restart", "-q", *more]
    return time_program(command)


def _describe_columns(text: Path) -> Path:
    """Write which columns of a text are coordinates, for GDAL."""
    path = text.with_suffix(".vrt")
    path.write_text(
        f"""<OGRVRTDataSource><OGRVRTLayer name="{text.stem}">
<SrcDataSource>{text}</SrcDataSource><GeometryType>wkbPoint25D</GeometryType>
<GeometryField encoding="PointFromColumns" x="easting" y="northing" z="elevation"/>
</OGRVRTLayer></OGRVRTDataSource>""",
        encoding="utf-8",
    )
    return path


def compare_with_gdal(folder: Path, tiles: list[Path], workers: int, table: Table) -> None:
    """Compute the raster of the ground by two programs, and show how much their cells differ."""
    program = shutil.which("gdal_grid")
    if program is None:
        print("gdal_grid: skipped, GDAL's programs are not installed.")
        return
    text = make_ground(tiles, folder / f"ground-{tiles[0].parent.name}.csv")
    count = text.read_bytes().count(b"\n") - 1
    ours, theirs = folder / "ours.tif", folder / "gdal.tif"
    seconds, peak = rasterize(text, ours, workers, "--crs", "EPSG:32616", *IN_TILES)
    rate = count / seconds / 1e6
    table.show("ground, CSV, tinsmith raster", count, seconds, rate, None, peak)
    with rasterio.open(ours) as dataset:
        box, cells = dataset.bounds, dataset.read(1)
    command = [program, "-q", "-a", "linear:radius=0:nodata=nan", "-ot", "Float64"]
    command += ["-txe", str(box.left), str(box.right), "-tye", str(box.top), str(box.bottom)]
    command += ["-outsize", *map(str, cells.shape[::-1]), "-l", text.stem]
    command += [str(_describe_columns(text)), str(theirs)]
    seconds, peak = time_program(command)
    rate = count / seconds / 1e6
    table.show("ground, CSV, gdal_grid -a linear", count, seconds, rate, None, peak)
    with rasterio.open(theirs) as dataset:
        others = dataset.read(1)
    both = np.isfinite(cells) & np.isfinite(others)
    gap = np.abs(cells - others)[both]
    print(
        f"{cells.size:,} cells; {int((np.isfinite(cells) ^ np.isfinite(others)).sum()):,} are "
        f"empty in one of both; {int((gap > 0.001).sum()):,} differ by more than a millimetre, the "
        f"largest difference is {gap.max(initial=0.0):.3f} m."
    )


def make_elevations(path: Path, count: int) -> Path:
    """Write about so many cells of 1 m as a cloud optimized GeoTIFF, unless that is there."""
    if path.exists():
        return path
    side = round(count**0.5)
    row, column = np.mgrid[:side, :side]
    noise = np.random.default_rng(1).normal(0.0, 0.05, row.shape)
    cells = 400 + 60 * np.sin(column / 180) * np.cos(row / 230) + noise
    place = rasterio.Affine(1.0, 0.0, 500_000.0, 0.0, -1.0, 4_100_000.0)
    size = {"count": 1, "height": side, "width": side, "dtype": "float32"}
    how = {"driver": "COG", "compress": "deflate", "predictor": 3}
    beside = path.with_suffix(".part")
    with rasterio.open(beside, "w", **size, **how, crs="EPSG:32616", transform=place) as dataset:
        dataset.write(np.round(cells, 2).astype(np.float32), 1)
    beside.rename(path)
    return path


def compare_places(folder: Path, tile: Path, count: int, workers: int, table: Table) -> None:
    """Compute rasters of copied points and of points in place, whose files must be the same."""
    elevations = make_elevations(folder / f"elevations-{count:.0e}.tif", count)
    octree = write_octree(tile, folder / f"octree-{count:.0e}.copc.laz")
    groups = write_row_groups(tile, folder / f"ground-{count:.0e}.parquet")
    sources = {"COPC": (octree, ("--classes", "2")), "GeoParquet": (groups, ())}
    sources["COG"] = (elevations, ())
    for name, (source, options) in sources.items():
        made = {"copied": folder / f"{name}.tif", "in place": folder / f"{name}-in-place.tif"}
        for how, output in made.items():
            more = (*IN_TILES, *options, *(("--in-place",) if how == "in place" else ()))
            before = _measure_cores()
            with PeakDisk(output.with_name(f"{output.name}.run")) as disk:
                seconds, peak = rasterize(source, output, workers, *more)
            cores = _measure_cores() - before
            table.show(f"{name}, {how}", count, seconds, cores, peak, disk.megabytes)
        if not filecmp.cmp(*made.values(), shallow=False):
            raise SystemExit(f"{name}: the rasters differ")


def _measure_cores() -> float:
    """Return the processor's time of all processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--points", type=lambda text: int(float(text)), default=10**8)
    parser.add_argument("--tiles", type=int, default=10)
    parser.add_argument("--workers", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--format", choices=("laz", "csv"), default="laz")
    parser.add_argument("--beside", action="store_true", help="gdal_grid, on the ground points")
    parser.add_argument("--in-place", action="store_true", help="beside copies; one tile")
    add_option(parser)
    given = parser.parse_args()
    if given.in_place:
        given.tiles = 1
    lidar = given.folder / f"lidar-{given.points:.0e}-{given.tiles}"
    tiles = make_lidar_tiles(lidar, given.points, given.tiles, workers=given.workers)
    table = Table(PLACES if given.in_place else COLUMNS)
    output = given.folder / "dtm.tif"
    if given.in_place:
        compare_places(given.folder, tiles[0], given.points, given.workers, table)
    elif given.beside:
        compare_with_gdal(given.folder, tiles, given.workers, table)
    elif given.format == "csv":
        text = make_text(tiles, given.folder / f"points-{given.points:.0e}.csv")
        count = given.points // given.tiles * given.tiles
        seconds, peak = rasterize(text, output, given.workers, "--crs", "EPSG:32616", *IN_TILES)
        table.show("CSV to GeoTIFF, 1 m", count, seconds, count / seconds / 1e6, None, peak)
    else:
        begin = time.perf_counter()
        count = decode_all(tiles, given.workers)
        decoding = time.perf_counter() - begin
        table.show("decoding alone, laspy", count, decoding, count / decoding / 1e6, 1.0, None)
        cog = ("--output-format", "cog", "--classes", "2")
        seconds, peak = rasterize(lidar, output, given.workers, *cog, *IN_TILES)
        rate = count / seconds / 1e6
        table.show("LAZ to COG, 1 m", count, seconds, rate, decoding / seconds, peak)
    table.write(given.json)


if __name__ == "__main__":
    main()
