"""Make design_pad.csv: a building pad with side slopes, designed into the site of site_survey.csv.

Run ``python sample_data/make_design.py [FILE]``; needs tinsmith. The same bytes every time.

The pad is a rectangle that falls evenly for drainage. From its edge side slopes run down to the
ground where the pad lies above it (fill), and up where it lies below (cut): each is followed
outwards until it meets the TIN of the survey, which is where the design ends (daylight).
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from make_site_survey import EASTING, HERE, NORTHING, write_rows

import tinsmith as ts

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

CENTER, SIZE, BEARING = np.array([158.0, 118.0]), np.array([54.0, 28.0]), 6.0
"""Of the pad: local metres, and degrees clockwise from north of its short sides."""
LEVEL, FALL = 325.77, 0.01
"""Elevation at the centre, and how much it falls for each metre to the south."""
CUT_RUN, FILL_RUN = 2.0, 2.5
"""Metres outwards for a metre up in cut, or down in fill."""
STEP, FAN = 2.0, 6
"""Metres between slope lines along an edge; parts of the quarter turn at a corner."""
REACH, PARTS = 60.0, 1000
"""Metres that slope lines are followed at most, in so many parts."""
LEAST = 0.02
"""Metres: where the pad meets the ground at its very edge there is no slope."""


def turned(right: Floats, up: Floats) -> Floats:
    """Turn directions from along the pad to east and north."""
    angle = np.radians(BEARING)
    east, north = (
        np.array([np.cos(angle), -np.sin(angle)]),
        np.array([np.sin(angle), np.cos(angle)]),
    )
    return np.asarray(right)[..., None] * east + np.asarray(up)[..., None] * north


def slope_lines() -> Iterator[tuple[Floats, Floats]]:
    """Go round the pad counter-clockwise: a place on its edge, and the direction outwards."""
    half = SIZE / 2
    corners = np.array([[1, -1], [1, 1], [-1, 1], [-1, -1]]) * half
    for k, (start, end) in enumerate(zip(corners, np.roll(corners, -1, axis=0), strict=True)):
        for share in np.linspace(0.0, 1.0, round(np.hypot(*(end - start)) / STEP) + 1)[1:-1]:
            place = start + share * (end - start)
            yield turned(*place), turned(*np.array([np.cos(k * np.pi / 2), np.sin(k * np.pi / 2)]))
        for turn in (k + np.linspace(0.0, 1.0, FAN + 1)) * np.pi / 2:
            yield turned(*end), turned(np.cos(turn), np.sin(turn))


def pad_elevation(place: Floats) -> float:
    """Return the elevation of the pad at a place relative to its centre."""
    return float(LEVEL + FALL * place[1])


def daylight(ground: ts.TIN, place: Floats, outwards: Floats) -> Floats | None:
    """Follow a side slope to the ground; None where there is none to speak of."""
    start = np.array([*(origin() + place), pad_elevation(place)])
    is_cut = bool(start[2] < ground.interpolate(start[None, :2])[0])
    way = np.array([*outwards, 1 / CUT_RUN if is_cut else -1 / FILL_RUN])
    low, high = 0.0, REACH
    for _ in range(3):  # a thousand times nearer each time
        trial = np.linspace(low, high, PARTS + 1)
        spots = start + trial[:, None] * way
        height = spots[:, 2] - ground.interpolate(spots[:, :2])
        first = int(np.argmax(height >= 0 if is_cut else height <= 0))
        low, high = float(trial[max(first - 1, 0)]), float(trial[first])
    return None if high < LEAST else start + high * way


def origin() -> Floats:
    """Easting and northing of the pad's centre."""
    return np.array([EASTING, NORTHING]) + CENTER


def pad_edge() -> list[Floats]:
    """Return the places on the edge from which slope lines run, each once."""
    places = [np.array([*(origin() + p), pad_elevation(p)]) for p, _ in slope_lines()]
    return [p for k, p in enumerate(places) if k == 0 or (p != places[k - 1]).any()]


def site() -> ts.TIN:
    """Build the ground as it is, with its breaklines."""
    survey = ts.read(HERE / "site_survey.csv", crs="EPSG:32616")
    return ts.triangulate(ts.lines_from_codes(survey))


def records() -> list[list[str]]:
    """Return the rows of the file: the edge of the pad, then the daylight line."""
    ground = site()
    toe = [daylight(ground, *line) for line in slope_lines()]
    rows: list[list[str]] = []
    for first, code, points in (
        (1, "SLAB1", pad_edge()),
        (501, "DAYLIGHT1", [p for p in toe if p is not None]),
    ):
        for k, (east, north, z) in enumerate(points):
            mark = " BEG" if k == 0 else " CLS" if k == len(points) - 1 else ""
            place = f"{north:.3f}", f"{east:.3f}", f"{z:.3f}"
            rows.append([str(first + k), *place, f"{code}{mark}"])
    return rows


def main(path: Path = HERE / "design_pad.csv") -> None:
    """Make the file."""
    write_rows(path, records())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
