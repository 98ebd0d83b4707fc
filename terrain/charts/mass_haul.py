"""The diagram of mass haul: areas of cut and fill along an axis, and what is moved along it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base.errors import OptionError
from ...base.results import Table
from ..drawing import palette
from ..sections import find_balanced
from .figures import INK, color_frame, picture, start_panels

if TYPE_CHECKING:
    from ...base.arrays import Float64Array

_COLUMNS = ("station", "cut_area", "fill_area", "mass")
_WIDTH, _HEIGHT = 11.0, 7.0
_FAINT = {"color": palette.FAINT, "linewidth": 0.6}


@picture
def mass_haul_picture(table: Table, *, title: str = "Mass haul") -> Any:
    """Draw areas of cut and fill and the curve of mass haul along an axis.

    Where the curve rises there is more cut than fill, where it falls more fill; between two places
    of the same ordinate cut and fill balance.

    Parameters
    ----------
    table : Table
        Of :func:`tinsmith.section_volumes`.
    title : str

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    OptionError
        If the table is none of section volumes.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import tinsmith as ts
    >>> corners = [(0, 0), (8, 0), (8, 8), (0, 8)]
    >>> ground, design = (
    ...     ts.triangulate([[x, y, h] for (x, y), h in zip(corners, z, strict=True)])
    ...     for z in ((5, 5, 5, 5), (4, 6, 6, 4))
    ... )
    >>> table = ts.section_volumes(ground, design, [[0, 4], [8, 4]], interval=4, width=2)
    >>> len(ts.mass_haul_picture(table).axes)
    2
    """
    if not isinstance(table, Table) or any(name not in table.columns for name in _COLUMNS):
        raise OptionError("table", type(table).__name__, allowed="a Table of section_volumes")
    at = table["station"]
    figure = start_panels("Drawing mass haul", _WIDTH, _HEIGHT, title=title)
    areas, mass = figure.subplots(2, 1, sharex=True, height_ratios=(2, 3))
    _draw_areas(areas, table, at)
    _draw_mass(mass, table, at)
    for axes in (areas, mass):
        axes.grid(**_FAINT)
        axes.set_axisbelow(True)
        axes.xaxis.set_major_formatter("{x:,.0f}")
        axes.yaxis.set_major_formatter("{x:,.0f}")
        axes.margins(x=0.0)
        color_frame(axes)
    figure.align_ylabels([areas, mass])
    mass.set_xlabel(_caption(table, "station", "station"), color=INK)
    return figure


def _draw_areas(axes: Any, table: Table, at: Float64Array) -> None:
    for sign, name, color in ((1.0, "cut", palette.CUT), (-1.0, "fill", palette.FILL)):
        values = sign * table[f"{name}_area"]
        axes.fill_between(at, values, 0.0, color=color, linewidth=0, label=name)
        axes.plot(at, values, color=INK, linewidth=0.8)
    axes.axhline(0.0, color=INK, linewidth=0.8)
    axes.set_ylabel(_caption(table, "cut_area", "area, cut above fill"), color=INK)
    axes.legend(loc="upper right", frameon=False)


def _draw_mass(axes: Any, table: Table, at: Float64Array) -> None:
    mass = table["mass"]
    where = {"interpolate": True, "linewidth": 0}
    axes.fill_between(at, mass, 0.0, where=mass >= 0.0, color=palette.CUT, **where)
    axes.fill_between(at, mass, 0.0, where=mass <= 0.0, color=palette.FILL, **where)
    axes.plot(at, mass, color=INK, linewidth=1.6)
    axes.axhline(0.0, color=INK, linewidth=0.8)
    for place in find_balanced(mass, at).tolist():
        axes.axvline(place, color=INK, linewidth=0.8, linestyle=(0, (6, 3)))
    unit = _find_symbol(table, "mass")
    words = "cut to waste" if mass[-1] > 0.0 else "fill to borrow"
    left = f"{words}: {abs(mass[-1]):,.1f} {unit}".rstrip() if mass[-1] != 0.0 else "balanced"
    axes.text(0.01, 0.03, left, transform=axes.transAxes, color=INK)
    axes.set_ylabel(_caption(table, "mass", "mass"), color=INK)


def _find_symbol(table: Table, name: str) -> str:
    unit: Any = table.units.get(name)
    return str(getattr(unit, "symbol", unit) or "")


def _caption(table: Table, name: str, words: str) -> str:
    symbol = _find_symbol(table, name)
    return f"{words}, {symbol}" if symbol else words
