"""What of a TIN, a survey or features becomes which entity, on which layer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ....base.results import Features
from ....tin import TIN, Surface, Survey
from ....tin.topology import directed_edges, edge_keys
from ...registry.losses import select_attributes
from ..drawing import list_lines, scale_elevations
from .names import CONSTRAINED

if TYPE_CHECKING:
    from ....base.arrays import AnyArray, Float64Array, Int64Array
    from .entities import EntityWriter

__all__ = ["add_features", "add_survey", "add_tin", "select_texts"]

_LAYER_OF_KIND = {
    "hard": "BREAKLINES",
    "soft": "SOFT_BREAKLINES",
    "boundary": "BOUNDARY",
    "hole": "HOLES",
    "erase": "ERASE",
    "water": "WATER",
}
_SHARE = 0.2
"""Height of labels as a share of the mean distance of points."""


def add_tin(writer: EntityWriter, tin: TIN, factor: float) -> None:
    """Add triangles and lines."""
    points = scale_elevations(tin.points, factor)
    writer.add_faces("TIN", points[tin.triangles])
    for line in list_lines(tin, factor):
        stated = (line.kind, line.name, str(line.source))
        writer.add_line(_LAYER_OF_KIND[line.kind], line.coordinates, stated)
    for edge in _find_other_edges(tin):
        writer.add_line("CONSTRAINED_EDGES", points[edge], (CONSTRAINED, "", ""))


def _find_other_edges(tin: TIN) -> Int64Array:
    """Return the constrained edges that belong to no line, (k, 2) vertices."""
    pairs = np.stack(directed_edges(tin.triangles), axis=-1)[tin.constrained]
    keys, first = np.unique(edge_keys(pairs, len(tin.points)), return_index=True)
    known = edge_keys(tin.lines.segments(), len(tin.points))
    others: Int64Array = pairs[np.sort(first[~np.isin(keys, known)])]
    return others


def select_texts(obj: TIN | Survey | Features) -> dict[str, AnyArray]:
    """Return the texts of points that a drawing holds, and tell of other attributes."""
    if isinstance(obj, Surface) or (isinstance(obj, Features) and obj.kind != "points"):
        return {}
    attributes = obj.attributes if isinstance(obj, Survey) else obj.columns
    reason = "a drawing has the number and the description of a point"
    return select_attributes(attributes, ("number", "description"), reason)


def add_survey(
    writer: EntityWriter,
    survey: Survey,
    texts: dict[str, AnyArray],
    factor: float,
    *,
    labels: bool,
) -> None:
    """Add points with their texts and labels, and lines."""
    _add_points(writer, scale_elevations(survey.points, factor), texts, labels=labels)
    for line in list_lines(survey, factor):
        stated = (line.kind, line.name, line.polygon or "", str(line.priority))
        writer.add_line(_LAYER_OF_KIND[line.kind], line.coordinates, stated)


def add_features(
    writer: EntityWriter,
    features: Features,
    texts: dict[str, AnyArray],
    factor: float,
    *,
    labels: bool,
) -> None:
    """Add points, lines or the rings of polygons; contours on layers of their own."""
    if features.kind == "points":
        rows = features.coordinates
        if not features.has_elevations:
            rows = np.column_stack([rows, np.zeros(len(rows))])
        points = scale_elevations(np.nan_to_num(rows, nan=0.0), factor)
        _add_points(writer, points, texts, labels=labels)
        return
    names = _choose_layers(features)
    for line in list_lines(features, factor):
        rows, layer = line.coordinates, names[line.source or 0]
        if rows.shape[1] == 3 and np.ptp(rows[:, 2]) == 0 and rows[0, 2] != 0:
            writer.add_contour(layer, rows)
        else:
            writer.add_line(layer, rows)


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


# ------------------------------------------------------------------ points


def _add_points(
    writer: EntityWriter, points: Float64Array, texts: dict[str, AnyArray], *, labels: bool
) -> None:
    if len(points) == 0:
        return
    numbers, descriptions = (
        _find_texts(texts, name, len(points)) for name in ("number", "description")
    )
    writer.add_points("POINTS", points, list(zip(numbers, descriptions, strict=True)))
    if not labels:
        return
    height = _choose_height(points)
    elevations = [f"{z:.2f}" for z in points[:, 2].tolist()]
    columns = (("NUMBERS", numbers), ("ELEVATIONS", elevations), ("DESCRIPTIONS", descriptions))
    for k, (name, shown) in enumerate(columns):
        beside = np.array([height * 0.5, height * (0.5 - 1.5 * k), 0.0])
        writer.add_texts(f"POINT_{name}", points + beside, shown, height)


def _find_texts(texts: dict[str, AnyArray], name: str, count: int) -> list[str]:
    if name not in texts:
        return [""] * count
    values = texts[name].tolist()
    return ["" if one is None or one != one else str(one) for one in values]


def _choose_height(points: Float64Array) -> float:
    """Return a height of text that leaves neighbours room, with two digits."""
    width, depth = np.ptp(points[:, :2], axis=0).tolist()
    distance = max(width, depth) / max(len(points), 1) ** 0.5 if max(width, depth) > 0 else 5.0
    return float(f"{distance * _SHARE:.2g}")
