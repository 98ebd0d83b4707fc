"""Make the pictures of breaklines.md, and the figures in its text.

Run ``python docs/make_breaklines.py [FOLDER]``; needs the extra "view".
"""

from __future__ import annotations

import runpy
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import tinsmith as ts

if TYPE_CHECKING:
    from tinsmith.base.arrays import AnyArray, Float64Array

HERE = Path(__file__).parent
SAMPLES = HERE.parent / "sample_data"
SITE = runpy.run_path(str(SAMPLES / "make_site_survey.py"))
"""The ground as it is: the script that invents it tells its height anywhere."""

PART = np.array([[60.0, 62.0], [122.0, 62.0], [122.0, 98.0], [60.0, 98.0]])
"""Part of the site in the pictures, metres from its south-west corner."""

EXAGGERATION = 3.0

EVERY = 4
"""Of the shots on lines, which are 5 m apart, only every so many are used: 20 m apart."""


def main(folder: Path = HERE) -> None:
    """Make the pictures and print the figures."""
    lined = thinned(ts.lines_from_codes(ts.read(SAMPLES / "site_survey.csv", crs="EPSG:32616")))
    sources = {"without": replace(lined, breaklines=()), "with": lined}
    parts = {name: take_part(source) for name, source in sources.items()}
    tints = find_range(list(parts.values()))
    for name, source in sources.items():
        ts.preview(
            parts[name],
            output=folder / f"breaklines-{name}.png",
            title=f"Ditch and road, {name} breaklines",
            edges=True,
            exaggeration=EXAGGERATION,
            size=(1200, 900),
            elevations=tints,
        )
        tell(name, ts.triangulate(source))


def thinned(survey: ts.Survey) -> ts.Survey:
    """Return a survey with fewer shots on its open lines; the points are those that are left."""
    lines = [line for line in survey.breaklines if not line.name.startswith("BLDG")]
    names = {line.name for line in lines}
    codes = [str(text).split(" ")[0] for text in survey.attributes["description"]]
    ground = survey.points[[code not in names for code in codes]]
    fewer = [ts.Breakline(_every(line.coords), name=line.name) for line in lines]
    points = np.concatenate([ground, *(line.coords for line in fewer)])
    return ts.Survey(points=points, breaklines=fewer, water=survey.water, crs=survey.crs)


def _every(coords: Float64Array) -> Float64Array:
    """Return every so many vertices, and the last."""
    return coords[[*range(0, len(coords) - 1, EVERY), -1]]


def take_part(survey: ts.Survey) -> ts.TIN:
    """Return the part of the site in the pictures."""
    corner = np.array([SITE["EASTING"], SITE["NORTHING"]])
    return ts.triangulate(survey, boundary=[corner + PART])


def find_range(tins: list[ts.TIN]) -> tuple[float, float]:
    """Return the lowest and the highest elevation of all: one scale of colours."""
    elevations = np.concatenate([tin.points[:, 2] for tin in tins])
    return float(elevations.min()), float(elevations.max())


def tell(name: str, tin: ts.TIN) -> None:
    """Print how far the surface is from the ground along the ditch."""
    u = np.linspace(5.0, 240.0, 20_000)
    for what, offset in (("flow line", 0.0), ("banks", SITE["DITCH_TOP"])):
        v = SITE["road_line"](u) + SITE["DITCH_OFFSET"] + offset
        error = heights(tin, u, v) - SITE["elevation"](u, v)
        worst = float(np.abs(error).max())
        print(f"{name}, {what}: rms {np.sqrt(np.mean(error**2)):.3f} m, at most {worst:.3f} m")
    v = SITE["road_line"](u) + SITE["DITCH_OFFSET"]
    flow = heights(tin, u, v)
    print(f"{name}: water would stand {pool_depth(flow):.3f} m deep in the ditch at most")


def heights(tin: ts.TIN, u: AnyArray, v: AnyArray) -> Float64Array:
    """Heights of the surface at places of the site."""
    return tin.interpolate(np.stack([SITE["EASTING"] + u, SITE["NORTHING"] + v], axis=1))


def pool_depth(bed: Float64Array) -> float:
    """Greatest depth of water that cannot run off to the west along a bed."""
    return float((np.maximum.accumulate(bed) - bed).max())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
