"""Make the picture of meshing.md, and the figures in its text.

Run ``python docs/make_meshing.py [FOLDER]``; needs the extra "plot", and triangle for comparison.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import triangle
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import tinsmith as ts
from tinsmith.tin import quality, refine

if TYPE_CHECKING:
    from tinsmith.base.arrays import AnyArray

HERE = Path(__file__).parent
SURVEY = HERE.parent / "sample_data" / "site_survey.csv"
NO_VERSION = {"Software": None}
RUNS = 3
"""Of both programs in turn; the fastest of each counts."""

INK, EDGES, LINES, BAD = "#333333", "#8a97a3", "#0b5fa5", "#f3c9b8"
LEAST_ANGLE, LARGEST_AREA = 28.0, 12.0
FRAME = (70.0, 150.0, 50.0, 120.0)
"""West, east, south and north of the part in the picture, metres from the site's corner."""


def main(folder: Path = HERE) -> None:
    """Make the picture and print the figures."""
    site = surveyed()
    draw(site, folder / "meshing.png")
    print("| surface | least angle | tinsmith | Triangle | ratio | time of Triangle / tinsmith |")
    print("|---|---|---|---|---|---|")
    for name, tin in (("site survey with its lines", site), *others()):
        for angle in (20.0, 25.0, 30.0):
            print(row(name, tin, angle))


def surveyed() -> ts.TIN:
    """Return the TIN of the sample survey with the lines of its codes."""
    return ts.triangulate(ts.lines_from_codes(ts.read(SURVEY, crs="EPSG:32616")))


def others() -> list[tuple[str, ts.TIN]]:
    """Return surfaces of other kinds."""
    rng = np.random.default_rng(7)
    points = rng.random((20_000, 3)) * [1000.0, 1000.0, 20.0]
    ring = [[0, 0], [900, 0], [900, 300], [300, 300], [300, 900], [0, 900]]
    hole = [[100, 100], [200, 100], [200, 200], [100, 200]]
    return [
        ("20,000 random points", ts.triangulate(points)),
        ("the same in an L with a hole", ts.triangulate(points, boundary=[ring], holes=[hole])),
        ("200,000 random points", ts.triangulate(rng.random((200_000, 3)) * [3000, 3000, 20])),
    ]


# ----------------------------------------------------------------------- picture


def draw(site: ts.TIN, path: Path) -> None:
    """Draw a part of the site before and after, triangles with small angles filled."""
    refined = refine(site, min_angle=LEAST_ANGLE, max_area=LARGEST_AREA)
    figure = Figure(figsize=(12.0, 6.0), layout="constrained")
    titles = (
        f"As surveyed: {len(site.triangles):,} triangles, "
        f"smallest angle {quality(site).min_angle.min():.1f}°",
        f"Refined: {len(refined.triangles):,} triangles, "
        f"smallest angle {quality(refined).min_angle.min():.1f}°",
    )
    for axes, tin, title in zip(figure.subplots(1, 2), (site, refined), titles, strict=True):
        draw_mesh(axes, tin, site.bounds)
        axes.set_title(title, color=INK, fontsize=12)
    figure.legend(
        handles=[
            Line2D([], [], color=LINES, linewidth=1.8, label="breaklines"),
            Line2D([], [], color=EDGES, linewidth=0.9, label="edges of triangles"),
            Patch(color=BAD, label=f"triangles with an angle below {LEAST_ANGLE:g}°"),
        ],
        loc="outside lower center",
        ncols=3,
        frameon=False,
        labelcolor=INK,
        fontsize=11,
    )
    figure.savefig(path, dpi=150, metadata=NO_VERSION)


def draw_mesh(axes: Any, tin: ts.TIN, corner: ts.Bounds) -> None:
    """Draw triangles and lines."""
    xy = tin.points[:, :2] - [corner.xmin, corner.ymin]
    is_bad = quality(tin).min_angle < LEAST_ANGLE - 1e-9
    axes.add_collection(PolyCollection(xy[tin.triangles[is_bad]], facecolors=BAD))
    axes.add_collection(LineCollection(xy[tin.edges], colors=EDGES, linewidths=0.5))
    axes.add_collection(LineCollection(xy[tin.lines.segments()], colors=LINES, linewidths=1.4))
    axes.set(xlim=FRAME[:2], ylim=FRAME[2:], aspect="equal", xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_color(EDGES)


# ----------------------------------------------------------------------- figures


def row(name: str, tin: ts.TIN, angle: float) -> str:
    """Return a line of the table: triangles and smallest angle of both, and their times."""
    graph = as_graph(tin)
    own = theirs = np.inf
    for _ in range(RUNS):
        begin = time.perf_counter()
        refined = refine(tin, min_angle=angle, threads=1)
        own = min(own, time.perf_counter() - begin)
        begin = time.perf_counter()
        made = triangle.triangulate(graph, f"pq{angle:g}Q")
        theirs = min(theirs, time.perf_counter() - begin)
    other = ts.TIN.from_triangles(
        np.column_stack([made["vertices"], np.zeros(len(made["vertices"]))]), made["triangles"]
    )
    return (
        f"| {name} | {angle:g}° "
        f"| {len(refined.triangles):,}, {quality(refined).min_angle.min():.2f}° "
        f"| {len(other.triangles):,}, {quality(other).min_angle.min():.2f}° "
        f"| {len(refined.triangles) / len(other.triangles):.3f} | {theirs / own:.2f} |"
    )


def as_graph(tin: ts.TIN) -> dict[str, AnyArray]:
    """Return what Triangle takes: vertices, segments and a place in each hole."""
    t, k = np.nonzero(tin.constrained | (tin.neighbors < 0))
    ends = [tin.triangles[t, (k + 1) % 3], tin.triangles[t, (k + 2) % 3]]
    origin = tin.points[0, :2]
    graph = {"vertices": tin.points[:, :2] - origin, "segments": np.column_stack(ends)}
    if len(tin.rings) > 1:
        graph["holes"] = np.array([tin.points[r, :2].mean(axis=0) - origin for r in tin.rings[1:]])
    return graph


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
