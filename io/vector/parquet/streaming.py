"""Points of GeoParquet: group of rows after group, what metadata say, and those of a box."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.crs import CRS, Unit
from ....base.errors import OptionError, ReadError
from ....base.sentences import FILE, counted
from ....tin.screening.elevation_summary import ElevationSummary
from ....tin.screening.nodata import parse_nodata
from ...isolated import run_isolated, stream_isolated
from ...registry import (
    PointChunk,
    SourceHeader,
    StreamEnd,
    StreamHead,
    join_chunks,
    make_source_header,
    yield_survey,
)
from ...reprojection import Placing, find_bounds, place, settle_unit
from ..elevations import find_elevation_unit, find_elevations
from ..features import make_layer
from ..points import POINT, collect_attributes, gather_points, list_kinds, read, require_finite

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array, Int64Array
    from ....base.crs import CrsLike, UnitLike
    from ....tin import Bounds
    from ...isolated import Answer
    from ...registry import Blocks
    from ..layers import Layer

_CHILD = f"{__package__}.child"
_LARGEST_WHOLE = 1 << 28
"""Bytes of a file that is read at once where it holds other features than single points."""


class _Asked(NamedTuple):
    """What the caller asks for, and what was found of the first points."""

    target: CRS | None
    declared: Unit | None
    z_field: str | None
    nodata: Float64Array


class _Part(NamedTuple):
    """Points of a group of rows, as they are in the file, and the unit of their elevations."""

    chunk: PointChunk
    unit: Unit | None
    notes: tuple[str, ...]
    skipped: Counter[str]


def stream(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    **options: Any,
) -> Blocks:
    """Read points group of rows after group; the options are those of :func:`.points.read`.

    Notes
    -----
    The first group decides where elevations are. A file whose first features are not single points
    is read at once, up to 256 MB.
    """
    optional.require("pyarrow", "Reading vector files")
    if not _are_points(path, options):
        if path.stat().st_size > _LARGEST_WHOLE:
            raise ReadError(f"{FILE} holds other features than single points, and is too large.")
        whole = read(path, crs=crs, elevation_unit=elevation_unit, **options)
        return (yield from yield_survey(whole))
    asked = _ask(crs, elevation_unit, options)
    summary, skipped = ElevationSummary("point"), Counter[str]()
    first: _Part | None = None
    placing: Placing | None = None
    n_points, missing = 0, _Missing()
    for layer in _iterate_layers(path, options, None, missing):
        part = _take_points(layer, asked)
        skipped.update(part.skipped)
        if first is not None and (part.unit, part.notes) != (first.unit, first.notes):
            raise ReadError(
                f"{layer.label(0)} and those behind it have their elevations elsewhere than those "
                "before: the option `z_field` says where they are."
            )
        first = first or part
        if len(part.chunk) == 0:
            continue
        summary.add(part.chunk.points[:, 2])
        placing = placing or Placing(layer.crs, asked.target, part.unit)
        placed = placing.add(part.chunk.points)
        if n_points == 0:
            yield StreamHead(placed.crs, placed.elevation_unit)
        n_points += len(part.chunk)
        yield PointChunk(placed.points, part.chunk.rows, part.chunk.attributes)
    if placing is None or first is None:
        raise ReadError(f"{FILE} has no elevation but nodata ({asked.nodata.tolist()}).")
    notes = [*missing.describe(path), *first.notes, *summary.describe(), *placing.finish()]
    return StreamEnd(notes, {what: count for what, count in skipped.items() if count})


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


def _ask(crs: CrsLike | None, elevation_unit: UnitLike | None, options: dict[str, Any]) -> _Asked:
    nodata = parse_nodata(options.get("nodata"))
    return _Asked(CRS.of(crs), Unit.of(elevation_unit), options.get("z_field"), nodata)


def _request(path: Path, options: dict[str, Any]) -> dict[str, Any]:
    names = {"layer": options.get("layer"), "where": options.get("where")}
    return {"path": str(path.absolute()), **names}


def _are_points(path: Path, options: dict[str, Any]) -> bool:
    """Whether the first features are single points."""
    if options.get("lines_as") is not None:
        return False
    layers = list(_iterate_layers(path, options, [0], _Missing()))  # to the end: the child goes on
    return bool(layers) and len(layers[0].numbers) > 0 and _holds_single_points(layers[0])


def _holds_single_points(layer: Layer) -> bool:
    shapely = optional.load("shapely")
    is_single = shapely.get_num_coordinates(layer.geometries) == 1
    return list_kinds(layer) == {POINT} and bool(is_single.all())


def _iterate_layers(
    path: Path, options: dict[str, Any], groups: list[int] | None, missing: _Missing
) -> Iterator[Layer]:
    """Yield the features of groups of rows that have a geometry."""
    request = {**_request(path, options), "groups": groups}
    with stream_isolated(f"{_CHILD}:read_groups", request, path=path) as parts:
        for part in parts:
            has_any = bool((part.arrays["lengths"] > 0).any())
            layer = _make_layer(path, part) if has_any else None
            missing.add(part.arrays["numbers"], layer)
            if layer is not None:
                yield layer


def _make_layer(path: Path, part: Answer) -> Layer:
    layer = make_layer(path, part.value, part.arrays, CRS.of(part.value["crs"]))
    return layer._replace(notes=())


def _take_points(layer: Layer, asked: _Asked) -> _Part:
    if not _holds_single_points(layer):
        raise ReadError(
            f"{layer.label(0)} or one behind it is no single point, as those before are: one kind "
            "is needed."
        )
    vertices = gather_points(layer)
    require_finite(vertices, layer)
    found = find_elevations(layer, vertices.xyz[:, 2], vertices.has_z, vertices.rows, asked.z_field)
    is_nodata = np.isin(found.z, asked.nodata)
    keep = np.isfinite(found.z) & ~is_nodata
    points = np.column_stack([vertices.xyz[keep, :2], found.z[keep]])
    unit = find_elevation_unit(layer, asked.declared)
    unit = settle_unit(asked.declared, found.unit) if found.unit else unit
    rows = vertices.rows[keep]
    skipped = Counter(
        {
            "features without an elevation": len(np.unique(vertices.rows[np.isnan(found.z)])),
            "nodata points": int(is_nodata.sum()),
        }
    )
    chunk = PointChunk(points, layer.numbers[rows], collect_attributes(layer, rows))
    return _Part(chunk, unit, found.notes, skipped)


# ------------------------------------------------------------------ metadata and boxes


def describe(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    **options: Any,
) -> SourceHeader:
    """Tell what the metadata of a file say of its features.

    Parameters
    ----------
    path : Path
    crs, elevation_unit, **options
        As of the reader.
    """
    optional.require("pyarrow", "Reading vector files")
    value, boxes = run_isolated(f"{_CHILD}:read_statistics", _request(path, options), path=path)
    source, target = CRS.of(value["crs"]), CRS.of(crs)
    box = value["bbox"]
    half = len(box) // 2 if box else 0
    corners = None if half < 2 else (np.array(box[:2]), np.array(box[half : half + 2]))
    unit = _find_unit(value["elevation_unit"], source, Unit.of(elevation_unit))
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
        has_boxes=_stays(source, target) and bool(np.isfinite(boxes["boxes"]).all()),
    )


def _find_unit(word: str | None, source: CRS | None, declared: Unit | None) -> Unit | None:
    """Return the unit of elevations in geometries; that of a column shows when it is read."""
    try:
        stated = Unit.of(word)
    except OptionError:
        stated = None
    vertical = None if source is None else source.vertical_unit
    return settle_unit(declared, stated or vertical)


def _stays(source: CRS | None, target: CRS | None) -> bool:
    return target is None or (source is not None and source.is_same(target))


def read_box(
    path: Path,
    bounds: Bounds,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    **options: Any,
) -> PointChunk:
    """Read the points of a box from the groups of rows whose statistics meet it.

    Parameters
    ----------
    path : Path
    bounds : Bounds
        In the CRS of the file; the edges belong to it.
    crs, elevation_unit, **options
        As of the reader.

    Raises
    ------
    ReadError
        If the file does not tell the bounds of its groups, or points would be reprojected.
    """
    value, boxes = run_isolated(f"{_CHILD}:read_statistics", _request(path, options), path=path)
    asked = _ask(crs, elevation_unit, options)
    sides = boxes["boxes"]
    if not _stays(CRS.of(value["crs"]), asked.target) or not np.isfinite(sides).all():
        raise ReadError(f"{FILE} tells no bounds of its {counted(len(sides), 'group')} of rows.")
    meets = (sides[:, 0] <= bounds.xmax) & (sides[:, 2] >= bounds.xmin)
    meets &= (sides[:, 1] <= bounds.ymax) & (sides[:, 3] >= bounds.ymin)
    chunks = []
    for layer in _iterate_layers(path, options, np.flatnonzero(meets).tolist(), _Missing()):
        part = _take_points(layer, asked)
        x, y = part.chunk.points[:, 0], part.chunk.points[:, 1]
        inside = (x >= bounds.xmin) & (x <= bounds.xmax)
        inside &= (y >= bounds.ymin) & (y <= bounds.ymax)
        chunk = part.chunk.take(inside)
        points = Placing(layer.crs, asked.target, part.unit).add(chunk.points).points
        chunks.append(PointChunk(points, chunk.rows, chunk.attributes))
    empty = PointChunk(np.empty((0, 3)), np.empty(0, np.int64), {})
    return join_chunks(chunks) if chunks else empty
