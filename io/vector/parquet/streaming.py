"""Points of GeoParquet: group of rows after group, what metadata say, and those of a box."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base import optional
from ....base.crs import CRS
from ....base.errors import ReadError
from ....base.sentences import FILE, counted
from ....tin.screening import ElevationSummary
from ...isolated import run_isolated, stream_isolated
from ...registry import (
    PointChunk,
    SourceHeader,
    StreamEnd,
    StreamHead,
    find_inside,
    join_chunks,
    make_source_header,
    taking,
    yield_survey,
)
from ...reprojection import Placing, find_bounds, place, stays
from ..elevations import settle_stated_unit
from ..features import make_layer
from ..points import (
    POINT,
    Asked,
    Taken,
    collect_attributes,
    gather_points,
    list_kinds,
    read_layer,
    take_points,
)

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array, Int64Array
    from ....tin import Bounds
    from ...registry import Blocks
    from ..layers import Layer

_CHILD = f"{__package__}.child"
_MOST_OVERLAP = 4.0
"""How often the groups of rows cover their bounds, of a file in which points have an order."""
_LARGEST_WHOLE = 1 << 28
"""Bytes of a file that is read at once where it holds other features than single points."""


@taking(Asked)
def stream(path: Path, asked: Asked) -> Blocks:
    """Read points group of rows after group; the options are those of :func:`.points.read`.

    Notes
    -----
    The first group decides where elevations are. A file whose first features are not single points
    is read at once, up to 256 MB.
    """
    optional.require("pyarrow", "Reading vector files")
    if not _are_points(path, asked):
        if path.stat().st_size > _LARGEST_WHOLE:
            raise ReadError(f"{FILE} holds other features than single points, and is too large.")
        return (yield from yield_survey(read_layer(path, asked)))
    summary, skipped = ElevationSummary("point"), Counter[str]()
    first: Taken | None = None
    placing: Placing | None = None
    n_points, missing = 0, _Missing()
    for layer in _iterate_layers(path, asked, None, missing):
        part = _take_points(layer, asked)
        skipped.update(part.skipped)
        if first is not None and (part.unit, part.notes) != (first.unit, first.notes):
            raise ReadError(
                f"{layer.label(0)} and those behind it have their elevations elsewhere than those "
                "before: the option `z_field` says where they are."
            )
        first = first or part
        if len(part.points) == 0:
            continue
        summary.add(part.points[:, 2])
        placing = placing or Placing(layer.crs, asked.target, part.unit)
        placed = placing.add(part.points)
        if n_points == 0:
            yield StreamHead(placed.crs, placed.elevation_unit)
        n_points += len(part.points)
        yield _make_chunk(placed.points, part.rows, layer)
    if placing is None or first is None:
        raise asked.describe_marks()
    notes = [*missing.describe(path), *first.notes, *summary.describe(), *placing.finish()]
    return StreamEnd(notes, dict(skipped))


def _make_chunk(points: Float64Array, rows: Int64Array, layer: Layer) -> PointChunk:
    return PointChunk(points, layer.numbers[rows], collect_attributes(layer, rows))


@dataclass(slots=True)
class _Missing:
    """Features without a geometry."""

    count: int = 0
    first: int = 0

    def add(self, numbers: Int64Array, layer: Layer | None) -> None:
        """Add those that a layer lacks."""
        lacking = numbers if layer is None else np.setdiff1d(numbers, layer.numbers)
        if len(lacking):
            self.first = self.first if self.count else int(lacking[0])
            self.count += len(lacking)

    def describe(self, path: Path) -> list[str]:
        """Tell of them."""
        have = "feature has" if self.count == 1 else "features have"
        note = f"'{path.name}': {self.count} {have} no geometry (first: {self.first})."
        return [note] if self.count else []


def _request(path: Path, asked: Asked) -> dict[str, Any]:
    return {"path": str(path.absolute()), "layer": asked.layer, "where": asked.where}


def _are_points(path: Path, asked: Asked) -> bool:
    """Whether the first features are single points."""
    if asked.lines_as is not None:
        return False
    layers = list(_iterate_layers(path, asked, [0], _Missing()))  # to the end: the child goes on
    return bool(layers) and len(layers[0].numbers) > 0 and _holds_single_points(layers[0])


def _holds_single_points(layer: Layer) -> bool:
    shapely = optional.load("shapely")
    is_single = shapely.get_num_coordinates(layer.geometries) == 1
    return list_kinds(layer) == {POINT} and bool(is_single.all())


def _iterate_layers(
    path: Path, asked: Asked, groups: list[int] | None, missing: _Missing
) -> Iterator[Layer]:
    """Yield the features of groups of rows that have a geometry."""
    request = {**_request(path, asked), "groups": groups}
    with stream_isolated(f"{_CHILD}:read_groups", request, path=path) as parts:
        for part in parts:
            value, arrays = part
            missing_all = not (arrays["lengths"] > 0).any()
            layer = None if missing_all else make_layer(path, value, arrays, CRS.of(value["crs"]))
            missing.add(arrays["numbers"], layer)
            if layer is not None:
                yield layer._replace(notes=())


def _take_points(layer: Layer, asked: Asked) -> Taken:
    if not _holds_single_points(layer):
        raise ReadError(
            f"{layer.label(0)} or one behind it is no single point, as those before are: one kind "
            "is needed."
        )
    return take_points(gather_points(layer), layer, asked)


# ------------------------------------------------------------------ metadata and boxes


@taking(Asked)
def describe(path: Path, asked: Asked) -> SourceHeader:
    """Tell what the metadata of a file say of its features."""
    optional.require("pyarrow", "Reading vector files")
    value, boxes = run_isolated(f"{_CHILD}:read_statistics", _request(path, asked), path=path)
    source, target = CRS.of(value["crs"]), asked.target
    box = value["bbox"]
    half = len(box) // 2 if box else 0
    corners = None if half < 2 else (np.array(box[:2]), np.array(box[half : half + 2]))
    unit = settle_stated_unit(value["elevation_unit"], source, asked.declared)
    middle = np.zeros((0, 3))
    if corners is not None:
        middle = np.append(corners[0] / 2 + corners[1] / 2, 0.0)[None, :]
    placed = place(middle, source=source, target=target, unit=unit)
    return make_source_header(
        path,
        "geoparquet",
        count=value["count"],
        bounds=None if corners is None else find_bounds(*corners, source, target),
        crs=placed.crs,
        elevation_unit=placed.elevation_unit,
        obstacle=_find_obstacle(boxes["boxes"], stays=stays(source, target)),
    )


def _find_obstacle(sides: Float64Array, *, stays: bool) -> str:
    """Return why points cannot be read by box, or not without most others; (n, 4) sides."""
    if not stays:
        return "would be reprojected"
    if not np.isfinite(sides).all():
        return "tells no bounds of its groups of rows"
    extents = sides[:, 2:] - sides[:, :2]
    whole = sides[:, 2:].max(axis=0, initial=-np.inf) - sides[:, :2].min(axis=0, initial=np.inf)
    if len(sides) and extents.prod(axis=1).sum() > _MOST_OVERLAP * whole.prod():
        return "has groups of rows that overlap: its points have no order in space"
    return ""


@taking(Asked)
def read_box(path: Path, bounds: Bounds, asked: Asked) -> PointChunk:
    """Read the points of a box from the groups of rows whose statistics meet it.

    Parameters
    ----------
    bounds : Bounds
        In the CRS of the file; the edges belong to it.

    Raises
    ------
    ReadError
        If the file does not tell the bounds of its groups, or points would be reprojected.
    """
    value, boxes = run_isolated(f"{_CHILD}:read_statistics", _request(path, asked), path=path)
    sides = boxes["boxes"]
    if not stays(CRS.of(value["crs"]), asked.target) or not np.isfinite(sides).all():
        raise ReadError(f"{FILE} tells no bounds of its {counted(len(sides), 'group')} of rows.")
    meets = (sides[:, 0] <= bounds.xmax) & (sides[:, 2] >= bounds.xmin)
    meets &= (sides[:, 1] <= bounds.ymax) & (sides[:, 3] >= bounds.ymin)
    chunks = []
    for layer in _iterate_layers(path, asked, np.flatnonzero(meets).tolist(), _Missing()):
        part = _take_points(layer, asked)
        inside = find_inside(part.points, bounds)
        points = Placing(layer.crs, asked.target, part.unit).add(part.points[inside]).points
        chunks.append(_make_chunk(points, part.rows[inside], layer))
    return join_chunks(chunks)
