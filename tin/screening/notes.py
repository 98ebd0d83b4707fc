"""What looks wrong with a TIN, in a few sentences that go with all that is made of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..._sentences import counted, inflect
from .gaps import describe_gaps
from .searching import screen_points
from .suspects import DROPPED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..surface import TIN
    from .suspects import Suspect

__all__ = ["describe_findings"]

_SHOWN = 3


def describe_findings(tin: TIN, *, gaps: bool = True) -> tuple[str, ...]:
    """Tell in a few sentences what looks wrong with a TIN.

    A sentence for each kind of finding: points that look like blunders, of high or medium
    certainty, and gaps that the surface spans.

    Parameters
    ----------
    tin : TIN
        Any, built of a survey or read from a file; it is not changed.
    gaps : bool, optional
        Whether to tell of gaps; needless where the caller has said how long edges may be.

    Notes
    -----
    Linear in the points; the same for the same TIN. It is a screening: of many points only those
    are judged that stand out most, as :func:`.screen_points` does.

    Examples
    --------
    >>> import numpy as np
    >>> import tinsmith as ts
    >>> x, y = np.divmod(np.arange(100.0), 10)
    >>> z = 320 + 0.01 * x * y
    >>> z[33] = 0
    >>> describe_findings(ts.triangulate(np.column_stack([x, y, z])))
    ('1 point looks like a blunder: row 33 (code).',)
    """
    found = screen_points(tin)
    wrong = [one for one in found.suspects if one.reason in DROPPED and one.certainty != "low"]
    told = [_describe_blunders(wrong)] if wrong else []
    return (*told, *found.notes, *(describe_gaps(tin) if gaps else ()))


def _describe_blunders(wrong: Sequence[Suspect]) -> str:
    shown = ", ".join(f"row {one.row} ({one.reason})" for one in wrong[:_SHOWN])
    more = ", ..." if len(wrong) > _SHOWN else ""
    looks = inflect("[looks like a blunder|look like blunders]", len(wrong))
    return f"{counted(len(wrong), 'point')} {looks}: {shown}{more}."
