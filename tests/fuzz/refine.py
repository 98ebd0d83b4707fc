"""Refinements of small TINs: sound, good, as large as asked for, and honest about what is left."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from .campaign import Campaign, Case
from .linework import surface, triangulate

MOST_VERTICES = 3000


def generate(rng: np.random.Generator) -> Case:
    """A TIN with lines, a boundary or holes, and what its triangles shall be."""
    case = surface(rng, most=13)
    xy = np.array(case["points"])[:, :2]
    case["min_angle"] = float(rng.choice([0, 15, 20, 25, 30, 33]))
    size = float(np.ptp(xy, axis=0).max())
    if rng.random() < 0.4:
        case["max_area"] = max(size * size, 1e-300) * float(rng.choice([0.3, 0.05]))
    if rng.random() < 0.3:
        case["max_edge"] = max(size, 1e-150) * float(rng.choice([0.7, 0.2]))
    return case


def examine(case: Case) -> str:
    """Refine, and ask for a sound mesh that keeps what it promises."""
    tin = triangulate(case)
    if isinstance(tin, str):
        return tin
    limits = {name: case[name] for name in ("min_angle", "max_area", "max_edge") if name in case}
    try:
        mesh = ts.tin.refine(tin, **limits, max_vertices=MOST_VERTICES)
    except ts.TinsmithError as error:
        return "refused: " + ("vertices" if "vertices" in str(error) else "too near")
    found = ts.check(mesh)
    assert found.ok, [one.sentence for one in found.problems]
    require_goal(mesh, **limits)
    require_kept(tin, mesh)
    return "refined" if len(mesh.report.unmended.triangles) == 0 else "refined in part"


def require_goal(
    mesh: Any, *, min_angle: float, max_area: float = np.inf, max_edge: float = np.inf
) -> None:
    """Each triangle that misses the goal is told, and no other."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        shapes = ts.tin.quality(mesh)
        areas = mesh.triangle_areas
    longest = shapes.edge_lengths.max(axis=1)
    told = np.zeros(len(areas), bool)
    told[mesh.report.unmended.triangles] = True
    misses = (areas > max_area * (1 + 1e-9)) | (longest > max_edge * (1 + 1e-9))
    small = shapes.min_angle < min_angle - 1e-6
    assert not ((misses | small) & ~told).any(), "a triangle misses the goal and is not told"
    hardly = (areas < max_area * (1 - 1e-6)) & (longest < max_edge * (1 - 1e-6))
    slack = 1e-4 + rounding_of_angles(mesh, shapes)
    well = hardly & (shapes.min_angle > min_angle + slack)
    assert not (told & well).any(), "a good triangle is told as bad"


def rounding_of_angles(mesh: Any, shapes: Any) -> Float64Array:
    """Return how much the rounding of coordinates may turn the angles, degrees."""
    rounding = np.spacing(np.abs(mesh.points[:, :2]).max())
    shortest = shapes.edge_lengths.min(axis=1)
    return np.degrees(np.minimum(4 * rounding / np.maximum(shortest, 1e-300), 4.0))


def require_kept(tin: Any, mesh: Any) -> None:
    """Vertices stay, lines pass through theirs in order, the boundary keeps the area."""
    assert np.array_equal(mesh.points[: len(tin.points)], tin.points), "vertices moved"
    n = len(tin.points)
    for before, after in zip(tin.lines.chains(), mesh.lines.chains(), strict=False):
        kept = [v for v in after.tolist() if v < n]
        assert kept == before.tolist(), "a line left its vertices"
    size = np.abs(tin.points[:, :2]).max()
    rim = sum(
        float(np.hypot(*np.diff(tin.points[[*ring, ring[0]], :2], axis=0).T).sum())
        for ring in tin.rings
    )
    assert abs(mesh.area - tin.area) <= 8 * np.spacing(size) * rim + 1e-9 * tin.area, "area"


CAMPAIGNS = (
    Campaign("refine", "refinements of small TINs with lines and limits", generate, examine),
)
