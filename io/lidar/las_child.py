"""Points of a lidar file through laspy, as the child process reads them: chunk after chunk."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ...base.sentences import FILE, inflect
from ..isolated import Answer, Refusal

__all__ = ["ENVIRONMENT", "prepare", "read_points"]

_MOST_THREADS = 8
"""Each reserves some memory of its own, and there is a limit for all of them."""

ENVIRONMENT = {"RAYON_NUM_THREADS": str(min(_MOST_THREADS, os.cpu_count() or 1))}

_CHUNK = 500_000
"""Points at a time: ten chunks of the usual compressed file, for every core some."""

_FEW = 100_000
"""Points that one core decompresses sooner than several would start."""

_LAYERED = 6
"""The first format of points whose attributes are decompressed one by one."""

_SELECTIONS = {
    "classification": "decompress_classification",
    "intensity": "decompress_intensity",
    "gps_time": "decompress_gps_time",
    "scan_angle": "decompress_scan_angle",
    "user_data": "decompress_user_data",
    "point_source_id": "decompress_point_source_id",
}


def prepare() -> None:
    """Load the library."""
    import laspy  # noqa: F401 - loaded here, before memory is limited


def read_points(path: str, *, wanted: dict[str, Any]) -> Iterator[Answer]:
    """Yield the points of a file that are wanted, as whole numbers, with their attributes.

    ``wanted`` is a Selection as it is sent. The value counts why points were left out, as
    :class:`Tally`. The arrays hold ``xyz``, (n, 3) int32, ``classes``, the points of each class,
    and the attributes by their names.
    """
    done = 0
    for points in _prefetch(_iterate_chunks(path, wanted)):
        answer, done = _select(points, wanted, done)
        yield answer


def _prefetch(chunks: Iterator[Any]) -> Iterator[Any]:
    """Yield chunks while a thread decompresses the one behind."""
    with ThreadPoolExecutor(1) as thread:
        coming = thread.submit(next, chunks, None)
        while (points := coming.result()) is not None:
            coming = thread.submit(next, chunks, None)
            yield points


def _iterate_chunks(path: str, wanted: dict[str, Any]) -> Iterator[Any]:
    import laspy

    with open(path, "rb") as file:  # noqa: PTH123 - laspy takes a file
        selection = _choose_fields(wanted)
        reader = laspy.LasReader(file, closefd=False, read_evlrs=False)
        is_octree = any(type(one).__name__ == "CopcInfoVlr" for one in reader.header.vlrs)
        is_layered = reader.header.point_format.id >= _LAYERED
        _require_attributes(reader.header, wanted)
        file.seek(0)
        if is_octree and (wanted["window"] is not None or wanted["resolution"] is not None):
            yield from _iterate_levels(laspy.CopcReader(file), wanted, selection)
            return
        backends = laspy.LazBackend
        few = reader.header.point_count <= _FEW
        reader = laspy.LasReader(
            file,
            closefd=False,
            laz_backend=backends.Lazrs if few else backends.LazrsParallel,
            read_evlrs=False,
            decompression_selection=selection if is_layered else laspy.DecompressionSelection.all(),
        )
        left = reader.header.point_count
        while left > 0:
            points = reader.read_points(_CHUNK)
            if len(points) != min(left, _CHUNK):
                missing = inflect("[is|are] missing", left - len(points))
                raise RuntimeError(f"{left - len(points):,} of its points {missing}")
            left -= len(points)
            yield points


def _choose_fields(wanted: dict[str, Any]) -> Any:
    """Return which fields are to be decompressed, where the format lets them be chosen."""
    import laspy

    names = wanted["attributes"]
    if names is None or not set(names) <= {*_SELECTIONS, "return_number", "number_of_returns"}:
        return laspy.DecompressionSelection.all()
    selection = laspy.DecompressionSelection.base().decompress_z().decompress_flags()
    selection = selection.decompress_classification()
    for name in names:
        if name in _SELECTIONS:
            selection = getattr(selection, _SELECTIONS[name])()
    return selection


def _require_attributes(header: Any, wanted: dict[str, Any]) -> None:
    names = [name for name in header.point_format.dimension_names if name not in "XYZ"]
    for name in wanted["attributes"] or ():
        if name not in names:
            raise Refusal(f"{FILE} has no attribute '{name}': there is {', '.join(names)}, or all.")


def _iterate_levels(reader: Any, wanted: dict[str, Any], selection: Any) -> Iterator[Any]:
    """Yield the points of an octree level after level, down to the one that is fine enough."""
    import laspy

    reader.decompression_selection = selection.to_lazrs()
    header = reader.header
    box = wanted["window"]
    bounds = None
    if box is not None:
        reach = np.abs(header.scales[:2]) * (2.0**31 - 2)
        low, high = header.offsets[:2] - reach, header.offsets[:2] + reach
        bounds = laspy.copc.Bounds(np.clip(box[:2], low, high), np.clip(box[2:], low, high))
        bounds = _add_elevations(bounds, header)
    finest = _find_finest_level(reader, wanted["resolution"])
    level = 0
    while level <= min(finest, max((key.level for key in reader.root_page.entries), default=-1)):
        yield reader.query(bounds=bounds, level=level)
        level += 1


def _add_elevations(bounds: Any, header: Any) -> Any:
    """Let bounds in the plane hold any elevation that can be stored, whatever the header says."""
    import laspy

    reach = abs(header.scales[2]) * (2.0**31 - 2)
    low, high = header.offsets[2] - reach, header.offsets[2] + reach
    return laspy.copc.Bounds(np.append(bounds.mins, low), np.append(bounds.maxs, high))


def _find_finest_level(reader: Any, resolution: float | None) -> float:
    """Return the first level whose points are no further apart than asked for."""
    spacing = float(reader.copc_info.spacing)
    if resolution is None:
        return float("inf")
    if not np.isfinite(spacing) or spacing <= 0:
        raise RuntimeError(f"its octree is said to have the spacing {spacing:g}")
    return max(0.0, float(np.ceil(np.log2(spacing / resolution))))


# -------------------------------------------------------------------------- selection


def _select(points: Any, wanted: dict[str, Any], done: int) -> tuple[Answer, int]:
    """Return what is wanted of a chunk, and how many points were fit for thinning until its end."""
    record = points.array
    keep, counts, classes = _choose_points(points, record, wanted)
    every = wanted["every"]
    if every > 1:
        keep = np.flatnonzero(keep)
        start, fit = -done % every, len(keep)
        keep, done = keep[start::every], done + fit
        counts["thinned"] = fit - len(keep)
    elif keep.all():
        keep = slice(None)
    xyz = np.stack([record[axis][keep] for axis in "XYZ"], axis=1)
    counts |= _count_marks(points, keep)
    arrays = {"xyz": xyz, "classes": classes}
    return Answer(counts, arrays | _gather_attributes(points, wanted, keep)), done


def _choose_points(
    points: Any, record: Any, wanted: dict[str, Any]
) -> tuple[Any, dict[str, int], Any]:
    """Return which points are taken, why others are not, and the points of each class."""
    counts = {}
    keep = np.ones(len(record), bool)
    if not wanted["withheld"]:
        keep = np.asarray(points["withheld"]) == 0
        counts["withheld"] = len(keep) - int(keep.sum())
    kinds = np.asarray(points["classification"])
    classes = np.bincount(kinds if keep.all() else kinds[keep], minlength=256).astype(np.int64)
    tests = {
        "of_other_classes": _test_classes(kinds, wanted["classes"]),
        "of_other_returns": _test_returns(points, wanted["returns"]),
        "outside": _test_window(points, wanted["window"]),
    }
    for name, passes in tests.items():
        if passes is not None:
            counts[name] = int((keep & ~passes).sum())
            keep &= passes
    return keep, counts, classes


def _test_classes(kinds: Any, classes: list[int] | None) -> Any:
    if classes is None:
        return None
    is_wanted = np.zeros(256, bool)
    is_wanted[classes] = True
    return is_wanted[kinds]


def _test_returns(points: Any, returns: list[int | str] | None) -> Any:
    if returns is None:
        return None
    number, total = np.asarray(points["return_number"]), np.asarray(points["number_of_returns"])
    tests = {"first": number == 1, "last": number == total, "only": total == 1}
    passes = np.zeros(len(number), bool)
    for one in returns:
        passes |= tests[one] if isinstance(one, str) else number == one
    return passes


def _test_window(points: Any, box: list[float] | None) -> Any:
    if box is None:
        return None
    x, y = np.asarray(points["x"]), np.asarray(points["y"])
    return (x >= box[0]) & (y >= box[1]) & (x <= box[2]) & (y <= box[3])


def _count_marks(points: Any, keep: Any) -> dict[str, int]:
    """Count the points taken that are marked as synthetic, and as overlap of flight lines."""
    names = points.point_format.dimension_names
    return {
        name: int(np.count_nonzero(np.asarray(points[name])[keep]))
        for name in ("synthetic", "overlap")
        if name in names
    }


def _gather_attributes(points: Any, wanted: dict[str, Any], keep: Any) -> dict[str, Any]:
    """Return attributes; of several numbers a point one for each, ``rgb[0]``, ``rgb[1]`` ..."""
    every = [name for name in points.point_format.dimension_names if name not in "XYZ"]
    names = every if wanted["attributes"] is None else wanted["attributes"]
    found: dict[str, Any] = {}
    for name in names:
        values = _as_plain(np.asarray(points[name]))[keep]
        if values.ndim == 1:
            found[f"attribute {name}"] = values
        else:
            found |= {f"attribute {name}[{k}]": values[:, k] for k in range(values.shape[1])}
    return found


def _as_plain(values: Any) -> Any:
    return values.view(np.uint8) if values.dtype.kind == "b" else values
