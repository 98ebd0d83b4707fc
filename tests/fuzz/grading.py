"""Pasted and graded surfaces: sound, the patch within its boundary, slopes by their closed form."""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely
from support.surfaces import stretch_triangles

import tinsmith as ts

from .campaign import Campaign, Case

_STEPS = 4
"""Of coordinates by which a steep triangle at the seam is moved."""

_FACETS = 2e-4
"""Share of a rise by which a facet of a cone lies beside it."""


def generate(rng: np.random.Generator) -> Case:
    """A ground, and a patch in it or beyond it: on its very vertices in a lattice, or anywhere."""
    origin = [500_000.0, 4_000_000.0] if rng.random() < 0.5 else [0.0, 0.0]
    is_beyond = rng.random() < 0.4
    if rng.random() < 0.6:
        size = int(rng.integers(4, 9))
        first = rng.integers(-2, size, 2) if is_beyond else rng.integers(0, size - 2, 2)
        last = first + rng.integers(1, 4, 2)
        last = last if is_beyond else np.minimum(last, size - 1)
        base = _lattice((0, 0), (size - 1, size - 1))
        patch = _lattice(first, last)
    else:
        corners = [[0, 0], [10, 0], [10, 10], [0, 10]]
        base = np.concatenate([rng.uniform(0, 10, (40, 2)), corners])
        low, high = (-4.0, 9.0) if is_beyond else (0.2, 5.5)
        patch = rng.uniform(0, 4, (9, 2)) + rng.uniform(low, high, 2)
    return {
        "base": np.column_stack([base + origin, rng.uniform(0, 1, len(base))]).tolist(),
        "max_edge": float(rng.choice([0.0, 4.0])),
        "patch": np.column_stack([patch + origin, rng.uniform(3, 5, len(patch))]).tolist(),
        "weights": rng.dirichlet([1, 1, 1], 8).tolist(),
        "level": float(rng.uniform(-0.4, 1.4)),
        "cut": float(rng.choice([0.5, 1, 2])),
        "fill": float(rng.choice([0.5, 1, 2])),
        "places": rng.uniform(0, 1, (40, 2)).tolist(),
        "stretch": float(rng.choice([0.0, 0.0, 4.0, 0.3])),
        "holes": _draw_hole(rng, base, origin),
        "patch_holes": _draw_hole(rng, patch, origin),
    }


def _draw_hole(rng: np.random.Generator, points: Any, origin: list[float]) -> list[Any]:
    """Return rings on the lattice: none, a hole, or one with an island in it."""
    low = np.floor(points.min(axis=0)) + rng.integers(0, 4, 2) + origin
    side = int(rng.integers(1, 4))
    corners = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    rings = [(low + side * corners).tolist(), (low + (1 + corners) * side / 3).tolist()]
    return rings[: int(rng.choice([0, 0, 1, 2]))]


def _lattice(first: Any, last: Any) -> Any:
    axes = [np.arange(a, b + 1.0) for a, b in zip(first, last, strict=True)]
    return np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 2)


def examine(case: Case) -> str:
    """Paste the patch, and grade its convex hull."""
    try:
        base = ts.triangulate(case["base"], max_edge=_find_limit(case), holes=_list_holes(case))
        patch = ts.triangulate(case["patch"], holes=_list_holes(case, "patch_"))
        if case.get("stretch"):
            base, patch = (stretch_triangles(one, (1.0, case["stretch"])) for one in (base, patch))
    except ts.TinsmithError:
        return "refused: TIN"
    try:
        pasted = ts.paste(base, patch)
    except ts.PointsError as error:
        if "within the rounding" not in str(error):
            raise
        return "refused: boundaries that rounding lets cross"
    _require_sound(base, pasted, beyond=patch)
    _require_base_beyond(base, pasted, _cover(patch))
    weights = np.array(case["weights"])
    weights /= weights.sum(axis=1, keepdims=True)
    corners = patch.points[patch.triangles]
    inner = np.einsum("wk,tkd->twd", weights, corners)
    error = np.abs(
        pasted.interpolate(inner.reshape(-1, 3)[:, :2]).reshape(inner.shape[:2]) - inner[..., 2]
    )
    step = np.spacing(np.abs(base.points[:, :2]).max())  # of a place at which the seam is cut
    lost = np.isnan(error)  # in a triangle of the patch that is as thin as a rounding
    gaps = shapely.distance(_cover(pasted), shapely.points(inner[lost][:, :2]))
    assert (gaps <= _STEPS * step).all(), "a gap within the seam"
    error[lost] = 0.0
    allowed = 1e-6 + _STEPS * step * ts.slope(patch, unit="ratio")
    assert (error <= allowed[:, None]).all(), "within the seam another surface than the patch"
    return "pasted" if _grade(case, base, patch) is None else "pasted and graded"


def _find_limit(case: Case) -> float | None:
    return case["max_edge"] or None


def _list_holes(case: Case, of: str = "") -> list[Any]:
    """Return the one hole, with its island: a polygon for itself."""
    rings = [np.array(ring) for ring in case[f"{of}holes"]]
    return [rings] if rings else []


def _cover(tin: Any) -> Any:
    """Return what the triangles cover, of themselves rather than of the boundary's rings."""
    return shapely.union_all(shapely.polygons(tin.points[tin.triangles, :2]))


def _grade(case: Case, base: Any, patch: Any) -> Any:
    """Grade the hull of the patch's points, and compare with the slopes by distance."""
    pad = shapely.convex_hull(shapely.multipoints(patch.points[:, :2]))
    ring = shapely.get_coordinates(pad)[:-1]
    try:
        graded = ts.grade(base, ring, case["level"], cut_slope=case["cut"], fill_slope=case["fill"])
    except ts.PointsError:
        return None  # the ground ends before the slopes do
    _require_sound(base, graded)
    bounds = base.bounds
    xy = np.array(case["places"]) * (bounds.width, bounds.height) + (bounds.xmin, bounds.ymin)
    ground = base.interpolate(xy)
    away = shapely.distance(shapely.points(xy), pad)
    rise, drop = away / case["cut"], away / case["fill"]
    wanted = np.clip(ground, case["level"] - drop, case["level"] + rise)
    found = graded.interpolate(xy)
    slack = 1e-6 + _FACETS * np.maximum(rise, drop)
    is_slope, is_ground = np.abs(found - wanted) <= slack, np.abs(found - ground) <= 1e-6
    assert (is_slope | is_ground | np.isnan(ground)).all(), "neither the slope nor the ground"
    assert is_slope[away == 0.0].all(), "the pad is not level"
    return graded


def _require_sound(base: Any, made: Any, beyond: Any = None) -> None:
    found = ts.check(made)
    assert found.ok, [one.sentence for one in found.problems]
    wanted = _cover(base)
    if beyond is not None:
        wanted = shapely.union(wanted, _cover(beyond))
    assert abs(made.area - wanted.area) <= 1e-9 * wanted.area, "another area than both surfaces"
    far = shapely.difference(_cover(made), shapely.buffer(wanted, 1e-6))
    assert far.is_empty, "a triangle beyond both surfaces"


def _require_base_beyond(base: Any, made: Any, area: Any) -> None:
    """Triangles of the base that what was put in does not touch are what they were."""
    corners = base.points[base.triangles]
    apart = shapely.distance(shapely.polygons(corners[:, :, :2]), area) > 1e-6
    middles = corners[apart].mean(axis=1)
    slack = 1e-6 + _STEPS * np.spacing(np.abs(middles).max(initial=0.0)) * ts.slope(
        base, unit="ratio"
    )
    error = np.abs(made.interpolate(middles[:, :2]) - middles[:, 2])
    assert (error <= slack[apart]).all(), "the base is another one beyond"


def generate_balance(rng: np.random.Generator) -> Case:
    """A rough ground, a convex pad in its middle, level or inclined, and factors."""
    origin = [500_000.0, 4_000_000.0] if rng.random() < 0.5 else [0.0, 0.0]
    xy = np.concatenate([rng.uniform(0, 40, (60, 2)), [[0, 0], [40, 0], [40, 40], [0, 40]]])
    slope = rng.normal(0, 0.04, 2)
    z = xy @ slope + rng.normal(0, float(rng.choice([0.0, 0.1, 0.4])), len(xy))
    pad = 17 + 6 * rng.random((int(rng.integers(3, 7)), 2))
    return {
        "base": np.column_stack([xy + origin, z]).tolist(),
        "pad": (pad + origin).tolist(),
        "gradient": rng.normal(0, 0.05, 2).tolist() if rng.random() < 0.5 else None,
        "cut_slope": float(rng.choice([0.5, 1, 2])),
        "fill_slope": float(rng.choice([0.5, 1, 2])),
        "shrink_factor": float(rng.choice([1.0, 0.8, 1.1])),
        "surplus": float(rng.choice([0.0, 0.0, 4.0, -4.0])),
        "fixed": [_draw_fixed(rng, origin, slope) for _ in range(int(rng.choice([0, 1, 1, 2])))],
        "places": (8 + 24 * rng.random((60, 2)) + origin).tolist(),
    }


def _draw_fixed(rng: np.random.Generator, origin: list[float], slope: Any) -> list[Any]:
    """Return a convex ring near the pad: with a level near the ground's, or without elevations."""
    middle = rng.uniform(13, 27, 2)
    corners = middle + rng.uniform(0.3, 3.0) * rng.normal(size=(int(rng.integers(3, 7)), 2))
    ring = shapely.get_coordinates(shapely.convex_hull(shapely.multipoints(corners)))[:-1]
    z = np.full((len(ring), 1), middle @ slope + rng.normal(0, 0.3))
    ring = ring + origin
    return (np.hstack([ring, z]) if rng.random() < 0.4 else ring).tolist()


def examine_balance(case: Case) -> str:
    """Ask for a pad in balance, as measured again in the graded ground."""
    names = ("gradient", "cut_slope", "fill_slope", "shrink_factor", "surplus")
    try:
        base = ts.triangulate(case["base"])
        hull = shapely.convex_hull(shapely.multipoints(case["pad"]))
        ring = shapely.get_coordinates(hull)[:-1]
        regions = [np.array(one) for one in case.get("fixed", [])]
        how = {name: case[name] for name in names}
        found = ts.balance(base, ring, fixed=regions or None, **how)
    except ts.PointsError as error:
        words = {"another part": "jump", "meet, at": "fixed regions meet", "leave nothing": "fixed"}
        return "refused: " + next((w for k, w in words.items() if k in str(error)), "ground ends")
    except (ts.LinesError, ts.OptionError):
        return "refused: pad"
    _require_sound(base, found.tin)
    table = {name: float(values[0]) for name, values in found.table.columns.items()}
    again = ts.volume(base, found.tin)
    moved = table["cut"] + table["fill"]
    for name in ("cut", "fill"):
        apart = abs(float(again[name][0]) - table[name])
        assert apart <= 1e-6 * moved + 1e-6, f"{name}: off by {apart} when measured again"
    rest = table["cut"] * case["shrink_factor"] + case["surplus"] - table["fill"]
    assert abs(rest - table["balance"]) <= 1e-9 * moved + 1e-12
    assert abs(rest) <= 1e-4 * moved + 1e-6 * table["sensitivity"], f"{rest} remain"
    for region in regions:
        _require_fixed(case, base, found, region)
    label = "inclined" if case["gradient"] else "level"
    return f"{label}, fixed" if regions else label


def _require_fixed(case: Case, base: Any, found: Any, ring: Any) -> None:
    """Require the ground or the level in a region, and slopes to it."""
    graded = found.tin
    shape = shapely.Polygon(ring[:, :2])
    drawn = np.random.default_rng(0).dirichlet(np.ones(len(ring)), 20) @ ring[:, :2]
    xy = np.concatenate([drawn, case["places"]])
    away = shapely.distance(shape, shapely.points(xy))
    feet = shapely.get_coordinates(shapely.shortest_line(shapely.points(xy), shape))[1::2]
    own, new = base.interpolate(xy), graded.interpolate(xy)
    level = base.interpolate(feet) if ring.shape[1] == 2 else np.full(len(xy), ring[0, 2])
    inside = away == 0.0
    kept = own if ring.shape[1] == 2 else level
    off = np.abs(new - kept)[inside]
    assert not (off > 1e-6).any(), f"a fixed region is off by {np.nanmax(off)}"
    if len(case["fixed"]) == 1:
        pad = shapely.convex_hull(shapely.multipoints(case["pad"]))
        how = {name: case[name] for name in ("gradient", "cut_slope", "fill_slope")}
        plain = ts.grade(base, shapely.get_coordinates(pad)[:-1], found.elevation, **how)
        _require_slopes(case, plain, graded, np.stack([feet, xy], axis=1)[~inside], level[~inside])


def _require_slopes(case: Case, plain: Any, graded: Any, lines: Any, level: Any) -> None:
    """Require that slopes are made where, along a line from the region, all is beyond them."""
    shares = np.linspace(0.02, 1.0, 50)[:, None, None]
    away = np.hypot(*(lines[:, 1] - lines[:, 0]).T)
    along = lines[:, 0] + shares * (lines[:, 1] - lines[:, 0])
    found = plain.interpolate(along.reshape(-1, 2)).reshape(along.shape[:2])
    new = graded.interpolate(lines[:, 1])
    for sign, slope in ((1.0, case["cut_slope"]), (-1.0, case["fill_slope"])):
        rise = shares[:, :, 0] * away / slope
        is_beyond = ((found - level) * sign > rise + 1e-3).all(axis=0)
        off = ((new - level) * sign - away / slope)[is_beyond]
        most = away[is_beyond] / slope * _FACETS + 1e-6
        assert (np.abs(off) <= most).all(), f"a slope of a fixed region is off by {off}"


CAMPAIGNS = (
    Campaign("grading", "pasted surfaces, and pads with slopes", generate, examine),
    Campaign("balances", "pads whose cut makes their fill", generate_balance, examine_balance),
)
