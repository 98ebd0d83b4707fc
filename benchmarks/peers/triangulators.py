"""The tools that triangulate, each with what is timed: from the caller's points to triangles.

What prepares the tool's own input from an array of points is not timed, nor what reads its
answer: an advantage for the peers, since tinsmith's call is timed whole.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from tinsmith.base.arrays import AnyArray, Float64Array

__all__ = [
    "ALL_CORES",
    "CDT",
    "CGAL",
    "DELAUNAY32",
    "DELAUNAY32_ALL_CORES",
    "DETRIA",
    "KERNEL",
    "KERNEL_ALL_CORES",
    "TOOLS",
    "Tool",
    "count_tin_bytes",
    "is_compiled",
    "is_exact",
    "name_harness",
]


CDT = "CDT"
"""By A. Amirkhanov, github artem-ogre/CDT; only for lines, as detria."""
CGAL = "CGAL"
DETRIA = "detria"
DELAUNAY32 = "Delaunay32"
DELAUNAY32_ALL_CORES = "Delaunay32, all cores"
KERNEL = "tinsmith kernel"
ALL_CORES = "tinsmith, all cores"
KERNEL_ALL_CORES = "kernel, all cores"


@dataclass(frozen=True)
class Tool:
    """A library that triangulates.

    Attributes
    ----------
    module : str
        What must be installed.
    prepare : callable
        (n, 3) points, or another task, to the library's own input.
    renew : callable
        Input to what a run gets, anew before each.
    run : callable
        Input to answer; this is timed.
    triangles : callable
        Answer to (m, 3) vertex numbers, or (m, 3, 2) coordinates.
    output_bytes : callable
        Bytes of the arrays in an answer.
    largest : int
        Number of points above which it is not asked: it takes minutes, or all the memory.
    is_exact : bool
        Whether it claims to be right for any coordinates; then a wrong answer is a failure.
    """

    module: str
    prepare: Callable[[Float64Array], Any]
    run: Callable[[Any], Any]
    triangles: Callable[[Any], AnyArray]
    renew: Callable[[Any], Any] = lambda given: given
    output_bytes: Callable[[Any], int] = lambda _: 0
    largest: int = 100_000
    is_exact: bool = False


def is_compiled(tool: str) -> bool:
    """Whether a tool is a way of using a library in C++, which has a harness of its own."""
    return tool.startswith((CDT, CGAL, DELAUNAY32, DETRIA))


def name_harness(tool: str, work: str) -> str:
    """Return the name of a compiled tool's harness for ``"points"``, ``"lines"`` or ``"edits"``."""
    return f"{tool.partition(',')[0].lower()}_{work}"


def is_exact(tool: str, modules: Mapping[str, Tool]) -> bool:
    """Whether a tool claims to be right for any coordinates; Delaunay32's are rounded."""
    return tool.startswith((CGAL, DETRIA)) if is_compiled(tool) else modules[tool].is_exact


def _pass_points(points: Float64Array) -> Float64Array:
    return points


def _drop_elevations(points: Float64Array) -> Float64Array:
    return np.ascontiguousarray(points[:, :2])


# ---------------------------------------------------------------------- tinsmith


def _triangulate_points(points: Float64Array, threads: int | None = 1) -> Any:
    from tinsmith import triangulate

    return triangulate(points, threads=threads)


def _grow_only(points: Float64Array, threads: int | None = 1) -> Any:
    from tinsmith.tin import _kernel
    from tinsmith.tin.validation.threads import thread_count

    return _kernel.grow(points, threads=thread_count(threads, len(points)))


def count_tin_bytes(tin: Any) -> int:
    """Return the bytes of a TIN's arrays."""
    arrays = (tin.points, tin.triangles, tin.neighbors, tin.constrained, tin.vertex_of)
    return sum(array.nbytes for array in arrays)


def _count_growth_bytes(growth: Any) -> int:
    return int(growth.triangles.nbytes + growth.neighbors.nbytes)


# ------------------------------------------------------------------------- peers


def _prepare_vertices(points: Float64Array) -> dict[str, Float64Array]:
    return {"vertices": _drop_elevations(points)}


def _triangulate_with_triangle(vertices: dict[str, Float64Array]) -> Any:
    import triangle

    return triangle.triangulate(vertices, "Qz")


def _triangulate_with_scipy(xy: Float64Array) -> Any:
    from scipy.spatial import Delaunay

    return Delaunay(xy)


def _triangulate_with_startinpy(points: Float64Array) -> Any:
    import startinpy

    made = startinpy.DT()
    made.snap_tolerance = 1e-12  # its default, a millimetre, merges points
    made.insert(points)
    return made


def _read_startinpy_triangles(made: Any) -> AnyArray:
    return np.asarray(made.points[:, :2][made.triangles.astype(np.int64)])


def _make_multipoint(points: Float64Array) -> Any:
    import shapely

    return shapely.multipoints(points[:, :2])


def _triangulate_with_geos(multipoint: Any) -> Any:
    import shapely

    return shapely.delaunay_triangles(multipoint)


def _read_geos_triangles(collection: Any) -> AnyArray:
    import shapely

    return np.asarray(shapely.get_coordinates(collection).reshape(-1, 4, 2)[:, :3])


def _make_own_tool(run: Callable[[Float64Array], Any], output_bytes: Callable[[Any], int]) -> Tool:
    return Tool(
        module="tinsmith",
        prepare=_pass_points,
        run=run,
        triangles=lambda made: made.triangles,
        output_bytes=output_bytes,
        largest=10_000_000,
        is_exact=True,
    )


TOOLS: dict[str, Tool] = {
    "tinsmith": _make_own_tool(_triangulate_points, count_tin_bytes),
    KERNEL: _make_own_tool(_grow_only, _count_growth_bytes),
    ALL_CORES: _make_own_tool(partial(_triangulate_points, threads=None), count_tin_bytes),
    KERNEL_ALL_CORES: _make_own_tool(partial(_grow_only, threads=None), _count_growth_bytes),
    "Triangle": Tool(
        module="triangle",
        prepare=_prepare_vertices,
        run=_triangulate_with_triangle,
        triangles=lambda made: made["triangles"],
        largest=10_000_000,
        is_exact=True,
    ),
    "SciPy": Tool(
        module="scipy",
        prepare=_drop_elevations,
        run=_triangulate_with_scipy,
        triangles=lambda made: made.simplices,
    ),
    "startinpy": Tool(
        module="startinpy",
        prepare=_pass_points,
        run=_triangulate_with_startinpy,
        triangles=_read_startinpy_triangles,
    ),
    "GEOS": Tool(
        module="shapely",
        prepare=_make_multipoint,
        run=_triangulate_with_geos,
        triangles=_read_geos_triangles,
    ),
}
"""The tools that Python can call, by name; those in C++ have harnesses of their own."""
