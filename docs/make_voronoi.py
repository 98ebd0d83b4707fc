"""Make the pictures of voronoi.md, and the figures in its text.

Run ``python docs/make_voronoi.py [FOLDER]``; needs the extra "plot", and scipy for its time.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import shapely
from matplotlib.figure import Figure
from scipy.spatial import Voronoi as SciPyVoronoi

import tinsmith as ts

if TYPE_CHECKING:
    from tinsmith.base.arrays import Float64Array

HERE = Path(__file__).parent
SURVEY = HERE.parent / "sample_data" / "site_survey.csv"
NO_VERSION = {"Software": None}

INK, CELLS, GREY, EDGES, POINT = "#333333", "#7a8794", "#dfe3e6", "#0b5fa5", "#b3472d"
FRAME = ts.Bounds(0.0, 0.0, 10.0, 10.0)


def main(folder: Path = HERE) -> None:
    """Make the pictures and print the figures."""
    draw_dual(folder / "voronoi.png")
    draw_quality(folder / "quality.png")
    tell(1_000_000)


def scattered() -> ts.TIN:
    """Return a TIN of 25 points, one near the middle of each of 5 by 5 squares."""
    x, y = np.meshgrid(np.arange(1.0, 10.0, 2.0), np.arange(1.0, 10.0, 2.0))
    xy = np.column_stack([x.ravel(), y.ravel()])
    xy += np.random.default_rng(97).uniform(-0.7, 0.7, xy.shape)
    return ts.triangulate(np.column_stack([xy, np.zeros(len(xy))]))


def draw_dual(path: Path) -> None:
    """Draw one cell and its neighbours, the diagram, and its dual: the paper's Figure 2."""
    tin = scattered()
    diagram = ts.voronoi(tin, boundary=FRAME)
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    titles = ("(a) The cell of p", "(b) The Voronoi diagram", "(c) Its dual: the triangles")
    panels = (draw_cell, draw_diagram, draw_triangles)
    for axes, title, draw in zip(figure.subplots(1, 3), titles, panels, strict=True):
        draw(axes, tin, diagram)
        axes.set_title(title, color=INK, fontsize=12)
        axes.set_aspect("equal")
        axes.set_anchor("N")
        axes.set_axis_off()
    figure.savefig(path, dpi=150, metadata=NO_VERSION)


def in_the_middle(tin: ts.TIN) -> int:
    """Return the vertex that is called p."""
    return int(np.argmin(np.hypot(*(tin.points[:, :2] - 5.0).T)))


def draw_cell(axes: Any, tin: ts.TIN, diagram: Any) -> None:
    """Draw the cell in the middle, and the edges to the points whose cells it meets."""
    middle = in_the_middle(tin)
    cell = diagram.coords[diagram.offsets[middle] : diagram.offsets[middle + 1]]
    p = tin.points[middle, :2]
    axes.fill(*cell.T, facecolor=GREY, edgecolor=CELLS, linewidth=2)
    ends = [edge[edge != middle][0] for edge in tin.edges if middle in edge]
    for q in tin.points[ends, :2]:
        axes.plot(*np.stack([p, q]).T, color=EDGES, linewidth=1.2, linestyle=(0, (4, 2)))
    axes.plot(*tin.points[ends, :2].T, "o", color=POINT, markersize=6)
    axes.plot(*p, "o", color=POINT, markersize=8)
    above = {"xytext": (0, 9), "textcoords": "offset points", "ha": "center"}
    axes.annotate("p", p, **above, fontsize=13, color=INK)
    for number, corner in enumerate(cell, start=1):
        away = (corner - cell.mean(axis=0)) / np.hypot(*(corner - cell.mean(axis=0)))
        axes.text(*(corner + 0.28 * away), f"V{number}", ha="center", va="center", color=INK)
    around = tin.points[[middle, *ends], :2]
    reach = 0.56 * np.ptp(around, axis=0).max()
    centre = (around.min(axis=0) + around.max(axis=0)) / 2
    axes.set_xlim(centre[0] - reach, centre[0] + reach)
    axes.set_ylim(centre[1] - reach, centre[1] + reach)


def draw_diagram(axes: Any, tin: ts.TIN, diagram: Any) -> None:
    """Draw all cells, the one of p grey, and their points."""
    axes.fill(*shapely.get_coordinates(diagram.to_shapely()[in_the_middle(tin)]).T, color=GREY)
    for cell in diagram.to_shapely():
        axes.plot(*shapely.get_coordinates(cell).T, color=CELLS, linewidth=1.4)
    axes.plot(*tin.points[:, :2].T, "o", color=POINT, markersize=5)


def draw_triangles(axes: Any, tin: ts.TIN, diagram: Any) -> None:
    """Draw the triangles over the cells."""
    for cell in diagram.to_shapely():
        axes.plot(*shapely.get_coordinates(cell).T, color=CELLS, linewidth=0.8, alpha=0.7)
    axes.triplot(*tin.points[:, :2].T, tin.triangles, color=EDGES, linewidth=1.6)
    axes.plot(*tin.points[:, :2].T, "o", color=POINT, markersize=5)


def draw_quality(path: Path) -> None:
    """Draw the histograms of the site survey's triangles."""
    survey = ts.lines_from_codes(ts.read(SURVEY, crs="EPSG:32616"))
    shapes = ts.quality(ts.triangulate(survey))
    figure = ts.histogram(shapes, title="Triangle quality: site survey", unit="m")
    figure.savefig(path, dpi=110, metadata=NO_VERSION)


def tell(count: int) -> None:
    """Print how long the diagram of random points takes, and how its areas add up."""
    random = np.random.default_rng(1).uniform(0, 10_000, (count, 3))
    tin = ts.triangulate(random + np.array([742_000.0, 4_030_000.0, 0.0]))
    begin = time.perf_counter()
    diagram = ts.voronoi(tin)
    ours = time.perf_counter() - begin
    box = shapely.Polygon(diagram.boundary).area
    print(f"{count:,} points: {ours:.1f} s; areas add up to {diagram.areas.sum() / box - 1:+.1e}")
    print(f"SciPy, cells not clipped: {timed(tin.points[:, :2]):.1f} s")


def timed(xy: Float64Array) -> float:
    """Return the seconds that SciPy takes."""
    begin = time.perf_counter()
    SciPyVoronoi(xy)
    return time.perf_counter() - begin


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
