"""Make the picture of mass haul: a road through the hills of the sample raster.

Run ``python docs/gallery/mass_haul.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import tinsmith as ts

HERE = Path(__file__).parent
SAMPLES = HERE.parent.parent / "sample_data"


def main(folder: Path = HERE) -> None:
    """Write mass_haul.png."""
    ground = ts.triangulate(ts.read(SAMPLES / "jacksboro.tif"))
    middle = ground.points[:, :2].mean(axis=0)
    corners = middle + np.array([[-1500, -700], [-400, -300], [200, 500], [1400, 700]])
    road = ts.Alignment.from_points(corners, radii=[300, 250], transitions=[80, 60], crs=ground.crs)
    table = ts.section_volumes(
        ground, _make_bed(ground, road), road, interval=20, width=24, shrink_factor=0.9
    )
    figure = ts.mass_haul_picture(table, title="Mass haul of a road through the sample hills")
    figure.savefig(folder / "mass_haul.png", dpi=100, metadata={"Software": None})


def _make_bed(ground: ts.TIN, road: ts.Alignment) -> ts.TIN:
    """Return a road bed of even grades between some stations, 30 m wide."""
    knots = np.linspace(road.start, road.end, 9)
    heights = ground.interpolate(road.points_at(knots))
    at = np.union1d(road.cut_into_chords(0.05), np.arange(road.start, road.end, 20.0))
    elevations = np.interp(at, knots, heights)
    edges = [
        np.column_stack([road.points_at(at, offset=offset), elevations]) for offset in (-15, 15)
    ]
    ring = np.concatenate([edges[0][:, :2], edges[1][::-1, :2]])
    return ts.triangulate(
        np.concatenate(edges),
        boundary=[ring],
        crs=ground.crs,
        elevation_unit=ground.elevation_unit,
    )


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
