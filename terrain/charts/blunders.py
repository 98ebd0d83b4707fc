"""Map of suspicious points: where they are, what is wrong and how certain it is."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_tin, require_type
from ...base.errors import OptionError, TinsmithError
from ...base.georeference import turn_into_drawing
from ...base.results import Table
from ...base.sentences import counted
from ...tin.screening import DROPPED
from ..drawing import palette, parse_title
from .figures import INK, picture
from .maps import draw_shade, shade_for_map, start_map

if TYPE_CHECKING:
    from ...tin import TIN
    from .maps import Map

_PURPOSE = "A map of blunders"
_MARKERS = {"spike": "^", "pit": "v", "factor": "X", "code": "X", "number": "s", "place": "s"}
_OTHER = "o"
_LIGHTS = (-330, 245)
_MOST_DOTS = 20_000
"""More points would hide the ground."""
_MOST_LABELS = 40
_LEGEND = 1.6
"""Inches beside the map."""


@picture
def blunder_map(tin: TIN, table: Table, *, title: str | None = None) -> Any:
    """Draw where the points are that look like blunders.

    Parameters
    ----------
    tin : TIN
        The surface of all points; it is drawn without those that look wrong.
    table : Table
        Of :func:`tinsmith.blunders`.
    title : str, optional
        Default "Points that look like blunders".

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it. Colours tell how certain it is, marks what
        is wrong; the first 40 bear their point numbers, or rows. Points beyond the site are told.

    Raises
    ------
    OptionError
        If the table is none of blunders, or the title is no text.
    PointsError
        If the TIN is none.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> points = [[x, y, 0.01 * x * y] for x in range(10) for y in range(10)]
    >>> points[33][2] += 3.0
    >>> tin = ts.triangulate(points)
    >>> figure = ts.blunder_map(tin, ts.blunders(tin))
    >>> figure.axes[0].get_ylabel()
    'northing'
    """
    require_tin(tin)
    require_type("table", table, Table)
    if "reason" not in table.columns or "certainty" not in table.columns:
        raise OptionError("table", table, "one of ts.blunders")
    if len(table) and table["row"].max() >= len(tin.vertex_of):
        raise OptionError("table", table, f"one of the {len(tin.vertex_of)} points of the surface")
    x, y = turn_into_drawing(np.column_stack([table["x"], table["y"]]), tin.crs).T
    ground = _leave_out(tin, table)
    table = replace(table, columns={**table.columns, "x": x, "y": y})
    drawn = start_map(
        ground,
        parse_title(title, "Points that look like blunders"),
        purpose=_PURPOSE,
        pad=0.03,
        beside=_LEGEND,
        caption_lines=1,
    )
    draw_shade(drawn.axes, shade_for_map(ground, smooth=False), limits=_LIGHTS)
    if len(ground.points) <= _MOST_DOTS:
        drawn.axes.plot(*ground.points[:, :2].T, ".", color=INK, markersize=1.2, zorder=2)
    _mark(drawn, table)
    drawn.write_caption(_write_caption(drawn, table), size=10)
    return drawn.figure


def _leave_out(tin: TIN, table: Table) -> TIN:
    """Return the surface without the points that look wrong, as far as there is one."""
    rows = table["row"][np.isin(table["reason"].astype(str), DROPPED)]
    vertices = np.unique(tin.vertex_of[rows])
    rest = tin.to_tin()
    try:
        rest.remove(vertices[vertices >= 0])
    except TinsmithError:
        return tin
    return rest


def _mark(drawn: Map, table: Table) -> None:
    axes, in_view = drawn.axes, _is_in_view(drawn, table)
    reasons, certainties = (table[name].astype(str) for name in ("reason", "certainty"))
    kinds = [
        (reason, certainty, (reasons == reason) & (certainties == certainty) & in_view)
        for certainty in reversed(palette.BLUNDERS)
        for reason in dict.fromkeys(reasons.tolist())
    ]
    for reason, certainty, chosen in kinds:
        if chosen.any():
            axes.scatter(
                table["x"][chosen],
                table["y"][chosen],
                marker=_MARKERS.get(reason, _OTHER),
                color=palette.BLUNDERS[certainty],
                edgecolor=INK,
                linewidth=0.6,
                s=46,
                zorder=4,
                label=f"{reason}, {certainty}",
            )
    _label(drawn, table, in_view)
    if in_view.any():
        axes.legend(
            loc="upper left", bbox_to_anchor=(1.01, 1.0), fontsize=8, frameon=False, borderpad=0
        )


def _label(drawn: Map, table: Table, in_view: Any) -> None:
    """Write point numbers, or rows, beside the most certain ones."""
    for i in np.flatnonzero(in_view & (table["row"] >= 0))[:_MOST_LABELS].tolist():
        drawn.axes.annotate(
            table["number"][i] or str(table["row"][i]),
            (table["x"][i], table["y"][i]),
            xytext=(5, 4),
            textcoords="offset points",
            fontsize=7.5,
            color=INK,
            zorder=5,
            parse_math=False,
        )


def _is_in_view(drawn: Map, table: Table) -> Any:
    (west, east), (south, north) = drawn.axes.get_xlim(), drawn.axes.get_ylim()
    x, y = table["x"], table["y"]
    return (x >= west) & (x <= east) & (y >= south) & (y <= north)


def _write_caption(drawn: Map, table: Table) -> str:
    if len(table) == 0:
        return "None found."
    beyond = int((~_is_in_view(drawn, table)).sum())
    text = f"{counted(len(table), 'finding')}"
    return f"{text}, {beyond:,} beyond the map" if beyond else text
