"""Make the picture of the ground filter: all points, the ground among them, and a strip of both.

Run ``python docs/gallery/ground.py [FOLDER]``; needs the extra "plot".
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from pictures import FOLDER, draw, save

import tinsmith as ts

SIDE = 240.0
STRIP = 170.0, 176.0
COLORS = {"ground": "#8c6d46", "others": "#4c9a52", "low noise": "#d62728"}


def make_points(seed=4):
    """Return a cloud of hills with houses, trees and low noise, one point a square metre."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(0, SIDE, (2, int(SIDE**2)))
    z = 210 + 14 * np.sin(x / 50) * np.cos(y / 65) + 0.06 * x + rng.normal(0, 0.03, len(x))
    bare = z.copy()
    for east, north, half in [(50, 60, 9), (120, 118, 10), (185, 70, 7), (70, 180, 12)]:
        inside = (abs(x - east) < half) & (abs(y - north) < 0.7 * half)
        z[inside] = z[inside].max() + 5 - 0.4 * abs(y[inside] - north)
    wood = (np.sin(x / 31) * np.sin(y / 37) > 0.3) & (rng.uniform(size=len(x)) < 0.4)
    z[wood] += rng.uniform(2, 16, int(wood.sum()))
    low = rng.choice(len(x), 60, replace=False)
    z[low] = bare[low] - rng.uniform(4, 12, len(low))
    return np.column_stack([x, y, z]).round(2)


def draw_light(axes, tin, title):
    """Draw a surface in the light from the north-west."""
    light = ts.hillshade(tin, spacing=1.0)
    (shades,) = light.bands.values()
    axes.imshow(shades, extent=(0, SIDE, 0, SIDE), cmap="gray", vmin=0, vmax=255)
    axes.set(title=title, xlabel="easting (m)", ylabel="northing (m)")


def draw_strip(axes, found):
    """Draw the points of a strip from the side, by their classes."""
    x, y, z = found.given.points.T
    is_near = (y > STRIP[0]) & (y < STRIP[1])
    for name, number in {"ground": 2, "others": 1, "low noise": 7}.items():
        own = is_near & (found.classification == number)
        size = 12 if name == "low noise" else 3
        axes.scatter(x[own], z[own], s=size, c=COLORS[name], lw=0, label=name)
    axes.set(xlim=(0, SIDE), xlabel="easting (m)", ylabel="elevation (m)")
    axes.set_title(f"Points of a strip, northing {STRIP[0]:g} to {STRIP[1]:g} m")
    axes.legend(loc="upper left", markerscale=2.5, ncols=3)


def main(folder: Path = FOLDER) -> None:
    """Write ground.png."""
    survey = ts.Survey(points=make_points(), crs="EPSG:32616+5703")
    found = ts.ground(survey)
    figure = plt.figure(figsize=(10, 8.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=[1.7, 1])
    draw_light(figure.add_subplot(grid[0, 0]), ts.triangulate(survey), "All points")
    draw_light(figure.add_subplot(grid[0, 1]), found.tin, "The ground")
    draw_strip(figure.add_subplot(grid[1, :]), found)
    save(draw(figure, 90), folder / "ground.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
