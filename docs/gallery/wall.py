"""Make the picture of a retaining wall: its contours, and a section.

Run ``python docs/gallery/wall.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from pictures import FOLDER, draw, save

import tinsmith as ts

PATH = np.array([[12, 30], [25, 30], [38, 24], [50, 24]])
RISE = np.array([0.0, 2.5, 2.5, 0.0])
DISTANCE = 0.05


def main(folder: Path = FOLDER) -> None:
    """Write wall.png."""
    xy = np.random.default_rng(8).uniform([0, 0], [62, 50], (500, 2))
    xy = np.vstack([xy, [[0, 0], [62, 0], [62, 50], [0, 50]]])
    away = xy[:, 1] - np.interp(xy[:, 0], *PATH.T)
    along = np.interp(xy[:, 0], PATH[:, 0], RISE) * np.exp(-np.abs(away) / 12.0)
    ground = 20.0 + 0.05 * xy[:, 1] + 0.02 * xy[:, 0]
    z = ground + np.where(away > 0.0, 0.5, -0.5) * along
    level = 20.0 + 0.05 * PATH[:, 1] + 0.02 * PATH[:, 0]
    lines = [
        ts.Breakline(np.column_stack([PATH, level + 0.5 * RISE]), name="top"),
        ts.Breakline(np.column_stack([PATH, level - 0.5 * RISE]), name="foot"),
    ]
    kept = np.abs(away) > 0.5
    tin = ts.triangulate(np.column_stack([xy, z])[kept], breaklines=lines, walls=DISTANCE)
    figure = Figure(figsize=(9, 4.2), layout="constrained")
    plan, section = figure.subplots(1, 2, width_ratios=(1.4, 1.0))
    surface = (*tin.points[:, :2].T, tin.triangles, tin.points[:, 2])
    plan.tricontourf(*surface, levels=np.arange(19, 26, 0.25), cmap="terrain")
    plan.tricontour(*surface, levels=np.arange(19, 26, 0.25), colors="#00000088", linewidths=0.6)
    plan.plot(*PATH.T, color="#c40000", linewidth=2, label="wall")
    plan.plot([31, 31], [5, 45], color="#000000", linestyle="--", linewidth=1, label="section")
    plan.set(xlim=(0, 62), ylim=(0, 50), aspect="equal", xticks=[], yticks=[])
    plan.legend(frameon=False, loc="lower right")
    table = ts.profile(tin, [[31, 5], [31, 45]])
    section.plot(table["station"], table["elevation"], color="#7a5230")
    section.set(xlabel="distance, m", ylabel="elevation, m")
    section.set_title(f"Face {DISTANCE:g} m wide", fontsize=11)
    save(draw(figure, 100), folder / "wall.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
