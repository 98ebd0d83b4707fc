"""Layout: where the map and the title block lie on a sheet of paper, millimetres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...tin import Bounds

if TYPE_CHECKING:
    from .papers import Paper

_MARGIN = 8.0
"""Between the edge of the paper and the border: office printers leave 5 mm white."""
_LABELS = 6.0
"""Around the map, for the labels of the coordinate grid."""
_BLOCK = 40.0
_TITLE, _SCALES = 84.0, 44.0
_MOST_ENLARGED = 1.7
_A4 = 210.0 * 297.0


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


def arrange_sheet(paper: Paper) -> Layout:
    """Return the layout of a sheet: the title block below the map, all of its width.

    Examples
    --------
    >>> from tinsmith.terrain.plans.papers import Paper
    >>> frame = arrange_sheet(Paper.choices("A4", "landscape")[0]).frame
    >>> frame.width, frame.height
    (269.0, 142.0)
    """
    factor = min(_MOST_ENLARGED, max(1.0, (paper.width * paper.height / _A4) ** 0.25))
    factor = min(factor, (paper.width - 2 * _MARGIN) / (_TITLE + _SCALES + 46.0))
    left, right = _MARGIN, paper.width - _MARGIN
    low, top = _MARGIN, paper.height - _MARGIN
    block = low + _BLOCK * factor
    title = right - _TITLE * factor
    scales = title - _SCALES * factor
    return Layout(
        paper=paper,
        factor=factor,
        border=Bounds(left, low, right, top),
        frame=Bounds(left + _LABELS, block + _LABELS, right - _LABELS, top - _LABELS),
        legend=Bounds(left, low, scales, block),
        scales=Bounds(scales, low, title, block),
        title=Bounds(title, low, right, block),
    )
