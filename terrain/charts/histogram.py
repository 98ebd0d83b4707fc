"""Histogram: how the shapes of a TIN's triangles are spread, as a picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.checks import require_type
from ...base.sentences import counted
from ...tin import Quality
from ..drawing import choose_ticks, palette, parse_text, parse_title
from .figures import INK, start_panels

if TYPE_CHECKING:
    from ...base.arrays import BoolArray, Float64Array

_PURPOSE = "A histogram"
_SIZE = (11.0, 7.0)
"""Of the picture, inches."""

_BARS = 60
_TAIL = 0.002
"""Share of values at each end that may lie outside a panel without ends of its own."""

_LEAST_SPAN = 1.5
"""Highest over lowest value of a logarithmic axis, at least."""


@dataclass(frozen=True, slots=True, eq=False)
class _Panel:
    """One measure: its values, what it is called, the unit behind numbers, and its axis."""

    title: str
    values: Float64Array
    unit: str
    edges: Float64Array
    note: str
    is_log: bool = False


def histogram(quality: Quality, *, title: str | None = None, unit: str = "") -> Any:
    """Draw histograms of smallest and largest angle, aspect ratio and edge length.

    Parameters
    ----------
    quality : Quality
        Of :func:`tinsmith.quality`.
    title : str, optional
        Default "Triangle quality".
    unit : str, optional
        Symbol of the unit of lengths, for example "m".

    Returns
    -------
    matplotlib.figure.Figure
        Drawn without a screen; ``savefig`` writes it. Four panels, each with its median.

    Raises
    ------
    OptionError
        If the quality is none, or the title or unit is no text.
    MissingExtraError
        If matplotlib is not installed.

    Notes
    -----
    Bars are shares of all triangles. Aspect ratios and lengths stand on logarithmic axes, which
    leave out at most 0.2 percent of the values at either end, as the panel then says. An edge
    between two triangles counts for both.

    Examples
    --------
    >>> from tinsmith import TIN
    >>> from tinsmith.tin import quality
    >>> tin = TIN.from_triangles([[0, 0, 0], [4, 0, 0], [0, 3, 0]], [[0, 1, 2]])
    >>> len(histogram(quality(tin), unit="m").axes)
    4
    """
    require_type("quality", quality, Quality)
    heading, symbol = parse_title(title, "Triangle quality"), parse_text("unit", unit)
    figure = start_panels(_PURPOSE, *_SIZE, title=heading)
    where = "in space" if quality.space else "in the plane"
    figure.supxlabel(
        f"{counted(len(quality), 'triangle')}, measured {where}", fontsize=10, color=INK
    )
    grid = figure.subplots(2, 2)
    for axes, panel in zip(grid.ravel(), _choose_panels(quality, symbol), strict=True):
        _draw_panel(axes, panel)
    return figure


def _choose_panels(quality: Quality, unit: str) -> list[_Panel]:
    small, large = quality.min_angle, quality.max_angle
    lengths = quality.edge_lengths.ravel()
    return [
        _make_angle_panel(
            "Smallest angle", small, (0, 60), _describe_share(small < 20, "below 20°")
        ),
        _make_angle_panel(
            "Largest angle", large, (60, 180), _describe_share(large > 120, "above 120°")
        ),
        _make_log_panel("Aspect ratio", quality.aspect_ratio, "", low=1.0),
        _make_log_panel("Edge length", lengths, f" {unit}" if unit else ""),
    ]


def _make_angle_panel(
    title: str, values: Float64Array, span: tuple[float, float], note: str
) -> _Panel:
    edges = np.linspace(*span, _BARS + 1)
    return _Panel(title, np.clip(values, *span), "°", edges, note)


def _make_log_panel(
    title: str, values: Float64Array, unit: str, *, low: float | None = None
) -> _Panel:
    """Return a panel whose bars are equally wide on a logarithmic axis."""
    finite = values[np.isfinite(values)]
    tails = (
        np.quantile(finite, [_TAIL, 1 - _TAIL], method="inverted_cdf") if len(finite) else [1, 1]
    )
    first = float(tails[0]) if low is None else low
    last = max(float(tails[1]), _LEAST_SPAN * first)
    values = values if low is None else np.maximum(values, low)
    edges = np.geomspace(first, last, _BARS + 1)
    # Logarithm and power round: the ends must hold the values that they are.
    edges[0], edges[-1] = first, last
    outside = np.mean((values < edges[0]) | (values > edges[-1]))
    note = f"{100 * outside:.2f} % off the axis" if outside else ""
    return _Panel(title, values, unit, edges, note, is_log=True)


def _describe_share(chosen: BoolArray, what: str) -> str:
    return f"{100 * np.mean(chosen):.1f} % {what}"


# ---------------------------------------------------------------- drawing


def _draw_panel(axes: Any, panel: _Panel) -> None:
    counts, edges = np.histogram(panel.values, panel.edges)
    axes.stairs(100 * counts / len(panel.values), edges, fill=True, color=palette.BARS)
    axes.set_title(panel.title, loc="left", fontsize=12, color=INK)
    low, high = _format_number(panel.values.min()), _format_number(panel.values.max())
    spread = f"{low} to {high}{panel.unit}" + (f", {panel.note}" if panel.note else "")
    axes.set_title(spread, loc="right", fontsize=9, color=INK)
    _label_axes(axes, panel)
    _mark_median(axes, panel)


def _mark_median(axes: Any, panel: _Panel) -> None:
    middle = float(np.quantile(panel.values, 0.5, method="inverted_cdf"))
    if not np.isfinite(middle):
        return
    axes.axvline(middle, color=palette.MEDIAN, linewidth=1.5)
    is_left = np.searchsorted(panel.edges, middle) < len(panel.edges) / 2
    axes.annotate(
        f"median {_format_number(middle)}{panel.unit}",
        (middle, 1.0),
        xycoords=("data", "axes fraction"),
        xytext=(5 if is_left else -5, -10),
        textcoords="offset points",
        ha="left" if is_left else "right",
        color=palette.MEDIAN,
        fontsize=9,
    )


def _label_axes(axes: Any, panel: _Panel) -> None:
    low, high = panel.edges[0], panel.edges[-1]
    places = choose_ticks(low, high, count=6)
    if panel.is_log:
        axes.set_xscale("log")
        places = _choose_log_ticks(low, high) or places
        axes.minorticks_off()
    axes.set_xticks(places, [f"{place:g}{panel.unit}" for place in places])
    axes.set_xlim(low, high)
    axes.set_ylim(0, 1.14 * (axes.dataLim.ymax or 1.0))
    axes.set_ylabel("share, %", color=INK)
    axes.grid(axis="y", color=palette.GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=INK)
    axes.spines[["top", "right"]].set_visible(False)


def _format_number(value: float) -> str:
    return f"{value:,.0f}" if 1000 <= value < 1e9 else f"{value:.3g}"


def _choose_log_ticks(low: float, high: float) -> list[float]:
    """Return 1, 2, 5 times powers of ten within [low, high], or powers alone; none if too few."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    leads = (1, 2, 5) if len(powers) <= 4 else (1,)
    step = 1 + len(powers) // 10
    places = [float(lead * 10.0**power) for power in powers[::step] for lead in leads]
    within = [place for place in places if low <= place <= high]
    return within if len(within) >= 3 else []
