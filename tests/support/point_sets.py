"""Sets of points: generators with a generator of numpy, and strategies of hypothesis.

Those of :data:`KINDS` are hard in the ways in which real coordinates are, and in a few worse ones.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import strategies as st

from tinsmith.base.arrays import Float64Array

UTM = np.array([512_345.0, 5_403_210.0])
UTM_CORNER = np.array([500_000.0, 4_000_000.0])


def lattice(rng: np.random.Generator, n: int) -> Float64Array:
    """Whole numbers on a small grid, where everything is collinear, cocircular or repeated."""
    return rng.integers(0, rng.integers(2, 12), (n, 2)).astype(float)


def raster_with_gaps(rng: np.random.Generator, n: int) -> Float64Array:
    """Centres of a raster's cells, some of them and perhaps a disc left out, in any order.

    Now and then its steps vary, one of its points is moved, or one is repeated.
    """
    columns = int(rng.integers(2, max(3, n // 2)))
    rows = -(-n * int(rng.integers(10, 16)) // (10 * columns)) + 1
    column, row = grid(columns, rows).astype(int).T
    far = np.hypot(column - rng.uniform(0, columns), row - rng.uniform(0, rows))
    first = np.argsort(np.where(far < rng.uniform(0, 3), 2.0, rng.random(len(far))))
    taken = first[:n] if rng.random() < 0.5 else np.sort(first[:n])
    steps = rng.choice([30.0, 0.1, 1 / 3, 1.0, 1e-9, 1e6]) * np.array(
        [1.0, rng.choice([1, 2, 0.7])]
    )
    vary = rng.choice([0.0, 0.0, 1e-9, 0.2])
    x = (np.arange(columns) + vary * rng.random(columns)) * steps[0]
    y = (np.arange(rows) + vary * rng.random(rows)) * steps[1]
    xy = np.column_stack([x[column], y[row]])[taken] + rng.choice([0.0, 0.1, 4e6])
    if rng.random() < 0.1:
        xy[rng.integers(n)] += rng.choice([0.0, 0.25]) * steps
        xy[rng.integers(n)] = xy[rng.integers(n)]
    return xy


def neighbours(rng: np.random.Generator, n: int) -> Float64Array:
    """Groups of points a rounding or a few apart."""
    centres = rng.choice([0.1, 1 / 3, 1.0, 7.7, 1e5 / 3, 5.4e6], (1 + n // 6, 2))
    chosen = centres[rng.integers(0, len(centres), n)] * (1.0 + rng.integers(0, 3, (n, 2)))
    return chosen + rng.integers(-3, 4, (n, 2)) * np.spacing(chosen)


def utm_centimetres(rng: np.random.Generator, n: int) -> Float64Array:
    """What a surveyor writes: centimetres at the size of UTM coordinates."""
    size = rng.choice([50, 500, 20_000])
    return np.round(UTM + rng.integers(0, size, (n, 2)) / 100.0, 2)


def fractions(rng: np.random.Generator, n: int) -> Float64Array:
    """Ordinary fractions in the unit square."""
    return rng.random((n, 2))


def thirds(rng: np.random.Generator, n: int) -> Float64Array:
    """Fractions with small denominators, which doubles only come near to."""
    return rng.integers(0, 10, (n, 2)) / rng.choice([3.0, 7.0, 10.0, 30.0])


def mixed_magnitudes(rng: np.random.Generator, n: int) -> Float64Array:
    """From the tiny to the huge in one set."""
    low, high = (-12, 9) if rng.random() < 0.7 else (-59, 60)
    exponents = rng.integers(low, high, (n, 2))
    return rng.choice([-1.0, 1.0], (n, 2)) * (1.0 + rng.random((n, 2))) * 10.0**exponents


def nearly_collinear(rng: np.random.Generator, n: int) -> Float64Array:
    """On one slanted line but for rounding, a few of them a little off it."""
    x = np.sort(rng.random(n)) * rng.choice([1.0, 100.0, 1e5])
    y = x * rng.choice([1 / 3, 0.1, 0.7, 3.3]) + rng.choice([0.0, 0.1, 1e5])
    off = rng.random(n) < 0.1
    return np.column_stack([x, y + off * rng.integers(-4, 5, n) * np.spacing(y + 1.0)])


def cocircular(rng: np.random.Generator, n: int) -> Float64Array:
    """On one circle: exactly (Pythagorean) or but for rounding."""
    if rng.random() < 0.5:
        legs = np.array([(65, 0), (63, 16), (60, 25), (56, 33), (52, 39)], float)
        around = np.vstack([legs, legs[:, ::-1]])
        signs = rng.choice([-1.0, 1.0], (n, 2))
        return around[rng.integers(0, len(around), n)] * signs + rng.choice([0.0, 1000.0])
    angles = rng.random(n) * 2 * np.pi
    return np.column_stack([np.cos(angles), np.sin(angles)]) * rng.choice([1.0, 1e3, 1 / 3])


def clustered(rng: np.random.Generator, n: int) -> Float64Array:
    """Two kinds in one set: survey points and neighbours of theirs."""
    near = utm_centimetres(rng, n)
    near += rng.integers(-1, 2, (n, 2)) * np.spacing(near) * (rng.random((n, 1)) < 0.3)
    return near


KINDS = {
    kind.__name__: kind
    for kind in (
        lattice,
        raster_with_gaps,
        neighbours,
        utm_centimetres,
        fractions,
        thirds,
        mixed_magnitudes,
        nearly_collinear,
        cocircular,
        clustered,
    )
}


def coordinates(rng: np.random.Generator, n: int, kind: str | None = None) -> Float64Array:
    """Return (n, 2) coordinates of one kind, drawn unless it is named."""
    chosen = KINDS[kind or str(rng.choice(list(KINDS)))]
    return np.ascontiguousarray(chosen(rng, n), np.float64)


def points(rng: np.random.Generator, n: int, kind: str | None = None) -> list[list[float]]:
    """Return n points [x, y, elevation] as plain lists; elevations in centimetres."""
    elevations = rng.integers(-500, 100_000, n) / 100.0
    rows: list[Any] = np.column_stack([coordinates(rng, n, kind), elevations]).tolist()
    return rows


# ------------------------------------------------------------------- ordinary sets


def small_integers(rng: np.random.Generator, n: int, side: int = 5) -> Float64Array:
    """Return whole numbers below ``side``."""
    return rng.integers(0, side, (n, 2)).astype(float)


def utm_raster(rng: np.random.Generator, n: int, side: int = 5) -> Float64Array:
    """Return centres of a raster at UTM coordinates, whose distances are not exact."""
    return rng.integers(0, side, (n, 2)) * 30.1 + UTM_CORNER


def utm_floats(rng: np.random.Generator, n: int) -> Float64Array:
    """Return any doubles within 100 units at UTM coordinates."""
    return rng.random((n, 2)) * 100 + UTM_CORNER


def tenths(rng: np.random.Generator, n: int) -> Float64Array:
    """Return tenths from 0 to 3."""
    return np.round(rng.random((n, 2)) * 3, 1)


def scattered(rng: np.random.Generator, count: int, size: float) -> Float64Array:
    """Return points of a square, of no decimals, of one, or of nine."""
    return rng.uniform(0, size, (count, 2)).round(int(rng.choice([0, 1, 9])))


def grid(columns: int, rows: int) -> Float64Array:
    """Return the places of a grid with the spacing 1, row by row."""
    places = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1)
    return places.reshape(-1, 2).astype(float)


def whole_number_grid(
    rng: np.random.Generator, columns: int, rows: int, relief: int
) -> Float64Array:
    """Return (n, 3) points of a grid with whole elevations: flats, pits and equal slopes."""
    xy = grid(columns, rows)
    return np.column_stack([xy, rng.integers(0, relief + 1, len(xy))])


def rolling(rng: np.random.Generator, count: int, noise: float = 2.0) -> Float64Array:
    """Return (n, 3) points of hills and hollows within 100 units, with noise."""
    xy = rng.uniform(0, 100, (count, 2))
    z = 8 * np.sin(xy[:, 0] / 9) * np.cos(xy[:, 1] / 11) + rng.uniform(0, noise, count)
    return np.column_stack([xy, z])


# ---------------------------------------------------------------------- strategies

seeds = st.integers(0, 2**32 - 1)
"""Of generators of numpy."""


def places(
    coordinates: st.SearchStrategy[Any], most: int, *, least: int = 3, unique: bool = True
) -> st.SearchStrategy[list[Any]]:
    """Return a strategy of lists of pairs of coordinates."""
    pairs = st.tuples(coordinates, coordinates)
    return st.lists(pairs, min_size=least, max_size=most, unique=unique)


small_surfaces = st.lists(
    st.tuples(st.integers(0, 4), st.integers(0, 4), st.integers(-2, 2)), min_size=3, max_size=9
)
"""Rows of x, y and elevation on a small grid; some at one place."""


def hard_places(most: int) -> st.SearchStrategy[Float64Array]:
    """Return a strategy of coordinates of every kind, 3 to ``most`` rows, some at one place."""
    return st.builds(
        lambda kind, seed, n: coordinates(np.random.default_rng(seed), n, kind),
        st.sampled_from(list(KINDS)),
        seeds,
        st.integers(3, most),
    )
