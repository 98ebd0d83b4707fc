"""Papers: the sizes that drawings are printed on, and what lies where on a sheet; millimetres."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias, get_args

from ....base.checks import is_finite_number
from ....base.errors import OptionError, choice
from ....base.policies import PaperOrientation
from ....tin import Bounds

if TYPE_CHECKING:
    from collections.abc import Callable

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

_MARGIN = 8.0
"""Between the edge of the paper and the border: office printers leave 5 mm white."""

_LABELS = 6.0
"""Around the map, for the labels of the coordinate grid."""

_BLOCK = 40.0

_TITLE, _SCALES = 84.0, 44.0

_MOST_ENLARGED = 1.7

_A4 = 210.0 * 297.0


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


@dataclass(frozen=True, slots=True)
class Layout:
    """Rectangles of a sheet."""

    paper: Paper
    factor: float
    """By which title block and letters in it are larger than on A4."""
    border: Bounds
    frame: Bounds
    """Of the map."""
    legend: Bounds
    scales: Bounds
    title: Bounds
    """All three are cells of the title block."""
    office: Bounds
    """Below them, for what the office says; it may have no height."""


def arrange_sheet(paper: Paper, measure_office: Callable[[float], float] | None = None) -> Layout:
    """Return the layout of a sheet: the title block below the map, all of its width.

    ``measure_office`` returns the height of what the office says, of a width, both as on A4.

    Examples
    --------
    >>> from tinsmith.terrain.plans.paper import Paper
    >>> frame = arrange_sheet(Paper.choices("A4", "landscape")[0]).frame
    >>> frame.width, frame.height
    (269.0, 142.0)
    """
    factor = min(_MOST_ENLARGED, max(1.0, (paper.width * paper.height / _A4) ** 0.25))
    factor = min(factor, (paper.width - 2 * _MARGIN) / (_TITLE + _SCALES + 46.0))
    left, right = _MARGIN, paper.width - _MARGIN
    low, top = _MARGIN, paper.height - _MARGIN
    band = factor * measure_office((right - left) / factor) if measure_office else 0.0
    foot = low + band
    block = foot + _BLOCK * factor
    title = right - _TITLE * factor
    scales = title - _SCALES * factor
    return Layout(
        paper=paper,
        factor=factor,
        border=Bounds(left, low, right, top),
        frame=Bounds(left + _LABELS, block + _LABELS, right - _LABELS, top - _LABELS),
        legend=Bounds(left, foot, scales, block),
        scales=Bounds(scales, foot, title, block),
        title=Bounds(title, foot, right, block),
        office=Bounds(left, low, right, foot),
    )
