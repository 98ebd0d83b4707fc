"""Triangles for matplotlib: its Triangulation, and a TIN drawn in plan on anybody's axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base import optional
from ...base.checks import as_flag, as_floats, require_tin
from ...base.errors import OptionError
from ...base.georeference import find_axes, find_ground
from ...base.products import product
from ..drawing import LINE_STYLES, find_line_edges, palette
from ..surface import compute_normals, measure_slopes

if TYPE_CHECKING:
    from ...base.arrays import Float64Array
    from ...base.georeference import Ground
    from ...tin import TIN

_MOST_WITH_EDGES = 5_000
"""Triangles; the edges of more hide the colours."""


@product
def to_matplotlib(tin: TIN) -> Any:
    """Return the triangles as matplotlib has them, for ``tripcolor``, ``tricontourf``, ``triplot``.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    matplotlib.tri.Triangulation
        Eastings and northings in CRS units, nothing subtracted; triangles in the TIN's order.
        Elevations are ``tin.points[:, 2]``.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    PointsError
        If ``tin`` is none.

    Notes
    -----
    Matplotlib computes contours and colours of the triangles in double precision, which holds for
    map coordinates. For elevations at places ask :meth:`TIN.interpolate`, which is exact.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> ts.to_matplotlib(tin).triangles.shape
    (2, 3)
    """
    tri = optional.load("matplotlib.tri", "Handing triangles over to matplotlib")
    require_tin(tin)
    x, y, _ = tin.points.T
    return tri.Triangulation(x.copy(), y.copy(), tin.triangles.copy())


@product
def plot_tin(
    tin: TIN,
    ax: Any,
    *,
    values: Any,
    edges: bool | None,
    lines: bool,
    colorbar: bool,
    **options: Any,
) -> Any:
    """Draw a TIN in plan, as :meth:`TIN.plot` describes it."""
    with_edges = len(tin) <= _MOST_WITH_EDGES if edges is None else as_flag("edges", edges)
    with_lines, with_bar = as_flag("lines", lines), as_flag("colorbar", colorbar)
    triangles = to_matplotlib(tin)
    numbers, name = _find_values(tin, values)
    is_new = ax is None
    if not is_new and not hasattr(ax, "tripcolor"):
        raise OptionError("ax", ax, "the axes of a matplotlib figure", or_none=True)
    if is_new:
        ax = optional.load("matplotlib.pyplot", "Drawing a TIN").subplots(layout="constrained")[1]
    ground = find_ground(tin)
    if numbers is not None:
        is_flat = len(numbers) != len(tin.points) or name == "slope"
        how = {"facecolors": numbers} if is_flat else {"shading": "gouraud"}
        given = (triangles,) if is_flat else (triangles, numbers)
        mapped = ax.tripcolor(*given, **(how | options))
        if is_new and with_bar:
            unit = {"elevation": ground.elevation_caption, "slope": "degrees"}.get(name, "")
            ax.figure.colorbar(mapped, ax=ax, shrink=0.7, label=f"{name}, {unit}" if unit else name)
    if with_edges:
        ax.triplot(triangles, color=palette.EDGES_CHART, linewidth=0.3)
    if with_lines:
        _draw_lines(ax, tin)
    _set_axes(ax, tin, ground, is_new=is_new)
    return ax


def _find_values(tin: TIN, values: Any) -> tuple[Float64Array | None, str]:
    """Return a number for each vertex or triangle, and what it is called."""
    if values is None:
        return None, ""
    if isinstance(values, str):
        if values == "elevation":
            return tin.points[:, 2], values
        if values == "slope":
            return measure_slopes(compute_normals(tin), "degrees"), values
        raise OptionError("values", values, ["elevation", "slope"])
    numbers = as_floats(values)
    if numbers is None or numbers.shape not in ((len(tin.points),), (len(tin),)):
        raise OptionError(
            "values",
            values,
            f"elevation, slope, {len(tin.points):,} numbers (one a vertex) or {len(tin):,} (one a "
            "triangle)",
        )
    return numbers, ""


def _draw_lines(ax: Any, tin: TIN) -> None:
    collection = optional.load("matplotlib.collections", "Drawing a TIN").LineCollection
    for kind, pairs in find_line_edges(tin).by_kind().items():
        style = LINE_STYLES[kind]
        how = {"colors": style.color, "linestyles": "--" if style.dashed else "-"}
        ax.add_collection(collection(tin.points[pairs][..., :2], linewidths=1.2, **how))


def _set_axes(ax: Any, tin: TIN, ground: Ground, *, is_new: bool) -> None:
    """Draw true to scale, with whole coordinates along the sides; north is up on new axes."""
    east, north, _ = ground.scale
    ax.set_aspect(north / east)
    ax.autoscale_view()
    ax.ticklabel_format(style="plain", useOffset=False)
    ax.locator_params(nbins=5)
    axes = find_axes(tin.crs)
    if is_new and axes == ("west", "south"):
        ax.invert_xaxis()
        ax.invert_yaxis()
    symbol = "" if tin.crs is None else tin.crs.horizontal_unit.symbol
    names = (f"{direction}ing" for direction in axes)
    for label, set_label in zip(names, (ax.set_xlabel, ax.set_ylabel), strict=True):
        set_label(f"{label}, {symbol}" if symbol else label)
