"""Shifts of rough, flat, one-sided and partly changed surfaces, found again or refused.

The oracle is the shift by which a surface was moved; without errors it comes back, with errors to a
part of the cells. Whatever is returned differs less than before.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from support.point_sets import scattered

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """Sines of random directions on a lattice or scattered, moved by up to some cells."""
    waves = int(rng.choice([0, 1, 2, 5]))
    side = int(rng.integers(14, 40))
    return {
        "side": side,
        "waves": [
            [
                *rng.uniform(-0.35, 0.35, 2).tolist(),
                float(rng.uniform(0, 7)),
                float(rng.uniform(1, 6)),
            ]
            for _ in range(waves)
        ],
        "is_lattice": bool(rng.random() < 0.5),
        "noise": float(rng.choice([0.0, 0.0, 0.02, 1.0])),
        "changed": bool(rng.random() < 0.3),
        "shift": (rng.normal(size=3) * rng.choice([0.0, 0.1, 1.5])).tolist(),
        "west": float(rng.choice([0.0, 500_000.0])),
        "unit": str(rng.choice(["m", "ft"])),
        "spacing": [None, 0.7, 2.0][int(rng.integers(3))],
        "seed": int(rng.integers(1 << 30)),
    }


def make_points(case: Case, rng: np.random.Generator) -> Any:
    side = case["side"]
    if case["is_lattice"]:
        x, y = (one.ravel() for one in np.meshgrid(np.arange(side + 1.0), np.arange(side + 1.0)))
    else:
        x, y = scattered(rng, side * side, float(side)).T
    z = np.zeros(len(x))
    for east, north, phase, height in case["waves"]:
        z = z + height * np.sin(east * x + north * y + phase)
    return np.column_stack([x + case["west"], y, z])


def examine(case: Case) -> str:
    """Move a surface and bring it back."""
    rng = np.random.default_rng(case["seed"])
    points = make_points(case, rng)
    shift = np.array(case["shift"])
    moved = points + shift
    for one in (points, moved):
        one[:, 2] += case["noise"] * rng.normal(size=len(one))
    if case["changed"]:
        moved[moved[:, 1] - shift[1] > 0.8 * case["side"], 2] += 9.0
    factor = 0.3048 if case["unit"] == "ft" else 1.0
    moved[:, 2] /= factor
    try:
        reference = ts.triangulate(points, crs="EPSG:32616", elevation_unit="m")
        tin = ts.triangulate(moved, crs="EPSG:32616", elevation_unit=case["unit"])
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    try:
        found = ts.coregister(tin, reference, spacing=case["spacing"])
    except ts.PointsError as error:
        return f"refused: {str(error)[:18]}"
    assert ts.check(found.tin).ok, "the shifted surface"
    before, after = found.statistics["nmad"]
    assert after <= 1.02 * before + 1e-9, "it differs more than before"
    off = np.array(found.shift) * [1, 1, factor] + shift
    is_exact = case["noise"] == 0 and not case["changed"]
    if is_exact:  # of one wave, too, the triangles themselves tell the shift
        assert np.abs(off).max() <= 0.02, f"off by {off}"
        return "exact"
    return "moved"


CAMPAIGNS = (Campaign("coregistration", "shifts that are found again", generate, examine),)
