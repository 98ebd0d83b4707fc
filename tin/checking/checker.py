"""Check: prove that a TIN is what it says, without trusting whoever made it.

Why levels 1 to 3 together are a proof. Take a place on no edge and count the triangles over it. If
all triangles are counter-clockwise (level 2) and every inner edge has two of them, which walk it in
opposite directions (level 1), then the count is the number of times that the boundary winds about
the place: inner edges cancel out. Level 2 shows that this is 1 inside the boundary and 0 outside,
in one of two ways:

- The boundary is one convex ring that turns round once.
- Else a sweep shows that edges of the boundary meet in vertices only, and that a line from below to
  above goes in and out of the surface in turn (:mod:`.boundary_sweep`). As the number is 0 below
  everything, it is then 0 and 1 in turn.

So the triangles tile what the boundary encloses, with no gap or overlap. That areas add up follows;
their comparison is a test of the check itself, and no part of the proof.

A triangulation of a convex region whose every edge passes the in-circle test (level 3) is Delaunay.
If edges are constrained, those of a boundary that is not convex included, and every other edge
passes, it is the constrained Delaunay triangulation of the surface [1]_.

References
----------
.. [1] D. T. Lee, A. K. Lin, Generalized Delaunay Triangulation for Planar Graphs, Discrete &
   Computational Geometry 1 (1986), doi:10.1007/BF02187695.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from ...base.checks import as_flag, is_whole_number, require_tin
from ...base.errors import CheckError, OptionError
from ...base.products import product
from ..building import Survey
from ..constraints import as_sequence, gather_lines
from ..validation import as_masked_points
from .chains import check_chains, check_segments
from .connections import check_arrays, check_connections
from .delaunay import check_delaunay
from .findings import Findings, Problem
from .inputs import check_given_lines, check_rows
from .shape import check_shape, has_sound_boundary

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike

    from ...base.arrays import Float64Array
    from ..constraints import Breakline, LineSet
    from ..surface import TIN

LEVELS = (1, 2, 3)


_OF_SURFACES = frozenset({"hull", "boundary", "euler", "delaunay", "unused"})
"""Kinds of problems that sound surfaces have which are not Delaunay."""


@dataclass(frozen=True)
class CheckResult:
    """What :func:`check` found.

    Attributes
    ----------
    level : int
        Level that was asked for.
    problems : tuple of Problem
        Faults; none in a sound TIN.
    notes : tuple of Problem
        Worth knowing, but no faults: cocircular points triangulated against tinsmith's own rule
        for ties, as a TIN from another program may have them, and levels that could not be
        entered because of problems.
    counts : dict of str to int
        Vertices, triangles, edges, rings and so on, as far as they were counted.

    Examples
    --------
    >>> import tinsmith as ts
    >>> result = ts.check(ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]]))
    >>> result.ok, result.problems
    (True, ())
    """

    level: int
    problems: tuple[Problem, ...] = ()
    notes: tuple[Problem, ...] = ()
    counts: dict[str, int] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether no problem was found."""
        return not self.problems

    @property
    def is_surface(self) -> bool:
        """Whether the triangles make a sound surface, whatever it lacks to be Delaunay.

        So from level 2 on, if all problems are that edges are not Delaunay, that the boundary is
        not convex or not one ring, or that vertices are of no triangle: surfaces of other programs
        are often such.

        Examples
        --------
        >>> import tinsmith as ts
        >>> square = [[0, 0, 5], [4, 0, 6], [4, 4, 8], [1, 3, 7]]
        >>> result = ts.check(ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]]))
        >>> result, result.is_surface
        (<CheckResult: level 3, problems: 1 delaunay>, True)
        """
        return self.level > 1 and all(
            one.kind in _OF_SURFACES and (one.kind != "hull" or one.first)  # else it winds twice
            for one in self.problems
        )

    def raise_if_failed(self) -> None:
        """Do nothing if the TIN is sound.

        Raises
        ------
        CheckError
            If there are problems; its text is their sentences.

        Examples
        --------
        >>> import tinsmith as ts
        >>> result = ts.check(ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]]))
        >>> result.raise_if_failed()
        """
        if self.problems:
            raise CheckError(
                " ".join(problem.sentence for problem in self.problems), problems=self.problems
            )

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain Python values, ready for JSON.

        Examples
        --------
        >>> import tinsmith as ts
        >>> result = ts.check(ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]]))
        >>> result.to_dict()["ok"]
        True
        """
        return {
            "ok": self.ok,
            "is_surface": self.is_surface,
            "level": self.level,
            "problems": [_as_plain(problem) for problem in self.problems],
            "notes": [_as_plain(note) for note in self.notes],
            "counts": dict(self.counts),
        }

    def __repr__(self) -> str:
        kinds = ", ".join(f"{problem.count} {problem.kind}" for problem in self.problems)
        verdict = f"problems: {kinds}" if kinds else "ok"
        return f"<CheckResult: level {self.level}, {verdict}>"


def _as_plain(problem: Problem) -> dict[str, Any]:
    return asdict(problem) | {"first": list(problem.first)}


@product
def check(
    tin: TIN,
    *,
    level: int = 3,
    points: Survey | ArrayLike | None = None,
    breaklines: Sequence[Breakline | ArrayLike] = (),
    conforming: bool = False,
) -> CheckResult:
    """Check a TIN, exactly and without the kernel that made it.

    Parameters
    ----------
    tin : TIN
    level : {1, 2, 3}
        1: indices are in range, neighbours and edge flags agree from both sides, every vertex is
        used, every row has a vertex or is named as left out, the chains of lines are sound. 2:
        also, triangles are counter-clockwise, the Euler count fits, the boundary is one convex
        ring (collinear points allowed; a constrained boundary may have any shape), no part of the
        surface lies over another. 3: also, every edge that is not constrained is Delaunay, every
        segment of a line is a constrained edge and every constrained edge inside a segment, and
        what is given as ``points`` and ``breaklines`` is present.
    points : Survey or (n, 3) array, optional
        The rows that the TIN was made of, to be found again at level 3 within the TIN's own
        ``report.snap``, and a survey's lines: as chains with the same vertices in the same order,
        and no more off the course than snapping and rounding can explain.
    breaklines : sequence of Breakline or arrays, optional
        Those that the TIN was made of besides the survey's own, all of them if ``points`` is none.
    conforming : bool
        At level 3, check constrained inner edges too: so the TIN is Delaunay without its lines, as
        ``triangulate(..., conforming=True)`` makes it.

    Returns
    -------
    CheckResult

    Raises
    ------
    OptionError
        If ``level`` is none of 1, 2, 3.
    PointsError
        If ``points`` are no points. Faults of the TIN never raise.
    LinesError
        If the lines given are none.

    Notes
    -----
    All signs are exact. Time is linear but for a sort of the edges, and a sweep over the boundary
    if it is not convex: some 3 seconds for a million vertices, 2 for 100,000 edges of a boundary.

    Examples
    --------
    >>> from tinsmith import triangulate
    >>> check(triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]]))
    <CheckResult: level 3, ok>
    """
    if not (is_whole_number(level) and level in LEVELS):
        raise OptionError("level", level, "1, 2 or 3")
    require_tin(tin)
    is_conforming = as_flag("conforming", conforming)
    rows, lines = _as_rows(points), _as_lines(points, breaklines)
    found = Findings()
    if check_arrays(tin, found) and check_connections(tin, found):
        check_chains(tin, found)
        if level >= 2:
            check_shape(tin, found)
        if level >= 3:
            check_delaunay(tin, found, conforming=is_conforming)
            _check_given(tin, rows, lines, found)
    elif level >= 2:
        sentence = f"Level {level} was not reached: level 1 must be passed first."
        found.notes.append(Problem("stopped", 1, (level,), sentence))
    return CheckResult(level, tuple(found.problems), tuple(found.notes), found.counts)


def _as_rows(points: Survey | ArrayLike | None) -> Float64Array | None:
    if points is None:
        return None
    return as_masked_points(points.points if isinstance(points, Survey) else points).values


def _as_lines(
    points: Survey | ArrayLike | None, breaklines: Sequence[Breakline | ArrayLike]
) -> LineSet:
    own = points.breaklines if isinstance(points, Survey) else ()
    together = [*own, *as_sequence(breaklines, "breaklines")]
    if not isinstance(points, Survey):
        return gather_lines(together, (), (), ())
    return gather_lines(together, points.boundary, points.holes, points.water)


def _check_given(tin: TIN, rows: Float64Array | None, lines: LineSet, found: Findings) -> None:
    """Check lines and rows, as far as the surface is fit to be asked about them."""
    if found.lack("chains"):
        check_segments(tin, found)
        if lines.kinds and has_sound_boundary(found):
            check_given_lines(tin, lines, found)
    if rows is not None:
        check_rows(tin, rows, found)
