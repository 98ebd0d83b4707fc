"""Products of a surface, each in a process of its own: ``python -m benchmarks.products NAME N``.

A line of JSON tells the seconds by the clock and of the processor, how far the memory rose above
what the process held with its input, and how much was found. An AssertionError says that the answer
is wrong.

With ``--against PYTHON`` a product is run in turn by the interpreter of another installation, such
as that of the commit before, and by this one; the line tells the best of each, and their ratios.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import tinsmith as ts

from .ground import make_terrain, measure_errors

__all__ = ["PRODUCTS"]

DROPS = 1000
NOISE = 0.03
INTERVAL = 5.0
EYE_HEIGHT = 30.0
WARM_UP_POINTS = 200


class Product(NamedTuple):
    """A function of a surface, its input, and what must hold of its answer.

    ``prepare`` makes the input from the number of points, ``run`` the answer from the input;
    ``check`` looks at both and tells how much was found.
    """

    prepare: Callable[[int], Any]
    run: Callable[[Any], Any]
    check: Callable[[Any, Any], str]


def make_hills(count: int) -> ts.TIN:
    """Return hills of random points, one to the square metre, with noise."""
    rng = np.random.default_rng(1)
    x, y = rng.uniform(0, np.sqrt(count), (2, count))
    z = 300 + 20 * np.sin(x / 110) * np.cos(y / 140) + 0.05 * x + rng.normal(0, NOISE, count)
    return ts.triangulate(np.column_stack([x, y, z]))


def make_rings(count: int) -> ts.TIN:
    """Return contours of many cones, with their lines; on top of each it is flat."""
    hills, rings = max(1, count // 1000), 10
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    side = int(np.ceil(np.sqrt(hills)))
    lines = []
    for hill in range(hills):
        center = np.array([hill % side, hill // side]) * 2.5 * rings
        for ring in range(1, rings + 1):
            height = np.full((len(angle), 1), INTERVAL * (rings - ring))
            line = np.hstack([center + ring * circle, height])
            lines.append(ts.Breakline(np.vstack([line, line[:1]])))
    return ts.triangulate(np.zeros((0, 3)), breaklines=lines)


def make_pair(count: int) -> tuple[ts.TIN, ts.TIN]:
    """Return hills, and a surface for their middle that has a quarter as many points."""
    base = make_hills(count)
    rng = np.random.default_rng(2)
    half = np.sqrt(count) / 4
    xy = np.array([base.bounds.center]) + rng.uniform(-half, half, (count // 4, 2))
    return base, ts.triangulate(np.column_stack([xy, base.interpolate(xy) + 1.0]))


def grade_pad(tin: ts.TIN) -> ts.TIN:
    """Grade a pad in the middle, an eighth as wide as the surface."""
    half = tin.bounds.width / 16
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * half
    return ts.grade(tin, np.array(tin.bounds.center) + corners, 305.0, cut_slope=1, fill_slope=0.5)


def follow_drops(tin: ts.TIN, *, is_filled: bool) -> ts.Features:
    """Let drops fall everywhere."""
    x, y = np.random.default_rng(3).uniform(0.05, 0.95, (2, DROPS)) * tin.bounds.width
    low = np.array([tin.bounds.xmin, tin.bounds.ymin])
    places = low + np.column_stack([x, y])
    return ts.flow_path(tin, places, fill_depressions=is_filled)


def look_around(tin: ts.TIN) -> Any:
    """Tell which vertices are seen from above the middle."""
    return ts.visible_vertices(tin, tin.bounds.center, eye_height=EYE_HEIGHT)


def look_over(tin: ts.TIN) -> ts.Features:
    """Divide the surface into what is seen from above the middle, and what is hidden."""
    return ts.viewshed(tin, tin.bounds.center, eye_height=EYE_HEIGHT)


def look_along_lines(tin: ts.TIN) -> ts.Features:
    """Look from the middle at vertices everywhere."""
    chosen = np.random.default_rng(3).choice(len(tin.points), DROPS, replace=False)
    targets = tin.points[chosen, :2]
    return ts.line_of_sight(tin, tin.bounds.center, targets, eye_height=EYE_HEIGHT)


def write_and_read(tin: ts.TIN) -> ts.TIN:
    """Write a surface as a GeoPackage, and read it again."""
    with tempfile.TemporaryDirectory() as folder:
        return ts.read(write_whole(tin, Path(folder, "a.gpkg")))


def write_whole(tin: ts.TIN, path: Path | None = None) -> Path:
    """Write a surface as a GeoPackage."""
    with tempfile.TemporaryDirectory() as folder:
        return ts.write(tin, path or Path(folder, "a.gpkg"))


# --------------------------------------------------------------------- what must hold


def _require_tiles(tin: ts.TIN, found: ts.Features) -> str:
    area = found.columns["area"].sum()
    assert abs(area - tin.area) <= 1e-9 * tin.area, f"catchments of {area}, surface of {tin.area}"
    return f"{len(found):,} catchments"


def _require_some(given: Any, found: Any) -> str:
    del given
    assert len(found) > 0
    return f"{len(found):,} rows"


def _require_few(tin: ts.TIN, found: Any) -> str:
    assert len(found) <= len(tin.points) // 10_000  # there is none but the noise
    return f"{len(found):,} named"


def _require_ends(tin: ts.TIN, found: ts.Features) -> str:
    del tin
    assert len(np.unique(found.columns["start"])) == DROPS
    assert (found.columns["drop"] >= 0).all()
    return f"{len(found.coordinates):,} places"


def _require_ground(given: Any, found: Any) -> str:
    errors = measure_errors(found.is_ground, given[1])
    assert errors.total < 5, errors
    return f"{errors.total:.2f} % wrong"


def _require_pad(tin: ts.TIN, found: ts.TIN) -> str:
    assert abs(found.interpolate([tin.bounds.center])[0] - 305.0) < 1e-9
    return f"{len(found.points):,} vertices"


def _require_patch(given: tuple[ts.TIN, ts.TIN], found: ts.TIN) -> str:
    patch = given[1]
    center = [patch.bounds.center]
    assert abs(found.interpolate(center)[0] - patch.interpolate(center)[0]) < 1e-9
    return f"{len(found.points):,} vertices"


def _require_near(tin: ts.TIN, found: ts.TIN) -> str:
    off = np.abs(found.interpolate(tin.points[:, :2]) - tin.points[:, 2]).max()
    assert off <= 0.5 * (1 + 1e-9), f"{off} off"
    return f"{len(found.points):,} vertices"


def _require_mended(tin: ts.TIN, found: ts.TIN) -> str:
    assert len(ts.flats(found)) < len(ts.flats(tin))
    return f"{len(found.points) - len(tin.points):,} points added"


def _require_seen_and_hidden(tin: ts.TIN, found: Any) -> str:
    assert len(found) == len(tin.points)
    assert 0 < found.sum() < len(found)
    return f"{found.sum():,} seen"


def _require_parts(tin: ts.TIN, found: ts.Features) -> str:
    area = dict(zip(found.columns["class"], found.columns["area"], strict=True))
    assert abs(sum(area.values()) - tin.area) <= 1e-6 * tin.area, f"{area}, surface of {tin.area}"
    return f"{100 * area['visible'] / tin.area:.1f} % seen"


def _require_same(tin: ts.TIN, found: ts.TIN) -> str:
    assert (found.points.view(np.int64) == tin.points.view(np.int64)).all()
    assert (found.triangles == tin.triangles).all()
    return f"{len(found.triangles):,} triangles"


def _require_sights(tin: ts.TIN, found: ts.Features) -> str:
    chosen = np.random.default_rng(3).choice(len(tin.points), DROPS, replace=False)
    seen = ts.visible_vertices(tin, tin.bounds.center, eye_height=EYE_HEIGHT)[chosen]
    differing = int((found.columns["visible"] != seen).sum())
    assert differing == 0, f"{differing} lines of sight differ from the vertices seen"
    return f"{seen.sum():,} seen"


PRODUCTS: dict[str, Product] = {
    "pits": Product(make_hills, ts.pits, _require_some),
    "depressions": Product(make_hills, ts.depressions, _require_some),
    "ponds": Product(make_hills, partial(ts.ponds, level=300.0), _require_some),
    "ridges and valleys": Product(make_hills, ts.ridges_and_valleys, _require_some),
    f"flow paths, {DROPS:,}": Product(
        make_hills, partial(follow_drops, is_filled=False), _require_ends
    ),
    f"flow paths, {DROPS:,}, filled": Product(
        make_hills, partial(follow_drops, is_filled=True), _require_ends
    ),
    "flow accumulation": Product(make_hills, ts.flow_accumulation, _require_some),
    "flow accumulation, filled": Product(
        make_hills, partial(ts.flow_accumulation, fill_depressions=True), _require_some
    ),
    "catchments": Product(make_hills, ts.catchments, _require_tiles),
    "catchments, filled": Product(
        make_hills, partial(ts.catchments, fill_depressions=True), _require_tiles
    ),
    "blunders": Product(make_hills, ts.blunders, _require_few),
    "ground": Product(make_terrain, lambda given: ts.ground(given[0]), _require_ground),
    "flats": Product(make_rings, ts.flats, _require_some),
    "flats mended": Product(make_rings, ts.mend_flats, _require_mended),
    "grade": Product(make_hills, grade_pad, _require_pad),
    "paste": Product(make_pair, lambda given: ts.paste(*given), _require_patch),
    "simplify": Product(make_hills, partial(ts.simplify, tolerance=0.5, threads=1), _require_near),
    "visible vertices": Product(make_hills, look_around, _require_seen_and_hidden),
    "viewshed": Product(make_hills, look_over, _require_parts),
    "GeoPackage": Product(make_hills, write_whole, lambda _, path: path.suffix),
    "GeoPackage, read again": Product(make_hills, write_and_read, _require_same),
    f"lines of sight, {DROPS:,}": Product(make_hills, look_along_lines, _require_sights),
}
"""By name; hills have a point a square metre."""


def measure(name: str, count: int) -> dict[str, Any]:
    """Run a product once, on ``count`` points."""
    product = PRODUCTS[name]
    small = product.prepare(max(WARM_UP_POINTS, 1000))
    product.run(small)  # libraries are loaded
    given = product.prepare(count)
    before = _forget_peak()
    begin, ticks = time.perf_counter(), time.process_time()
    found = product.run(given)
    figures: dict[str, Any] = {
        "seconds": time.perf_counter() - begin,
        "processor_seconds": time.process_time() - ticks,
    }
    if before is not None:
        figures["peak_bytes"] = _read_status("VmHWM") - before
    return {**figures, "found": product.check(given, found)}


def _forget_peak() -> int | None:
    """Forget the peak of memory so far; return the memory now, None where that is not told."""
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    except OSError:
        return None
    return _read_status("VmRSS")


def _read_status(name: str) -> int:
    lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith(name))


def compare(name: str, count: int, other: str, rounds: int) -> dict[str, Any]:
    """Run a product in two installations in turn; return the best of each, and ratios."""
    command = ["-m", "benchmarks.products", name, str(count)]
    runs: dict[str, list[dict[str, Any]]] = {other: [], sys.executable: []}
    for _ in range(rounds):
        for python, found in runs.items():
            done = subprocess.run([python, *command], check=True, capture_output=True, text=True)
            found.append(json.loads(done.stdout))
    keys = [key for key in runs[other][0] if key != "found"]
    base, change = (
        {key: min(run[key] for run in found) for key in keys} for found in runs.values()
    )
    ratios = {key: base[key] / change[key] for key in keys}
    return {"base": base, "change": change, "base / change": ratios}


def main(arguments: list[str] | None = None) -> None:
    """Measure what the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.products", description=__doc__)
    parser.add_argument("name", choices=PRODUCTS)
    parser.add_argument("points", type=int, metavar="N")
    parser.add_argument("--against", metavar="PYTHON")
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args(arguments)
    if given.against:
        print(json.dumps(compare(given.name, given.points, given.against, given.rounds)))
        return
    print(json.dumps(measure(given.name, given.points)))


if __name__ == "__main__":
    main()
