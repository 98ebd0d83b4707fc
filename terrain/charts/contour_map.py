"""Contour map: lines with labels on a shaded surface, or bands of elevation, as a picture."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ... import _optional
from ..isolines.labels import contour_labels
from ..preview.tints import interpolate_tints
from ..rounding import choose_ticks
from ..slope import compute_normals
from ..units import find_ground

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...tin import TIN
    from ..results import Features
    from ..units import Ground

__all__ = ["contour_map"]

_PURPOSE = "A contour map"
_WIDTH = 9.0
"""Of the picture, inches."""
_MARGIN = 1.6
"""Above and below the map together, inches."""
_PIXELS = 1400
"""Of the shading, along the longer side."""
_INK = "#333333"
_LINE = "#6b4a2b"
_LIGHT = np.array([-0.5, 0.5, np.sqrt(0.5)])
"""From the north-west, 45 degrees high, as maps are shaded."""
_SHADES = ("#4a4d50", "#ffffff")
_BAND_VEIL = 0.72


def contour_map(
    tin: TIN,
    lines: Features | None = None,
    *,
    bands: Features | None = None,
    labels: Features | None = None,
    title: str | None = None,
) -> Any:
    """Draw contours of a TIN on its hillshade.

    Parameters
    ----------
    tin : TIN
    lines : Features, optional
        Of :func:`tinsmith.contours`; index contours are drawn thicker.
    bands : Features, optional
        Of :func:`tinsmith.contour_bands`; tinted by elevation, with a scale.
    labels : Features, optional
        Of :func:`tinsmith.contour_labels`; default those of the lines.
    title : str, optional

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 0], [9, 0, 9], [9, 9, 9], [0, 9, 0]])
    >>> figure = ts.contour_map(tin, ts.contours(tin, interval=1))
    >>> figure.axes[0].get_ylabel()
    'northing'
    """
    ground = find_ground(tin)
    figure, axes = _frame(tin, ground, title)
    _draw_shade(axes, tin)
    if bands is not None and len(bands):
        _draw_bands(figure, axes, bands, ground)
    if lines is not None and len(lines):
        _draw_lines(axes, lines)
        _draw_labels(axes, contour_labels(lines) if labels is None else labels)
    axes.set_title(_caption(lines, ground), loc="left", fontsize=9, color=_INK, parse_math=False)
    return figure


def _frame(tin: TIN, ground: Ground, title: str | None) -> tuple[Any, Any]:
    bounds = tin.bounds
    width, height = bounds.xmax - bounds.xmin, bounds.ymax - bounds.ymin
    tall = float(np.clip(height / width, 0.4, 1.5))
    figure = _optional.load("matplotlib.figure", _PURPOSE).Figure(
        figsize=(_WIDTH, 0.86 * _WIDTH * tall + _MARGIN), layout="constrained"
    )
    heading = " ".join((title or "Contours").split())
    figure.suptitle(heading, fontsize=15, color=_INK, parse_math=False)
    axes = figure.subplots()
    east, north, _ = ground.scale
    axes.set_aspect(north / east)
    pad = 0.02 * max(width, height)
    axes.set_xlim(bounds.xmin - pad, bounds.xmax + pad)
    axes.set_ylim(bounds.ymin - pad, bounds.ymax + pad)
    unit = _horizontal_symbol(tin)
    axes.set_xlabel(f"easting{unit}\n{ground.crs_name}", color=_INK, parse_math=False)
    axes.set_ylabel(f"northing{unit}", color=_INK)
    axes.ticklabel_format(style="plain", useOffset=False)
    axes.set_xticks(choose_ticks(bounds.xmin, bounds.xmax, count=5))
    axes.set_yticks(choose_ticks(bounds.ymin, bounds.ymax, count=5))
    axes.tick_params(colors=_INK, labelsize=8)
    axes.grid(color="#9aa0a6", linewidth=0.4, alpha=0.5)
    return figure, axes


def _horizontal_symbol(tin: TIN) -> str:
    symbol = "" if tin.crs is None else tin.crs.horizontal_unit.symbol
    return f", {symbol}" if symbol else ""


def _caption(lines: Features | None, ground: Ground) -> str:
    unit = f" {ground.elevation_caption}" if ground.elevation_caption else ""
    if lines is None or len(lines) == 0:
        return f"Elevations{f' in{unit}' if unit else ''}"
    levels = np.unique(lines.columns["elevation"])
    marked = np.unique(lines.columns["elevation"][lines.columns["is_index"]])
    spoken = [_every(levels, "contours", unit), _every(marked, "index contours", unit)]
    return ", ".join(part for part in spoken if part).capitalize()


def _every(levels: NDArray[np.float64], what: str, unit: str) -> str:
    """Say at which interval levels are, if at one."""
    steps = np.diff(levels).round(9)
    if len(steps) == 0 or (steps != steps[0]).any():
        return ""
    return f"{what} every {steps[0]:g}{unit}"


# ------------------------------------------------------------------------- drawing


def _draw_shade(axes: Any, tin: TIN) -> None:
    bounds = tin.bounds
    width, height = bounds.xmax - bounds.xmin, bounds.ymax - bounds.ymin
    cell = max(width, height) / _PIXELS
    columns, rows = (max(1, round(side / cell)) for side in (width, height))
    x = bounds.xmin + (np.arange(columns) + 0.5) * width / columns
    y = bounds.ymax - (np.arange(rows) + 0.5) * height / rows
    shaded = tin.replace(points=np.column_stack([tin.points[:, :2], _vertex_shades(tin)]))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    image = shaded.interpolate(places).reshape(rows, columns)
    colors = _optional.load("matplotlib.colors", _PURPOSE)
    axes.imshow(
        np.ma.masked_invalid(image),
        extent=(bounds.xmin, bounds.xmax, bounds.ymin, bounds.ymax),
        cmap=colors.LinearSegmentedColormap.from_list("shade", _SHADES),
        vmin=0.25,
        vmax=0.95,
        aspect=axes.get_aspect(),
        interpolation="bilinear",
        zorder=0,
    )


def _vertex_shades(tin: TIN) -> NDArray[np.float64]:
    """Return how bright the surface is at each vertex: the cosine of the angle to the light."""
    upward = np.repeat(compute_normals(tin), 3, axis=0)
    corners = tin.triangles.ravel()
    count = len(tin.points)
    sums = np.stack([np.bincount(corners, axis, count) for axis in upward.T], axis=1)
    lengths = np.maximum(np.linalg.norm(sums, axis=1), np.finfo(float).tiny)
    shades: NDArray[np.float64] = np.clip(sums @ _LIGHT / lengths, 0.0, 1.0)
    return shades


def _draw_lines(axes: Any, lines: Features) -> None:
    collections = _optional.load("matplotlib.collections", _PURPOSE)
    paths = np.split(lines.coordinates[:, :2], lines.offsets[0][1:-1])
    is_index = lines.columns["is_index"]
    widths = np.where(is_index, 1.3, 0.55)
    axes.add_collection(
        collections.LineCollection(paths, colors=_LINE, linewidths=widths, zorder=3),
        autolim=False,
    )


def _draw_labels(axes: Any, labels: Features) -> None:
    effects = _optional.load("matplotlib.patheffects", _PURPOSE)
    halo = [effects.withStroke(linewidth=2.6, foreground="#ffffffd9")]
    columns = labels.columns
    for (x, y), text, rotation in zip(
        labels.coordinates[:, :2], columns["text"], columns["rotation"], strict=True
    ):
        axes.text(
            x,
            y,
            text,
            rotation=rotation,
            rotation_mode="anchor",
            transform_rotates_text=True,
            ha="center",
            va="center_baseline",
            fontsize=7,
            color=_LINE,
            path_effects=halo,
            clip_on=True,
            zorder=4,
        )


def _draw_bands(figure: Any, axes: Any, bands: Features, ground: Ground) -> None:
    colors = _optional.load("matplotlib.colors", _PURPOSE)
    patches = _optional.load("matplotlib.patches", _PURPOSE)
    ramp = interpolate_tints(max(len(bands), 2)) / 255.0
    for path, color in zip(_band_paths(bands), ramp, strict=False):
        axes.add_patch(
            patches.PathPatch(path, facecolor=color, edgecolor="none", alpha=_BAND_VEIL, zorder=1)
        )
    bounds = _band_bounds(bands)
    scale = _optional.load("matplotlib.cm", _PURPOSE).ScalarMappable(
        colors.BoundaryNorm(bounds, len(bounds) - 1),
        colors.ListedColormap(ramp[: len(bands)]),
    )
    step = 1 + len(bounds) // 14
    bar = figure.colorbar(
        scale, ax=axes, ticks=bounds[::step], shrink=0.8, aspect=32, spacing="proportional"
    )
    unit = f", {ground.elevation_caption}" if ground.elevation_caption else ""
    bar.set_label(f"elevation{unit}", color=_INK)
    bar.ax.tick_params(colors=_INK, labelsize=8)


def _band_paths(bands: Features) -> list[Any]:
    """Return one path for each band, of all its rings."""
    path = _optional.load("matplotlib.path", _PURPOSE).Path
    rings, polygons, features = bands.offsets
    made = []
    for first, last in pairwise(features):
        begin, end = rings[polygons[first]], rings[polygons[last]]
        codes = np.full(end - begin, path.LINETO, path.code_type)
        starts = rings[polygons[first] : polygons[last] + 1] - begin
        codes[starts[:-1]] = path.MOVETO
        codes[starts[1:] - 1] = path.CLOSEPOLY
        made.append(path(bands.coordinates[begin:end, :2], codes))
    return made


def _band_bounds(bands: Features) -> NDArray[np.float64]:
    """Return where bands begin and end; an open one is as high as the one beside it."""
    low, high = bands.columns["from"], bands.columns["to"]
    bounds = np.append(low, high[-1])
    bounds[1:-1] = high[:-1]
    known = bounds[np.isfinite(bounds)]
    step = float(np.diff(known).max(initial=0.0)) or 1.0
    if np.isnan(bounds[0]):
        bounds[0] = known[0] - step if len(known) else 0.0
    if np.isnan(bounds[-1]):
        bounds[-1] = bounds[-2] + step
    return bounds
