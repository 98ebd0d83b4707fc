"""Make the pictures of clip.md.

Run ``python docs/make_clip.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import tinsmith as ts

HERE = Path(__file__).parent
SURVEY = HERE.parent / "sample_data" / "site_survey.csv"
NO_VERSION = {"Software": None}

INK, EDGES, BORDER, OTHER, FAINT = "#333333", "#8a97a3", "#0b5fa5", "#f3c9b8", "#e4e8eb"
PARCEL = [[752738.0, 4024262], [752786, 4024270], [752779, 4024305], [752762, 4024288]]
MARGIN = 6.0
"""Around the parcel, metres."""


def main(folder: Path = HERE) -> None:
    """Draw the clipped surface beside the one that a boundary makes."""
    survey = ts.lines_from_codes(ts.read(SURVEY, crs="EPSG:32616"))
    site = ts.triangulate(survey)
    parts = {
        "ts.clip: the surface stays as it is": ts.clip(site, [PARCEL]),
        "boundary= of a build: triangulated anew": ts.triangulate(survey, boundary=[PARCEL]),
    }
    figure = Figure(figsize=(12.0, 6.4), layout="constrained")
    figure.get_layout_engine().set(h_pad=0.12)
    for axes, (title, part) in zip(figure.subplots(1, 2), parts.items(), strict=True):
        draw(axes, site, part)
        axes.set_title(f"{title}, {len(part.triangles)} triangles", color=INK, fontsize=12)
    figure.legend(
        handles=[
            Line2D([], [], color=BORDER, linewidth=1.8, label="the polygon"),
            Line2D([], [], color=EDGES, linewidth=0.9, label="edges of triangles"),
            Patch(color=OTHER, label="triangles off the surface by more than a millimetre"),
        ],
        loc="outside lower center",
        ncols=3,
        frameon=False,
        labelcolor=INK,
        fontsize=11,
    )
    figure.savefig(folder / "clip.png", dpi=110, metadata=NO_VERSION)
    draw_seam(folder / "merge.png")


def draw(axes: Any, site: ts.TIN, part: ts.TIN) -> None:
    """Draw a part on the surface, and which of its triangles lie elsewhere."""
    corners = part.points[part.triangles]
    gaps = np.abs(site.interpolate(corners.mean(axis=1)[:, :2]) - corners.mean(axis=1)[:, 2])
    axes.add_collection(LineCollection(site.points[site.edges, :2], colors=FAINT, linewidths=0.8))
    axes.add_collection(PolyCollection(corners[gaps > 0.001][:, :, :2], facecolors=OTHER))
    edges = part.points[part.edges, :2]
    axes.add_collection(LineCollection(edges, colors=EDGES, linewidths=0.7))
    for ring in part.boundary:
        axes.plot(*part.points[np.append(ring, ring[0]), :2].T, color=BORDER, linewidth=1.8)
    low, high = np.min(PARCEL, axis=0) - MARGIN, np.max(PARCEL, axis=0) + MARGIN
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xticks=[], yticks=[])
    for spine in axes.spines.values():
        spine.set_color(EDGES)


def draw_seam(path: Path) -> None:
    """Draw two sheets across their seam: joined, and blended in a strip."""
    upper, lower = (make_sheet(*sheet) for sheet in ((0.0, 60.0, 0.5, 1), (40.0, 60.0, 0.0, 2)))
    along = np.linspace(30.0, 80.0, 2001)
    xy = np.column_stack([along, np.full_like(along, 20.0)])
    figure = Figure(figsize=(12.0, 4.2), layout="constrained")
    panels = ((0.0, "joined"), (12.0, "blended over 12 m"))
    for axes, (width, title) in zip(figure.subplots(1, 2, sharey=True), panels, strict=True):
        merged = ts.merge([upper, lower], blend=width)
        axes.axvspan(60.0 - width, 60.0, color=OTHER, alpha=0.6, linewidth=0)
        axes.axvline(60.0, color=EDGES, linewidth=0.8)
        for tin, style, label in (
            (upper, {"color": EDGES, "linestyle": "--"}, "upper surface"),
            (lower, {"color": EDGES, "linestyle": ":"}, "lower surface"),
            (merged, {"color": BORDER, "linewidth": 2.0}, "merged"),
        ):
            axes.plot(along, tin.interpolate(xy), label=label, **style)
        axes.set_title(title, color=INK, fontsize=12)
        axes.set_xlabel("easting, m", color=INK)
        axes.tick_params(colors=INK)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
    figure.axes[0].set_ylabel("elevation, m", color=INK)
    figure.axes[0].legend(frameon=False, labelcolor=INK)
    figure.savefig(path, dpi=110, metadata=NO_VERSION)


def make_sheet(west: float, width: float, z: float, seed: int) -> ts.TIN:
    """Return ground of some width, 40 m north to south, raised by ``z``."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.arange(0.0, width + 1, 4.0), np.arange(0.0, 41.0, 4.0))
    inner = (x > 0) & (x < width) & (y > 0) & (y < 40)
    x, y = (axis + rng.uniform(-1.5, 1.5, x.shape) * inner for axis in (x, y))
    heights = 100 + z + 1.2 * np.sin((x + west) / 9) + 0.5 * np.cos(y / 5)
    return ts.triangulate(np.column_stack([(x + west).ravel(), y.ravel(), heights.ravel()]))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
