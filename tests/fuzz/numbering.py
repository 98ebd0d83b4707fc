"""Surfaces whose triangles and points are numbered otherwise: elevations, slopes and means stay.

The oracles, in fractions: the nearest places of the boundary, the nearest vertices, the gradient at
any place, and the area of a cell that triangles cover.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from support.clipping import covered_area
from support.point_sets import grid
from support.relief_oracle import GradientAt

import tinsmith as ts
from tinsmith.base.arrays import Float64Array, Int32Array

from .campaign import Campaign, Case

_MOST_PLACES = 12
VALUES = ("elevation", "slope", "aspect", "hillshade")


def generate(rng: np.random.Generator) -> Case:
    """A lattice or scattered points of a lattice, some triangles left out, and places."""
    columns, rows = (int(side) for side in rng.integers(2, 7, 2))
    lattice = grid(columns, rows)
    if rng.random() < 0.4:
        lattice = np.unique(rng.integers(0, 9, (int(rng.integers(3, 20)), 2)), axis=0)
    scale = float(rng.choice([1.0, 0.5, 4.0]))
    corner = rng.choice([0.0, 0.0, 500_000.0, -4_000_000.0], 2)
    return {
        "points": np.column_stack(
            [lattice * scale + corner, rng.integers(0, 50, len(lattice))]
        ).tolist(),
        "left_out": rng.random(64).tolist(),
        "share": float(rng.choice([0.0, 0.2, 0.5])),
        "places": (rng.integers(-3, 20, (_MOST_PLACES, 2)) * scale / 2 + corner).tolist(),
        "spacing": scale * float(rng.choice([0.25, 0.5, 1.0, 2.0])),
        "shift": float(rng.choice([0.0, 0.5])),
        "order": int(rng.integers(2**31)),
    }


def examine(case: Case) -> str:
    """Ask both numberings, and the definitions."""
    tin = build(case)
    if tin is None:
        return "refused"
    other = renumber(tin, case["order"])
    require_outside(tin, other, np.array(case["places"]))
    label = require_relief(tin, other, case)
    require_means(tin, case)
    return label


def build(case: Case) -> Any:
    """Return the surface without some of its triangles."""
    points = np.array(case["points"], float)
    try:
        whole = ts.triangulate(points)
    except ts.TinsmithError:
        return None
    shares = np.resize(np.array(case["left_out"]), len(whole.triangles))
    kept = whole.triangles[shares >= case["share"]]
    return ts.TIN.from_triangles(whole.points, kept) if len(kept) else None


def renumber(tin: Any, seed: int) -> Any:
    """Return the same surface by other numbers of points, triangles and corners."""
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(tin.points))
    number = np.empty(len(order), np.int32)
    number[order] = np.arange(len(order))
    triangles: Int32Array = number[tin.triangles[rng.permutation(len(tin.triangles))]]
    turned = [np.roll(one, int(rng.integers(3))) for one in triangles]
    return ts.TIN.from_triangles(tin.points[order], np.array(turned))


def require_outside(tin: Any, other: Any, places: Float64Array) -> None:
    """The westernmost of the nearest places, of several of these the southernmost."""
    for method in ("linear", "nearest"):
        found, again = (
            one.interpolate(places, method=method, extrapolate="nearest") for one in (tin, other)
        )
        assert np.array_equal(found, again), f"{method} by another numbering"
    inside = tin.locate(places) >= 0
    nearest = tin.interpolate(places, method="nearest", extrapolate="nearest")
    linear = tin.interpolate(places, extrapolate="nearest")
    rows = [tuple(map(Fraction, row)) for row in tin.points.tolist()]
    for place, is_inside, z, z_nearest in zip(
        places.tolist(), inside.tolist(), linear.tolist(), nearest.tolist(), strict=True
    ):
        p = (Fraction(place[0]), Fraction(place[1]))
        first = min(((r[0] - p[0]) ** 2 + (r[1] - p[1]) ** 2, r) for r in rows)
        assert z_nearest == float(first[1][2]), f"nearest vertex of {place}"
        if not is_inside:
            wanted = float(find_on_boundary(tin, p))
            assert abs(z - wanted) <= 1e-9, f"{place}: {z}, not {wanted}"


def find_on_boundary(tin: Any, p: tuple[Fraction, Fraction]) -> Fraction:
    """Return the elevation at the nearest place of the boundary, exactly."""
    best = None
    for ring in tin.rings:
        corners = [tuple(map(Fraction, row)) for row in tin.points[ring].tolist()]
        for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
            along = (b[0] - a[0], b[1] - a[1])
            share = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / (
                along[0] ** 2 + along[1] ** 2
            )
            share = min(max(share, Fraction(0)), Fraction(1))
            x, y, z = (a[k] + share * (b[k] - a[k]) for k in range(3))
            one = ((x - p[0]) ** 2 + (y - p[1]) ** 2, x, y, z)
            best = one if best is None or one < best else best
    assert best is not None
    return best[3]


def require_relief(tin: Any, other: Any, case: Case) -> str:
    """Cells whose centres lie on vertices, on edges and within triangles."""
    spacing = case["spacing"]
    west, south = tin.bounds.xmin - case["shift"] * spacing, tin.bounds.ymin - spacing / 2
    bounds = ts.Bounds(west, south, west + 8 * spacing, south + 8 * spacing)
    grid = ts.Grid(bounds, (8, 8), spacing)
    try:
        made = {v: ts.rasterize(tin, grid=grid, value=v).bands[v] for v in VALUES}
    except ts.PointsError:
        return "no cell"
    for value, band in made.items():
        again = ts.rasterize(other, grid=grid, value=value).bands[value]
        assert np.array_equal(band, again, equal_nan=True), f"{value} by another numbering"
    gradient_at = GradientAt(tin.points, tin.triangles)
    for row in range(8):
        for column in range(8):
            x = bounds.xmin + (column + 0.5) * spacing
            y = bounds.ymax - (row + 0.5) * spacing
            wanted, found = gradient_at.slope(x, y), made["slope"][row, column]
            assert np.isnan(found) == np.isnan(wanted), f"slope at {x}, {y}"
            assert np.isnan(wanted) or abs(found - wanted) <= 1e-9, f"slope at {x}, {y}"
    return "cells"


def require_means(tin: Any, case: Case) -> None:
    """A cell has a mean if it is covered, and not if it is touched."""
    spacing = case["spacing"] * 0.75
    means = ts.rasterize(tin, spacing=spacing, at="mean")
    band, bounds = means.bands["elevation"], means.grid.bounds
    corners = tin.points[tin.triangles, :2]
    chosen = np.random.default_rng(case["order"]).permutation(band.size)[:60]
    for row, column in zip(*np.unravel_index(chosen, band.shape), strict=True):
        west, north = bounds.xmin + column * spacing, bounds.ymax - row * spacing
        area = covered_area(corners, (west, north - spacing, west + spacing, north))
        assert np.isnan(band[row, column]) == (area == 0), f"mean of cell {row}, {column}"


CAMPAIGNS = (
    Campaign(
        "numbering",
        "surfaces numbered otherwise: elevations outside, slopes and means of cells",
        generate,
        examine,
    ),
)
