"""Lines that the surface must hold: breaklines, rings and water, as callers give them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from ...base.checks import is_finite_number, is_whole_number
from ...base.errors import LinesError, OptionError, PointsError, choice
from ...base.policies import BreaklineKind, LineKind
from ...base.records import require, require_indices, require_offsets
from ...base.sentences import counted, height, inflect, shown
from ...base.types import Frozen
from ..validation import as_table, find_geometries
from .polylines import Polylines

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import BoolArray, Float64Array, Int32Array, Int64Array

MOST_PRIORITY = 2**53
"""Up to here whole numbers are told apart as floats, which priorities become."""


@dataclass(frozen=True, eq=False)
class Breakline:
    """A polyline that must be edges of the surface.

    Attributes
    ----------
    coords : (k, 3) or (k, 2) float64 array
        Vertices, k >= 2, CRS units; first and last equal if it is closed. With two columns it is
        draped: its elevations are taken from the surface of everything that has elevations.
    kind : {"hard", "soft"}
        A soft breakline shapes the surface, but is no break of slope.
    priority : int
        Where breaklines cross, the elevation of the higher one counts; among equals, of the first.
    name : str
        For reports and pictures.

    Raises
    ------
    LinesError
        For another shape, coordinates that are not finite, or an unknown kind.

    Examples
    --------
    >>> Breakline([[0, 0, 5], [4, 0, 6]], name="kerb")
    <Breakline: hard, 2 vertices, 'kerb'>
    """

    coords: Float64Array
    kind: BreaklineKind = "hard"
    priority: int = 0
    name: str = ""

    def __init__(
        self,
        coords: ArrayLike,
        *,
        kind: BreaklineKind = "hard",
        priority: int = 0,
        name: str = "",
    ) -> None:
        choice("kind", kind, BreaklineKind)
        if not is_whole_number(priority) or abs(int(priority)) > MOST_PRIORITY:
            allowed = f"a whole number from {-MOST_PRIORITY} to {MOST_PRIORITY}"
            raise OptionError("priority", priority, allowed)
        name = _as_name(name)
        what = f"breakline '{name}'" if name else "a breakline"
        object.__setattr__(self, "coords", as_coords(coords, what, least=2))
        object.__setattr__(self, "kind", kind)
        object.__setattr__(self, "priority", int(priority))
        object.__setattr__(self, "name", str(name))

    @property
    def is_draped(self) -> bool:
        """Whether the elevations come from the surface."""
        return int(self.coords.shape[1]) == 2

    def __repr__(self) -> str:
        draped = ", draped" if self.is_draped else ""
        name = f", '{self.name}'" if self.name else ""
        return f"<Breakline: {self.kind}, {len(self.coords)} vertices{draped}{name}>"


@dataclass(frozen=True, eq=False)
class Water:
    """A flat polygon: a pond, a slab, a building's footprint.

    Points and breaklines inside it are left out, and said so in the report.

    Attributes
    ----------
    ring : (k, 2) float64 array
        Corners in order, the first not repeated, k >= 3, CRS units.
    z : float
        Its constant elevation.
    name : str

    Raises
    ------
    LinesError
        For another shape or coordinates that are not finite.

    Examples
    --------
    >>> Water([[0, 0], [4, 0], [0, 3]], 7.5, name="pond")
    <Water: 3 corners at 7.5, 'pond'>
    """

    ring: Float64Array
    z: float
    name: str = ""

    def __init__(self, ring: ArrayLike, z: float, *, name: str = "") -> None:
        name = _as_name(name)
        what = f"water '{name}'" if name else "a water polygon"
        if not is_finite_number(z):
            raise LinesError(f"Invalid elevation {shown(z)} of {what}: a finite number is needed.")
        object.__setattr__(self, "ring", as_ring(ring, what)[:, :2])
        object.__setattr__(self, "z", float(z))
        object.__setattr__(self, "name", str(name))

    def __repr__(self) -> str:
        name = f", '{self.name}'" if self.name else ""
        return f"<Water: {len(self.ring)} corners at {height(self.z)}{name}>"


@dataclass(frozen=True, eq=False, kw_only=True)
class Lines(Frozen):
    """The lines in a TIN: chains of vertices, every segment of which is an edge of the TIN.

    Chain ``i`` is ``vertices[offsets[i]:offsets[i + 1]]``, in the direction of the line that it
    comes from; a closed one ends where it begins. A line of which parts are left out, outside the
    boundary or in water, has several chains or none.

    Attributes
    ----------
    vertices : (k,) int32 array
    offsets : (l + 1,) int32 array
    kinds : tuple of LineKind
        Of each chain.
    sources : (l,) int32 array
        The caller's line that each chain comes from, counted within breaklines, boundary rings,
        holes and water.
    names : tuple of str
        Of each chain, ``""`` if it has none.

    Examples
    --------
    >>> from tinsmith import Breakline, triangulate
    >>> square = [[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]]
    >>> tin = triangulate(square, breaklines=[[[0, 0], [4, 3]]])
    >>> tin.lines
    <Lines: 1 hard, 0 soft, 0 boundary, 0 hole, 0 water; 3 vertices>
    """

    vertices: Int32Array = field(default_factory=lambda: np.empty(0, np.int32))
    offsets: Int32Array = field(default_factory=lambda: np.zeros(1, np.int32))
    kinds: tuple[LineKind, ...] = ()
    sources: Int32Array = field(default_factory=lambda: np.empty(0, np.int32))
    names: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.kinds)

    def _require_sound(self, n_vertices: int) -> None:
        """Refuse stored lines whose chains are not of so many vertices."""
        require_indices(self.vertices, n_vertices, "vertices of lines")
        require_offsets(self.offsets, len(self), len(self.vertices), "lines")
        require_indices(self.sources, 2**31, "sources of lines", least=-1)
        require(len(self.sources) == len(self.names) == len(self), "sources of lines")

    def chains(self) -> Iterator[Int32Array]:
        """Walk the chains, as vertex numbers.

        Examples
        --------
        >>> lines = Lines(vertices=np.array([0, 1, 2, 5, 4]), offsets=np.array([0, 3, 5]))
        >>> [chain.tolist() for chain in lines.chains()]
        [[0, 1, 2], [5, 4]]
        """
        return iter(self._polylines)

    def segments(self) -> Int32Array:
        """Return the edges along which the chains run, (s, 2) vertex pairs in order.

        Examples
        --------
        >>> lines = Lines(vertices=np.array([0, 1, 2, 5, 4]), offsets=np.array([0, 3, 5]))
        >>> lines.segments().tolist()
        [[0, 1], [1, 2], [5, 4]]
        """
        return self._polylines.segments()

    def segment_chains(self) -> Int64Array:
        """Return the chain of each of the segments.

        Examples
        --------
        >>> lines = Lines(vertices=np.array([0, 1, 2, 5, 4]), offsets=np.array([0, 3, 5]))
        >>> lines.segment_chains().tolist()
        [0, 0, 1]
        """
        return self._polylines.segment_owners()

    steps, step_chains = segments, segment_chains  # their names at first

    @property
    def _polylines(self) -> Polylines:
        return Polylines.whole(self.vertices, self.offsets)

    def is_same(self, other: Lines) -> bool:
        """Tell whether these are the same lines through the same vertices.

        Examples
        --------
        >>> Lines().is_same(Lines())
        True
        """
        arrays = ("vertices", "offsets", "sources")
        return (self.kinds, self.names) == (other.kinds, other.names) and all(
            np.array_equal(getattr(self, name), getattr(other, name)) for name in arrays
        )

    def __repr__(self) -> str:
        kinds = ", ".join(f"{self.kinds.count(kind)} {kind}" for kind in get_args(LineKind))
        return f"<Lines: {kinds}; {len(self.vertices)} vertices>"


def _as_name(name: Any) -> str:
    if not isinstance(name, str | int | float | np.number):
        raise OptionError("name", name, "text")
    return str(name)


def as_coords(coords: ArrayLike, what: str, *, least: int) -> Float64Array:
    """Return a (k, 2) or (k, 3) float64 array of at least ``least`` finite rows, read-only."""
    subject = what[0].upper() + what[1:]
    try:
        values, is_masked = as_table(_take_only_line(coords, subject), subject, least=2)
    except PointsError as error:
        if str(error).startswith(f"{subject} are no table"):
            raise LinesError(f"{subject} is no table of real numbers.") from None
        raise LinesError(str(error)) from None
    if is_masked is not None:
        raise LinesError(
            f"{subject} has {counted(int(is_masked.sum()), 'masked vertex', 'masked vertices')} "
            f"(first: vertex {int(np.argmax(is_masked))}): a line needs all of its vertices."
        )
    array = values.copy()
    if array.ndim != 2 or array.shape[1] not in (2, 3) or len(array) < least:
        raise LinesError(
            f"{subject} has shape {array.shape}: (k, 3), or (k, 2) to drape it, "
            f"with k >= {least} is needed."
        )
    if not np.isfinite(array).all():
        wrong = ~np.isfinite(array).all(axis=1)
        row = int(np.argmax(wrong))
        count = int(wrong.sum())
        are = inflect(f"{counted(count, 'vertex', 'vertices')} that [is|are]", count)
        raise LinesError(
            f"{subject} has {are} not finite "
            f"(first: vertex {row}, {array[row].tolist()}): "
            "every coordinate must be a finite number."
        )
    array += 0.0  # no -0.0: equal coordinates are equal bytes
    array.flags.writeable = False
    return array


def _take_only_line(given: Any, subject: str) -> Any:
    """Return the vertices of a geometry that is one line or ring, anything else as it is."""
    found = find_geometries(given)
    if found is None or all(part.kind == "Point" for part in found.parts):
        return given
    kinds = [part.kind for part in found.parts]
    is_one = kinds in (["LineString"], ["Polygon"]) and len(found.parts[0].rings) == 1
    if not is_one:
        told = ", ".join(kinds[:3]) + (", ..." if len(kinds) > 3 else "")
        raise LinesError(
            f"{subject} is a geometry of other than one line or ring ({told}): several are given "
            "as a sequence."
        )
    return found.parts[0].rings[0]


def as_ring(ring: ArrayLike, what: str) -> Float64Array:
    """Return the corners of a ring, the first not repeated at the end; as :func:`as_coords`.

    Of several elevations where it closes the lowest is taken, whichever way the ring runs.
    """
    coords = as_coords(ring, what, least=3)
    is_start = _is_start(coords)
    if coords.shape[1] == 3 and is_start.sum() > 1:
        lowest = coords[is_start, 2].min()
        coords = coords.copy()
        coords[is_start, 2] = lowest
    if is_start[-1]:
        coords = coords[:-1]
    coords.flags.writeable = False
    n_corners = len(np.unique(coords[:, :2], axis=0))
    if n_corners < 3:
        number = "two corners" if n_corners == 2 else "one corner"
        raise LinesError(f"{what[0].upper() + what[1:]} has {number}: a ring needs three.")
    return coords


def find_elevations_at_start(ring: ArrayLike, what: str) -> Float64Array:
    """Return the vertices where a ring closes, one for each elevation, ascending; none if flat."""
    coords = as_coords(ring, what, least=3)
    if coords.shape[1] == 2:
        return np.empty((0, 3))
    found: Float64Array = np.unique(coords[_is_start(coords)], axis=0)
    return found


def _is_start(ring: Float64Array) -> BoolArray:
    """Tell which vertices are where a ring begins and ends: repeated ones next to the first."""
    is_there = (ring[:, :2] == ring[0, :2]).all(axis=1)
    ahead, behind = np.logical_and.accumulate(is_there), np.logical_and.accumulate(is_there[::-1])
    is_start: BoolArray = ahead | behind[::-1]
    return is_start
