"""Make the picture of rivers.md.

Run ``python docs/make_river.py [FOLDER]``; needs the extra "plot".
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import tinsmith as ts

HERE = Path(__file__).parent
DATA = HERE.parent / "tests" / "data" / "river"
SPACING = 10.0
LEVELS = np.arange(504.0, 518.0, 1.0)


def read_river() -> tuple[list[np.ndarray], np.ndarray]:
    """Return the cross sections and the centreline of a reach of the Wabash River."""
    table = np.genfromtxt(DATA / "sections.csv", delimiter=",", skip_header=1)
    line = np.genfromtxt(DATA / "centreline.csv", delimiter=",", skip_header=1)
    return [table[table[:, 0] == k, 1:] for k in np.unique(table[:, 0])], line


def main(folder: Path = HERE) -> None:
    """Draw the TIN of the points beside the bed, and print how well sections are predicted."""
    sections, line = read_river()
    options = {"crs": "EPSG:26916", "elevation_unit": "US survey foot"}
    measure(sections, line)
    surfaces = {
        "the points, triangulated": ts.triangulate(np.concatenate(sections), **options),
        "ts.riverbed": ts.riverbed(sections, line, spacing=SPACING, omit_returns=True, **options),
    }
    figure = Figure(figsize=(11.0, 5.6), layout="constrained")
    for axes, (title, tin) in zip(figure.subplots(1, 2), surfaces.items(), strict=True):
        x, y, z = tin.points.T
        shown = axes.tricontourf(
            x, y, tin.triangles, z, levels=LEVELS, cmap="viridis", extend="both"
        )
        axes.tricontour(x, y, tin.triangles, z, levels=LEVELS, colors="#333333", linewidths=0.4)
        for one in sections:
            axes.plot(*one[:, :2].T, color="#c62828", linewidth=0.8)
        middle = sections[4][:, :2].mean(axis=0)
        axes.set(xlim=middle[0] + [-220, 220], ylim=middle[1] + [-220, 220], xticks=[], yticks=[])
        axes.set_aspect("equal")
        axes.set_title(title, color="#333333", fontsize=12)
    figure.colorbar(shown, ax=figure.axes, label="elevation, US survey feet", shrink=0.8)
    figure.savefig(folder / "river-bed.png", dpi=110, metadata={"Software": None})


def measure(sections: list[np.ndarray], line: np.ndarray) -> None:
    """Print the errors at each section that is left out, of both surfaces."""
    for k in range(1, len(sections) - 1):
        rest = [one for j, one in enumerate(sections) if j != k]
        made = ts.riverbed(rest, line, spacing=SPACING, omit_returns=True)
        apart = [
            tin.interpolate(sections[k][:, :2]) - sections[k][:, 2]
            for tin in (ts.triangulate(np.concatenate(rest)), made)
        ]
        print(k, *(f"{np.sqrt(np.nanmean(one**2)):.2f}" for one in apart))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
