"""Campaign: points alone, against brute force, every engine, a second order, duplicates, snap."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

import numpy as np
from support import oracles
from support.point_sets import points

import tinsmith as ts
from tinsmith.tin import _kernel

from .campaign import Campaign, Case

POLICIES = ("first", "last", "mean", "lowest", "highest")
SMALL = 14  # brute force looks at n^4 in exact fractions


def generate(rng: np.random.Generator) -> Case:
    n = int(rng.integers(3, SMALL)) if rng.random() < 0.8 else int(rng.integers(SMALL, 300))
    return {
        "points": points(rng, n),
        "duplicates": str(rng.choice([*POLICIES, "error"])),
        "snap": float(rng.choice([0.0, 0.0, 0.01, 1.0])),
        "threads": int(rng.integers(1, 5)),
        "order": rng.permutation(n).tolist(),
    }


def examine(case: Case) -> str:
    xyz = np.array(case["points"], np.float64).reshape(-1, 3)
    options: dict[str, Any] = {"duplicates": case["duplicates"], "snap": case["snap"]}
    try:
        tin = ts.triangulate(xyz, **options)
    except ts.PointsError as error:
        return _examine_refusal(xyz, error, **options)
    ts.check(tin, points=xyz).raise_if_failed()
    _require_same(tin, ts.triangulate(xyz, **options, threads=case["threads"]))
    _examine_engines(tin.points, case["threads"])
    if not case["snap"]:
        _examine_elevations(tin, xyz, case["duplicates"])
        _examine_order(tin, xyz, case)
    if len(tin.points) <= SMALL:
        assert oracles.canonical(tin.triangles) == oracles.delaunay(tin.points), "not Delaunay"
    return "built"


def _examine_refusal(xyz: np.ndarray, error: Exception, *, duplicates: str, snap: float) -> str:
    if len({tuple(row) for row in xyz[:, :2].tolist()}) < len(xyz) and duplicates == "error":
        return "refused: duplicates"
    if snap and duplicates == "error" and "collinear" not in str(error):
        gaps = xyz[:, None, :2] - xyz[None, :, :2]
        near = np.hypot(gaps[..., 0], gaps[..., 1]) <= snap * (1 + 1e-9)
        assert near.sum() > len(xyz), f"no two points are that near: {error}"
        return "refused: snapped"
    sizes = np.abs(xyz[:, :2][xyz[:, :2] != 0])
    if "exact range" in str(error) and (sizes.min() < 6e-61 or sizes.max() > 2e75):
        return "refused: range"
    places = sorted({oracles.place(p) for p in xyz})
    turns = (oracles.orientation(places[0], places[-1], p) for p in places)
    assert snap or not any(turns), f"refused, though not all points are collinear: {error}"
    return "refused: collinear"


def _require_same(tin: ts.TIN, other: ts.TIN) -> None:
    for name in ("points", "triangles", "neighbors", "constrained", "vertex_of"):
        assert np.array_equal(getattr(tin, name), getattr(other, name)), f"{name} differ"


def _examine_engines(points: np.ndarray, threads: int) -> None:
    """Every way to build gives the same arrays; rasters have one of their own."""
    wanted = _kernel.grow(points, method=_kernel.Method.INSERTION)
    for method in _kernel.Method:
        for count in (1, threads):
            found = _kernel.grow(points, method=method, threads=count)
            for name in ("triangles", "neighbors"):
                same = np.array_equal(getattr(found, name), getattr(wanted, name))
                assert same, f"{name} of {method} in {count} threads differ"


def _examine_elevations(tin: ts.TIN, xyz: np.ndarray, policy: str) -> None:
    """Every row is at its vertex, and every vertex has the elevation that the policy says."""
    assert np.array_equal(tin.points[tin.vertex_of, :2], xyz[:, :2]), "a row is not at its vertex"
    groups: dict[tuple[float, float], list[float]] = defaultdict(list)
    for x, y, z in xyz.tolist():
        groups[x, y].append(z)
    assert len(groups) == len(tin.points), "places and vertices differ in number"
    choose = {"first": lambda z: z[0], "last": lambda z: z[-1], "lowest": min, "highest": max}
    for x, y, z in tin.points.tolist():
        at = groups[x, y]
        if policy in choose:
            assert z == choose[policy](at), f"{policy} of {at} is not {z}"
        else:
            assert min(at) <= z <= max(at), f"{policy} of {at} is not {z}"
            assert abs(z - sum(at) / len(at)) <= 1e-9 * max(1.0, abs(z)), f"mean of {at}: {z}"


def _examine_order(tin: ts.TIN, xyz: np.ndarray, case: Case) -> None:
    """The triangles as sets of coordinates are the same in any order of rows."""
    order = np.array([i for i in case["order"] if i < len(xyz)], int)
    if len(order) < len(xyz):
        return
    other = ts.triangulate(xyz[order], duplicates=case["duplicates"])
    assert _faces(tin) == _faces(other), "another order of rows, another TIN"


def _faces(tin: ts.TIN) -> set[frozenset[tuple[float, float]]]:
    corners = tin.points[tin.triangles, :2].tolist()
    return {frozenset((x, y) for x, y in triangle) for triangle in corners}


CAMPAIGNS = (Campaign("points", "points alone, against brute force", generate, examine),)
