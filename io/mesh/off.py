"""Object File Format (OFF): vertices and faces as text, every digit kept, elevation up.

Comments keep the CRS, ``# crs: EPSG:32616``, and the unit of elevations where it is known,
``# elevation unit: US survey foot``. Which edges are constrained is lost.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..._atomic import replacing
from ..._sentences import counted
from ...errors import ReadError
from .common import (
    choose_reference,
    cut_into_fans,
    format_crs,
    format_unit,
    make_survey,
    make_tin,
    read_content,
    require_tin,
)
from .text_rows import (
    describe_row_fault,
    parse_floats,
    parse_integer_columns,
    parse_integers,
    split_rows,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from ...arrays import Int64Array
    from ...crs import CrsLike, UnitLike
    from ...tin import TIN, Survey

__all__ = ["read", "write"]

_BATCH = 65_536
_KEYWORD = re.compile(r"(ST)?(C)?(N)?(4)?(n)?OFF")
_RECORD = re.compile(rb"^# (crs|elevation unit): (.*?)\s*$", re.M)


class _Counts(NamedTuple):
    vertices: int
    faces: int


def read(path: Path, *, crs: CrsLike | None = None, z_unit: UnitLike | None = None) -> TIN | Survey:
    """Read the vertices and faces of an OFF file in text; called as :class:`.Format` says.

    CRS and unit default to those in the comments ``# crs: ...`` and ``# elevation unit: ...``.
    Polygons are cut into triangles; normals, colours and texture (NOFF, COFF, STOFF) are skipped. A
    file without faces gives a survey.
    """
    content = read_content(path)
    rows, lines = split_rows(content)
    rows, lines = _skip_keyword(rows, lines, path)
    counts = _parse_counts(rows, lines, path)
    rows, lines = rows[1:], lines[1:]
    vertices, faces = slice(0, counts.vertices), slice(counts.vertices, sum(counts))
    points = parse_floats(
        rows[vertices],
        lines[vertices],
        path,
        columns=slice(0, 3),
        what="a vertex needs x, y and z",
    )
    found = {name.decode(): text.decode("utf-8", "replace")
             for name, text in _RECORD.findall(content)}  # fmt: skip
    reference = choose_reference(
        crs, z_unit, path, found_crs=found.get("crs"), found_unit=found.get("elevation unit")
    )
    if counts.faces == 0:
        return make_survey(points, path, reference=reference)
    corners, offsets = _parse_faces(rows[faces], lines[faces], path)
    made = cut_into_fans(corners, offsets, points, path)
    return make_tin(points, made.triangles, path, reference=reference, notes=made.notes)


def _skip_keyword(rows: list[str], lines: list[int], path: Path) -> tuple[list[str], list[int]]:
    """Return what stands behind the keyword, which some programs put before the counts."""
    first = rows[0].split() if rows else [""]
    keyword = first[0]
    found = _KEYWORD.fullmatch(keyword)
    if "BINARY" in first:
        raise ReadError(
            f"'{path}' is a binary OFF file, and only those in text are read: save it as that.",
            path=path,
        )
    if found is None:
        raise ReadError(
            f"'{path}' is no OFF file in text: it must begin with 'OFF', not '{keyword[:20]}'.",
            path=path,
        )
    if found[4] or found[5]:
        raise ReadError(
            f"'{path}' is an OFF file of {keyword}, vertices in more than three dimensions, which "
            "are no TIN.",
            path=path,
        )
    if len(first) > 1:
        return [" ".join(first[1:]), *rows[1:]], lines
    return rows[1:], lines[1:]


def _parse_counts(rows: Sequence[str], lines: Sequence[int], path: Path) -> _Counts:
    """Return the numbers of vertices and faces, once the file is long enough for them."""
    if not rows:
        raise ReadError(f"'{path}' ends before the numbers of its vertices and faces.", path=path)
    first = rows[0].split()
    if len(first) < 2:
        what = "the numbers of vertices and of faces are needed"
        raise describe_row_fault(first, lines[0], what, path)
    counts = _Counts(*parse_integers(first[:2], lines[0], path))
    if min(counts) < 0:
        raise describe_row_fault(first, lines[0], "a count is negative", path)
    if sum(counts) > len(rows) - 1:
        promised = counted(counts.vertices, "vertex", "vertices")
        raise ReadError(
            f"'{path}' ends too early: it promises {promised} and "
            f"{counted(counts.faces, 'face')}, and has {counted(len(rows) - 1, 'row')} for them.",
            path=path,
        )
    return counts


def _parse_faces(
    rows: Sequence[str], lines: Sequence[int], path: Path
) -> tuple[Int64Array, Int64Array]:
    """Return the vertex numbers of all faces, and the offsets of each."""
    if rows and all(row.startswith(("3 ", "3\t")) for row in rows):
        what = "a face has fewer corners than it promises"
        corners = parse_integer_columns(rows, lines, path, columns=slice(1, 4), what=what)
        return corners.ravel(), np.arange(0, corners.size + 1, 3)
    found: list[int] = []
    offsets = [0]
    for text, line in zip(rows, lines, strict=True):
        row = text.split()
        count = parse_integers(row[:1], line, path, what="a face begins with its number of corners")
        if not 0 <= count[0] <= len(row) - 1:
            raise describe_row_fault(row, line, "a face has fewer corners than it promises", path)
        found += parse_integers(row[1 : count[0] + 1], line, path)
        offsets.append(len(found))
    return np.array(found, np.int64), np.array(offsets, np.int64)


def write(surface: TIN, path: Path, *, progress: Callable[[float], None] | None = None) -> None:
    """Write a TIN as OFF; :func:`read` gives the same vertices and triangles back.

    Parameters and errors are those of every writer, see :class:`.Format`.
    """
    tin = require_tin(surface, path, format_name="OFF")
    total = len(tin.points) + len(tin.triangles)
    with replacing(path, binary=False) as file:
        file.write("OFF\n")
        if tin.crs is not None:
            file.write(f"# crs: {format_crs(tin.crs)}\n")
        if unit := format_unit(tin):
            file.write(f"# elevation unit: {unit}\n")
        file.write(f"{len(tin.points)} {len(tin.triangles)} 0\n")
        done = 0
        for count, batch in _iterate_batches(tin):
            file.write(batch)
            done += count
            if progress is not None:
                progress(done / total)


def _iterate_batches(tin: TIN) -> Iterator[tuple[int, str]]:
    for start in range(0, len(tin.points), _BATCH):
        rows = tin.points[start : start + _BATCH]
        yield len(rows), ("%r %r %r\n" * len(rows)) % tuple(rows.ravel().tolist())
    for start in range(0, len(tin.triangles), _BATCH):
        faces = tin.triangles[start : start + _BATCH]
        yield len(faces), ("3 %d %d %d\n" * len(faces)) % tuple(faces.ravel().tolist())
