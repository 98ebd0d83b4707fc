"""Read a drawing: a surface of faces with its own triangles, or points and lines.

Equal corners of faces are joined, and quadrilaterals cut in two.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, get_args

import numpy as np

from ....base.errors import ReadError, choice
from ....base.policies import DrawingContent, FacePolicy, LineKind
from ....base.sentences import FILE, counted
from ....tin.topology import find_offsets
from ...mesh import cut_into_fans, join_places
from ..drawing import Drawing
from ..reference import Declared, Measures, choose_measures
from ..surfaces import Line, Mesh
from .layers import CONSTRAINED
from .model_space import ModelSpace, read_model_space

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import AnyArray, BoolArray, Float64Array
    from ....base.crs import CrsLike, UnitLike
    from ....tin import TIN, Survey

_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)", re.ASCII)
_PRIORITY = re.compile(r"-?[0-9]{1,15}", re.ASCII)
_SAMPLE = 64
_KINDS = (*get_args(LineKind), "erase", CONSTRAINED)
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
    found = read_model_space(path, layer=layer, texts=texts, tolerance=tolerance)
    kind = content or _choose_content(found)
    frame = Drawing(
        path=path,
        measures=_choose_measures(found, declared),
        declared=declared,
        is_crs_declared=found.stated.crs is None,
    )
    if kind == "surface":
        return _gather_surface(found, frame).to_tin(faces)
    with_lines = kind == "source"
    points, attributes, notes = _gather_points(found)
    lines = _name_lines(found) if with_lines else []
    if not len(points) and not lines:
        raise ReadError(
            f"{FILE} has {'neither points nor lines' if with_lines else 'no points'} in "
            "the layers read."
        )
    n_draped = sum(
        one.coordinates.shape[1] == 2 and one.kind not in ("boundary", "hole", "erase")
        for one in lines
    )
    if n_draped:
        notes.append(
            f"{counted(n_draped, 'line')} of plane entities without elevation will be draped on "
            "the surface."
        )
    if len(found.arrays["faces"]):
        notes.append(f"Not read: {counted(len(found.arrays['faces']), 'face')}.")
    notes += found.describe_left_out()
    return replace(
        frame, points=points, attributes=attributes, lines=lines, notes=notes
    ).to_survey()


def _choose_content(found: ModelSpace) -> str:
    """Return "surface" if there are faces, and all points are corners of them."""
    faces, points = found.arrays["faces"], found.arrays["points"]
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


def _choose_measures(found: ModelSpace, declared: Declared) -> Measures:
    arrays = found.arrays
    rows = np.concatenate([arrays[name].reshape(-1, 3) for name in ("points", "faces", "lines")])
    stated = found.stated
    sample = rows[:: max(1, len(rows) // _SAMPLE), :2]
    measures = choose_measures(stated, declared, sample=sample)
    if stated.unit is not None and declared.unit is None:
        return measures.noting(f"Lengths are in {stated.unit.name}, by $INSUNITS.", first=True)
    if stated.unit is None and declared.unit is None and measures.elevation_unit is None:
        return measures.noting("The drawing names no unit of lengths ($INSUNITS).", first=True)
    return measures


# ------------------------------------------------------------------ a surface


def _gather_surface(found: ModelSpace, frame: Drawing) -> Drawing:
    faces = found.arrays["faces"]
    if len(faces) == 0:
        raise ReadError(f"{FILE} has no faces (3DFACE, polyface or MESH) in the layers read.")
    notes = found.describe_left_out()
    return replace(frame, mesh=make_mesh(faces), lines=_name_lines(found), notes=notes)


def _name_lines(found: ModelSpace) -> list[Line]:
    """Return lines with what drawings that were written here say of them, else their layers."""
    layers, numbers = found.value["layers"], found.arrays["line_layers"].tolist()
    stated = found.value["line_names"] or [()] * len(numbers)
    lines = []
    for rows, own, layer in zip(found.lines, stated, numbers, strict=True):
        kind, name, number, priority = (
            [*own, "", "", "", ""] if own else ["", layers[layer], "", ""]
        )[:4]
        lines.append(
            Line(
                rows,
                kind if kind in _KINDS else "hard",
                name,
                source=int(number) if number.isdecimal() and len(number) < 10 else None,
                polygon=number or None,
                priority=int(priority) if _PRIORITY.fullmatch(priority) else 0,
            )
        )
    return lines


def _gather_points(
    found: ModelSpace,
) -> tuple[Float64Array, dict[str, AnyArray], list[str]]:
    """Return points, those of texts that are numbers last, their columns, and notes."""
    points, value = found.arrays["points"], found.value
    layers = [value["layers"][k] for k in found.arrays["point_layers"].tolist()]
    attributes: dict[str, AnyArray] = {}
    places = found.arrays["text_places"]
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


_NO_AREA = 1e-12
"""Share of the squared length of a triangle that is no area, but the rounding of its corners."""


def make_mesh(faces: Float64Array) -> Mesh:
    """Return points in the order in which faces name them, and triangles.

    Parameters
    ----------
    faces : (m, 4, 3) float64 array
        Corners; a triangle repeats one.
    """
    points, numbers = join_places(faces.reshape(-1, 3))
    corners = numbers.reshape(-1, 4)
    is_new = corners != np.roll(corners, 1, axis=1)
    is_new[:, 2] &= corners[:, 2] != corners[:, 0]
    is_new[:, 3] &= corners[:, 3] != corners[:, 1]
    counts = is_new.sum(axis=1)
    kept = counts > 2
    if not kept.any():
        raise ReadError("none of its faces has three corners.")
    notes: list[str] = []
    if not kept.all():
        lines = counted(int((~kept).sum()), "face")
        notes.append(f"Left out: {lines} with fewer than three different corners.")
    used = corners[kept][is_new[kept]]
    quads = corners[kept & (counts == 4)]
    triangles = cut_into_fans(used, find_offsets(counts[kept]), points).triangles
    with np.errstate(over="ignore", invalid="ignore"):  # what is too large is refused later
        if len(quads):
            notes.append(_describe_quads(points[quads]))
        corners = points[triangles]
        u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = np.linalg.norm(np.cross(u, v), axis=1)
        longest = np.maximum((u * u).sum(axis=1), (v * v).sum(axis=1))
        is_line: BoolArray = area <= _NO_AREA * longest
    if is_line.any() and not is_line.all():
        notes.append(f"Left out: {counted(int(is_line.sum()), 'triangle')} without any area.")
        triangles = triangles[~is_line]
    return Mesh(points, triangles, None, notes)


def _describe_quads(corners: Float64Array) -> str:
    """Tell how many quadrilaterals were cut, and of how many the cut shapes the surface."""
    a, b, c, d = (corners[:, k] for k in range(4))
    normal = np.cross(b - a, c - a)
    apart = np.abs(((d - a) * normal).sum(axis=1))
    size = np.linalg.norm(normal, axis=1) * np.linalg.norm(c - a, axis=1)
    n_bent = int((apart > 1e-9 * size).sum())
    text = f"{counted(len(corners), 'face')} of four corners cut in two along an inner diagonal"
    bent = counted(n_bent, "face")
    return f"{text}." if not n_bent else f"{text}: {bent} of them not plane, so the cut matters."
