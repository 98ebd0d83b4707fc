"""Cut and fill map: where a surface is lowered and raised, by how much, with the volumes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ... import _optional
from ..rounding import choose_ticks, round_down
from ..slope import compute_normals
from ..units import find_ground

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN
    from ..earthwork import Difference
    from ..units import Ground

__all__ = ["earthwork_map"]

_PURPOSE = "A cut and fill map"
_WIDTH, _MARGIN = 9.0, 1.3
"""Inches: of the picture, and above and below the map together."""
_PIXELS = 1400
"""Of the picture of a surface, along the longer side."""
_PAD = 0.18
"""Of the ground around what is cut and filled, as a share of its extent."""
_INK, _ZERO = "#333333", "#111111"
_COLORS = ("#8c1c13", "#e07a5f", "#fbfaf5", "#5fa8d3", "#1b4965")
"""From the deepest cut over nothing to the highest fill."""
_LIGHT = np.array([-0.5, 0.5, np.sqrt(0.5)])
"""From the north-west, 45 degrees high, as maps are shaded."""
_LINES = 8
"""So many lines of equal cut or fill are drawn at most on each side."""


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
        difference; the black line parts them.

    Raises
    ------
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
    tin = difference.tin
    scale = find_ground(tin)
    figure, axes = _frame(tin, scale, title)
    limits = axes.get_xlim(), axes.get_ylim()
    if ground is not None:
        _draw_ground(axes, ground)
    _draw_difference(figure, axes, tin, scale)
    _draw_zero_line(axes, difference)
    axes.set_xlim(limits[0])  # images bring limits of their own
    axes.set_ylim(limits[1])
    axes.set_title(_caption(difference), loc="left", fontsize=10, color=_INK, parse_math=False)
    return figure


def _frame(tin: TIN, scale: Ground, title: str | None) -> tuple[Any, Any]:
    bounds = tin.bounds
    pad = _PAD * max(bounds.width, bounds.height)
    tall = float(np.clip((bounds.height + 2 * pad) / (bounds.width + 2 * pad), 0.4, 1.5))
    figure = _optional.load("matplotlib.figure", _PURPOSE).Figure(
        figsize=(_WIDTH, 0.78 * _WIDTH * tall + _MARGIN), layout="constrained"
    )
    heading = " ".join((title or "Cut and fill").split())
    figure.suptitle(heading, fontsize=15, color=_INK, parse_math=False)
    axes = figure.subplots()
    axes.set_aspect(scale.scale[1] / scale.scale[0])
    axes.set_xlim(bounds.xmin - pad, bounds.xmax + pad)
    axes.set_ylim(bounds.ymin - pad, bounds.ymax + pad)
    unit = f", {scale.unit.symbol}" if scale.unit.symbol else ""
    axes.set_xlabel(f"easting{unit}\n{scale.crs_name}", color=_INK, parse_math=False)
    axes.set_ylabel(f"northing{unit}", color=_INK)
    axes.ticklabel_format(style="plain", useOffset=False)
    axes.set_xticks(choose_ticks(bounds.xmin - pad, bounds.xmax + pad, count=5))
    axes.set_yticks(choose_ticks(bounds.ymin - pad, bounds.ymax + pad, count=5))
    axes.tick_params(colors=_INK, labelsize=8)
    return figure, axes


def _caption(difference: Difference) -> str:
    zones = difference.zones
    unit = zones.units["volume"]
    symbol = "" if unit is None else f" {unit}"
    square = "" if unit is None else f" {zones.units['area']}"
    parts = []
    for kind in ("cut", "fill"):
        chosen = zones.columns["kind"] == kind
        volume, area = (float(zones.columns[name][chosen].sum()) for name in ("volume", "area"))
        parts.append(f"{kind} {_rounded(volume)}{symbol} over {_rounded(area)}{square}")
    net = difference.fill - difference.cut
    surplus = f"net {_rounded(net)}{symbol}"
    return f"{'; '.join(parts).capitalize()}; {surplus}"


def _rounded(value: float) -> str:
    """Write a number with about four digits, and no less than whole ones."""
    return f"{value:,.{max(4 - len(f'{abs(value):.0f}'), 0)}f}"


def _places(tin: TIN, axes: Any) -> tuple[tuple[float, ...], NDArray[np.float64], Any]:
    """Return the part of a TIN that is in view, and a place in each pixel of it, row by row."""
    bounds = tin.bounds
    (west, east), (south, north) = axes.get_xlim(), axes.get_ylim()
    west, east = max(west, bounds.xmin), min(east, bounds.xmax)
    south, north = max(south, bounds.ymin), min(north, bounds.ymax)
    cell = max(east - west, north - south) / _PIXELS
    columns, rows = max(1, round((east - west) / cell)), max(1, round((north - south) / cell))
    x = west + (np.arange(columns) + 0.5) * (east - west) / columns
    y = north - (np.arange(rows) + 0.5) * (north - south) / rows
    return (west, east, south, north), np.stack(np.meshgrid(x, y), axis=-1), (rows, columns)


def _draw_ground(axes: Any, ground: TIN) -> None:
    """Draw the ground shaded, paler than what matters."""
    upward = compute_normals(ground)
    lengths = np.maximum(np.linalg.norm(upward, axis=1), np.finfo(float).tiny)
    shade = np.clip(upward @ _LIGHT / lengths, 0.0, 1.0)
    extent, places, shape = _places(ground, axes)
    triangle = ground.locate(places.reshape(-1, 2)).reshape(shape)
    _draw_image(axes, np.where(triangle >= 0, shade[triangle], np.nan), extent, "gray", (-0.9, 0.9))


def _draw_image(
    axes: Any, image: NDArray[np.float64], extent: Any, colors: Any, limits: tuple[float, float]
) -> Any:
    return axes.imshow(
        np.ma.masked_invalid(image),
        extent=extent,
        cmap=colors,
        vmin=limits[0],
        vmax=limits[1],
        aspect=axes.get_aspect(),
        interpolation="nearest",
    )


def _draw_difference(figure: Any, axes: Any, tin: TIN, scale: Ground) -> None:
    colors = _optional.load("matplotlib.colors", _PURPOSE)
    x, y, height = tin.points.T
    most = float(np.abs(height).max()) or 1.0
    extent, places, shape = _places(tin, axes)
    image = tin.interpolate(places.reshape(-1, 2)).reshape(shape)
    ramp = colors.LinearSegmentedColormap.from_list("earthwork", _COLORS)
    drawn = _draw_image(axes, image, extent, ramp, (-most, most))
    levels = _levels(height)
    if len(levels):
        lines = axes.tricontour(
            x, y, tin.triangles, height, levels=levels, colors=_INK, linewidths=0.4, zorder=2
        )
        axes.clabel(lines, fontsize=6.5, fmt="%+g", inline_spacing=2)
    bar = figure.colorbar(drawn, ax=axes, shrink=0.8, aspect=32)
    unit = f", {scale.elevation_caption}" if scale.elevation_caption else ""
    bar.set_label(f"cut (below 0) and fill (above 0){unit}", color=_INK)
    bar.ax.tick_params(colors=_INK, labelsize=8)


def _levels(height: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return round differences, 0 left out."""
    low, high = float(height.min()), float(height.max())
    most = max(high, -low)
    if most == 0.0:
        return np.zeros(0)
    step = round_down(2.0 * most / _LINES)
    numbers = np.arange(np.ceil(low / step), np.floor(high / step) + 1)
    levels: NDArray[np.float64] = numbers[numbers != 0] * step
    return levels[(levels > low) & (levels < high)]


def _draw_zero_line(axes: Any, difference: Difference) -> None:
    collections = _optional.load("matplotlib.collections", _PURPOSE)
    lines = difference.zero_line
    paths = np.split(lines.coordinates[:, :2], lines.offsets[0][1:-1]) if len(lines) else []
    rings = [difference.tin.points[np.append(ring, ring[0]), :2] for ring in difference.tin.rings]
    for drawn, width, style in ((paths, 1.4, "solid"), (rings, 0.9, (0, (4, 2)))):
        axes.add_collection(
            collections.LineCollection(
                drawn, colors=_ZERO, linewidths=width, linestyles=style, zorder=3
            ),
            autolim=False,
        )
