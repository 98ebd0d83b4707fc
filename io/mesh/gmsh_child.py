"""Gmsh files through meshio, as the child process reads them."""

from __future__ import annotations

from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from io import StringIO
from typing import TYPE_CHECKING, Any

import numpy as np

from ..isolated import Answer, Refusal

if TYPE_CHECKING:
    from ...arrays import Int64Array

__all__ = ["prepare", "read_mesh"]


_READ = frozenset({"vertex", "line", "triangle", "quad"})


def prepare() -> None:
    """Load the library."""
    import_module("meshio")


def read_mesh(path: str, shown: str) -> Answer:
    """Return the ``points``, ``triangles``, ``quadrilaterals`` and ``lines`` of a file."""
    found = _read_with_meshio(path, shown)
    points = np.asarray(found.points, np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise Refusal(f"'{shown}' is a damaged Gmsh file: its points have not three coordinates.")
    _require_known_cells(found, shown)
    cells = {
        "triangles": _find_cells(found, "triangle", 3),
        "quadrilaterals": _find_cells(found, "quad", 4),
        "lines": _find_cells(found, "line", 2),
    }
    for name, numbers in cells.items():
        wrong = (numbers < 0) | (numbers >= len(points))
        if wrong.any():
            row = int(np.argmax(wrong.any(axis=1)))
            raise Refusal(
                f"'{shown}' is a damaged Gmsh file: element {row} of its {name} names a vertex "
                "that it does not hold."
            )
    return Answer(None, {"points": points, **cells})


def _require_known_cells(found: Any, shown: str) -> None:
    """Refuse faces of other kinds, which would be lost."""
    kinds = {block.type: len(block.data) for block in found.cells if len(block.data)}
    odd = sorted(kinds.keys() - _READ)
    if odd:
        raise Refusal(
            f"'{shown}' holds {kinds[odd[0]]} elements of the type {odd[0]}: triangles and "
            "quadrilaterals with straight edges can be read."
        )


def _read_with_meshio(path: str, shown: str) -> Any:
    meshio = import_module("meshio")
    said = StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):
            found = meshio.gmsh.read(path)
    except MemoryError:
        raise
    except Exception as error:  # meshio lets through whatever a damaged file leads to
        told = str(error).strip().rstrip(".") if isinstance(error, meshio.ReadError) else ""
        reason = told or "it ends early, or holds something else than the format asks for"
        raise Refusal(f"'{shown}' is a damaged Gmsh file: {reason}.") from error
    if "not closed" in said.getvalue():
        raise Refusal(f"'{shown}' is a Gmsh file that was cut short.")
    return found


def _find_cells(found: Any, kind: str, size: int) -> Int64Array:
    blocks = [np.asarray(block.data, np.int64) for block in found.cells if block.type == kind]
    return np.concatenate([np.empty((0, size), np.int64), *blocks])
