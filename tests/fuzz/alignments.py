"""Alignments of any elements: joined, read again from LandXML, stations found, damaged files."""

from __future__ import annotations

import math
import re
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

LAWS = ("clothoid", "bloss", "cosine", "sinusoid", "biquadratic")
ORDINATES = ("cubic parabola", "sine half-wave")


def generate(rng: np.random.Generator) -> Case:
    """Up to eight elements from a place of any size, points around them, and a damage."""
    size = float(10.0 ** rng.integers(0, 6))  # around a place where the CRS applies
    parts: list[Any] = []
    for _ in range(int(rng.integers(1, 9))):
        kind = str(rng.choice(["line", "arc", *LAWS, *ORDINATES]))
        length = float(rng.choice([0.5, 10.0, 37.3, 200.0]))
        bent = [float(v) for v in rng.choice([0.0, 0.001, -0.02, 0.05, -0.3], 2)]
        if kind == "line":
            bent = [0.0, 0.0]
        elif kind == "arc":
            bent = [bent[0] or 0.01] * 2
        elif kind in ORDINATES:
            flat = int(rng.integers(2))
            bent[flat], bent[1 - flat] = 0.0, min(bent[1 - flat] or 0.01, 1.0 / length)
        elif bent[0] == bent[1]:
            bent[1] = 0.0 if bent[0] else 0.01
        elif rng.random() < 0.8:  # most turn to one side
            bent = [abs(bent[0]), abs(bent[1])]
        if kind != "arc":  # an axis whose transitions are spirals of many turns is none
            length = min(length, 4.0 / max(1e-9, *map(abs, bent)))
        parts.append([kind, length, *bent])
    start = [float(v) for v in np.array([5e5, 4e6]) + rng.uniform(-size, size, 2)]
    return {
        "start": start,
        "direction": float(rng.uniform(-4, 4)),
        "parts": parts,
        "points": rng.uniform(-300, 300, (12, 2)).tolist(),
        "begin": float(rng.choice([0.0, -50.0, 1234.5])),
        "damage": [float(v) for v in rng.random(2)],
    }


def make_road(case: Case) -> ts.Alignment:
    """Join the elements of a case."""
    elements, start, direction = [], tuple(case["start"]), case["direction"]
    for kind, length, first, last in case["parts"]:
        elements.append(ts.Element(kind, start, direction, length, first, last))
        start, direction = elements[-1].end, elements[-1].end_direction
    return ts.Alignment(elements, start=case["begin"], crs="EPSG:32616", elevation_unit="m")


def examine(case: Case) -> str:
    """Compare stations with a fine search, and what was written with what is read again."""
    try:
        road = make_road(case)
    except ts.OptionError as error:
        return f"refused: {str(error)[:20]}"
    size = max(1.0, float(np.abs(road.points_at([road.start, road.end])).max()))
    require_stations(road, np.array(case["points"]) + case["start"], 1e-9 * size)
    with TemporaryDirectory() as folder:
        try:
            path = ts.write(road, Path(folder, "road.xml"))
        except ts.FormatError as error:
            return require_reason(str(error))
        try:
            back = ts.read_alignment(path)
        except ts.ReadError as error:
            raise AssertionError(f"what was written is refused: {error}") from error
        require_same(road, back, 1e-8 * size)
        damaged = damage(path, case["damage"])
        path.write_text(damaged, encoding="utf-8")
        try:
            other = ts.read_alignment(path)
        except ts.TinsmithError:
            return "damage refused"
    return "damage harmless" if math.isfinite(other.length) else "damage"


def require_reason(sentence: str) -> str:
    """Only a transition that turns to both sides, and is no clothoid, has no place in LandXML."""
    if "both sides" not in sentence:
        raise AssertionError(sentence)
    return "refused: both sides"


def require_stations(road: ts.Alignment, points: Any, rounding: float) -> None:
    """No place of a fine search is nearer, and stations lead back to the points."""
    table = road.stations_of(points)
    steps = np.linspace(road.start, road.end, 1001)
    places = road.points_at(steps)
    for row, point in enumerate(points):
        nearest = float(np.hypot(*(places - point).T).min())
        if math.isnan(table["station"][row]):
            ends = np.hypot(*(places[[0, -1]] - point).T)
            assert ends.min() <= nearest + rounding + 1e-6, (point, ends, nearest)
            continue
        offset = float(table["offset"][row])
        assert abs(offset) <= nearest + rounding, (point, offset, nearest)


def require_same(road: ts.Alignment, back: ts.Alignment, rounding: float) -> None:
    """Both are the same curve."""
    at = np.linspace(0.0, 1.0, 101)
    own = road.points_at(road.start + at * road.length)
    other = back.points_at(np.minimum(back.start + at * back.length, back.end))
    assert abs(road.length - back.length) <= rounding, (road.length, back.length)
    assert np.abs(own - other).max() <= max(rounding, 1e-7), np.abs(own - other).max()


def damage(path: Path, shares: list[float]) -> str:
    """Return the text of a file in which one number is another."""
    text = path.read_text(encoding="utf-8")
    numbers = list(re.finditer(r"-?\d+\.\d+(?:e[-+]?\d+)?", text))
    chosen = numbers[int(shares[0] * len(numbers)) % len(numbers)]
    words = ("0.0", "-1.0", "1e300", "nan", "INF", "", "12.5", "1 2")
    return text[: chosen.start()] + words[int(shares[1] * 8) % 8] + text[chosen.end() :]


CAMPAIGNS = (
    Campaign("alignments", "axes of any elements: stations, LandXML, damage", generate, examine),
)
