"""Volumes and differences of two small TINs against the same in fractions."""

from __future__ import annotations

from typing import Any

import numpy as np
from support.earthwork_oracle import exact_volume
from support.point_sets import points

import tinsmith as ts

from .campaign import Campaign, Case

NAMES = ("area", "cut_area", "fill_area", "cut", "fill")


def generate(rng: np.random.Generator) -> Case:
    """Two sets of points of one kind; the second may lie on the edges of the first."""
    both = np.array(points(rng, int(rng.integers(6, 19))), float)
    rng.shuffle(both)
    half = len(both) // 2
    first, second = both[:half], both[half:]
    if rng.random() < 0.3:
        second = on_edges(rng, first, half)
    if rng.random() < 0.3:
        first[:, 2] = second[:, 2] = 3.0
        second[: rng.integers(0, 4), 2] += 1.0
    kept = rng.random(64) if rng.random() < 0.3 else np.zeros(64)
    return {"points": first.tolist(), "other": second.tolist(), "kept": kept.tolist()}


def on_edges(rng: np.random.Generator, first: Any, count: int) -> Any:
    """Return points between pairs of others, where edges run, but for rounding; some corners."""
    a, b = first[rng.integers(0, len(first), count)], first[rng.integers(0, len(first), count)]
    share = rng.choice([0.0, 0.5, 1 / 3, 0.1], (count, 1))
    return a + share * (b - a)


def examine(case: Case) -> str:
    """Ask for the exact volumes but for rounding, and a difference that is sound and agrees."""
    try:
        tin, other = (ts.triangulate(case[name]) for name in ("points", "other"))
    except ts.TinsmithError:
        return "refused: points"
    tin = without_some(tin, case["kept"])
    exact = dict(zip((*NAMES, "squares"), exact_volume(tin, other).values(), strict=True))
    table = ts.volume(tin, other)
    relief = max(
        np.ptp(tin.points[:, 2]),
        np.ptp(other.points[:, 2]),
        abs(float(tin.points[:, 2].mean() - other.points[:, 2].mean())),
    )
    extent = np.ptp(np.concatenate([tin.points, other.points])[:, :2], axis=0)
    thin = 1e-14 * float(extent.sum()) ** 2  # a corner is rounded once
    for name in NAMES:
        found, true = float(table[name][0]), float(exact[name])
        scale = float(exact["area"]) * (1.0 if "area" in name else float(relief))
        slack = thin * (1.0 if "area" in name else float(relief))
        assert true != 0.0 or found == 0.0, f"{name}: {found} instead of 0"
        assert abs(found - true) <= 1e-11 * scale + slack, f"{name}: {found} instead of {true}"
    back = ts.volume(other, tin)
    assert back["cut"] == table["fill"], "exchanged"
    assert back["area"] == table["area"], "exchanged"
    return examine_difference(tin, other, table)


def without_some(tin: Any, kept: list[float]) -> Any:
    chosen = np.resize(np.array(kept), len(tin.triangles)) < 0.6
    return ts.TIN.from_triangles(tin.points, tin.triangles[chosen]) if chosen.any() else tin


def examine_difference(tin: Any, other: Any, table: Any) -> str:
    try:
        found = ts.difference(tin, other)
    except ts.PointsError as error:
        if "can tell" in str(error):
            return "refused: too thin"
        if table["area"] > 0.0:
            raise
        return "apart"
    assert ts.check(found.tin).ok, repr(ts.check(found.tin))
    area, slack = float(table["area"][0]), rounding_of(tin, other)
    relief = float(np.abs(found.tin.points[:, 2]).max())
    ranges = float(np.ptp(tin.points[:, 2]) + np.ptp(other.points[:, 2]))  # what a rounding moves
    assert abs(found.tin.area - area) <= slack, "area"
    zones = found.zones
    assert abs(zones.columns["area"].sum() - area) <= slack, "zones"
    for kind in ("cut", "fill"):
        volume = zones.columns["volume"][zones.columns["kind"] == kind].sum()
        apart = abs(volume - table[kind][0])
        assert apart <= slack * (relief + ranges) + 2e-7 * area * relief, (
            f"{kind}: {apart} of {volume}"
        )
    middle = found.statistics["median"][0]
    assert found.statistics["lowest"][0] <= middle <= found.statistics["highest"][0]
    reach = max(abs(found.statistics[name][0] - middle) for name in ("lowest", "highest"))
    assert 0 <= found.statistics["nmad"][0] <= 1.4826 * reach + 1e-12 * relief, "NMAD"
    return "overlaid"


def rounding_of(tin: Any, other: Any) -> float:
    """Return the area that moving every vertex by a rounding can change."""
    xy = np.concatenate([tin.points[:, :2], other.points[:, :2]])
    edges = 3 * (len(tin.triangles) + len(other.triangles))
    return float(8 * np.spacing(np.abs(xy).max()) * np.ptp(xy, axis=0).sum() * edges)


def generate_regions(rng: np.random.Generator) -> Case:
    """Two surfaces as above, and one to three regions among their places, which may overlap."""
    case = generate(rng)
    xy = np.array([*case["points"], *case["other"]], float)[:, :2]
    low, high = xy.min(axis=0), xy.max(axis=0)
    regions = []
    for _ in range(int(rng.integers(1, 4))):
        if rng.random() < 0.5:
            regions.append(xy[rng.choice(len(xy), 3, replace=False)].tolist())
        else:
            a, b = np.sort(low + (high - low) * rng.random((2, 2)), axis=0)
            regions.append([a.tolist(), [b[0], a[1]], b.tolist(), [a[0], b[1]]])
    return case | {"regions": regions}


def examine_regions(case: Case) -> str:
    """Ask for zones that add up to the table of volumes, region by region."""
    try:
        tin, other = (ts.triangulate(case[name]) for name in ("points", "other"))
        table = ts.volume(tin, other, regions=case["regions"])
        found = ts.difference(tin, other, regions=case["regions"])
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    assert ts.check(found.tin).ok, repr(ts.check(found.tin))
    slack = 64.0 * rounding_of(tin, other)
    relief = float(np.abs(found.tin.points[:, 2]).max())
    ranges = float(np.ptp(tin.points[:, 2]) + np.ptp(other.points[:, 2]))
    zones = found.zones.columns
    for row, name in enumerate(table["region"].tolist()):
        own = zones["region"].astype(str) == name
        area = float(table["area"][row])
        assert abs(zones["area"][own].sum() - area) <= slack, f"area of {name}"
        for kind in ("cut", "fill"):
            volume = zones["volume"][own & (zones["kind"].astype(str) == kind)].sum()
            apart = abs(volume - table[kind][row])
            most = slack * (relief + ranges) + 2e-7 * area * relief
            assert apart <= most, f"{kind} of {name}: off by {apart}"
    return f"{len(case['regions'])} regions"


def generate_errors(rng: np.random.Generator) -> Case:
    """Two surfaces with regions as above, errors of both, and a level of detection or none."""
    case = generate_regions(rng)
    words = ["exponential", "spherical", "gaussian"]
    extent = float(np.ptp(np.array(case["points"], float)[:, :2]))
    models = [
        {
            "standard_error": float(rng.choice([0.0, 0.1, 2.0])),
            "systematic": float(rng.choice([0.0, 0.3])),
            "correlation_range": float(rng.choice([0.0, 0.1, 1.0, 20.0]) * extent),
            "correlation": str(rng.choice(words)),
            "nugget": float(rng.choice([0.0, 0.4, 1.0])),
        }
        for _ in range(2)
    ]
    level = float(rng.choice([0.1, 0.5, 1.0, 3.0]))
    return case | {"models": models, "level": level, "in_regions": bool(rng.random() < 0.4)}


def examine_errors(case: Case) -> str:
    """Ask for the errors of derivatives, and for zones that are the volumes beyond the level."""
    regions = case["regions"] if case["in_regions"] else None
    models = [ts.ErrorModel(**one) for one in case["models"]]
    options = {"standard_error": models[0], "other_standard_error": models[1]}
    try:
        tin, other = (ts.triangulate(case[name]) for name in ("points", "other"))
        table = ts.volume(tin, other, regions=regions, level_of_detection=case["level"], **options)
    except ts.TinsmithError as error:
        return f"refused: {type(error).__name__}"
    examine_net_errors(tin, other, regions, table, models)
    slack = 64.0 * rounding_of(tin, other)
    relief = float(np.ptp(np.concatenate([tin.points, other.points])[:, 2]))
    for name in ("cut", "fill"):
        whole, beyond = table[name], table[f"thresholded_{name}"]
        least = case["level"] * table[f"thresholded_{name}_area"]
        assert (beyond <= whole * (1 + 1e-9) + slack * relief).all(), name
        assert (beyond >= least * (1 - 1e-9)).all(), name
    try:
        found = ts.difference(tin, other, regions=regions, level_of_detection=case["level"])
    except ts.TinsmithError as error:
        return f"measured; refused: {type(error).__name__}"
    assert ts.check(found.tin).ok, repr(ts.check(found.tin))
    relief = float(np.abs(found.tin.points[:, 2]).max())
    ranges = float(np.ptp(tin.points[:, 2]) + np.ptp(other.points[:, 2]))
    zones, area = found.zones.columns, float(table["area"].sum())
    assert abs(zones["area"].sum() - area) <= slack, "area of zones"
    for kind in ("cut", "fill"):
        volume = zones["volume"][zones["kind"].astype(str) == kind].sum()
        apart = abs(volume - table[f"thresholded_{kind}"].sum())
        most = slack * (relief + ranges) + 2e-7 * area * relief
        assert apart <= most, f"{kind} beyond the level: off by {apart}"
    return "with a level"


def examine_net_errors(tin: Any, other: Any, regions: Any, table: Any, models: Any) -> None:
    """Ask for the error of a net volume by how it changes with each elevation, which is linear."""
    variances = np.zeros(len(table))
    for which, model in enumerate(models):
        surface = (tin, other)[which]
        found = []
        for vertex in range(len(surface.points)):
            moved = surface.points.copy()
            moved[vertex, 2] += 1.0
            pair = [tin, other]
            pair[which] = ts.TIN.from_triangles(moved, surface.triangles)
            found.append(ts.volume(*pair, regions=regions)["net"] - table["net"])
        weights = np.array(found)
        xy = surface.points[:, :2]
        away = np.hypot(*(xy[:, None] - xy[None]).transpose(2, 0, 1))
        rho = np.eye(len(xy))
        if model.correlation_range > 0:
            near = np.where(away < model.reach, model.correlate(away), 0.0)
            rho = (1 - model.nugget) * near + model.nugget * rho
        covariance = model.standard_error**2 * rho + model.systematic**2
        variances += np.einsum("ik,ij,jk->k", weights, covariance, weights)
    most = sum(one.standard_error + one.systematic for one in models)
    relief = float(np.abs(np.concatenate([tin.points, other.points])[:, 2]).max()) + 1.0
    # Derivatives are differences of volumes, each of which is rounded.
    slack = (1e-11 * float(table["area"].max()) + 64.0 * rounding_of(tin, other)) * relief * most
    apart = np.abs(table["net_error"] - np.sqrt(np.maximum(variances, 0.0)))
    assert (apart <= 1e-6 * table["net_error"] + slack).all(), f"net_error: off by {apart}"


CAMPAIGNS = (
    Campaign("volumes", "cut and fill, and the difference of two TINs", generate, examine),
    Campaign(
        "standard_errors",
        "standard errors of volumes, and the level of detection",
        generate_errors,
        examine_errors,
    ),
    Campaign("regions", "zones and volumes in regions", generate_regions, examine_regions),
)
