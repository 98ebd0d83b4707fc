"""Campaign: records of a CRS in LAS files, right, contradicting, user-defined, damaged.

What the records name alone is found; two that disagree are refused; nothing foreign is raised.
"""

from __future__ import annotations

import struct
import tempfile
from pathlib import Path
from typing import Any

import laspy
import numpy as np
import pyproj

import tinsmith as ts

from .campaign import Campaign, Case
from .samples import MEMORY

CODES = (32616, 26916, 2274, 2180, 27700, 5513, 4326, 32767, 0, 65000)
VERTICALS = (0, 5703, 6360, 32767)
UNITS = (0, 9001, 9002, 9003, 9999)
TEXTS = ("", "none", "damaged", "WKT1_GDAL", "WKT2_2019", "WKT1_ESRI", "local")
LOCAL = (
    'ENGCRS["Site grid",EDATUM["Site datum"],CS[Cartesian,2],AXIS["easting",east],'
    'AXIS["northing",north],LENGTHUNIT["metre",1]]'
)


def pick(rng: np.random.Generator, items: Any) -> Any:
    return items[int(rng.integers(len(items)))]


def generate(rng: np.random.Generator) -> Case:
    return {
        "code": pick(rng, CODES),
        "text_code": pick(rng, (32616, 32616, 2274, 26916)),
        "vertical": pick(rng, VERTICALS),
        "unit": pick(rng, UNITS),
        "vertical_unit": pick(rng, UNITS),
        "has_keys": bool(rng.random() < 0.7),
        "text": pick(rng, TEXTS),
        "cut": int(rng.integers(0, 40)) if rng.random() < 0.15 else -1,
        "declared": bool(rng.random() < 0.3),
        "version": pick(rng, ("1.2", "1.4")),
    }


def write(case: Case, path: Path) -> None:
    form = 1 if case["version"] == "1.2" else 6
    header = laspy.LasHeader(point_format=form, version=case["version"])
    header.scales, header.offsets = np.full(3, 0.001), np.array([752_700, 4_024_200, 300.0])
    if case["has_keys"]:
        header.vlrs.append(laspy.VLR("LASF_Projection", 34735, "", pack_keys(case)))
    if text := make_text(case):
        header.vlrs.append(laspy.VLR("LASF_Projection", 2112, "", text))
    cloud = laspy.LasData(header)
    rng = np.random.default_rng(1)
    cloud.x, cloud.y, cloud.z = (rng.random((9, 3)) * 50 + header.offsets).T
    cloud.write(str(path))


def pack_keys(case: Case) -> bytes:
    is_geographic = case["code"] == 4326
    keys = [(1024, 2 if is_geographic else 1), (2048 if is_geographic else 3072, case["code"])]
    more = ((3076, case["unit"]), (4096, case["vertical"]), (4099, case["vertical_unit"]))
    keys += [(key, value) for key, value in more if value]
    rows = b"".join(struct.pack("<4H", key, 0, 1, value) for key, value in keys)
    content = struct.pack("<4H", 1, 1, 0, len(keys)) + rows
    return content if case["cut"] < 0 else content[: case["cut"]]


def make_text(case: Case) -> bytes:
    kind = case["text"]
    if kind in ("", "none"):
        return b"" if kind == "" else b"\0"
    if kind == "local":
        return LOCAL.encode() + b"\0"
    text = pyproj.CRS(case["text_code"]).to_wkt("WKT2_2019" if kind == "damaged" else kind)
    return (text[:-30] if kind == "damaged" else text).encode() + b"\0"


def examine(case: Case) -> str:
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        path = Path(folder, "a.las")
        write(case, path)
        try:
            found = ts.read(path, **({"crs": "EPSG:32616"} if case["declared"] else {}))
        except ts.TinsmithError as error:
            return _require_reason(case, str(error))
    if case["declared"]:
        assert found.crs == ts.CRS.of("EPSG:32616")
        return "declared"
    expected = find_plain(case)
    if expected is None:
        return "open"
    if found.crs is None:
        raise AssertionError(f"{expected} is not found: {found.notes}")
    assert found.crs.horizontal.is_same(f"EPSG:{expected}"), (str(found.crs), expected)
    return "found"


def _require_reason(case: Case, message: str) -> str:
    assert message.endswith("."), message
    assert not is_plain(case), message
    return "refused"


def find_plain(case: Case) -> int | None:
    """Return the code that a file names alone and without a fault."""
    has_text = case["text"] in ("WKT1_GDAL", "WKT2_2019", "WKT1_ESRI")
    is_silent = case["text"] in ("", "none")
    if has_text and not case["has_keys"]:
        return case["text_code"]
    if case["has_keys"] and is_silent and case["cut"] < 0 and case["code"] in CODES[:6]:
        return case["code"]
    if has_text and case["has_keys"] and case["cut"] < 0 and case["code"] == case["text_code"]:
        return case["code"]
    return None


def is_plain(case: Case) -> bool:
    """Whether nothing speaks against reading the points where they are."""
    code = find_plain(case)
    has_units = case["has_keys"] and (case["unit"] or case["vertical_unit"] or case["vertical"])
    return code == 32616 and not has_units


CAMPAIGNS = (
    Campaign(
        "LAS CRS", "records of a CRS in LAS files, contradicting and damaged", generate, examine
    ),
)
