"""Campaign: files of points in chunks beside the same files read at once.

The same bits, rows, CRS, unit and counts, or a refusal of both. Of a text larger than a block the
stream alone may refuse what its head does not show.
"""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.io.delimited import survey_text
from tinsmith.io.raster import reading
from tinsmith.io.streaming import stream_points

from .campaign import Campaign, Case

KINDS = ("text", "text", "text", "las", "raster")
SITE = np.array([752_640.0, 4_024_180.0, 300.0])
DAMAGES = (
    *("", "", "", "", "blank", "comment", "short row", "long row", "text", "nan", "inf", "no end"),
    *("quote", "header again", "no elevation", "group", "letter", "western", "far", "-9999"),
)


def generate(rng: np.random.Generator) -> Case:
    return {
        "kind": str(rng.choice(KINDS)),
        "seed": int(rng.integers(2**31)),
        "count": int(rng.integers(1, 400)),
        "block": int(rng.integers(200, 6000)),
        "chunk": int(rng.choice([1, 7, 50, 1000])),
        "delimiter": str(rng.choice([",", ";", " ", "\t"])),
        "comma": bool(rng.random() < 0.2),
        "header": bool(rng.random() < 0.6),
        "damages": [[str(rng.choice(DAMAGES)), float(rng.random())] for _ in range(2)],
        "skip_bad": bool(rng.random() < 0.4),
        "crs": [None, "EPSG:32616", "EPSG:2274"][int(rng.integers(3))],
        "every": int(rng.integers(1, 4)),
        "ends": str(rng.choice(["\n", "\r\n", "\r"])),
    }


def write_text(case: Case, path: Path) -> dict[str, Any]:
    rng = np.random.default_rng(case["seed"])
    points = SITE + rng.random((case["count"], 3)) * (200, 100, 30)
    delimiter = ";" if case["comma"] else case["delimiter"]
    rows = [
        delimiter.join([*(f"{one:.3f}" for one in row), f"tree{k % 7}"])
        for k, row in enumerate(points.tolist())
    ]
    if case["comma"]:
        rows = [row.replace(".", ",") for row in rows]
    if case["header"]:
        rows[:0] = [delimiter.join(["easting", "northing", "elevation", "code"])]
    end = case["ends"]
    for what, share in case["damages"]:
        at = min(len(rows) - 1, max(int(share * len(rows)), int(case["header"])))
        rows[at : at + 1] = damage(what, rows[at], rows[0], delimiter)
        end = "" if what == "no end" else end
    text = case["ends"].join(rows) + end
    is_western = any(what == "western" for what, _ in case["damages"])
    path.write_bytes(text.encode("cp1252" if is_western else "utf-8"))
    options = {"skip_bad": case["skip_bad"], "crs": case["crs"]}
    if case["crs"] == "EPSG:2274":
        options["source_crs"] = "EPSG:32616"
    return options if case["header"] else options | {"columns": "ENZD"}


def damage(what: str, row: str, head: str, delimiter: str) -> list[str]:
    cells = row.split(delimiter)
    changed = {
        "blank": ["", row],
        "comment": ["# a comment", row],
        "short row": [delimiter.join(cells[:2])],
        "long row": [delimiter.join([*cells, "1", "2"])],
        "header again": [head, row],
        "quote": [delimiter.join([*cells[:3], '"open'])],
        "letter": [row + "ä"],
        "western": [row + "ä"],
    }
    values = {
        "text": (0, "east"),
        "nan": (1, "nan"),
        "inf": (2, "inf"),
        "no elevation": (2, ""),
        "group": (0, "752,700"),
        "far": (1, "9000000.0"),
        "-9999": (2, "-9999"),
    }
    if what in values and len(cells) > 2:
        at, value = values[what]
        cells[at] = value
        return [delimiter.join(cells)]
    return changed.get(what, [row])


def write_las(case: Case, path: Path) -> dict[str, Any]:
    rng = np.random.default_rng(case["seed"])
    points = SITE + rng.random((case["count"], 3)) * (200, 100, 30)
    classes = rng.choice([1, 2, 7], case["count"]).astype(np.uint8)
    survey = ts.Survey(points=points, attributes={"classification": classes}, crs="EPSG:32616")
    ts.write(survey, path)
    if case["damages"][0][0] == "no end":
        path.write_bytes(path.read_bytes()[: -(case["count"] % 60) - 1])
    return {
        "crs": case["crs"],
        "every": case["every"],
        "classes": [None, 2, [1, 7]][case["count"] % 3],
    }


def write_raster(case: Case, path: Path) -> dict[str, Any]:
    import rasterio

    rng = np.random.default_rng(case["seed"])
    shape = (int(rng.integers(2, 30)), int(rng.integers(2, 30)))
    heights = np.round(300 + rng.normal(size=shape), 2)
    heights[rng.random(shape) < rng.choice([0, 0, 0.1, 0.9, 1])] = -9999
    transform = rasterio.Affine(2.0, 0, SITE[0], 0, -2.0, SITE[1])
    how = {"driver": "GTiff", "height": shape[0], "width": shape[1], "count": 1, "dtype": "float64"}
    nodata = -9999 if case["header"] else None
    with rasterio.open(path, "w", crs="EPSG:32616", transform=transform, nodata=nodata, **how) as d:
        d.write(heights, 1)
    return {"crs": case["crs"], "fill": case["skip_bad"], "stride": case["every"]}


WRITERS = {
    "text": (write_text, ".csv"),
    "las": (write_las, ".laz"),
    "raster": (write_raster, ".tif"),
}


def examine(case: Case) -> str:
    before = survey_text.BLOCK_BYTES, reading._STRIP_CELLS
    survey_text.BLOCK_BYTES = case["block"]
    reading._STRIP_CELLS = max(1, case["block"] // 20)
    try:
        with tempfile.TemporaryDirectory() as folder:
            writer, suffix = WRITERS[case["kind"]]
            path = Path(folder, f"points{suffix}")
            return compare(path, writer(case, path), case)
    finally:
        survey_text.BLOCK_BYTES, reading._STRIP_CELLS = before


def compare(path: Path, options: dict[str, Any], case: Case) -> str:
    is_one_block = case["kind"] != "text" or path.stat().st_size <= 2 * case["block"]
    whole, found = try_read(path, options), try_stream(path, options, case)
    if isinstance(whole, ts.TinsmithError):
        assert isinstance(found, ts.TinsmithError), f"the stream takes what read refuses: {whole}"
        if is_one_block:
            assert (type(found), str(found)) == (type(whole), str(whole))
        return f"refused {case['kind']}"
    survey = whole
    if isinstance(found, ts.TinsmithError):
        assert not is_one_block, str(found)
        return "refused by the stream alone"
    chunks, stream = found
    points = np.concatenate([one.points for one in chunks])
    assert points.tobytes() == np.ascontiguousarray(survey.points).tobytes()
    rows = np.concatenate([one.rows for one in chunks])
    assert (np.diff(rows) > 0).all()
    if survey.row_sources is not None:
        assert np.array_equal(rows, survey.row_sources.lines)
    assert (stream.crs, stream.elevation_unit) == (survey.crs, survey.elevation_unit)
    assert stream.skipped == dict(survey.skipped)
    if is_one_block:
        assert stream.notes == list(survey.notes)
    return f"read {case['kind']}"


def try_read(path: Path, options: dict[str, Any]) -> Any:
    try:
        return ts.read_points(path, **options)
    except ts.TinsmithError as error:
        return error


def try_stream(path: Path, options: dict[str, Any], case: Case) -> Any:
    try:
        with stream_points(path, chunk_points=case["chunk"], **options) as stream:
            chunks = list(stream)
    except ts.TinsmithError as error:
        return error
    assert all(len(one) == case["chunk"] for one in chunks[:-1])
    return chunks, stream


CAMPAIGNS = (
    Campaign("streams", "points in chunks are those of the file read at once", generate, examine),
)
