"""Cut and fill map: where a surface is lowered and raised, by how much, with the volumes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.checks import require_tin, require_type
from ...tin import TIN, Bounds
from ..drawing import draw_north_up, palette, parse_title, round_down
from ..earthwork import Difference
from ..gridding import cover, hillshade, rasterize
from .figures import INK, picture
from .maps import PIXELS, draw_cells, draw_scale, draw_shade, start_map

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.results import Features, Table
    from ...tin import Grid
    from .maps import Map

_PURPOSE = "A cut and fill map"
_PAD = 0.18
"""Of the ground around what is cut and filled, as a share of its extent."""
_LIGHTS = (-330, 245)
"""What is black and what is white: the ground is paler than what matters."""
_SCALE = 0.95
"""Inches beside the map."""
_KINDS = ("cut", "fill", "net")
_LINES = 8
"""So many lines of equal cut or fill are drawn at most on each side."""


@picture
def earthwork_map(
    difference: Difference, *, ground: TIN | None = None, title: str | None = None
) -> Any:
    """Draw where a surface is cut and filled.

    Parameters
    ----------
    difference : Difference
        Of :func:`tinsmith.difference`.
    ground : TIN, optional
        Drawn shaded around, for orientation.
    title : str, optional
        Default "Cut and fill".

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it. Cut is red, fill blue, with lines of equal
        difference; the black line parts them. What differs by no more than a level of detection has
        no colour. Above it stand the sums of ``difference.volumes``, with their standard errors.

    Raises
    ------
    OptionError
        If the difference is none, or the title is no text.
    PointsError
        If the ground is no TIN.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> flat = ts.triangulate([[0, 0, 1], [4, 0, 1], [4, 4, 1], [0, 4, 1]])
    >>> ramp = ts.triangulate([[0, 0, 0], [4, 0, 2], [4, 4, 2], [0, 4, 0]])
    >>> figure = ts.earthwork_map(ts.difference(flat, ramp))
    >>> figure.axes[0].get_ylabel()
    'northing'
    """
    require_type("difference", difference, Difference)
    if ground is not None:
        require_tin(ground)
    surface = draw_north_up(difference.tin)
    drawn = start_map(
        surface,
        parse_title(title, "Cut and fill"),
        purpose=_PURPOSE,
        pad=_PAD,
        beside=_SCALE,
        caption_lines=1 + _has_level(difference),
    )
    axes = drawn.axes
    if ground is not None:
        shade = hillshade(ground, grid=_choose_grid(ground, axes), smooth=True)
        draw_shade(axes, shade, limits=_LIGHTS)
    _draw_difference(drawn, surface, difference)
    _draw_zero_line(axes, surface, draw_north_up(difference.zero_line))
    lines = [_write_sums(difference.volumes)]
    if _has_level(difference):
        lines.append(_write_beyond(difference.volumes))
    drawn.write_caption("\n".join(lines), size=10)
    return drawn.figure


def _has_level(difference: Difference) -> bool:
    return "level_of_detection" in difference.volumes.columns


def _write_sums(table: Table) -> str:
    unit = table.units.get("area")
    parts = [
        f"{kind} {_write_volume(table, kind)} over "
        f"{_write_rounded(float(table[f'{kind}_area'].sum()))}{f' {unit}' if unit else ''}"
        for kind in ("cut", "fill")
    ]
    parts.append(f"net {_write_volume(table, 'net')}")
    return "; ".join(parts).capitalize()


def _write_volume(table: Table, name: str) -> str:
    """Write a volume with its standard error: that of several regions together is not known."""
    unit = f" {table.units[name]}" if table.units.get(name) else ""
    value, errors = float(table[name].sum()), table.columns.get(f"{name}_error")
    if errors is None or len(table) > 1 or not errors[0] > 0.0:
        return f"{_write_rounded(value)}{unit}"
    digits = max(1 - math.floor(math.log10(errors[0])), 0)
    return f"{value:,.{digits}f} ± {errors[0]:,.{digits}f}{unit}"


def _write_beyond(table: Table) -> str:
    unit: Any = table.units.get("level_of_detection")
    levels = table["level_of_detection"]
    level = f"{float(np.nanmean(levels)):.3g} {getattr(unit, 'symbol', unit) or ''}".rstrip()
    parts = [f"{kind} {_write_volume(table, f'thresholded_{kind}')}" for kind in _KINDS]
    return f"Beyond a level of detection of {level}: {'; '.join(parts)}"


def _write_rounded(value: float) -> str:
    """Write a number with about four digits, and no less than whole ones."""
    return f"{value:,.{max(4 - len(f'{abs(value):.0f}'), 0)}f}"


def _choose_grid(tin: TIN, axes: Any) -> Grid:
    """Return cells, as many as the picture shows, over the part of a TIN that is in view."""
    bounds = tin.bounds
    (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
    west, east = max(west, bounds.xmin), min(east, bounds.xmax)
    south, north = max(south, bounds.ymin), min(north, bounds.ymax)
    return cover(Bounds(west, south, east, north), max(east - west, north - south) / PIXELS)


def _draw_difference(drawn: Map, tin: TIN, difference: Difference) -> None:
    colors = optional.load("matplotlib.colors", _PURPOSE)
    axes, (x, y, height) = drawn.axes, tin.points.T
    most = float(np.abs(height).max()) or 1.0
    ramp = colors.LinearSegmentedColormap.from_list("earthwork", palette.EARTHWORK)
    is_drawn = ~difference.unchanged
    if not _has_level(difference):
        is_drawn[:] = True
    if not is_drawn.any():
        return
    colored = tin if is_drawn.all() else TIN.from_triangles(tin.points, tin.triangles[is_drawn])
    cells = rasterize(colored, grid=_choose_grid(tin, axes))
    image = draw_cells(axes, cells, limits=(-most, most), cmap=ramp, interpolation="nearest")
    levels = _choose_levels(height)
    if len(levels):
        lines = axes.tricontour(
            x, y, tin.triangles, height, levels=levels, colors=INK, linewidths=0.4, zorder=2
        )
        axes.clabel(lines, fontsize=6.5, fmt="%+g", inline_spacing=2)
    draw_scale(drawn, image, "cut (below 0) and fill (above 0)")


def _choose_levels(height: Float64Array) -> Float64Array:
    """Return round differences, 0 left out."""
    low, high = float(height.min()), float(height.max())
    most = max(high, -low)
    if most == 0.0:
        return np.zeros(0)
    step = round_down(2.0 * most / _LINES)
    numbers = np.arange(np.ceil(low / step), np.floor(high / step) + 1)
    levels: Float64Array = numbers[numbers != 0] * step
    return levels[(levels > low) & (levels < high)]


def _draw_zero_line(axes: Any, surface: TIN, lines: Features) -> None:
    collections = optional.load("matplotlib.collections", _PURPOSE)
    paths = np.split(lines.coordinates[:, :2], lines.offsets[0][1:-1]) if len(lines) else []
    rings = [surface.points[np.append(ring, ring[0]), :2] for ring in surface.rings]
    for drawn, width, style in ((paths, 1.4, "solid"), (rings, 0.9, (0, (4, 2)))):
        axes.add_collection(
            collections.LineCollection(
                drawn, colors=palette.NO_CHANGE, linewidths=width, linestyles=style, zorder=3
            ),
            autolim=False,
        )
