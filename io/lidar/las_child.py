"""Points of a lidar file through laspy, as the child process reads them: chunk after chunk."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np

from ...base.sentences import FILE, inflect
from ..isolated import Answer, Refusal

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
    the attributes by their names, ``range``, the first point of the chunk in the file and the one
    behind its last, ``span``, the bounds of all its points, and ``kept``, which of them are taken,
    if not all are.
    """
    done = end = 0
    for points in _prefetch(_iterate_chunks(path, wanted)):
        answer, done = _select(points, wanted, done)
        start, end = end, end + len(points)
        answer.arrays["range"] = np.array([start, end], np.int64)
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


# ------------------------------------------------------------------------------ boxes


class _Nodes(NamedTuple):
    """The nodes of an octree that hold points, in the order of the file."""

    offsets: Any
    sizes: Any
    counts: Any
    """Each (n,) int64: the first byte, how many bytes, and how many points."""
    starts: Any
    """(n,) int64, number of the first point in the file."""
    lows: Any
    highs: Any
    """Both (n, 2), the sides of the nodes in the plane."""


def read_nodes(path: str, *, wanted: dict[str, Any], box: list[float]) -> Iterator[Answer]:
    """Yield the points of an octree in a box, as :func:`read_points`, in the order of the file.

    The arrays hold ``rows``, the number of each point in the file.
    """
    import laspy

    with open(path, "rb") as file:  # noqa: PTH123 - laspy takes a file
        state = os.fstat(file.fileno())
        reader = laspy.CopcReader(file, close_fd=False)
        reader.decompression_selection = _choose_fields(wanted).to_lazrs()
        _require_attributes(reader.header, wanted)
        nodes = _list_nodes(reader, (path, state.st_size, state.st_mtime_ns))
        slack = np.abs(reader.header.scales[:2])
        is_met = ((nodes.lows - slack <= box[2:]) & (nodes.highs + slack >= box[:2])).all(axis=1)
        chosen = np.flatnonzero(is_met)
        groups = np.cumsum(nodes.counts[chosen]) // _CHUNK
        for group in np.unique(groups):
            some = chosen[groups == group]
            points = _decompress(reader, nodes, some)
            _require_inside(points, nodes, some, slack)
            yield _select_in_box(points, wanted, box, _number_points(nodes, some))


def _list_nodes(reader: Any, key: tuple[str, int, int]) -> _Nodes:
    """Return the nodes of an octree; those of the file that was asked for last are kept."""
    import laspy

    if key not in _LAST_NODES:
        _LAST_NODES.clear()
        found = laspy.copc.load_octree_for_query(reader.source, reader.copc_info, reader.root_page)
        full = sorted((one for one in found if one.point_count), key=lambda one: one.offset)
        counts = np.array([one.point_count for one in full], np.int64)
        if counts.sum() != reader.header.point_count:
            raise Refusal(
                f"{FILE} is damaged: its octree has {counts.sum():,} points, and the header tells "
                f"of {reader.header.point_count:,}."
            )
        _LAST_NODES[key] = _Nodes(
            np.array([one.offset for one in full], np.int64),
            np.array([one.byte_size for one in full], np.int64),
            counts,
            np.cumsum(counts) - counts,
            np.array([one.bounds.mins[:2] for one in full]).reshape(-1, 2),
            np.array([one.bounds.maxs[:2] for one in full]).reshape(-1, 2),
        )
    return _LAST_NODES[key]


_LAST_NODES: dict[tuple[str, int, int], _Nodes] = {}


def _decompress(reader: Any, nodes: _Nodes, some: Any) -> Any:
    """Return the points of some nodes."""
    import laspy
    import lazrs

    header = reader.header
    content = bytearray()
    for offset, size in zip(nodes.offsets[some].tolist(), nodes.sizes[some].tolist(), strict=True):
        reader.source.seek(offset)
        content += reader.source.read(size)
    counts = nodes.counts[some]
    target = np.zeros(int(counts.sum()) * header.point_format.size, np.uint8)
    table = list(zip(counts.tolist(), nodes.sizes[some].tolist(), strict=True))
    lazrs.decompress_points_with_chunk_table(
        content, reader.laszip_vlr.record_data, target, table, reader.decompression_selection
    )
    records = laspy.PackedPointRecord.from_buffer(target, header.point_format)
    return laspy.ScaleAwarePointRecord(
        records.array, records.point_format, header.scales, header.offsets
    )


def _number_points(nodes: _Nodes, some: Any) -> Any:
    """Return the number in the file of each point of some nodes."""
    counts = nodes.counts[some]
    behind = np.repeat(nodes.starts[some] - (np.cumsum(counts) - counts), counts)
    return np.arange(counts.sum()) + behind


def _require_inside(points: Any, nodes: _Nodes, some: Any, slack: Any) -> None:
    """Refuse points that do not lie in their node: others may be missing then."""
    xy = np.stack([np.asarray(points["x"]), np.asarray(points["y"])], axis=1)
    low = np.repeat(nodes.lows[some] - slack, nodes.counts[some], axis=0)
    high = np.repeat(nodes.highs[some] + slack, nodes.counts[some], axis=0)
    outside = ((xy < low) | (xy > high)).any(axis=1)
    if outside.any():
        row = int(_number_points(nodes, some)[np.argmax(outside)])
        raise Refusal(
            f"{FILE} is damaged: point {row} lies outside of the node of the octree that it is in."
        )


def _select_in_box(points: Any, wanted: dict[str, Any], box: list[float], rows: Any) -> Answer:
    keep, counts, classes = _choose_points(points, points.array, wanted)
    keep &= _test_window(points, box)
    xyz = np.stack([points.array[axis][keep] for axis in "XYZ"], axis=1)
    arrays = {"xyz": xyz, "classes": classes, "rows": rows[keep]}
    return Answer(counts, arrays | _gather_attributes(points, wanted, keep))


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
    arrays = {"xyz": xyz, "classes": classes, "span": _find_span(record)}
    if not isinstance(keep, slice):
        arrays["kept"] = (np.flatnonzero(keep) if keep.dtype == bool else keep).astype(np.int32)
    return Answer(counts, arrays | _gather_attributes(points, wanted, keep)), done


def _find_span(record: Any) -> Any:
    """Return the least and the greatest coordinates of all points, taken or not, (2, 3) int32."""
    if not len(record):
        return np.empty((0, 3), np.int32)
    return np.array([[find(record[axis]) for axis in "XYZ"] for find in (np.min, np.max)], np.int32)


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
