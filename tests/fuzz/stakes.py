"""Points that are set out: elevations, cut and fill, layouts, units, files, ground and grid."""

from __future__ import annotations

import csv
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

CRS = {"m": "EPSG:32616", "us-ft": "EPSG:2277"}
FOOT = 1200 / 3937


def generate(rng: np.random.Generator) -> Case:
    """Two surfaces around a place, points in and beside them, and how they are listed."""
    count = int(rng.integers(3, 40))
    size = float(10.0 ** rng.integers(0, 5))
    unit = str(rng.choice(list(CRS)))
    letters = rng.permutation(list("PNEZDGCFR"))[: int(rng.integers(1, 10))]
    at = rng.uniform(-1.3, 1.3, (int(rng.integers(1, 30)), 2))
    design = rng.uniform(-1, 1, (count, 3))
    on = int(min(len(at), count // 2))
    at[:on] = design[:on, :2]  # on vertices
    return {
        "design": design.tolist(),
        "ground": rng.uniform(-1.2, 1.2, (count, 3)).tolist(),
        "at": at.tolist(),
        "size": size,
        "base": [float(v) for v in np.array([2.2e6, 1.0e7]) if unit != "m"] or [5e5, 4e6],
        "unit": unit,
        "asked": rng.choice([None, "m", "ft", "us-ft"]),
        "layout": rng.choice([None, "".join(letters)]),
        "decimals": int(rng.integers(0, 7)),
        "factor": rng.choice([None, 0.9996, 1.00031, 0.7]),
    }


def examine(case: Case) -> str:
    """Compare with triangles searched one by one, and what was written with the list."""
    base = np.array([*case["base"], 0.0])
    surfaces = []
    for name in ("design", "ground"):
        points = np.array(case[name]) * [case["size"], case["size"], 30.0] + base
        try:
            surfaces.append(ts.triangulate(points, crs=CRS[case["unit"]], elevation_unit="m"))
        except ts.TinsmithError as error:
            return f"refused: {str(error)[:20]}"
    at = np.array(case["at"]) * case["size"] + base[:2]
    design, ground = surfaces
    table = ts.stakeout(design, at, ground=ground)
    assert len(table) == len(at)
    heights = [search(one, at) for one in surfaces]
    rounding = 1e-9 * max(30.0, *(np.abs(one.points[:, 2]).max() for one in surfaces))
    for name, wanted in zip(("elevation", "ground"), heights, strict=True):
        require_near(table[name], wanted, rounding, at)
    require_cut(table)
    require_reasons(table)
    require_factor(case, design, at)
    how: dict[str, Any] = {"unit": case["asked"], "layout": case["layout"]}
    listed = ts.stakeout(design, at, ground=ground, **how)
    require_units(case, table, listed)
    with TemporaryDirectory() as folder:
        require_file(listed, case["decimals"], Path(folder, "list.csv"))
    return "some outside" if np.isnan(table["elevation"]).any() else "inside"


def search(tin: ts.TIN, at: Any) -> Any:
    """Return elevations of the first triangle that holds each point; NaN and its margin else."""
    corners = tin.points[tin.triangles]
    a, b, c = (corners[:, k, :2] for k in range(3))
    found = np.full((len(at), 2), np.nan)
    for row, point in enumerate(at):

        def cross(one: Any, other: Any, point: Any = point) -> Any:
            d, e = other - one, point - one
            return d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]

        weights = np.column_stack([cross(b, c), cross(c, a), cross(a, b)])
        weights /= weights.sum(axis=1, keepdims=True)
        best = int(np.argmax(weights.min(axis=1)))
        found[row] = weights[best] @ corners[best, :, 2], weights[best].min()
    return found


def require_near(values: Any, searched: Any, rounding: float, at: Any) -> None:
    """Elevations are those of the search; NaN where it found no triangle; either on the rim."""
    for value, (wanted, margin), point in zip(values, searched, at, strict=True):
        if margin < -1e-6:
            assert np.isnan(value), (point, value, margin)
        elif margin > 1e-6:
            assert abs(value - wanted) <= rounding * 1e3, (point, value, wanted)


def require_cut(table: ts.Table) -> None:
    """Cut less fill is ground less design, and one of both is 0."""
    known = ~np.isnan(table["cut"])
    step = table["ground"] - table["elevation"]
    np.testing.assert_array_equal(known, ~np.isnan(step))
    np.testing.assert_array_equal((table["cut"] - table["fill"])[known], step[known])
    assert not (table["cut"][known] * table["fill"][known]).any()


def require_reasons(table: ts.Table) -> None:
    """Whatever is missing has a reason, and nothing else has."""
    missing = np.isnan(table["elevation"]) | np.isnan(table["ground"])
    assert [one is not None for one in table["reason"].tolist()] == missing.tolist()
    numbers = [point for point, lost in zip(table["point"], missing, strict=True) if lost]
    text = " ".join(table.notes)
    assert all(str(point) in text for point in numbers[:5]), (numbers, text)


def require_factor(case: Case, design: ts.TIN, at: Any) -> None:
    """Places on the ground are scaled about the base, and come back."""
    if case["factor"] is None:
        return
    factor = ts.CombinedFactor(case["factor"], base=case["base"], crs=design.crs)
    listed = ts.stakeout(design, at, factor=factor)
    names = list(listed.columns)[1:3]
    found = np.column_stack([listed[name] for name in names])
    wanted = case["base"] + (at - case["base"]) / case["factor"]
    np.testing.assert_allclose(found, wanted, rtol=1e-14)
    np.testing.assert_allclose(factor.to_grid(found), at, rtol=1e-14)


def require_units(case: Case, table: ts.Table, listed: ts.Table) -> None:
    """A list in another unit has the same lengths, and a layout the columns it names."""
    metres = {"m": 1.0, "ft": 0.3048, "us-ft": FOOT}
    for name, values in listed.columns.items():
        if values.dtype.kind != "f":
            continue
        own = 1.0 if name in ("elevation", "ground", "cut", "fill") else metres[case["unit"]]
        to = own if case["asked"] is None else metres[case["asked"]]
        np.testing.assert_allclose(values, table[name] * (own / to), rtol=1e-12)
    if case["layout"] is not None:
        assert len(listed.columns) == len(case["layout"])


def require_file(listed: ts.Table, decimals: int, path: Path) -> None:
    """What is written reads back, to half of the last digit."""
    ts.write(listed, path)
    _, *whole = read_cells(path)
    ts.write(listed, path, decimals=decimals, header=False)
    cells = read_cells(path)
    assert len(cells) == len(whole) == len(listed)
    for k, values in enumerate(listed.columns.values()):
        if values.dtype.kind != "f":
            continue
        found = np.array([float(row[k] or "nan") for row in cells])
        np.testing.assert_array_equal([float(row[k] or "nan") for row in whole], values)
        slack = 0.5 * 10.0**-decimals * (1 + 1e-9) + np.abs(np.nan_to_num(values)) * 3e-16
        assert np.all(np.isnan(values) | (np.abs(found - values) <= slack))
        assert not any(row[k].startswith("-0") and float(row[k]) == 0 for row in cells if row[k])


def read_cells(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


CAMPAIGNS = (
    Campaign("stakes", "points to set out: elevations, units, layouts", generate, examine),
)
