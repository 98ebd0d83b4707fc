"""Corridors: sections of the nearest station, slopes as asked, and the ground beyond."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import shapely

import tinsmith as ts

from .campaign import Campaign, Case

_SIZE = 160.0
_REFUSED = {
    "width": "Invalid width 0.0",
    "ground": "does not meet the ground",
    "edge": "The corridor lies off",
    "self": "lies over itself",
    "axis": "There is no room for the curves",
    "bend": "cannot be laid out near station",
    "sharp": "the axis has to turn less sharply there",
    "end": "side slopes reach an end of the axis",
}
"""What may be refused, and the sentences."""
_MICRON = 1e-6
"""Side slopes of a rise so small have no triangle: coordinates of millions cannot tell its corners
apart. The step that is left at the seam is told."""
_NAMES = {-1: "left", 1: "right"}


def generate(rng: np.random.Generator) -> Case:
    """A rough ground, an axis with bends of all kinds, and a template with kerbs and ditches."""
    origin = [500_000.0, 4_000_000.0] if rng.random() < 0.5 else [0.0, 0.0]
    corners = [[0, 0], [_SIZE, 0], [_SIZE, _SIZE], [0, _SIZE]]
    xy = np.concatenate([rng.uniform(0, _SIZE, (150, 2)), corners])
    rough = float(rng.choice([0.0, 0.2, 1.0]))
    z = 50 + xy @ rng.normal(0, 0.02, 2) + rng.normal(0, 1, len(xy)) * rough
    points = [np.array([50.0, 50.0]) + rng.uniform(-8, 8, 2)]
    heading = float(rng.uniform(0, 1.5))
    for _ in range(int(rng.integers(1, 4))):
        step = rng.uniform(18, 35)
        points.append(points[-1] + step * np.array([np.cos(heading), np.sin(heading)]))
        heading += float(rng.choice([rng.normal(0, 0.5), rng.normal(0, 1.2)]))
    level = float(rng.choice([0.0, rng.normal(0, 0.03)]))
    return {
        "ground": np.column_stack([xy + origin, z]).tolist(),
        "points": (np.array(points) + origin).tolist(),
        "radius": float(rng.choice([0.0, 2.0, 6.0, 12.0])),
        "transition": float(rng.choice([0.0, 0.0, 3.0])),
        "profile": [
            50 + float(rng.normal(0, 1)),
            level,
            float(rng.choice([0.0, rng.normal(0, 1)])),
        ],
        "left": _draw_side(rng),
        "right": _draw_side(rng),
        "widening": float(rng.choice([0.0, 0.0, 1.5])),
        "superelevation": float(rng.choice([0.0, 0.0, 0.06])),
        "tolerance": float(rng.choice([0.01, 0.05])),
        "places": rng.uniform(0, 1, (300, 2)).tolist(),
        "ring": (_draw_ring(rng) + origin).tolist() if rng.random() < 0.25 else None,
    }


def _draw_ring(rng: np.random.Generator) -> Any:
    """Corners of a polygon around the middle of the ground."""
    count = int(rng.integers(3, 8))
    angles = np.sort(rng.uniform(0.0, 2.0 * np.pi, count)) * float(rng.choice([-1.0, 1.0]))
    away = rng.uniform(8.0, 30.0, count)
    return 0.5 * _SIZE + away[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])


def _draw_side(rng: np.random.Generator) -> dict[str, Any]:
    parts = [["lane", float(rng.uniform(1, 4)), float(rng.normal(0, 0.03)), 0.0]]
    if rng.random() < 0.4:
        parts.append(["kerb", 0.0, 0.0, float(rng.choice([-0.1, 0.12]))])
        parts.append(["path", float(rng.uniform(0.5, 2)), float(rng.normal(0, 0.02)), 0.0])
    ditch = [["foreslope", 0.8, -0.4, 0.0], ["bottom", 0.4, 0.0, 0.0]]
    return {
        "parts": parts if rng.random() < 0.9 else [],
        "ditch": ditch if rng.random() < 0.4 else [],
        "cut_slope": float(rng.choice([0.5, 1, 2])),
        "fill_slope": float(rng.choice([1, 1.5, 2])),
    }


def _make_side(drawn: dict[str, Any], wider: float = 0.0) -> Any:
    parts = [
        ts.Part(name, width + wider * (name == "lane"), slope, rise, turns=name == "lane")
        for name, width, slope, rise in drawn["parts"]
    ]
    ditch = [ts.Part(*one) for one in drawn["ditch"]]
    slopes = {name: drawn[name] for name in ("cut_slope", "fill_slope")}
    return ts.Side(parts, ditch=ditch, **slopes)


def examine(case: Case) -> str:
    """Build the corridor, and compare it with the section of the nearest station."""
    try:
        ground = ts.triangulate(case["ground"])
        axis = _make_axis(case)
        middle = 0.5 * (axis.start + axis.end)
        sides = case["left"], case["right"]
        template = {
            axis.start: ts.Template(*map(_make_side, sides)),
            middle: ts.Template(*(_make_side(one, case["widening"]) for one in sides)),
        }
        table = None
        if case["superelevation"]:
            q = case["superelevation"]
            table = [[axis.start, -0.02, -0.02], [middle, q, -q]]
        if case["ring"]:
            template[axis.end] = template[axis.start]
            table = table and [*table, [axis.end, -0.02, -0.02]]
        made = ts.corridor(
            ground, axis, template, superelevation=table, tolerance=case["tolerance"]
        )
    except (ts.OptionError, ts.PointsError, ts.LinesError) as error:
        known = [word for word, sentence in _REFUSED.items() if sentence in str(error)]
        if not known:
            raise
        return f"refused: {known[0]}"
    found = ts.check(made)
    assert found.ok, [one.sentence for one in found.problems]
    notes = " ".join(made.report.notes)
    seams = re.findall(r"Along the seam [^:]*by up to ([\d.e+-]*\d)", notes)
    assert all(float(one) <= _MICRON for one in seams), notes
    assert abs(made.area - ground.area) <= 1e-9 * ground.area
    steps = [float(one) for one in re.findall(r"differ by up to ([\d.e+-]*\d)", notes + " ")]
    sections = _Sections(case, axis, middle)
    _require_lines(made, sections)
    _require_heights(case, ground, made, sections, max(steps, default=0.0))
    return "cut off" if "as near" in notes else "whole"


def _make_axis(case: Case) -> Any:
    points = np.array(case["points"])
    if case["ring"]:
        points = np.array([*case["ring"], case["ring"][0]])
    curves = {} if len(points) < 3 else {"radii": case["radius"]}
    if case["radius"] and len(points) > 2:
        turns = np.abs(np.angle(np.exp(1j * np.diff(np.arctan2(*np.diff(points, axis=0).T)))))
        curves["transitions"] = min(case["transition"], 0.9 * case["radius"] * turns.min())
    axis = ts.Alignment.from_points(points, **curves)
    level, rate, bend = case["profile"]
    middle, half = 0.5 * (axis.start + axis.end), 0.2 * axis.length
    tops = [level, level + rate * axis.length / 2 + bend, level + rate * axis.length]
    stations = (axis.start, middle, axis.end)
    if case["ring"]:
        tops[2] = tops[0]
    curve = ("parabola", half, half)
    rows = [
        ts.VerticalPoint(station, top, *(curve if k == 1 else ()))
        for k, (station, top) in enumerate(zip(stations, tops, strict=True))
    ]
    return replace(axis, verticals=[ts.VerticalAlignment(rows)])


class _Sections:
    """The section at any station, of the numbers of the case."""

    def __init__(self, case: Case, axis: Any, middle: float) -> None:
        self._case, self.axis, self._middle = case, axis, middle

    def locate(self, xy: Any) -> tuple[Any, Any]:
        """Return stations and offsets; where a ring closes those of its corner."""
        table = self.axis.stations_of(xy)
        station, offset = np.array(table["station"]), np.array(table["offset"])
        if self._case["ring"]:
            beyond = np.flatnonzero(np.isnan(station))
            corner, ring = self.axis.points_at([self.axis.start])[0], self._case["ring"]
            inside = shapely.contains_xy(shapely.Polygon(ring), xy[beyond])
            is_left = inside == shapely.LinearRing(ring).is_ccw
            station[beyond] = self.axis.start
            offset[beyond] = np.where(is_left, -1.0, 1.0) * np.hypot(*(xy[beyond] - corner).T)
        return station, offset

    def list_lines(self, side: int, station: float, what: str = "parts") -> list[tuple[Any, ...]]:
        """Return name, offset and height above the axis of each line."""
        share = (station - self.axis.start) / (self._middle - self.axis.start)
        share = min(share, 2.0 - share) if self._case["ring"] else min(share, 1.0)
        share = max(share, 0.0)
        offset = height = 0.0
        lines = []
        for name, width, slope, rise in self._case[_NAMES[side]][what]:
            drawn = width
            if name == "lane":
                drawn += share * self._case["widening"]
                if self._case["superelevation"]:
                    last = -side * self._case["superelevation"]
                    slope = -0.02 + share * (last + 0.02)
            drawn = max(drawn, 0.001) if rise else drawn
            offset, height = offset + drawn, height + drawn * slope + rise
            lines.append((name, offset, height))
        return lines

    def measure(self, side: int, station: float, offset: float) -> tuple[float, float, float]:
        """Return the elevation of the bed, or those of a cut and a fill."""
        axis = float(self.axis.elevations_at([station])[0])
        rows = [("axis", 0.0, 0.0), *self.list_lines(side, station)]
        offsets, heights = [one[1] for one in rows], [one[2] for one in rows]
        if offset <= offsets[-1]:
            bed = axis + float(np.interp(offset, offsets, heights))
            return bed, bed, offsets[-1]
        ditch = [("", 0.0, 0.0), *self.list_lines(side, station, "ditch")]
        drawn = self._case[_NAMES[side]]
        away, foot = offset - offsets[-1], axis + heights[-1]
        cut = foot + float(np.interp(away, [d[1] for d in ditch], [d[2] for d in ditch]))
        cut += max(away - ditch[-1][1], 0.0) / drawn["cut_slope"]
        return cut, foot - away / drawn["fill_slope"], offsets[-1]


def _require_lines(made: Any, sections: _Sections) -> None:
    """Ask for each line of the template along stations that are nearest to it."""
    axis = sections.axis
    lines = made.lines
    for side in (-1, 1):
        for station in np.linspace(axis.start + 1e-6, axis.end - 1e-6, 7).tolist():
            for name, offset, _ in [("axis", 0.0, 0.0), *sections.list_lines(side, station)]:
                place = axis.points_at([station], offset=side * offset)
                back = axis.stations_of(place)
                if not abs(float(back["offset"][0]) - side * offset) <= 1e-6:
                    continue
                chains = [
                    shapely.LineString(made.points[chain, :2])
                    for chain, own in zip(lines.chains(), lines.names, strict=True)
                    if own in (name, "hinge")
                ]
                away = shapely.distance(shapely.multilinestrings(chains), shapely.Point(place[0]))
                assert away <= sections._case["tolerance"] + 2e-3, f"no '{name}' at {station}"


def _require_heights(case: Case, ground: Any, made: Any, sections: _Sections, step: float) -> None:
    bounds = ground.bounds
    axis = sections.axis
    middle = axis.points_at([0.5 * (axis.start + axis.end)])[0]
    wide = 60.0 * (np.array(case["places"][:200]) - 0.5) + middle
    along = np.array(case["places"][200:]) * [axis.length, 12.0]
    near = axis.points_at(axis.start + along[:, 0], offset=along[:, 1] - 6.0)
    xy = np.concatenate([wide, near])
    inside = (xy > [bounds.xmin, bounds.ymin]) & (xy < [bounds.xmax, bounds.ymax])
    xy = xy[inside.all(axis=1)]
    own, found = ground.interpolate(xy), made.interpolate(xy)
    stations, offsets = sections.locate(xy)
    for k in range(len(xy)):
        station, offset = float(stations[k]), float(offsets[k])
        is_ground = abs(found[k] - own[k]) <= 1e-6
        if np.isnan(station):
            ends = np.array([axis.start, axis.end])
            away = xy[k] - axis.points_at(ends)
            beyond = np.abs((away * axis.tangents_at(ends)).sum(axis=1)).min()
            assert is_ground or beyond < 0.01, f"the ground is another at {xy[k]}"
            continue
        side = -1 if offset < 0 else 1
        faces = [one[1] for one in sections.list_lines(side, station)]
        slack = case["tolerance"]
        if min((abs(abs(offset) - one) for one in faces), default=1.0) <= 2 * slack + 2e-3:
            continue
        cut, fill, hinge = sections.measure(side, station, abs(offset))
        allowed = 2.0 * slack + 2.0 * slack * 2.0 * (abs(offset) > hinge) + step + 1e-6
        errors = min(abs(found[k] - cut), abs(found[k] - fill))
        if abs(offset) <= hinge:
            assert errors <= allowed, f"bed off by {errors} at {station} {offset}"
        else:
            assert is_ground or errors <= allowed, f"slope off by {errors} at {station} {offset}"


CAMPAIGNS = (
    Campaign("corridors", "sections of the nearest station, slopes, ground", generate, examine),
)
