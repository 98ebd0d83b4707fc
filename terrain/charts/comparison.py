"""Picture of a comparison: what each algorithm made of the same points, faults marked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_type
from ...base.sentences import counted
from ...tin.paper import Comparison
from ..drawing import TRIANGULATIONS, parse_title
from .figures import INK, start_panels

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array
    from ...tin.paper import Outcome

_PURPOSE = "A picture of a comparison"
_VEIL = 0.22
"""Opacity of an overlapping triangle: the more of them, the darker."""

_PADDING = 0.14  # inches above and below titles
_COLUMNS = 3

_WIDTH = 17.0
"""Of the picture, inches."""

_CROWD = 300
"""Points above which they are not drawn and edges are thin."""


def comparison_picture(comparison: Comparison, *, title: str | None = None) -> Any:
    """Draw the triangles of every algorithm side by side, faults marked.

    Parameters
    ----------
    comparison : Comparison
        Of :func:`tinsmith.compare`.
    title : str, optional
        Default the number of points.

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it. A panel for each algorithm marks triangles
        with a point in their circle, overlapping ones, and what is not covered.

    Raises
    ------
    OptionError
        If it is no comparison, or the title is no text.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from tinsmith.tin import compare
    >>> found = compare([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8], [2, 1, 9]])
    >>> len(comparison_picture(found).axes)
    5
    """
    require_type("comparison", comparison, Comparison)
    heading = parse_title(title, f"{len(comparison.points):,} points")
    xy = comparison.points[:, :2] - comparison.points[:, :2].min(axis=0)
    width, height = xy.max(axis=0)
    panel = _WIDTH / _COLUMNS * min(max(height / width, 0.3), 1.5)
    figure = start_panels(_PURPOSE, _WIDTH, 2 * panel + 2.0, title=heading)
    figure.get_layout_engine().set(h_pad=_PADDING)
    *grid, last = figure.subplots(2, _COLUMNS).ravel()
    last.remove()
    for axes, outcome in zip(grid, comparison.outcomes, strict=True):
        _draw_outcome(axes, xy, comparison.hull, outcome)
        axes.set_title(_describe_outcome(outcome, comparison.expected), fontsize=11, color=INK)
    _add_legend(figure)
    return figure


def _describe_outcome(outcome: Outcome, expected: int) -> str:
    count = len(outcome.triangles)
    stopped = ", stopped" if outcome.is_stopped else ""
    first = f"{outcome.name}: {count:,} of {counted(expected, 'triangle')}{stopped}"
    violating, overlapping = int(outcome.violating.sum()), int(outcome.overlapping.sum())
    return f"{first}\n{violating:,} with a point in the circle, {overlapping:,} overlapping"


def _draw_outcome(axes: Any, xy: Float64Array, hull: Int32Array, outcome: Outcome) -> None:
    is_crowded = len(xy) > _CROWD
    line = 0.35 if is_crowded else 0.8
    axes.fill(*xy[hull].T, facecolor=TRIANGULATIONS["gap"], edgecolor=INK, linewidth=line, zorder=1)
    for chosen, color, alpha in (
        (~outcome.violating, TRIANGULATIONS["sound"], 1.0),
        (outcome.violating, TRIANGULATIONS["violating"], 1.0),
        (outcome.overlapping, TRIANGULATIONS["overlapping"], _VEIL),
    ):
        corners = xy[outcome.triangles[chosen]]
        axes.add_collection(
            _load_collections().PolyCollection(corners, facecolors=color, alpha=alpha, linewidths=0)
        )
    axes.add_collection(
        _make_line_collection(xy, _find_edges(outcome.triangles), TRIANGULATIONS["edge"], line)
    )
    axes.add_collection(
        _make_line_collection(xy, outcome.unextended, TRIANGULATIONS["unextended"], 3 * line)
    )
    if not is_crowded:
        axes.plot(*xy.T, ".", color=INK, markersize=4, zorder=4)
    axes.set_aspect("equal")
    axes.margins(0.03)
    axes.set_axis_off()


def _find_edges(triangles: Int32Array) -> Int32Array:
    """Return every edge once, (k, 2) array."""
    both = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(both, axis=1), axis=0)


def _make_line_collection(xy: Float64Array, edges: Int32Array, color: str, width: float) -> Any:
    return _load_collections().LineCollection(xy[edges], colors=color, linewidths=width, zorder=3)


def _load_collections() -> Any:
    from matplotlib import collections

    return collections


def _add_legend(figure: Any) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    edge: dict[str, Any] = {"edgecolor": TRIANGULATIONS["edge"], "linewidth": 0.8}
    kinds = {
        "sound": "empty circle",
        "violating": "point in the circle",
        "overlapping": "overlapping",
        "gap": "not covered",
    }
    handles: list[Any] = [
        Patch(facecolor=TRIANGULATIONS[kind], label=label, **edge) for kind, label in kinds.items()
    ]
    handles[2].set_alpha(2 * _VEIL)
    line = Line2D([], [], color=TRIANGULATIONS["unextended"], linewidth=2.4)
    line.set_label("edge not extended")
    figure.legend(
        handles=[*handles, line],
        loc="outside lower center",
        ncols=5,
        frameon=False,
        fontsize=11,
    )
