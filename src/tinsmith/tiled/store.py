"""All points of a run: chunks on disk, and the few points that every task knows."""

from __future__ import annotations

import itertools
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..base.types import Bounds
from ..terrain.parts import are_owned
from ..tin.tiling import (
    NumberedPoints,
    are_in_box,
    find_outermost,
    list_sides,
    reduce_to_hull,
)
from .chunks import Chunk, save_array
from .in_place import FileInPlace

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from ..base.arrays import BoolArray, Float64Array, Int64Array
    from ..tin.tiling import Discs

_ENTRY = np.dtype(
    [
        ("file", "<u4"),
        ("part", "<u4"),
        ("first", "<i8"),
        ("count", "<i8"),
        ("box", "<f8", 4),
        ("shape", "<u2", 2),
        ("is_in_place", "?"),
    ]
)
"""A chunk in the list of all."""

_SIDE_OF_SKELETON = 32
"""Rows and columns of the cells each of which keeps its outermost points, however many chunks."""
_MANY = 50_000
"""Points near a disc, above which only some of the deepest are read."""
_SOME = 64
_ABOUT = 1 + 2.0**-40
"""Factor within which distances are not told apart where points are only chosen to be looked at."""
_CLEARLY = 0.99
"""Of the radius: what lies further out is not worth taking before the others were looked at."""
NO_POINTS = NumberedPoints(np.empty((0, 3)), np.empty(0, np.int64))


class PointStore:
    """A source of points for :func:`tinsmith.tin.tiling.local_triangulation.triangulate_box`.

    Parameters
    ----------
    chunks : sequence of Chunk
    skeleton : NumberedPoints
        All vertices of the convex hull, and outermost points of parts of it.
    """

    def __init__(self, chunks: Sequence[Chunk], skeleton: NumberedPoints) -> None:
        self.chunks = tuple(chunks)
        self.skeleton = skeleton

    @cached_property
    def _corners(self) -> Float64Array:
        boxes = [chunk.bounds for chunk in self.chunks]
        sides = [(box.xmin, box.ymin, box.xmax, box.ymax) for box in boxes]
        return np.array(sides, np.float64).reshape(-1, 4)

    @property
    def count(self) -> int:
        """Points in it."""
        return sum(chunk.count for chunk in self.chunks)

    @property
    def bounds(self) -> Bounds:
        """Bounds of all points."""
        west, south, east, north = self._corners.T
        return Bounds(*map(float, (west.min(), south.min(), east.max(), north.max())))

    def read_box(self, box: Bounds) -> NumberedPoints:
        """Return all points in a closed box, in order of their numbers."""
        found = self._read(np.array([list_sides(box)]))
        return found.choose(are_in_box(found.points, box))

    def read_parts(self, box: Bounds, most: int) -> Iterator[NumberedPoints]:
        """Yield the points in a box without its east and north sides, in parts.

        These are strips from the south on, as many as leave each ``most`` points, about.
        """
        sides = np.array([list_sides(box)])
        count = sum(
            int(self.chunks[number].count_points(self.chunks[number].locate(sides)).sum())
            for number, _ in self._find(sides)
        )
        low, high = max(box.ymin, self.bounds.ymin), min(box.ymax, self.bounds.ymax)
        cuts = np.linspace(low, high, max(1, -(-count // most)) + 1)[1:-1]
        edges = [box.ymin, *np.unique(cuts).tolist(), box.ymax]
        for south, north in itertools.pairwise(edges):
            strip = Bounds(box.xmin, south, box.xmax, north)
            found = self.read_box(strip)
            own = are_owned(found.points, strip)
            if own.any():
                yield found.choose(own)

    def read_some(self, discs: Discs) -> NumberedPoints:
        """Return some of the deepest points of discs near which there are very many.

        Such are the discs of triangles across a bay of the data; read as wholes they would be a
        large part of all points.
        """
        found = [NO_POINTS]
        for k in np.flatnonzero(self._are_large(discs)).tolist():
            for points, far in self._read_from_middle(discs.centers[k], float(discs.radii[k])):
                inside = np.flatnonzero(far < discs.radii[k] * _CLEARLY)
                if len(inside):
                    deepest = inside[np.argsort(far[inside], kind="stable")[:_SOME]]
                    found.append(points.choose(np.sort(deepest)))
                    break
        return NumberedPoints.join(found)

    def read_discs(self, discs: Discs) -> NumberedPoints:
        """Return all points in any of some closed discs, and others near them."""
        is_large = self._are_large(discs)
        found = [self._read(_bound(discs.choose(~is_large)))]
        for k in np.flatnonzero(is_large).tolist():
            radius = float(discs.radii[k]) * _ABOUT
            found += [
                points.choose(far <= radius)
                for points, far in self._read_from_middle(discs.centers[k], radius)
            ]
        return NumberedPoints.join(found)

    def _are_large(self, discs: Discs) -> BoolArray:
        """Tell near which discs there are very many points, as far as cells tell."""
        counts = np.zeros(len(discs.radii), np.int64)
        boxes = _bound(discs)
        for number, met in self._find(boxes):
            chunk = self.chunks[number]
            counts[met] += chunk.count_points(chunk.locate(boxes[met]))
        return (counts > _MANY) & np.isfinite(discs.radii)

    def _read_from_middle(
        self, center: Float64Array, radius: float
    ) -> Iterator[tuple[NumberedPoints, Float64Array]]:
        """Yield the points of all cells that meet a disc, with their distances from its middle.

        Chunks that lie nearest to it come first, and of each the nearest cells.
        """
        west, south, east, north = self._corners.T
        x, y = center.tolist()
        gaps = [np.maximum(west - x, x - east), np.maximum(south - y, y - north)]
        distances = np.hypot(*np.maximum(gaps, 0.0))
        for k in np.argsort(distances, kind="stable").tolist():
            if distances[k] > radius * _ABOUT:
                return
            chunk = self.chunks[k]
            for points in chunk.read_near(center, radius * _ABOUT):
                yield points, np.hypot(*(points.points[:, :2] - center).T)

    def _find(self, boxes: Float64Array) -> Iterator[tuple[int, Int64Array]]:
        """Yield chunks, and which of some closed boxes, (k, 4), meet their bounds."""
        low, high = (
            boxes[:, :2].min(axis=0, initial=np.inf),
            boxes[:, 2:].max(axis=0, initial=-np.inf),
        )
        corners = self._corners
        is_met = ((corners[:, :2] <= high) & (corners[:, 2:] >= low)).all(axis=1)
        for number in np.flatnonzero(is_met).tolist():
            west, south, east, north = corners[number]
            meets = (boxes[:, 0] <= east) & (boxes[:, 2] >= west)
            meets &= (boxes[:, 1] <= north) & (boxes[:, 3] >= south)
            if meets.any():
                yield number, np.flatnonzero(meets)

    def _read(self, boxes: Float64Array) -> NumberedPoints:
        """Return the points of the chunks' cells that some closed boxes meet, each once."""
        found = []
        for number, met in self._find(boxes):
            chunk = self.chunks[number]
            found.append(chunk.read_boxes(boxes[met]))
        if not found:
            return NO_POINTS
        points = np.concatenate([one.points for one in found])
        numbers = np.concatenate([one.numbers for one in found])
        order = np.argsort(numbers, kind="stable")
        return NumberedPoints(points[order], numbers[order])


def save_chunks(path: Path, chunks: list[Chunk]) -> None:
    """Write what is known of chunks, so that tasks need not be handed it."""
    entries = np.zeros(len(chunks), _ENTRY)
    for entry, chunk in zip(entries, chunks, strict=True):
        box = chunk.bounds
        entry["file"], entry["part"] = chunk.file, chunk.part
        entry["first"], entry["count"] = chunk.first, chunk.count
        entry["box"] = box.xmin, box.ymin, box.xmax, box.ymax
        entry["shape"] = chunk.shape
        entry["is_in_place"] = isinstance(chunk, FileInPlace)
    save_array(path, entries)


def load_chunks(path: Path, folder: Path) -> list[Chunk]:
    """Read what :func:`save_chunks` wrote, of chunks in a folder."""
    return [
        (FileInPlace if is_in_place else Chunk)(
            folder, file, part, first, count, Bounds(*box.tolist()), (int(shape[0]), int(shape[1]))
        )
        for file, part, first, count, box, shape, is_in_place in np.load(path).tolist()
    ]


def _bound(discs: Discs) -> Float64Array:
    """Return boxes that hold discs, (k, 4)."""
    reach = discs.radii[:, None] * _ABOUT + 2.0**-40 * np.abs(discs.centers)
    return np.column_stack([discs.centers - reach, discs.centers + reach])


def join_skeletons(parts: Sequence[NumberedPoints], bounds: Bounds) -> NumberedPoints:
    """Return the points that every task must know, of those that single chunks named.

    These are the vertices of the convex hull of all, and in each of some cells over the bounds the
    points that lie furthest in 16 directions: a bounded number, however many chunks there are.
    """
    known = NumberedPoints.join(parts)
    side = _SIDE_OF_SKELETON
    places = []
    for k, (low, high) in enumerate(((bounds.xmin, bounds.xmax), (bounds.ymin, bounds.ymax))):
        extent = high - low
        steps = (known.points[:, k] - low) / extent * side if extent > 0 else known.points[:, k] * 0
        places.append(np.clip(steps, 0, side - 1).astype(np.int64))
    cells = places[1] * side + places[0]
    kept = [reduce_to_hull(known)]
    kept += [find_outermost(known.choose(cells == cell)) for cell in np.unique(cells)]
    return NumberedPoints.join(kept)


def count_by_cells(chunks: Sequence[Chunk], bounds: Bounds, side: int) -> Int64Array:
    """Return about how many points lie in each cell of a lattice over bounds, (side, side) array.

    The points of a cell of a chunk are counted where its middle lies; rows are from the south.
    """
    counts = np.zeros(side * side, np.int64)
    for chunk in chunks:
        rows, columns = chunk.shape
        box = chunk.lattice
        x = box.xmin + (np.arange(columns) + 0.5) * (box.width / columns)
        y = box.ymin + (np.arange(rows) + 0.5) * (box.height / rows)
        across, up = (
            np.clip((values - low) / extent * side if extent > 0 else values * 0, 0, side - 1)
            for values, low, extent in (
                (x, bounds.xmin, bounds.width),
                (y, bounds.ymin, bounds.height),
            )
        )
        cells = up.astype(np.int64)[:, None] * side + across.astype(np.int64)
        np.add.at(counts, cells.ravel(), np.diff(chunk.offsets))
    return counts.reshape(side, side)
