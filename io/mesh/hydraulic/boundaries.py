"""Boundaries of ADCIRC and SCHISM: open ones, where water flows, and land with its type.

A list of segments for each: the number of nodes of a segment, for land its type (``ibtype``), then
a row for each node; rows of barriers have heights and coefficients behind the node, those of
barriers within the mesh the node on the other side before them.

References
----------
ADCIRC, "Grid and Boundary Information File (fort.14)", https://adcirc.org.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE, counted
from ..linework import Chain
from ..text_rows import parse_integers
from .nodes import find_nodes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ....base.arrays import BoolArray, Int64Array
    from ....tin import TIN
    from ..text_rows import TextRows

OPEN = "open"
"""Name of a line that is an open boundary; one of land is called ``land 20`` by its type."""

_LAND = re.compile(r"land (\d{1,9})")
_ISLANDS = frozenset({1, 11, 21})
"""Types of rings that programs close: the last node is not the first again."""

_MAINLAND, _ISLAND = 0, 1
"""Types that ADCIRC and SCHISM both know: no flow across, around the mesh and about a hole."""


def _has_heights(kind: int) -> bool:
    return kind % 10 in (3, 4, 5) and kind < 100


def _has_other_side(kind: int) -> bool:
    return kind % 10 in (4, 5) and kind < 100


class Boundaries(NamedTuple):
    """What a file says of boundaries."""

    chains: list[Chain]
    notes: list[str]


def parse_boundaries(rows: TextRows, numbers: Int64Array) -> Boundaries:
    """Read the boundaries at the end of a file; files of fields at nodes may have none.

    Parameters
    ----------
    rows : TextRows
        Those behind the elements.
    numbers : (n,) int64 array
        Of the nodes.

    Raises
    ------
    ReadError
        If the rows end too early, or name a node that is not there.
    """
    if not len(rows):
        return Boundaries([], [])
    at = 0
    found: list[_Rows] = []
    for is_land in (False, True):
        count = _count(rows, at, "the number of boundaries")
        at += 2  # past the number of all their nodes
        for _ in range(count):
            length = _count(rows, at, "the number of nodes of a boundary")
            kind = _parse_kind(rows, at) if is_land else None
            found.append(_Rows(at + 1, at + 1 + length, kind))
            at += 1 + length
            if at > len(rows):
                raise _describe_end(f"a boundary of {counted(length, 'node')}")
    kinds = [one.kind for one in found]
    return Boundaries(_find_sides(rows, found, numbers), _describe(kinds, len(rows) - at))


class _Rows(NamedTuple):
    """Where the nodes of a segment stand, and its type if it is of land."""

    start: int
    stop: int
    kind: int | None


def _find_sides(rows: TextRows, segments: list[_Rows], numbers: Int64Array) -> list[Chain]:
    """Return the nodes of all segments, those on the other side of barriers as chains too."""
    named: list[int] = []
    told: list[int] = []
    ends: list[tuple[int, int | None]] = []
    for start, stop, kind in segments:
        for column in range(2 if kind is not None and _has_other_side(kind) else 1):
            for row in range(start, stop):
                words = rows.texts[row].split()[column : column + 1]
                if not words:
                    raise rows.describe_fault(row, "the node on the other side is missing")
                named += parse_integers(words, rows.lines[row])
                told.append(row)
            ends.append((len(named), kind))
    found = find_nodes(np.array(named, np.int64).reshape(-1, 1), numbers, rows.pick(told)).ravel()
    chains, start = [], 0
    for end, kind in ends:
        nodes = found[start:end]
        if kind in _ISLANDS and len(nodes) > 1 and nodes[0] != nodes[-1]:
            nodes = np.append(nodes, nodes[0])
        chains.append(Chain(nodes, None, _name(kind)))
        start = end
    return chains


def _name(kind: int | None) -> str:
    if kind is None:
        return OPEN
    return f"barrier {kind}" if _has_heights(kind) else f"land {kind}"


def _count(rows: TextRows, at: int, what: str) -> int:
    """Return the whole number at the head of a row, behind which files have remarks."""
    if at >= len(rows):
        raise _describe_end(what)
    (count,) = parse_integers(rows.texts[at].split()[:1], rows.lines[at])
    if count < 0:
        raise rows.describe_fault(at, f"{what} is negative")
    return count


def _parse_kind(rows: TextRows, at: int) -> int:
    words = rows.texts[at].split()[1:2]
    if not words or not words[0].isdecimal():
        raise rows.describe_fault(at, "a land boundary needs its number of nodes and its type")
    return parse_integers(words, rows.lines[at])[0]


def _describe_end(what: str) -> ReadError:
    return ReadError(f"{FILE} ends too early: {what} is missing.")


def _describe(kinds: Iterable[int | None], n_left: int) -> list[str]:
    notes = []
    count = sum(kind is not None and _has_heights(kind) for kind in kinds)
    if count:
        notes.append(
            f"Heights and coefficients of {counted(count, 'barrier')} of the file are left out: "
            "their nodes are lines."
        )
    if n_left > 0:
        is_one = n_left == 1
        notes.append(
            f"{counted(n_left, 'row')} behind the boundaries of the file "
            f"{'is' if is_one else 'are'} left out."
        )
    return notes


# ------------------------------------------------------------------ what is written


class Segment(NamedTuple):
    """A part of the boundary, the surface on its left."""

    nodes: Int64Array
    kind: int
    """The type of a boundary of land."""


def list_boundaries(tin: TIN) -> tuple[list[Int64Array], list[Segment]]:
    """Return the open boundaries of a TIN and those of land, which cover its whole boundary.

    Lines along it that are named "open" and "land 20" are what their names say; the rest is land:
    of type 0 around the surface, of type 1 about holes.
    """
    rings = [np.asarray(ring, np.int64) for ring in tin.boundary]
    count = len(tin.points)
    keys = np.concatenate([ring * count + np.roll(ring, -1) for ring in rings])
    order = np.argsort(keys)
    is_taken = np.zeros(len(keys), np.bool_)
    opened: list[Int64Array] = []
    land: list[Segment] = []
    for chain, name in zip(tin.lines.chains(), tin.lines.names, strict=True):
        kind = _LAND.fullmatch(name)
        if kind is None and name != OPEN:
            continue
        nodes = np.asarray(chain, np.int64)
        for directed in (nodes, nodes[::-1]):
            wanted = directed[:-1] * count + directed[1:]
            at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)]
            if (keys[at] == wanted).all() and not is_taken[at].any():
                is_taken[at] = True
                if kind is None:
                    opened.append(directed)
                else:
                    land.append(_as_land(directed, int(kind[1])))
                break
    start = 0
    for ring in rings:
        land += _list_rest(tin, ring, is_taken[start : start + len(ring)])
        start += len(ring)
    return opened, land


def _as_land(nodes: Int64Array, kind: int) -> Segment:
    is_ring = kind in _ISLANDS and nodes[0] == nodes[-1]
    return Segment(nodes[:-1] if is_ring else nodes, kind)


def _list_rest(tin: TIN, ring: Int64Array, is_taken: BoolArray) -> list[Segment]:
    """Return what no line covers of a ring, of which each edge starts at a vertex."""
    if not is_taken.any():
        x, y = (tin.points[ring, :2] - tin.points[ring[0], :2]).T
        is_around = float(x @ np.roll(y, -1) - np.roll(x, -1) @ y) > 0
        return [_as_land(np.append(ring, ring[0]), _MAINLAND if is_around else _ISLAND)]
    first = int(np.argmax(is_taken))
    walk, flags = np.roll(ring, -first), np.roll(is_taken, -first).astype(np.int8)
    steps = np.diff(np.concatenate([flags, [1]]), prepend=np.int8(1))
    starts, ends = np.flatnonzero(steps < 0), np.flatnonzero(steps > 0)
    return [
        Segment(walk[np.arange(a, b + 1) % len(walk)], _MAINLAND)
        for a, b in zip(starts.tolist(), ends.tolist(), strict=True)
    ]
