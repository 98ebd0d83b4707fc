"""Walls: two breaklines along one line, or a line with columns, apart by the distance."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import shapely

import tinsmith as ts

from .campaign import Campaign, Case

_REFUSED = {
    "sharp": "turns too sharply",
    "side": "do not tell on which side",
    "points": "three",
}
"""What may be refused, and the sentences."""


def generate(rng: np.random.Generator) -> Case:
    """A bent line between two rough grounds, with an upper and a lower elevation."""
    origin = [500_000.0, 4_000_000.0] if rng.random() < 0.5 else [0.0, 0.0]
    count = int(rng.integers(2, 9))
    if rng.random() < 0.4:
        angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, max(count, 3)))
        path = rng.uniform(10, 30, len(angles))[:, None] * np.column_stack(
            [np.cos(angles), np.sin(angles)]
        )
        path = np.vstack([path, path[:1]])
    else:
        turns = np.cumsum(rng.normal(0, 0.5, count - 1))
        steps = rng.uniform(0.5, 12, count - 1)[:, None]
        path = np.vstack(
            [[0, 0], np.cumsum(steps * np.column_stack([np.cos(turns), np.sin(turns)]), axis=0)]
        )
    if rng.random() < 0.2:
        path = np.round(path)
    is_new = np.append(True, (np.diff(path, axis=0) != 0).any(axis=1))
    path = path[is_new]
    if len(path) < 2:
        path = np.array([[0.0, 0.0], [5.0, 1.0]])
    low, high = path.min(axis=0) - 15, path.max(axis=0) + 15
    height = float(rng.uniform(0.1, 5))
    rise = rng.choice([height, 0.0], len(path), p=[0.8, 0.2])
    if (path[0] == path[-1]).all():
        rise[-1] = rise[0]
    rise[int(rng.integers(len(path)))] = height
    if (path[0] == path[-1]).all():
        rise[[0, -1]] = height
    return {
        "path": (path + origin).tolist(),
        "points": (rng.uniform(low, high, (int(rng.integers(40, 200)), 2)) + origin).tolist(),
        "rough": rng.normal(0, float(rng.choice([0.0, 0.05])), 200).tolist(),
        "base": float(rng.uniform(-5, 300)),
        "rise": rise.tolist(),
        "walls": float(rng.choice([0.001, 0.01, 0.2])),
        "left": bool(rng.random() < 0.5),
        "turned": bool(rng.random() < 0.5),
        "first": bool(rng.random() < 0.5),
        "columns": _draw_columns(rng),
    }


def _draw_columns(rng: np.random.Generator) -> list[str]:
    """Names of columns that give the elevations of the wall; none for two breaklines."""
    drawn = [[], ["top", "foot"], ["top", "bottom"], ["top"], ["foot"], ["bottom"], ["Top", "FOOT"]]
    return list(drawn[int(rng.integers(len(drawn)))]) if rng.random() < 0.5 else []


def examine(case: Case) -> str:
    """Build the surface, and look for both lines, and for the elevations on both sides."""
    path, xy = np.array(case["path"]), np.array(case["points"])
    is_ring = bool((path[0] == path[-1]).all())
    is_left = _lie_left(path, xy, is_ring)
    kept = shapely.distance(shapely.LineString(path), shapely.points(xy)) > 1.0
    high = max(case["rise"])
    z = case["base"] + np.where(is_left == case["left"], high, 0.0)
    ground = np.column_stack([xy, z + np.array(case["rough"])[: len(xy)]])[kept]
    top = np.column_stack([path, case["base"] + np.array(case["rise"])])
    foot = np.column_stack([path, np.full(len(path), case["base"])])
    lines = [
        ts.Breakline(top, name="top"),
        ts.Breakline(foot[::-1] if case["turned"] else foot, name="foot"),
    ]
    if case["columns"]:
        lines = _read_columns(case, top, foot)
        if isinstance(lines, str):
            return lines
    try:
        made = ts.triangulate(
            ground, breaklines=lines if case["first"] else lines[::-1], walls=case["walls"]
        )
    except (ts.LinesError, ts.PointsError) as error:
        known = [word for word, sentence in _REFUSED.items() if sentence in str(error)]
        if not known:
            raise
        return f"refused: {known[0]}"
    assert ts.check(made).ok
    assert any(note.startswith("1 wall: ") for note in made.report.notes)
    _require_apart(case, made, path)
    told = _require_side(case, made, path)
    return "ring" if is_ring else told


def _read_columns(case: Case, top: Any, foot: Any) -> Any:
    """Return the breaklines of a file whose line has columns, or what is refused, rightly.

    A column gives one elevation of the whole line: what is not in a column is that of the line.
    """
    level = {"top": float(top[:, 2].max()), "foot": case["base"], "bottom": case["base"]}
    names = [name.lower() for name in case["columns"]]
    coords = {("top",): foot, ("foot",): top, ("bottom",): top}.get(tuple(names), top[:, :2])
    given = {name: np.array([level[name.lower()]]) for name in case["columns"]}
    line = ts.Features.of_lines(coords, [0, len(coords)], columns={**given, "name": ["top"]})
    with TemporaryDirectory() as folder:
        path = ts.write(line, Path(folder) / "wall.gpkg")
        found = ts.read_lines(path, walls=True)
    assert len(found) == 2, found
    upper, lower = (np.asarray(one.coords) for one in found)
    whole = np.column_stack([top[:, :2], np.full(len(top), level["top"])])
    assert np.array_equal(upper, whole if "top" in names else top), "another top"
    assert np.array_equal(lower, foot), "another foot"
    if "top" in names and len(set(case["rise"])) > 1:
        return "columns: a level top"  # and no end on the ground, as other checks ask
    return [replace(found[0], name="top"), replace(found[1], name="foot")]


def _lie_left(path: Any, xy: Any, is_ring: bool) -> Any:
    """Tell which places lie to the left of a line: of the segment that is nearest."""
    if is_ring:
        ring = shapely.Polygon(path)
        return shapely.contains_xy(ring, xy) == ring.exterior.is_ccw
    segments = shapely.linestrings(np.stack([path[:-1], path[1:]], axis=1))
    away = shapely.distance(segments[None], shapely.points(xy)[:, None])
    # Of the segments as near, that whose line is farthest: the other one sees the place sideways.
    start, way = path[:-1], np.diff(path, axis=0)
    off = xy[:, None] - start
    across = way[:, 0] * off[..., 1] - way[:, 1] * off[..., 0]
    across /= np.hypot(*way.T)
    is_near = away <= away.min(axis=1)[:, None] * (1 + 1e-9) + 1e-9
    chosen = np.where(is_near, np.abs(across), -1.0).argmax(axis=1)
    return across[np.arange(len(xy)), chosen] > 0.0


def _require_apart(case: Case, made: Any, path: Any) -> None:
    lines = {
        name: made.points[chain]
        for chain, name in zip(made.lines.chains(), made.lines.names, strict=True)
    }
    top, foot = lines["top"], lines["foot"]
    assert len(foot) >= len(path)
    assert set(map(tuple, path.tolist())) <= set(map(tuple, top[:, :2].tolist()))
    high = {tuple(p): r > 0 for p, r in zip(path.tolist(), case["rise"], strict=True)}
    line = shapely.LineString(path)
    away = shapely.distance(line, shapely.points(foot[:, :2]))
    places = set(map(tuple, path.tolist()))
    moved = np.array([tuple(p) not in places for p in foot[:, :2].tolist()])
    assert moved.sum() >= sum(high[p] for p in places)
    assert (away[moved] >= case["walls"]).all(), away[moved].min()


def _require_side(case: Case, made: Any, path: Any) -> str:
    """Ask for the elevations of both lines beside each long segment whose ends are high."""
    rise = np.array(case["rise"])
    way = np.diff(path, axis=0)
    length = np.hypot(*way.T)
    left = np.column_stack([-way[:, 1], way[:, 0]]) / length[:, None]
    long = (rise[:-1] > 0) & (rise[1:] > 0) & (length > 20.0 * case["walls"])
    if not long.any():
        return "short"
    middle = 0.5 * (path[:-1] + path[1:])[long]
    toward = left[long] * (1.0 if case["left"] else -1.0)
    at_top = made.interpolate(middle)
    at_foot = made.interpolate(middle - toward * case["walls"] * (1 + 1e-6))
    # Middles are off the lines by roundings, and the face is steep.
    slack = 1e-6 + 4.0 * np.spacing(np.abs(path).max()) * max(rise) / case["walls"]
    assert np.abs(at_top - case["base"] - max(rise)).max() <= slack
    assert np.nanmax(np.abs(at_foot - case["base"])) <= 0.02 * max(rise) + slack
    return "line"


CAMPAIGNS = (Campaign("walls", "both lines, their distance and their sides", generate, examine),)
