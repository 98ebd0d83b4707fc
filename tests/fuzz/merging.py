"""Merged surfaces: each where it has priority, the mean of two where they are blended."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from support.surfaces import stretch_triangles

import tinsmith as ts

from .campaign import Campaign, Case

_STEPS = 512
"""Of coordinates: places so near to each other are one where surfaces are joined."""


def generate(rng: np.random.Generator) -> Case:
    """Two or three surfaces on a lattice or anywhere, over, beside and within each other."""
    origin = [500_000.0, 4_000_000.0] if rng.random() < 0.5 else [0.0, 0.0]
    is_lattice = rng.random() < 0.5
    surfaces = []
    for _ in range(int(rng.choice([2, 2, 3]))):
        low, size = rng.integers(0, 6, 2), rng.integers(2, 8, 2)
        if is_lattice:
            axes = [np.arange(a, a + n + 1.0) for a, n in zip(low, size, strict=True)]
            xy = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)
        else:
            xy = low + rng.uniform(0, 1, (int(rng.integers(4, 30)), 2)) * size
        z = rng.uniform(0, 1) * 5 + rng.uniform(0, 1, len(xy))
        surfaces.append(np.column_stack([xy + origin, z]).tolist())
    return {
        "surfaces": surfaces,
        "max_edge": float(rng.choice([0.0, 0.0, 3.0])),
        "blend": float(rng.choice([0.0, 0.5, 1.3, 20.0])),
        "stretch": float(rng.choice([0.0, 0.0, 0.0, 3.0])),
        "places": rng.uniform(0, 1, (60, 2)).tolist(),
    }


def examine(case: Case) -> str:
    """Merge, and compare with each surface where it has priority."""
    limit = case["max_edge"] or None
    try:
        surfaces = [ts.triangulate(points, max_edge=limit) for points in case["surfaces"]]
        if case["stretch"]:
            surfaces = [stretch_triangles(one, (1.0, case["stretch"])) for one in surfaces]
    except ts.TinsmithError:
        return "refused: TIN"
    try:
        merged = ts.merge(surfaces, blend=case["blend"])
    except ts.PointsError as error:
        if "within the rounding" not in str(error):
            raise
        return "refused: boundaries that rounding lets cross"
    ts.check(merged).raise_if_failed()
    covers = [_cover(one) for one in surfaces]
    union = shapely.union_all(covers)
    step = _STEPS * float(np.spacing(np.abs(merged.points[:, :2]).max()))
    slack = step * (union.length + sum(cover.length for cover in covers)) + 1e-9
    assert abs(merged.triangulation.area - union.area) <= slack, merged.triangulation.area
    if len(surfaces) > 2:
        rest = ts.merge(surfaces[1:], blend=case["blend"])
        again = ts.merge([surfaces[0], rest], blend=case["blend"])
        np.testing.assert_array_equal(again.points, merged.points)
        np.testing.assert_array_equal(again.triangles, merged.triangles)
        return "of three"
    _compare(surfaces, covers, merged, case, step)
    return "blended" if case["blend"] else "joined"


def _compare(surfaces: Any, covers: Any, merged: Any, case: Case, step: float) -> None:
    """Require the upper surface beyond the strip, the lower one beyond triangles that are cut."""
    upper, lower = surfaces
    seam = _find_seam(covers, step)
    low, high = merged.points[:, :2].min(axis=0), merged.points[:, :2].max(axis=0)
    xy = low + (high - low) * case["places"]
    places = shapely.points(xy)
    found, one, two = (tin.interpolate(xy) for tin in (merged, upper, lower))
    steepest = max(float(np.max(ts.slope(tin, unit="ratio"))) for tin in (*surfaces, merged))
    allowed = 1e-9 + steepest * step
    far = shapely.distance(seam, places) if not seam.is_empty else np.full(len(xy), np.inf)
    on_upper = np.isfinite(one)
    if case["blend"]:
        on_upper &= np.isnan(two) | (far > case["blend"] * (1 + 1e-9) + step)
    off = np.nan_to_num(np.abs(found - one))[on_upper]
    assert (off <= allowed).all(), f"not the upper surface by {off.max()}"
    on_lower = np.isfinite(two) & ~shapely.dwithin(covers[0], places, step)
    triangles = shapely.polygons(lower.points[lower.triangles, :2])
    ends = shapely.intersection(*map(shapely.boundary, covers))
    joined = ends if case["blend"] else covers[0]  # at ends of the seam the upper one counts
    cut = shapely.dwithin(triangles, joined, step)
    on_lower &= ~np.isin(lower.locate(xy), np.flatnonzero(cut))
    off = np.nan_to_num(np.abs(found - two))[on_lower]
    assert (off <= allowed).all(), f"not the lower surface by {off.max()}"
    if case["blend"] and not seam.is_empty:
        _require_means(surfaces, merged, seam, case["blend"], allowed)


def _find_seam(covers: Any, step: float) -> Any:
    """Return what of the upper outline lies on the lower surface, and not along its outline."""
    on = shapely.intersection(shapely.boundary(covers[0]), covers[1])
    return shapely.difference(on, shapely.buffer(shapely.boundary(covers[1]), step))


def _require_means(surfaces: Any, merged: Any, seam: Any, blend: float, allowed: float) -> None:
    """Require the mean of both at vertices of theirs that are in the strip."""
    lower = surfaces[1]
    given = {(x, y) for tin in surfaces for x, y in tin.points[:, :2].tolist()}
    is_given = np.array([(x, y) in given for x, y in merged.points[:, :2].tolist()])
    points = merged.points[is_given]
    one, two = (tin.interpolate(points[:, :2]) for tin in surfaces)
    far = shapely.distance(seam, shapely.points(points[:, :2]))
    is_in = np.isfinite(one) & np.isfinite(two) & (far < blend * (1 - 1e-3))
    outline = shapely.boundary(_cover(lower))
    is_in &= shapely.distance(outline, shapely.points(points[:, :2])) > 1e-6
    share = far[is_in] / blend
    wanted = share * one[is_in] + (1 - share) * two[is_in]
    error = np.abs(points[is_in, 2] - wanted)
    assert (error <= allowed + 1e-6).all(), f"not the mean by {error.max()}"


def _cover(tin: Any) -> Any:
    return shapely.union_all(shapely.polygons(tin.points[tin.triangles, :2]))


CAMPAIGNS = [Campaign("merge", "merged and blended surfaces against each", generate, examine)]
