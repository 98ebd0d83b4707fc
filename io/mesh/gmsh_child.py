"""Gmsh files through meshio, as the child process reads them."""

from __future__ import annotations

from collections import Counter
from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from io import StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.sentences import FILE
from ..isolated import Answer, Refusal

if TYPE_CHECKING:
    from ...base.arrays import Int64Array

_NO_FACES = frozenset({"vertex", "line", "line3", "line4", "line5"})
_POLYGONS = {
    # Corners stand before the nodes amid their edges; faces are cut at these.
    "triangle": ((0, 1, 2),),
    "quad": ((0, 1, 2, 3),),
    "triangle6": ((0, 3, 5), (3, 1, 4), (4, 2, 5), (3, 4, 5)),
    "quad8": ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6, 7)),
    "quad9": ((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3)),
}


def prepare() -> None:
    """Load the library."""
    import_module("meshio")


def read_mesh(path: str) -> Answer:
    """Return the ``points`` and ``lines`` of a file, and the ``corners`` and ``offsets`` of faces.

    The value counts the cells that are neither by their kinds.
    """
    meshio = import_module("meshio")
    said = StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):
            found = meshio.gmsh.read(path)
    except MemoryError:
        raise
    except Exception as error:  # meshio lets through whatever a damaged file leads to
        stated = str(error).strip().rstrip(".") if isinstance(error, meshio.ReadError) else ""
        reason = stated or "it ends early, or holds something else than the format asks for"
        raise Refusal(f"{FILE} is a damaged Gmsh file: {reason}.") from error
    if "not closed" in said.getvalue():
        raise Refusal(f"{FILE} is a Gmsh file that was cut short.")
    points = np.asarray(found.points, np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise Refusal(f"{FILE} is a damaged Gmsh file: its points have not three coordinates.")
    for block in found.cells:
        numbers = np.asarray(block.data)
        wrong = (numbers < 0) | (numbers >= len(points))
        if wrong.any():
            row = int(np.argmax(wrong.any(axis=1)))
            raise Refusal(
                f"{FILE} is a damaged Gmsh file: element {row} of its cells of the kind "
                f"{block.type} names a vertex that it does not hold."
            )
    others: Counter[str] = Counter()
    for block in found.cells:
        if block.type not in (*_POLYGONS, *_NO_FACES):
            others[block.type] += len(block.data)
    lines = [np.asarray(block.data, np.int64) for block in found.cells if block.type == "line"]
    edges = np.concatenate([np.empty((0, 2), np.int64), *lines])
    corners, lengths = _gather_faces(found)
    offsets = np.concatenate([[0], np.cumsum(lengths)])
    arrays = {"points": points, "lines": edges, "corners": corners, "offsets": offsets}
    return Answer(dict(others), arrays)


def _gather_faces(found: Any) -> tuple[Int64Array, Int64Array]:
    """Return the corners of polygons, one after the other, and how many each has."""
    corners, lengths = [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    for block in found.cells:
        polygons = _POLYGONS.get(block.type, ())
        nodes = np.asarray(block.data, np.int64)
        if polygons and len(nodes):
            corners.append(nodes[:, [slot for one in polygons for slot in one]].ravel())
            lengths.append(np.tile([len(one) for one in polygons], len(nodes)))
    return np.concatenate(corners), np.concatenate(lengths)
