"""Relief map: classes of slope or aspect on a hillshade, with a legend, or a hillshade alone."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ... import _optional
from ..relief.shading import hillshade
from ..rounding import choose_ticks
from ..units import find_ground

if TYPE_CHECKING:
    from ...tin import TIN
    from ..results import Features, Raster

__all__ = ["relief_map"]

_PURPOSE = "A relief map"
_WIDTH = 9.0
"""Of the picture, inches."""
_MARGIN = 1.4
"""Above and below the map together, inches."""
_PIXELS = 1400
"""Of the shading, along the longer side."""
_INK = "#333333"
_VEIL = 0.72
_SHADES = (1, 255)


def relief_map(
    tin: TIN,
    classes: Features | None = None,
    *,
    shade: Raster | None = None,
    title: str | None = None,
) -> Any:
    """Draw classes of slope or aspect on the hillshade of a TIN.

    Parameters
    ----------
    tin : TIN
    classes : Features, optional
        Of :func:`tinsmith.slope_classes` or :func:`tinsmith.aspect_classes`; default the hillshade
        alone.
    shade : Raster, optional
        Of :func:`tinsmith.hillshade`; default a smooth one.
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
    >>> figure = ts.relief_map(tin, ts.slope_classes(tin), title="A plane")
    >>> figure.axes[0].get_legend().get_texts()[0].get_text()
    '45° and more, 100.0 %'
    """
    figure, axes = _frame(tin, title or ("Hillshade" if classes is None else "Slope"))
    _draw_shade(axes, _usual_shade(tin) if shade is None else shade)
    if classes is not None and len(classes):
        _draw_classes(axes, classes)
    return figure


def _usual_shade(tin: TIN) -> Raster:
    bounds = tin.bounds
    return hillshade(tin, spacing=max(bounds.width, bounds.height) / _PIXELS, smooth=True)


def _frame(tin: TIN, title: str) -> tuple[Any, Any]:
    """Return a figure with empty axes, true to scale."""
    ground, bounds = find_ground(tin), tin.bounds
    east, north, _ = ground.scale
    tall = float(np.clip(bounds.height * north / (bounds.width * east), 0.4, 1.5))
    figure = _optional.load("matplotlib.figure", _PURPOSE).Figure(
        figsize=(_WIDTH, 0.86 * _WIDTH * tall + _MARGIN), layout="constrained"
    )
    figure.suptitle(" ".join(title.split()), fontsize=15, color=_INK, parse_math=False)
    axes = figure.subplots()
    axes.set_aspect(north / east)
    pad = 0.02 * max(bounds.width, bounds.height)
    axes.set_xlim(bounds.xmin - pad, bounds.xmax + pad)
    axes.set_ylim(bounds.ymin - pad, bounds.ymax + pad)
    symbol = "" if tin.crs is None else tin.crs.horizontal_unit.symbol
    unit = f", {symbol}" if symbol else ""
    axes.set_xlabel(f"easting{unit}\n{ground.crs_name}", color=_INK, parse_math=False)
    axes.set_ylabel(f"northing{unit}", color=_INK)
    axes.ticklabel_format(style="plain", useOffset=False)
    axes.set_xticks(choose_ticks(bounds.xmin, bounds.xmax, count=5))
    axes.set_yticks(choose_ticks(bounds.ymin, bounds.ymax, count=5))
    axes.tick_params(colors=_INK, labelsize=8)
    return figure, axes


def _draw_shade(axes: Any, shade: Raster) -> None:
    bounds, band = shade.grid.bounds, next(iter(shade.bands.values()))
    axes.imshow(
        np.ma.masked_equal(band[:, :], shade.nodata),
        extent=(bounds.xmin, bounds.xmax, bounds.ymin, bounds.ymax),
        cmap="gray",
        vmin=_SHADES[0],
        vmax=_SHADES[1],
        aspect=axes.get_aspect(),
        interpolation="bilinear",
        zorder=0,
    )


def _draw_classes(axes: Any, classes: Features) -> None:
    """Draw the polygons of each class, and name them in a legend."""
    patches = _optional.load("matplotlib.patches", _PURPOSE)
    columns = classes.columns
    for path, color in zip(_paths(classes), columns["color"], strict=True):
        axes.add_patch(
            patches.PathPatch(path, facecolor=color, edgecolor="none", alpha=_VEIL, zorder=1)
        )
    keys = [
        patches.Patch(facecolor=color, alpha=_VEIL, label=f"{label}, {share:.1f} %")
        for color, label, share in zip(
            columns["color"], columns["label"], columns["share"], strict=True
        )
    ]
    axes.legend(
        handles=keys,
        title="Class, share of area",
        fontsize=8,
        title_fontsize=8.5,
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        frameon=False,
    )


def _paths(features: Features) -> list[Any]:
    """Return one path for each feature, of all its rings."""
    path = _optional.load("matplotlib.path", _PURPOSE).Path
    rings, polygons, parts = features.offsets
    made = []
    for first, last in pairwise(parts):
        begin, end = rings[polygons[first]], rings[polygons[last]]
        codes = np.full(end - begin, path.LINETO, path.code_type)
        starts = rings[polygons[first] : polygons[last] + 1] - begin
        codes[starts[:-1]] = path.MOVETO
        codes[starts[1:] - 1] = path.CLOSEPOLY
        made.append(path(features.coordinates[begin:end, :2], codes))
    return made
