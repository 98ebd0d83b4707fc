"""Rivers: beds that keep their sections, and water that is level across and falls downstream."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import shapely

import tinsmith as ts

from .campaign import Campaign, Case

_REFUSED_BEDS = {
    "fold": "lines along the channel cross one another",
    "meet": "must not cross or touch one another",
    "twice": "meets the centreline more than once",
    "off": "does not cross the centreline",
    "over": "lies over itself",
    "zigzag": "crosses itself",
    "station": "meet the centreline at one station",
}
_REFUSED_WATER = {
    "level": "the banks do not tell which way",
    "polygon": "Invalid water",
    "line": "The centreline crosses itself",
    "short": "not much longer than wide",
    "off": "lies off the surface",
}


# ---------------------------------------------------------------- the bed


class Course:
    """A winding line as a function of the length along it, closely approximated."""

    def __init__(self, case: Case) -> None:
        along = np.linspace(-100.0, 500.0, 6001)
        across = case["swing"] * np.sin(along / case["wave"])
        turn = np.array([[np.cos(case["turn"]), np.sin(case["turn"])], [0.0, 0.0]])
        turn[1] = -turn[0, 1], turn[0, 0]
        self.points = np.column_stack([along, across]) @ turn + case["origin"]
        steps = np.hypot(*np.diff(self.points, axis=0).T)
        self.stations = np.concatenate([[0.0], np.cumsum(steps)])
        self.stations -= self.stations[1000]

    def places(self, stations: Any, offsets: Any) -> Any:
        """Return places left of the line by offsets."""
        stations = np.asarray(stations, float)
        middle = np.stack([np.interp(stations, self.stations, one) for one in self.points.T], -1)
        ahead = np.stack(
            [np.interp(stations + 0.1, self.stations, one) for one in self.points.T], -1
        )
        behind = np.stack(
            [np.interp(stations - 0.1, self.stations, one) for one in self.points.T], -1
        )
        way = ahead - behind
        way /= np.hypot(way[..., 0], way[..., 1])[..., None]
        left = np.stack([-way[..., 1], way[..., 0]], -1)
        return middle + np.asarray(offsets)[..., None] * left


def _draw_course(rng: np.random.Generator) -> Case:
    is_far = rng.random() < 0.5
    return {
        "origin": [500_000.0, 4_000_000.0] if is_far else [0.0, 0.0],
        "swing": float(rng.choice([0.0, 10.0, 30.0])),
        "wave": float(rng.uniform(20, 80)),
        "turn": float(rng.choice([0.0, rng.uniform(0, 6.3)])),
    }


def generate_bed(rng: np.random.Generator) -> Case:
    """Sections of all kinds across a winding channel, with banks and a thalweg or without."""
    count = int(rng.integers(2, 8))
    is_skew = rng.random() < 0.5
    stations = np.sort(rng.uniform(20, 380, count))
    sections = []
    for station in stations.tolist():
        k = int(rng.integers(2, 12))
        width = rng.uniform(6, 14, 2)
        offsets = np.sort(rng.uniform(-width[0], width[1], k))
        offsets[[0, -1]] = -width[0], width[1]
        skew = rng.normal(0, 0.1) if is_skew else 0.0
        z = 10 - 0.01 * station + rng.integers(0, 5, k) * 0.5
        rows = np.column_stack([station + skew * offsets, offsets, z])
        sections.append((rows[::-1] if rng.random() < 0.5 else rows).tolist())
    if rng.random() < 0.5:
        rng.shuffle(sections)
    return _draw_course(rng) | {
        "sections": sections,
        "spacing": float(rng.choice([3.0, 10.0, 50.0, 1000.0])),
        "banks": float(rng.uniform(2, 5)) if rng.random() < 0.4 else None,
        "thalweg": float(rng.uniform(-1.5, 1.5)) if rng.random() < 0.4 else None,
        "upstream": bool(rng.random() < 0.3),
        "short": bool(rng.random() < 0.2),
        "grouped": bool(rng.random() < 0.3),
    }


def examine_bed(case: Case) -> str:
    """Build the bed, and compare it with the sections it must keep and lie between."""
    course = Course(case)
    tables = [np.array(one) for one in case["sections"]]
    lines = [np.column_stack([course.places(t[:, 0], t[:, 1]), t[:, 2]]) for t in tables]
    ends = (60.0, 340.0) if case["short"] else (0.0, 400.0)
    stations = np.linspace(*ends, 80 if case["swing"] else 2)
    line = course.places(stations, np.zeros(len(stations)))
    options: dict[str, Any] = {"spacing": case["spacing"]}
    if case["banks"] is not None:
        stations = np.linspace(0, 400, len(stations))
        sides = (case["banks"], -case["banks"])
        options["banks"] = [course.places(stations, np.full(len(stations), one)) for one in sides]
    if case["thalweg"] is not None:
        stations = np.linspace(0, 400, len(stations))
        options["thalweg"] = course.places(stations, np.full(len(stations), case["thalweg"]))
    given: Any = lines
    if case["grouped"]:
        rows = np.concatenate(lines)
        labels = np.repeat([f"X{k}" for k in range(len(lines))], [len(one) for one in lines])
        given, options["by"] = ts.Survey(points=rows, attributes={"code": labels}), "code"
    try:
        made = ts.riverbed(given, line[::-1] if case["upstream"] else line, **options)
    except ts.LinesError as error:
        known = [word for word, sentence in _REFUSED_BEDS.items() if sentence in str(error)]
        if not known:
            raise
        return f"refused: {known[0]}"
    found = ts.check(made)
    assert found.ok, [one.sentence for one in found.problems]
    _require_kept(made, lines)
    _require_between(made, lines)
    if not case["swing"] and not any(np.ptp(one[:, 0]) for one in tables):
        _require_linear(made, case, course, tables)
        return "straight"
    return "curved"


def _require_kept(made: ts.TIN, lines: list[Any]) -> None:
    """Every surveyed point is a vertex, bit for bit."""
    vertices = {tuple(one) for one in made.points.tolist()}
    for line in lines:
        assert all(tuple(one) in vertices for one in line.tolist()), "a surveyed point is lost"


def _require_between(made: ts.TIN, lines: list[Any]) -> None:
    """Between two sections nothing is lower or higher than both."""
    (outline,) = made.boundary
    ring = shapely.linearrings(made.points[outline, :2])
    area = shapely.Polygon(ring)
    assert abs(area.area - made.area) <= 1e-9 * area.area
    flat = [shapely.linestrings(line[:, :2]) for line in lines]
    places = shapely.points(made.points[:, :2])
    near = np.array([shapely.distance(one, places) for one in flat])
    touched = near <= 1e-6
    cuts = shapely.buffer(shapely.multilinestrings(flat), 1e-6)
    faces = [one for one in shapely.get_parts(shapely.difference(area, cuts)) if one.area > 1e-3]
    for face in faces:
        ends = [k for k, one in enumerate(flat) if shapely.distance(face, one) <= 1e-5]
        inside = shapely.dwithin(face, places, 1e-7) & ~touched.any(axis=0)
        z = np.concatenate([lines[k][:, 2] for k in ends])
        assert len(ends) == 2, "a strip does not lie between two sections"
        own = made.points[inside, 2]
        assert ((own >= z.min()) & (own <= z.max())).all(), "beyond both sections"


def _require_linear(made: ts.TIN, case: Case, course: Course, tables: list[Any]) -> None:
    """On a straight channel with square sections vertices are linear at the same offset."""
    turn = course.points[-1] - course.points[0]
    turn = turn / np.hypot(*turn)
    away = made.points[:, :2] - course.points[1000]
    station, offset = away @ turn, away @ np.array([-turn[1], turn[0]])
    order = sorted((one[np.argsort(one[:, 1])] for one in tables), key=lambda one: one[0, 0])
    inner = sorted([case["banks"], -case["banks"]] if case["banks"] is not None else [])
    inner = sorted(inner + ([case["thalweg"]] if case["thalweg"] is not None else []))
    for first, last in pairwise(order):
        a, b = first[0, 0], last[0, 0]
        chosen = (station > a + 1e-6) & (station < b - 1e-6)
        share = (station[chosen] - a) / (b - a)
        nodes = [np.array([one[0, 1], *inner, one[-1, 1]]) for one in (first, last)]
        for w, y, z in zip(share, offset[chosen], made.points[chosen, 2], strict=True):
            own = nodes[0] + w * (nodes[1] - nodes[0])
            u = np.interp(y, own, np.arange(len(own)))
            ends = [
                np.interp(np.interp(u, np.arange(len(at)), at), one[:, 1], one[:, 2])
                for at, one in zip(nodes, (first, last), strict=True)
            ]
            wanted = ends[0] + w * (ends[1] - ends[0])
            steep = max(
                float(np.abs(np.diff(one[:, 2]) / np.diff(one[:, 1])).max())
                for one in (first, last)
            )
            assert abs(z - wanted) <= 3e-5 * (1.0 + steep), f"off by {z - wanted}"


# ---------------------------------------------------------------- the water


def generate_water(rng: np.random.Generator) -> Case:
    """A valley with noise, a stream in it with islands, and a centreline or none."""
    return _draw_course(rng) | {
        "places": rng.uniform(0, 1, (int(rng.choice([60, 400])), 2)).tolist(),
        "noise": rng.normal(0, 1, 400).tolist(),
        "rough": float(rng.choice([0.0, 0.02, 0.3])),
        "slope": float(rng.choice([0.01, 0.002, 0.0, -0.01])),
        "width": rng.uniform(4, 12, 12).tolist(),
        "island": float(rng.uniform(0.2, 0.8)) if rng.random() < 0.3 else None,
        "line": str(rng.choice(["given", "given", "coarse", "none"])),
        "fit": str(rng.choice(["lowest", "isotonic"])),
        "downstream": str(rng.choice(["guess", "along", "against"])),
        "spacing": float(rng.choice([2.0, 10.0, 60.0])),
        "beyond": bool(rng.random() < 0.3),
    }


def find_sides(case: Case) -> tuple[Any, Any]:
    """Return the left and the right shore of the stream of a case."""
    course = Course(case)
    start, stop = (-40.0, 430.0) if case["beyond"] else (30.0, 370.0)
    stations = np.linspace(start, stop, 40)
    widths = np.interp(stations, np.linspace(0, 400, 12), case["width"])
    return course.places(stations, widths), course.places(stations, -0.8 * widths)


def make_water(case: Case) -> tuple[ts.TIN, Any, Any]:
    """Return the ground, the water and the centreline of a case."""
    course = Course(case)
    places = np.array(case["places"])
    corners = course.places([-60, 400, 400, -60], [-70, -70, 70, 70])
    xy = course.places(places[:, 0] * 400, (places[:, 1] - 0.5) * 60)
    xy = np.vstack([xy, corners, course.places(np.linspace(0, 400, 40), np.zeros(40))])
    line = shapely.linestrings(course.points)
    along = shapely.line_locate_point(line, shapely.points(xy))
    apart = shapely.distance(line, shapely.points(xy))
    noise = np.resize(np.array(case["noise"]), len(xy))
    z = 50 - case["slope"] * along + 0.1 * apart + case["rough"] * noise
    ground = ts.triangulate(np.column_stack([xy, z]))
    left, right = find_sides(case)
    water = shapely.Polygon(np.vstack([left, right[::-1]]))
    if case["island"] is not None:
        middle = course.places([30 + 340 * case["island"]], [1.0])[0]
        water = water.difference(shapely.Point(middle).buffer(2.0, quad_segs=3))
    if case["line"] == "none":
        return ground, water, None
    count = 12 if case["line"] == "coarse" else 80
    at = np.linspace(25, 375, count)
    return ground, water, course.places(at, np.zeros(count))


def examine_water(case: Case) -> str:
    """Flatten the water, and look whether it is level across, falls, and leaves the ground."""
    ground, water, line = make_water(case)
    if not water.is_valid or water.geom_type != "Polygon":
        return "no polygon"
    options = {name: case[name] for name in ("spacing", "fit", "downstream")}
    try:
        made = ts.hydroflatten(ground, water, line, **options)
    except (ts.LinesError, ts.OptionError, ts.PointsError) as error:
        known = [word for word, sentence in _REFUSED_WATER.items() if sentence in str(error)]
        if not known:
            raise
        return f"refused: {known[0]}"
    found = ts.check(made)
    assert found.ok, [one.sentence for one in found.problems]
    assert abs(made.area - ground.area) <= 1e-9 * ground.area
    inside = shapely.intersection(water, shapely.convex_hull(shapely.multipoints(ground.points)))
    _require_ground(ground, made, inside, case)
    axis = _find_centreline(made) if line is None else shapely.linestrings(line)
    notes = " ".join(made.report.notes)
    is_along = "flows along the centreline" in notes
    is_whole = line is not None or inside.equals(water)
    _require_fall(made, inside, axis, is_along=is_along, is_whole=is_whole)
    _require_level(made, inside, axis, np.array(case["places"]))
    return "flattened" if line is not None else "medial axis"


def _find_centreline(made: ts.TIN) -> Any:
    """Return the breaklines called centreline as one line."""
    chains = [
        made.points[chain, :2]
        for chain, name in zip(made.lines.chains(), made.lines.names, strict=True)
        if name == "centreline"
    ]
    return shapely.line_merge(shapely.multilinestrings(chains))


def _require_ground(ground: ts.TIN, made: ts.TIN, water: Any, case: Case) -> None:
    """Vertices beyond the water stay, bit for bit; islands too; the lowest level is not above."""
    xy = ground.points[:, :2]
    apart = shapely.distance(water, shapely.points(xy))
    vertices = {tuple(one) for one in made.points.tolist()}
    kept = ground.points[apart > 1e-6]
    assert all(tuple(one) in vertices for one in kept.tolist()), "a vertex beyond the water is lost"
    shore = shapely.boundary(water)
    near = shapely.distance(shore, shapely.points(made.points[:, :2])) <= 1e-7
    own = ground.interpolate(made.points[near, :2])
    above = np.nan_to_num(made.points[near, 2] - own, nan=0.0)
    if case["fit"] == "lowest":
        hull = shapely.boundary(shapely.convex_hull(shapely.multipoints(xy)))
        inner = shapely.distance(hull, shapely.points(made.points[near, :2])) > 1e-6
        ends = shapely.multilinestrings(list(np.stack(find_sides(case), axis=1)[[0, -1]]))
        inner &= shapely.distance(ends, shapely.points(made.points[near, :2])) > 1e-6
        assert above[inner].max(initial=0.0) <= 1e-6, f"above the ground by {above.max()}"
    for hole in water.interiors if water.geom_type == "Polygon" else ():
        island = shapely.Polygon(hole).buffer(-1e-6)
        stays = shapely.contains_xy(island, xy)
        assert all(tuple(one) in vertices for one in ground.points[stays].tolist())


def _require_fall(made: ts.TIN, water: Any, axis: Any, *, is_along: bool, is_whole: bool) -> None:
    """The level is a function of the nearest station that never rises downstream.

    A medial axis that leaves the surface goes on beyond the centreline of the TIN, which is not
    whole then: what is nearest to an end of that one has stations of which nothing is known.
    """
    xy = made.points[:, :2]
    wet = shapely.distance(water, shapely.points(xy)) <= 1e-7
    stations = shapely.line_locate_point(axis, shapely.points(xy[wet]))
    z = made.points[wet, 2]
    if not is_whole:
        known = (stations > 1e-6) & (stations < axis.length - 1e-6)
        stations, z = stations[known], z[known]
    order = np.lexsort((-z if is_along else z, stations))
    falls = np.diff(z[order]) * (1.0 if is_along else -1.0)
    steps = np.diff(stations[order])
    rises = falls > 1e-9 + 1e-6 * (steps < 1e-6)
    assert not rises.any(), f"rises by {falls.max()} downstream"


def _require_level(made: ts.TIN, water: Any, axis: Any, draws: Any) -> None:
    """Square to the centreline, as far as its station is the nearest, the water is level."""
    length = float(axis.length)
    stations = draws[:, 0] * length
    middles = shapely.get_coordinates(axis.interpolate(stations))
    ahead = shapely.get_coordinates(axis.interpolate(np.minimum(stations + 1e-3, length)))
    way = ahead - middles
    way /= np.hypot(*way.T)[:, None]
    places = middles + (draws[:, 1:] - 0.5) * 20 * np.column_stack([-way[:, 1], way[:, 0]])
    nearest = shapely.line_locate_point(axis, shapely.points(places))
    inner = shapely.buffer(water, -1e-3)
    on = np.abs(nearest - stations) <= 1e-5
    on &= shapely.contains_xy(inner, places) & shapely.contains_xy(inner, middles)
    apart = np.abs(made.interpolate(places[on]) - made.interpolate(middles[on]))
    assert apart.max(initial=0.0) <= 1e-4, f"not level across by {apart.max()}"


CAMPAIGNS = (
    Campaign("riverbeds", "beds keep sections and lie between them", generate_bed, examine_bed),
    Campaign("flowing", "level across, falling, ground kept", generate_water, examine_water),
)
