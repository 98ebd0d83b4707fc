"""Screens of surfaces: right points stay, wrong points, lines and voids are found."""

from __future__ import annotations

from typing import Any

import numpy as np
from support.point_sets import points

import tinsmith as ts
from tinsmith.terrain.inspection.findings import drop_blunders, list_wrong_rows, screen
from tinsmith.tin.screening import describe_findings

from .campaign import Campaign, Case

SIZE = 100.0
BASE = 300.0
FAULTS = ("none", "spike", "zero boundary", "far boundary", "two codes", "void", "millimetres")


def _compute_ground(xy: Any, case: Case) -> Any:
    """Return a plane, or a paraboloid as steep as it at most, with decimals as surveys have."""
    a, b, c = case["slopes"]
    x, y = (np.asarray(xy, float) / SIZE - 0.5).T
    return BASE + SIZE * (a * x + b * y + c * (x * x + y * y))


def generate(rng: np.random.Generator) -> Case:
    """Even points of a plane or a smooth surface, lines through them, and one fault."""
    count = int(rng.integers(12, 20))
    turn = float(rng.random() * 2 * np.pi)
    x, y = np.meshgrid(np.arange(count), np.arange(count))
    xy = np.column_stack([x.ravel(), y.ravel()]) * (SIZE / (count - 1))
    jitter = float(rng.choice([0.0, 0.3]))
    xy[:, :2] += rng.normal(0, jitter * SIZE / count, xy.shape)
    cosine, sine = np.cos(turn), np.sin(turn)
    xy = (xy - SIZE / 2) @ np.array([[cosine, -sine], [sine, cosine]]) + SIZE / 2
    curved = float(rng.choice([0.0, rng.uniform(-0.2, 0.2)]))
    low, high = np.sort(rng.uniform(-0.3, 1.3, (2, 2)), axis=0) * SIZE
    return {
        "xy": xy.tolist(),
        "slopes": [*rng.uniform(-0.5, 0.5, 2).tolist(), curved],
        "fault": str(rng.choice(FAULTS)),
        "boundary": [low.tolist(), high.tolist()] if rng.random() < 0.5 else [],
        "line": (rng.uniform(0.1, 0.9, (3, 2)) * SIZE).tolist() if rng.random() < 0.5 else [],
        "row": int(rng.integers(count * count)),
        "seed": int(rng.integers(2**31)),
    }


def _make_ring(low: Any, high: Any) -> Any:
    return np.array([low, [high[0], low[1]], high, [low[0], high[1]]], float)


def examine(case: Case) -> str:
    """Build the surface without its fault, then with it, and ask what is found."""
    xy = np.array(case["xy"], float)
    xyz = np.column_stack([xy, _compute_ground(xy, case)])
    lines: dict[str, Any] = {}
    if case["boundary"]:
        lines["boundary"] = [_make_ring(*case["boundary"])]
    if case["line"]:
        line = np.array(case["line"], float)
        lines["breaklines"] = [np.column_stack([line, _compute_ground(line, case)])]
    try:
        tin = ts.triangulate(xyz, **lines)
    except ts.TinsmithError:
        return "refused: lines"
    _require_none(tin)
    return _examine_fault(case, xyz)


def _require_none(tin: Any) -> None:
    """Of right points none looks wrong, and none is dropped."""
    for table in (ts.blunders(tin), screen(tin)):
        assert len(list_wrong_rows(table)) == 0, table["explanation"].tolist()[:3]
        assert not np.isin(table["reason"].astype(str), ("line", "void")).any()
    assert not any("blunder" in note for note in describe_findings(tin))
    assert len(drop_blunders(tin, ts.blunders(tin))[1]) == 0


def _examine_fault(case: Case, xyz: Any) -> str:
    """Plant the fault, and look for it in both tables and in the sentences."""
    fault, row = case["fault"], case["row"]
    rng = np.random.default_rng(case["seed"])
    wrong, lines, told = xyz.copy(), {}, "blunder"
    rows = {row}
    if fault == "none":
        return "none"
    if fault == "spike":
        wrong[row, 2] += 500.0 * rng.choice([-1.0, 1.0])
    elif fault == "two codes":
        rows = set(rng.choice(len(xyz), 4, replace=False).tolist())
        first, *others = sorted(rows)
        wrong[first, 2] = -99.0
        wrong[others, 2] = 0.0
    elif fault == "millimetres":
        rows = set(rng.choice(len(xyz), 6, replace=False).tolist())
        wrong[sorted(rows), 2] *= 1000.0
    elif fault == "void":
        near = np.argsort(np.hypot(*(xyz[:, :2] - SIZE / 2).T))[:16]
        rows = set(near.tolist())
        wrong[near, 2] = 0.0
    else:
        rows, told = set(), "Boundary 0"
        ring = _make_ring([0.2 * SIZE, 0.3 * SIZE], [0.8 * SIZE, 0.7 * SIZE])
        z = np.zeros(4) if fault == "zero boundary" else _compute_ground(ring, case) + 500.0
        lines["boundary"] = [np.column_stack([ring, z])]
    tin = ts.triangulate(wrong, **lines)
    for table in (ts.blunders(tin), screen(tin)):
        _require_found(table, rows, tin)
    assert any(told in note for note in describe_findings(tin)), describe_findings(tin)
    tin, gone = drop_blunders(tin, ts.blunders(tin))
    assert set(gone.tolist()) <= rows, "a right point was dropped"
    assert ts.check(tin).ok
    return fault


def _require_found(table: Any, rows: set[int], tin: Any) -> None:
    found = set(list_wrong_rows(table).tolist())
    there = {row for row in rows if tin.vertex_of[row] >= 0}
    assert found == there, f"{sorted(found)} instead of {sorted(there)}"
    if not rows:
        assert "line" in table["reason"].tolist()


# ---------------------------------------------------------------- any surface


def generate_any(rng: np.random.Generator) -> Case:
    """Points of any kind with rings and lines, of which some triangles are taken."""
    made = points(rng, int(rng.integers(3, 60)))
    box = np.array(made, float)[:, :2]
    low, size = box.min(axis=0), np.ptp(box, axis=0) + 1e-9
    ring = (low + size * rng.uniform(-0.2, 1.2, (4, 2))).tolist()
    return {
        "points": made,
        "ring": ring,
        "kind": str(rng.choice(["whole", "boundary", "holes", "water", "breaklines", "parts"])),
        "z": float(rng.choice([0.0, -9999.0, 1e30, 300.0])),
        "keep": float(rng.random()),
        "seed": int(rng.integers(2**31)),
    }


def examine_any(case: Case) -> str:
    """Ask every screen of a surface; none of them raises, and all say the same twice."""
    xyz, ring = np.array(case["points"], float), np.array(case["ring"], float)
    kind, rng = case["kind"], np.random.default_rng(case["seed"])
    rings = [np.column_stack([ring, np.full(len(ring), case["z"])])]
    given: dict[str, Any] = {kind: rings}
    if kind == "water":
        given = {kind: [ts.Water(ring, case["z"])]}
    elif kind in ("whole", "parts"):
        given = {}
    try:
        tin = ts.triangulate(xyz, **given)
        if kind == "parts":
            chosen = rng.random(len(tin.triangles)) < case["keep"]
            chosen[0] = True
            tin = ts.TIN.from_triangles(tin.points, tin.triangles[chosen])
    except ts.TinsmithError:
        return "refused: lines"
    told = describe_findings(tin)
    assert told == describe_findings(tin)
    assert all(isinstance(note, str) and note.endswith(".") for note in told), told
    screen(tin)
    table = ts.blunders(tin)
    drop_blunders(tin, table)
    return kind


CAMPAIGNS = (
    Campaign("screens", "right points, wrong points, lines and voids", generate, examine),
    Campaign("screened", "screens of surfaces of any kind", generate_any, examine_any),
)
