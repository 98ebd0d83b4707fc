"""Read a drawing: a surface of faces with its own triangles, or points and lines."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from ....base.errors import LinesError, ReadError, choice
from ....base.policies import BreaklineKind, DrawingContent, FacePolicy, LineKind
from ....base.sentences import FILE, counted
from ....tin import Breakline, Survey, Water
from ....tin.constraints.breaklines import as_ring
from ....tin.screening.nodata import describe_elevations
from ...mesh.common import Reference, require_own_crs
from ..placing import place_rows
from ..reference import Declared, Measures, choose_measures
from ..surfaces import EdgeLine, make_tin_with_lines, merge_equal_points
from .drawing import Drawing, read_drawing
from .faces import make_mesh
from .names import CONSTRAINED

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array
    from ....base.crs import CrsLike, UnitLike
    from ....tin import TIN

__all__ = ["read"]

_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)", re.ASCII)
_PRIORITY = re.compile(r"-?[0-9]{1,15}", re.ASCII)
_SAMPLE = 64
_RINGS = frozenset({"boundary", "hole", "erase"})
_NUMBER_NAMES = ("number", "description")


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    unit: UnitLike | None = None,
    layer: str | None = None,
    content: DrawingContent | None = None,
    texts: bool = False,
    tolerance: float | None = None,
    faces: FacePolicy = "most",
) -> TIN | Survey:
    """Read a DXF drawing, text or binary.

    A TIN has the drawing's own triangles. Lines of a survey are breaklines; those of plane entities
    without elevation are draped. What was assumed or left out is in the notes. Points and lines are
    reprojected to ``crs``.

    Parameters
    ----------
    unit : Unit or str, optional
        Declares the unit of coordinates and elevations, where the drawing does not say, or where
        it says another one than its CRS.
    layer : str, optional
        Names or patterns of layers, with commas between ("TOPO*,BREAK?"); default all that are
        neither off nor frozen.
    content : {"surface", "source", "points"}, optional
        The triangles that 3DFACE, polyface and MESH entities make; points and lines; or points.
        Default triangles if there are any.
    texts : bool
        Take texts that are numbers as points of that elevation.
    tolerance : float, optional
        How far an arc or spline may lie from its chords, in the unit of the drawing; default a
        centimetre, or a hundredth of a unit that is not known.

    Raises
    ------
    ReadError
        Also if there is nothing of the kind, or faces and other points and no content is chosen; or
        if the unit is not that of the CRS.
    CrsError
        Also if a TIN is in another CRS.

    Notes
    -----
    Blocks are taken apart with scale, rotation and arrays; other files are not followed.
    """
    if content is not None:
        choice("content", content, DrawingContent)
    declared = Declared.of(crs, unit, elevation_unit)
    drawing = read_drawing(path, layer=layer, texts=texts, tolerance=tolerance)
    kind = content or _choose_content(drawing)
    measures = _choose_measures(drawing, declared)
    if kind == "surface":
        return _read_tin(drawing, measures, declared, faces)
    return _read_survey(drawing, measures, declared, with_lines=kind == "source")


def _choose_content(drawing: Drawing) -> str:
    """Return "surface" if there are faces, and all points are corners of them."""
    faces, points = drawing.arrays["faces"], drawing.arrays["points"]
    if len(faces) == 0:
        return "source"
    corners = faces.reshape(-1, 3)
    others = np.unique(points, axis=0)
    together = np.unique(np.concatenate([corners, others]), axis=0)
    n_other = len(together) - len(np.unique(corners, axis=0))
    if n_other:
        raise ReadError(
            f"{FILE} has {counted(len(faces), 'face')} and {counted(n_other, 'point')} "
            "that are no corners of them: choose `content='surface'` or `content='source'`, or "
            "name layers by the option `layer`."
        )
    return "surface"


def _choose_measures(drawing: Drawing, declared: Declared) -> Measures:
    arrays = drawing.arrays
    rows = np.concatenate([arrays[name].reshape(-1, 3) for name in ("points", "faces", "lines")])
    stated = drawing.stated
    sample = rows[:: max(1, len(rows) // _SAMPLE), :2]
    measures = choose_measures(stated, declared, sample=sample)
    if stated.unit is not None and declared.unit is None:
        return measures.noting(f"Lengths are in {stated.unit.name}, by $INSUNITS.", first=True)
    if stated.unit is None and declared.unit is None and measures.elevation_unit is None:
        return measures.noting("The drawing names no unit of lengths ($INSUNITS).", first=True)
    return measures


# ------------------------------------------------------------------ a surface


def _read_tin(drawing: Drawing, measures: Measures, declared: Declared, policy: FacePolicy) -> TIN:
    require_own_crs(measures.source, declared.crs)
    faces = drawing.arrays["faces"]
    if len(faces) == 0:
        raise ReadError(f"{FILE} has no faces (3DFACE, polyface or MESH) in the layers read.")
    mesh = make_mesh(measures.apply(faces.reshape(-1, 3)).reshape(-1, 4, 3))
    mesh = merge_equal_points(mesh)
    notes = [*measures.notes, *mesh.notes, *drawing.describe_left_out()]
    return make_tin_with_lines(
        mesh._replace(notes=notes),
        _select_edge_lines(drawing, measures),
        reference=Reference(
            measures.source, measures.elevation_unit, is_declared=drawing.stated.crs is None
        ),
        faces=policy,
    )


def _select_edge_lines(drawing: Drawing, measures: Measures) -> list[EdgeLine]:
    kinds: tuple[LineKind, ...] = get_args(LineKind)
    found = []
    for rows, stated in zip(drawing.lines, _name_lines(drawing), strict=True):
        kind = next((one for one in kinds if one == stated[0]), None)
        if stated[0] != CONSTRAINED and kind is None:
            kind = "hard"
        source = int(stated[2]) if stated[2].isdecimal() and len(stated[2]) < 10 else None
        found.append(EdgeLine(measures.apply(rows), kind, stated[1], source))
    return found


def _name_lines(drawing: Drawing) -> list[list[str]]:
    """Return kind, name, source and priority of each line; unnamed ones are called by layers."""
    stated = drawing.value["line_names"]
    layers, numbers = drawing.value["layers"], drawing.arrays["line_layers"].tolist()
    if not stated:
        return [["", layers[number], "", ""] for number in numbers]
    return [
        ([*one, "", "", "", ""][:4] if one else ["", layers[number], "", ""])
        for one, number in zip(stated, numbers, strict=True)
    ]


# ------------------------------------------------------------------ points and lines


def _read_survey(
    drawing: Drawing, measures: Measures, declared: Declared, *, with_lines: bool
) -> Survey:
    points, attributes, notes = _gather_points(drawing)
    lines = drawing.lines if with_lines else []
    if not len(points) and not lines:
        raise ReadError(
            f"{FILE} has {'neither points nor lines' if with_lines else 'no points'} in "
            "the layers read."
        )
    stated = _name_lines(drawing) if with_lines else []
    n_draped = sum(
        line.shape[1] == 2 and one[0] not in _RINGS for line, one in zip(lines, stated, strict=True)
    )
    if n_draped:
        notes.append(
            f"{counted(n_draped, 'line')} of plane entities without elevation will be draped on "
            "the surface."
        )
    if len(drawing.arrays["faces"]):
        notes.append(f"Not read: {counted(len(drawing.arrays['faces']), 'face')}.")
    placing = place_rows([points, *lines], measures, declared)
    survey = Survey(
        points=placing.rows[0],
        attributes=attributes,
        crs=placing.crs,
        elevation_unit=placing.elevation_unit,
        source=drawing.path.name,
        notes=[
            *placing.notes,
            *notes,
            *describe_elevations(placing.rows[0][:, 2]),
            *drawing.describe_left_out(),
        ],
    )
    try:
        return _add_lines(survey, placing.rows[1:], stated)
    except LinesError as error:
        raise ReadError(f"{error}") from error


def _add_lines(
    survey: Survey, lines: Sequence[Float64Array], stated: Sequence[Sequence[str]]
) -> Survey:
    """Add breaklines, and of drawings that were written here rings and water by their kinds."""
    found: dict[str, list[Any]] = {kind: [] for kind in ("boundary", "hole", "erase", "water", "")}
    polygons: dict[tuple[str, str], list[Float64Array]] = {}
    for rows, (kind, name, number, priority) in zip(lines, stated, strict=True):
        if kind == "water" and rows.shape[1] == 3:
            found[kind].append(Water(as_ring(rows, "water"), float(rows[0, 2]), name=name))
        elif kind in _RINGS:
            key = (kind, number or f"alone {len(polygons)}")
            polygons.setdefault(key, []).append(as_ring(rows, kind))
        else:
            found[""].append(_make_breakline(rows, kind, name, priority))
    for (kind, _), rings in polygons.items():
        found[kind].append(rings[0] if len(rings) == 1 else rings)
    return replace(
        survey,
        breaklines=found[""],
        boundary=found["boundary"],
        holes=found["hole"],
        erase=found["erase"],
        water=found["water"],
    )


def _make_breakline(rows: Float64Array, stated: str, name: str, priority: str) -> Breakline:
    kind: BreaklineKind = "soft" if stated == "soft" else "hard"
    rank = int(priority) if _PRIORITY.fullmatch(priority) else 0
    return Breakline(rows, kind=kind, name=name, priority=rank)


def _gather_points(
    drawing: Drawing,
) -> tuple[Float64Array, dict[str, AnyArray], list[str]]:
    """Return points, those of texts that are numbers last, their columns, and notes."""
    points, value = drawing.arrays["points"], drawing.value
    layers = [value["layers"][k] for k in drawing.arrays["point_layers"].tolist()]
    attributes: dict[str, AnyArray] = {}
    places = drawing.arrays["text_places"]
    is_number = np.array([_NUMBER.fullmatch(one.strip()) is not None for one in value["texts"]])
    notes = []
    if len(places):
        kept = places[is_number].copy()
        kept[:, 2] = [float(one) for one in value["texts"] if _NUMBER.fullmatch(one.strip())]
        points = np.concatenate([points, kept])
        layers += ["texts"] * len(kept)
        notes.append(
            f"Points that come from texts: {len(kept):,}; texts that are no numbers: "
            f"{int((~is_number).sum()):,}."
        )
    names = value["point_names"]
    for k, name in enumerate(_NUMBER_NAMES):
        column = [one[k] if len(one) > k else "" for one in names]
        if any(column):
            column += [""] * (len(points) - len(column))
            attributes[name] = np.array(column, object)
    if len(points):
        attributes["layer"] = np.array(layers, object)
    return points, attributes, notes
