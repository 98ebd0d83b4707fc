"""Papers: the sizes that drawings are printed on, millimetres."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, get_args

from ...base.checks import is_finite_number
from ...base.errors import OptionError, choice
from ...base.policies import PaperOrientation

if TYPE_CHECKING:
    from typing import TypeAlias

    PaperLike: TypeAlias = "str | tuple[float, float]"

MM_PER_INCH = 25.4

_ISO = {"A0": (841, 1189), "A1": (594, 841), "A2": (420, 594), "A3": (297, 420), "A4": (210, 297)}
_INCHES = {
    "Letter": (8.5, 11),
    "Legal": (8.5, 14),
    "Tabloid": (11, 17),
    "ANSI A": (8.5, 11),
    "ANSI B": (11, 17),
    "ANSI C": (17, 22),
    "ANSI D": (22, 34),
    "ANSI E": (34, 44),
    "ARCH A": (9, 12),
    "ARCH B": (12, 18),
    "ARCH C": (18, 24),
    "ARCH D": (24, 36),
    "ARCH E": (36, 48),
}
_SIZES = {
    **{name: (float(short), float(long)) for name, (short, long) in _ISO.items()},
    **{name: (MM_PER_INCH * a, MM_PER_INCH * b) for name, (a, b) in _INCHES.items()},
}
"""ISO 216 and ASME Y14.1, the shorter side first."""

_LEAST, _MOST = 190.0, 5000.0
"""Millimetres: narrower, a title block has no room; PDF pages end at 5080."""


@dataclass(frozen=True, slots=True)
class Paper:
    """A sheet of paper."""

    name: str
    """Such as "A3 landscape", or the size of one that has no name."""
    width: float
    height: float
    """Width and height are millimetres."""

    @classmethod
    def choices(cls, paper: PaperLike, orientation: str | None) -> tuple[Paper, ...]:
        """Return the papers that a name stands for: one, or landscape and portrait.

        A name is one such as "A3" or "ARCH D", or width and height in millimetres, else an
        OptionError; a named paper has both orientations if none is given.

        Examples
        --------
        >>> Paper.choices("a3", "portrait")
        (Paper(name='A3 portrait', width=297.0, height=420.0),)
        >>> [paper.name for paper in Paper.choices("arch-d", None)]
        ['ARCH D landscape', 'ARCH D portrait']
        """
        if orientation is not None:
            choice("orientation", orientation, PaperOrientation)
        if not isinstance(paper, str):
            return (_as_own_paper(paper, orientation),)
        name = {_simplify(known): known for known in _SIZES}.get(_simplify(paper))
        if name is None:
            raise OptionError("paper", paper, _describe_allowed())
        short, long = _SIZES[name]
        made = {
            "landscape": cls(f"{name} landscape", long, short),
            "portrait": cls(f"{name} portrait", short, long),
        }
        return tuple(
            made[word] for word in get_args(PaperOrientation) if orientation in (None, word)
        )


def _simplify(name: str) -> str:
    return re.sub(r"[\s_-]", "", name).casefold()


def _as_own_paper(size: Any, orientation: str | None) -> Paper:
    is_pair = isinstance(size, tuple | list) and len(size) == 2
    if not is_pair or not all(is_finite_number(side) for side in size):
        raise OptionError("paper", size, _describe_allowed())
    if not all(_LEAST <= side <= _MOST for side in size):
        raise OptionError("paper", size, f"{_LEAST:g} to {_MOST:g} mm wide and high")
    if orientation is not None:
        raise OptionError("orientation", orientation, "None where a paper is given by its size")
    width, height = float(size[0]), float(size[1])
    return Paper(f"{width:g} x {height:g} mm", width, height)


def _describe_allowed() -> str:
    return f"one of {', '.join(_SIZES)}, or width and height in millimetres"
