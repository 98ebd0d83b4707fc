"""Data that make products slow: waters over each other, pads with notches, clusters far apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
import shapely.affinity
from support.water_oracle import leave_out_one_by_one

import tinsmith as ts
from tinsmith.terrain.earthwork.grading.distances import measure_distances
from tinsmith.tin.building import constrained, water

from .campaign import Campaign, Case

_FACET = 1.7e-4
"""Share of a distance by which a facet of a cone lies beside it."""


def generate_water(rng: np.random.Generator) -> Case:
    """Points, and waters over and in each other, perhaps on a lattice, lines and a boundary."""
    on_lattice = rng.random() < 0.5

    def draw(count: int, around: Any = 0.0, size: float = 20.0) -> Any:
        places = rng.random((count, 2)) * size + around
        return np.floor(places) if on_lattice else places

    def draw_ring() -> Any:
        count = int(rng.integers(3, 9))
        angle = np.sort(rng.random(count)) * 2 * np.pi
        radius = rng.uniform(1.0, 8.0) * rng.uniform(0.3, 1.0, (count, 1))
        ring = draw(1) + np.column_stack([np.cos(angle), np.sin(angle)]) * radius
        return np.round(ring) if on_lattice else ring

    middle, square = draw(1), np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    rings = [draw_ring() for _ in range(int(rng.integers(1, 8)))]
    rings += [middle + size * square for size in range(1, int(rng.integers(1, 6)))]
    boundary = [[[1, 1], [18, 2], [19, 17], [3, 19]]]
    return {
        "points": np.column_stack([draw(60), rng.random(60)]).tolist(),
        "water": [[ring.tolist(), float(rng.integers(0, 3))] for ring in rings],
        "breaklines": [
            np.column_stack([draw(3), np.ones(3)]).tolist() for _ in range(int(rng.integers(0, 4)))
        ],
        "boundary": boundary[: int(rng.integers(0, 2))],
        "snap": float(rng.choice([0.0, 0.0, 0.5])),
    }


def examine_water(case: Case) -> str:
    """Leave out water at once, and one after the other."""
    corners = [[-9.0, -9, 0], [40, -9, 0], [40, 40, 1], [-9, 40, 0]]

    def compare(points: Any, polylines: Any, lines: Any, overruled: Any, *, threads: int) -> Any:
        own = points.copy()
        expected = leave_out_one_by_one(own, polylines, lines, overruled)
        found = water.leave_out_water(points, polylines, lines, overruled, threads=threads)
        np.testing.assert_array_equal(points, own)
        np.testing.assert_array_equal(found[1], expected[1])
        for name in ("vertices", "offsets", "lines"):
            np.testing.assert_array_equal(getattr(found[0], name), getattr(expected[0], name))
        for name in ("vertices", "lines", "elevations", "vertex_elevations"):
            np.testing.assert_array_equal(getattr(found[2], name), getattr(expected[2], name))
        return found

    kept = constrained.leave_out_water
    constrained.leave_out_water = compare
    try:
        ts.triangulate(
            case["points"] + corners,
            water=[ts.Water(np.array(ring), level) for ring, level in case["water"]],
            breaklines=[np.array(line) for line in case["breaklines"]],
            boundary=[np.array(ring) for ring in case["boundary"]],
            snap=case["snap"],
        )
    except ts.TinsmithError:
        return "refused"
    finally:
        constrained.leave_out_water = kept
    return "same"


def generate_pad(rng: np.random.Generator) -> Case:
    """A pad: boxes, turned ones, a star, a sawtooth, or a disc with a bay."""
    kind = int(rng.integers(5))
    if kind < 2:
        sizes = rng.random((int(rng.integers(2, 9)), 4)) * 9 + 1
        sizes = np.floor(sizes) if kind == 0 else sizes
        boxes = [shapely.box(x, y, x + w, y + h) for x, y, w, h in sizes]
        turns = rng.random(len(boxes)) * 360 * kind
        pad = shapely.union_all(
            [shapely.affinity.rotate(box, turn) for box, turn in zip(boxes, turns, strict=True)]
        )
    elif kind == 2:
        angle = np.sort(rng.random(int(rng.integers(5, 40)))) * 2 * np.pi
        radius = rng.uniform(2, 20, (len(angle), 1))
        pad = shapely.Polygon(np.column_stack([np.cos(angle), np.sin(angle)]) * radius)
    elif kind == 3:
        count = int(rng.integers(4, 60))
        teeth = np.where(np.arange(count) % 2, rng.uniform(0, 5), 0.0) + 5
        path = np.column_stack([np.linspace(0, 20, count), teeth])
        pad = shapely.Polygon([*path, (20, -5), (0, -5)])
    else:
        bay = shapely.Point(rng.uniform(0, 4), 3).buffer(rng.uniform(0.3, 3), quad_segs=5)
        pad = shapely.Point(0, 0).buffer(5, quad_segs=int(rng.integers(1, 30))).difference(bay)
    pad = max(shapely.get_parts(pad), key=shapely.area)
    shift = [(0.0, 0.0), (500_000.0, 4_000_000.0)][int(rng.integers(2))]
    return {
        "ring": (shapely.get_coordinates(pad.exterior)[:-1] + shift).tolist(),
        "reach": float(rng.choice([0.3, 1.0, 3.0, 10.0, 60.0])),
        "shares": rng.random((500, 2)).tolist(),
    }


def examine_pad(case: Case) -> str:
    """Compare the surface of distances with those that GEOS measures."""
    pad = shapely.orient_polygons(shapely.Polygon(case["ring"]))
    if not pad.is_valid or len(case["ring"]) < 3 or pad.area < 1e-6:
        return "no pad"
    reach = case["reach"]
    tolerance = float(64 * np.spacing(np.abs(case["ring"]).max()))
    surface = measure_distances(pad, reach, tolerance)
    assert ts.check(surface).ok
    low, high = surface.points[:, :2].min(axis=0), surface.points[:, :2].max(axis=0)
    places = low + np.array(case["shares"]) * (high - low)
    away = shapely.distance(pad, shapely.points(places))
    found = surface.interpolate(places)
    is_made = ~np.isnan(found)
    is_beside = (away > 10 * tolerance) & (away < reach * (1 - 2 * _FACET))
    assert is_made[is_beside].all(), "a place within the reach is left out"
    assert not is_made[away > reach * (1 + 1e-6) + tolerance].any(), "a place beyond it is made"
    off = np.abs(found - away)[is_made & (away > 0)]
    most = _FACET * away[is_made & (away > 0)] + 2e-6 * reach + 4 * tolerance
    assert (off <= most).all(), f"off by {float((off - most).max())}"
    return "measured"


def generate_clusters(rng: np.random.Generator) -> Case:
    """Two clusters of points, far apart for their size."""
    cluster = rng.random((int(rng.integers(20, 80)), 2))
    z = rng.random(len(cluster))
    shift = 10.0 ** rng.uniform(0, 6) * np.array([1.0, rng.choice([0.0, 1.0, 0.3])])
    points = np.column_stack([cluster, z])
    return {
        "points": np.vstack([points, points + np.append(shift, 0.0)]).tolist(),
        "smooth": float(rng.choice([0.0, 0.05, 0.2])),
        "simplify": float(rng.choice([0.05, 0.2])),
    }


def examine_clusters(case: Case) -> str:
    """Prove that smoothed and simplified contours stay apart, and near their level."""
    try:
        tin = ts.triangulate(case["points"])
    except ts.TinsmithError:
        return "refused: points"
    lines = ts.contours(tin, interval=0.1, smooth=case["smooth"] or None, simplify=case["simplify"])
    found = ts.check_contours(tin, lines)
    assert found.is_apart, f"{found.contacts} contacts, first of lines {found.lines}"
    allowed = case["smooth"] + case["simplify"]
    rounding = float(np.spacing(np.abs(tin.points).max()))
    assert found.deviation <= allowed + 1e6 * rounding, f"off by {found.deviation}"
    return "apart"


CAMPAIGNS = (
    Campaign("water", "waters over and in each other", generate_water, examine_water),
    Campaign("pads", "distances around pads with notches", generate_pad, examine_pad),
    Campaign("clusters", "smoothed contours of clusters", generate_clusters, examine_clusters),
)
