"""Flats of contours of random surfaces: mended between the contours, marked, and counted."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """Points of a surface with some waves, and an interval of contours."""
    count = int(rng.integers(20, 150))
    xy = rng.random((count, 2)) * 100.0
    if rng.random() < 0.5:
        xy = np.rint(xy)
    waves = rng.normal(size=(4, 3)) * [0.08, 0.08, 10.0]
    z = sum(size * np.sin(xy @ [east, north] + k) for k, (east, north, size) in enumerate(waves))
    if rng.random() < 0.3:
        z = np.rint(z)
    return {
        "points": np.column_stack([xy, z]).tolist(),
        "interval": float(rng.choice([1.0, 2.5, 5.0, 7.0])),
        "every": int(rng.integers(1, 4)),
    }


def examine(case: Case) -> str:
    """Trace contours, build their TIN, mend it."""
    try:
        lines = trace(case)
        survey = ts.Survey(points=np.concatenate(lines), breaklines=lines)
        tin = ts.triangulate(survey)
    except (ts.TinsmithError, ValueError):
        return "refused: contours"
    if not ts.check(tin).ok:
        return "not ours: unsound before"
    mended = ts.mend_flats(tin)
    found = ts.check(mended)
    assert found.ok, [one.sentence for one in found.problems]
    added = mended.attributes["origin"] == "added"
    given = tin.points[tin.vertex_of]
    kept = mended.points[mended.vertex_of[: len(given)]]
    assert np.array_equal(kept, given), "what was given changed"
    if not has_crossings(tin):  # which are found anew
        assert np.array_equal(mended.points[~added], tin.points), "other vertices changed"
    require_between(tin, mended, case["interval"])
    left = int(are_flat(mended).sum())
    assert f"{left:,} flat triangle" in mended.report.notes[-1], "flat triangles are not counted"
    assert left <= are_flat(tin).sum(), "more flat triangles than before"
    return "mended" if added.any() else "nothing to mend"


def trace(case: Case) -> list[Any]:
    """Return contours of the points' TIN, with some of their vertices."""
    surface = ts.triangulate(case["points"])
    contours = ts.contours(surface, interval=case["interval"])
    lines = [shapely.get_coordinates(one, include_z=True) for one in contours.to_shapely()]
    thinned = [np.vstack([line[: -1 : case["every"]], line[-1:]]) for line in lines]
    return [line for line in thinned if len(line) > 2]


def has_crossings(tin: Any) -> bool:
    """Whether lines, which were thinned, cross at vertices that no row gave."""
    return len(np.unique(tin.vertex_of)) < len(tin.points)


def are_flat(tin: Any) -> Any:
    z = tin.points[tin.triangles, 2]
    return (z == z[:, :1]).all(axis=1)


def require_between(tin: Any, mended: Any, interval: float) -> None:
    """An added point is strictly between two contours."""
    added = mended.attributes["origin"] == "added"
    levels = np.unique(tin.points[:, 2])
    z = mended.points[added, 2]
    assert not np.isin(z, levels).any(), "an added point is at a contour's elevation"
    assert ((z > levels[0] - interval) & (z < levels[-1] + interval)).all(), "beyond the next one"
    if has_crossings(tin):
        return  # contours that cross are none: between them edges that span levels may turn
    span = np.ptp(mended.points[mended.triangles, 2], axis=1).max()
    before = np.ptp(tin.points[tin.triangles, 2], axis=1).max()
    assert span <= max(before, interval) * (1 + 1e-12), "a triangle spans more than an interval"


CAMPAIGNS = (Campaign("flats", "flat triangles of contours, mended", generate, examine),)
