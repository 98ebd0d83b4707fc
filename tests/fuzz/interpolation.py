"""Interpolation: natural neighbour weights against their definition, and what must always hold."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
from support import oracles
from support.natural_oracle import laplace_weights, sibson_weights
from support.point_sets import points

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from .campaign import Campaign, Case

METHODS = ("linear", "nearest", "laplace", "natural", "c1")
_MOST_PLACES = 6
_ROUNDING = 1e-9
"""Of the spread of the elevations, as far as an interpolated one may be off."""


_MOST_RANGE = 1e40
"""The largest coordinate over the smallest that is not 0, for circles that doubles can hold."""


def generate(rng: np.random.Generator) -> Case:
    """Some points, a line through some of them or none, and shares that choose places."""
    case: Case = {
        "points": points(rng, int(rng.integers(3, 11))),
        "shares": rng.random((_MOST_PLACES, 3)).tolist(),
        "kinds": rng.integers(0, 4, _MOST_PLACES).tolist(),
    }
    if rng.random() < 0.4:
        n = len(case["points"])
        case["line"] = rng.choice(n, min(n, int(rng.integers(2, 4))), replace=False).tolist()
        case["kind"] = str(rng.choice(["hard", "soft"]))
    return case


def examine(case: Case) -> str:
    """Ask for elevations that the definition has, and rasters and threads that agree with them."""
    tin = build(case)
    if tin is None:
        return "refused"
    xy = places(tin, case)
    require_bounds(tin, xy)
    require_vertices(tin)
    require_raster(tin, case)
    if "line" in case:
        require_line(tin)
        return case["kind"]
    sizes = np.abs(tin.points[:, :2])
    if sizes.max() > _MOST_RANGE * sizes[sizes > 0].min():
        return "no definition"  # circles overflow: there the surface is linear
    for place in inner(tin, xy):
        require_definition(tin, place)
    return "definition"


def build(case: Case) -> Any:
    """Return the TIN, None if its points or line are refused."""
    rows = np.array(case["points"], float)
    try:
        if "line" not in case:
            return ts.triangulate(rows)
        line = ts.Breakline(rows[case["line"]], kind=case["kind"])
        return ts.triangulate(rows, breaklines=[line])
    except ts.TinsmithError:
        return None


def places(tin: Any, case: Case) -> Float64Array:
    """Places within triangles, on edges, next to them, and outside."""
    found = []
    for shares, kind in zip(np.array(case["shares"]), case["kinds"], strict=True):
        corners = tin.points[tin.triangles[int(shares[0] * len(tin.triangles))], :2]
        middle = (corners[0] + corners[1]) / 2
        weights = (shares + 1e-3) / (shares + 1e-3).sum()
        found.append(
            [
                weights @ corners,
                middle,
                middle + (corners[2] - middle) * 1e-13,
                tin.points[:, :2].min(axis=0)
                + (shares[:2] * 1.2 - 0.1) * np.ptp(tin.points[:, :2], axis=0),
            ][kind]
        )
    xy = np.array(found)
    small, large = 1e-55, 1e70
    xy[np.abs(xy) < small] = 0.0
    return xy[(np.abs(xy) < large).all(axis=1)]


def require_bounds(tin: Any, xy: Float64Array) -> None:
    """An elevation inside and none outside; between those of the vertices but for C1."""
    inside = tin.locate(xy) >= 0
    low, high = tin.points[:, 2].min(), tin.points[:, 2].max()
    for method in METHODS:
        found = tin.interpolate(xy, method=method)
        assert (np.isnan(found) == ~inside).all(), f"{method}: {found}"
        if method != "c1":
            assert (found[inside] >= low).all(), method
            assert (found[inside] <= high).all(), method
        again = tin.interpolate(xy, method=method, extrapolate="nearest", threads=2)
        assert np.isfinite(again).all(), f"{method} outside: {again}"
        assert (again[inside] == found[inside]).all(), f"{method} with threads"


def require_vertices(tin: Any) -> None:
    """Vertices of triangles keep their elevations."""
    used = np.unique(tin.triangles)
    for method in METHODS:
        found = tin.interpolate(tin.points[used, :2], method=method)
        assert (found == tin.points[used, 2]).all(), method


def require_raster(tin: Any, case: Case) -> None:
    """Cells hold the interpolated elevations of their centres."""
    spacing = tin.bounds.diagonal * (0.02 + 0.2 * case["shares"][0][0])
    try:
        raster = ts.rasterize(tin, spacing=spacing)
    except ts.TinsmithError:
        return
    rows, columns = raster.shape
    x = raster.grid.bounds.xmin + (np.arange(columns) + 0.5) * spacing
    y = raster.grid.bounds.ymax - (np.arange(rows) + 0.5) * spacing
    xy = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    try:
        wanted = tin.interpolate(xy)
    except ts.TinsmithError:  # centres beyond the exact range
        return
    found = raster.bands["elevation"].ravel()
    assert np.array_equal(found, wanted, equal_nan=True), "raster"


def require_line(tin: Any) -> None:
    """On hard lines all methods but the nearest vertex are linear."""
    hard = [k for k, kind in enumerate(tin.lines.kinds) if kind != "soft"]
    steps = tin.lines.steps()[np.isin(tin.lines.step_chains(), hard)]
    if len(steps) == 0:
        return
    a, b = tin.points[steps[:, 0]], tin.points[steps[:, 1]]
    middle = (a + b) / 2
    wanted = np.array([elevation_on(*ends) for ends in zip(a, b, middle, strict=True)])
    on_line = ~np.isnan(wanted)
    spread = np.ptp(tin.points[:, 2])
    for method in ("laplace", "natural", "c1"):
        found = tin.interpolate(np.ascontiguousarray(middle[on_line][:, :2]), method=method)
        off = np.abs(found - wanted[on_line])
        assert (off <= _ROUNDING * spread).all(), f"{method} on a line: {off}"


def elevation_on(start: Float64Array, end: Float64Array, place: Float64Array) -> float:
    """Return the elevation of a segment at a place, NaN beside it."""
    a, b, p = (oracles.place(at) for at in (start, end, place))
    if oracles.orientation(a, b, p) != 0:
        return float("nan")
    axis = 0 if a[0] != b[0] else 1
    share = Fraction(p[axis] - a[axis]) / Fraction(b[axis] - a[axis])
    return float(Fraction(start[2]) + share * (Fraction(end[2]) - Fraction(start[2])))


def inner(tin: Any, xy: Float64Array) -> list[list[float]]:
    """Return the places strictly inside the hull, at no vertex."""
    hull = [oracles.place(tin.points[v]) for v in tin.hull]
    sides = list(zip(hull, [*hull[1:], hull[0]], strict=True))
    taken = {tuple(p) for p in tin.points[:, :2].tolist()}
    return [
        p
        for p in xy.tolist()
        if tuple(p) not in taken
        and all(oracles.orientation(a, b, oracles.place(p)) > 0 for a, b in sides)
    ]


def require_definition(tin: Any, place: list[float]) -> None:
    """Natural neighbours weigh as their Voronoi cells say."""
    sites = [oracles.place(p) for p in tin.points]
    z = [Fraction(float(value)) for value in tin.points[:, 2]]
    for method, weigh in (("natural", sibson_weights), ("laplace", laplace_weights)):
        wanted = sum(w * v for w, v in zip(weigh(sites, oracles.place(place)), z, strict=True))
        found = float(tin.interpolate([place], method=method)[0])
        off = abs(found - float(wanted))
        assert off <= _ROUNDING * float(max(z) - min(z)), f"{method} at {place}: {off}"


CAMPAIGNS = (
    Campaign("interpolation", "interpolated elevations against fractions", generate, examine),
)
