"""The ground filter on scenes whose ground is known, in every order and unit.

The oracle is the scene: what was raised is no ground, and what was sunk is noise. Beside it, what
must hold of any points: the classes do not depend on their order, and every point has one.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

SIDE = 50.0


def generate(rng: np.random.Generator) -> Case:
    """A tilted plane or a hill with a house and trees; or points of no sense."""
    kind = str(rng.choice(["scene", "scene", "noise", "few"]))
    points = scatter(rng) if kind == "noise" else scene(rng)
    if kind == "few":
        points = points[: int(rng.integers(1, 12))]
    return {
        "kind": kind,
        "points": points.tolist(),
        "house": float(rng.choice([0.0, 4.0, 8.0])) if kind == "scene" else 0.0,
        "low": int(rng.integers(0, 4)) if kind == "scene" else 0,
        "cell": float(rng.choice([0.5, 1.0, 2.5])),
        "building": float(rng.choice([10.0, 30.0, 40.0])),
        "unit": float(rng.choice([1.0, 0.3048])),
        "seed": int(rng.integers(2**31)),
    }


def scene(rng: np.random.Generator) -> Any:
    spacing = float(rng.choice([1.0, 2.0]))
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.arange(0, SIDE, spacing)] * 2))
    x, y = x + rng.uniform(0, 0.4, len(x)), y + rng.uniform(0, 0.4, len(y))
    z = 100 + rng.uniform(-0.1, 0.1) * x + rng.uniform(-0.1, 0.1) * y
    return np.column_stack([x, y, z]).round(3)


def scatter(rng: np.random.Generator) -> Any:
    places = rng.integers(0, int(rng.choice([3, 12, 40])), (int(rng.integers(1, 300)), 3))
    return places * float(rng.choice([0.1, 1.0, 7.0]))


def examine(case: Case) -> str:
    """Find the ground, in two orders, and compare it with what was built."""
    rng = np.random.default_rng(case["seed"])
    points, is_house, is_low = build(case, rng)
    options = {"cell": case["cell"], "building": case["building"]}
    crs = {1.0: "EPSG:32616+5703", 0.3048: "EPSG:2222+8228"}[case["unit"]]
    survey = ts.Survey(points=points / case["unit"], crs=crs)
    found = ts.ground(survey, **options)
    require_order_does_not_matter(survey, found, options, rng)
    assert set(np.unique(found.classification)) <= {1, 2, 7}, "classes"
    assert sum(found.counts.values()) == len(points), "every point has a class"
    assert np.isfinite(found.heights).all(), "heights"
    if case["kind"] == "scene":
        ground = found.is_ground
        assert not ground[is_house].any(), "a house is ground"
        assert (found.classification[is_low] == 7).all(), "low noise is not told"
        missed = ~ground & ~is_house & ~is_low
        assert missed.sum() <= 0.002 * len(points), f"{missed.sum()} points of the ground missed"
    return str(case["kind"])


def build(case: Case, rng: np.random.Generator) -> tuple[Any, Any, Any]:
    """Return points with a house and low noise, and which points these are."""
    points = np.array(case["points"])
    is_house = (np.abs(points[:, :2] - SIDE / 2) < case["house"] / 2).all(axis=1)
    points[is_house, 2] += 5.0
    low = np.column_stack(
        [
            np.array([[12.0, 12.0], [37.0, 12.0], [12.0, 37.0]])[: case["low"]],
            rng.uniform(10, 80, case["low"]),
        ]
    )
    is_low = np.arange(len(points) + len(low)) >= len(points)
    return np.concatenate([points, low]), np.append(is_house, np.zeros(len(low), bool)), is_low


def require_order_does_not_matter(
    survey: Any, found: Any, options: dict[str, Any], rng: np.random.Generator
) -> None:
    order = rng.permutation(len(survey))
    again = ts.ground(ts.Survey(points=survey.points[order], crs=survey.crs), **options)
    assert (again.classification == found.classification[order]).all(), "classes by another order"
    assert (again.heights == found.heights[order]).all(), "heights by another order"


CAMPAIGNS = (Campaign("ground", "the ground of scenes that are known", generate, examine),)
