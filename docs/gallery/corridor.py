"""Make the pictures of corridors: a road through the hills of the sample raster, and sharp bends.

Run ``python docs/gallery/corridor.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from pictures import FOLDER, SAMPLES, draw, save

import tinsmith as ts

CORNERS = np.array([[-330, -135], [-60, -60], [120, 160], [420, 160]])
STATION, REACH = 300.0, 45.0


def main(folder: Path = FOLDER) -> None:
    """Write corridor.png and corridor_bends.png."""
    whole = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    middle = whole.points[:, :2].mean(axis=0)
    box = middle + np.array([[-700, -450], [700, -450], [700, 450], [-700, 450]])
    ground = ts.clip(whole, [box])
    road = _lay_out(ground, middle)
    lane, shoulder = ts.Part("lane", 3.75, -0.025), ts.Part("shoulder", 1.5, -0.05)
    ditch = [ts.Part("foreslope", 1.5, -0.4), ts.Part("ditch", 1.0)]
    side = ts.Side([lane, shoulder], ditch=ditch, cut_slope=1.5, fill_slope=1.5)
    made = ts.corridor(ground, road, ts.Template(side))
    found, change = ts.volume(ground, made), ts.difference(ground, made).tin
    figure = Figure(figsize=(9, 7.6), layout="constrained")
    plan, section = figure.subplots(2, 1, height_ratios=(1.5, 1.0))
    largest = float(np.abs(change.points[:, 2]).max())
    drawn = plan.tripcolor(
        *change.points[:, :2].T, change.triangles, change.points[:, 2],
        cmap="RdBu", vmin=-largest, vmax=largest, shading="gouraud",
    )  # fmt: skip
    figure.colorbar(drawn, ax=plan, label="fill (blue) and cut (red), m", shrink=0.7)
    _draw_lines(plan, made)
    (west, south), (east, north) = (
        middle + CORNERS.min(axis=0) - 60, middle + CORNERS.max(axis=0) + 60,
    )  # fmt: skip
    plan.set(xlim=(west, east), ylim=(south, north), aspect="equal", xticks=[], yticks=[])
    plan.set_title(f"Cut {found['cut'][0]:,.0f} m³, fill {found['fill'][0]:,.0f} m³", fontsize=11)
    _draw_section(section, ground, made, road)
    save(draw(figure, 100), folder / "corridor.png")
    save(draw(_draw_bends(), 100), folder / "corridor_bends.png")


def _draw_bends() -> Figure:
    """Draw a road that turns back, and a dam around a pond, on inclined ground."""
    corners = np.array([[0, 0], [120, 0], [120, 90], [0, 90]])
    ground = ts.triangulate(np.column_stack([corners, 20 + 0.04 * corners[:, 0]]))
    lane, shoulder = ts.Part("lane", 4, -0.025), ts.Part("shoulder", 1.5, -0.05)
    road = ts.Template(ts.Side([lane, shoulder], cut_slope=1.5, fill_slope=2))
    bend = [[15, 25, 24.5], [75, 25, 26.5], [95, 45, 27.3], [75, 60, 28], [25, 52, 25.5]]
    crest = ts.Template(ts.Side([ts.Part("crest", 2)], cut_slope=1.5, fill_slope=2))
    pond = [[30, 25, 25.5], [75, 20, 25.5], [95, 45, 25.5], [55, 70, 25.5], [30, 25, 25.5]]
    figure = Figure(figsize=(10, 4.2), layout="constrained")
    jobs = (("A road that turns back", bend, road), ("A dam around a pond", pond, crest))
    for axes, (title, axis, template) in zip(figure.subplots(1, 2), jobs, strict=True):
        made = ts.corridor(ground, axis, template)
        surface = (*made.points[:, :2].T, made.triangles, made.points[:, 2])
        axes.tricontourf(*surface, levels=np.arange(19, 31, 0.5), cmap="terrain")
        axes.tricontour(*surface, levels=np.arange(19, 31, 0.5), colors="#00000055", linewidths=0.5)
        _draw_lines(axes, made)
        axes.set(xlim=(0, 120), ylim=(0, 90), aspect="equal", xticks=[], yticks=[])
        axes.set_title(title, fontsize=11)
    return figure


def _lay_out(ground: ts.TIN, middle: np.ndarray) -> ts.Alignment:
    """Return an axis whose profile follows the hills."""
    axis = ts.Alignment.from_points(
        middle + CORNERS, radii=120, transitions=40, crs=ground.crs,
        elevation_unit=ground.elevation_unit,
    )  # fmt: skip
    knots = np.linspace(axis.start, axis.end, 9)
    heights = ground.interpolate(axis.points_at(knots))
    rows = [
        ts.VerticalPoint(float(s), float(z), *(("parabola", 45, 45) if 0 < k < 8 else ()))
        for k, (s, z) in enumerate(zip(knots, heights, strict=True))
    ]
    return replace(axis, verticals=(ts.VerticalAlignment(rows),))


def _draw_lines(axes: object, made: ts.TIN) -> None:
    styles = {"axis": ("#c40000", 1.0), "hinge": ("#000000", 1.0), "daylight": ("#1a7f37", 1.2)}
    for chain, name in zip(made.lines.chains(), made.lines.names, strict=True):
        if name in styles:
            color, width = styles[name]
            axes.plot(*made.points[chain, :2].T, color=color, linewidth=width)


def _draw_section(axes: object, ground: ts.TIN, made: ts.TIN, road: ts.Alignment) -> None:
    offsets = np.linspace(-REACH, REACH, 1801)
    places = np.concatenate([road.points_at([STATION], offset=one) for one in offsets])
    axes.plot(offsets, ground.interpolate(places), color="#888888", label="ground")
    axes.plot(offsets, made.interpolate(places), color="#7a5230", label="corridor")
    axes.set(xlabel="offset, m", ylabel="elevation, m", xlim=(-REACH, REACH), aspect=1.0)
    axes.set_title(f"Section at station {STATION:.0f}", fontsize=11)
    axes.legend(frameon=False)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
