"""Lines of sight over hard surfaces, against every edge in fractions."""

from __future__ import annotations

import numpy as np
from support.sight_oracle import find_first_block, require_parts_as_lines

import tinsmith as ts

from .campaign import Campaign, Case
from .hydrology import generate as generate_surface


def generate(rng: np.random.Generator) -> Case:
    """A surface as of the campaign of hydrology, and heights that make lines touch."""
    case = generate_surface(rng)
    case["heights"] = rng.choice([0.0, 0.5, 1.0, 2.7], 2).tolist()
    return case


def examine(case: Case) -> str:
    """Look from the first place that has ground to the others, and to all vertices."""
    try:
        tin = ts.triangulate(case["points"], max_edge=case["max_edge"], crs="EPSG:32616")
    except ts.TinsmithError:
        return "refused: points"
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    places = low + np.array(case["starts"]) * (high - low)
    places = np.vstack([places[tin.locate(places) >= 0], tin.points[np.unique(tin.triangles), :2]])
    eye, targets = places[0], places[1:][(places[1:] != places[0]).any(axis=1)]
    above, target_above = case["heights"]
    found = ts.line_of_sight(tin, eye, targets, eye_height=above, target_height=target_above)
    for row, (start, end) in enumerate(found.coordinates.reshape(-1, 2, 3)):
        block = find_first_block(tin.points, tin.edges, start, end)
        assert found.columns["visible"][row] == (block is None), f"{start} to {end}"
    seen = ts.visible_vertices(tin, eye, eye_height=above, target_height=target_above)
    vertices = np.unique(tin.triangles)
    apart = vertices[(tin.points[vertices, :2] != eye).any(axis=1)]
    lines = found.columns["visible"][len(targets) - len(apart) :]
    assert seen[apart].tolist() == lines.tolist(), "vertices are not seen as by lines of sight"
    _require_parts(tin, eye, case)
    _require_curved(tin, eye, targets, case)
    return "sight"


def _require_curved(tin: ts.TIN, eye: np.ndarray, targets: np.ndarray, case: Case) -> None:
    """Over a curved earth, with refraction that bends as much as hills: as by plain sampling."""
    above, target_above = case["heights"]
    how = {"curvature": True, "refraction": -1.0}
    big = ts.TIN.from_triangles(
        tin.points * (1024.0, 1024.0, 1.0), tin.triangles, crs=tin.crs, elevation_unit="m"
    )
    eye, targets = 1024.0 * eye, 1024.0 * targets
    heights = {"eye_height": above, "target_height": target_above}
    found = ts.line_of_sight(big, eye, targets, **heights, **how)
    bend = 2.0 / (2.0 * 6_371_000.0)
    rounding = 1e-6 + 64 * np.spacing(np.abs(big.points[:, :2]).max()) * ts.slope(big, unit="ratio")
    for row, (start, end) in enumerate(found.coordinates.reshape(-1, 2, 3)):
        share = np.linspace(0.0, 1.0, 402)[1:-1, None]
        places = start + share * (end - start)
        square = ((end - start)[:2] ** 2).sum()
        ground = big.interpolate(places[:, :2]) + bend * square * (share * (1 - share))[:, 0]
        free = np.nanmin(places[:, 2] - ground, initial=np.inf)
        assert free >= -rounding.max() or not found.columns["visible"][row], f"{start} to {end}"


def _require_parts(tin: ts.TIN, eye: np.ndarray, case: Case) -> None:
    """From above the ground: on it, next to an edge, doubles decide otherwise than fractions."""
    above, target_above = case["heights"]
    shares = np.array([[a, b] for a, _ in case["starts"] for _, b in case["starts"]])
    low, high = tin.points[:, :2].min(axis=0), tin.points[:, :2].max(axis=0)
    require_parts_as_lines(tin, eye, low + shares * (high - low), (max(above, 0.5), target_above))


CAMPAIGNS = (Campaign("sight", "lines of sight and viewsheds", generate, examine),)
