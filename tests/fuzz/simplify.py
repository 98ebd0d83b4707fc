"""Simplifications of small TINs: sound, near every point, with lines and boundary as they were."""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case
from .linework import list_lines, surface, triangulate


def generate(rng: np.random.Generator) -> Case:
    """A TIN with lines, a boundary or holes, and a tolerance or a number of points."""
    case = surface(rng, most=39)
    heights = np.array(case["points"])[:, 2]
    case["tolerance"] = float(rng.choice([0, 0.01, 0.1, 0.5, 2])) * float(np.ptp(heights))
    case["share"] = float(rng.random())
    case["order"] = int(rng.integers(2**31))
    return case


def examine(case: Case) -> str:
    """Simplify both ways, and in another order of the points."""
    tin = triangulate(case)
    if isinstance(tin, str):
        return tin
    try:
        simple = ts.simplify(tin, tolerance=case["tolerance"])
    except ts.PointsError:
        return "refused: too near"
    require_sound(tin, simple)
    rounding = np.abs(tin.points[:, 2]).max() * 1e-13
    assert simple.report.simplification.largest_error <= max(case["tolerance"], rounding)
    least = ts.simplify(tin, tolerance=1e300).report.simplification.required
    number = least + int(case["share"] * (len(tin.points) - least))
    if number >= 3:
        counted = ts.simplify(tin, points=number)
        require_sound(tin, counted)
        assert len(counted.points) == number, "another number of points"
    if not list_lines(case):
        require_same_in_any_order(case, simple)
    return "simplified"


def require_sound(tin: Any, simple: Any) -> None:
    """The TIN is sound, its error as told, its lines as they were."""
    found = ts.check(simple)
    assert found.ok, [one.sentence for one in found.problems]
    error = np.abs(simple.interpolate(tin.points[:, :2]) - tin.points[:, 2])
    told = simple.report.simplification.largest_error
    assert np.nanmax(error) <= told + 1e-9 * np.abs(tin.points[:, 2]).max(), "error"
    for before, after in zip(tin.lines.chains(), simple.lines.chains(), strict=True):
        assert np.array_equal(tin.points[before], simple.points[after]), "a line changed"


def require_same_in_any_order(case: Case, simple: Any) -> None:
    given = np.array(case["points"])
    if len(np.unique(given[:, :2], axis=0)) < len(given):
        return  # the mean of several elevations depends on their order
    order = np.random.default_rng(case["order"]).permutation(len(given))
    other = ts.simplify(ts.triangulate(given[order]), tolerance=case["tolerance"])
    sets = [{tuple(point) for point in one.points.tolist()} for one in (simple, other)]
    assert sets[0] == sets[1], "another order of the points, other points are left"


CAMPAIGNS = (Campaign("simplify", "simplifications of small TINs with lines", generate, examine),)
