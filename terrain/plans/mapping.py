"""Mapping: what is drawn of the ground within the frame of a sheet."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base import optional
from ...base.crs import scale_elevations
from ...base.results import Features
from ..drawing import palette, turn_upright
from ..isolines import contour_labels, count_decimals
from .clipping import Paths, clip_paths, join_paths
from .grid import draw_grid
from .paper import CAPITAL, Drawable, Pen, Room, measure_text, outline_text
from .windows import outline, turn

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from .contents import Contents
    from .point_labels import Marks
    from .stations import Stationed
    from .windows import MatchLine, Window

CONTOUR_PENS = {
    False: Pen(palette.CONTOURS_PLAN, 0.13),
    True: Pen(palette.INDEX_CONTOURS_PLAN, 0.35),
}
LINE_PENS = {
    "soft": Pen(palette.LINES["soft"], 0.25, (2.0, 1.0)),
    "hard": Pen(palette.LINES["hard"], 0.35),
    "hole": Pen(palette.LINES["hole"], 0.35, (4.0, 1.0, 0.8, 1.0)),
    "boundary": Pen(palette.LINES["boundary"], 0.5),
    "water": Pen(palette.LINES["water"], 0.35),
}
OUTLINE_PEN = Pen(palette.OUTLINE_PLAN, 0.25)
AXIS_PEN = Pen(palette.CURVES[1], 0.35, (8.0, 1.5, 1.0, 1.5))
MATCH_PEN = Pen(palette.MATCH_LINE, 0.5, (6.0, 2.0))
_FRAME_PEN = Pen(palette.INK_PLAN, 0.35)
_MARK_PEN = Pen(palette.INK_PLAN, 0.18)
_MARK = 0.7
"""Half a point's cross, millimetres."""
ARMS = {
    "point": _MARK * np.array([[(-1, 0), (1, 0)], [(0, -1), (0, 1)]]),
    "spot height": 0.5 * np.array([[(-1, -1), (1, 1)], [(-1, 1), (1, -1)]]),
}
"""Lines of marks, (2, 2, 2), millimetres from the point."""
_NAMES = {"point": "points", "spot height": "spots"}
_TICK = 1.3
"""Half a tick of a station, millimetres."""
_LETTERS = 2.0
_GAP = 0.3
"""Between a mark and its label."""
_SPACING = 110.0
"""Millimetres between the labels of a contour."""
_MATCH_INSET = 4.0
_MOST_MARK_LABELS = 20_000


@dataclass(eq=False)
class Drawn:
    """What was drawn on a sheet, for its legend and the notes."""

    kinds: set[str]
    """Of "contour", "index contour", "water area", "outline", "point", "spot height", "match line",
    and kinds of lines.
    """
    crowded: Counter[str] = field(default_factory=Counter)
    """Points and stations whose labels had no room, and spot heights that had none, by kinds."""


class _Text(NamedTuple):
    center: tuple[float, float]
    rotation: float
    text: str
    corners: Float64Array
    source: int  # the contour, or the station, that it is of


class Map:
    """The ground within the frame of a window, drawn on a sheet layer by layer."""

    def __init__(self, canvas: Drawable, window: Window, contents: Contents) -> None:
        self._canvas = canvas
        self._window = window
        self._contents = contents
        self._room = Room(window.frame)
        self.drawn = Drawn(set())

    def draw(self, *, labeling: str, grid: str, numbers: tuple[int, ...]) -> Drawn:
        """Draw water, grid, match lines, contours, lines, points and frame.

        ``labeling`` is "index", "all" or "none", ``grid`` "crosses", "lines" or "none"; ``numbers``
        are those of the sheet of each window, as match lines name them.
        """
        self._fill_water()
        draw_grid(self._canvas, self._window, grid, self._contents.axes)
        for match in self._window.matches:  # first, for their texts to have room
            self._draw_match(match, numbers[match.window])
        stations = self._place_stations()
        self._draw_contours(labeling)
        self._draw_linework()
        self._draw_stations(stations)
        self._draw_marks()
        self._draw_frame()
        return self.drawn

    def draw_outline(self, *, grid: str) -> Drawn:
        """Draw the edge, the lines and the water of a surface alone, with grid and frame."""
        self._fill_water()
        draw_grid(self._canvas, self._window, grid, self._contents.axes)
        self._draw_linework()
        self._draw_stations([])
        self._draw_frame()
        return self.drawn

    def _draw_linework(self) -> None:
        self._draw_paths(self._contents.outline, OUTLINE_PEN, "outline")
        for kind, paths in self._contents.linework.items():
            self._draw_paths(paths, LINE_PENS[kind], kind)

    def _place_stations(self) -> list[_Text]:
        """Take room for the stations of the axis, to its left if there is room, before contours."""
        axis, window = self._contents.axis, self._window
        if axis is None:
            return []
        seen, normals = self._find_ticks(axis)
        texts = []
        for number in np.flatnonzero(seen).tolist() if axis.texts else ():
            text, normal = axis.texts[number], normals[number]
            width = measure_text(text, _LETTERS)
            rotation = turn_upright(math.degrees(math.atan2(normal[1], normal[0])))
            place = window.to_paper(axis.places[number])
            for side in (1.0, -1.0):
                x, y = (place + side * (_TICK + 0.6 + width / 2) * normal).tolist()
                corners = outline_text((x, y), width, CAPITAL * _LETTERS, rotation)
                if self._room.take(corners):
                    texts.append(_Text((x, y), rotation, text, corners, number))
                    break
            else:
                self.drawn.crowded["station"] += 1
        return texts

    def _find_ticks(self, axis: Stationed) -> tuple[BoolArray, Float64Array]:
        """Tell which stations are within the frame, and return what is across the axis on paper."""
        places = self._window.to_paper(axis.places)
        west, south, east, north = _list_sides(self._window)
        x, y = places[:, 0], places[:, 1]
        is_seen = (x >= west) & (x <= east) & (y >= south) & (y <= north)
        return is_seen, turn(axis.directions, 90.0 - self._window.angle)

    def _draw_stations(self, texts: list[_Text]) -> None:
        """Draw the axis, a tick across it at each station, and the texts."""
        axis = self._contents.axis
        if axis is None:
            return
        self._draw_paths(Paths.whole(axis.line, np.array([0, len(axis.line)])), AXIS_PEN, "axis")
        seen, normals = self._find_ticks(axis)
        if axis.texts and seen.any():
            places, arms = self._window.to_paper(axis.places)[seen], _TICK * normals[seen]
            ticks = list(np.stack([places - arms, places + arms], axis=1))
            parts = clip_paths(join_paths(ticks), self._window.frame).parts()
            self._canvas.draw_paths(parts, AXIS_PEN._replace(dashes=()), "station-ticks")
        self._write(texts, AXIS_PEN.color, "station-label")

    def _write(self, texts: list[_Text], color: str, name: str) -> None:
        for text in texts:
            self._canvas.write(text.center, text.text, size=_LETTERS, color=color, name=name,
                               rotation=text.rotation, across="center",
                               up="center_baseline")  # fmt: skip

    def _draw_paths(self, paths: Paths, pen: Pen, kind: str) -> None:
        parts = clip_to_window(paths, self._window).parts()
        if parts:
            self._canvas.draw_paths(parts, pen, kind if kind == "outline" else f"{kind}-lines")
            self.drawn.kinds.add(kind)

    def _draw_frame(self) -> None:
        self._canvas.draw_paths([outline(self._window.frame)], _FRAME_PEN, "frame")

    def _fill_water(self) -> None:
        shapely = optional.load("shapely")
        box, footprint = shapely.box(*_list_sides(self._window)), self._contents.footprint
        for face in footprint.faces[footprint.is_water]:
            moved = shapely.make_valid(shapely.transform(face, self._window.to_paper))
            for part in shapely.get_parts(shapely.intersection(moved, box)):
                if shapely.area(part) > 0:
                    rings = [shapely.get_coordinates(ring) for ring in shapely.get_rings(part)]
                    self._canvas.fill(rings, palette.WATER, "water")
                    self.drawn.kinds.add("water area")

    # ---------------------------------------------------------------- contours

    def _draw_contours(self, labeling: str) -> None:
        lines, canvas = self._contents.contours, self._canvas
        seen = clip_to_window(Paths.whole(lines.coordinates[:, :2], lines.offsets[0]), self._window)
        is_index = lines.columns["is_index"]
        texts: list[_Text] = []
        if labeling != "none":
            texts = self._choose_labels(_place_labels(seen, lines, labeling))
        cut = _cut_out(seen, texts)
        levels = lines.columns["elevation"] * scale_elevations(lines.crs, lines.elevation_unit)
        for flag, kind in ((False, "contour"), (True, "index contour")):
            chosen = is_index == flag
            parts = cut.choose(chosen)
            if parts:
                heights = levels[cut.sources[chosen[cut.sources]]].tolist()
                pen = CONTOUR_PENS[flag]
                canvas.draw_paths(parts, pen, f"{kind.replace(' ', '-')}s", heights)
                self.drawn.kinds.add(kind)
        self._write(texts, CONTOUR_PENS[True].color, "contour-label")

    def _choose_labels(self, texts: list[_Text]) -> list[_Text]:
        """Keep the labels that have room; one on a line only where its contour has no other."""
        shapely = optional.load("shapely")
        shown = (clip_to_window(paths, self._window) for paths in self._contents.linework.values())
        barriers = shapely.STRtree(
            [shapely.LineString(p) for paths in shown for p in paths.parts()]
        )
        boxes = shapely.polygons(np.array([text.corners for text in texts]).reshape(-1, 4, 2))
        hit = np.zeros(len(texts), np.bool_)
        hit[barriers.query(boxes, predicate="intersects")[0]] = True
        free = [text for text, is_hit in zip(texts, hit, strict=True) if not is_hit]
        kept = [text for text in free if self._room.take(text.corners)]
        named = {text.source for text in kept}
        for text in (text for text, is_hit in zip(texts, hit, strict=True) if is_hit):
            if text.source not in named and self._room.take(text.corners):
                kept.append(text)
                named.add(text.source)
        return kept

    # ---------------------------------------------------------------- points

    def _draw_marks(self) -> None:
        """Draw points with their labels, and spot heights that have room, which come first."""
        shown = [(marks, *self._find_seen(marks)) for marks in self._contents.marks]
        for marks, places, seen in shown:
            if marks.kind == "point":
                self._draw_arms(marks, places[seen])
                for place in places[seen[:_MOST_MARK_LABELS]].tolist() if marks.texts else ():
                    self._room.occupy(outline_text(place, 2 * _MARK, 2 * _MARK))
        for marks, places, seen in reversed(shown):
            labeled = seen[:_MOST_MARK_LABELS].tolist() if marks.texts else []
            written = [one for one in labeled if self._write_mark(marks, one, places[one].tolist())]
            if marks.kind != "point":
                self._draw_arms(marks, places[written])
            if marks.texts:
                self.drawn.crowded[marks.kind] += len(seen) - len(written)

    def _find_seen(self, marks: Marks) -> tuple[Float64Array, Int64Array]:
        """Return places on paper, and the numbers of those whose marks are within the frame."""
        places = self._window.to_paper(marks.places)
        west, south, east, north = _list_sides(self._window)
        low, high = (west + _MARK, south + _MARK), (east - _MARK, north - _MARK)
        return places, np.flatnonzero(((places >= low) & (places <= high)).all(axis=1))

    def _draw_arms(self, marks: Marks, places: Float64Array) -> None:
        if len(places):
            crosses = (places[:, None, None, :] + ARMS[marks.kind]).reshape(-1, 2, 2)
            self._canvas.draw_paths(list(crosses), _MARK_PEN, _NAMES[marks.kind])
            self.drawn.kinds.add(marks.kind)

    def _write_mark(self, marks: Marks, number: int, place: Sequence[float]) -> bool:
        """Write texts beside a point, one below the other, if there is room to one side."""
        texts = {name: own[number] for name, own in marks.texts.items() if own[number]}
        if not texts:
            return True
        if marks.kind != "point" and not self._room.take(
            outline_text((place[0], place[1]), 2 * _MARK, 2 * _MARK)
        ):
            return False
        size = self._contents.label_size / CAPITAL
        step = self._contents.label_size + 0.3
        width = max(measure_text(text, size) for text in texts.values())
        for side in (1.0, -1.0):
            x = place[0] + side * (_MARK + _GAP)
            center = (x + side * width / 2, place[1])
            if self._room.take(outline_text(center, width, step * len(texts))):
                break
        else:
            return False
        across = "left" if side > 0 else "right"
        y = place[1] + step * len(texts) / 2
        for name, text in texts.items():
            y -= step
            self._canvas.write((x, y + 0.15), text, size=size, across=across, name=name)
        return True

    # ---------------------------------------------------------------- match lines

    def _draw_match(self, match: MatchLine, number: int) -> None:
        parts = clip_paths(
            join_paths([self._window.to_paper(match.ends)]), self._window.frame
        ).parts()
        if not parts:
            return
        self._canvas.draw_paths(parts, MATCH_PEN, "match-lines")
        self.drawn.kinds.add("match line")
        start, end = parts[0][0], parts[0][-1]
        text = f"Match line: sheet {number}"
        width = measure_text(text, _LETTERS)
        east, north = (end - start).tolist()
        if math.hypot(east, north) < width + 2 * _MATCH_INSET:
            return
        rotation = turn_upright(math.degrees(math.atan2(north, east)))
        high, low = (start, end) if start[1] >= end[1] else (end, start)
        inward = (low - high) / np.hypot(*(low - high))
        middle = high + (0.5 * width + _MATCH_INSET) * inward  # away from the surface in mid-frame
        above = turn(np.array([0.0, 1.0]), rotation)
        center = tuple((middle + (0.5 * _LETTERS + 0.5) * above).tolist())
        self._room.take(outline_text(center, width, _LETTERS, rotation))
        self._canvas.write(
            tuple((middle + 0.7 * above).tolist()),
            text,
            size=_LETTERS,
            color=MATCH_PEN.color,
            rotation=rotation,
            across="center",
            name="match-label",
        )


def _list_sides(window: Window) -> tuple[float, float, float, float]:
    frame = window.frame
    return frame.xmin, frame.ymin, frame.xmax, frame.ymax


def clip_to_window(paths: Paths, window: Window) -> Paths:
    """Return what a window shows of paths on the ground, on paper."""
    moved = Paths(window.to_paper(paths.coordinates), paths.offsets, paths.sources)
    return clip_paths(moved, window.frame)


def _place_labels(seen: Paths, lines: Features, labeling: str) -> list[_Text]:
    """Return the labels of contours as they are seen, upright on this sheet."""
    if len(seen.sources) == 0:
        return []
    columns = lines.columns
    is_index = columns["is_index"]
    firsts, lasts = seen.offsets[:-1], seen.offsets[1:] - 1
    is_closed = (seen.coordinates[firsts] == seen.coordinates[lasts]).all(axis=1)
    shown = Features.of_lines(
        seen.coordinates,
        seen.offsets,
        columns={
            "elevation": columns["elevation"][seen.sources],
            "is_index": is_index[seen.sources],
            "is_closed": is_closed,
        },
    )
    # where the surface has index contours, others have no labels even if a sheet shows no index
    is_silent = labeling == "index" and is_index.any() and not shown.columns["is_index"].any()
    if is_silent:
        return []
    labels = contour_labels(shown, spacing=_SPACING, index_only=labeling == "index")
    decimals = count_decimals(columns["elevation"])
    rows = zip(
        labels.coordinates[:, :2].tolist(),
        labels.columns["rotation"].tolist(),
        [f"{level + 0.0:.{decimals}f}" for level in labels.columns["elevation"].tolist()],
        seen.sources[labels.columns["line"]].tolist(),
        strict=True,
    )
    return [_make_outline(tuple(place), *rest) for place, *rest in rows]


def _make_outline(center: tuple[float, float], rotation: float, text: str, source: int) -> _Text:
    width = measure_text(text, _LETTERS) + 1.0
    corners = outline_text(center, width, CAPITAL * _LETTERS + 0.8, rotation)
    return _Text(center, rotation, text, corners, source)


def _cut_out(paths: Paths, texts: list[_Text]) -> Paths:
    """Leave the lines out that run through a text."""
    shapely = optional.load("shapely")
    if not texts or len(paths.sources) == 0:
        return paths
    parts = paths.parts()
    lines = shapely.linestrings(
        paths.coordinates, indices=np.repeat(np.arange(len(parts)), np.diff(paths.offsets))
    )
    boxes = shapely.polygons([text.corners for text in texts])
    hit, box = shapely.STRtree(boxes).query(lines, predicate="intersects")
    kept: list[Float64Array] = []
    sources: list[int] = []
    for number, part in enumerate(parts):
        own = boxes[box[hit == number]]
        left = [part] if len(own) == 0 else _subtract(lines[number], own)
        kept += left
        sources += [int(paths.sources[number])] * len(left)
    return join_paths(kept, sources)


def _subtract(line: Any, boxes: AnyArray) -> list[Float64Array]:
    shapely = optional.load("shapely")
    rest = shapely.difference(line, shapely.union_all(boxes))
    pieces = [shapely.get_coordinates(part) for part in shapely.get_parts(rest)]
    return [piece for piece in pieces if len(piece) > 1]
