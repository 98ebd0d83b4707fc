"""Profiles, cross sections and draped lines against the same in fractions."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from support.point_sets import points
from support.section_oracle import elevation_at, exact_rows

import tinsmith as ts

from .campaign import Campaign, Case


def generate(rng: np.random.Generator) -> Case:
    """One or two surfaces with triangles left out, and a line on the same places or between."""
    case: Case = {"surfaces": [], "line": []}
    for _ in range(int(rng.integers(1, 3))):
        given = points(rng, int(rng.integers(3, 12)))
        leave_out = rng.random() * rng.choice([0.0, 0.6])
        case["surfaces"].append(
            {"points": given, "seed": int(rng.integers(1000)), "out": leave_out}
        )
    xy = np.array(case["surfaces"][0]["points"], float)[:, :2]
    for _ in range(int(rng.integers(2, 5))):
        case["line"].append(_vertex(rng, xy))
    if rng.random() < 0.3:
        case["interval"] = float(rng.choice([0.5, 1.0, 3.0]))
    return case


def _vertex(rng: np.random.Generator, xy: Any) -> list[float]:
    """Return a vertex of the surface, a place between two of them, or one around."""
    p, q = xy[rng.integers(len(xy), size=2)]
    kind = rng.integers(4)
    place = p if kind == 0 else (p + q) / 2 if kind == 1 else 2 * p - q if kind == 2 else q
    low, high = xy.min(axis=0), xy.max(axis=0)
    if rng.random() < 0.2:
        place = low + (high - low) * (rng.random(2) * 1.4 - 0.2)
    return [float(place[0]), float(place[1])]


def surface_of(case: Any) -> Any:
    """Triangulate, and leave some of the triangles out: holes, parts, corners that touch."""
    tin = ts.triangulate(case["points"])
    rng = np.random.default_rng(case["seed"])
    stays = rng.random(len(tin.triangles)) >= case["out"]
    if not stays.any():
        stays[0] = True
    return ts.TIN.from_triangles(tin.points, tin.triangles[stays])


def examine(case: Case) -> str:
    """Ask for the exact breaks, for the mirror image in reverse, and for the surface itself."""
    try:
        tins = [surface_of(one) for one in case["surfaces"]]
    except ts.TinsmithError:
        return "refused: points"
    try:
        table = ts.profile(tins if len(tins) > 1 else tins[0], case["line"])
    except ts.LinesError as error:
        return require_reason(str(error))
    if len(tins) == 1:
        require_exact_breaks(tins[0], case["line"], table)
    require_mirror(tins, case["line"], table)
    require_surface(tins, table)
    require_drape(tins[0], case["line"])
    if "interval" in case:
        require_stations(tins, case["line"], case["interval"])
    return f"{len(tins)} surfaces"


def require_reason(sentence: str) -> str:
    """Only a line without length, outside, or with coordinates out of range is refused."""
    for reason in ("no length", "outside the surface", "exact range"):
        if reason in sentence:
            return f"refused: {reason}"
    raise AssertionError(sentence)


def require_exact_breaks(tin: Any, line: Any, table: Any) -> None:
    """Places and elevations are the exact ones, rounded once; gaps are where they should be."""
    expected = []
    steps = [(a, b) for a, b in pairwise(line) if a != b]
    for number, (a, b) in enumerate(steps):
        rows = exact_rows(tin, a, b)
        expected += rows if number == len(steps) - 1 else rows[:-1]
    is_gap = table["crossed"] == "gap"
    x, y, z = (table[name][~is_gap] for name in ("x", "y", "elevation"))
    assert len(x) == len(expected), f"{len(x)} breaks, not {len(expected)}"
    for k, row in enumerate(expected):
        assert (x[k], y[k]) == (float(row.x), float(row.y)), f"break {k} is misplaced"
        assert np.isnan(z[k]) == (row.elevation is None), f"break {k}: surface or none"
        if row.elevation is not None and 0 < row.ratio < 1:
            assert z[k] == float(row.elevation), f"break {k}: {z[k]}, not {float(row.elevation)}"
        elif row.elevation is not None:
            assert z[k] == tin.interpolate([[x[k], y[k]]])[0], f"break {k}: an end"
    grades = table["grade"][~is_gap]
    goes_on = [row.goes_on for row in expected]
    assert (~np.isnan(grades)).tolist() == goes_on, "gaps"
    rows = np.flatnonzero(~is_gap)
    for k, (row, after) in enumerate(pairwise(expected)):
        if row.elevation is None or after.elevation is None or row.goes_on:
            continue
        assert rows[k + 1] == rows[k] + 2 or (x[k], y[k]) == (x[k + 1], y[k + 1]), "no gap row"


def require_mirror(tins: list[Any], line: Any, table: Any) -> None:
    """The line in reverse has the same rows in reverse, bit for bit."""
    mirror = ts.profile(tins if len(tins) > 1 else tins[0], line[::-1])
    for name, values in table.columns.items():
        if name == "station" or name.startswith("grade"):
            continue
        other = mirror[name][::-1]
        same = np.array_equal(values, other, equal_nan=values.dtype.kind == "f")
        assert same, f"{name} in reverse: {values.tolist()}, {other.tolist()}"
    assert (np.diff(table["station"]) >= 0).all(), "stations go back"


def require_surface(tins: list[Any], table: Any) -> None:
    """Elevations are those of the surface at the place, but for the rounding of the place."""
    for k, tin in enumerate(tins):
        name = f"elevation_{k + 1}" if len(tins) > 1 else "elevation"
        size = np.abs(tin.points[:, :2]).max()
        steepness = min(steepest(tin), 1e280)
        slack = 8 * np.spacing(max(size, 1e-300)) * steepness
        slack += 8 * np.spacing(np.abs(tin.points[:, 2]).max())
        for x, y, z in zip(table["x"], table["y"], table[name], strict=True):
            truth = elevation_at(tin, x, y)
            if truth is not None and not np.isnan(z):
                assert abs(z - float(truth)) <= slack, f"{name} {z} at {x}, {y}: {float(truth)}"


def steepest(tin: Any) -> float:
    normals = tin.triangle_normals
    up = np.maximum(normals[:, 2], 1e-300)
    return float((np.hypot(normals[:, 0], normals[:, 1]) / up).max())


def require_drape(tin: Any, line: Any) -> None:
    """Draped lines have the vertices of the profile."""
    try:
        table = ts.profile(tin, line)
    except ts.LinesError:
        return
    draped = ts.drape(tin, line, outside="nan").coordinates
    columns = np.column_stack([table["x"], table["y"], table["elevation"]])
    assert np.array_equal(draped, columns, equal_nan=True), "the draped line is another"


def require_stations(tins: list[Any], line: Any, interval: float) -> None:
    """Every multiple within the line has a row."""
    length = sum(float(np.hypot(b[0] - a[0], b[1] - a[1])) for a, b in pairwise(line))
    if not 0.0 < length < 1000 * interval:
        return
    table = ts.profile(tins if len(tins) > 1 else tins[0], line, interval=interval)
    stations = table["station"]
    assert (np.diff(stations) >= 0).all(), "stations go back"
    wanted = np.arange(1, int(length / interval)) * interval
    apart = np.abs(stations[None, :] - wanted[:, None]).min(axis=1, initial=np.inf)
    assert (apart <= 8 * np.spacing(length)).all(), "a station is missing"


CAMPAIGNS = (Campaign("sections", "profiles and draped lines in fractions", generate, examine),)
