"""Campaign: tables of numbers without a header, where the first three need not be x, y, z.

What stands before, behind or in place of coordinates is drawn, and every answer must be the points
or a refusal. Only lists that begin with northing, easting may be read the other way round, as the
convention says.
"""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case
from .delimited import choose, read

PLACES = {
    "local": (None, (5_000.0, 1_000.0)),
    "small": (None, (10.0, 20.0)),
    "utm": ("EPSG:32616", (752_700.0, 4_024_240.0)),
    "japan": ("EPSG:6677", (-12_100.0, -35_100.0)),
    "web": ("EPSG:3857", (-9_370_000.0, 4_340_000.0)),
}
BEFORE = ("", "chainage", "times", "number.part", "number", "whole step", "grid row")
LAYOUTS = ("ENZ", "NEZ", "EN", "NE", "ENP", "ENC", "DMS", "DM")
HEADINGS = ("", "", "", "# survey of the north field", "Job 12")
ORDERS = ("{}", "# {}", "order: {}", "# columns are {}", "{} (m)", "Format {}, 14 points")


def generate(rng: np.random.Generator) -> Case:
    place = choose(rng, tuple(PLACES))
    _, (east, north) = PLACES[place]
    count = int(rng.integers(6, 40))
    points = np.column_stack(
        [
            east + rng.random(count) * 180,
            north + rng.random(count) * 140,
            float(choose(rng, (3.0, 98.0, 320.0))) + rng.random(count) * 6,
        ]
    ).round(3)
    layout = choose(rng, LAYOUTS)
    before = choose(rng, BEFORE) if layout[:1] in "EN" else ""
    heading = choose(rng, HEADINGS)
    if not before and rng.random() < 0.2:  # the order as it is, in words or letters
        word = str(choose(rng, ("", " ", ", ", "/"))).join(layout)
        heading = str(choose(rng, ORDERS)).format(word)
    return {
        "place": place,
        "points": points.tolist(),
        "layout": layout,
        "before": before,
        "first": first_column(rng, before, count),
        "codes": rng.integers(1, 5, count).tolist(),
        "heading": heading,
        "is_told": bool(rng.random() < 0.5),
        "separator": choose(rng, (",", ", ", ";", "\t", " ")),
        "suffix": choose(rng, (".csv", ".txt", ".xyz", ".pts")),
    }


def first_column(rng: np.random.Generator, kind: str, count: int) -> list[str]:
    """Return what stands before the coordinates."""
    rows = np.arange(count)
    start = float(rng.integers(0, 5_000))
    step = float(choose(rng, (1.0, 5.0, 12.5, 20.0)))
    texts = {
        "chainage": [f"{start + step * i:.2f}" for i in rows],
        "times": [f"{t:.2f}" for t in start + np.cumsum(0.3 + 4 * rng.random(count))],
        "number.part": [f"{100 + i // 5}.{i % 5 + 1}" for i in rows],
        "number": [str(one) for one in rng.permutation(rows + int(start))],
        "whole step": [str(int(start) + 10 * i) for i in rows],
        "grid row": [str(i // 4) for i in rows],
    }
    return texts.get(kind, [])


def text_of(case: Case) -> str:
    lines = [case["heading"]] if case["heading"] else []
    for i, (e, n, z) in enumerate(case["points"]):
        cells = {"E": f"{e:.3f}", "N": f"{n:.3f}", "Z": f"{z:.3f}", "P": str(i + 1)}
        cells["C"] = str(case["codes"][i])
        if case["layout"] in ("DMS", "DM"):
            row = angle(36.3 + i / 7e3, case["layout"]) + angle(-84.2 - i / 9e3, case["layout"])
            row.append(cells["Z"])
        else:
            row = [*case["first"][i : i + 1], *(cells[one] for one in case["layout"])]
        lines.append(case["separator"].join(row))
    return "\n".join(lines) + "\n"


def angle(degrees: float, layout: str) -> list[str]:
    whole, rest = divmod(abs(degrees), 1.0)
    minutes, seconds = divmod(rest * 60, 1.0)
    seconds = min(seconds, 0.9999)  # 59.999 at most
    shown = f"{'-' if degrees < 0 else ''}{whole:.0f}"
    if layout == "DM":
        return [shown, f"{rest * 60:.4f}"]
    return [shown, f"{minutes:.0f}", f"{seconds * 60:.3f}"]


def examine(case: Case) -> str:
    crs = PLACES[case["place"]][0]
    options: dict[str, Any] = {"crs": crs} if crs and case["is_told"] else {}
    found = read(text_of(case).encode(), case["suffix"], **options)
    if isinstance(found, ts.TinsmithError):
        assert "\n" not in str(found)
        is_plain = case["layout"] == "ENZ" and not case["before"]
        assert not is_plain, f"x, y, z is refused: {found}"
        return "refused"
    expected = np.array(case["points"])
    assert len(case["layout"]) == 3, f"no elevations, and read: {found.notes}"
    assert case["layout"] in ("ENZ", "NEZ"), f"no elevations, and read: {found.notes}"
    if np.array_equal(found.points, expected):
        return "read"
    assert any("the convention for" in note for note in found.notes), f"wrong: {found.notes}"
    assert case["layout"] == "NEZ", f"wrong by convention: {found.notes}"
    assert not case["before"], f"wrong by convention: {found.notes}"
    assert case["heading"] in HEADINGS, f"the order is named: {found.notes}"
    assert np.array_equal(found.points[:, [1, 0, 2]], expected)
    return "read by custom"


CAMPAIGNS = (
    Campaign(
        "unnamed columns",
        "numbers without a header that need not be x, y, z",
        generate,
        examine,
    ),
)
