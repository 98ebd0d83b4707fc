"""The definition of a surface as a mesh, and the lines of its source data along its edges."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

import numpy as np

from ....base.errors import ReadError
from ....base.policies import LineKind
from ....base.sentences import counted
from ..surfaces import Line, Mesh
from .content import KIND, LINE, SOURCE

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array
    from . import content
    from .content import Content, Surface

NO_ELEVATIONS = frozenset({"nondestructive", "proximity"})
"""Types of breaklines that take their elevations from the surface."""

_BOUNDARY_KINDS = {"outer": "outer", "void": "void", "island": "island", "hide": "void",
                   "show": "island"}  # fmt: skip
_KINDS: dict[str, LineKind] = {"outer": "boundary", "void": "hole"}
_OPPOSITE = (2, 0, 1)
"""The corner opposite side 1, 2, 3 of a face: sides join its corners in their order."""


def make_mesh(found: Content, surface: Surface) -> Mesh:
    """Return the points and the visible triangles of a surface."""
    if surface.kind.lower() == "grid":
        raise ReadError(
            f"surface {surface.label} is a grid (surfType='grid'), and only TIN surfaces are read."
        )
    if not surface.faces:
        hidden = f", but {counted(surface.n_hidden, 'invisible one')}" if surface.n_hidden else ""
        raise ReadError(f"surface {surface.label} has no visible faces{hidden}.")
    ids = np.concatenate(surface.ids or [np.empty(0, np.int64)])
    points = np.concatenate(surface.points or [np.empty((0, 3))])
    if surface.references:
        points = resolve_references(points, surface.references, found)
    faces = np.concatenate(surface.faces)
    order = np.argsort(ids, kind="stable")
    ordered = ids[order]
    _require_unique(ordered, points[order], surface)
    at = np.searchsorted(ordered, faces)
    at = np.minimum(at, max(len(ordered) - 1, 0))
    wrong = ordered[at] != faces if len(ordered) else np.ones(faces.shape, np.bool_)
    if wrong.any():
        row, corner = np.argwhere(wrong)[0].tolist()
        raise ReadError(
            f"visible face {row + 1} of surface {surface.label} names point "
            f"{faces[row, corner]}, and there is no point with this id."
        )
    triangles: Int64Array = order[at]
    notes = [f"Skipped: {counted(surface.n_hidden, 'invisible face')}."] * bool(surface.n_hidden)
    if surface.point_files:
        notes.append(describe_point_files(surface))
    sides = np.frombuffer(surface.sides, np.uint8)
    if not sides.any():
        flags = None
    else:
        flags = np.zeros((len(sides), 3), np.bool_)
        for side, corner in enumerate(_OPPOSITE):
            flags[:, corner] = sides >> side & 1 == 1
    return Mesh(points[:, [1, 0, 2]], triangles, flags, notes)


def describe_point_files(surface: Surface) -> str:
    """Name the files that hold points of the source data."""
    names = ", ".join(f"'{name[:60]}'" for name in surface.point_files[:5])
    return f"Its source data name point files, which are not read: {names}."


def _require_unique(ids: Int64Array, points: Float64Array, surface: Surface) -> None:
    twice = ids[1:] == ids[:-1]
    if not twice.any():
        return
    differ = twice & (points[1:] != points[:-1]).any(axis=1)
    if differ.any():
        raise ReadError(
            f"in surface {surface.label} the id {ids[1:][np.argmax(differ)]} stands for two points."
        )


def resolve_references(
    points: Float64Array, references: dict[int, str], found: Content
) -> Float64Array:
    """Return points with those that refer to survey points by name."""
    rows, row_of = found.points.rows, {name: k for k, name in enumerate(found.points.names)}
    points = points.copy()
    for row, name in references.items():
        if name not in row_of:
            raise ReadError(
                f"a point refers to the survey point '{name[:60]}', which there is not."
            )
        points[row] = rows[row_of[name]]
    return points


def list_edge_lines(surface: Surface) -> list[Line]:
    """Return the breaklines and boundaries that may run along edges, in their order of old."""
    found = []
    for line in surface.lines:
        own = line.properties.get(KIND, "")
        if line.element == "Breakline":
            if own in get_args(LineKind):
                kind = next(kind for kind in get_args(LineKind) if kind == own)
            else:
                kind = None if line.attributes.get("brkType") in NO_ELEVATIONS else "hard"
        else:
            kind = _KINDS.get(find_boundary_kind(line)) if line.element == "Boundary" else None
        number, source = (_find_number(line, name) for name in (LINE, SOURCE))
        for part in line.coordinates:
            if kind is not None and len(part) > 1:
                one = Line(_close(line, part)[:, [1, 0]], kind, name_line(line), source)
                found.append((len(surface.lines) if number is None else number, one))
    return [line for _, line in sorted(found, key=lambda one: one[0])]


def _find_number(line: content.Line, name: str) -> int | None:
    text = line.properties.get(name, "")
    return int(text) if text.isascii() and text.isdecimal() and len(text) < 10 else None


def _close(line: content.Line, part: Float64Array) -> Float64Array:
    is_open = line.element == "Boundary" and (part[0, :2] != part[-1, :2]).any()
    return np.concatenate([part, part[:1]]) if is_open else part


def find_boundary_kind(line: content.Line) -> str:
    """Return "outer", "void" or "island"; "" for boundaries of other things, such as textures."""
    return _BOUNDARY_KINDS.get(line.attributes.get("bndType", "").strip().lower(), "")


def name_line(line: content.Line) -> str:
    """Return the name of a line, else its description."""
    return line.attributes.get("name", "").strip() or line.attributes.get("desc", "").strip()
