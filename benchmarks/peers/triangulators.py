"""The tools that triangulate, each with what is timed: from the caller's points to triangles.

What prepares the tool's own input from an array of points is not timed, nor what reads its
answer: an advantage for the peers, since tinsmith's call is timed whole.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "ALL_CORES",
    "CGAL",
    "KERNEL",
    "KERNEL_ALL_CORES",
    "TOOLS",
    "Tool",
    "is_cgal",
    "tin_bytes",
]

Floats = NDArray[np.float64]

CGAL = "CGAL"
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
    prepare: Callable[[Floats], Any]
    run: Callable[[Any], Any]
    triangles: Callable[[Any], NDArray[Any]]
    renew: Callable[[Any], Any] = lambda given: given
    output_bytes: Callable[[Any], int] = lambda _: 0
    largest: int = 100_000
    is_exact: bool = False


def is_cgal(tool: str) -> bool:
    """Whether a tool is a way of using CGAL, which has harnesses of its own."""
    return tool.startswith(CGAL)


def _as_given(points: Floats) -> Floats:
    return points


def _plane(points: Floats) -> Floats:
    return np.ascontiguousarray(points[:, :2])


# ---------------------------------------------------------------------- tinsmith


def _triangulate(points: Floats, threads: int | None = 1) -> Any:
    from tinsmith import triangulate

    return triangulate(points, threads=threads)


def _grow(points: Floats, threads: int | None = 1) -> Any:
    from tinsmith.tin import _kernel
    from tinsmith.tin.validation.threads import thread_count

    return _kernel.grow(points, threads=thread_count(threads, len(points)))


def tin_bytes(tin: Any) -> int:
    """Return the bytes of a TIN's arrays."""
    arrays = (tin.points, tin.triangles, tin.neighbors, tin.constrained, tin.vertex_of)
    return sum(array.nbytes for array in arrays)


def _growth_bytes(growth: Any) -> int:
    return int(growth.triangles.nbytes + growth.neighbors.nbytes)


# ------------------------------------------------------------------------- peers


def _triangle_input(points: Floats) -> dict[str, Floats]:
    return {"vertices": _plane(points)}


def _triangle(vertices: dict[str, Floats]) -> Any:
    import triangle

    return triangle.triangulate(vertices, "Qz")


def _scipy(xy: Floats) -> Any:
    from scipy.spatial import Delaunay

    return Delaunay(xy)


def _startinpy(points: Floats) -> Any:
    import startinpy

    made = startinpy.DT()
    made.snap_tolerance = 1e-12  # its default, a millimetre, merges points
    made.insert(points)
    return made


def _startinpy_triangles(made: Any) -> NDArray[Any]:
    return np.asarray(made.points[:, :2][made.triangles.astype(np.int64)])


def _geos_input(points: Floats) -> Any:
    import shapely

    return shapely.multipoints(points[:, :2])


def _geos(multipoint: Any) -> Any:
    import shapely

    return shapely.delaunay_triangles(multipoint)


def _geos_triangles(collection: Any) -> NDArray[Any]:
    import shapely

    return np.asarray(shapely.get_coordinates(collection).reshape(-1, 4, 2)[:, :3])


def _ours(run: Callable[[Floats], Any], output_bytes: Callable[[Any], int]) -> Tool:
    return Tool(
        module="tinsmith",
        prepare=_as_given,
        run=run,
        triangles=lambda made: made.triangles,
        output_bytes=output_bytes,
        largest=10_000_000,
        is_exact=True,
    )


TOOLS: dict[str, Tool] = {
    "tinsmith": _ours(_triangulate, tin_bytes),
    KERNEL: _ours(_grow, _growth_bytes),
    ALL_CORES: _ours(partial(_triangulate, threads=None), tin_bytes),
    KERNEL_ALL_CORES: _ours(partial(_grow, threads=None), _growth_bytes),
    "Triangle": Tool(
        module="triangle",
        prepare=_triangle_input,
        run=_triangle,
        triangles=lambda made: made["triangles"],
        largest=10_000_000,
        is_exact=True,
    ),
    "SciPy": Tool(
        module="scipy", prepare=_plane, run=_scipy, triangles=lambda made: made.simplices
    ),
    "startinpy": Tool(
        module="startinpy", prepare=_as_given, run=_startinpy, triangles=_startinpy_triangles
    ),
    "GEOS": Tool(module="shapely", prepare=_geos_input, run=_geos, triangles=_geos_triangles),
}
"""The tools that Python can call, by name; CGAL has a harness of its own."""
