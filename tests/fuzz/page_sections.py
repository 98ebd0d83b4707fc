"""Sections that the page draws, held against those of the library: rows, places, elevations."""

from __future__ import annotations

import csv
import functools
import io
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from support.pages import open_page

import tinsmith as ts

from .campaign import Campaign, Case

_CRSS = {"EPSG:32616": (742_000.0, 4_030_000.0), "EPSG:2274": (2e6, 6e5), "": (0.0, 0.0)}
_SECTION = """async (line) => { const p = await window.terrain;
  const [s, o] = [p.payload.scale, p.payload.origin];
  p.tool.clear(); p.tool.choose("distance");
  p.tool.marked = line.map(([x, y]) => ({ model: p.scene.models[0],
    hit: { triangle: 0, x: (x - o[0]) * s[0], y: (y - o[1]) * s[1], z: 0 } }));
  p.tool.showMeasured(); return p.tool.formatCsv(); }"""
_STATION, _ELEVATION = 2e-5, 1e-4
"""Stations have 6 decimals; an elevation of a page is a sum of few numbers of 32 bits."""
_ALONG = 1e-3
"""From the boundary: coordinates are rounded for the page."""


def generate(rng: np.random.Generator) -> Case:
    """Surfaces of whole millimetres, with much on one line, and lines along and beside them."""
    crs = str(rng.choice([*_CRSS]))
    size = float(rng.choice([8.0, 60.0, 900.0]))
    step = float(rng.choice([1.0, 0.25, 0.001]))
    relief = size * float(rng.choice([0.0, 0.01, 0.3, 2.0]))

    def draw(count: int, low: float = 0.0, high: float = 1.0) -> np.ndarray:
        return np.round(rng.uniform(low, high, (count, 2)) * size / step) * step

    surfaces = []
    for _ in range(int(rng.choice([1, 1, 2, 3]))):
        xy = draw(int(rng.integers(3, 50)))
        z = np.round(300 + relief * rng.uniform(-1, 1, len(xy)), 3)
        surfaces.append(np.column_stack([xy + _CRSS[crs], z]).round(3).tolist())
    hole = None
    if rng.random() < 0.3:
        middle, half = draw(1, 0.3, 0.7)[0], size * float(rng.uniform(0.05, 0.2))
        corners = middle + np.round(half / step + 1) * step * np.array(
            [[-1, -1], [1, -1], [1, 1], [-1, 1]]
        )
        hole = (corners + _CRSS[crs]).round(3).tolist()
    line = draw(int(rng.integers(2, 6)), -0.2, 1.2) + _CRSS[crs]
    if rng.random() < 0.4:  # along edges, and through vertices
        some = np.array(surfaces[0])[:, :2]
        line = some[rng.integers(0, len(some), len(line))]
    return {"crs": crs, "surfaces": surfaces, "hole": hole, "line": line.round(3).tolist()}


def examine(case: Case) -> str:
    """Draw the line in the page; every row is one of the library's, and the reverse."""
    line = np.array(case["line"])
    line = line[np.r_[True, (np.diff(line, axis=0) != 0).any(axis=1)]]
    if len(line) < 2:
        return "a point"
    more = {} if case["hole"] is None else {"holes": [case["hole"]]}
    unit = "ft" if case["crs"] == "EPSG:2274" else "m"
    try:
        tins = {
            f"S{k}": ts.triangulate(rows, crs=case["crs"] or None, elevation_unit=unit, **more)
            for k, rows in enumerate(case["surfaces"])
        }
    except ts.TinsmithError:
        return "refused: points"
    try:
        truth = ts.profile(tins, line).to_dataframe()
    except ts.TinsmithError:
        return "refused: profile"
    header, rows = ask(tins, line)
    elevations = [name for name in truth.columns if name.startswith("elevation")]
    # Beside the surfaces the page shows cut and fill, which is one of them once more.
    assert len(header) == 3 + len(tins), header
    ends = [find_boundary(tin) for tin in tins.values()]
    compare(truth[["station", *truth.columns[2:4], *elevations]].to_numpy(float), rows, ends)
    return f"{len(tins)} surfaces" + ("" if np.isfinite(rows[:, 3:]).all() else ", gaps")


def ask(tins: dict[str, ts.TIN], line: np.ndarray) -> tuple[list[str], np.ndarray]:
    """Return the header and the numbers of the section in the page."""
    page = _open()
    with tempfile.TemporaryDirectory() as folder:
        page.goto(ts.preview(tins).save(Path(folder, "a.html")).as_uri())
        text = page.evaluate(_SECTION, line.tolist())
    header, *rows = csv.reader(io.StringIO(text, newline=""))
    return header, np.array([[float(one or "nan") for one in row] for row in rows])


def find_boundary(tin: ts.TIN) -> Any:
    """Return the edges that only one triangle has."""
    triangle, corner = np.nonzero(tin.neighbors < 0)
    edges = [tin.triangles[triangle, (corner + k) % 3] for k in (1, 2)]
    return shapely.MultiLineString(list(tin.points[np.stack(edges, axis=1), :2]))


def compare(truth: np.ndarray, found: np.ndarray, boundaries: list[Any]) -> None:
    """Hold rows of (station, x, y, elevations) against each other, each on the lines of the other.

    Along an edge, and where one is crossed at a small angle, rounding may add a row or move it
    along the line: it lies on the straight between its neighbours. On the boundary itself a place
    may be taken for one outside: the page has rounded coordinates.
    """
    assert (np.diff(found[:, 0]) >= 0).all(), "stations go back"
    assert abs(found[-1, 0] - truth[-1, 0]) <= _STATION, "another length"
    for here, there, what in ((truth, found, "is missing"), (found, truth, "is none")):
        for row in here[np.isfinite(here[:, 3:]).any(axis=1)]:
            near = np.flatnonzero(np.abs(there[:, 0] - row[0]) <= _STATION)
            if len(near) > 0:
                apart = np.abs(there[near, 1:3] - row[1:3])
                assert (apart <= _STATION).all(axis=1).any(), f"another place at {row[0]}"
            for k in range(3, len(row)):
                values = there[near, k] if len(near) > 0 else between(there, row[0], k)
                finite = truth[np.isfinite(truth[:, k]), k].tolist() or [0.0]
                tolerance = _ELEVATION * (1 + np.ptp(finite))
                same = np.isnan(values) & np.isnan(row[k]) | (np.abs(values - row[k]) <= tolerance)
                if not same.any() and (np.isnan(row[k]) or np.isnan(values).all()):
                    same = boundaries[k - 3].distance(shapely.Point(row[1:3])) <= _ALONG
                touch = is_touch(truth, row[0], k)
                assert np.any(same) or touch, f"at {row[0]} {row[k]} {what}, {values}"


def between(rows: np.ndarray, station: float, k: int) -> np.ndarray:
    """Return the elevation on the straight between the rows before and after a station."""
    after = int(np.searchsorted(rows[:, 0], station))
    (a, *_), (b, *_) = rows[after - 1], rows[after]
    share = (station - a) / (b - a)
    return np.array([rows[after - 1, k] + share * (rows[after, k] - rows[after - 1, k])])


def is_touch(truth: np.ndarray, station: float, k: int) -> bool:
    """Tell whether a line only touches a surface at a station: the page draws no such point."""
    at = int(np.abs(truth[:, 0] - station).argmin())
    beside = [truth[j, k] for j in (at - 1, at + 1) if 0 <= j < len(truth)]
    return bool(np.isnan(beside).all())


@functools.cache
def _open() -> Any:
    """Open a page, into which others are loaded; a process has one."""
    folder = Path(tempfile.mkdtemp())
    path = ts.preview(ts.triangulate(np.eye(3))).save(folder / "a.html")
    keep = open_page(path, viewport={"width": 600, "height": 400})
    page = keep.__enter__()
    page.keep = keep
    return page


CAMPAIGNS = (
    Campaign(
        "page sections",
        "sections in the page against ts.profile",
        generate,
        examine,
        seconds=120.0,
        megabytes=2**30,  # a browser reserves addresses that it never fills
        weight=20,
    ),
)
