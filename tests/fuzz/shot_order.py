"""Campaign: crews with numbers of their own, codes with and without marks, shots out of order.

The figures are known: what is read is them, or is refused, or is told as jumping or crossing.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import shapely

import tinsmith as ts

from .campaign import Campaign, Case

CODES = ("EP", "TOB", "WALL")
TOLD = ("line that jumps", "line that crosses itself")


def pick(rng: np.random.Generator, items: Any) -> Any:
    return items[int(rng.integers(len(items)))]


def generate(rng: np.random.Generator) -> Case:
    """Make crews with figures far apart, each in its own numbers."""
    crews = []
    for k in range(int(rng.integers(1, 4))):
        sites = np.add([[0, 0], [500, 0], [0, 500]], [700_000 + 3000 * k, 4_000_000])
        crews.append([make_figure(rng, site) for site in sites[: int(rng.integers(1, 4))]])
    return {
        "crews": crews,
        "has_numbers": bool(rng.random() < 0.8),
        "goes_on": bool(rng.random() < 0.5),  # numbers go on from crew to crew
        "has_marks": bool(rng.random() < 0.6),
        "shuffled": bool(rng.random() < 0.3),
        "order": pick(rng, [None, None, None, "number", "row"]),
        "seed": int(rng.integers(1 << 30)),
    }


def make_figure(rng: np.random.Generator, site: Any) -> dict[str, Any]:
    """Make shots along a bent line in even steps, or here and there, so that their line crosses."""
    count = int(rng.integers(3, 9))
    turn = np.cumsum(rng.uniform(-0.4, 0.4, count)) + rng.uniform(0, 6)
    steps = rng.uniform(4, 8, count)[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    along = np.cumsum(steps, axis=0) if rng.random() < 0.8 else rng.uniform(0, 40, (count, 2))
    xy = (site + rng.uniform(0, 200, 2) + along).round(3)
    return {"name": pick(rng, CODES) + str(rng.integers(1, 3)), "shots": xy.tolist()}


def write(case: Case) -> tuple[ts.Survey, list[Any]]:
    """Return the survey, and the lines that were shot."""
    rows: list[tuple[int, str, list[float]]] = []
    truth = []
    number = 1
    for crew in case["crews"]:
        number = number if case["goes_on"] else 1
        for one in crew:
            shots = one["shots"]
            truth.append((one["name"], shots))
            for k, place in enumerate(shots):
                mark = {0: " BEG", len(shots) - 1: " END"}.get(k, "") if case["has_marks"] else ""
                rows.append((number, one["name"] + mark, place))
                number += 1
    if case["shuffled"] and case["has_numbers"]:
        order = np.random.default_rng(case["seed"]).permutation(len(rows))
        rows = [rows[int(k)] for k in order]
    attributes: dict[str, Any] = {"description": np.array([row[1] for row in rows], object)}
    if case["has_numbers"]:
        attributes["number"] = np.array([row[0] for row in rows])
    points = [[*row[2], 100.0] for row in rows]
    return ts.Survey(points=points, attributes=attributes), truth


def examine(case: Case) -> str:
    survey, truth = write(case)
    try:
        found = ts.lines_from_codes(
            survey, shot_order=case["order"] if case["has_numbers"] else None
        )
    except ts.LinesError as error:
        message = str(error)
        assert case["order"] is None or not case["has_numbers"], message
        assert message.endswith("."), message
        assert "shot_order" in message, message
        assert is_doubtful(case), message
        return "refused"
    lines = [(line.name, line.coords[:, :2].tolist()) for line in found.breaklines]
    told = {finding.kind for finding in found.findings} & {*TOLD, "line without an end"}
    if not all(shapely.is_simple(shapely.linestrings(coords)) for _, coords in lines):
        assert "line that crosses itself" in told
    if sorted(lines) == sorted(truth):
        return "read"
    assert told or case["order"], (lines, truth)
    return "told" if told else "as ordered"


def is_doubtful(case: Case) -> bool:
    """Whether lines may be others than those that were shot."""
    return (
        not case["has_marks"]
        or (case["has_numbers"] and not case["goes_on"])
        or (case["shuffled"] and case["has_numbers"])
    )


CAMPAIGNS = (
    Campaign(
        "shot order",
        "crews with repeated numbers, codes without marks: lines as shot, refused, or told",
        generate,
        examine,
    ),
)
