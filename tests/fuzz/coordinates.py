"""Coordinates that are hard in the ways in which real ones are, and in a few worse ones."""

from __future__ import annotations

from typing import Any

import numpy as np

from tinsmith.base.arrays import Float64Array

UTM = np.array([512_345.0, 5_403_210.0])


def lattice(rng: np.random.Generator, n: int) -> Float64Array:
    """Whole numbers on a small grid, where everything is collinear, cocircular or repeated."""
    return rng.integers(0, rng.integers(2, 12), (n, 2)).astype(float)


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
