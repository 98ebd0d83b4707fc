"""Campaign: fresh builds with lines and all their options, against check, order and shapely."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
import shapely
from support.point_sets import KINDS, coordinates

import tinsmith as ts
from tinsmith.base.arrays import Float64Array

from .campaign import Campaign, Case

PLAIN_KINDS = ("lattice", "utm_centimetres", "fractions", "thirds", "clustered")


# --------------------------------------------------------------------- generate


def generate(rng: np.random.Generator) -> Case:
    """Draw points and lines from one pool of places, so that they meet."""
    kind = str(rng.choice(list(KINDS)))
    pool = coordinates(rng, int(rng.integers(4, 30)), kind)
    n = int(rng.integers(0, 25)) if rng.random() < 0.9 else int(rng.integers(25, 120))
    case: Case = {
        "kind": kind,
        "points": _with_elevations(rng, _places(rng, pool, n, kind)),
        "breaklines": [_line(rng, pool, kind) for _ in range(int(rng.integers(0, 6)))],
        "boundary": _rings(rng, pool, kind, 0.25, can_have_heights=True),
        "holes": _rings(rng, pool, kind, 0.15, can_have_heights=True),
        "erase": _rings(rng, pool, kind, 0.1, can_have_heights=False),
        "water": [
            [_ring(rng, pool, kind), float(rng.integers(-5, 6))]
            for _ in range(int(rng.random() < 0.2) * int(rng.integers(1, 3)))
        ],
        "order": int(rng.integers(0, 2**31)),
    }
    return case | _options(rng, pool)


def _options(rng: np.random.Generator, pool: Float64Array) -> Case:
    extent = float(np.ptp(pool, axis=0).max()) or 1.0
    return {
        "snap": float(rng.choice([0.0, 0.0, 0.0, 1e-15, 1e-3, 0.05])) * extent,
        "max_edge": extent * float(rng.random()) if rng.random() < 0.15 else None,
        "trim": str(rng.choice(["perimeter", "everywhere"])),
        "crossing": str(rng.choice(["split"] * 9 + ["error"])),
        "duplicates": str(rng.choice(["mean"] * 6 + ["first", "last", "lowest", "error"])),
        "conforming": False,
    }


def _places(rng: np.random.Generator, pool: Float64Array, n: int, kind: str) -> Float64Array:
    fresh = coordinates(rng, n, kind) if n else np.empty((0, 2))
    return np.where(rng.random((n, 1)) < 0.5, pool[rng.integers(0, len(pool), n)], fresh)


def _with_elevations(rng: np.random.Generator, xy: Float64Array) -> list[list[float]]:
    rows: list[list[float]] = np.column_stack([xy, rng.integers(-5, 6, len(xy))]).tolist()
    return rows


def _line(rng: np.random.Generator, pool: Float64Array, kind: str) -> Case:
    xy = _places(rng, pool, int(rng.integers(2, 6)), kind)
    if rng.random() < 0.2:
        xy = np.concatenate([xy, xy[:1]])
    is_draped = rng.random() < 0.3
    return {
        "coords": xy.tolist() if is_draped else _with_elevations(rng, xy),
        "kind": str(rng.choice(["hard", "soft"])),
        "priority": int(rng.integers(0, 3)),
    }


def _ring(rng: np.random.Generator, pool: Float64Array, kind: str) -> list[list[float]]:
    """Return corners by their direction from the middle, so that most rings are simple."""
    xy = _places(rng, pool, int(rng.integers(3, 8)), kind)
    away = xy - xy.mean(axis=0)
    ring: list[list[float]] = xy[np.argsort(np.arctan2(away[:, 1], away[:, 0]))].tolist()
    return ring


def _rings(
    rng: np.random.Generator, pool: Float64Array, kind: str, share: float, *, can_have_heights: bool
) -> list[list[list[float]]]:
    count = int(rng.random() < share) * int(rng.integers(1, 3))
    rings = [_ring(rng, pool, kind) for _ in range(count)]
    if not can_have_heights:
        return rings
    return [_with_elevations(rng, np.array(ring)) if rng.random() < 0.3 else ring for ring in rings]


# ---------------------------------------------------------------------- examine


def examine(case: Case) -> str:
    """Build, check, build again in another order and with two threads, measure."""
    try:
        tin = build(case)
    except ts.TinsmithError as error:
        return f"refused: {' '.join(str(error).split()[:2])}"
    lines = [ts.Breakline(**line) for line in case["breaklines"]]
    survey = ts.Survey(
        points=_rows(case),
        breaklines=lines,
        boundary=_arrays(case["boundary"]),
        holes=_arrays(case["holes"]),
        water=[ts.Water(ring, z) for ring, z in case["water"]],
    )
    result = ts.check(tin, points=survey)
    assert result.ok, [problem.sentence for problem in result.problems]
    _require_same(tin, build(case, threads=2))
    _require_same_surface(case, tin, build(_reordered(case)))
    _require_vertices(case, tin)
    _require_area(case, tin)
    return "built"


def build(case: Case, **more: Any) -> ts.TIN:
    """Build the TIN of a case."""
    names = ("snap", "max_edge", "trim", "crossing", "duplicates", "conforming")
    return ts.triangulate(
        _rows(case),
        breaklines=[ts.Breakline(**line) for line in case["breaklines"]],
        boundary=_arrays(case["boundary"]),
        holes=_arrays(case["holes"]),
        erase=_arrays(case["erase"]),
        water=[ts.Water(ring, z) for ring, z in case["water"]],
        **{name: case[name] for name in names},
        **more,
    )


def _rows(case: Case) -> Float64Array:
    return np.array(case["points"], np.float64).reshape(-1, 3)


def _arrays(rings: list[Any]) -> list[Float64Array]:
    return [np.array(ring, np.float64) for ring in rings]


def _reordered(case: Case) -> Case:
    """Shuffle the rows, reverse the lines, and turn the rings round."""
    rng = np.random.default_rng(case["order"])
    turned = {
        name: [np.roll(ring[::-1], int(rng.integers(9)), axis=0).tolist() for ring in case[name]]
        for name in ("boundary", "holes", "erase")
    }
    lines = [line | {"coords": line["coords"][::-1]} for line in case["breaklines"]]
    order = rng.permutation(len(case["points"]))
    rows = [case["points"][i] for i in order]
    water = [[ring[::-1], z] for ring, z in case["water"]]
    return case | turned | {"points": rows, "breaklines": lines, "water": water}


def _require_same(tin: ts.TIN, other: ts.TIN) -> None:
    for name in ("points", "triangles", "neighbors", "constrained", "vertex_of"):
        same = np.array_equal(getattr(tin, name), getattr(other, name))
        assert same, f"{name} differ with two threads"
    for name in ("vertices", "offsets", "sources"):
        assert np.array_equal(getattr(tin.lines, name), getattr(other.lines, name)), name


def _require_same_surface(case: Case, tin: ts.TIN, other: ts.TIN) -> None:
    """Compare coordinates; elevations only where the order of the rows has no say in them."""
    columns = 2 if case["duplicates"] in ("first", "last") else 3
    assert faces(tin, columns) == faces(other, columns), "another order, another TIN"


def faces(tin: ts.TIN, columns: int) -> Counter[frozenset[tuple[float, ...]]]:
    """Return the triangles as sets of coordinates."""
    corners = tin.points[tin.triangles, :columns].tolist()
    return Counter(frozenset(tuple(corner) for corner in corners_) for corners_ in corners)


def _is_whole(case: Case) -> bool:
    return not (case["boundary"] or case["holes"] or case["max_edge"])


def _require_vertices(case: Case, tin: ts.TIN) -> None:
    """Every given vertex of every line with elevations is a vertex, where nothing is cut away."""
    if not _is_whole(case) or case["snap"] or case["water"]:
        return
    there = set(map(tuple, tin.points[:, :2].tolist()))
    for line in case["breaklines"]:
        if len(line["coords"][0]) == 3:
            lost = [v for v in line["coords"] if (v[0] + 0.0, v[1] + 0.0) not in there]
            assert not lost, f"vertices of a line are no vertices: {lost}"


def _require_area(case: Case, tin: ts.TIN) -> None:
    """Compare the area with that of shapely, at ordinary coordinates."""
    if case["kind"] not in PLAIN_KINDS or case["snap"] or case["erase"] or case["max_edge"]:
        return
    laid = [v[:2] for line in case["breaklines"] for v in line["coords"] if len(v) == 3]
    for name in ("boundary", "holes"):
        laid += [v[:2] for ring in case[name] for v in ring if len(v) == 3]
    laid += [v for ring, _ in case["water"] for v in ring]
    laid += [v[:2] for v in case["points"]]
    expected = shapely.MultiPoint(laid).convex_hull
    if case["boundary"]:
        inside = shapely.Polygon()
        for ring in case["boundary"]:
            inside = inside.symmetric_difference(_polygon(ring))
        expected = expected.intersection(inside)
    for ring in case["holes"]:
        expected = expected.difference(_polygon(ring))
    size = np.abs(np.array(laid)).max()
    slack = 1e-9 * size * (expected.length + 1.0)
    assert abs(tin.area - expected.area) <= slack, f"area {tin.area}, shapely {expected.area}"


def _polygon(ring: list[list[float]]) -> shapely.Geometry:
    return shapely.make_valid(shapely.Polygon(np.array(ring)[:, :2]))


CAMPAIGNS = (
    Campaign(
        "lines", "builds with lines and all options, against check and shapely", generate, examine
    ),
)
