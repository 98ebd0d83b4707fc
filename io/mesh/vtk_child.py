"""VTK XML files through VTK itself, as the child process reads them."""

from __future__ import annotations

from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.sentences import FILE
from ..isolated import Answer, Refusal

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.arrays import AnyArray, Float64Array, Int64Array, UInt8Array

_NO_FACES = frozenset({0, 1, 2, 3, 4})  # empty cell, vertices, lines
_FACES = frozenset({5, 7, 9})  # triangle, polygon, quadrilateral


def prepare() -> None:
    """Load the library."""
    import_module("pyvista")
    import_module("vtkmodules.vtkIOXML")


def read_mesh(path: str, *, kind: str) -> Answer:
    """Return the points and faces of a file, a "PolyData" or an "UnstructuredGrid".

    The value holds ``crs``, ``elevation_unit``, the names of the ``attributes``, and the ``dtype``
    of the coordinates. The arrays hold ``points``, the ``corners`` of faces, one face after the
    other, their ``offsets``, the number of the cell that each is (``cells``), ``attribute 0`` ...,
    and where the file has them ``flags`` of the faces' edges, ``origin``, ``exaggeration`` and
    ``elevation_scale``.
    """
    pv = import_module("pyvista")
    reader = load_vtk_class(f"vtkXML{kind}Reader")()
    reader.SetFileName(path)
    with catch_errors(pv) as errors:
        reader.Update()
    if errors or reader.GetErrorCode():
        raise Refusal(f"{FILE} is a damaged VTK XML file.")
    return read_dataset(pv.wrap(reader.GetOutput()))


def read_dataset(found: Any) -> Answer:
    """Return what a PolyData or UnstructuredGrid of PyVista holds, as :func:`read_mesh` does."""
    is_poly_data = hasattr(found, "GetPolys")
    if not (is_poly_data or hasattr(found, "celltypes")):
        raise Refusal(f"{FILE} is neither a PolyData nor an UnstructuredGrid.")
    faces = _read_poly_data(found) if is_poly_data else _read_faces(found)
    data = {str(name): np.array(values) for name, values in found.point_data.items()}
    attributes = {name: a for name, a in data.items() if a.ndim == 1 and a.dtype.kind in "biuf"}
    arrays: dict[str, AnyArray] = {
        "points": np.array(found.points, np.float64).reshape(-1, 3),
        **faces,
    }
    arrays |= {f"attribute {k}": values for k, values in enumerate(attributes.values())}
    arrays |= _read_number_fields(found) | _read_edge_flags(found, faces["cells"])
    texts = {name: _read_text_field(found, name) for name in ("crs", "elevation_unit")}
    value = {**texts, "attributes": list(attributes), "dtype": str(found.points.dtype)}
    return Answer(value, arrays)


def load_vtk_class(name: str) -> Any:
    """Return a class of VTK's readers and writers of XML files."""
    return getattr(import_module("vtkmodules.vtkIOXML"), name)


@contextmanager
def catch_errors(pv: Any) -> Iterator[list[Any]]:
    """Collect what VTK would print to the terminal."""
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    errors: list[Any] = []
    try:
        with pv.VtkErrorCatcher(raise_errors=False, send_to_logging=False) as catcher:
            yield errors
        errors.extend(catcher.error_events)
    finally:
        vtkLogger.SetStderrVerbosity(before)


def _convert_to_integers(array: Any) -> Int64Array:
    numbers: Int64Array = import_module("pyvista").convert_array(array).astype(np.int64)
    return numbers


def _read_number_fields(found: Any) -> dict[str, Float64Array]:
    """Return the fields that tell where the coordinates are, as far as they are sound."""
    fields = {}
    for name, size in (("origin", 3), ("exaggeration", 1), ("elevation_scale", 1)):
        values = np.asarray(found.field_data.get(name, ()))
        if values.size == size and values.dtype.kind in "iuf" and np.isfinite(values).all():
            fields[name] = values.ravel().astype(np.float64)
    return fields


def _read_text_field(found: Any, name: str) -> str | None:
    if name not in found.field_data:
        return None
    values = np.asarray(found.field_data[name]).ravel()
    return (str(values[0]).strip() or None) if len(values) else None


def _read_poly_data(found: Any) -> dict[str, Int64Array]:
    if found.n_strips:
        raise Refusal(f"{FILE} holds triangle strips, which are not read.")
    polys = found.GetPolys()
    first = found.GetVerts().GetNumberOfCells() + found.GetLines().GetNumberOfCells()
    cells = np.arange(first, first + polys.GetNumberOfCells())
    if len(cells) == 0:
        corners, offsets = np.empty(0, np.int64), np.zeros(1, np.int64)
    else:
        corners = _convert_to_integers(polys.GetConnectivityArray())
        offsets = _convert_to_integers(polys.GetOffsetsArray())
    return {"corners": corners, "offsets": offsets, "cells": cells}


def _read_faces(found: Any) -> dict[str, Int64Array]:
    types = np.asarray(found.celltypes)
    odd = ~np.isin(types, list(_NO_FACES | _FACES))
    if odd.any():
        count = int(odd.sum())
        raise Refusal(
            f"{FILE} holds {count} cell{'s' if count > 1 else ''} that "
            f"{'are no faces' if count > 1 else 'is no face'} (first: cell {int(np.argmax(odd))} "
            f"of VTK type {types[np.argmax(odd)]}): triangles, quadrilaterals and polygons can be "
            "read."
        )
    cells = np.flatnonzero(np.isin(types, list(_FACES)))
    every = _convert_to_integers(found.GetCells().GetOffsetsArray())
    starts, lengths = every[cells], np.diff(every)[cells]
    offsets = np.zeros(len(cells) + 1, np.int64)
    np.cumsum(lengths, out=offsets[1:])
    slots = np.repeat(starts - offsets[:-1], lengths) + np.arange(offsets[-1])
    corners = _convert_to_integers(found.GetCells().GetConnectivityArray())[slots]
    return {"corners": corners, "offsets": offsets, "cells": cells}


def _read_edge_flags(found: Any, cells: Int64Array) -> dict[str, UInt8Array]:
    if "constrained" not in found.cell_data:
        return {}
    flags = np.asarray(found.cell_data["constrained"])
    if flags.ndim != 2 or flags.shape[1] != 3:
        return {}
    return {"flags": (flags[cells] != 0).astype(np.uint8)}
