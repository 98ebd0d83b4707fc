"""Campaign: squares of a surface at several scales fit, cover it once and err as they say."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import tinsmith as ts
from tinsmith.terrain.simplification.pyramid import (
    Mesh,
    Node,
    Quadtree,
    find_tolerance,
    join_nodes,
    make_finest,
    simplify,
)
from tinsmith.tiled.products.simplified import SquareJoiner

from .campaign import Campaign, Case

_MOST_POINTS = 400


def generate(rng: np.random.Generator) -> Case:
    """Points at random, in centimetres, on a lattice or in clusters, and how they are divided."""
    count = int(rng.integers(4, _MOST_POINTS))
    kind = int(rng.integers(0, 4))
    if kind == 0:
        xy = rng.random((count, 2)) * rng.uniform(1, 500, 2)
    elif kind == 1:
        xy = np.round(rng.random((count, 2)) * rng.uniform(5, 500, 2), 2)
    elif kind == 2:
        xy = rng.integers(0, 20, (count, 2)) * float(rng.choice([1.0, 0.1, 16.0]))
    else:
        xy = np.concatenate([rng.normal(0, 1, (count, 2)), rng.normal(50, 20, (count, 2))])
    xy = xy + float(rng.choice([0.0, 1e3, 5e5]))
    z = rng.normal(0, float(rng.choice([0.01, 1.0, 30.0])), len(xy))
    return {
        "points": np.column_stack([xy, z]).tolist(),
        "node_points": int(rng.choice([16, 50, 200])),
        "tolerance": float(rng.choice([0.0, 0.1])),
    }


def examine(case: Case) -> str:
    """Make all levels, from the finest on."""
    points = np.array(case["points"], np.float64).reshape(-1, 3)
    try:
        tin = ts.triangulate(points, duplicates="first")
    except ts.PointsError:
        return "refused"
    tree = Quadtree.over(tin.bounds, len(tin.points), case["node_points"])
    found = (
        (node, make_finest(tin.points, tin.triangles, tree.find_box(node), case["tolerance"]))
        for x, y in np.ndindex(1 << tree.levels, 1 << tree.levels)
        for node in [Node(tree.levels, x, y)]
    )
    level = {node: mesh for node, mesh in found if mesh is not None}
    _require_joined(tree, level, tin, case["tolerance"])
    for height in range(1, tree.levels + 1):
        _require_fit(level.values(), tin)
        within = find_tolerance(height, tree.side, case["tolerance"])
        level = {
            parent: simplify(
                join_nodes([level[child] for child in parent.children if child in level]),
                tree.find_box(parent),
                within,
            )
            for parent in sorted({node.parent for node in level})
        }
    _require_fit(level.values(), tin)
    (mesh,) = level.values()
    rough = ts.TIN.from_triangles(mesh.points, mesh.triangles)
    box = tin.bounds
    places = np.random.default_rng(1).random((300, 2)) * [box.width, box.height]
    places = np.concatenate([places + np.array([box.xmin, box.ymin]), tin.points[:, :2]])
    away = np.abs(rough.interpolate(places) - tin.interpolate(places))
    assert np.nanmax(away, initial=0.0) <= mesh.error + _find_slack(tin)
    return f"{tree.levels} levels"


def _require_joined(tree, level, tin, tolerance):
    """Require all squares of the finest level as one mesh, within the tolerance at each point."""
    with TemporaryDirectory() as folder:
        joiner = SquareJoiner(Path(folder), tree)
        for node in sorted(level, key=lambda one: (one.y, one.x)):
            joiner.add(node, level[node])
        joiner.close()
        points, triangles = (
            np.fromfile(*one) for one in zip(joiner.paths, ("<f8", "<i4"), strict=True)
        )
    points, triangles = points.reshape(-1, 3), triangles.reshape(-1, 3)
    assert [len(points), len(triangles)] == joiner.counts
    assert len(np.unique(points[:, :2], axis=0)) == len(points)
    _require_fit([Mesh(points, triangles)], tin)
    found = ts.TIN.from_triangles(points, triangles).interpolate(tin.points[:, :2])
    away = np.abs(found - tin.points[:, 2])
    assert np.nanmax(away, initial=0.0) <= tolerance + _find_slack(tin)


def _find_slack(tin):
    """Return what rounding of coordinates may change, on steep triangles too."""
    return 1e-6 * max(1.0, np.abs(tin.points).max() / 1e3)


def _require_fit(meshes, tin):
    """Require each edge once in each direction, and the area of the surface."""
    edges: Counter = Counter()
    area = 0.0
    for mesh in meshes:
        places = list(map(tuple, mesh.points.tolist()))
        for corners in mesh.triangles.tolist():
            for k in range(3):
                edges[places[corners[k - 1]], places[corners[k]]] += 1
        a, b, c = ((mesh.points - mesh.points[0])[mesh.triangles[:, k], :2] for k in range(3))
        u, v = b - a, c - a
        area += float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum()) / 2
    assert max(edges.values()) == 1
    balance: Counter = Counter()
    for start, end in edges:
        if (end, start) not in edges:
            balance[start] += 1
            balance[end] -= 1
    assert not any(balance.values()), "the rim is not closed"
    assert abs(area - tin.area) <= _find_slack(tin) * max(1.0, tin.area * 1e-3)


CAMPAIGNS = (Campaign("pyramids", "squares of surfaces at scales", generate, examine),)
