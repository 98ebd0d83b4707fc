"""2DM meshes of SMS (Surface-water Modeling System), which hydraulic models and QGIS read.

A row ``ND`` for each vertex with every digit, ``E3T`` for each triangle, and node strings ``NS``
along lines. 2DM has no place for CRS and units.
"""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from ....base.atomic import replacing
from ....base.errors import ReadError
from ....base.sentences import FILE, counted
from ....tin.topology import find_offsets
from .. import common
from ..common import Mesh, mesh_reader
from ..linework import Chain, add_lines, list_chains
from ..text_rows import TextRows, format_rows, parse_integers, split_rows, write_batches
from .nodes import find_nodes, require_distinct

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ....base.arrays import Int64Array
    from ....base.progress import Tell
    from ....tin import TIN

_NODES_IN_A_ROW = 10
_FACES = {
    # Corners and midside nodes stand in turn; each element becomes polygons of these.
    "E3T": (3, ((0, 1, 2),)),
    "E4Q": (4, ((0, 1, 2, 3),)),
    "E6T": (6, ((0, 1, 5), (1, 2, 3), (3, 4, 5), (1, 3, 5))),
    "E8Q": (8, ((0, 1, 7), (1, 2, 3), (3, 4, 5), (5, 6, 7), (1, 3, 5, 7))),
    "E9Q": (9, ((0, 1, 8, 7), (1, 2, 3, 8), (8, 3, 4, 5), (7, 8, 5, 6))),
}
_EDGES = ("E2L", "E3L")


@mesh_reader
def read(path: Path) -> Mesh:
    """Read a 2DM mesh: nodes in any order with gaps, elements, node strings.

    The file tells neither CRS nor unit. Quadrilaterals (E4Q, and those within E8Q and E9Q) are cut
    along a diagonal, which the report tells; elements with midside nodes (E6T, E8Q, E9Q) are cut at
    these. Node strings along edges become lines: of the boundary if they lie on it, else hard
    breaklines. Elements that are lines and materials are left out and told. A file without faces
    gives a survey.

    Raises
    ------
    ReadError
        Also if two nodes have one number, or an element names a node that is not there.
    """
    rows = split_rows(common.read_content(path))
    if not rows.texts or not rows.texts[0].startswith("MESH2D"):
        raise ReadError(f"{FILE} is no 2DM mesh: it must begin with 'MESH2D'.")
    cards = rows.sort_by_keyword()
    rows = cards.get("ND", TextRows())
    what = "a node needs its number, x, y and z"
    points = rows.parse_floats(slice(2, 5), what)
    numbers = rows.parse_integers(slice(1, 2), what).ravel()
    require_distinct(numbers, rows)
    found = [_parse_elements(card, cards[card], numbers) for card in _FACES if card in cards]
    if not found:
        return Mesh(points)
    strings = _parse_strings(cards.get("NS", TextRows()), numbers)
    return Mesh(
        points,
        np.concatenate([corners for corners, _ in found]),
        find_offsets(np.concatenate([lengths for _, lengths in found])),
        notes=_describe_losses(cards),
        add_lines=lambda tin: add_lines(tin, strings, "segment"),
    )


def _parse_elements(
    card: str, rows: TextRows, numbers: Int64Array
) -> tuple[Int64Array, Int64Array]:
    """Return the corners of the polygons that elements of one kind become, and their lengths."""
    count, polygons = _FACES[card]
    what = f"an element {card} needs its number and {count} nodes"
    nodes = find_nodes(rows.parse_integers(slice(2, count + 2), what), numbers, rows)
    corners = nodes[:, [slot for polygon in polygons for slot in polygon]].ravel()
    return corners, np.tile([len(polygon) for polygon in polygons], len(nodes))


def _parse_strings(rows: TextRows, numbers: Int64Array) -> list[Chain]:
    """Return node strings: each ends in a negative number, behind which its name may stand."""
    named: list[int] = []
    told: list[int] = []
    ends: list[tuple[int, str]] = []
    for row, (text, line) in enumerate(zip(rows.texts, rows.lines, strict=True)):
        words = text.split()
        for at, word in enumerate(words[1:], start=1):
            (node,) = parse_integers([word], line)
            named.append(abs(node))
            told.append(row)
            if node < 0:
                ends.append((len(named), words[at + 1] if at + 1 < len(words) else ""))
                break
    if named and (not ends or ends[-1][0] < len(named)):
        ends.append((len(named), ""))
    nodes = find_nodes(np.array(named, np.int64).reshape(-1, 1), numbers, rows.pick(told)).ravel()
    starts = [0, *(end for end, _ in ends)]
    return [
        Chain(nodes[start:end], None, name)
        for start, (end, name) in zip(starts, ends, strict=False)
    ]


def _describe_losses(cards: dict[str, TextRows]) -> list[str]:
    notes = []
    n_edges = sum(len(cards[card]) for card in _EDGES if card in cards)
    if n_edges:
        kinds = " and ".join(card for card in _EDGES if card in cards)
        notes.append(
            f"{counted(n_edges, 'element')} of the file that "
            f"{'is a line' if n_edges == 1 else 'are lines'} ({kinds}) "
            f"{'is' if n_edges == 1 else 'are'} left out."
        )
    materials = {
        tuple(row.split(None, count + 2)[count + 2 :])
        for card, (count, _) in _FACES.items()
        if card in cards
        for row in cards[card].texts
    }
    if len(materials) > 1:
        notes.append("The materials of the elements are left out.")
    return notes


def write(surface: TIN, path: Path, *, progress: Tell | None = None) -> None:
    """Write a TIN as 2DM, numbers ascending from 1; :func:`read` gives the same TIN back.

    Lines of the TIN become node strings, as do chains of its other constrained edges.
    """
    tin = common.require_tin(surface, format_name="2DM")
    with replacing(path, binary=False) as file:
        file.write("MESH2D\n")
        triangles = np.column_stack([np.arange(len(tin.triangles)), tin.triangles]) + 1
        faces = format_rows("E3T %d %d %d %d 1\n", triangles)
        nodes = np.column_stack([np.arange(len(tin.points)) + 1, tin.points])
        rows = chain(faces, format_rows("ND %d %r %r %r\n", nodes))
        write_batches(file, tin, rows, progress)
        for number, line in enumerate(list_chains(tin), start=1):
            file.write(_format_string(line, number))


def _format_string(chain: Int64Array, number: int) -> str:
    """Return a node string: the last node is negative, and the number of the string follows it."""
    words = [str(node + 1) for node in chain.tolist()]
    words[-1] = f"-{words[-1]} {number}"
    rows: Sequence[Sequence[str]] = [
        words[start : start + _NODES_IN_A_ROW] for start in range(0, len(words), _NODES_IN_A_ROW)
    ]
    return "".join(f"NS {' '.join(row)}\n" for row in rows)
