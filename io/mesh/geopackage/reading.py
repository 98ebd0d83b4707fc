"""Read the TIN of a GeoPackage: in a child process, and compared with its digests."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.errors import PointsError, ReadError
from ....base.sentences import FILE
from ....tin import TIN
from ...isolated import run_isolated
from ...reprojection import look_at_crs
from ..common import add_notes, choose_reference, make_tin
from .records import Record, unpack_tin
from .schema import digest_arrays

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import BoolArray, Float64Array, Int32Array
    from ....base.crs import CrsLike, UnitLike
    from ...isolated import Answer
    from ..common import FileReference

_CHANGED = (
    "Layers of the file were changed by another program since it was written: the TIN is made of "
    "its vertices and triangles, and what was known of lines, rows and edits is left out."
)


def read(path: Path, *, crs: CrsLike | None = None, elevation_unit: UnitLike | None = None) -> TIN:
    """Read the TIN of a GeoPackage that :func:`write` wrote, with all that was known of it.

    Parameters
    ----------
    path : Path
    crs : CRS, str, int or pyproj.CRS, optional
        Declares the CRS where the file has none.
    elevation_unit : Unit or str, optional
        Declares the unit of the elevations where the file has none.

    Returns
    -------
    TIN
        Equal to the one that was written, edits and what undoing them needs included. Where
        another program changed the layers since, that of the vertices and triangles there are,
        and the report's notes say so.

    Raises
    ------
    ReadError
        If the file is damaged, or its triangles are no TIN.
    CrsError, OptionError
        If the file has another CRS or unit.

    Notes
    -----
    SQLite reads the file in a child process, with limits of time and memory; only tables are
    read, no view, trigger or function of the file takes part.
    """
    journal = path.with_name(path.name + "-wal")
    if journal.exists() and journal.stat().st_size:
        raise ReadError(
            f"{FILE} is open in another program, as '{journal.name}' beside it shows: close it "
            "there first."
        )
    answer = run_isolated(
        f"{__package__}.child:read_tables", {"path": str(path.absolute())}, path=path
    )
    points, triangles, constrained = _take_mesh(answer)
    found = {name[1:]: array for name, array in answer.arrays.items() if name[0] == " "}
    record = Record(
        _load_json(answer, "document"),
        dict(sorted(found.items(), key=lambda item: int(item[0]) if item[0].isdecimal() else -1)),
    )
    digests = _load_json(answer, "digests")
    text = answer.value["document"]
    if digest_arrays(*record.arrays.values(), text=text) != digests.get("record"):
        raise ReadError(f"{FILE} is damaged: its record of the TIN is not as written.")
    stored = {}
    for name, key in (("crs", "crs"), ("elevation_unit", "unit")):
        tree = record.document.get(name)
        stored[key] = tree.get(key) if isinstance(tree, dict) else None
    reference = choose_reference(
        crs, elevation_unit, found_crs=stored["crs"], found_unit=stored["unit"]
    )
    mesh = digest_arrays(points, triangles, constrained)
    if (mesh, answer.value["lines"]) != (digests.get("mesh"), digests.get("lines")):
        tin = make_tin(points, triangles, constrained=constrained, reference=reference)
        return tin.replace(report=replace(tin.report, notes=[*tin.report.notes, _CHANGED]))
    declared = _declare(record, reference)
    noted = look_at_crs(points, reference.crs, is_declared=True) if reference.is_declared else ()
    try:
        tin = unpack_tin(declared, points, triangles, constrained)
        return add_notes(tin, noted) if noted else tin
    except PointsError as error:
        raise ReadError(f"{FILE} holds no TIN. {error}") from error


def _take_mesh(answer: Answer) -> tuple[Float64Array, Int32Array, BoolArray]:
    points, triangles, flags = (answer.arrays[name] for name in ("points", "triangles", "flags"))
    wrong = ((triangles < 0) | (triangles >= len(points))).any(axis=1) | (flags < 0) | (flags > 7)
    if wrong.any() or not len(triangles):
        row = int(np.argmax(wrong)) if len(wrong) else 0
        raise ReadError(
            f"row {row + 1} of the layer 'triangles' names no three of the {len(points)} vertices."
        )
    constrained = (flags[:, None] & np.array([1, 2, 4])) != 0
    return points, triangles.astype(np.int32), constrained


def _load_json(answer: Answer, name: str) -> dict[str, Any]:
    try:
        found = json.loads(answer.value[name])
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise ReadError(f"{FILE} is damaged: its {name} is no JSON object.")
    return found


def _declare(record: Record, reference: FileReference) -> Record:
    """Return the record with the reference that the file or else a caller names."""
    crs, unit = reference.crs, reference.elevation_unit
    named = {
        "crs": None if crs is None else {"crs": str(crs)},
        "elevation_unit": None if unit is None else {"unit": unit.text},
    }
    return record._replace(document=record.document | named)
