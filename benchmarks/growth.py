"""How the time of every product grows with the points: ``python -m benchmarks.growth``.

Data sets are those on which algorithms grow out of proportion: points on a slanted line, which are
collinear in decimals and not in doubles, rails, rotated grids, a fan, clusters far apart. Each
product runs on n, 2 n, 4 n ... points until it takes more than the limit; then the tasks: builds
with waters over and in each other, a pad with many notches, the triangulation alone. The exponent
is that of the least squares line through the logarithms of the last four processor times, 1 is
linear; *per point* is the time of a point at the largest size, by that at the smallest.

The triangulation alone, from ten thousand to a million points: ``python -m benchmarks.growth --data
--tasks "slanted line, triangulated" ... --start 15625 --most 1000000 --limit 60``.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import tinsmith as ts

from .datasets.uneven import (
    make_clusters,
    make_fan,
    make_ground,
    make_nested_waters,
    make_overlapping_waters,
    make_sawtooth,
)
from .report.tables import TEXT, Table, add_option

__all__ = ["DATASETS", "PRODUCTS", "TASKS", "Growth", "measure"]

Product = Callable[[ts.TIN], object]

COLUMNS = {
    "data": TEXT,
    "product": TEXT,
    "size": "{:,}",
    "seconds": "{:.3f}",
    "exponent": "{:.2f}",
    "per point": "{:.2f}",
    "refused": TEXT,
}

_FITTED = 4
"""Sizes of which the exponent is that of the last."""
_LEAST_SECONDS = 1e-3
"""Shorter times are of the call and not of the points."""


def make_slanted_line(n: int) -> np.ndarray:
    x = np.arange(float(n))
    return np.vstack([np.column_stack([x, x / 3, np.sin(x)]), [[n / 2, 2.0 * n, 0]]])


def make_rails(n: int, degrees: float = 18.434948822922) -> np.ndarray:
    along = np.repeat(np.arange(float(n // 2)), 2)
    across = np.tile([0.0, 1.435], n // 2)
    return np.column_stack([_turn(along * 0.6, across, degrees), 0.02 * np.sin(along / 7) + 300])


def make_rotated_grid(n: int) -> np.ndarray:
    side = math.isqrt(n)
    x, y = (axis.ravel().astype(float) for axis in np.divmod(np.arange(side * side), side))
    z = 300 + 5 * np.sin(x / 9) + 4 * np.cos(y / 7)
    return np.column_stack([np.round(_turn(x, y), 3), z])


def make_hills(n: int) -> np.ndarray:
    xy = np.random.default_rng(1).random((n, 2)) * math.sqrt(n)
    return np.column_stack([xy, 3 * np.sin(xy[:, 0] / 9) + 2 * np.cos(xy[:, 1] / 7)])


def make_comb(n: int) -> np.ndarray:
    """Teeth of points in straight lines, and a back that joins them."""
    of_tooth = max(2, math.isqrt(n) * 4)
    tooth, along = np.divmod(np.arange(n), of_tooth)
    back = np.arange(n // of_tooth * 8)
    x, y = np.append(tooth, back / 8.0), np.append(along * 0.05, np.full(len(back), -1.0))
    return np.column_stack([_turn(x * 10.0, y), np.sin(x) + 0.1 * y])


def make_spiral(n: int) -> np.ndarray:
    """Places along the spiral of Archimedes, whose rounds are 20 steps apart."""
    angle = np.sqrt(np.arange(1.0, n + 1) / (10.0 / math.pi))
    radius = 20.0 * angle / (2 * math.pi)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.sin(angle)])


def _turn(x: np.ndarray, y: np.ndarray, degrees: float = 18.434948822922) -> np.ndarray:
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.column_stack([x * cosine - y * sine, x * sine + y * cosine])


DATASETS: dict[str, Callable[[int], np.ndarray]] = {
    "slanted line": make_slanted_line,
    "rails": make_rails,
    "rotated grid": make_rotated_grid,
    "fan": make_fan,
    "clusters": make_clusters,
    "hills": make_hills,
}
"""Points of about a number, by name."""


def _shift(tin: ts.TIN) -> ts.TIN:
    return ts.triangulate(np.add(tin.points, [0.125, 0.125, 0.0]))


def _spread(tin: ts.TIN) -> np.ndarray:
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    return low + np.random.default_rng(0).random((len(tin.points), 2)) * (high - low)


def _step(tin: ts.TIN) -> float:
    return float(np.ptp(tin.points[:, 2])) / 10


def _paste_middle(tin: ts.TIN) -> ts.TIN:
    inner = np.argsort(tin.points[:, 0])[len(tin.points) // 3 : -len(tin.points) // 3]
    return ts.paste(tin, ts.triangulate(np.add(tin.points[inner], [0, 0, 0.5])))


PRODUCTS: dict[str, Product] = {
    "screens": lambda tin: tin.notes,
    "check": ts.check,
    "contours": lambda tin: ts.contours(tin, _step(tin)),
    "contours, smooth": lambda tin: ts.contours(tin, _step(tin), smooth=_step(tin) / 2),
    "contour bands": lambda tin: ts.contour_bands(tin, _step(tin)),
    "volume": lambda tin: ts.volume(tin, base=0.0),
    "difference, shifted": lambda tin: ts.difference(tin, _shift(tin)),
    "difference, raised": lambda tin: ts.difference(
        tin, ts.TIN.from_triangles(np.add(tin.points, [0, 0, 1]), tin.triangles)
    ),
    "paste": _paste_middle,
    "ponds": lambda tin: ts.ponds(tin, float(np.median(tin.points[:, 2]))),
    "depressions": lambda tin: ts.depressions(tin, nested=True),
    "catchments": ts.catchments,
    "flow accumulation": ts.flow_accumulation,
    "flats": ts.flats,
    "linear": lambda tin: tin.interpolate(_spread(tin)),
    "natural": lambda tin: tin.interpolate(_spread(tin), method="natural"),
    "laplace": lambda tin: tin.interpolate(_spread(tin), method="laplace"),
    "slope, vertices": lambda tin: ts.slope(tin, per="vertex"),
    "curvature": ts.curvature,
    "simplify": lambda tin: ts.simplify(tin, tolerance=_step(tin) / 2),
    "simplify, between points": lambda tin: ts.simplify(
        tin, tolerance=_step(tin) / 2, hold="surface"
    ),
    "profile": lambda tin: ts.profile(tin, tin.points[[0, -2], :2]),
    "voronoi": ts.voronoi,
    "blunders": ts.blunders,
    "preview": ts.preview,
}
"""Products of a surface, by name."""


TASKS: dict[str, tuple[Callable[[int], Any], Callable[[Any], object]]] = {
    "waters over each other": (
        make_overlapping_waters,
        lambda waters: ts.triangulate(make_ground(), water=waters),
    ),
    "waters in each other": (
        make_nested_waters,
        lambda waters: ts.triangulate(make_ground(), water=waters),
    ),
    "pad with notches": (
        make_sawtooth,
        lambda ring: ts.grade(
            ts.triangulate(make_ground()), ring, 15.0, cut_slope=2.0, fill_slope=2.0
        ),
    ),
}
"""What is made for a size, and what is done with it, by name."""

POINT_SETS: dict[str, Callable[[int], np.ndarray]] = {
    "hills": make_hills,
    "slanted line": make_slanted_line,
    **{
        f"rails at {degrees} degrees": partial(make_rails, degrees=degrees)
        for degrees in (0, 37, 45, 89.9)
    },
    "circle and its middle": make_fan,
    "clusters": make_clusters,
    "comb": make_comb,
    "spiral": make_spiral,
}
TASKS |= {
    f"{name}, triangulated": (make, partial(ts.triangulate, threads=1))
    for name, make in POINT_SETS.items()
}


@dataclass(frozen=True)
class Growth:
    """Processor seconds of a product on growing numbers of points, and why it ended."""

    sizes: tuple[int, ...]
    seconds: tuple[float, ...]
    refusal: str = ""

    @property
    def exponent(self) -> float:
        """Of the last sizes; NaN where they are too few or too fast."""
        last = [
            (math.log(size), math.log(one))
            for size, one in zip(self.sizes, self.seconds, strict=True)
            if one >= _LEAST_SECONDS
        ][-_FITTED:]
        if len(last) < 3:
            return math.nan
        return float(np.polyfit(*zip(*last, strict=True), 1)[0])

    @property
    def per_point(self) -> float:
        """Time of a point at the largest size by that at the smallest; NaN of less than two."""
        if len(self.sizes) < 2:
            return math.nan
        return self.seconds[-1] / self.sizes[-1] * self.sizes[0] / self.seconds[0]


def measure(
    make: Callable[[int], Any],
    run: Callable[[Any], object],
    *,
    start: int,
    most: int,
    limit: float,
) -> Growth:
    """Run on what is made for sizes that double, until it takes more than ``limit`` seconds."""
    sizes: list[int] = []
    seconds: list[float] = []
    for count in _double(start, most):
        made = make(count)
        begin = time.process_time()
        try:
            run(made)
        except ts.TinsmithError as error:
            return Growth(tuple(sizes), tuple(seconds), f"{count}: {error}")
        sizes.append(count)
        seconds.append(time.process_time() - begin)
        if seconds[-1] > limit:
            break
    return Growth(tuple(sizes), tuple(seconds))


def _double(start: int, most: int) -> Iterator[int]:
    count = start
    while count <= most:
        yield count
        count *= 2


def main(arguments: list[str] | None = None) -> None:
    """Print a table of the exponents, and of the times of the largest sizes."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.growth", description=__doc__)
    parser.add_argument("--data", nargs="*", default=list(DATASETS), help=_list(DATASETS))
    parser.add_argument("--products", nargs="+", choices=PRODUCTS, default=list(PRODUCTS))
    parser.add_argument("--tasks", nargs="*", default=list(TASKS), help=_list(TASKS))
    parser.add_argument("--start", type=int, default=500, help="points; default 500")
    parser.add_argument("--most", type=int, default=16_000, help="points; default 16,000")
    parser.add_argument("--limit", type=float, default=2.0, help="seconds; default 2")
    add_option(parser)
    given = parser.parse_args(arguments)
    table = Table(COLUMNS)
    runs = [
        (data, name, partial(_build, DATASETS[data]), PRODUCTS[name])
        for data in given.data
        for name in given.products
    ]
    runs += [("", name, *TASKS[name]) for name in given.tasks]
    for data, name, make, run in runs:
        found = measure(make, run, start=given.start, most=given.most, limit=given.limit)
        size, seconds = (found.sizes or (0,))[-1], (found.seconds or (math.nan,))[-1]
        table.show(data, name, size, seconds, found.exponent, found.per_point, found.refusal)
    table.write(given.json)


def _list(names: Iterable[str]) -> str:
    return "; ".join(names) + "; default all"


def _build(make: Callable[[int], np.ndarray], count: int) -> ts.TIN:
    return ts.triangulate(make(count))


if __name__ == "__main__":
    main()
