"""Campaign: figures that are known, written in every style of field codes, and read back."""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

CODES = ("EP", "TOB", "FL", "WALL", "BLDG", "KERB")
REMARKS = ("", "", "", ' "NOTE"', ", SEALED", " / SEE SKETCH", "; 12", " (OLD)")
# By style: begin, end, close, begin and end of a curve, and what stands before each word.
WORDS: dict[str, tuple[tuple[str, ...], ...]] = {
    "words": (("B", "BEG", "ST"), ("E", "END"), ("C", "CLS", "X"), ("BC", "PC"), ("EC", "PT")),
    "civil3d": (("B", "BEG"), ("E", "END"), ("CLS",), ("BC",), ("EC",)),
    "carlson": (("BEG", "+7"), ("END", "-7"), ("CLO",), ("PC",), ("PT",)),
    "trimble": (("ST", "B"), ("END", "E"), ("CLOSE",), ("SC", "SA"), ("EC", "EA")),
    "leica": (("N",), (), ("P",), ("CS", "TS"), ("CE", "TE")),
    "cg": (("BL",), ("EL",), ("CL",), ("PC",), ("PT",)),
    "star": (("*",), ("E",), ("C",), ("BC",), ("EC",)),
    "star-end": (("B",), ("*",), ("C",), ("BC",), ("EC",)),
}
for _name in ("dash", "slash", "dot"):
    WORDS[_name] = WORDS["words"]
SEPARATORS = {"dash": "-", "slash": "/", "dot": "."}
RADIUS = 40.0


def pick(rng: np.random.Generator, items: Any) -> Any:
    return items[int(rng.integers(len(items)))]


def generate(rng: np.random.Generator) -> Case:
    style = pick(rng, sorted(WORDS))
    figures = [figure(rng, style) for _ in range(int(rng.integers(1, 6)))]
    order = [k for k, one in enumerate(figures) for _ in one["shots"]]
    order = [int(k) for k in rng.permutation(order)] if rng.random() < 0.6 else order
    return {
        "style": style,
        "figures": figures,
        "order": apart(figures, order),
        "seed": int(rng.integers(1 << 30)),
    }


def figure(rng: np.random.Generator, style: str) -> dict[str, Any]:
    """Return a figure: its name, shots, and where its curve begins and ends."""
    is_closed = bool(rng.random() < 0.3)
    count = int(rng.integers(3 if is_closed else 2, 8))
    curve: list[int] = []
    if count >= 3 and rng.random() < 0.4:
        first = int(rng.integers(count - 2))
        curve = [first, int(rng.integers(first + 2, count))]
    centre = rng.uniform([752_000, 4_024_000], [753_000, 4_025_000]).round(3)
    turns = np.sort(rng.uniform(0, 5.5, count)) + np.arange(count) * 0.05
    xy = centre + RADIUS * np.column_stack([np.cos(turns), np.sin(turns)])
    z = rng.uniform(300, 310, count).round(3)
    return {
        "code": pick(rng, CODES),
        "number": str(rng.integers(1, 4)) if rng.random() < 0.8 else "",
        "is_closed": is_closed,
        "curve": curve,
        "centre": centre.tolist(),
        "shots": np.column_stack([xy, z]).tolist(),
        "style": style,
    }


def apart(figures: list[dict[str, Any]], order: list[int]) -> list[int]:
    """Let figures of one name follow each other, whole."""
    names = [one["code"] + one["number"] for one in figures]
    turn = {name: [k for k, other in enumerate(names) if other == name] for name in names}
    left = {k: len(one["shots"]) for k, one in enumerate(figures)}
    found = []
    for k in order:
        queue = turn[names[k]]
        found.append(queue[0])
        left[queue[0]] -= 1
        if left[queue[0]] == 0:
            queue.pop(0)
    return found


def write(case: Case) -> tuple[np.ndarray, list[str], list[list[int]]]:
    """Return points, descriptions, and the rows of each figure."""
    rng = np.random.default_rng(case["seed"])
    at = [0] * len(case["figures"])
    points, texts = [], []
    rows: list[list[int]] = [[] for _ in case["figures"]]
    for k in case["order"]:
        one = case["figures"][k]
        place, text = one["shots"][at[k]], describe(rng, one, at[k])
        rows[k].append(len(points))
        points.append(place)
        texts.append(text + pick(rng, REMARKS))
        at[k] += 1
    for i, text in enumerate(texts):
        if rng.random() < 0.1:
            texts[i] = text.lower()
    return np.array(points), texts, rows


def describe(rng: np.random.Generator, one: dict[str, Any], at: int) -> str:
    """Write the code of a shot with its marks; the first always begins a line."""
    begins, ends, closes, bends, unbends = WORDS[one["style"]]
    last = at == len(one["shots"]) - 1
    beside = " " if one["number"] and rng.random() < 0.2 else ""
    words = [pick(rng, begins)] if at == 0 else []
    if one["curve"] and at == one["curve"][1]:
        words.append(pick(rng, unbends))
    if one["curve"] and at == one["curve"][0]:
        words.append(pick(rng, bends))
    if last and one["is_closed"]:
        words.append(pick(rng, closes))
    elif last and ends:
        words.append(pick(rng, ends))
    separator = SEPARATORS.get(one["style"], " ")
    return one["code"] + beside + one["number"] + "".join(separator + word for word in words)


def examine(case: Case) -> str:
    points, texts, rows = write(case)
    survey = ts.Survey(
        points=points, attributes={"description": np.array(texts, object)}, crs="EPSG:32616"
    )
    named = ts.lines_from_codes(survey, code_style=case["style"])
    expect(case, points, rows, named)
    try:
        found = ts.lines_from_codes(survey)
    except ts.LinesError as error:
        return _require_doubt(str(error))
    expect(case, points, rows, found)
    return "read"


def _require_doubt(message: str) -> str:
    assert "two styles" in message, message
    assert message.endswith("."), message
    return "refused"


def expect(case: Case, points: np.ndarray, rows: list[list[int]], found: ts.Survey) -> None:
    """Require the lines of the figures, in the order of their first shots."""
    assert np.array_equal(found.points, points)
    first = sorted(range(len(rows)), key=lambda k: rows[k][0])
    lines = list(found.breaklines)
    assert len(lines) == len(rows), (len(lines), len(rows), found.notes)
    for k, line in zip(first, lines, strict=True):
        one = case["figures"][k]
        expect_line(one, points[rows[k]], line)


def expect_line(one: dict[str, Any], shots: np.ndarray, line: Any) -> None:
    assert line.name == one["code"] + one["number"]
    whole = np.vstack([shots, shots[:1]]) if one["is_closed"] else shots
    coords = line.coords
    at = [int(np.flatnonzero((coords == shot).all(axis=1))[0]) for shot in shots]
    assert at == sorted(at)
    if not one["curve"]:
        assert np.array_equal(coords, whole)
        return
    begin, end = (at[i] for i in one["curve"])
    straight = np.vstack([coords[: begin + 1], coords[end:]])
    first, last = one["curve"]
    assert np.array_equal(straight, np.vstack([whole[: first + 1], whole[last:]]))
    arc = coords[begin : end + 1, :2] - one["centre"]
    assert np.abs(np.hypot(*arc.T) - RADIUS).max() < 1e-4
    middles = (arc[1:] + arc[:-1]) / 2
    assert (RADIUS - np.hypot(*middles.T)).max() < 0.0101
    turns = np.diff(np.unwrap(np.arctan2(arc[:, 1], arc[:, 0])))
    assert (turns > 0).all()


CAMPAIGNS = (
    Campaign(
        "field codes",
        "known figures in every style of field codes, found out and named",
        generate,
        examine,
    ),
)
