"""Campaign: values of any type at every entry point, answered by a sentence or by Python's call."""

from __future__ import annotations

import inspect
import warnings
from decimal import Decimal
from typing import Any

import numpy as np

import tinsmith as ts

from .campaign import Campaign, Case

XYZ = [[0, 0, 1], [4, 0, 2], [4, 3, 3], [0, 3, 4], [2, 1, 9]]
LINE = [[0, 0, 1], [4, 3, 2]]
RING = [[1, 1], [3, 1], [2, 2]]
TIN = ts.triangulate(XYZ)

# What is given as a value: names, so that a case can be written down.
VALUES: dict[str, Any] = {
    "None": None,
    "True": True,
    "0": 0,
    "1": 1,
    "2": 2,
    "-1": -1,
    "0.5": 0.5,
    "10**30": 10**30,
    "10**400": 10**400,
    "nan": float("nan"),
    "inf": float("inf"),
    "1e300": 1e300,
    "float64": np.float64(0.25),
    "int8": np.int8(-3),
    "complex": 1j,
    "text": "mean",
    "empty text": "",
    "bytes": b"mean",
    "list": [],
    "tuple": (),
    "dict": {},
    "dict of text": {"x": "a"},
    "set": {1},
    "object": object(),
    "class": int,
    "function": abs,  # takes what progress gives
    "xyz": XYZ,
    "array": np.array(XYZ, float),
    "ragged": [[1], [2, 3]],
    "xy": [[1.0, 1.0]],
    "row": [1.0, 1.0, 1.0],
    "numbers": [0, 1],
    "numbers twice": [1, 1],
    "far numbers": [10**30],
    "huge numbers": [10**400],
    "decimals": [Decimal("0.5"), Decimal("sNaN")],
    "0d array": np.array(1.5),
    "0d text": np.array("mean"),
    "objects": np.array([None, 1.0, "a"], object),
    "empty lists": [[], []],
    "date": np.datetime64("2020-01-01"),
    "surrogate": "\ud800",
    "texts": ["a", "b"],
    "flags": [True, False],
    "nans": [[np.nan, 1.0, 2.0]],
    "dates": np.array(["2020-01-01"], "datetime64[D]"),
    "strings": np.array([["a", "b", "c"]]),
    "3d array": np.zeros((2, 2, 2)),
    "no rows": np.zeros((0, 3)),
    "masked": np.ma.masked_array(XYZ, mask=np.eye(5, 3)),
    "line": LINE,
    "lines": [LINE],
    "ring": RING,
    "rings": [RING],
    "nested": [[[[1.0]]]],
    "breakline": ts.Breakline(LINE),
    "breaklines": [ts.Breakline(LINE)],
    "water": ts.Water(RING, 1.0),
    "waters": [ts.Water(RING, 1.0)],
    "survey": ts.Survey(points=np.array(XYZ, float)),
    "bounds": ts.Bounds(0.0, 0.0, 1.0, 1.0),
    "code": "EPSG:32616",
    "other code": "EPSG:2240",
    "format": "ply",
    "shape": (2, 2),
    "kind": "points",
    "xy line": [[1, 1], [3, 2]],
    "columns": {"a": np.arange(5.0)},
    "grids": {"elevation": np.zeros((2, 2))},
    "grid": ts.Grid(ts.Bounds(0.0, 0.0, 2.0, 2.0), (2, 2), 1.0),
    "tin": TIN,
    "features": ts.contours(TIN, interval=1.0),
    "table": ts.profile(TIN, [[1, 1], [3, 2]]),
    "raster": ts.rasterize(TIN, spacing=1.0),
    "difference": ts.difference(TIN, TIN),
    "quality": ts.quality(TIN),
    "comparison": ts.compare(XYZ),
}

READS_OR_SHOWS = {"read", "write", "preview"}  # their own campaigns give them files
FUNCTIONS: dict[str, Any] = {
    name: getattr(ts, name)
    for name in ts.__all__
    if inspect.isfunction(getattr(ts, name)) and name not in READS_OR_SHOWS
} | {
    "Breakline": ts.Breakline,
    "Water": ts.Water,
    "Survey": ts.Survey,
    "Bounds": ts.Bounds,
    "Bounds.of": ts.Bounds.of,
    "Grid": ts.Grid,
    "CRS": ts.CRS,
    "CRS.of": ts.CRS.of,
    "Unit.of": ts.Unit.of,
    "Features": ts.Features,
    "Raster": ts.Raster,
    "Table": ts.Table,
    "from_triangles": ts.TIN.from_triangles,
    "paper.original": ts.tin.paper.original,
    "paper.improved": ts.tin.paper.improved,
}
METHODS = tuple(
    name for name, _ in inspect.getmembers(ts.TIN, inspect.isfunction) if not name.startswith("_")
)
USUAL: dict[str, str] = {  # what is mostly given, so that the rest is reached
    "points": "xyz",
    "tin": "tin",
    "coords": "line",
    "ring": "ring",
    "z": "1",
    "vertex": "2",
    "vertices": "numbers",
    "point": "row",
    "xy": "xy",
    "a": "0",
    "b": "1",
    "number": "0",
    "triangles": "dict",
    "survey": "survey",
    "source": "code",
    "target": "code",
    "crs": "code",
    "value": "code",
    "name": "format",
    "bounds": "bounds",
    "shape": "shape",
    "spacing": "0.5",
    "other": "tin",
    "lines": "features",
    "features": "features",
    "cloud": "xyz",
    "line": "xy line",
    "centreline": "xy line",
    "interval": "0.5",
    "quality": "quality",
    "difference": "difference",
    "comparison": "comparison",
    "table": "table",
    "columns": "columns",
    "bands": "grids",
    "grid": "grid",
    "kind": "kind",
    "coordinates": "xyz",
}


def generate(rng: np.random.Generator) -> Case:
    """Draw an entry point, and a value for some of its parameters."""
    name = str(rng.choice([*FUNCTIONS, *METHODS]))
    function = FUNCTIONS.get(name) or getattr(ts.TIN, name, None)
    arguments: dict[str, str] = {}
    for parameter in inspect.signature(function).parameters.values() if function else ():
        is_needed = parameter.default is parameter.empty
        if parameter.name == "self" or parameter.kind in (2, 4):
            continue
        if is_needed and rng.random() < 0.5 and parameter.name in USUAL:
            arguments[parameter.name] = USUAL[parameter.name]
        elif is_needed or rng.random() < 0.25:
            arguments[parameter.name] = str(rng.choice(list(VALUES)))
    if arguments.get("function") == "class":  # called, int raises: the caller's own error
        arguments["function"] = "function"
    return {"name": name, "arguments": arguments}


def examine(case: Case) -> str:
    """Call it: an answer, or an error of the toolkit of one sentence."""
    name = case["name"]
    call = FUNCTIONS.get(name) or getattr(ts.triangulate(XYZ, breaklines=[LINE]), name)
    arguments = {key: VALUES[value] for key, value in case["arguments"].items()}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            repr(call(**arguments))
        except ts.TinsmithError as error:
            _require_sentence(str(error))
            return f"refused: {name}"
    return f"taken: {name}"


def _require_sentence(text: str) -> None:
    assert text.endswith("."), f"no sentence: {text}"
    for foreign in ("np.float64", "np.int", "Traceback", "\n", "--"):
        assert foreign not in text, f"{foreign!r} in a sentence: {text}"
    assert len(text) < 600, f"a sentence of {len(text)} characters"


CAMPAIGNS = (
    Campaign("arguments", "values of any type at every entry point", generate, examine, 30.0),
)
