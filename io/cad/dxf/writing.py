"""Write a drawing: triangles, lines, points with labels and contours, each on a layer of its own.

Header, tables and layers are made by ezdxf. The CRS stands among the properties of the drawing,
where programs show it; the names and kinds of lines, numbers and descriptions of points in extended
data.
"""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.atomic import replacing
from ....base.checks import as_flag, as_length
from ....base.errors import FormatError, choice
from ....base.notes import warn
from ....base.policies import DrawingVersion
from ....base.results import Features
from ....base.sentences import FILE
from ....terrain import contour_labels
from ....terrain.drawing import fixed_dxf_dates, set_paper
from ....tin import TIN, Surface, Survey
from ....tin.topology import directed_edges, edge_keys
from ...registry import select_attributes, warn_of_unknown_elevations
from ..drawing import choose_length_unit, list_lines, scale_elevations
from .entities import EntityWriter, Lettering
from .layers import (
    APPLICATION,
    CONSTRAINED,
    CRS_PROPERTY,
    ELEVATION_PROPERTY,
    HEAVY,
    LAYERS,
    UNKNOWN,
    find_code,
)

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int64Array
    from ....base.crs import Unit, UnitLike
    from ....base.progress import Tell
    from .entities import EntityWriter

_CHUNK = 10_000
_CUT_FILL = "cut_fill"
"""A column of points that are set out: "C 0.350", "F 1.200"."""
_WIDE = 1.4
"""Width of a window by its height, about that of the paper."""
_AIR = 1.1
_ALONE = 5.0
"""What stands for the mean distance of points where there is none, in CRS units."""
_CROSS = 3
"""The mark of points, of ``$PDMODE``; the usual one is a dot, which is not seen."""
_PAPER = (420.0, 297.0)
"""Millimetres: A3, landscape, the paper that a drawing fits on."""
_FARTHEST = 40e6
"""Millimetres: how far a drawing may lie from its origin at the scale of the paper. LibreCAD counts
pixels, 1200 to an inch, in 32 bits: what lies farther is not on its page."""


def write(
    obj: TIN | Survey | Features,
    path: Path,
    *,
    version: DrawingVersion = "R2010",
    unit: UnitLike | None = None,
    labels: bool = True,
    label_height: float | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a TIN, a survey, or features as a DXF drawing.

    Triangles become 3DFACEs on the layer TIN, lines 3D polylines on BREAKLINES, BOUNDARY and so on,
    contours plane polylines with an elevation on CONTOURS and INDEX_CONTOURS, points POINTs. Labels
    of contours are texts along them on CONTOUR_LABELS; they hide the line behind them, but in R12.

    Parameters
    ----------
    version : {"R2010", "R12"}
        R12 is read by nearly every program, and has no units and no CRS.
    unit : Unit or str, optional
        Unit of coordinates and elevations, where the CRS does not tell.
    labels : bool
        Write number, elevation and description of points, and cut and fill of points that are set
        out, as texts on layers of their own; label contours, index contours alone if there are
        some.
    label_height : float, optional
        Height of these texts, in the unit of coordinates; default a share of how far points, or
        labels of a contour, are apart.

    Raises
    ------
    OptionError
        If there is no such version, or the unit is not that of the CRS.
    WriteError
        Also if the unit is one that DXF does not have.
    CrsError
        If coordinates are angles.

    Warns
    -----
    LossWarning
        If elevations are converted, as a drawing has one unit for all lengths, or none are known;
        if attributes are left out, or line breaks in texts.
    """
    if not isinstance(obj, Surface | Survey | Features):
        raise FormatError(f"Cannot write {FILE}: a {type(obj).__name__} is no surface or survey.")
    choice("version", version, DrawingVersion)
    height = None if label_height is None else as_length("label_height", label_height)
    lettering = _Labelling(as_flag("labels", labels), height)
    ezdxf = optional.load("ezdxf", "Writing DXF drawings")
    along, factor = choose_length_unit(
        obj, unit, is_known=lambda one: find_code(one) > 0, format_name="DXF"
    )
    if version == "R12" and obj.crs is not None:
        warn(f"{FILE} keeps no CRS and no unit: R12 has no place for them.")
    with fixed_dxf_dates():
        document = _make_document(ezdxf, obj, version, along, factor)
        stream = io.StringIO(newline="\n")
        document.write(stream)
        text = stream.getvalue().replace("\r\n", "\n")
        start = text.index("ENTITIES\n") + len("ENTITIES\n")
        end = text.index("  0\nENDSEC\n", start)
        owner = document.modelspace().layout_key
        first = int(str(document.entitydb.handles), 16)
        writer = EntityWriter(is_r12=version == "R12", owner=owner, first_handle=first)
        encoding = "utf-8" if version != "R12" else str(document.output_encoding)
        head, tail = text[:start], text[end:]
    texts = select_texts(obj)
    if isinstance(obj, Surface):
        add_tin(writer, obj, factor)
    elif isinstance(obj, Survey):
        add_survey(writer, obj, texts, factor, lettering)
    else:
        add_features(writer, obj, texts, factor, lettering)
    warn_of_unknown_elevations(obj)
    with replacing(path) as file:
        file.write(_encode(_count_handles(head, writer), encoding))
        for start in range(0, len(writer.parts), _CHUNK):
            file.write(_encode("".join(writer.parts[start : start + _CHUNK]), encoding))
            if progress is not None:
                progress(start / len(writer.parts))
        file.write(_encode(tail, encoding))
    if progress is not None:
        progress(1.0)


def _encode(text: str, encoding: str) -> bytes:
    return text.encode(encoding, "dxfreplace" if encoding != "utf-8" else "replace")


# ------------------------------------------------------------------ the file around it


def _make_document(
    ezdxf: Any, obj: TIN | Survey | Features, version: str, unit: Unit | None, factor: float
) -> Any:
    """Return an empty drawing with units, layers and properties, the same at any time."""
    document = ezdxf.new(version)
    if version != "R12":
        document.header["$INSUNITS"] = find_code(unit)
        document.header["$MEASUREMENT"] = int(unit is None or unit.name.endswith("metre"))
    document.appids.add(APPLICATION)
    for name, colour in LAYERS.items():
        layer = document.layers.add(name, color=colour)
        if version != "R12" and name in HEAVY:
            layer.dxf.lineweight = HEAVY[name]
    _set_view(document, obj, factor, unit)
    if obj.crs is not None:
        document.header.custom_vars.append(CRS_PROPERTY, " ".join(str(obj.crs).split()))
        if obj.elevation_unit is None:
            document.header.custom_vars.append(ELEVATION_PROPERTY, UNKNOWN)
    return document


def _set_view(
    document: Any, obj: TIN | Survey | Features, factor: float, unit: Unit | None
) -> None:
    """Let programs open and print the drawing with all that is in it in view."""
    points = obj.coordinates if isinstance(obj, Features) else obj.points
    if isinstance(obj, Survey):
        lines = [np.asarray(getattr(line, "coords", line))[:, :2] for line in obj.breaklines]
        points = np.vstack([points[:, :2], *lines]) if len(points) == 0 else points
    if len(points) == 0:
        return
    known = np.column_stack([points, np.zeros(len(points))])[:, :3] * (1.0, 1.0, factor)
    known = np.nan_to_num(known)
    low, high = known.min(axis=0), known.max(axis=0)
    document.modelspace().reset_extents(tuple(low.tolist()), tuple(high.tolist()))
    middle, sides = (low + high)[:2] / 2, (high - low)[:2]
    height = float(max(sides[1], sides[0] / _WIDE)) * _AIR
    height = height or 2.0 * _ALONE
    document.set_modelspace_vport(height, center=tuple(middle.tolist()))
    if isinstance(obj, Survey) or (isinstance(obj, Features) and obj.kind == "points"):
        document.header["$PDMODE"] = _CROSS
        document.header["$PDSIZE"] = _choose_height(points)
    mm_per_unit = min(_PAPER[1] / height, _FARTHEST / max(float(np.abs(middle).max()), 1.0))
    west, south = middle - np.array(_PAPER) / mm_per_unit / 2
    set_paper(document, _PAPER, (float(west), float(south)), mm_per_unit, unit)


def _count_handles(head: str, writer: EntityWriter) -> str:
    """Let the header name the first handle that is free."""
    before, mark, after = head.partition("$HANDSEED\n")
    if not mark:
        return head
    code, _, rest = after.partition("\n")
    _, _, rest = rest.partition("\n")
    return f"{before}{mark}{code}\n{writer.next_handle + 1:X}\n{rest}"


_LAYER_OF_KIND = {
    "hard": "BREAKLINES",
    "soft": "SOFT_BREAKLINES",
    "boundary": "BOUNDARY",
    "hole": "HOLES",
    "erase": "ERASE",
    "water": "WATER",
}
_LABELS = {
    "number": "POINT_NUMBERS",
    "elevation": "POINT_ELEVATIONS",
    "description": "POINT_DESCRIPTIONS",
    _CUT_FILL: "POINT_CUT_FILL",
}
"""Of what is written beside points, from top to bottom, the layer."""
_SHARE = 0.2
"""Height of labels as a share of the mean distance of points."""
_SHARE_OF_EXTENT = 0.007
"""Height of labels of contours as a share of how far they reach."""


_CONTOURS = ("contours", "elevation", "is_index", "is_closed")
_CONTOUR_LABELS = ("contour labels", "text", "elevation", "rotation")
"""Names of features, and of columns that such have."""


class _Labelling(NamedTuple):
    """Whether points and contours are labelled, and how high texts are, if that is given."""

    is_wanted: bool
    height: float | None


def add_tin(writer: EntityWriter, tin: TIN, factor: float) -> None:
    """Add triangles and lines."""
    points = scale_elevations(tin.points, factor)
    writer.add_faces("TIN", points[tin.triangles])
    for line in list_lines(tin, factor):
        stated = (line.kind, line.name, str(line.source))
        writer.add_line(_LAYER_OF_KIND[line.kind], line.coordinates, stated)
    pairs = np.stack(directed_edges(tin.triangles), axis=-1)[tin.constrained]
    keys, first = np.unique(edge_keys(pairs, len(tin.points)), return_index=True)
    known = edge_keys(tin.lines.segments(), len(tin.points))
    others: Int64Array = pairs[np.sort(first[~np.isin(keys, known)])]
    for edge in others:
        writer.add_line("CONSTRAINED_EDGES", points[edge], (CONSTRAINED, "", ""))


def select_texts(obj: TIN | Survey | Features) -> dict[str, AnyArray]:
    """Return the texts of points that a drawing holds, and tell of other attributes."""
    if isinstance(obj, Surface):
        return {}
    if isinstance(obj, Features) and (obj.kind != "points" or _are(obj, _CONTOUR_LABELS)):
        return {}
    attributes = obj.attributes if isinstance(obj, Survey) else obj.columns
    reason = "a drawing has the number and the description of a point"
    return select_attributes(attributes, ("number", "description", _CUT_FILL), reason)


def add_survey(
    writer: EntityWriter,
    survey: Survey,
    texts: dict[str, AnyArray],
    factor: float,
    labelling: _Labelling,
) -> None:
    """Add points with their texts and labels, and lines."""
    points = scale_elevations(survey.points, factor)
    _add_points(writer, points, points[:, 2], texts, labelling)
    for line in list_lines(survey, factor):
        stated = (line.kind, line.name, line.polygon or "", str(line.priority))
        writer.add_line(_LAYER_OF_KIND[line.kind], line.coordinates, stated)


def add_features(
    writer: EntityWriter,
    features: Features,
    texts: dict[str, AnyArray],
    factor: float,
    labelling: _Labelling,
) -> None:
    """Add points, lines or the rings of polygons; contours on layers of their own."""
    if _are(features, _CONTOUR_LABELS):
        _add_contour_labels(writer, features, factor, labelling.height)
        return
    if features.kind == "points":
        rows = features.coordinates
        if not features.has_elevations:
            rows = np.column_stack([rows, np.zeros(len(rows))])
        rows = scale_elevations(rows, factor)
        elevations = rows[:, 2] if features.has_elevations else np.full(len(rows), np.nan)
        _add_points(writer, np.nan_to_num(rows, nan=0.0), elevations, texts, labelling)
        return
    names = _choose_layers(features)
    for line in list_lines(features, factor):
        rows, layer = line.coordinates, names[line.source or 0]
        if rows.shape[1] == 3 and np.ptp(rows[:, 2]) == 0 and rows[0, 2] != 0:
            writer.add_contour(layer, rows)
        else:
            writer.add_line(layer, rows)
    if labelling.is_wanted and _are(features, _CONTOURS):
        labels = contour_labels(features)
        _add_contour_labels(writer, labels, factor, labelling.height)


def _are(features: Features, kind: tuple[str, ...]) -> bool:
    """Whether features are of a name, and have the columns that such have."""
    return features.name == kind[0] and all(name in features.columns for name in kind[1:])


def _add_contour_labels(
    writer: EntityWriter, labels: Features, factor: float, height: float | None
) -> None:
    """Add labels of contours; of elevations in another unit those of the drawing."""
    if len(labels) == 0:
        return
    places = scale_elevations(labels.coordinates, factor)
    texts = [str(one) for one in labels.columns["text"].tolist()]
    if factor != 1.0:
        texts = [f"{z:.2f}" for z in places[:, 2].tolist()]
    if height is None:
        box = labels.bounds
        extent = max(box.xmax - box.xmin, box.ymax - box.ymin)
        height = float(f"{extent * _SHARE_OF_EXTENT:.2g}") or 1.0
    how = Lettering(height, labels.columns["rotation"].tolist())
    writer.add_labels("CONTOUR_LABELS", places, texts, how)


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
    writer: EntityWriter,
    points: Float64Array,
    elevations: Float64Array,
    texts: dict[str, AnyArray],
    labelling: _Labelling,
) -> None:
    """Add points, and what is written beside them; an elevation that is NaN is not."""
    if len(points) == 0:
        return
    found = {name: _find_texts(texts, name, len(points)) for name in _LABELS}
    stated = zip(found["number"], found["description"], strict=True)
    writer.add_points("POINTS", points, list(stated))
    if not labelling.is_wanted:
        return
    height = labelling.height or _choose_height(points)
    found["elevation"] = ["" if z != z else f"{z:.2f}" for z in elevations.tolist()]
    for k, (name, layer) in enumerate(_LABELS.items()):
        beside = np.array([height * 0.5, height * (0.5 - 1.5 * k), 0.0])
        writer.add_texts(layer, points + beside, found[name], height)


def _choose_height(points: AnyArray) -> float:
    """Return how high labels of points are, and marks of points, in CRS units."""
    extent = float(np.ptp(points[:, :2], axis=0).max())
    distance = extent / len(points) ** 0.5 if extent > 0 else _ALONE
    return float(f"{distance * _SHARE:.2g}")


def _find_texts(texts: dict[str, AnyArray], name: str, count: int) -> list[str]:
    if name not in texts:
        return [""] * count
    values = texts[name].tolist()
    return ["" if one is None or one != one else str(one) for one in values]
