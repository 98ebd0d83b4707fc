"""Make the picture of clip.md.

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


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
