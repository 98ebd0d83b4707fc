"""Voronoi cells of a few points against the same cells in fractions."""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from shapely.geometry import Point, Polygon
from support.point_sets import points

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from .campaign import Campaign, Case

Place = tuple[Fraction, Fraction]


def generate(rng: np.random.Generator) -> Case:
    """Three to twelve points, and a boundary: the bounds, padded or not, or a ring."""
    case: Case = {"points": points(rng, int(rng.integers(3, 13)))}
    if rng.random() < 0.4:
        case["pad"] = float(rng.choice([0.0, 0.1, 1.0, 1e3]))
    elif rng.random() < 0.4:
        case["ring"] = ring_about(rng, np.array(case["points"])[:, :2])
    return case


def ring_about(rng: np.random.Generator, xy: Float64Array) -> list[list[float]]:
    """Return a star of corners about the middle of the points, most of them convex."""
    low, high = xy.min(axis=0), xy.max(axis=0)
    angles = np.sort(rng.random(int(rng.integers(3, 9)))) * 2 * np.pi
    reach = rng.choice([0.3, 0.6, 1.5]) * (1.0 - rng.choice([0.0, 0.6]) * rng.random(len(angles)))
    way = np.column_stack([np.cos(angles), np.sin(angles)]) * reach[:, None]
    corners: list[list[float]] = ((low + high) / 2 + way * (high - low).max()).tolist()
    return corners


def examine(case: Case) -> str:
    """Ask for cells that tile the boundary and are the true ones but for rounding."""
    try:
        tin = ts.triangulate(case["points"])
    except ts.TinsmithError:
        return "refused: points"
    if "ring" in case:
        return examine_ring(tin, case["ring"])
    diagram = tin.voronoi(pad=case.get("pad"))
    require_tiling(diagram)
    require_truth(diagram, tin.points[:, :2])
    return "box"


def examine_ring(tin: Any, ring: list[list[float]]) -> str:
    """Ask for parts that tile the ring."""
    try:
        diagram = tin.voronoi(boundary=ring)
    except ts.TinsmithError:
        assert not Polygon(ring).is_valid, "a sound ring was refused"
        return "refused: ring"
    area = exact_area(list(map(exactly, diagram.boundary.tolist())))
    rounding = rounding_of(diagram) * length_of(diagram.boundary)
    assert abs(Fraction(float(diagram.areas.sum())) - area) <= rounding, "areas"
    assert (diagram.areas >= 0).all()
    return "ring"


def require_tiling(diagram: Any) -> None:
    """Each side is walked once each way by two cells, or once, along the boundary."""
    area = exact_area(list(map(exactly, diagram.boundary.tolist())))
    found = Fraction(float(diagram.areas.sum()))
    assert abs(found - area) <= area * Fraction(2) ** -40, f"{float(found)} of {float(area)}"
    assert (diagram.areas >= 0).all(), "negative areas"
    walks = Counter(side for ring in rings(diagram) for side in pairwise([*ring, *ring[:1]]))
    xmin, ymin = diagram.boundary.min(axis=0)
    xmax, ymax = diagram.boundary.max(axis=0)
    for (a, b), times in walks.items():
        on_wall = (a[0] == b[0] and a[0] in (xmin, xmax)) or (a[1] == b[1] and a[1] in (ymin, ymax))
        assert on_wall or walks[b, a] == times, f"the side from {a} to {b} is not shared"


def require_truth(diagram: Any, xy: Float64Array) -> None:
    """Each cell is the exact one but for roundings, and holds its vertex."""
    exact = exact_cells(list(map(exactly, xy.tolist())), diagram.boundary)
    rounding = float(rounding_of(diagram))
    slack = rounding * length_of(diagram.boundary)
    for ring, truth, area, (x, y) in zip(
        rings(diagram), exact, diagram.areas.tolist(), xy.tolist(), strict=True
    ):
        assert abs(area - float(exact_area(truth))) <= slack, "an area"
        for a in ring:
            apart = min(max(abs(a[0] - float(b)), abs(a[1] - float(c))) for b, c in truth)
            assert apart <= rounding, f"the corner {a} is {apart} from an exact one"
        if ring:
            shape = Polygon(ring)
            assert shape.distance(Point(x, y)) <= rounding, "the vertex is outside"
            lost = shape.convex_hull.area - shape.area
            assert lost <= slack, "not convex"


def rings(diagram: Any) -> list[list[tuple[float, float]]]:
    coords = list(map(tuple, diagram.coords.tolist()))
    ends = diagram.offsets.tolist()
    return [coords[begin:end] for begin, end in pairwise(ends)]


def rounding_of(diagram: Any) -> Fraction:
    return 8 * Fraction(float(np.spacing(np.abs(diagram.boundary).max())))


def length_of(ring: Float64Array) -> float:
    return float(np.hypot(*(np.roll(ring, -1, axis=0) - ring).T).sum())


def exactly(place: list[float]) -> Place:
    return Fraction(place[0]), Fraction(place[1])


def exact_area(ring: list[Place]) -> Fraction:
    doubled = sum((a[0] * b[1] - b[0] * a[1] for a, b in pairwise([*ring, ring[0]])), Fraction(0))
    return doubled / 2


def exact_cells(places: list[Place], boundary: Float64Array) -> list[list[Place]]:
    """Cut the boundary by the bisectors with all other places."""
    cells = []
    for p in places:
        cell = list(map(exactly, boundary.tolist()))
        for q in places:
            if q != p:
                cell = cut(cell, p, q)
        cells.append([one for one, next_ in pairwise([*cell, cell[0]]) if one != next_])
    return cells


def cut(cell: list[Place], p: Place, q: Place) -> list[Place]:
    """Keep what is no nearer to q than to p."""

    def excess(place: Place) -> Fraction:
        x, y = place
        return 2 * ((q[0] - p[0]) * x + (q[1] - p[1]) * y) - (
            q[0] ** 2 + q[1] ** 2 - p[0] ** 2 - p[1] ** 2
        )

    kept = []
    for a, b in pairwise([*cell, cell[0]]):
        at_a, at_b = excess(a), excess(b)
        if at_a <= 0:
            kept.append(a)
        if at_a * at_b < 0:
            share = at_a / (at_a - at_b)
            kept.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
    return kept


CAMPAIGNS = (Campaign("voronoi", "cells against half-planes cut in fractions", generate, examine),)
