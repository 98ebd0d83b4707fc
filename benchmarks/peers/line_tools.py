"""The tools that triangulate points with lines; what is timed is as in ``triangulators``."""

from __future__ import annotations

from functools import partial
from typing import Any

from ..datasets.lines import LineTask
from .triangulators import ALL_CORES, CGAL, Tool, tin_bytes

__all__ = ["ALL_LINE_TOOLS", "CGAL_INDICES", "LINE_TOOLS"]

CGAL_INDICES = "CGAL, by indices"
"""``insert_constraints(points, segments)``; CGAL alone is ``insert_constraint`` by handles."""


def _given(task: LineTask) -> Any:
    return task.points, task.breaklines()


def _triangulate(given: Any, threads: int | None = 1) -> Any:
    from tinsmith import triangulate

    points, breaklines = given
    return triangulate(points, breaklines=breaklines, threads=threads)


def _triangle_input(task: LineTask) -> dict[str, Any]:
    return {"vertices": task.vertices, "segments": task.segments}


def _triangle(graph: dict[str, Any]) -> Any:
    import triangle

    return triangle.triangulate(graph, "pcQz")  # c: out to the convex hull


def _ours(threads: int | None) -> Tool:
    return Tool(
        module="tinsmith",
        prepare=_given,
        run=partial(_triangulate, threads=threads),
        triangles=lambda tin: tin.points[tin.triangles, :2],
        output_bytes=tin_bytes,
        is_exact=True,
    )


LINE_TOOLS: dict[str, Tool] = {
    "tinsmith": _ours(1),
    ALL_CORES: _ours(None),
    "Triangle": Tool(
        module="triangle",
        prepare=_triangle_input,
        run=_triangle,
        triangles=lambda made: made["vertices"][made["triangles"]],
    ),
}
"""The tools that Python can call, by name."""

ALL_LINE_TOOLS = ("tinsmith", ALL_CORES, CGAL, CGAL_INDICES, "Triangle")
