"""The plot: time per point of every tool on every data set."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from ..measure import OURS, Result
from ..peers.line_tools import CGAL_INDICES
from ..peers.triangulators import (
    ALL_CORES,
    CDT,
    CGAL,
    DELAUNAY32,
    DELAUNAY32_ALL_CORES,
    DETRIA,
    KERNEL,
    KERNEL_ALL_CORES,
)
from ..sections import kernel, lines

__all__ = ["TITLES", "draw"]

PALE = 0.3
TICKS = (1.0, 2.0, 5.0)
"""Leads of the numbers below the axis."""

_HOLLOW = {"facecolors": "none"}
STYLES: dict[str, dict[str, Any]] = {
    OURS: {"color": "#0b5fa5", "marker": "o", "s": 75, "zorder": 5},
    KERNEL: {"color": "#0b5fa5", "marker": "o", "s": 40, "zorder": 5, **_HOLLOW},
    ALL_CORES: {"color": "#2aa198", "marker": "o", "s": 75, "zorder": 5},
    KERNEL_ALL_CORES: {"color": "#2aa198", "marker": "o", "s": 40, "zorder": 5, **_HOLLOW},
    CGAL: {"color": "#d1495b", "marker": "D", "s": 42, "zorder": 4},
    CGAL_INDICES: {"color": "#d1495b", "marker": "D", "s": 30, "zorder": 4, **_HOLLOW},
    DELAUNAY32: {"color": "#7b3f9e", "marker": "D", "s": 42, "zorder": 4},
    DELAUNAY32_ALL_CORES: {"color": "#7b3f9e", "marker": "D", "s": 30, "zorder": 4, **_HOLLOW},
    CDT: {"color": "#3d7a3d", "marker": "X", "s": 46, "zorder": 3},
    DETRIA: {"color": "#8a5a33", "marker": "p", "s": 50, "zorder": 3},
    "Triangle": {"color": "#e08e1b", "marker": "^", "s": 46, "zorder": 3},
    "GEOS": {"color": "#66a182", "marker": "s", "s": 36, "zorder": 3},
    "SciPy": {"color": "#8d6a9f", "marker": "v", "s": 46, "zorder": 3},
    "startinpy": {"color": "#7a7a7a", "marker": "P", "s": 46, "zorder": 3},
}


TITLES = {
    kernel.SECTION: "Delaunay triangulation at UTM coordinates, one core where not said",
    lines.SECTION: "Triangulation with breaklines at UTM coordinates, one core where not said",
}
"""Sections that have a plot, and its title."""


def draw(results: list[Result], path: Path) -> Path:
    """Draw a section's results: a row a data set, microseconds per point to the right."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    shown = [r for r in results if r.tool != kernel.WORK and not math.isnan(r.seconds)]
    labels = list(dict.fromkeys(_name_size(result) for result in shown))
    figure, axes = plt.subplots(figsize=(9.0, 1.6 + 0.36 * len(labels)), layout="constrained")
    for tool, style in STYLES.items():
        # The legend's marker is drawn apart: all answers of a tool may be pale.
        axes.scatter(
            [], [], label=tool if _select_tool(shown, tool) else None, linewidths=1.4, **style
        )
        for is_right, strength in ((True, 1.0), (False, PALE)):
            mine = [r for r in _select_tool(shown, tool) if r.extra["is_right"] == is_right]
            times = [result.seconds / result.count * 1e6 for result in mine]
            rows = [labels.index(_name_size(result)) for result in mine]
            axes.scatter(times, rows, alpha=strength, linewidths=1.4, **style)
    _finish_axes(axes, labels, TITLES[results[0].section])
    figure.savefig(path, dpi=150, metadata={"Software": None})
    plt.close(figure)
    return path


def _select_tool(results: list[Result], tool: str) -> list[Result]:
    return [result for result in results if result.tool == tool]


def _name_size(result: Result) -> str:
    return f"{result.task}, {result.count:,}"


def _finish_axes(axes: Any, labels: list[str], title: str) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter

    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(10, subs=TICKS))
    axes.xaxis.set_minor_locator(LogLocator(10, subs=range(1, 10)))
    axes.set_yticks(range(len(labels)), labels)
    axes.invert_yaxis()
    axes.set_xlabel("microseconds per point (less is better); pale: wrong or incomplete answer")
    axes.set_title(title, loc="left")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(axis="x", which="both", color="#e6e6e6", linewidth=0.7)
    axes.grid(axis="y", color="#f0f0f0", linewidth=0.7)
    axes.set_axisbelow(True)
    axes.spines[["top", "right", "left"]].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.4, -0.04 - 0.6 / len(labels)),
        ncols=5,
        frameon=False,
        handletextpad=0.2,
        columnspacing=1.2,
    )
