"""Meshes of ADCIRC (fort.14) and SCHISM (hgrid.gr3): nodes with depths, elements, boundaries.

A title, the numbers of elements and nodes, a row for each node (number, x, y, depth) and for each
element (number, number of corners, nodes), then open boundaries and those of land. Depths are
positive downwards, from a datum that the file does not name, as neither CRS nor units. Both
programs want nodes numbered from 1 without gaps and corners counter-clockwise.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import TYPE_CHECKING, Literal

import numpy as np

from ....base.atomic import replacing
from ....base.errors import ReadError, choice
from ....base.sentences import FILE, counted
from .. import common
from ..common import Mesh, mesh_reader
from ..linework import add_lines
from ..text_rows import format_rows, parse_integers, split_rows, write_batches
from .boundaries import list_boundaries, parse_boundaries
from .nodes import find_nodes, require_distinct

if TYPE_CHECKING:
    from pathlib import Path
    from typing import IO

    from ....base.arrays import Float64Array, Int64Array
    from ....base.progress import Tell
    from ....tin import TIN
    from ..text_rows import TextRows

Sense = Literal["down", "up"]

_FORTRAN = re.compile(rb"(?<=[\d.])[dD](?=[-+]?\d)")
"""The exponent of a number in double precision, as Fortran writes it."""

_TITLES = {"down": "depths positive downward", "up": "elevations positive up"}
"""The first row, of which ADCIRC reads 24 letters."""


@mesh_reader
def read(path: Path, *, positive: Sense = "down") -> Mesh:
    """Read a mesh of ADCIRC or SCHISM, with its boundaries as lines.

    The file tells neither CRS nor unit. Depths become elevations, which the report tells. Open
    boundaries become lines named "open", those of land lines named by their type, such as "land
    20"; barriers keep their nodes alone. Quadrilaterals are cut along a diagonal. Nodes may be
    numbered with gaps. Rows without elements give a survey.

    Parameters
    ----------
    positive : {"down", "up"}
        The way in which the numbers of nodes grow: "down" if they are depths, as both programs
        have them, "up" if elevations.

    Raises
    ------
    ReadError
        Also if there are fewer rows than the file promises, two nodes have one number, or a node
        is named that is not there.
    OptionError
        If ``positive`` is another word.
    """
    choice("positive", positive, Sense)
    content = _FORTRAN.sub(b"e", common.read_content(path))
    rows = split_rows(b"\n" + content.partition(b"\n")[2])  # the title may be anything
    if not rows.texts:
        raise ReadError(f"{FILE} ends before the numbers of its elements and nodes.")
    what = "the numbers of elements and of nodes are needed"
    counts = rows.texts[0].split()[:2]
    if len(counts) < 2:
        raise rows.describe_fault(0, what)
    n_elements, n_nodes = parse_integers(counts, rows.lines[0], what=what)
    if min(n_elements, n_nodes) < 0:
        raise rows.describe_fault(0, "a count is negative")
    if n_elements + n_nodes > len(rows) - 1:
        raise ReadError(
            f"{FILE} ends too early: it promises {counted(n_nodes, 'node')} and "
            f"{counted(n_elements, 'element')}, and has {counted(len(rows) - 1, 'row')} for them."
        )
    nodes = rows.cut(1, n_nodes + 1)
    elements = rows.cut(n_nodes + 1, n_nodes + n_elements + 1)
    what = "a node needs its number, x, y and depth"
    points = nodes.parse_floats(slice(1, 4), what).reshape(-1, 3)
    numbers = nodes.parse_integers(slice(0, 1), what).ravel()
    require_distinct(numbers, nodes)
    notes = _turn(points, positive) + _describe_numbers(numbers)
    if not n_elements:
        return Mesh(points, notes=notes)
    corners, offsets = _parse_elements(elements, numbers)
    boundaries = parse_boundaries(rows.cut(n_nodes + n_elements + 1), numbers)
    return Mesh(
        points,
        corners,
        offsets,
        notes=[*notes, *boundaries.notes],
        add_lines=lambda tin: add_lines(tin, boundaries.chains, "segment of boundaries"),
    )


def _turn(points: Float64Array, positive: Sense) -> list[str]:
    if positive == "up":
        return []
    points[:, 2] = 0.0 - points[:, 2]  # no -0.0
    return ["Depths of the nodes grow downwards: their sign was changed."]


def _describe_numbers(numbers: Int64Array) -> list[str]:
    if (numbers == np.arange(1, len(numbers) + 1)).all():
        return []
    return [
        f"Nodes of the file are numbered {numbers.min()} to {numbers.max()}, not 1 to "
        f"{len(numbers)}: vertices are in the order of the rows."
    ]


def _parse_elements(rows: TextRows, numbers: Int64Array) -> tuple[Int64Array, Int64Array]:
    """Return the corners of the elements, one after the other, and where each begins."""
    sizes = rows.parse_integers(slice(1, 2), "an element needs its number and its nodes").ravel()
    wrong = (sizes != 3) & (sizes != 4)
    if wrong.any():
        raise rows.describe_fault(int(np.argmax(wrong)), "an element needs 3 or 4 nodes")
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    corners = np.empty(int(offsets[-1]), np.int64)
    for size in (3, 4):
        at = np.flatnonzero(sizes == size)
        if not len(at):
            continue
        own = rows.pick(at.tolist())
        what = f"an element of {size} corners needs {size} nodes"
        nodes = find_nodes(own.parse_integers(slice(2, size + 2), what), numbers, own)
        corners[offsets[at][:, None] + np.arange(size)] = nodes
    return corners, offsets


def write(
    surface: TIN, path: Path, *, positive: Sense = "down", progress: Tell | None = None
) -> None:
    """Write a TIN for ADCIRC or SCHISM; :func:`read` gives the same vertices and triangles back.

    Lines along the boundary that are named "open" become open boundaries, those named "land 20"
    boundaries of land of that type; the rest of the boundary is land of type 0, about holes 1.

    Parameters
    ----------
    positive : {"down", "up"}
        The way in which the numbers of nodes grow: "down" writes depths, the negative elevations,
        as both programs want them, "up" elevations.

    Raises
    ------
    OptionError
        If ``positive`` is another word.
    """
    choice("positive", positive, Sense)
    tin = common.require_tin(surface, format_name="ADCIRC")
    points = tin.points.copy()
    _turn(points, positive)
    with replacing(path, binary=False) as file:
        file.write(f"{_TITLES[positive]}\n{len(tin.triangles)} {len(points)}\n")
        nodes = np.column_stack([np.arange(len(points)) + 1, points])
        triangles = np.column_stack([np.arange(len(tin.triangles)), tin.triangles]) + 1
        rows = format_rows("%d %r %r %r\n", nodes)
        elements = format_rows("%d 3 %d %d %d\n", triangles)
        write_batches(file, tin, chain(rows, elements), progress)
        _write_boundaries(file, tin)


def _write_boundaries(file: IO[str], tin: TIN) -> None:
    opened, land = list_boundaries(tin)
    total = sum(map(len, opened))
    file.write(f"{len(opened)} = Number of open boundaries\n")
    file.write(f"{total} = Total number of open boundary nodes\n")
    for number, nodes in enumerate(opened, start=1):
        file.write(f"{len(nodes)} 0 = Number of nodes for open boundary {number}\n")
        file.write("".join(f"{node + 1}\n" for node in nodes.tolist()))
    total = sum(len(one.nodes) for one in land)
    file.write(f"{len(land)} = Number of land boundaries\n")
    file.write(f"{total} = Total number of land boundary nodes\n")
    for number, (nodes, kind) in enumerate(land, start=1):
        file.write(f"{len(nodes)} {kind} = Number of nodes for land boundary {number}\n")
        file.write("".join(f"{node + 1}\n" for node in nodes.tolist()))
