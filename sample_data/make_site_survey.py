"""Make site_survey.csv: a believable topographic survey of an invented site near Jacksboro.

Run ``python sample_data/make_site_survey.py [FILE]``; needs numpy only. The generator is seeded,
so running it again gives the same bytes.

The site is described in local metres, u east and v north of its south-west corner; ``elevation``
is the ground as it is, and the survey sees it with the errors of an instrument.
"""

from __future__ import annotations

import csv
import sys
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

HERE = Path(__file__).parent
SEED = 20260511
HEADER = ("Point", "Northing", "Easting", "Elevation", "Description")
EASTING, NORTHING = 752_640.0, 4_024_180.0
"""South-west corner of the site, EPSG:32616."""
WIDTH, DEPTH = 250.0, 180.0
STEP = 5.0
"""Metres between shots, on the grid and along lines."""

RIDGE = np.array([[18.0, 170.0], [70.0, 150.0], [128.0, 146.0], [182.0, 158.0], [238.0, 140.0]])
ROAD_HALF_WIDTH, CROSS_FALL, SHOULDER = 3.5, 0.025, 9.0
DITCH_OFFSET, DITCH_TOE, DITCH_TOP = 12.0, 0.5, 2.2
"""Distances north of the road's centre line, and of the ditch's flow line."""
POND_CENTER, POND_RADII = np.array([66.0, 27.0]), np.array([27.0, 15.0])
POND_LEVEL, POND_DEPTH, POND_BANK = 318.4, 1.9, 12.0
"""Water level, greatest depth, and width of the bank around it."""


class Building(NamedTuple):
    """A rectangular building on a level pad."""

    center: tuple[float, float]
    size: tuple[float, float]
    bearing: float
    floor: float


BUILDINGS = (
    Building((168.0, 34.0), (26.0, 14.0), 8.0, 325.15),
    Building((208.0, 44.0), (12.0, 9.0), 8.0, 326.2),
)


class Shot(NamedTuple):
    """One place to be measured, and what the field book says of it."""

    u: float
    v: float
    description: str
    noise: float = 0.02


def blend(t: Floats) -> Floats:
    """Rise smoothly from 0 at t <= 0 to 1 at t >= 1."""
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def road_line(u: Floats) -> Floats:
    """Northing of the road's centre line."""
    return 66.0 + 0.06 * u + 7.0 * np.sin(np.pi * u / WIDTH)


def road_grade(u: Floats) -> Floats:
    """Elevation of the road's crown."""
    return 320.9 + 0.016 * u + 0.35 * np.sin(2.0 * np.pi * u / WIDTH)


def flow_line_grade(u: Floats) -> Floats:
    """Elevation of the bottom of the ditch, which drains to the west."""
    return 319.6 + 0.0175 * u


def distance_to_line(u: Floats, v: Floats, line: Floats) -> Floats:
    """Distance to a polyline."""
    place = np.stack([u, v], axis=-1)[..., None, :]
    start, span = line[:-1], np.diff(line, axis=0)
    along = np.clip(((place - start) * span).sum(-1) / (span * span).sum(-1), 0.0, 1.0)
    foot = start + along[..., None] * span
    return np.linalg.norm(place - foot, axis=-1).min(axis=-1)


def natural_ground(u: Floats, v: Floats) -> Floats:
    """Return the hillside before anything was built: a slope, swales, a sharp-crested ridge."""
    slope = 319.4 + 0.018 * u + 0.020 * v
    swales = 0.45 * np.sin(u / 21.0 + 0.6) * np.cos(v / 17.0) + 0.2 * np.sin((u + 2.0 * v) / 13.0)
    ridge = 6.5 * np.exp(-distance_to_line(u, v, RIDGE) / 16.0)
    return slope + swales + ridge


def with_road(u: Floats, v: Floats, ground: Floats) -> Floats:
    """Lay the road, crowned with a cross-fall, and its shoulders into the ground."""
    offset = np.abs(v - road_line(u))
    pavement = road_grade(u) - CROSS_FALL * np.minimum(offset, ROAD_HALF_WIDTH)
    return pavement + (ground - pavement) * blend((offset - ROAD_HALF_WIDTH) / SHOULDER)


def with_ditch(u: Floats, v: Floats, ground: Floats) -> Floats:
    """Cut a trapezoidal ditch north of the road."""
    offset = np.abs(v - road_line(u) - DITCH_OFFSET)
    side = np.clip((offset - DITCH_TOE) / (DITCH_TOP - DITCH_TOE), 0.0, 1.0)
    bottom = flow_line_grade(u) + 0.04 * np.minimum(offset / DITCH_TOE, 1.0)
    return np.where(offset < DITCH_TOP, bottom + (ground - bottom) * side, ground)


def pond_reach(u: Floats, v: Floats) -> Floats:
    """Return 1 on the water's edge, less inside, in units of the pond's radii."""
    return np.hypot((u - POND_CENTER[0]) / POND_RADII[0], (v - POND_CENTER[1]) / POND_RADII[1])


def with_pond(u: Floats, v: Floats, ground: Floats) -> Floats:
    """Dig the pond and slope its bank to the water's edge."""
    reach = pond_reach(u, v)
    bed = POND_LEVEL - POND_DEPTH * (1.0 - np.minimum(reach, 1.0) ** 2)
    bank = blend((reach - 1.0) * POND_RADII.min() / POND_BANK)
    return np.where(reach < 1.0, bed, POND_LEVEL + (ground - POND_LEVEL) * bank)


def building_frame(building: Building, u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return coordinates along the building's own axes, from its centre."""
    angle = np.radians(building.bearing)
    du, dv = u - building.center[0], v - building.center[1]
    return du * np.cos(angle) - dv * np.sin(angle), du * np.sin(angle) + dv * np.cos(angle)


def outside_building(building: Building, u: Floats, v: Floats) -> Floats:
    """Distance from the walls; 0 inside."""
    along, across = building_frame(building, u, v)
    return np.hypot(
        np.maximum(np.abs(along) - building.size[0] / 2, 0.0),
        np.maximum(np.abs(across) - building.size[1] / 2, 0.0),
    )


def with_pads(u: Floats, v: Floats, ground: Floats) -> Floats:
    """Level the ground around the buildings."""
    for building in BUILDINGS:
        away = blend((outside_building(building, u, v) - 1.5) / 8.0)
        ground = building.floor + (ground - building.floor) * away
    return ground


def elevation(u: Floats, v: Floats) -> Floats:
    """Elevation of the site as built, metres above mean sea level."""
    ground = with_pads(u, v, natural_ground(u, v))
    return with_pond(u, v, with_ditch(u, v, with_road(u, v, ground)))


def along(line: Floats, step: float) -> Floats:
    """Return places about ``step`` apart on a polyline, its own vertices included."""
    places = [line[:1]]
    for start, end in pairwise(line):
        count = max(1, round(float(np.linalg.norm(end - start)) / step))
        places.append(start + (end - start) * np.linspace(0.0, 1.0, count + 1)[1:, None])
    return np.concatenate(places)


def walk(places: Floats, code: str, noise: float = 0.015, *, end: str = "END") -> list[Shot]:
    """Shoot a line in walking order; the field book marks where it begins, and ends or closes."""
    last = len(places) - 1
    marks = {0: f"{code} BEG", last: f"{code} {end}"}
    return [Shot(u, v, marks.get(i, code), noise) for i, (u, v) in enumerate(places)]


def beside_road(offset: float, *, phase: float = 0.0) -> Floats:
    """Return places along the road at a distance north of its centre line, from west to east."""
    u = np.arange(2.0 + phase, WIDTH, STEP)
    return np.stack([u, road_line(u) + offset], axis=1)


def road_and_ditch() -> list[list[Shot]]:
    """Return the crown and both edges of pavement, then the ditch's five lines."""
    half, middle = ROAD_HALF_WIDTH, DITCH_OFFSET
    lines = (
        ("EP1", -half, 0.01),
        ("CL1", 0.0, 0.01),
        ("EP2", half, 0.01),
        ("TOB1", middle - DITCH_TOP, 0.02),
        ("TOE1", middle - DITCH_TOE, 0.02),
        ("FL1", middle, 0.02),
        ("TOE2", middle + DITCH_TOE, 0.02),
        ("TOB2", middle + DITCH_TOP, 0.02),
    )
    shots = [walk(beside_road(at), code, noise) for code, at, noise in lines]
    return [line if i % 2 == 0 else _backwards(line) for i, line in enumerate(shots)]


def _backwards(line: list[Shot]) -> list[Shot]:
    """Walk the line from its other end: nobody walks back for nothing."""
    places = np.array([(shot.u, shot.v) for shot in line])
    return walk(places[::-1], line[1].description, line[0].noise)


def pond() -> list[list[Shot]]:
    """Return the water's edge, then soundings of the bottom."""
    angle = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    edge = walk(POND_CENTER + POND_RADII * ring, "WE1", 0.01, end="CLS")
    soundings = [POND_CENTER[None, :]]
    for share in (0.75, 0.4):
        soundings.append(POND_CENTER + share * POND_RADII * ring[:: 2 if share > 0.5 else 4])
    return [edge, [Shot(u, v, "BOT", 0.03) for u, v in np.concatenate(soundings)]]


def buildings() -> list[Shot]:
    """Return the corners, going round each building."""
    shots = []
    for number, building in enumerate(BUILDINGS, start=1):
        angle = np.radians(building.bearing)
        corners = []
        for right, up in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)):
            along, across = right * building.size[0], up * building.size[1]
            u = building.center[0] + along * np.cos(angle) + across * np.sin(angle)
            v = building.center[1] - along * np.sin(angle) + across * np.cos(angle)
            corners.append((float(u), float(v)))
        shots += walk(np.array(corners), f"BLDG{number}", 0.01, end="CLS")
    return shots


def control() -> list[Shot]:
    """Return control points, as the job starts with them."""
    return [
        Shot(6.0, 58.0, 'CP1 "REBAR AND CAP, TS-1"', 0.0),
        Shot(243.0, 79.0, 'CP2 "REBAR AND CAP, TS-2"', 0.0),
        Shot(131.0, 141.0, "CP3 PK NAIL", 0.0),
        Shot(188.0, 24.0, "BM1 BRASS DISK, SE CORNER OF SLAB", 0.0),
    ]


def manholes() -> list[Shot]:
    """Return the lids in the road."""
    u = np.array([31.0, 92.0, 154.0, 216.0])
    v = road_line(u) - 1.7
    notes = ('MH "MANHOLE, 600mm"', 'MH "MANHOLE, 600mm"', "MH", 'MH "MANHOLE, 750mm, SEALED"')
    return [Shot(*place, note, 0.01) for *place, note in zip(u, v, notes, strict=True)]


def trees(rng: np.random.Generator) -> list[Shot]:
    """Return single trees north of the ditch and around the pond."""
    kinds = ("TR OAK, 400mm", "TR PINE, 300mm", "TR MAPLE, 250mm", "TR")
    shots = []
    while len(shots) < 36:
        u, v = rng.uniform(4.0, WIDTH - 4.0), rng.uniform(4.0, DEPTH - 4.0)
        if is_open_ground(u, v, clearance=3.0):
            shots.append(Shot(u, v, kinds[rng.integers(len(kinds))], 0.03))
    return shots


def is_open_ground(u: float, v: float, *, clearance: float) -> bool:
    """Tell whether a place is clear of the road, ditch, pond, ridge line and buildings."""
    uu, vv = np.array(u), np.array(v)
    north_of_road = float(v - road_line(uu))
    return bool(
        not -ROAD_HALF_WIDTH - clearance < north_of_road < DITCH_OFFSET + DITCH_TOP + 2 * clearance
        and (float(pond_reach(uu, vv)) - 1.0) * POND_RADII.min() > clearance
        and float(distance_to_line(uu, vv, RIDGE)) > clearance
        and all(float(outside_building(b, uu, vv)) > clearance for b in BUILDINGS)
    )


def grid_shots(rng: np.random.Generator) -> list[Shot]:
    """Return the ground between: rows walked there and back, never quite on the mark."""
    shots = []
    for row, v in enumerate(np.arange(0.0, DEPTH + 1.0, STEP)):
        columns = np.arange(0.0, WIDTH + 1.0, STEP)
        for u in columns if row % 2 == 0 else columns[::-1]:
            du, dv = np.clip(rng.normal(0.0, 0.45, 2), -1.4, 1.4)
            place = float(u + du), float(v + dv)
            if is_open_ground(*place, clearance=1.6):
                shots.append(Shot(*place, "GS", 0.025))
    return shots


def spot_heights(rng: np.random.Generator) -> list[Shot]:
    """Return extra shots where the surveyor saw a change of slope, under the ridge."""
    u = np.arange(30.0, 236.0, 14.0)
    v = np.interp(u, *RIDGE.T) - 9.0 + rng.normal(0.0, 0.8, len(u))
    return [Shot(float(a), float(b), "SPOT", 0.02) for a, b in zip(u, v, strict=True)]


def blocks(rng: np.random.Generator) -> Iterator[tuple[int, list[Shot]]]:
    """Give every block of the job with the point number at which it starts."""
    lines = [*road_and_ditch(), walk(along(RIDGE, STEP), "RDG1", 0.02), *pond()]
    yield 1, control()
    for i, line in enumerate(lines):
        yield 101 + 100 * i, line
    yield 1301, buildings()
    yield 1321, manholes()
    yield 1341, trees(rng)
    yield 1401, spot_heights(rng)
    yield 2001, grid_shots(rng)


def measure(shot: Shot, rng: np.random.Generator) -> tuple[str, str, str]:
    """Return northing, easting and elevation as the instrument exports them, to the millimetre."""
    du, dv = rng.normal(0.0, 0.5 * shot.noise, 2)
    z = float(elevation(np.array(shot.u), np.array(shot.v))) + rng.normal(0.0, shot.noise)
    easting, northing = EASTING + shot.u + du, NORTHING + shot.v + dv
    return f"{northing:.3f}", f"{easting:.3f}", f"{z:.3f}"


def records(rng: np.random.Generator) -> list[list[str]]:
    """Return the rows of the file; about one shot in sixty was deleted in the field."""
    rows = []
    for first, shots in blocks(rng):
        number = first
        for shot in shots:
            number += int(rng.random() < 1 / 60)
            rows.append([str(number), *measure(shot, rng), shot.description])
            number += 1
    return with_duplicates(rows)


def with_duplicates(rows: list[list[str]]) -> list[list[str]]:
    """Add the two duplicates: a place shot again 34 mm higher, and a row exported twice."""
    again = next(i for i, row in enumerate(rows) if row[4] == "SPOT") + 6
    number, north, east, z, _ = rows[again]
    reshot = [str(int(rows[-1][0]) + 5), north, east, f"{float(z) + 0.034:.3f}", "SPOT RESHOT"]
    twice = next(i for i, row in enumerate(rows) if row[0] == number) + 400
    return [*rows[: twice + 1], rows[twice], *rows[twice + 1 :], reshot]


def write_rows(path: Path, rows: list[list[str]]) -> None:
    """Write the rows of a survey."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        writer.writerows(rows)
    print(f"{path}: {len(rows):,} points")


def main(path: Path = HERE / "site_survey.csv") -> None:
    """Make the file."""
    write_rows(path, records(np.random.default_rng(SEED)))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
