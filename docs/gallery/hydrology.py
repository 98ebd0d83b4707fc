"""Make the pictures of flow paths and depressions: the hills around Jacksboro, on their light.

Run ``python docs/gallery/hydrology.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import LineCollection
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SPACING = 15.0


COLORS = {"descent": "#0b4f8a", "pond": "#d1495b", "flat": "#d1495b"}


def main(folder: Path = FOLDER) -> None:
    """Write hydrology.png and filling.png."""
    tin = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    shade = ts.hillshade(tin, spacing=SPACING)
    waters = ts.depressions(tin, min_depth=0.5)
    figure, axes = plt.subplots(figsize=(8, 6), layout="constrained")
    draw_ground(axes, shade, waters)
    extent = choose_extent(tin)
    draw_paths(axes, ts.flow_path(tin, list_starts(extent)))
    frame(axes, extent, "Jacksboro: flow paths, and depressions deeper than 0.5 m")
    save(draw(figure, 110), folder / "hydrology.png")
    figure, both = plt.subplots(1, 2, figsize=(11, 5.2), layout="constrained")
    extent = choose_extent(tin, 0.3)
    for axes, is_filled in zip(both, (False, True), strict=True):
        draw_ground(axes, shade, waters)
        draw_paths(axes, ts.flow_path(tin, list_starts(extent), fill_depressions=is_filled))
        where = "go on through full depressions" if is_filled else "end in the first pit"
        frame(axes, extent, f"Flow paths {where}")
    save(draw(figure, 100), folder / "filling.png")


def draw_ground(axes: Axes, shade: ts.Raster, waters: ts.Features) -> None:
    """Draw light, and the depressions full of water."""
    box = shade.grid.bounds
    light = np.array(shade.bands["hillshade"][:, :])
    bounds = (box.xmin, box.xmax, box.ymin, box.ymax)
    axes.imshow(light, cmap="gray", extent=bounds, vmin=-60, vmax=255)
    for shape in waters.to_shapely():
        for part in shape.geoms:
            axes.fill(*np.array(part.exterior.coords)[:, :2].T, color="#7fb8e8", alpha=0.85, lw=0)


def draw_paths(axes: Axes, paths: ts.Features) -> None:
    """Draw flow paths, their parts through ponds in another colour."""
    lines = [paths.coordinates[a:b, :2] for a, b in pairwise(paths.offsets[0].tolist())]
    kinds = paths.columns.get("kind", ["descent"] * len(lines))
    colors = [COLORS[kind] for kind in kinds]
    axes.add_collection(LineCollection(lines, colors=colors, linewidths=0.8))


def frame(axes: Axes, extent: tuple[float, float, float, float], title: str) -> None:
    """Leave the extent, without ticks."""
    axes.set(xlim=extent[:2], ylim=extent[2:], aspect="equal", xticks=[], yticks=[])
    axes.set_title(title)


def list_starts(extent: tuple[float, float, float, float]) -> np.ndarray:
    """Return where drops fall, 180 m apart."""
    west, east, south, north = extent
    x, y = np.meshgrid(np.arange(west, east, 180.0), np.arange(south, north, 180.0))
    return np.column_stack([x.ravel(), y.ravel()])


def choose_extent(tin: ts.TIN, share: float = 0.36) -> tuple[float, float, float, float]:
    """Return a part of the surface: west, east, south, north."""
    x, y = tin.bounds.center
    half_width, half_height = share / 2 * tin.bounds.width, share / 2 * tin.bounds.height
    return x - half_width, x + half_width, y - half_height, y + half_height


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
