"""Selafin (or Serafin) files of TELEMAC: a mesh of triangles, and variables of its nodes in time.

Records of Fortran, the first byte of a number the highest: title, names and units of variables,
ten parameters, the numbers of elements and nodes, the nodes of each element, the place of each
node on the boundary (IPOBO), eastings, northings; then for each time all variables. Numbers are of
32 bits, or of 64 where the title ends in SERAFIND. The file names no CRS.

References
----------
EDF, "TELEMAC data manual", appendix "Selafin format", http://www.opentelemac.org.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from ....base.atomic import replacing
from ....base.checks import require_count
from ....base.crs import METRE, Unit
from ....base.errors import OptionError, ReadError, choice
from ....base.notes import warn
from ....base.sentences import FILE, counted
from .. import common
from ..common import Mesh, mesh_reader
from .records import RecordReader, list_marks, write_record

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array, Int64Array
    from ....base.progress import Tell
    from ....tin import TIN

Precision = Literal["float32", "float64"]

_TITLE = 80
_NAME, _UNIT = 16, 16
"""Letters of the name of a variable, and of its unit."""

_PARAMETERS = 10
_BOTTOM = ("BOTTOM", "FOND")
"""What TELEMAC calls the elevation of the ground, in English and French."""

_UNITS = {"metre": "M", "foot": "FT", "US survey foot": "US SURVEY FOOT"}


class _Head(NamedTuple):
    """What stands before the values."""

    names: list[str]
    units: list[str]
    origin: tuple[int, int]
    is_part: bool
    """Whether it is one of several files of one mesh, whose IPOBO holds other numbers."""
    elements: Int64Array
    """(n_elements, corners), nodes from 0."""
    ipobo: Int64Array
    xy: AnyArray
    """(n, 2), as the file holds them."""


@mesh_reader
def read(path: Path, *, variable: str | None = None, frame: int | None = None) -> Mesh:
    """Read the mesh of a Selafin file, and its bottom as elevations.

    The file tells no CRS; the unit of elevations is that of the variable. Quadrilaterals are cut
    along a diagonal. An origin of the coordinates is added, which the report tells, as it does what
    variables are left out and whether the boundary that IPOBO numbers is another one.

    Parameters
    ----------
    variable : str, optional
        Name of the variable that holds the nodes' elevations; default BOTTOM or FOND.
    frame : int, optional
        The time to read, from 1; needed where the variable changes in time.

    Raises
    ------
    ReadError
        Also if a record is damaged or cut off, the mesh is one of prisms, there is no bottom, or it
        changes in time and ``frame`` does not say when.
    OptionError
        If ``frame`` is no time of the file, or ``variable`` no variable of it.
    """
    content = common.read_content(path)
    order: Literal[">", "<"] = "<" if content[:4] == _TITLE.to_bytes(4, "little") else ">"
    reader = RecordReader(content, order)
    head = _read_head(reader)
    which = _choose_variable(head.names, variable)
    frames = _read_frames(reader, head)
    z = _choose_frame(frames, which, head.names[which], frame)
    points = np.column_stack([head.xy, z]).astype(np.float64)
    notes = common.describe_single_precision(points, head.xy.dtype)
    rounding = common.measure_rounding(points, head.xy.dtype)
    if head.origin != (0, 0):
        points[:, :2] += head.origin
        notes.append("The origin {:,}, {:,} was added to the coordinates.".format(*head.origin))
    others = ", ".join(name for k, name in enumerate(head.names) if k != which)
    if others:
        notes.append(
            f"Variables of the file other than {head.names[which]} are left out: {others}."
        )
    return Mesh(
        points,
        head.elements.ravel(),
        np.arange(0, head.elements.size + 1, head.elements.shape[1]),
        elevation_unit=_parse_unit(head.units[which]),
        notes=notes,
        rounding=rounding,
        add_lines=lambda tin: _compare_boundary(tin, head),
    )


def _read_head(reader: RecordReader) -> _Head:
    reader.take("the title", _TITLE)
    count = int(reader.take_integers("the number of variables", 2).sum())
    texts = [reader.take("the name of a variable", _NAME + _UNIT) for _ in range(max(count, 0))]
    words = [text.decode("latin-1") for text in texts]
    parameters = reader.take_integers("the parameters", _PARAMETERS).tolist()
    if parameters[9] == 1:
        reader.take("the date", 24)
    sizes = reader.take_integers("the numbers of elements and nodes", 4).tolist()
    n_elements, n_nodes, n_corners = sizes[:3]
    if parameters[6] > 1 or n_corners not in (3, 4):
        raise ReadError(
            f"{FILE} holds a mesh of {n_corners} nodes an element in {max(parameters[6], 1)} "
            "planes: only meshes of triangles or quadrilaterals in one plane are read."
        )
    if n_elements < 1 or n_nodes < 1:
        raise ReadError(
            f"{FILE} holds {n_elements} elements and {n_nodes} nodes, which are no mesh."
        )
    nodes = reader.take_integers("the nodes of the elements", n_elements * n_corners)
    wrong = (nodes < 1) | (nodes > n_nodes)
    if wrong.any():
        at = int(np.argmax(wrong))
        raise ReadError(
            f"{FILE}: element {at // n_corners + 1} names node {nodes[at]}, and there are nodes 1 "
            f"to {n_nodes}."
        )
    ipobo = reader.take_integers("the numbers of the boundary", n_nodes)
    first = reader.take("the eastings")
    if len(first) not in (4 * n_nodes, 8 * n_nodes):
        raise ReadError(
            f"{FILE} is damaged: the record of the eastings has {len(first):,} bytes, not 4 or 8 "
            f"for each of {counted(n_nodes, 'node')}."
        )
    dtype = f"{reader.order}f{len(first) // n_nodes}"
    columns = [first, reader.take("the northings", len(first))]
    return _Head(
        names=[word[:_NAME].strip() for word in words],
        units=[word[_NAME:].strip() for word in words],
        origin=(parameters[2], parameters[3]),
        is_part=parameters[7] != 0 or parameters[8] != 0,
        elements=nodes.reshape(n_elements, n_corners) - 1,
        ipobo=ipobo,
        xy=np.column_stack([np.frombuffer(column, dtype) for column in columns]),
    )


def _choose_variable(names: list[str], wanted: str | None) -> int:
    upper = [name.upper() for name in names]
    if wanted is not None:
        if not isinstance(wanted, str) or wanted.strip().upper() not in upper:
            raise OptionError(
                "variable", wanted, tuple(names) or "left out: there are no variables"
            )
        return upper.index(wanted.strip().upper())
    for name in _BOTTOM:
        if name in upper:
            return upper.index(name)
    told = f"name the variable that they are in ({', '.join(names)})" if names else "it has none"
    raise ReadError(f"{FILE} has no variable BOTTOM or FOND, elevations of its nodes: {told}.")


def _read_frames(reader: RecordReader, head: _Head) -> AnyArray:
    """Return all frames at once: the time, then the variables, with the lengths about each."""
    real = head.xy.dtype.newbyteorder(reader.order)
    count = len(head.xy)
    fields: list[Any] = []
    for k in range(len(head.names) + 1):
        shape = (1,) if k == 0 else (count,)
        mark = f"{reader.order}i4"
        fields += [(f"before{k}", mark), (f"record{k}", real, shape), (f"behind{k}", mark)]
    dtype = np.dtype(fields)
    left = len(reader.content) - reader.at
    number, rest = divmod(left, dtype.itemsize)
    if rest:
        raise ReadError(
            f"{FILE} ends within frame {number + 1}: {rest:,} of its {dtype.itemsize:,} bytes are "
            "there."
        )
    if not number:
        raise ReadError(
            f"{FILE} holds a mesh without values: no elevations of its nodes are there."
        )
    frames = np.frombuffer(reader.content, dtype, number, reader.at)
    for marks, size in list_marks(frames):
        if (marks != size).any():
            at = int(np.argmax(marks != size))
            raise ReadError(
                f"{FILE} is damaged: a record of frame {at + 1} has {marks[at]:,} bytes, not "
                f"{size:,}."
            )
    return frames


def _choose_frame(frames: AnyArray, which: int, name: str, wanted: int | None) -> AnyArray:
    values = frames[f"record{which + 1}"]
    if wanted is not None:
        require_count("frame", wanted, least=1)
        if wanted > len(frames):
            raise OptionError("frame", wanted, f"a frame of the file, 1 to {len(frames)}")
        chosen: AnyArray = values[wanted - 1]
        return chosen
    if len(frames) > 1 and any((row != values[0]).any() for row in values[1:]):
        raise ReadError(
            f"{FILE} holds {len(frames)} frames, between which {name} changes: name one by "
            f"`frame`, 1 to {len(frames)}."
        )
    first: AnyArray = values[0]
    return first


def _parse_unit(text: str) -> str | None:
    """Return a unit of lengths; files have others, and none."""
    for word in (text, text.lower()):
        try:
            if Unit.of(word or None) is not None:
                return word
        except OptionError:
            continue
    return None


def _compare_boundary(tin: TIN, head: _Head) -> TIN:
    """Tell where the file numbers other nodes as those of the boundary than lie on it."""
    own = np.unique(np.concatenate(tin.boundary))
    numbered = np.flatnonzero(head.ipobo)
    if head.is_part or np.array_equal(own, numbered):
        return tin
    note = (
        f"The file numbers {counted(len(numbered), 'node')} as those of the boundary (IPOBO), and "
        f"{counted(len(own), 'vertex', 'vertices')} of the surface lie on it."
    )
    return common.add_notes(tin, [note])


# ------------------------------------------------------------------ what is written


def write(
    surface: TIN, path: Path, *, dtype: Precision = "float64", progress: Tell | None = None
) -> None:
    """Write a TIN as a Selafin file with the variable BOTTOM, as TELEMAC takes a geometry.

    IPOBO numbers the boundary from the vertex of least easting plus northing, the outer one
    counter-clockwise, those of holes clockwise.

    Parameters
    ----------
    dtype : {"float32", "float64"}
        Type of numbers: "float32" for programs that read single precision alone.

    Raises
    ------
    OptionError
        If ``dtype`` is another word.

    Warns
    -----
    LossWarning
        If lengths are not in metres, in which TELEMAC computes; if float32 rounds coordinates; if
        the boundary comes to a vertex twice, which TELEMAC does not take.
    """
    choice("dtype", dtype, Precision)
    tin = common.require_tin(surface, format_name="Selafin")
    numbers = np.dtype(dtype).newbyteorder(">")
    points = tin.points.astype(numbers)
    _warn(tin, points.astype(np.float64))
    ipobo = _number_boundary(tin)
    mark = "SERAFIND" if dtype == "float64" else "SERAFIN "
    unit = "" if tin.elevation_unit is None else _UNITS.get(tin.elevation_unit.name, "")
    unit = unit or common.format_unit(tin)[:_UNIT]
    with replacing(path) as file:
        write_record(file, f"{'elevations':<{_TITLE - len(mark)}}{mark}".encode())
        write_record(file, _pack(1, 0))
        write_record(file, f"{_BOTTOM[0]:<{_NAME}}{unit:<{_UNIT}}".encode("latin-1", "replace"))
        write_record(file, _pack(1, *[0] * (_PARAMETERS - 1)))
        write_record(file, _pack(len(tin.triangles), len(points), 3, 1))
        write_record(file, (tin.triangles + 1).astype(">i4").tobytes())
        write_record(file, ipobo.astype(">i4").tobytes())
        for column in (points[:, 0], points[:, 1], np.zeros(1, numbers), points[:, 2]):
            write_record(file, column.tobytes())
    if progress is not None:
        progress(1.0)


def _pack(*values: int) -> bytes:
    return np.array(values, ">i4").tobytes()


def _warn(tin: TIN, rounded: Float64Array) -> None:
    units = [tin.elevation_unit]
    if tin.crs is not None:
        units.append(None if tin.crs.is_geographic else tin.crs.horizontal_unit)
    others = sorted({one.name for one in units if one is not None and one != METRE})
    if others or (tin.crs is not None and tin.crs.is_geographic):
        told = "degrees" if tin.crs is not None and tin.crs.is_geographic else " and ".join(others)
        warn(f"{FILE} holds lengths in {told}, and TELEMAC computes in metres.")
    apart = float(np.abs(rounded - tin.points).max())
    if apart > 0:
        warn(f"{FILE}: coordinates were rounded to numbers of 32 bits, by up to {apart:.2g}.")


def _number_boundary(tin: TIN) -> Int64Array:
    """Return the place of each vertex on the boundary, from 1, and 0 of those within."""
    ipobo = np.zeros(len(tin.points), np.int64)
    count = 0
    again = 0
    for ring in tin.boundary:
        first = int(np.argmin(tin.points[ring, :2].sum(axis=1)))
        walk = np.roll(ring, -first)
        new = walk[ipobo[walk] == 0]
        ipobo[new] = np.arange(count + 1, count + 1 + len(new))
        again += len(walk) - len(new)
        count += len(new)
    if again:
        warn(
            f"{FILE}: the boundary comes to {counted(again, 'vertex', 'vertices')} twice, which "
            "TELEMAC does not take."
        )
    return ipobo
