"""Make the pictures of rivers: a winding bed between its sections, and a stream that is flattened.

Run ``python docs/gallery/river.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from matplotlib.figure import Figure
from pictures import FOLDER, draw, save

import tinsmith as ts

WIDTH = 15.0
INK, WATER, OTHER = "#333333", "#0b5fa5", "#c0593a"


def main(folder: Path = FOLDER) -> None:
    """Write riverbed.png and hydroflatten.png."""
    save(draw(draw_beds(), 100), folder / "riverbed.png")
    save(draw(draw_water(), 100), folder / "hydroflatten.png")


def find_places(stations: Any, offsets: Any) -> Any:
    """Return places beside a winding line, at lengths along it."""
    x = np.linspace(0.0, 500.0, 5001)
    line = np.column_stack([x, 45.0 * np.sin(x / 60.0)])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    way = np.gradient(line, along, axis=0)
    way /= np.hypot(*way.T)[:, None]
    normal = np.column_stack([-way[:, 1], way[:, 0]])
    at = [np.interp(stations, along, one) for one in (*line.T, *normal.T)]
    return np.stack([at[0] + offsets * at[2], at[1] + offsets * at[3]], axis=-1)


def measure_bed(stations: Any, offsets: Any) -> Any:
    """Return elevations of a bed whose deepest line goes from bank to bank."""
    share = offsets / WIDTH
    return 100 - 0.002 * stations + 3 * share**2 - np.sin(stations / 60.0) * share


def draw_beds() -> Figure:
    """Draw the bed between sections, beside the TIN of the same points."""
    offsets = np.linspace(WIDTH, -WIDTH, 13)
    sections = [
        np.column_stack([find_places(s, offsets), measure_bed(s, offsets)])
        for s in np.arange(20.0, 480.0, 50.0)
    ]
    line = find_places(np.linspace(0.0, 500.0, 250), 0.0)
    bed = ts.riverbed(sections, line, spacing=4.0)
    plain = ts.clip(ts.triangulate(np.concatenate(sections)), list_rings(bed))
    s, n = np.random.default_rng(1).uniform([25, -14], [415, 14], (4000, 2)).T
    figure = Figure(figsize=(9, 5.6), layout="constrained")
    titles = {"TIN of the points": plain, "riverbed": bed}
    for axes, (title, tin) in zip(figure.subplots(2, 1), titles.items(), strict=True):
        apart = tin.interpolate(find_places(s, n)) - measure_bed(s, n)
        off = float(np.sqrt(np.nanmean(apart**2)))
        axes.tricontourf(
            *tin.points[:, :2].T, tin.triangles, tin.points[:, 2],
            levels=np.arange(98.0, 104.6, 0.25), cmap="YlGnBu_r",
        )  # fmt: skip
        for section in sections:
            axes.plot(*section[:, :2].T, color=INK, linewidth=0.9, marker=".", markersize=3)
        axes.set(aspect="equal", xticks=[], yticks=[], xlim=(5, 400), ylim=(-68, 68))
        axes.set_title(f"{title}: {100 * off:.0f} cm from the true bed (RMS)", fontsize=11)
        axes.set_frame_on(False)
    return figure


def list_rings(tin: ts.TIN) -> list[Any]:
    """Return the rings around a surface."""
    return [tin.points[ring, :2] for ring in tin.boundary]


def draw_water() -> Figure:
    """Draw a stream before and after, and its levels along the centreline."""
    rng = np.random.default_rng(2)
    line = find_places(np.linspace(0.0, 500.0, 120), 0.0)
    xy = rng.uniform([0, -80], [420, 80], (12000, 2))
    axis = shapely.linestrings(line)
    along = shapely.line_locate_point(axis, shapely.points(xy))
    apart = shapely.distance(axis, shapely.points(xy))
    z = 100 - 0.004 * along + 0.25 * np.maximum(apart - 11, 0) + rng.normal(0, 0.12, len(xy))
    ground = ts.triangulate(np.column_stack([xy, z]))
    at = np.linspace(15.0, 470.0, 90)
    stream = np.vstack([find_places(at, 13.0), find_places(at[::-1], -13.0)])
    made = ts.hydroflatten(ground, stream, line, spacing=8.0)
    isotonic = ts.hydroflatten(ground, stream, line, spacing=8.0, fit="isotonic")
    figure = Figure(figsize=(9, 7.4), layout="constrained")
    grid = figure.subplot_mosaic([["before"], ["after"], ["levels"]])
    for name, tin in (("before", ground), ("after", made)):
        axes = grid[name]
        levels = np.arange(98.0, 102.0, 0.25)
        axes.tricontour(
            *tin.points[:, :2].T, tin.triangles, tin.points[:, 2],
            levels=levels, colors="#8a6d4f", linewidths=0.6,
        )  # fmt: skip
        axes.plot(*np.vstack([stream, stream[:1]]).T, color=WATER, linewidth=1.2)
        axes.set(aspect="equal", xticks=[], yticks=[], xlim=(10, 400), ylim=(-68, 68))
        axes.set_title(f"Contours of 0.25 m, {name}", fontsize=11)
    places = find_places(np.linspace(16.0, 469.0, 1500), 0.0)
    stations = shapely.line_locate_point(axis, shapely.points(places))
    for tin, color, label in (
        (ground, "#b9bec3", "ground"),
        (isotonic, OTHER, "isotonic"),
        (made, WATER, "lowest"),
    ):
        grid["levels"].plot(stations, tin.interpolate(places), color=color, label=label)
    grid["levels"].set(xlabel="station, m", ylabel="elevation, m")
    grid["levels"].legend(frameon=False)
    return figure


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
