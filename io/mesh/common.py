"""What the mesh formats share: a file's bytes, polygons cut into triangles, errors of the file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import wraps
from inspect import signature
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from ...base.crs import CRS, Unit
from ...base.errors import CrsError, FormatError, OptionError, PointsError, ReadError
from ...base.sentences import FILE, counted, height
from ...tin import TIN, Surface, Survey
from ...tin.checking import describe_oddities
from ...tin.screening import find_suspect_elevations
from ...tin.topology import edge_keys
from ..reprojection import look_at_crs, settle_unit
from .surface_part import make_surface

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.policies import FacePolicy

_LARGEST_SINGLE = float(np.finfo(np.float32).max)
_LEAST_MARK = 999.0
"""The smallest number that programs write for no data."""

_MUCH = 1e-3
"""CRS units between coordinates beyond which their rounding is told."""


class Fans(NamedTuple):
    """Triangles of polygons."""

    triangles: Int64Array
    """(m, 3)."""
    polygon: Int64Array
    """(m,), the polygon that each triangle comes from."""
    notes: tuple[str, ...] = ()
    """Whether polygons were cut, which has more than one way."""


def read_content(path: Path) -> bytes:
    """Return the bytes of a file, or raise a ReadError that says why not."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise ReadError(f"Cannot read '{path}': {error.strerror or error}.", path=path) from error


def require_writable(surface: object) -> TIN | Survey:
    """Return a TIN or a survey; refuse anything else."""
    if isinstance(surface, Surface | Survey):
        return cast("TIN | Survey", surface)  # writers ask it alone
    raise FormatError(
        f"Cannot write {FILE}: a {type(surface).__name__} is neither a TIN nor a Survey."
    )


def require_tin(surface: object, *, format_name: str) -> TIN:
    """Return a TIN; refuse a survey, which has no faces, and anything else."""
    writable = require_writable(surface)
    if isinstance(writable, Surface):
        return writable
    raise FormatError(
        f"Cannot write {FILE}: {format_name} holds triangles, and a survey has none; "
        "triangulate it first."
    )


def format_crs(crs: CRS) -> str:
    """Return the text of a CRS without line breaks, for a comment."""
    return " ".join(part.strip() for part in str(crs).splitlines())


class FileReference(NamedTuple):
    """What the coordinates of a file are measured in; None for what is not known."""

    crs: CRS | None
    elevation_unit: Unit | None
    is_declared: bool = False
    """Whether the caller names the CRS, and the file does not."""


def choose_reference(
    crs: CrsLike | None,
    elevation_unit: UnitLike | None,
    *,
    found_crs: str | None = None,
    found_unit: str | None = None,
) -> FileReference:
    """Return CRS and unit of elevations: what the file says, else what the caller declares.

    Raises
    ------
    CrsError
        If PROJ does not know the CRS, or the caller names another than the file.
    OptionError
        If the unit is unknown, or another than that of the file or the CRS.
    ReadError
        If the file names a unit that is none.
    """
    declared, own = CRS.of(crs), _find_crs(found_crs, crs is not None)
    require_own_crs(own, declared)
    system = declared if own is None else own
    try:
        known = Unit.of(found_unit or None)
    except OptionError:
        raise ReadError(f"'{found_unit}' is no unit of elevations.") from None
    vertical = None if system is None else system.vertical_unit
    unit = settle_unit(Unit.of(elevation_unit), known or vertical)
    return FileReference(system, unit, is_declared=own is None and system is not None)


def require_own_crs(own: CRS | None, declared: CRS | None) -> None:
    """Refuse to reproject a TIN."""
    if declared is not None and own is not None and not own.is_same(declared):
        raise CrsError(
            f"{FILE} is in {own.label}, and {declared.label} is another CRS: a TIN is not "
            "reprojected, since its triangles would be no Delaunay triangles there; build it anew "
            "from its points.",
            crs=declared,
        )


def _find_crs(text: str | None, is_declared: bool) -> CRS | None:
    """Look the CRS of a file up; one that is unknown does no harm if the caller names another."""
    try:
        return CRS.of(text or None)
    except CrsError:
        if is_declared:
            return None
        raise


def format_unit(surface: TIN | Survey) -> str:
    """Return the name of the unit of elevations for a file; "" if it is not known."""
    return "" if surface.elevation_unit is None else surface.elevation_unit.text


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """What a file holds: vertices, polygons, and what it says of them."""

    points: Float64Array
    """(n, 3)."""
    corners: AnyArray = field(default_factory=lambda: np.empty(0, np.int64))
    """(k,), vertex numbers of all polygons, one after the other."""
    offsets: AnyArray = field(default_factory=lambda: np.zeros(1, np.int64))
    """(n_polygons + 1,); a file without polygons gives a survey."""
    constrained: BoolArray | None = None
    """(n_polygons, 3), of edges opposite corners, where all polygons are triangles."""
    constrained_edges: AnyArray | None = None
    """(k, 2), the same by their vertices."""
    attributes: Mapping[str, AnyArray] = field(default_factory=dict)
    crs: str | None = None
    elevation_unit: str | None = None
    notes: Sequence[str] = ()
    rounding: float = 0.0
    """As :func:`make_surface` takes it."""
    add_lines: Callable[[TIN], TIN] | None = None
    """Adds the lines of the file to the TIN."""


def mesh_reader(parse: Callable[..., Mesh]) -> Callable[..., TIN | Survey]:
    """Make a reader of a function that says what a file holds, by its path and options.

    The reader takes the options of every mesh too: ``crs``, ``elevation_unit`` and ``faces``.
    """

    @wraps(parse)
    def read(
        path: Path,
        *,
        crs: CrsLike | None = None,
        elevation_unit: UnitLike | None = None,
        faces: FacePolicy = "most",
        **options: Any,
    ) -> TIN | Survey:
        mesh = parse(path, **options)
        reference = choose_reference(
            crs, elevation_unit, found_crs=mesh.crs, found_unit=mesh.elevation_unit
        )
        return build_mesh(mesh, path.name, reference=reference, faces=faces)

    usual = signature(read, follow_wrapped=False).parameters
    first, *own = signature(parse).parameters.values()
    order = [first, usual["crs"], usual["elevation_unit"], *own, usual["faces"]]
    vars(read)["__signature__"] = signature(parse).replace(parameters=order)
    return read


def build_mesh(
    mesh: Mesh, source: str, *, reference: FileReference, faces: FacePolicy
) -> TIN | Survey:
    """Make a TIN of what a file holds, or a survey of a file without polygons."""
    points, attributes = mesh.points, dict(mesh.attributes)
    if len(mesh.offsets) == 1:
        return make_survey(
            points, source, attributes=attributes, reference=reference, notes=mesh.notes
        )
    fans = cut_into_fans(mesh.corners, mesh.offsets, points)
    flags = mesh.constrained
    if flags is not None and len(flags) != len(fans.triangles):
        flags = None
    if flags is None and mesh.constrained_edges is not None:
        flags = flag_edges(fans.triangles, mesh.constrained_edges, len(points))
    tin = make_tin(
        points,
        fans.triangles,
        constrained=flags,
        reference=reference,
        attributes=attributes,
        notes=(*mesh.notes, *fans.notes),
        faces=faces,
        rounding=mesh.rounding,
    )
    return tin if mesh.add_lines is None else mesh.add_lines(tin)


def make_tin(
    points: AnyArray,
    triangles: AnyArray,
    *,
    constrained: BoolArray | None = None,
    reference: FileReference,
    attributes: Mapping[str, AnyArray] | None = None,
    notes: Sequence[str] = (),
    faces: FacePolicy = "most",
    rounding: float = 0.0,
    looks_at_crs: bool = True,
) -> TIN:
    """Make a TIN of what a file holds; what makes none is a fault of the file.

    What is odd about it is told in the notes of its report, behind the ``notes`` given. Whether
    the coordinates contradict their CRS is looked at, unless the reader has done so.

    Parameters
    ----------
    faces : {"most", "all", "surface"}
        As :func:`make_surface` takes it.
    rounding : float
        Likewise.

    Raises
    ------
    ReadError
        As :func:`make_surface` raises PointsError.
    CrsError
        If the coordinates contradict their CRS.
    """

    def make(kept: AnyArray | slice) -> TIN:
        return TIN.from_triangles(
            points,
            np.asarray(triangles)[kept],
            constrained=None if constrained is None else constrained[kept],
            crs=reference.crs,
            elevation_unit=reference.elevation_unit,
            attributes=attributes,
        )

    try:
        tin, noted = make_surface(make, points, triangles, faces=faces, rounding=rounding)
    except PointsError as error:
        raise ReadError(f"{FILE} holds no TIN. {error}") from error
    placed = _look_at_crs(tin.points, reference) if looks_at_crs else ()
    noted = [*notes, *noted, *placed, *describe_oddities(tin)]
    noted += [
        f"{counted(one.count, 'vertex', 'vertices')} {'has' if one.count == 1 else 'have'} the "
        f"elevation {one.value:g}, far from the others ({height(one.lowest)} to "
        f"{height(one.highest)}): it may "
        "stand for no data."
        for one in find_suspect_elevations(tin.points[:, 2])
        if abs(one.value) >= _LEAST_MARK  # a flat mesh may well have one tower
    ]
    return add_notes(tin, noted) if noted else tin


def _look_at_crs(points: Float64Array, reference: FileReference) -> tuple[str, ...]:
    return look_at_crs(points, reference.crs, is_declared=reference.is_declared)


def measure_rounding(points: Float64Array, dtype: Any) -> float:
    """Return how far apart the numbers are that coordinates of a file can have; 0 for doubles.

    Parameters
    ----------
    points : (n, 3) float64 array
        As they stand in the file.
    dtype : dtype
        As which it holds them.
    """
    if np.dtype(dtype).newbyteorder("=") != np.float32 or len(points) == 0:
        return 0.0
    largest = float(np.abs(points[:, :2]).max())
    return float(np.spacing(np.float32(largest))) if largest < _LARGEST_SINGLE else 0.0


def describe_single_precision(points: Float64Array, dtype: Any) -> list[str]:
    """Tell how far apart the numbers are that coordinates of a file can have, if that is much.

    Parameters
    ----------
    points : (n, 3) float64 array
    dtype : dtype
        As which the file holds coordinates.
    """
    step = measure_rounding(points, dtype)
    if step < _MUCH:
        return []
    largest = float(np.abs(points[:, :2]).max())
    return [
        f"Coordinates of the file are numbers of 32 bits: those about {largest:,.10g} are rounded "
        f"to multiples of {step:g}."
    ]


def add_notes(tin: TIN, notes: Sequence[str]) -> TIN:
    """Return a TIN with further notes in its report."""
    return tin.replace(report=replace(tin.report, notes=[*tin.report.notes, *notes]))


def make_survey(
    points: Float64Array,
    source: str,
    *,
    attributes: dict[str, AnyArray] | None = None,
    reference: FileReference,
    notes: Sequence[str] = (),
) -> Survey:
    """Make a survey of the points of a file."""
    if len(points) == 0:
        raise ReadError(f"{FILE} holds no points.")
    wrong = ~np.isfinite(points).all(axis=1)
    if wrong.any():
        row, count = int(np.argmax(wrong)), int(wrong.sum())
        raise ReadError(
            f"{count} {'point is' if count == 1 else 'points are'} not finite (first: "
            f"point {row}, {points[row].tolist()})."
        )
    return Survey(
        points=points,
        attributes=attributes or {},
        crs=reference.crs,
        elevation_unit=reference.elevation_unit,
        source=source,
        notes=[*notes, *_look_at_crs(points, reference)],
    )


def cut_into_fans(corners: Int64Array, offsets: Int64Array, points: Float64Array) -> Fans:
    """Cut polygons into triangles about their first corner, quadrilaterals along an inner diagonal.

    Parameters
    ----------
    corners : (k,) int array
        Vertex numbers of all polygons, one after the other.
    offsets : (n_polygons + 1,) int array
    points : (n, 3) float64 array

    Raises
    ------
    ReadError
        If a polygon has fewer than three corners, or a vertex number is out of range.
    """
    require_vertices(corners, offsets, len(points))
    lengths = np.diff(offsets)
    if (lengths == 3).all():
        return Fans(corners.reshape(-1, 3), np.arange(len(lengths)))
    # Begin a quadrilateral one corner later where its first diagonal runs outside of it.
    starts = offsets[:-1][np.diff(offsets) == 4]
    slots = starts[:, None] + np.arange(4)
    quads = corners[slots]
    a, b, c, d = (points[quads[:, k], :2] for k in range(4))
    with np.errstate(over="ignore", invalid="ignore"):  # what is not finite is refused later
        outside = _cross_in_plane(b - a, c - a) * _cross_in_plane(c - a, d - a) < 0
    corners = corners.copy()
    corners[slots[outside]] = np.roll(quads[outside], -1, axis=1)
    polygon = np.repeat(np.arange(len(lengths)), lengths - 2)
    within = np.arange(len(polygon)) - np.repeat(
        np.cumsum(lengths - 2) - (lengths - 2), lengths - 2
    )
    start = offsets[:-1][polygon]
    triangles = [corners[start], corners[start + within + 1], corners[start + within + 2]]
    count = int((lengths > 3).sum())
    note = (
        f"{counted(count, 'polygon')} of the file {'was' if count == 1 else 'were'} cut into "
        "triangles: the file does not tell along which diagonals."
    )
    return Fans(np.stack(triangles, axis=1), polygon, (note,))


def require_vertices(corners: Int64Array, offsets: Int64Array, n_vertices: int) -> None:
    """Refuse polygons of fewer than three corners, or of vertices that there are not."""
    lengths = np.diff(offsets)
    if (lengths < 3).any():
        row = int(np.argmax(lengths < 3))
        raise ReadError(
            f"face {row} has {lengths[row]} "
            f"corner{'' if lengths[row] == 1 else 's'}: 3 or more are needed."
        )
    wrong = (corners < 0) | (corners >= n_vertices)
    if wrong.any():
        first = int(np.argmax(wrong))
        row = int(np.searchsorted(offsets, first, side="right")) - 1
        raise ReadError(
            f"face {row} names vertex {corners[first]}, and the file has the vertices "
            f"0 to {n_vertices - 1}."
        )


def join_places(rows: AnyArray) -> tuple[AnyArray, Int64Array]:
    """Return the distinct rows in the order in which they first come, and the number of each row.

    Rows are the same where all numbers are, -0.0 and 0.0 too.
    """
    rows = rows + rows.dtype.type(0)  # turns -0.0 into 0.0
    order = np.lexsort(rows.T[::-1])  # stable: of equal ones the first comes first
    is_first = np.ones(len(order), np.bool_)
    is_first[1:] = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    stands_for = np.empty(len(order), np.int64)
    stands_for[order] = order[is_first][np.cumsum(is_first) - 1]
    is_kept = stands_for == np.arange(len(order))
    return rows[is_kept], (np.cumsum(is_kept) - 1)[stands_for]


def flag_edges(triangles: AnyArray, edges: AnyArray, n_vertices: int) -> BoolArray:
    """Return which edges of triangles, each opposite a corner, are among some, (m, 3) flags."""
    sides = np.stack([np.roll(triangles, -1, axis=1), np.roll(triangles, -2, axis=1)], axis=2)
    return np.isin(edge_keys(sides, n_vertices), edge_keys(edges, n_vertices))


def _cross_in_plane(u: Float64Array, v: Float64Array) -> Float64Array:
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
