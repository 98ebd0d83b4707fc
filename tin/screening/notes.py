"""What looks wrong with a TIN, in a few sentences that go with all that is made of it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from ...base.sentences import counted, height, inflect
from .gaps import describe_gaps
from .naming import make_namer
from .searching import screen_points
from .suspects import DROPPED

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ..surface import TIN
    from .naming import NameRows
    from .searching import Screening
    from .suspects import Suspect

_SHOWN = 3


def describe_findings(tin: TIN, *, gaps: bool = True) -> tuple[str, ...]:
    """Tell in a few sentences what looks wrong with a TIN.

    A sentence for each kind of finding of high or medium certainty: points that look like blunders,
    lines that the points do not bear out, voids that are filled with an elevation; and for ``gaps``
    that the surface spans, needless where the caller has said how long edges may be.

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
    ('1 point looks like a blunder (1 code): row 33 at elevation 0.',)
    """
    told = describe_screening(screen_points(tin), make_namer(tin))
    return (*told, *(describe_gaps(tin, slivers=False) if gaps else ()))


def describe_screening(found: Screening, name: NameRows) -> tuple[str, ...]:
    """Tell what was found wrong with points and lines, but for what is of low certainty."""
    clear = [one for one in found.suspects if one.certainty != "low"]
    wrong = [one for one in clear if one.reason in DROPPED]
    lines = [one.explanation for one in clear if one.reason == "line"]
    voids = [one.explanation for one in clear if one.reason == "void"]
    told = [_describe_blunders(wrong, name)] if wrong else []
    told += _describe_first(lines, "vertex or line", "vertices or lines")
    told += _describe_first(voids, "void", "voids")
    return (*told, *found.notes)


def _describe_blunders(wrong: Sequence[Suspect], name: NameRows) -> str:
    rows = list(dict.fromkeys(one.row for one in wrong))
    z = {one.row: one.place[2] for one in wrong}
    shown = "; ".join(f"{name([row])} at elevation {height(z[row])}" for row in rows[:_SHOWN])
    more = "; ..." if len(rows) > _SHOWN else ""
    reasons = list_counts(one.reason for one in wrong)
    looks = inflect("[looks like a blunder|look like blunders]", len(rows))
    return f"{counted(len(rows), 'point')} {looks} ({reasons}): {shown}{more}."


def list_counts(reasons: Iterable[str]) -> str:
    """Return how often each reason is there, the most frequent first."""
    counts = Counter(reasons)
    return ", ".join(f"{count:,} {reason}" for reason, count in counts.most_common())


def _describe_first(sentences: Sequence[str], noun: str, plural: str) -> list[str]:
    """Return the first of some sentences, and how many more there are."""
    if len(sentences) < 2:
        return list(sentences)
    more = counted(len(sentences) - 1, noun, plural)
    return [f"{sentences[0][:-1]}; so {inflect('[does|do]', len(sentences) - 1)} {more} more."]
