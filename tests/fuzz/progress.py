"""Calls that tell how far they are: to a function that listens, and to one that has had enough.

A call that is listened to must return what it returns alone, or be refused with the same sentence.
A function that raises, at any moment and whatever it likes, must be heard: the very exception comes
out, nothing is told after it, what was given stays as it was, and no file is there.
"""

from __future__ import annotations

import tempfile
import warnings
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from support.product_arrays import list_arrays

import tinsmith as ts

from .campaign import Campaign, Case

RING = np.array([[0.2, 0.2], [0.8, 0.2], [0.8, 0.8], [0.5, 0.6], [0.2, 0.8]])
SUFFIXES = (".ply", ".geojson", ".geojsons", ".xyz", ".dxf", ".obj", ".stl", ".2dm", ".gpkg")
ERRORS = (ZeroDivisionError, OSError, ValueError, KeyboardInterrupt, StopIteration)
ERRORS = (*ERRORS, ts.ReadError, ts.WriteError, ts.PointsError, ts.LinesError, ts.CrsError)
CALLS = {
    "triangulate": lambda g, to: ts.triangulate(g["points"], threads=g["threads"], **to),
    "snapped": lambda g, to: ts.triangulate(g["points"], snap=g["size"] / 50, **to),
    "lines": lambda g, to: ts.triangulate(g["points"], boundary=[g["ring"]], **to),
    "refine": lambda g, to: ts.refine(g["tin"], max_area=g["size"] ** 2 / 300, **to),
    "ground": lambda g, to: ts.ground(g["points"], cell=g["size"] / 20, building=g["size"], **to),
    "blunders": lambda g, to: ts.blunders(ts.Survey(points=g["points"]), **to),
    "grade": lambda g, to: ts.grade(g["tin"], g["pad"], 1.0, cut_slope=1, fill_slope=1, **to),
    "simplify": lambda g, to: ts.simplify(g["tin"], tolerance=0.3, **to),
    "viewshed": lambda g, to: ts.viewshed(g["tin"], g["points"][0][:2], eye_height=1, **to),
    "paste": lambda g, to: ts.paste(g["tin"], g["patch"], **to),
    "merge": lambda g, to: ts.merge([g["patch"], g["tin"]], blend=g["size"] / 20, **to),
    "clip": lambda g, to: ts.clip(g["tin"], [g["ring"]], **to),
    "mend_flats": lambda g, to: ts.mend_flats(g["flat"], **to),
    "rasterize": lambda g, to: ts.rasterize(g["tin"], spacing=g["size"] / 30, **to),
    "contours": lambda g, to: ts.contours(g["tin"], 0.4, **to),
    "smooth": lambda g, to: ts.contours(g["tin"], 0.4, smooth=0.1, **to),
    "volume": lambda g, to: ts.volume(g["tin"], g["patch"], regions=[g["pad"]], **to),
    "difference": lambda g, to: ts.difference(g["tin"], g["patch"], **to),
    "catchments": lambda g, to: ts.catchments(g["tin"], **to),
    "flow": lambda g, to: ts.flow_accumulation(g["tin"], fill_depressions=True, **to),
    "read": lambda g, to: ts.read(g["files"], columns=g["columns"], format="delimited", **to),
    "write": lambda g, to: ts.write(g["tin"], g["folder"] / f"made{g['suffix']}", **to),
    "write points": lambda g, to: ts.write(
        ts.Survey(points=g["points"]), g["folder"] / "made.csv", **to
    ),
}


def generate(rng: np.random.Generator) -> Case:
    count = int(rng.integers(3, 60)) if rng.random() < 0.6 else int(rng.integers(60, 3000))
    size = float(rng.choice([1.0, 100.0, 5000.0]))
    points = rng.random((count, 3)) * (size, size, 3.0)
    return {
        "call": str(rng.choice(list(CALLS))),
        "size": size,
        "points": points.round(int(rng.choice([0, 2, 6]))).tolist(),
        "threads": int(rng.integers(1, 4)),
        "error": int(rng.integers(len(ERRORS))),
        "moment": int(rng.integers(100)) if rng.random() < 0.5 else 0,
        "suffix": str(rng.choice(SUFFIXES)),
        "has quotes": bool(rng.random() < 0.4),
        "had file": bool(rng.random() < 0.3),
    }


def examine(case: Case) -> str:
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        given = make_given(case, Path(folder))
        if given is None:
            return "no surface"
        before = measure_given(given)
        plain = call(case, given, None)
        given["made"] = list_files(given["folder"])
        clear(given["folder"], None)
        fractions: list[float] = []
        told = call(case, given, fractions.append)
        require_same(plain, told)
        require_ascending(fractions, is_refused=isinstance(told, ts.TinsmithError))
        require_heard(case, given, fractions)
        require_unchanged(before, measure_given(given))
        return "refused" if isinstance(plain, ts.TinsmithError) else case["call"]


def make_given(case: Case, folder: Path) -> dict[str, Any] | None:
    """Return what the calls take; None if the points have no surface."""
    points = np.array(case["points"], np.float64).reshape(-1, 3)
    size = case["size"]
    try:
        tin = ts.triangulate(points, crs="EPSG:32616")
        flat = ts.triangulate(np.column_stack([points[:, :2], np.floor(points[:, 2])]))
    except ts.TinsmithError:
        return None
    pad = RING * size
    patch = ts.triangulate(np.column_stack([pad, np.full(5, 1.5)]), boundary=[pad], crs=tin.crs)
    texts = [folder / f"{k}.csv" for k in range(2)]
    for k, path in enumerate(texts):
        path.write_text(write_rows(points[k::2], has_quotes=case["has quotes"]), encoding="utf-8")
    out = folder / "out"
    out.mkdir()
    return {
        "points": points,
        "tin": tin,
        "flat": flat,
        "patch": patch,
        "pad": pad,
        "ring": np.column_stack([[[0.0, 0.0], [size, 0.0], [size, size]]]),
        "size": size,
        "threads": case["threads"],
        "suffix": case["suffix"],
        "folder": out,
        "files": texts if len(points) > 1 else texts[:1],
        "columns": "ENZD",
    }


def write_rows(points: Any, *, has_quotes: bool) -> str:
    code = '6" PIPE' if has_quotes else "GS"
    return "".join(f"{x!r},{y!r},{z!r},{code}\n" for x, y, z in points.tolist())


def call(case: Case, given: dict[str, Any], progress: Any) -> Any:
    """Return what a call returns, or the error that refuses it."""
    try:
        return CALLS[case["call"]](given, {} if progress is None else {"progress": progress})
    except ts.TinsmithError as error:
        return error


def measure_given(given: dict[str, Any]) -> list[Any]:
    return [
        given["points"].copy(),
        given["pad"].copy(),
        *(array.copy() for name in ("tin", "flat", "patch") for array in list_arrays(given[name])),
    ]


def require_unchanged(before: list[Any], after: list[Any]) -> None:
    for a, b in zip(before, after, strict=True):
        np.testing.assert_array_equal(a, b, "what was given changed")


def require_same(plain: Any, told: Any) -> None:
    assert type(plain) is type(told), f"{plain!r} alone, {told!r} with progress"
    if isinstance(plain, ts.TinsmithError):
        assert str(plain) == str(told), "another sentence with progress"
    elif isinstance(plain, Path):
        assert plain == told
    else:
        require_unchanged(list_arrays(plain), list_arrays(told))


def require_ascending(fractions: list[float], *, is_refused: bool) -> None:
    assert all(0.0 < a < b for a, b in pairwise(fractions)), f"fractions {fractions}"
    assert (1.0 in fractions) is not is_refused, f"1.0 is told by who is refused: {fractions}"
    assert not fractions or 0.0 < fractions[-1] <= 1.0


def require_heard(case: Case, given: dict[str, Any], fractions: list[float]) -> None:
    """Raise at one of the moments at which something is told."""
    if not fractions:
        return
    raised = ERRORS[case["error"]]("enough")
    moment = case["moment"] % len(fractions)
    told: list[float] = []

    def stop(fraction: float) -> None:
        told.append(fraction)
        if len(told) > moment:
            raise raised

    clear(given["folder"], b"an old file" if case["had file"] else None)
    try:
        call_anew = CALLS[case["call"]](given, {"progress": stop})
    except BaseException as error:
        if error is not raised:
            raise
        assert len(told) == moment + 1, "told after it had raised"
        require_no_file(case, given, is_done=told[-1] == 1.0)
    else:
        # Moments depend on the clock where threads work: there may have been fewer this time.
        assert len(told) <= moment, f"{raised!r} was lost in {call_anew!r}"


def require_no_file(case: Case, given: dict[str, Any], *, is_done: bool) -> None:
    """A file is there as it was, or whole once 1.0 was told."""
    files = list_files(given["folder"])
    if is_done:
        assert given["made"].items() <= files.items(), "a file that is done is not whole"
    elif case["had file"]:
        assert set(files.values()) == {b"an old file"}, f"{sorted(files)}"
    else:
        assert files == {}, f"left behind: {sorted(files)}"


def list_files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def clear(folder: Path, content: bytes | None) -> None:
    """Take away what was made; put an old file in the place of what may be made."""
    names = [path.name for path in folder.iterdir()]
    for name in names:
        (folder / name).unlink()
    for suffix in (*SUFFIXES, ".csv") if content is not None else ():
        (folder / f"made{suffix}").write_bytes(content)


CAMPAIGNS = (
    Campaign("progress", "calls that are listened to, and ended at any moment", generate, examine),
)
