"""Simplifications of small TINs and rasters: sound, near every point, lines as they were."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from support.simplification import largest_crossing

import tinsmith as ts
from tinsmith.terrain.simplification.rasters import simplify_raster
from tinsmith.tin.meshing.simplification import Goal

from .campaign import Campaign, Case
from .linework import list_lines, surface, triangulate


def generate(rng: np.random.Generator) -> Case:
    """A TIN with lines, a boundary or holes, and a tolerance or a number of points."""
    case = surface(rng, most=39)
    heights = np.array(case["points"])[:, 2]
    case["tolerance"] = float(rng.choice([0, 0.01, 0.1, 0.5, 2])) * float(np.ptp(heights))
    case["share"] = float(rng.random())
    case["order"] = int(rng.integers(2**31))
    case["flips"] = rng.random(int(rng.integers(0, 12))).tolist() if rng.random() < 0.4 else []
    case["hold"] = [None, "points", "surface"][int(rng.integers(3))]
    case["side"] = str(rng.choice(["both", "both", "above", "below"]))
    return case


def examine(case: Case) -> str:
    """Simplify both ways, and in another order of the points."""
    tin = triangulate(case)
    if isinstance(tin, str):
        return tin
    side = case.get("side", "both")
    try:
        simple = ts.simplify(tin, tolerance=case["tolerance"], hold=case["hold"], side=side)
    except ts.PointsError:
        return "refused: too near"
    require_sound(tin, simple)
    told = simple.report.simplification
    assert told.largest_error <= case["tolerance"]
    assert case["hold"] in (None, told.hold)
    if told.hold == "surface":
        require_near(tin, simple, case["tolerance"])
    if side != "both":
        require_on_side(tin, simple, side)
        return f"simplified {side} by {told.hold}"
    least = ts.simplify(tin, tolerance=1e300).report.simplification.required
    number = least + int(case["share"] * (len(tin.points) - least))
    if number >= 3:
        counted = ts.simplify(tin, points=number)
        require_sound(tin, counted)
        assert len(counted.points) == number, "another number of points"
    if not list_lines(case):
        require_same_in_any_order(case, simple)
        require_given_triangles(tin, case)
    return f"simplified by {told.hold}"


def require_given_triangles(tin: Any, case: Case) -> None:
    """Of triangles that are not Delaunay the difference is held nevertheless."""
    edited = tin.replace()
    for share in case["flips"]:
        try:
            edited.flip(*edited.edges[int(share * len(edited.edges))].tolist())
        except ts.TinsmithError:
            continue
    if not case["flips"] or np.array_equal(edited.triangles, tin.triangles):
        return
    given = ts.TIN.from_triangles(edited.points, edited.triangles)
    simple = ts.simplify(given, tolerance=case["tolerance"])
    found = ts.check(simple)
    assert found.ok, [one.sentence for one in found.problems]
    if simple.report.simplification.hold == "surface":
        require_near(given, simple, case["tolerance"])


def require_on_side(tin: Any, simple: Any, side: str) -> None:
    """The surface is nowhere below the points, or above them, and between them if that is held."""
    turn = 1.0 if side == "above" else -1.0
    told, rounding = simple.report.simplification, 2e-14 * np.abs(tin.points[:, 2]).max()
    assert told.side == side
    depth = turn * (tin.points[:, 2] - simple.interpolate(tin.points[:, :2]))
    assert np.nanmax(depth) <= rounding, f"a point lies {np.nanmax(depth)} beyond the surface"
    if told.hold == "surface":
        crossing = float(largest_crossing(tin, simple, turn))
        assert crossing <= 1e5 * rounding, f"the surfaces cross by {crossing}"


def require_near(tin: Any, simple: Any, tolerance: float) -> None:
    """The surfaces differ nowhere by more than is told, in fractions."""
    told = simple.report.simplification.surface_error
    rounding = 1e-9 * np.abs(tin.points[:, 2]).max()
    crossing = float(largest_crossing(tin, simple))
    assert told <= tolerance
    assert crossing <= told + rounding, f"{crossing} where edges cross, not {told}"
    found = max(crossing, simple.report.simplification.largest_error)
    assert told <= found + rounding, f"{told} is told, not {found}"


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
    mixed = ts.triangulate(given[order])
    other = ts.simplify(mixed, tolerance=case["tolerance"], hold=case["hold"])
    sets = [{tuple(point) for point in one.points.tolist()} for one in (simple, other)]
    assert sets[0] == sets[1], "another order of the points, other points are left"


# ------------------------------------------------------------------------ rasters


def generate_raster(rng: np.random.Generator) -> Case:
    """A small raster with voids or without, simplified whole or in blocks."""
    rows, columns = (int(side) for side in rng.integers(2, 30, 2))
    z = rng.normal(size=(rows, columns)).cumsum(axis=0).cumsum(axis=1)
    if rng.random() < 0.3:
        z = np.round(z)
    share = float(rng.choice([0, 0, 0.02, 0.1, 0.3]))
    is_void = rng.random(z.shape) < share
    at = rng.uniform(-5e6, 5e6, 2) if rng.random() < 0.5 else np.zeros(2)
    return {
        "z": np.where(is_void, -9999.0, z).tolist(),
        "west_north": at.tolist(),
        "spacing": float(rng.choice([1, 0.1, 30, 1 / 3])),
        "tolerance": float(rng.choice([0, 0.01, 0.1, 0.5])) * float(np.ptp(z)),
        "block_side": int(rng.integers(2, 12)) if rng.random() < 0.6 else 0,
        "hold": str(rng.choice(["points", "surface"])),
        "threads": int(rng.integers(1, 4)),
    }


def examine_raster(case: Case) -> str:
    """Simplify it, and measure every cell; the area is that of the TIN of all cells."""
    raster = make_raster(case)
    whole = 0 if case["block_side"] else 2**24
    hold = "points" if case["block_side"] else case["hold"]
    goal = Goal.of(case["tolerance"], None, hold)
    try:
        simple = simplify_raster(
            raster,
            goal,
            (),
            case["threads"],
            largest_whole=whole,
            block_side=case["block_side"] or 1,
        )
    except ts.PointsError:
        with pytest.raises(ts.TinsmithError):
            ts.triangulate(ts.from_raster(raster))
        return "refused: no surface"
    found = ts.check(simple)
    assert found.ok, [one.sentence for one in found.problems]
    tin = ts.triangulate(ts.from_raster(raster))
    used = np.unique(tin.triangles)
    error = np.abs(simple.interpolate(tin.points[used, :2]) - tin.points[used, 2])
    rounding = np.abs(tin.points[:, 2]).max() * 1e-9 + 1e-9
    told = simple.report.simplification
    assert error.max() <= case["tolerance"] + rounding, "a cell is beyond the tolerance"
    assert abs(error.max() - told.largest_error) <= rounding, "another error is told"
    assert told.points == len(used)
    assert np.isclose(simple.area, tin.area, rtol=1e-9), "another area"
    if hold == "surface":
        require_near(tin, simple, case["tolerance"])
    return "in blocks" if case["block_side"] else "whole"


def make_raster(case: Case) -> ts.Raster:
    """Return the raster of a case."""
    z = np.array(case["z"])
    (west, north), spacing = case["west_north"], case["spacing"]
    sides = z.shape[1] * spacing, z.shape[0] * spacing
    bounds = ts.Bounds(west, north - sides[1], west + sides[0], north)
    return ts.Raster({"elevation": z}, ts.Grid(bounds, z.shape, spacing), nodata=-9999.0)


CAMPAIGNS = (
    Campaign(
        "simplify rasters",
        "simplifications of small rasters, in blocks or whole",
        generate_raster,
        examine_raster,
    ),
    Campaign("simplify", "simplifications of small TINs with lines", generate, examine),
)
