"""The tools that triangulate points with lines; what is timed is as in ``triangulators``."""

from __future__ import annotations

from functools import partial
from typing import Any

from ..datasets.lines import LineTask
from .triangulators import (
    ALL_CORES,
    CDT,
    CGAL,
    DELAUNAY32,
    DELAUNAY32_ALL_CORES,
    DETRIA,
    Tool,
    count_tin_bytes,
)

__all__ = ["ALL_LINE_TOOLS", "ARGUMENTS", "CGAL_INDICES", "LINE_TOOLS"]

CGAL_INDICES = "CGAL, by indices"
"""``insert_constraints(points, segments)``; CGAL alone is ``insert_constraint`` by handles."""


def _pass_task(task: LineTask) -> Any:
    return task.points, task.breaklines()


def _triangulate_lines(given: Any, threads: int | None = 1) -> Any:
    from tinsmith import triangulate

    points, breaklines = given
    return triangulate(points, breaklines=breaklines, threads=threads)


def _prepare_pslg(task: LineTask) -> dict[str, Any]:
    return {"vertices": task.vertices, "segments": task.segments}


def _triangulate_lines_with_triangle(graph: dict[str, Any]) -> Any:
    import triangle

    return triangle.triangulate(graph, "pcQz")  # c: out to the convex hull


def _make_own_line_tool(threads: int | None) -> Tool:
    return Tool(
        module="tinsmith",
        prepare=_pass_task,
        run=partial(_triangulate_lines, threads=threads),
        triangles=lambda tin: tin.points[tin.triangles, :2],
        output_bytes=count_tin_bytes,
        is_exact=True,
    )


LINE_TOOLS: dict[str, Tool] = {
    "tinsmith": _make_own_line_tool(1),
    ALL_CORES: _make_own_line_tool(None),
    "Triangle": Tool(
        module="triangle",
        prepare=_prepare_pslg,
        run=_triangulate_lines_with_triangle,
        triangles=lambda made: made["vertices"][made["triangles"]],
    ),
}
"""The tools that Python can call, by name."""

ALL_LINE_TOOLS = (
    *("tinsmith", ALL_CORES, CGAL, CGAL_INDICES, DELAUNAY32, DELAUNAY32_ALL_CORES, CDT, DETRIA),
    "Triangle",
)

ARGUMENTS = {
    CGAL: ["handles"],
    CGAL_INDICES: ["indices"],
    DELAUNAY32: ["1"],
    DELAUNAY32_ALL_CORES: ["0"],
    CDT: [],
    DETRIA: [],
}
"""What the harness of a compiled tool is told besides its files."""
