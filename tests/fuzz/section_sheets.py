"""Sheets of random cross sections on random papers, read back from SVG and DXF and measured."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
from support.printed import Page, read_svg

import tinsmith as ts

from .campaign import Campaign, Case

PAPERS = ("A4", "A3", "A1", "letter", "ANSI C", (190, 190), (777.7, 321.5))
CRSS = {"EPSG:32616": (500_000, 4e6), "EPSG:2274": (2e6, 6e5), None: (0.0, 0.0)}
METRES = {"EPSG:32616": 1.0, "EPSG:2274": 1200 / 3937, None: 0.3048}
BORDER = 8.0
MOST_DRAWN = 60


def generate(rng: np.random.Generator) -> Case:
    """Clouds of points, flat or steep, small or large, and an axis of some vertices."""
    crs = (*CRSS,)[int(rng.integers(len(CRSS)))]
    size = float(10 ** rng.uniform(-1, 4))
    relief = float(rng.choice([0.0, 0.01, 0.1, 1.0, 20.0])) * size
    level = float(rng.choice([0.0, 300.0, -50.0, 5000.0]))
    surfaces = []
    for _ in range(int(rng.integers(1, 4))):
        xy = size * rng.uniform(0.0, 1.0, (int(rng.integers(3, 60)), 2)) + CRSS[crs]
        z = level + relief * rng.uniform(0.0, 1.0, len(xy))
        surfaces.append(np.column_stack([xy.round(4), z.round(3)]).tolist())
    axis = size * rng.uniform(-0.1, 1.1, (int(rng.integers(2, 5)), 2)) + CRSS[crs]
    width = size * float(10 ** rng.uniform(-2, 0))
    return {
        "surfaces": surfaces,
        "crs": crs,
        "unit": str(rng.choice(["m", "ft"])),
        "axis": axis.round(4).tolist(),
        "interval": size * float(10 ** rng.uniform(-1.3, 0.2)),
        "left": width * float(rng.choice([0.0, 0.3, 0.5])),
        "right": width * float(rng.choice([0.5, 1.0])),
        "paper": PAPERS[int(rng.integers(len(PAPERS)))],
        "scale": None
        if rng.random() < 0.5
        else float(round(size * 10 ** rng.uniform(0, 1.2)) or 1),
        "exaggeration": float(rng.choice([1.0, 1.0, 2.0, 10.0])),
    }


def examine(case: Case) -> str:
    """Ask for each section once, whole, at scale, within the border of a sheet."""
    try:
        tins = [
            ts.triangulate(points, crs=case["crs"], elevation_unit=case["unit"])
            for points in case["surfaces"]
        ]
    except ts.TinsmithError:
        return "refused: points"
    where = {name: case[name] for name in ("interval", "left", "right")}
    try:
        table = ts.cross_sections(tins, case["axis"], **where)
    except ts.TinsmithError:
        return "refused: sections"
    paper = case["paper"] if isinstance(case["paper"], str) else tuple(case["paper"])
    try:
        made = ts.section_sheets(
            tins, case["axis"], **where, scale=case["scale"], paper=paper,
            exaggeration=case["exaggeration"],
            ground_unit="ft" if case["crs"] is None else None,
        )  # fmt: skip
    except ts.OptionError as error:
        if error.option not in ("scale", "paper"):
            raise
        return f"refused: {error.option}"
    count = len(np.unique(table["section"]))
    assert made.sections == count, f"{made.sections} sections, not {count}"
    if count > MOST_DRAWN:
        return "many sections"
    with tempfile.TemporaryDirectory() as folder:
        pages = [read_svg(file) for file in made.save(Path(folder, "a.svg"))]
        require_sections(pages, table, made, case)
        (file,) = made.save(Path(folder, "a.dxf"))
        require_drawing(file, table)
    return "one sheet" if len(made) == 1 else "several sheets"


def require_sections(pages: list[Page], table: Any, made: Any, case: Case) -> None:
    """Each station stands on one sheet; lines measure as the table has them, within the border."""
    stations = [text.text for page in pages for text in page.named("station-label")]
    count = len(np.unique(table["section"]))
    assert len(stations) == len(set(stations)) == count, "a section is missing, or drawn twice"
    along = METRES[case["crs"]] * 1000 / made.scale
    up = (1.0 if case["unit"] == "m" else 0.3048) * 1000 / made.scale * case["exaggeration"]
    for number in range(len(case["surfaces"])):
        drawn = [path for page in pages for path in page.paths.get(f"surface{number + 1}", [])]
        runs = list_runs(table, number)
        assert len(drawn) == len(runs), f"surface {number + 1} has {len(drawn)} lines"
        for path, (offsets, heights) in zip(drawn, runs, strict=True):
            expected = np.column_stack([offsets * along, heights * up])
            slack = 1e-4 + 1e-6 * np.abs(expected - expected[0]).max()
            off = np.abs((path - path[0]) - (expected - expected[0])).max()
            assert off <= slack, f"a line is {off} mm off"
    require_border(pages, made)


def require_border(pages: list[Page], made: Any) -> None:
    """All that is drawn lies within the border of the paper."""
    for page in pages:
        assert np.allclose((page.width, page.height), made.paper, atol=1e-5), "size of the paper"
        for name, paths in page.paths.items():
            for path in paths:
                low, high = path.min(axis=0), path.max(axis=0)
                inside = (low >= BORDER - 1e-4).all()
                inside &= (high <= np.array(made.paper) - BORDER + 1e-4).all()
                assert inside or name.startswith("patch") or not name, f"{name} leaves the border"


def list_runs(table: Any, number: int) -> list[tuple[Any, Any]]:
    """Return offsets and elevations wherever a surface goes on."""
    name = f"elevation_{number + 1}"
    found = []
    for section in np.unique(table["section"]):
        own = table["section"] == section
        offsets, heights = table["offset"][own], table[name][own]
        known = np.flatnonzero(np.isfinite(heights))
        for run in np.split(known, np.flatnonzero(np.diff(known) > 1) + 1):
            if len(run) > 1:
                found.append((offsets[run], heights[run]))
    return found


def require_drawing(file: Path, table: Any) -> None:
    """A drawing is sound, and has all lines in the unit of the ground."""
    document = ezdxf.readfile(file)
    assert not document.audit().errors, "the drawing has errors"
    runs = list_runs(table, 0)
    lines = document.modelspace().query('LWPOLYLINE[layer=="1"]')
    assert len(lines) == len(runs), f"{len(lines)} lines on the layer of the first surface"
    for line, (offsets, _) in zip(lines, runs, strict=True):
        x = np.array(line.get_points("xy"))[:, 0]
        slack = 1e-9 * float(np.abs(x).max()) + 1e-9
        assert np.allclose(x - x[0], offsets - offsets[0], rtol=1e-9, atol=slack), "scale of DXF"


# ---------------------------------------------------------------- long profiles


def generate_profile(rng: np.random.Generator) -> Case:
    """The same surfaces and axes, and a gradient line with parabolas."""
    case = generate(rng)
    heights = np.concatenate([np.array(points)[:, 2] for points in case["surfaces"]])
    count = int(rng.integers(0, 6))
    shares = np.sort(rng.uniform(-0.1, 1.1, count))
    levels = rng.uniform(heights.min(), heights.max(), count)
    curves = rng.uniform(0.0, 0.45, count).round(3)
    return case | {"points": np.column_stack([shares, levels, curves]).tolist()}


def make_vertical(case: Case, length: float) -> Any:
    """A gradient line whose curves take less than the half of the tangents beside them."""
    rows = np.array(case["points"]).reshape(-1, 3)
    if len(rows) < 2:
        return None
    stations = rows[:, 0] * length
    gaps = np.diff(stations)
    points = [ts.VerticalPoint(stations[0], rows[0, 1])]
    for k in range(1, len(rows) - 1):
        reach = rows[k, 2] * min(gaps[k - 1], gaps[k])
        curve = {"kind": "parabola", "length_in": reach, "length_out": reach} if reach > 0 else {}
        points.append(ts.VerticalPoint(stations[k], rows[k, 1], **curve))
    return ts.VerticalAlignment([*points, ts.VerticalPoint(stations[-1], rows[-1, 1])])


def examine_profile(case: Case) -> str:
    """Ask for the whole profile, at scale, however many sheets it takes."""
    try:
        tins = [
            ts.triangulate(points, crs=case["crs"], elevation_unit=case["unit"])
            for points in case["surfaces"]
        ]
        table = ts.profile(tins, case["axis"])
        vertical = make_vertical(case, float(table["station"][-1]))
    except ts.TinsmithError:
        return "refused: input"
    paper = case["paper"] if isinstance(case["paper"], str) else tuple(case["paper"])
    try:
        made = ts.profile_sheets(
            tins, case["axis"], vertical=vertical, scale=case["scale"], paper=paper,
            exaggeration=case["exaggeration"],
            ground_unit="ft" if case["crs"] is None else None,
        )  # fmt: skip
    except ts.OptionError as error:
        if error.option not in ("scale", "paper"):
            raise
        return f"refused: {error.option}"
    if len(made) > 20:
        return "many sheets"
    with tempfile.TemporaryDirectory() as folder:
        pages = [read_svg(file) for file in made.save(Path(folder, "a.svg"))]
    require_border(pages, made)
    require_course(pages, table, made, case)
    return "one sheet" if len(made) == 1 else "several sheets"


def require_course(pages: list[Page], table: Any, made: Any, case: Case) -> None:
    """Over all sheets lines are as long, and rise and fall as much, as the table has them."""
    along = METRES[case["crs"]] * 1000 / made.scale
    up = (1.0 if case["unit"] == "m" else 0.3048) * 1000 / made.scale * case["exaggeration"]
    frames = [page.paths["frame-of-section"][0] for page in pages]
    stations = table["station"]
    drawn = sum(float(np.ptp(frame[:, 0])) for frame in frames)
    assert np.isclose(drawn, np.ptp(stations) * along, rtol=1e-6, atol=1e-3), "length of the sheets"
    for number in range(len(case["surfaces"])):
        heights = table[f"elevation_{number + 1}"]
        steps = np.isfinite(heights[:-1]) & np.isfinite(heights[1:])
        wanted = (
            float(np.diff(stations)[steps].sum()) * along,
            float(np.abs(np.diff(heights))[steps].sum()) * up,
        )
        lines = [path for page in pages for path in page.paths.get(f"surface{number + 1}", [])]
        moves = [np.abs(np.diff(line, axis=0)).sum(axis=0) for line in lines]
        found = np.sum(moves, axis=0) if moves else np.zeros(2)
        slack = 1e-3 * (1 + len(stations))
        assert np.allclose(found, wanted, rtol=1e-5, atol=slack), f"{found} mm, not {wanted}"


CAMPAIGNS = (
    Campaign("section sheets", "drawn cross sections, measured", generate, examine),
    Campaign("profile sheets", "drawn long profiles, measured", generate_profile, examine_profile),
)
