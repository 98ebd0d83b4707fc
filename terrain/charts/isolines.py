"""Contour map: lines with labels on a shaded surface, or bands of elevation, as a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.checks import require_tin
from ..drawing import palette, parse_title, require_features
from ..isolines import contour_labels
from .figures import picture
from .maps import draw_polygons, draw_scale, draw_shade, shade_for_map, start_map

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.georeference import Ground
    from ...base.results import Features
    from ...tin import TIN
    from .maps import Map

_PURPOSE = "A contour map"
_LIGHTS = (-60, 255)
"""What is black and what is white: paler than a hillshade alone, so that lines are read."""
_SCALE = 0.95
"""Inches beside the map."""


@picture
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
        Drawn without a screen; ``savefig`` writes it. The caption tells the interval if it is one.

    Raises
    ------
    PointsError
        If the TIN is none.
    OptionError
        If lines, bands or labels are not such features, or the title is no text.
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
    require_tin(tin)
    _require_isolines(lines, bands, labels)
    has_bands = bands is not None and len(bands) > 0
    usual = "Bands of elevation" if has_bands and lines is None else "Contours"
    drawn = start_map(
        tin,
        parse_title(title, usual),
        purpose=_PURPOSE,
        beside=_SCALE if has_bands else 0.0,
        caption_lines=1,
    )
    axes = drawn.axes
    draw_shade(axes, shade_for_map(tin), limits=_LIGHTS)
    if bands is not None and has_bands:
        _draw_bands(drawn, bands)
    if lines is not None and len(lines):
        _draw_lines(axes, lines)
        _draw_labels(axes, contour_labels(lines) if labels is None else labels)
    drawn.write_caption(_write_caption(lines, drawn.ground), size=9)
    return drawn.figure


def _require_isolines(lines: Any, bands: Any, labels: Any) -> None:
    """Refuse what is not drawn as contours, as bands or as labels."""
    for option, features, kind, columns, source in (
        ("lines", lines, "lines", ("elevation", "is_index"), "contours"),
        ("bands", bands, "polygons", ("from", "to"), "contour_bands"),
        ("labels", labels, "points", ("text", "rotation"), "contour_labels"),
    ):
        require_features(option, features, kind=kind, columns=columns, source=source)


def _write_caption(lines: Features | None, ground: Ground) -> str:
    unit = f" {ground.elevation_caption}" if ground.elevation_caption else ""
    if lines is None or len(lines) == 0:
        return f"Elevations{f' in{unit}' if unit else ''}"
    levels = np.unique(lines.columns["elevation"])
    marked = np.unique(lines.columns["elevation"][lines.columns["is_index"]])
    spoken = [_write_steps(levels, "contours", unit), _write_steps(marked, "index contours", unit)]
    return ", ".join(part for part in spoken if part).capitalize()


def _write_steps(levels: Float64Array, what: str, unit: str) -> str:
    """Say at which interval levels are, if at one."""
    steps = np.diff(levels).round(9)
    if len(steps) == 0 or (steps != steps[0]).any():
        return ""
    return f"{what} every {steps[0]:g}{unit}"


# ------------------------------------------------------------------------- drawing


def _draw_lines(axes: Any, lines: Features) -> None:
    collections = optional.load("matplotlib.collections", _PURPOSE)
    paths = np.split(lines.coordinates[:, :2], lines.offsets[0][1:-1])
    is_index = lines.columns["is_index"]
    widths = np.where(is_index, 1.3, 0.55)
    axes.add_collection(
        collections.LineCollection(paths, colors=palette.CONTOURS, linewidths=widths, zorder=3),
        autolim=False,
    )


def _draw_labels(axes: Any, labels: Features) -> None:
    effects = optional.load("matplotlib.patheffects", _PURPOSE)
    halo = [effects.withStroke(linewidth=2.6, foreground=palette.HALO)]
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
            color=palette.CONTOURS,
            path_effects=halo,
            clip_on=True,
            zorder=4,
        )


def _draw_bands(drawn: Map, bands: Features) -> None:
    colors = optional.load("matplotlib.colors", _PURPOSE)
    ramp = palette.interpolate_tints(max(len(bands), 2)) / 255.0
    draw_polygons(drawn.axes, bands, ramp[: len(bands)], _PURPOSE)
    bounds = _list_bounds(bands)
    scale = optional.load("matplotlib.cm", _PURPOSE).ScalarMappable(
        colors.BoundaryNorm(bounds, len(bounds) - 1),
        colors.ListedColormap(ramp[: len(bands)]),
    )
    draw_scale(drawn, scale, "elevation", ticks=bounds[:: 1 + len(bounds) // 14])


def _list_bounds(bands: Features) -> Float64Array:
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
