"""Plans of random surfaces on random papers, read back from SVG and measured."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from support.point_sets import grid
from support.printed import Page, georeference, read_svg

import tinsmith as ts

from .campaign import Campaign, Case

PAPERS = ("A4", "A3", "A1", "letter", "ANSI C", "ARCH D", (190, 190), (777.7, 321.5))
CRSS = {"EPSG:32616": (500_000, 4e6), "EPSG:2274": (2e6, 6e5), "EPSG:2222": (7e5, 9e5)}
METRES = {"EPSG:32616": 1.0, "EPSG:2274": 1200 / 3937, "EPSG:2222": 0.3048}


def generate(rng: np.random.Generator) -> Case:
    """A cloud, a winding corridor or a ring of points, on some paper at some scale."""
    shape = str(rng.choice(["cloud", "corridor", "corridor", "grid", "ring"]))
    size = float(10 ** rng.uniform(0.5, 4))
    crs = str(rng.choice(list(CRSS)))
    xy = size * make_shape(shape, rng)
    z = size * 0.05 * np.sin(xy[:, 0] / size * 9) + rng.normal(0, 0.01 * size, len(xy))
    relief = float(rng.choice([0.0, 1.0, 30.0]))
    layout = str(rng.choice(["single", "rows", "strips", "strips"]))
    return {
        "points": np.column_stack(
            [(xy + CRSS[crs]).round(3), (relief * z + 300).round(2)]
        ).tolist(),
        "max_edge": None if rng.random() < 0.5 else size * float(rng.choice([0.15, 0.4])),
        "lines": [rng.integers(0, len(xy), 4).tolist() for _ in range(int(rng.integers(3)))],
        "soft": bool(rng.random() < 0.5),
        "crs": crs,
        "paper": PAPERS[int(rng.integers(len(PAPERS)))],
        "layout": layout,
        "scale": choose_scale(rng, size) if layout != "single" or rng.random() < 0.4 else None,
        "labels": str(rng.choice(["index", "all", "none"])),
        "points_drawn": str(rng.choice(["none", "marks", "elevations"])),
        "grid": str(rng.choice(["crosses", "lines"])),
        "spots": choose_spots(rng, size),
        "axis": rng.integers(0, len(xy), int(rng.integers(2, 6))).tolist(),
        "has_axis": bool(rng.random() < 0.5),
        "station_interval": size * float(10 ** rng.uniform(-1.5, 0)),
        "station_range": np.sort(rng.uniform(0, 1, 2)).tolist() if rng.random() < 0.5 else None,
        "label_size": float(rng.choice([0.8, 1.1, 3.5])),
        "rows": int(rng.integers(-1, 9)),
        "revisions": int(rng.integers(0, 11)),
    }


def choose_spots(rng: np.random.Generator, size: float) -> Any:
    return (None, "peaks", round(size * float(rng.uniform(0.05, 0.5)), 3))[int(rng.integers(3))]


def make_axis(case: Case) -> Any:
    """A line along some of the points, with stations, and a range of them for strips."""
    vertices = np.array(case["points"])[case["axis"], :2]
    kept = np.append(True, (vertices[1:] != vertices[:-1]).any(axis=1))
    if not case["has_axis"] or kept.sum() < 2:
        return {}
    line = vertices[kept]
    how = {"axis": line, "station_interval": case["station_interval"]}
    if case["station_range"] is not None and case["layout"] == "strips":
        begin, end = case["station_range"]
        length = shapely.LineString(line).length
        if end - begin > 1e-6:
            how["station_range"] = (begin * length, end * length)
    return how


def require_stations(page: Page, along: Any) -> None:
    """Every station that is written has a tick where the axis has it."""
    ground, labels = georeference(page), page.named("station-label")
    if ground is None or not labels:
        return
    ticks = [one.mean(axis=0) for one in page.paths["station-ticks"] if len(one) == 2]
    places = ground.to_ground(np.array(ticks))
    line = shapely.LineString(along["axis"])
    for label in labels:
        wanted = np.array(line.interpolate(float(label.text)).coords[0])
        nearest = float(np.hypot(*(places - wanted).T).min())
        near = 0.2 * max(ground.units_per_mm) + 1e-3
        is_cut = np.abs(label.place - np.clip(label.place, *_inset(page))).max() > 0
        assert nearest <= near or is_cut, f"station {label.text} is {nearest} from a tick"


def _inset(page: Page) -> Any:
    """Return the corners of the frame, so much inside that no tick there is cut."""
    left, low, right, top = page.frame
    return np.array([left + 14.0, low + 14.0]), np.array([right - 14.0, top - 14.0])


def make_block(case: Case) -> Any:
    """A title block of so many rows and revisions, of words of any length."""
    if case["rows"] < 0:
        return None
    words = ["W" * (7 * k % 101) for k in range(10)]
    rows = {f"Row {k}": words[k] for k in range(case["rows"])}
    revisions = [{"mark": "A", "text": word} for word in words[: case["revisions"]]]
    return {"company": words[case["rows"]], "client": "x", "rows": rows, "revisions": revisions}


def make_shape(shape: str, rng: np.random.Generator) -> Any:
    count = int(rng.integers(3, 120))
    if shape == "cloud":
        return rng.random((count, 2)) * [1.0, rng.choice([0.1, 1.0])]
    if shape == "grid":
        return grid(*rng.integers(2, 9, 2)) / 8
    t = np.sort(rng.random(count))
    if shape == "ring":
        t = 2 * np.pi * t
        around = np.column_stack([np.cos(t), np.sin(t)])
        return np.concatenate([around, 0.9 * around])
    turn = rng.uniform(0, 2 * np.pi)
    way = np.column_stack([t, rng.choice([0, 0.2]) * np.sin(rng.uniform(2, 8) * t)])
    both = np.concatenate([way, way + np.array([0.0, 0.04])])
    return both @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])


def choose_scale(rng: np.random.Generator, size: float) -> Any:
    denominator = size * float(10 ** rng.uniform(-0.3, 0.8))
    if rng.random() < 0.3:
        return f"1\" = {max(1, round(denominator / 12))}'"
    return max(1, round(denominator))


def draw(tin: Any, case: Case, along: Any) -> Any:
    """Return the plan, or how it was refused."""
    paper = case["paper"] if isinstance(case["paper"], str) else tuple(case["paper"])
    try:
        return ts.plan(
            tin, scale=case["scale"], paper=paper, layout=case["layout"],
            labels=case["labels"], points=case["points_drawn"], grid=case["grid"],
            spots=case["spots"], label_size=case["label_size"], title_block=make_block(case),
            **along,
        )  # fmt: skip
    except ts.OptionError as error:
        if error.option not in ("scale", "paper"):
            raise
        return f"refused: {error.option}"
    except ts.LinesError:
        if not along:
            raise
        return "refused: axis"


def examine(case: Case) -> str:
    """Ask for sheets that measure right, cover the surface and are labelled truly."""
    tin = build(case)
    if tin is None:
        return "refused: points"
    along = make_axis(case)
    made = draw(tin, case, along)
    if isinstance(made, str):
        return made
    if "station_range" not in along:
        require_cover(tin, made)
    if len(made) > 12:
        return "many sheets"
    with tempfile.TemporaryDirectory() as folder:
        for number, file in enumerate(made.save(Path(folder, "plan.svg"))):
            page = read_svg(file)
            is_index = number == 0 and len(made) > 1
            require_page(page, made)
            require_scale(page, made, case["crs"], is_index=is_index)
            if not is_index:
                require_labels(page, tin, made)
                require_marks(page, tin)
                require_stations(page, along)
    return "one sheet" if len(made) == 1 else case["layout"]


def build(case: Case) -> Any:
    points = np.array(case["points"])
    kind = "soft" if case["soft"] else "hard"
    lines = [ts.Breakline(points[rows], kind=kind) for rows in case["lines"] if len(set(rows)) == 4]
    try:
        return ts.triangulate(
            points, breaklines=lines, max_edge=case["max_edge"], crs=case["crs"], elevation_unit="m"
        )
    except ts.TinsmithError:
        return None


def require_cover(tin: Any, made: Any) -> None:
    frames = made.frames if len(made) == 1 else made.frames[1:]
    slack = 1e-9 * float(np.abs(tin.points[:, :2]).max())
    seen = shapely.union_all([shapely.Polygon(frame) for frame in frames]).buffer(slack)
    ground = shapely.union_all(shapely.polygons(tin.points[tin.triangles][:, :, :2]))
    missing = shapely.difference(ground, seen).area
    assert missing <= 1e-9 * ground.area, f"{missing} of {ground.area} is on no sheet"


def require_page(page: Page, made: Any) -> None:
    assert np.allclose((page.width, page.height), made.paper, atol=1e-5), "size of the paper"
    left, low, right, top = page.frame
    for name, paths in page.paths.items():
        for path in paths:
            assert (path >= -1e-5).all(), f"{name} leaves the paper"
            assert (path <= np.array(made.paper) + 1e-5).all(), f"{name} leaves the paper"
            if name.endswith(("contours", "-lines", "crosses", "points")) or name == "outline":
                assert (path >= np.array([left, low]) - 1e-5).all(), f"{name} leaves the frame"
                assert (path <= np.array([right, top]) + 1e-5).all(), f"{name} leaves the frame"


def require_scale(page: Page, made: Any, crs: str, *, is_index: bool) -> None:
    ground = georeference(page)
    if ground is None:
        return
    denominator = made.scale
    if is_index:
        (text,) = [one.text for one in page.named("fact") if one.text.startswith(("1:", '1"'))]
        denominator = float(text.split(":")[1].rstrip(")")) if "(" not in text else None
    if denominator is not None:
        expected = denominator / 1000 / METRES[crs]
        assert np.allclose(ground.units_per_mm, expected, rtol=2e-4), (
            f"{ground.units_per_mm} on paper where 1:{denominator} is {expected}"
        )


def require_labels(page: Page, tin: Any, made: Any) -> None:
    ground = georeference(page)
    for label in page.named("contour-label"):
        turned = (label.rotation + 180.0) % 360.0 - 180.0
        assert -90.001 <= turned <= 90.001, f"{label.text} is upside down"
        ratio = float(label.text) / made.interval
        assert abs(ratio - round(ratio)) < 1e-6, f"{label.text} is no level"
        if ground is None:
            continue
        up = np.radians(label.rotation + 90.0)
        center = label.place + 0.365 * label.size * np.array([np.cos(up), np.sin(up)])
        assert reaches(tin, ground, center, float(label.text)), f"{label.text} is not there"


def reaches(tin: Any, ground: Any, center: Any, level: float) -> bool:
    """Whether the surface within a millimetre of a place is at a level."""
    steps = np.linspace(-1.0, 1.0, 41)  # a disc, for the ground may be a narrow valley
    disc = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    found = tin.interpolate(ground.to_ground(center + disc[np.hypot(*disc.T) <= 1.0]))
    if np.isnan(found).any():
        return True  # at the edge of the surface
    return bool(found.min() <= level + 1e-9 and found.max() >= level - 1e-9)


def require_marks(page: Page, tin: Any) -> None:
    """Labels of points meet no other, and spot heights are the surface where they are."""
    texts = [*page.named("point-elevation"), *page.named("spot-elevation")]
    boxes = []
    for one in texts:
        width, (x, y) = 0.5 * one.size * len(one.text), one.place
        x -= width if one.anchor == "end" else 0.0
        boxes.append(shapely.box(x, y, x + width, y + 0.7 * one.size))
    shapes = np.array(boxes, object)
    pairs = shapely.STRtree(shapes).query(shapes, predicate="overlaps")
    assert pairs.shape[1] == 0, f"{texts[pairs[0][0]].text} meets {texts[pairs[1][0]].text}"
    spots, ground = page.named("spot-elevation"), georeference(page)
    arms = page.paths.get("spots", [])
    assert len(arms) == 2 * len(spots), "a spot height has one mark"
    for text, arm in zip(spots, arms[::2], strict=True):
        if ground is not None:
            center = arm.mean(axis=0)
            disc = center + np.stack(np.meshgrid(*[np.linspace(-0.05, 0.05, 5)] * 2), -1)
            found = tin.interpolate(ground.to_ground(disc.reshape(-1, 2)))
            low, high = float(text.text) - 0.0051, float(text.text) + 0.0051
            known = found[np.isfinite(found)]
            if len(known) == len(found):
                assert known.min() <= high, f"{text.text} is not there"
                assert known.max() >= low, f"{text.text} is not there"


CAMPAIGNS = (Campaign("plans", "sheets of paper, measured", generate, examine),)
