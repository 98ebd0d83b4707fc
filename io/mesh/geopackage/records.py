"""Records: all that a TIN is, as values that JSON holds and arrays, and the TIN of them again.

What is read may come from anyone, and is compared first.
"""

from __future__ import annotations

import math
import re
from dataclasses import fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.crs import CRS, Unit
from ....base.errors import PointsError, TinsmithError
from ....base.records import require, require_fields, require_indices
from ....tin import topology
from ....tin.building import BuildInputs, BuildOptions, Version
from ....tin.constraints import ConstraintTable, Lines, LineSet
from ....tin.editing import Origin
from ....tin.report import Crossings, Edit, Overruled, Report, Simplification, Unmended
from ....tin.surface import TIN
from ....tin.triangulation import Triangulation
from ....tin.validation import as_flags, as_points, as_triangles, turn_counter_clockwise

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from ....base.arrays import AnyArray, BoolArray, Float64Array, Int32Array

CLASSES: dict[str, Any] = {
    kind.__name__: kind
    for kind in (
        *(BuildInputs, BuildOptions, ConstraintTable, Crossings, Edit, Lines, LineSet),
        *(Overruled, Report, Simplification, Unmended),
    )
}
"""The only classes that are made of trees."""

_NO_ROWS = np.empty((0, 3))


class Record(NamedTuple):
    """What is known of a TIN beside its points, triangles and flags."""

    document: dict[str, Any]
    """What JSON holds; ``{"array": name}`` stands for an array."""
    arrays: dict[str, AnyArray]


def pack_tin(tin: TIN) -> Record:
    """Return report, lines, reference, inputs and edits of a TIN as plain values and arrays."""
    version, origin = tin._settle()
    packer = _Packer()
    document: dict[str, Any] = {
        "crs": packer.pack(tin.crs),
        "elevation_unit": packer.pack(tin.elevation_unit),
        **_pack_version(version, packer),
        "edits": packer.pack(origin.edits),
    }
    if tin._row_attributes:  # those of inserted rows are in the edits
        document["attributes"] = pack_columns(tin._row_attributes, packer.pack)
    if origin.inputs is not None:
        inputs = origin.inputs
        rows = inputs.points
        differing = (take_rows(version, len(rows)).view(np.int64) != rows.view(np.int64)).any(
            axis=1
        )
        numbers = np.flatnonzero(differing).astype(np.int32)
        document |= {
            "inputs": packer.pack(replace(inputs, points=_NO_ROWS, crs=None, elevation_unit=None)),
            "n_rows": len(rows),
            "rows": packer.pack([numbers, rows[numbers]]),
        }
    if origin.given is not None:
        mesh = origin.given.triangulation
        arrays = (mesh.points, mesh.triangles, mesh.constrained)
        document["given"] = {
            **_pack_version(origin.given, packer),
            "mesh": packer.pack(list(arrays)),
        }
    return Record(document, packer.arrays)


def _pack_version(version: Version, packer: _Packer) -> dict[str, Any]:
    return {
        "vertex_of": packer.pack(version.vertex_of),
        "lines": packer.pack(version.lines),
        "report": packer.pack(version.report),
    }


def take_rows(version: Version, count: int) -> Float64Array:
    """Return the vertices of the first rows; for rows without a vertex, any."""
    return np.ascontiguousarray(version.triangulation.points[version.vertex_of[:count]])


class _Packer:
    """Makes trees of plain values, and gathers arrays."""

    def __init__(self) -> None:
        self.arrays: dict[str, AnyArray] = {}

    def pack(self, value: Any) -> Any:
        """Return a value as a tree."""
        if isinstance(value, np.ndarray) and not _STORED.fullmatch(value.dtype.str):
            value = _list_plain(value)  # a column of rows that an edit inserted
        if isinstance(value, np.ndarray):
            name = str(len(self.arrays))
            self.arrays[name] = value
            return {"array": name}
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, float) and not math.isfinite(value):
            return {"number": repr(value)}
        if value is None or isinstance(value, bool | int | float | str):
            return value
        name = type(value).__name__
        if isinstance(value, CRS | Unit):
            return {name.lower(): value.text if isinstance(value, Unit) else str(value)}
        if name in CLASSES:
            return {
                "type": name,
                **{key: self.pack(getattr(value, key)) for key in _list_keys(value)},
            }
        if isinstance(value, list | tuple):
            plain = list if isinstance(value, list) else tuple
            packed = [one if type(one) is str else self.pack(one) for one in value]
            return {plain.__name__: packed}
        return {"map": {str(key): self.pack(one) for key, one in dict(value).items()}}


def _list_keys(value: Any) -> list[str]:
    """Return the names of what a record holds; lines of the text that was read are left there."""
    names = [one.name for one in fields(value)] if is_dataclass(value) else list(value._fields)
    return [name for name in names if name != "row_sources"]


_STORED = re.compile(r"[<|][bif][148]|\|u1")
"""Types that the table of arrays holds."""

_TYPE = re.compile(r"[<|](?:[biu][1248]|f[248]|[mM]8(?:\[\w{1,12}\])?|U\d{1,7})|\|O")
_PLAIN = (bool, int, float, str, type(None))
_LARGEST = 2**63


def pack_columns(columns: Mapping[str, AnyArray], pack: Callable[[Any], Any]) -> list[Any]:
    """Return for each column its name, type and values; what is no plain value becomes text."""
    return [[name, *_pack_column(values, pack)] for name, values in columns.items()]


def _pack_column(values: AnyArray, pack: Callable[[Any], Any]) -> list[Any]:
    kind = values.dtype.newbyteorder("<").str
    if kind[1] in "OUSVc" or not _TYPE.fullmatch(kind):
        return [kind if kind[1] == "U" else "|O", pack(_list_plain(values))]
    values = np.ascontiguousarray(values, kind)
    if _STORED.fullmatch(kind):
        return [kind, pack(values)]
    wider = "f4" if kind[1] == "f" else "i8"
    return [kind, pack(values.view(wider) if values.itemsize == 8 else values.astype(wider))]


def _list_plain(values: AnyArray) -> list[Any]:
    """Return values of a column; what is no plain one becomes text."""
    return [one if isinstance(one, _PLAIN) else str(one) for one in values.tolist()]


def unpack_columns(trees: Any, unpack: Callable[[Any], Any], n_rows: int) -> dict[str, AnyArray]:
    """Return the columns of trees that :func:`pack_columns` made.

    Raises
    ------
    PointsError
        If one is no column, or longer than there are rows.
    """
    return {name: _unpack_column(kind, unpack(tree), n_rows) for name, kind, tree in trees}


def _unpack_column(kind: Any, values: Any, n_rows: int) -> AnyArray:
    require(isinstance(kind, str) and _TYPE.fullmatch(kind) is not None, "type of a column")
    require(isinstance(values, np.ndarray | list) and len(values) <= n_rows, "a column")
    if isinstance(values, list):
        require(all(isinstance(one, _PLAIN) for one in values), "values of a column")
        column = np.empty(len(values), object)
        column[:] = values
        return column if kind == "|O" else column.astype(kind)
    require(values.ndim == 1 and kind[1] not in "OU", "a column")
    dtype = np.dtype(kind)
    is_same_size = dtype.itemsize == values.itemsize
    whole: AnyArray = values.view(dtype) if is_same_size else values.astype(dtype)
    return whole


class LayerColumn(NamedTuple):
    """A column of attributes in a layer."""

    declaration: str
    """Name and type in SQL."""
    values: AnyArray | list[str | None]
    """Booleans, whole or real numbers that SQLite holds, or texts."""


def describe_layer_columns(
    columns: Mapping[str, AnyArray], taken: Collection[str]
) -> list[LayerColumn]:
    """Return each column as a layer has it.

    Parameters
    ----------
    columns : mapping of str to array
    taken : collection of str
        Names that the layer has already, small letters.
    """
    names, found = set(taken), []
    for name, values in columns.items():
        free = _find_free_name(name.replace("\0", " "), names)
        names.add(free.lower())
        quoted = '"' + free.replace('"', '""') + '"'
        kind = {"b": "BOOLEAN", "i": "INTEGER", "u": "INTEGER", "f": "REAL"}.get(values.dtype.kind)
        if values.dtype.kind == "u" and (values >= _LARGEST).any():
            kind = None
        texts = [] if kind else [_as_text(value) for value in values.tolist()]
        found.append(LayerColumn(f"{quoted} {kind or 'TEXT'}", values if kind else texts))
    return found


def _find_free_name(name: str, taken: set[str]) -> str:
    free, number = name or "attribute", 2
    while free.lower() in taken:
        free, number = f"{name}_{number}", number + 1
    return free


def _as_text(value: Any) -> str | None:
    if value is None or value != value:
        return None
    return str(value).encode("utf-8", "replace").decode()


_DEEPEST = 16
"""Levels of a tree; the deepest that is written has 9."""


def unpack_tin(
    record: Record,
    points: Float64Array,
    triangles: Int32Array,
    constrained: BoolArray,
) -> TIN:
    """Return the TIN of a record and of its points, triangles and flags."""
    try:
        return _unpack_tin(record, points, triangles, constrained)
    except PointsError:
        raise
    except (TypeError, ValueError, LookupError, AttributeError, TinsmithError) as error:
        raise PointsError(f"The record does not fit the TIN ({error}).") from error


def _unpack_tin(record: Record, *mesh: AnyArray) -> TIN:
    document, unpack = record.document, _Unpacker(record.arrays).unpack
    version = _unpack_version(document, mesh, unpack)
    inputs, given = None, None
    if "inputs" in document:
        inputs, count = unpack(document["inputs"]), document["n_rows"]
        numbers, values = unpack(document["rows"])
        require(type(count) is int and 0 <= count <= len(version.vertex_of), "too many rows")
        require(isinstance(inputs, BuildInputs), "the inputs are none")
        inputs._require_sound(count)
        require_indices(numbers, count, "rows")
        require(isinstance(values, np.ndarray) and values.shape == (len(numbers), 3), "rows")
        rows = take_rows(version, count)
        rows[numbers] = values
        whole: BuildInputs = replace(
            inputs, points=as_points(rows) if inputs.is_masked is None else rows
        )
        inputs = whole
    if "given" in document:
        before = document["given"]
        given = _unpack_version(before, unpack(before["mesh"]), unpack)
    origin = Origin(inputs, given, tuple(unpack(document["edits"])))
    origin._require_sound(version)
    tin = TIN._of(
        version,
        crs=unpack(document["crs"]),
        elevation_unit=unpack(document["elevation_unit"]),
        row_attributes=unpack_columns(
            document.get("attributes", []), unpack, len(version.vertex_of)
        ),
    )
    if inputs is not None:
        inputs = replace(inputs, crs=tin.crs, elevation_unit=tin.elevation_unit)
    tin._resume(origin._replace(inputs=inputs))
    return tin


def _unpack_version(document: Any, mesh: Iterable[Any], unpack: Any) -> Version:
    points, triangles, constrained = mesh
    xyz = as_points(points)
    corners, flags = as_triangles(triangles, len(xyz)), as_flags(constrained, len(triangles))
    turned, flags = turn_counter_clockwise(xyz, corners, flags)
    neighbors = topology.neighbors_of(turned, len(xyz))
    version = Version(
        triangulation=Triangulation(xyz, turned, neighbors, flags),
        **{name: unpack(document[name]) for name in ("vertex_of", "lines", "report")},
    )
    version._require_sound()
    return version


class _Unpacker:
    """Makes values of trees."""

    def __init__(self, arrays: Mapping[str, AnyArray]) -> None:
        self._arrays = arrays

    def unpack(self, tree: Any, depth: int = 0) -> Any:
        """Return the value of a tree."""
        require(depth < _DEEPEST, "it is too deep")
        if not isinstance(tree, dict):
            return tree
        if "type" in tree:
            own = {k: self.unpack(v, depth + 1) for k, v in tree.items() if k != "type"}
            value = CLASSES[tree["type"]](**own)
            require_fields(value, CLASSES | {"CRS": CRS, "Unit": Unit})
            return value
        ((kind, content),) = tree.items()
        if kind in ("list", "tuple"):
            items = [self.unpack(one, depth + 1) for one in content]
            return items if kind == "list" else tuple(items)
        if kind == "map":
            return {key: self.unpack(one, depth + 1) for key, one in content.items()}
        if kind == "array":
            return self._arrays[content]
        makers: dict[str, Callable[[Any], Any]] = {"number": float, "crs": CRS.of, "unit": Unit.of}
        return makers[kind](content)
