"""Check: prove that a TIN is what it says, without trusting whoever made it.

Why levels 1 to 3 together are a proof. If every edge has its two triangles on opposite sides
(level 1), every triangle is counter-clockwise, and the rim is one convex ring walked once
(level 2), then every place inside the ring lies in exactly one triangle: the rim winds about it
once, and that is the number of triangles over it. A triangulation of a convex region whose every
edge passes the in-circle test (level 3) is Delaunay.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from .check_connections import check_arrays, check_connections
from .check_delaunay import check_delaunay, check_rows
from .check_shape import check_shape
from .errors import CheckError, PointsError
from .findings import Findings, Problem
from .points import as_points
from .survey import Survey

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from .surface import TIN

__all__ = ["CheckResult", "Problem", "check"]

LEVELS = (1, 2, 3)


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
    """

    level: int
    problems: tuple[Problem, ...] = ()
    notes: tuple[Problem, ...] = ()
    counts: dict[str, int] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether no problem was found."""
        return not self.problems

    def raise_if_failed(self) -> None:
        """Do nothing if the TIN is sound.

        Raises
        ------
        CheckError
            If there are problems; its text is their sentences.
        """
        if self.problems:
            raise CheckError(
                " ".join(problem.sentence for problem in self.problems), problems=self.problems
            )

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain Python values, ready for JSON."""
        return {
            "ok": self.ok,
            "level": self.level,
            "problems": [_plain(problem) for problem in self.problems],
            "notes": [_plain(note) for note in self.notes],
            "counts": dict(self.counts),
        }

    def __repr__(self) -> str:
        kinds = ", ".join(f"{problem.count} {problem.kind}" for problem in self.problems)
        verdict = f"problems: {kinds}" if kinds else "ok"
        return f"<CheckResult: level {self.level}, {verdict}>"


def _plain(problem: Problem) -> dict[str, Any]:
    return asdict(problem) | {"first": list(problem.first)}


def check(tin: TIN, *, level: int = 3, points: Survey | ArrayLike | None = None) -> CheckResult:
    """Check a TIN, exactly and without the kernel that made it.

    Parameters
    ----------
    tin : TIN
    level : {1, 2, 3}
        1: indices are in range, neighbours and edge flags agree from both sides, every vertex is
        used. 2: also, triangles are counter-clockwise, the Euler count fits, the boundary is one
        convex ring (collinear points allowed; a constrained boundary may have any shape), areas
        add up. 3: also, every edge that is not constrained is Delaunay, and every row of
        ``points`` is present.
    points : Survey or (n, 3) array, optional
        The rows that the TIN was made of, to be found again at level 3 within the TIN's own
        ``report.snap``.

    Returns
    -------
    CheckResult

    Raises
    ------
    PointsError
        If ``level`` is none of 1, 2, 3, or ``points`` are no points. Faults of the TIN never
        raise.

    Notes
    -----
    All signs are exact. Time is linear but for one sort of the edges: some 3 seconds for a
    million vertices. Where a constrained boundary is not convex, that distant parts of the
    surface do not overlap is not proved.

    Examples
    --------
    >>> from tinsmith import triangulate
    >>> check(triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]]))
    <CheckResult: level 3, ok>
    """
    if level not in LEVELS:
        raise PointsError(f"Invalid level {level!r}: 1, 2 or 3 is needed.")
    rows = _rows_of(points)
    found = Findings()
    if check_arrays(tin, found) and check_connections(tin, found):
        if level >= 2:
            check_shape(tin, found)
        if level >= 3:
            check_delaunay(tin, found)
            if rows is not None:
                check_rows(tin, rows, found)
    elif level >= 2:
        found.note(
            "stopped", [level], "Level {first} was not reached: level 1 must be passed first."
        )
    return CheckResult(level, tuple(found.problems), tuple(found.notes), found.counts)


def _rows_of(points: Survey | ArrayLike | None) -> NDArray[np.float64] | None:
    if points is None:
        return None
    return as_points(points.points if isinstance(points, Survey) else points)
