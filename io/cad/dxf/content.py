"""What of a TIN, a survey or features becomes which entity, on which layer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....tin import Breakline
from ....tin.constraints.constraint_set import as_sequence
from ....tin.constraints.polygons import gather_rings_of_regions
from ....tin.topology import directed_edges, edge_keys
from .names import CONSTRAINED

if TYPE_CHECKING:
    from ....arrays import Float64Array, Int64Array
    from ....terrain.results import Features
    from ....tin import TIN, Survey
    from .entities import EntityWriter

__all__ = ["add_features", "add_survey", "add_tin"]

_LAYER_OF_KIND = {
    "hard": "BREAKLINES",
    "soft": "SOFT_BREAKLINES",
    "boundary": "BOUNDARY",
    "hole": "HOLES",
    "water": "WATER",
}
_SHARE = 0.2
"""Height of labels as a share of the mean distance of points."""


def add_tin(writer: EntityWriter, tin: TIN, factor: float) -> None:
    """Add triangles and lines."""
    points = _scale(tin.points, factor)
    writer.add_faces("TIN", points[tin.triangles])
    told = zip(tin.lines.kinds, tin.lines.names, tin.lines.sources.tolist(), strict=True)
    for chain, (kind, name, source) in zip(tin.lines.chains(), told, strict=True):
        writer.add_line(_LAYER_OF_KIND[kind], points[chain], (kind, name, str(source)))
    for edge in _find_other_edges(tin):
        writer.add_line("CONSTRAINED_EDGES", points[edge], (CONSTRAINED, "", ""))


def _find_other_edges(tin: TIN) -> Int64Array:
    """Return the constrained edges that belong to no line, (k, 2) vertices."""
    pairs = np.stack(directed_edges(tin.triangles), axis=-1)[tin.constrained]
    keys, first = np.unique(edge_keys(pairs, len(tin.points)), return_index=True)
    known = edge_keys(tin.lines.segments(), len(tin.points))
    others: Int64Array = pairs[np.sort(first[~np.isin(keys, known)])]
    return others


def add_survey(writer: EntityWriter, survey: Survey, factor: float, *, labels: bool) -> None:
    """Add points with their labels, and lines."""
    _add_points(writer, _scale(survey.points, factor), survey.attributes, labels=labels)
    for line in survey.breaklines:
        one = line if isinstance(line, Breakline) else Breakline(line)
        rows = _scale(one.coords, factor)
        told = (one.kind, one.name, "", str(one.priority))
        writer.add_line(_LAYER_OF_KIND[one.kind], rows, told)
    for regions, what, layer in (
        (survey.boundary, "boundary", "BOUNDARY"),
        (survey.holes, "hole", "HOLES"),
        (survey.erase, "erase", "ERASE"),
    ):
        polygons = gather_rings_of_regions(as_sequence(regions, what), what)
        for number, rings in enumerate(polygons):
            for ring in rings:
                closed = np.concatenate([ring, ring[:1]])
                writer.add_line(layer, _scale(closed, factor), (what, "", str(number)))
    for one_water in survey.water:
        ring = np.column_stack([one_water.ring, np.full(len(one_water.ring), one_water.z)])
        closed = np.concatenate([ring, ring[:1]])
        writer.add_line("WATER", _scale(closed, factor), ("water", one_water.name))


def add_features(writer: EntityWriter, features: Features, factor: float, *, labels: bool) -> None:
    """Add points, lines or the rings of polygons; contours on layers of their own."""
    if features.kind == "points":
        rows = features.coordinates
        if not features.has_elevations:
            rows = np.column_stack([rows, np.zeros(len(rows))])
        points = _scale(np.nan_to_num(rows, nan=0.0), factor)
        _add_points(writer, points, features.columns, labels=labels)
        return
    names = _choose_layers(features)
    for owner, rows in _iterate_parts(features):
        scaled = _scale(rows, factor)
        is_known = np.isfinite(scaled).all()
        if scaled.shape[1] == 3 and is_known and np.ptp(scaled[:, 2]) == 0 and scaled[0, 2] != 0:
            writer.add_contour(names[owner], scaled)
        else:
            writer.add_line(names[owner], scaled if is_known else scaled[:, :2])


def _choose_layers(features: Features) -> list[str]:
    count = len(features)
    if features.kind == "polygons":
        return ["POLYGONS"] * count
    if features.name != "contours":
        return ["LINES"] * count
    index = features.columns.get("is_index")
    if index is None:
        return ["CONTOURS"] * count
    return ["INDEX_CONTOURS" if one else "CONTOURS" for one in np.asarray(index).tolist()]


def _iterate_parts(features: Features) -> Any:
    """Yield each line or ring with the feature that it belongs to."""
    owners = np.arange(len(features))
    for level in reversed(features.offsets[1:]):
        owners = np.repeat(owners, np.diff(level))
    offsets = features.offsets[0].tolist()
    for owner, start, end in zip(owners.tolist(), offsets[:-1], offsets[1:], strict=True):
        yield owner, features.coordinates[start:end]


def _scale(rows: Float64Array, factor: float) -> Float64Array:
    return rows if factor == 1.0 or rows.shape[1] == 2 else rows * [1.0, 1.0, factor]


# ------------------------------------------------------------------ points


def _add_points(
    writer: EntityWriter, points: Float64Array, attributes: Any, *, labels: bool
) -> None:
    if len(points) == 0:
        return
    numbers, descriptions = (
        _find_texts(attributes, name, len(points)) for name in ("number", "description")
    )
    writer.add_points("POINTS", points, list(zip(numbers, descriptions, strict=True)))
    if not labels:
        return
    height = _choose_height(points)
    elevations = [f"{z:.2f}" for z in points[:, 2].tolist()]
    columns = (("NUMBERS", numbers), ("ELEVATIONS", elevations), ("DESCRIPTIONS", descriptions))
    for k, (name, texts) in enumerate(columns):
        beside = np.array([height * 0.5, height * (0.5 - 1.5 * k), 0.0])
        writer.add_texts(f"POINT_{name}", points + beside, texts, height)


def _find_texts(attributes: Any, name: str, count: int) -> list[str]:
    if name not in attributes:
        return [""] * count
    values = np.asarray(attributes[name]).tolist()
    return ["" if one is None or one != one else str(one) for one in values]


def _choose_height(points: Float64Array) -> float:
    """Return a height of text that leaves neighbours room, with two digits."""
    width, depth = np.ptp(points[:, :2], axis=0).tolist()
    distance = max(width, depth) / max(len(points), 1) ** 0.5 if max(width, depth) > 0 else 5.0
    return float(f"{distance * _SHARE:.2g}")
