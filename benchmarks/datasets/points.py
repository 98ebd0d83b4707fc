"""Point sets as they come from the field and from the pen, all at UTM-sized coordinates.

Every generator takes the number of points wanted and returns that many or a few less (whole rows,
whole lines), without two at one place, in the order in which such data arrive. Seeds are fixed:
the same call gives the same points.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tinsmith.base.arrays import Float64Array

__all__ = ["DATASETS", "UTM_CORNER", "lift_to_ground", "make_points"]


UTM_CORNER = np.array([500_000.0, 4_000_000.0])
SEED = 20_261


def make_points(name: str, n: int) -> Float64Array:
    """Make the data set of that name in ``DATASETS``: (about n, 3) float64 array, metres.

    At least 200 points can be wanted.
    """
    rng = np.random.default_rng(SEED)
    return lift_to_ground(DATASETS[name](n, rng))


def lift_to_ground(xy: Float64Array) -> Float64Array:
    """Put places on rolling ground: (n, 2) to (n, 3), metres."""
    x, y = (xy - UTM_CORNER).T
    z = 120.0 + 15.0 * np.sin(x / 370.0) + 9.0 * np.cos(y / 190.0) + 0.002 * x
    return np.column_stack([xy, z])


def make_uniform(n: int, rng: np.random.Generator) -> Float64Array:
    """One point a square metre on average, in random order."""
    return UTM_CORNER + rng.random((n, 2)) * np.sqrt(n)


def make_raster(n: int, rng: np.random.Generator) -> Float64Array:
    """Cell centres of a 30 m raster, row by row from the north: every cell a tie."""
    del rng
    return UTM_CORNER + _make_lattice(n) * 30.0


def make_decimal_raster(n: int, rng: np.random.Generator) -> Float64Array:
    """0.1 m raster as read from text: 0.1 is no binary number, so that ties are nearly ties."""
    del rng
    tenths = np.round(UTM_CORNER * 10.0) + _make_lattice(n)
    return tenths / 10.0


def make_raster_with_gaps(n: int, rng: np.random.Generator) -> Float64Array:
    """30 m raster without a lake of a fiftieth of its area, and without one cell in twenty."""
    steps = _make_lattice(round(n / (0.95 * 0.98)))
    columns, rows = steps.max(axis=0) + 1.0
    from_lake = np.hypot(steps[:, 0] - 0.6 * columns, steps[:, 1] - 0.4 * rows)
    is_land = from_lake**2 > 0.02 * columns * rows / np.pi
    return UTM_CORNER + steps[is_land & (rng.random(len(steps)) > 0.05)] * 30.0


def make_scan_lines(n: int, rng: np.random.Generator) -> Float64Array:
    """Lidar scan lines 1 m apart, jittered along and across, rounded to cm."""
    steps = _make_lattice(n)
    jitter = rng.uniform([-0.4, -0.05], [0.4, 0.05], steps.shape)
    return np.round(UTM_CORNER + steps + jitter, 2)


def make_clusters(n: int, rng: np.random.Generator) -> Float64Array:
    """200 Gaussian clusters in a square of 10 km, sigma from 0.1 to 300 m."""
    centres = rng.random((200, 2)) * 10_000.0
    sigmas = np.geomspace(0.1, 300.0, 200)
    member = np.arange(n) % 200
    offsets = rng.standard_normal((n, 2)) * sigmas[member, None]
    return UTM_CORNER + (centres[member] + offsets)[rng.permutation(n)]


def make_contour_lines(n: int, rng: np.random.Generator) -> Float64Array:
    """100 sinuous lines 100 m apart and 10 km long: dense along, sparse across."""
    count = n // 100
    along = np.linspace(0.0, 10_000.0, count)
    phases = rng.uniform(0.0, 2.0 * np.pi, (100, 2, 1))
    across = 40.0 * np.sin(along / 310.0 + phases[:, 0]) + 5.0 * np.sin(along / 47.0 + phases[:, 1])
    line = 100.0 * np.arange(100)[:, None]
    return UTM_CORNER + _stack_plane(np.broadcast_to(along, across.shape), line + across)


def make_survey_tracks(n: int, rng: np.random.Generator) -> Float64Array:
    """20 tracks of a boat 200 m apart, to and fro, soundings evenly along 20 km."""
    count = n // 20
    along = np.tile(np.linspace(0.0, 20_000.0, count), (20, 1))
    along[1::2] = along[1::2, ::-1]
    line = 200.0 * np.arange(20)[:, None]
    return UTM_CORNER + _stack_plane(along, line + rng.normal(0.0, 0.3, along.shape))


def make_rails(n: int, rng: np.random.Generator) -> Float64Array:
    """Two straight rails 1.435 m apart, a point every 0.2 m: collinear but for rounding."""
    del rng
    along = 0.2 * np.arange(n // 2)
    bearing = np.deg2rad(37.0)
    forward = np.array([np.sin(bearing), np.cos(bearing)])
    left = np.array([-forward[1], forward[0]])
    rail = along[:, None] * forward
    return UTM_CORNER + np.concatenate([rail, rail + 1.435 * left])


def make_circle(n: int, rng: np.random.Generator) -> Float64Array:
    """One circle of radius 1 km, in random order."""
    return UTM_CORNER + 1000.0 * _place_on_circle(n, rng)


def make_few_circles(n: int, rng: np.random.Generator) -> Float64Array:
    """Seven round tanks of 50 to 400 m that do not touch, one after the other."""
    radii = np.linspace(50.0, 400.0, 7)
    centres = np.column_stack([np.arange(7) * 1000.0, rng.uniform(0.0, 3000.0, 7)])
    rings = [_place_on_circle(n // 7, rng) * r + c for r, c in zip(radii, centres, strict=True)]
    return UTM_CORNER + np.concatenate(rings)


def make_dense_corner(n: int, rng: np.random.Generator) -> Float64Array:
    """Raster of 30 m, and 1 % of all points in one metre beside its south-west corner."""
    dense = UTM_CORNER + 1.0 + rng.random((n // 100, 2))
    return np.concatenate([make_raster(n - n // 100, rng), dense])


def _make_lattice(n: int) -> Float64Array:
    """About n whole coordinates, row by row from the north, west to east."""
    columns = round(np.sqrt(n))
    rows = n // columns
    y, x = np.divmod(np.arange(rows * columns), columns)
    return np.column_stack([x, rows - 1 - y]).astype(np.float64)


def _place_on_circle(n: int, rng: np.random.Generator) -> Float64Array:
    """Places on the unit circle in random order; jittered by less than half a step, so distinct."""
    step = np.arange(n) + rng.uniform(-0.3, 0.3, n)
    angle = rng.permutation(step) * (2.0 * np.pi / n)
    return np.column_stack([np.cos(angle), np.sin(angle)])


def _stack_plane(x: Float64Array, y: Float64Array) -> Float64Array:
    return np.column_stack([np.ravel(x), np.ravel(y)])


DATASETS: dict[str, Callable[[int, np.random.Generator], Float64Array]] = {
    "uniform": make_uniform,
    "raster": make_raster,
    "decimal raster": make_decimal_raster,
    "raster with gaps": make_raster_with_gaps,
    "scan lines": make_scan_lines,
    "clusters": make_clusters,
    "contour lines": make_contour_lines,
    "survey tracks": make_survey_tracks,
    "rails": make_rails,
    "circle": make_circle,
    "few circles": make_few_circles,
    "dense corner": make_dense_corner,
}
"""The generators by name."""
