"""The tools that edit a triangulation; building it first is not timed, nor reading it after."""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np

from tinsmith.base.arrays import Float64Array, UInt64Array

from ..datasets.edits import INSERT_ALL, WHAT, EditTask
from ..measure import OURS
from .triangulators import CGAL, Tool

__all__ = ["ALL_EDIT_TOOLS", "BUILD", "EDIT_TOOLS", "OPENED", "WITH_ARRAYS"]

WITH_ARRAYS = "tinsmith, and its arrays"
"""Edits, and the arrays of triangles and neighbours that they lead to."""
OPENED = "tinsmith, opened"
"""First edits, which make the TIN ready for further ones, are not timed."""
BUILD = "tinsmith, building"
"""For comparison: the points of the batch alone, triangulated."""
MORTON_BITS = 16


class _State(NamedTuple):
    made: Any
    calls: list[tuple[str, tuple[Any, ...]]]


# ---------------------------------------------------------------------- tinsmith


def _list_calls(task: EditTask) -> list[tuple[str, tuple[Any, ...]]]:
    """Return the edits as names of methods and their arguments."""
    is_batch = task.script[:, 0] == INSERT_ALL
    calls: list[tuple[str, tuple[Any, ...]]] = [("insert", (task.script[is_batch, 3:],))]
    if not is_batch.any():
        calls.clear()
    for what, _, vertex, *xyz in task.script[~is_batch].tolist():
        arguments = {
            "insert": ([xyz],),
            "remove": (int(vertex),),
            "move": (int(vertex), xyz),
            "set_elevation": (int(vertex), xyz[2]),
        }
        name = WHAT[int(what)]
        calls.append((name, arguments[name]))
    return calls


def _prepare_task(task: EditTask) -> tuple[EditTask, list[tuple[str, tuple[Any, ...]]]]:
    if hasattr(os, "sched_setaffinity"):  # a batch would take every core
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    return task, _list_calls(task)


def _triangulate_first(given: Any) -> _State:
    from tinsmith import triangulate

    task, calls = given
    return _State(triangulate(task.points, threads=1), calls)


def _open_session(given: Any) -> _State:
    state = _triangulate_first(given)
    last = len(state.made.points) - 1
    point = state.made.points[last].tolist()
    state.made.remove(last)
    state.made.insert([point])
    return state


def _edit_one_by_one(state: _State) -> Any:
    for name, arguments in state.calls:
        getattr(state.made, name)(*arguments)
    return state.made


def _edit_and_read(state: _State) -> Any:
    tin = _edit_one_by_one(state)
    assert len(tin.neighbors) == len(tin.triangles)
    return tin


def _build_result(given: Any) -> Any:
    from tinsmith import triangulate

    task, _ = given
    return triangulate(task.script[:, 3:], threads=1)


def _make_own_edit_tool(run: Any, renew: Any = _triangulate_first) -> Tool:
    return Tool(
        module="tinsmith",
        prepare=_prepare_task,
        renew=renew,
        run=run,
        triangles=lambda tin: tin.points[tin.triangles],
        is_exact=True,
    )


# --------------------------------------------------------------------- startinpy


def _sort_for_startinpy(task: EditTask) -> tuple[Float64Array, list[Any], Any]:
    """Sort points along a curve: in random order startinpy takes half a minute a million."""
    order = np.argsort(_encode_morton(task.points[:, :2]))
    ids = np.empty(len(order), np.int64)
    ids[order] = np.arange(1, len(order) + 1)  # 0 is its vertex at infinity
    is_batch = task.script[:, 0] == INSERT_ALL
    batch = task.script[is_batch, 3:]
    edits = [
        (WHAT[int(what)], int(ids[int(number)]), xyz)
        for what, number, _, *xyz in task.script[~is_batch].tolist()
    ]
    return task.points[order], edits, batch[np.argsort(_encode_morton(batch[:, :2]))]


def _encode_morton(xy: Float64Array) -> UInt64Array:
    """Place along a Z-shaped curve through a square about the places."""
    if len(xy) == 0:
        return np.empty(0, np.uint64)
    span = np.ptp(xy, axis=0).max()
    x, y = ((xy - xy.min(axis=0)) / span * (2**MORTON_BITS - 1)).astype(np.uint64).T
    code = np.zeros(len(xy), np.uint64)
    for bit in range(MORTON_BITS):
        at = np.uint64(bit)
        code |= ((x >> at & np.uint64(1)) << np.uint64(2 * bit)) | (
            (y >> at & np.uint64(1)) << np.uint64(2 * bit + 1)
        )
    return code


def _rebuild_with_startinpy(given: Any) -> Any:
    import startinpy

    points, edits, batch = given
    made = startinpy.DT()
    made.snap_tolerance = 1e-12  # its default, a millimetre, merges points
    made.insert(points)
    made.jump_and_walk = True  # else every search starts where the last edit was
    return made, edits, batch


def _edit_with_startinpy(state: Any) -> Any:
    made, edits, batch = state
    if len(batch):
        made.jump_and_walk = False  # the batch is sorted
        made.insert(batch)
    for what, vertex, xyz in edits:
        if what in ("remove", "move"):
            made.remove(vertex)
        if what in ("insert", "move"):
            made.insert_one_pt(xyz)
        elif what == "set_elevation":
            made.update_vertex_z_value(vertex, xyz[2])
    return made


EDIT_TOOLS: dict[str, Tool] = {
    OURS: _make_own_edit_tool(_edit_one_by_one),
    OPENED: _make_own_edit_tool(_edit_one_by_one, _open_session),
    WITH_ARRAYS: _make_own_edit_tool(_edit_and_read),
    BUILD: _make_own_edit_tool(_build_result, lambda given: given),
    "startinpy": Tool(
        module="startinpy",
        prepare=_sort_for_startinpy,
        renew=_rebuild_with_startinpy,
        run=_edit_with_startinpy,
        triangles=lambda made: made.points[made.triangles.astype(np.int64)],
    ),
}
"""The tools that Python can call, by name."""

ALL_EDIT_TOOLS = (OURS, OPENED, WITH_ARRAYS, BUILD, CGAL, "startinpy")
