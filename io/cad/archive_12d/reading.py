"""Read an archive of 12d Model: a tin with its own triangles, or strings as points and lines."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, get_args

import numpy as np

from ....base.errors import OptionError, ReadError, choice
from ....base.policies import DrawingContent, FacePolicy, LineKind
from ....base.sentences import FILE, counted, inflect, shown
from ...mesh import read_content
from ..drawing import Drawing
from ..reference import Declared, Stated, choose_measures
from ..surfaces import Line, Mesh
from .content import Content, Tin, parse
from .names import CONSTRAINED, KIND, POLYGON, PRIORITY, SOURCE

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import Float64Array
    from ....base.crs import CrsLike, UnitLike
    from ....tin import TIN, Survey

_SAMPLE = 64
_KINDS = (*get_args(LineKind), "erase", CONSTRAINED)
_MOST_DIGITS = 9


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    unit: UnitLike | None = None,
    surface: str | int | None = None,
    content: DrawingContent | None = None,
    faces: FacePolicy = "most",
) -> TIN | Survey:
    """Read an archive of 12d Model (.12da).

    A TIN has the file's own triangles, those of a full_tin without the nulled ones, and the strings
    along its edges as lines. Otherwise strings are a survey: vertices of those with ``breakline
    point`` and single vertices are points, others breaklines, draped where they have no elevation.
    The file tells neither CRS nor units. What was left out is in the notes.

    Parameters
    ----------
    unit : Unit or str, optional
        Declares the unit of coordinates and elevations.
    surface : str or int, optional
        Name of the tin, or its number in the file, from 1; needed if there are several.
    content : {"surface", "source", "points"}, optional
        The triangles of a tin; the points and lines of strings; or points alone. Default triangles
        if there are any.

    Raises
    ------
    ReadError
        Also if a block does not end, a word is no number, there is nothing of the kind, or several
        tins and no name is given.
    """
    if content is not None:
        choice("content", content, DrawingContent)
    declared = Declared.of(crs, unit, elevation_unit)
    found = parse(read_content(path))
    tin = None if content in ("source", "points") else _choose_tin(found, surface)
    if content == "surface" and tin is None:
        raise ReadError(f"{FILE} has no tin with triangles.")
    lines = _list_lines(found)
    points = _gather_points(found) if tin is None else np.empty((0, 3))
    parts = [points if tin is None else tin.points, *(one.coordinates for one in lines)]
    rows = np.concatenate([one[:, :2] for one in parts])
    rows = rows[np.isfinite(rows).all(axis=1)]
    sample = rows[:: max(1, len(rows) // _SAMPLE)]
    measures = choose_measures(Stated(), declared, sample=sample)
    if declared.unit is None and measures.elevation_unit is None:
        measures = measures.noting("The archive names no unit of lengths.", first=True)
    frame = Drawing(
        path=path,
        measures=measures,
        declared=declared,
        is_crs_declared=True,
        notes=_describe(found, tin),
    )
    if tin is not None:
        mesh = Mesh(tin.points, tin.triangles, None, [])
        drawing = replace(frame, mesh=mesh, lines=lines)
        return drawing.to_tin(faces).with_name(tin.name)
    with_lines = content != "points"
    if not len(points) and not (with_lines and lines):
        raise ReadError(
            f"{FILE} has {'neither points nor lines' if with_lines else 'no points'} in its "
            "strings."
        )
    return replace(frame, points=points, lines=lines if with_lines else ()).to_survey()


def _choose_tin(found: Content, wanted: str | int | None) -> Tin | None:
    """Return the tin of a name or number, or the only one that has triangles."""
    if wanted is None:
        able = [one for one in found.tins if len(one.triangles)]
        if len(able) > 1:
            names = ", ".join(shown(one.name) for one in able[:8])
            raise ReadError(
                f"{FILE} has {len(able)} tins: name one by the option `surface` ({names})."
            )
        return able[0] if able else None
    if isinstance(wanted, bool) or not isinstance(wanted, str | int) or wanted == "":
        raise OptionError("surface", wanted, "the name of a tin, or its number from 1")
    if isinstance(wanted, int):
        called = found.tins[wanted - 1 : wanted] if wanted > 0 else []
    else:
        called = [one for one in found.tins if one.name == wanted.strip()]
    if len(called) != 1:
        names = ", ".join(shown(one.name) for one in found.tins[:8]) or "none"
        raise ReadError(f"{FILE} has {len(called)} tins {shown(wanted)}: there are {names}.")
    if not len(called[0].triangles):
        raise ReadError(f"{FILE}: the tin {shown(wanted)} has no visible triangles.")
    return called[0]


def _gather_points(found: Content) -> Float64Array:
    """Return the vertices of strings that are points, those with an elevation."""
    parts = [one.rows for one in found.strings if not one.is_line or len(one.rows) == 1]
    points = np.concatenate([np.empty((0, 3)), *parts])
    kept: Float64Array = points[~np.isnan(points[:, 2])]
    return kept


def _list_lines(found: Content) -> list[Line]:
    lines = []
    for one in found.strings:
        if not one.is_line or len(one.rows) < 2:
            continue
        kind = one.attributes.get(KIND, "")
        source, priority = one.attributes.get(SOURCE, ""), one.attributes.get(PRIORITY, "")
        has_elevations = not np.isnan(one.rows[:, 2]).any()
        lines.append(
            Line(
                one.rows if has_elevations else one.rows[:, :2],
                kind if kind in _KINDS else "hard",
                one.name,
                source=int(source) if _is_count(source) else None,
                polygon=one.attributes.get(POLYGON),
                priority=int(priority) if _is_count(priority.removeprefix("-")) else 0,
            )
        )
    return lines


def _is_count(text: str) -> bool:
    return text.isascii() and text.isdecimal() and len(text) <= _MOST_DIGITS


def _describe(found: Content, tin: Tin | None) -> list[str]:
    notes = []
    if found.left_out:
        what = ", ".join(f"{count:,} {shown(kind)}" for kind, count in found.left_out.items())
        notes.append(f"Left out of the archive: {what}.")
    n_curved = sum(one.is_curved for one in found.strings)
    if n_curved:
        what = f"{counted(n_curved, 'string')} [has|have] curves between vertices, which were read"
        notes.append(f"{inflect(what, n_curved)} as straight lines.")
    no_height = [np.isnan(one.rows[:, 2]) for one in found.strings]
    if tin is None:
        is_point = [not one.is_line or len(one.rows) == 1 for one in found.strings]
        lost = sum(int(one.sum()) for one, flag in zip(no_height, is_point, strict=True) if flag)
        if lost:
            notes.append(f"{counted(lost, 'point')} without elevation left out.")
        draped = [one for one, flag in zip(no_height, is_point, strict=True) if not flag]
        n_draped = sum(bool(one.any()) for one in draped)
        if n_draped:
            n_partly = sum(bool(one.any() and not one.all()) for one in draped)
            partly = f", {n_partly:,} of them only in part" if n_partly else ""
            notes.append(
                f"{counted(n_draped, 'string')} without elevations{partly}: will be draped on the "
                "surface."
            )
    elif tin.n_hidden:
        notes.append(
            f"Skipped: {counted(tin.n_hidden, 'triangle')} that [is|are] nulled or outside."
        )
        notes[-1] = inflect(notes[-1], tin.n_hidden)
    n_other = len(found.tins) - (tin is not None)
    if n_other:
        notes.append(f"Not read: {counted(n_other, 'tin' if tin is None else 'other tin')}.")
    return notes
