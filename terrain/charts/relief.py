"""Relief map: classes of slope or aspect on a hillshade, with a legend, or a hillshade alone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base import optional
from ...base.checks import require_tin, require_type
from ...base.results import Raster
from ..drawing import parse_title, require_features
from .figures import picture
from .maps import VEIL, draw_polygons, draw_shade, shade_for_map, start_map

if TYPE_CHECKING:
    from ...base.results import Features
    from ...tin import TIN

_PURPOSE = "A relief map"
_COLUMNS = ("color", "label", "share")
_SOURCE = "slope_classes or aspect_classes"
_LEGEND = 1.8
"""Inches beside the map."""


@picture
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
        Drawn without a screen; ``savefig`` writes it. A legend tells each class's share of the
        area.

    Raises
    ------
    PointsError
        If the TIN is none.
    OptionError
        If classes are not such features, the shade is no raster, or the title is no text.
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
    require_tin(tin)
    require_features("classes", classes, kind="polygons", columns=_COLUMNS, source=_SOURCE)
    require_type("shade", shade, Raster, or_none=True)
    has_classes = classes is not None and len(classes) > 0
    drawn = start_map(
        tin,
        parse_title(title, _choose_title(classes)),
        purpose=_PURPOSE,
        beside=_LEGEND if has_classes else 0.0,
    )
    draw_shade(drawn.axes, shade_for_map(tin) if shade is None else shade)
    if classes is not None and has_classes:
        _draw_classes(drawn.axes, classes)
    return drawn.figure


def _choose_title(classes: Features | None) -> str:
    if classes is None or len(classes) == 0:
        return "Hillshade"
    return "Aspect" if classes.name == "aspect_classes" else "Slope"


def _draw_classes(axes: Any, classes: Features) -> None:
    """Draw the polygons of each class, and name them in a legend."""
    patches = optional.load("matplotlib.patches", _PURPOSE)
    columns = classes.columns
    draw_polygons(axes, classes, columns["color"], _PURPOSE)
    keys = [
        patches.Patch(facecolor=color, alpha=VEIL, label=f"{label}, {share:.1f} %")
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
