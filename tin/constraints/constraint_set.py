"""The lines of a survey as flat arrays, ready to be put into a surface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import LinesError
from ...base.records import require, require_finite, require_indices, require_offsets
from ...base.sentences import coordinate, shown
from .. import _kernel
from ..topology import find_offsets, find_owners
from ..validation import find_geometries, has_coordinates, is_plain
from .breaklines import Breakline, Water, as_ring
from .constraint_table import ConstraintTable
from .given_geometries import convert_geometries
from .polygons import gather_rings_of_regions

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array
    from ...base.policies import LineKind

ABOVE_ALL = np.inf
"""Priority of water: it stays flat whatever crosses it."""

BELOW_ALL = -np.inf
"""Priority of draped lines: they never change an elevation."""


class LineSet(NamedTuple):
    """Lines as ragged arrays of places; line ``i`` has the rows ``offsets[i]:offsets[i + 1]``."""

    xy: Float64Array
    """(k, 2)."""
    elevations: Float64Array
    """(k,), NaN for draped lines."""
    offsets: Int64Array
    """(l + 1,)."""
    table: ConstraintTable
    """What the lines are."""

    @property
    def kinds(self) -> tuple[LineKind, ...]:
        """The kind of each line."""
        return self.table.kinds

    @property
    def sources(self) -> Int32Array:
        """The caller's number of each line."""
        return self.table.sources

    @property
    def priorities(self) -> Float64Array:
        """The priority of each line."""
        return self.table.priorities

    @property
    def names(self) -> tuple[str, ...]:
        """The name of each line."""
        return self.table.names

    def _require_sound(self) -> None:
        """Refuse stored lines whose rows and offsets do not belong together."""
        count, rows = len(self.kinds), len(self.xy)
        require_finite(self.xy, (rows, 2), "coordinates of lines")
        require_offsets(self.offsets, count, rows, "lines")
        require((np.diff(self.offsets) >= 2).all(), "lines of one vertex")
        require_indices(self.sources, 2**31, "sources of lines", least=-1)
        require(len(self.sources) == len(self.names) == count, "sources of lines")
        require(self.elevations.shape == (rows,), "elevations of lines")
        require(self.priorities.shape == (count,), "priorities of lines")

    @property
    def is_draped(self) -> BoolArray:
        """Whether each line takes its elevations from the surface."""
        return np.isnan(self.elevations[self.offsets[:-1]])

    @property
    def line_of(self) -> Int64Array:
        """The line of each row."""
        return find_owners(self.offsets)

    def find_best_rows(self, vertices: Int32Array | Int64Array) -> Int64Array:
        """Return the row that counts most of each vertex, in the order of vertices.

        That of the line of highest priority, of these the first, there its lowest; parts of draped
        lines have no order. ``vertices`` are those of the rows.
        """
        order = np.argsort(vertices, kind="stable")
        shared = np.flatnonzero(np.bincount(vertices)[vertices] > 1)
        if len(shared):  # hardly any, and a sort by four keys takes long
            line = self.line_of[shared]
            priority = self.priorities[line]
            rank = np.where(priority == BELOW_ALL, 0, line)
            keys = (line, self.elevations[shared], rank, -priority, vertices[shared])
            is_shared = np.zeros(len(vertices), np.bool_)
            is_shared[shared] = True
            order[is_shared[order]] = shared[np.lexsort(keys)]
        is_first = np.append(True, np.diff(vertices[order]) > 0)[: len(order)]
        found: Int64Array = order[is_first]
        return found

    def label(self, line: int) -> str:
        """Return what a line is called in sentences."""
        return self.table.label(line)

    def labels(self) -> list[str]:
        """Return what the lines are called."""
        return [self.label(line) for line in range(len(self.kinds))]

    def title(self, line: int) -> str:
        """Return what a line is called at the beginning of a sentence."""
        label = self.label(line)
        return label[0].upper() + label[1:]

    @classmethod
    def join(cls, sets: Sequence[LineSet]) -> LineSet:
        """Return the lines of several sets as one."""
        return cls(
            np.concatenate([part.xy for part in sets]),
            np.concatenate([part.elevations for part in sets]),
            find_offsets(np.concatenate([np.diff(part.offsets) for part in sets])),
            ConstraintTable.join([part.table for part in sets]),
        )

    def choose(self, is_chosen: BoolArray) -> LineSet:
        """Return some of the lines."""
        rows = is_chosen[self.line_of]
        return LineSet(
            self.xy[rows],
            self.elevations[rows],
            find_offsets(np.diff(self.offsets)[is_chosen]),
            self.table.take(np.flatnonzero(is_chosen)),
        )


_NONE = LineSet(
    np.empty((0, 2)),
    np.empty(0),
    np.zeros(1, np.int64),
    ConstraintTable((), np.empty(0, np.int32), np.empty(0), ()),
)


def gather_lines(
    breaklines: Sequence[Breakline | ArrayLike],
    boundary: Sequence[ArrayLike],
    holes: Sequence[Any],
    water: Sequence[Water],
) -> LineSet:
    """Put all lines into one set: breaklines, then boundary rings, holes and water."""
    if not (len(breaklines) or len(boundary) or len(holes) or len(water)):
        return _NONE
    found = None if boundary or holes or water else _gather_arrays_alone(breaklines)
    if found is None:
        found = _gather(breaklines, boundary, holes, water)
    _require_exact_range(found)
    highest = _kernel.LARGEST_ELEVATION
    wrong = np.abs(found.elevations) > highest  # NaN is draped
    if wrong.any():
        row = int(np.argmax(wrong))
        line = int(found.line_of[row])
        label = found.label(line)
        raise LinesError(
            f"{label[0].upper() + label[1:]} has an elevation of {found.elevations[row]:.3g}: "
            f"magnitudes up to {highest:.0e} are allowed.",
            lines=[line],
        )
    require_length(found)
    return found


def _gather_arrays_alone(breaklines: Sequence[Any]) -> LineSet | None:
    """Return sound (k, 3) arrays as hard breaklines, all at once; None for anything else."""
    if not (isinstance(breaklines, list | tuple) and all(map(_is_array_of_vertices, breaklines))):
        return None
    coords = np.concatenate(breaklines)
    if not np.isfinite(coords).all():
        return None
    coords += 0.0  # no -0.0: equal coordinates are equal bytes
    n = len(breaklines)
    return LineSet(
        np.ascontiguousarray(coords[:, :2]),
        coords[:, 2].copy(),  # a view would keep the eastings and northings, too
        find_offsets(map(len, breaklines)),
        ConstraintTable.of_kind("hard", np.arange(n, dtype=np.int32), np.zeros(n)),
    )


def _is_array_of_vertices(line: Any) -> bool:
    is_array = isinstance(line, np.ndarray) and line.dtype == np.float64
    return is_array and line.ndim == 2 and line.shape[1] == 3 and len(line) >= 2


def _gather(
    breaklines: Sequence[Breakline | ArrayLike],
    boundary: Sequence[Any],
    holes: Sequence[Any],
    water: Sequence[Water],
) -> LineSet:
    lines = [
        line if isinstance(line, Breakline) else Breakline(line)
        for line in as_sequence(breaklines, "breaklines")
    ]
    rings = [
        *_gather_rings_of_kind(boundary, "boundary"),
        *_gather_rings_of_kind(holes, "hole"),
    ]
    ponds = gather_water(water)
    coords = [
        *(line.coords for line in lines),
        *(_close(ring) for _, ring in rings),
        *(_close(np.column_stack([pond.ring, np.full(len(pond.ring), pond.z)])) for pond in ponds),
    ]
    kinds: list[LineKind] = [line.kind for line in lines]
    kinds += [kind for kind, _ in rings]
    kinds += ["water" for _ in ponds]
    table = ConstraintTable(
        kinds=tuple(kinds),
        sources=_count_sources(kinds),
        priorities=np.array(
            [
                *(BELOW_ALL if line.is_draped else line.priority for line in lines),
                *(BELOW_ALL if ring.shape[1] == 2 else 0.0 for _, ring in rings),
                *(ABOVE_ALL for _ in ponds),
            ],
            np.float64,
        ),
        names=(*(line.name for line in lines), *("" for _ in rings), *(p.name for p in ponds)),
    )
    return LineSet(*_stack(coords), find_offsets(map(len, coords)), table)


def gather_extent(extent: Sequence[ArrayLike], n_boundary: int) -> LineSet:
    """Return the rings within which there is data as lines, numbered behind those given."""
    rings = [_close(as_ring(ring, f"extent ring {number}")) for number, ring in enumerate(extent)]
    n = len(rings)
    if n == 0:
        return _NONE
    table = ConstraintTable.of_kind(
        "boundary",
        np.arange(n_boundary, n_boundary + n, dtype=np.int32),
        np.where([ring.shape[1] == 2 for ring in rings], BELOW_ALL, 0.0),
    )
    return LineSet(*_stack(rings), find_offsets(map(len, rings)), table)


def gather_rings(rings: Sequence[Any], what: str) -> list[Float64Array]:
    """Return rings, and those of polygons, as (k, 2) arrays, the first corner not repeated."""
    return [ring for region in gather_regions(rings, what) for ring in region]


def gather_regions(regions: Sequence[Any], what: str) -> list[list[Float64Array]]:
    """Return the rings of each region: one, or those of a polygon with islands."""
    return [
        [ring[:, :2] for ring in rings]
        for rings in gather_rings_of_regions(as_sequence(regions, what), what)
    ]


def gather_water(water: Sequence[Water]) -> list[Water]:
    """Return the water polygons, or say what is none."""
    ponds = list(as_sequence(water, "water"))
    for pond in ponds:
        if not isinstance(pond, Water):
            raise LinesError(f"Invalid water {type(pond).__name__}: a tinsmith.Water is needed.")
    return ponds


def as_sequence(lines: Any, what: str) -> list[Any]:
    """Return several lines; one line alone is told apart by its rows being numbers.

    Geometries become breaklines, regions or water, as ``what`` says: one for each of their parts.
    """
    if type(lines) in (tuple, list):
        return [lines] if _is_one(lines) else _convert_each(lines, what)
    if isinstance(lines, Breakline | Water):
        return [lines]
    if isinstance(lines, np.ndarray) and lines.ndim == 2 and lines.dtype != object:
        return [lines]
    found = find_geometries(lines)
    if found is not None:
        return convert_geometries(found, what)
    if has_coordinates(lines):  # a table, whose rows are the vertices of one
        return [lines]
    if not isinstance(lines, str | bytes | Mapping):
        with suppress(TypeError, LookupError):  # whatever it is, it gives no lines
            return _convert_each(list(lines), what)
    raise LinesError(
        f"Invalid {what} {shown(lines)}: a sequence of lines is needed, each an array of vertices."
    )


def _is_one(lines: Sequence[Any]) -> bool:
    """Whether rows are those of one line, each two or three numbers, and no lines."""
    return len(lines) > 0 and all(
        isinstance(row, list | tuple)
        and len(row) in (2, 3)
        and all(isinstance(number, int | float | np.number) for number in row)
        for row in lines
    )


def _convert_each(lines: Sequence[Any], what: str) -> list[Any]:
    """Put what geometries hold in their places."""
    if all(isinstance(line, Breakline | Water) or is_plain(line) for line in lines):
        return list(lines)
    converted: list[Any] = []
    for line in lines:
        found = None if isinstance(line, Breakline | Water) else find_geometries(line)
        converted.extend([line] if found is None else convert_geometries(found, what))
    return converted


def _gather_rings_of_kind(
    regions: Sequence[Any], kind: LineKind
) -> list[tuple[LineKind, Float64Array]]:
    found = gather_rings_of_regions(as_sequence(regions, kind), kind)
    return [(kind, ring) for rings in found for ring in rings]


def _close(ring: Float64Array) -> Float64Array:
    return np.concatenate([ring, ring[:1]])


def _stack(coords: list[Float64Array]) -> tuple[Float64Array, Float64Array]:
    if not coords:
        return np.empty((0, 2)), np.empty(0)
    xy = np.concatenate([line[:, :2] for line in coords])
    draped = [len(line) if line.shape[1] == 2 else 0 for line in coords]
    elevations = np.concatenate(
        [np.full(n, np.nan) if n else line[:, 2] for n, line in zip(draped, coords, strict=True)]
    )
    return np.ascontiguousarray(xy), elevations


def _count_sources(kinds: Sequence[str]) -> Int32Array:
    counts: dict[str, int] = {}
    numbers = []
    for kind in kinds:
        group = "breakline" if kind in ("hard", "soft") else kind
        numbers.append(counts.get(group, 0))
        counts[group] = numbers[-1] + 1
    return np.array(numbers, np.int32)


def require_length(lines: LineSet) -> None:
    """Refuse a line whose vertices are all at one place."""
    starts = lines.offsets[:-1]
    begins_at_one_place = (lines.xy[starts] == lines.xy[starts + 1]).all(axis=1)
    for line in np.flatnonzero(begins_at_one_place).tolist():
        rows = lines.xy[lines.offsets[line] : lines.offsets[line + 1]]
        if (rows != rows[0]).any():
            continue
        label = lines.label(line)
        x, y = lines.xy[lines.offsets[line]]
        raise LinesError(
            f"{label[0].upper() + label[1:]} has all its vertices at one place (x "
            f"{coordinate(x)}, y {coordinate(y)}): "
            "a line needs two places.",
            lines=[line],
        )


def _require_exact_range(lines: LineSet) -> None:
    smallest, largest = _kernel.EXACT_RANGE
    size = np.abs(lines.xy)
    wrong = ((size > largest) | ((size < smallest) & (size > 0))).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        line = int(lines.line_of[row])
        label, (x, y) = lines.label(line), lines.xy[row].tolist()
        raise LinesError(
            f"{label[0].upper() + label[1:]} has a vertex outside the exact range "
            f"(x {x!r}, y {y!r}): magnitudes from {smallest:.0e} to {largest:.0e}, or 0, are "
            "allowed.",
            lines=[line],
        )
