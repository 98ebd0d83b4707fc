"""Lines, rings and water of vector files, in the CRS of the points they belong to.

Whatever GDAL reads will do: GeoPackage, Shapefile, GeoJSON, FlatGeobuf, DXF ... Geometry with
heights keeps them; without, it is draped on the surface. A text table of points is one line, or one
ring, in the order of its rows.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import IO, TYPE_CHECKING, Any, NamedTuple, TypedDict, Unpack, get_args

import numpy as np

from ...base.atomic import as_path
from ...base.crs import CRS, Unit
from ...base.errors import ReadError
from ...base.notes import naming_file
from ...base.policies import BreaklineKind
from ...base.sentences import FILE, height, inflect
from ...tin import Breakline, Water
from ...tin.constraints import as_ring
from ..isolated import as_local_file
from ..reprojection import checking_crs, settle_unit
from .elevations import find_named_unit, list_elevation_columns
from .features import read_features
from .layers import Layer
from .parts import Part, Wanted, find_elevation_factor, split_into_parts
from .point_tables import is_point_table, read_point_table

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ...base.crs import CrsLike, UnitLike

LARGEST_PRIORITY = 2**31 - 1
"""Priorities of lines that a file can give: whole numbers of 32 bits."""

_SHOWN_LETTERS = 60
_WATER_COLUMNS = ("z", "level", "elevation", "height")
_WALL_COLUMNS = {"top": ("top",), "foot": ("foot", "bottom")}


class LineOptions(TypedDict, total=False):
    """How lines are read, as :func:`read_lines` describes."""

    crs: CrsLike | None
    target_unit: UnitLike | None
    elevation_unit: UnitLike | None
    layer: str | None
    where: str | None
    drape: bool
    notes: list[str] | None
    check_crs: bool


class _Lines(NamedTuple):
    """Lines and rings of a file."""

    features: Layer
    parts: list[Part]
    wanted: Wanted


@contextmanager
def _reading(
    path: str | os.PathLike[str] | IO[Any],
    *,
    crs: CrsLike | None = None,
    target_unit: UnitLike | None = None,
    elevation_unit: UnitLike | None = None,
    layer: str | None = None,
    where: str | None = None,
    drape: bool = False,
    notes: list[str] | None = None,
    check_crs: bool = True,
    table: str = "lines",
) -> Iterator[_Lines]:
    """Yield the lines of a file, of which errors speak; ``table`` is what the rows of one make."""
    wanted = Wanted(CRS.of(crs), Unit.of(target_unit), Unit.of(elevation_unit))
    with as_local_file(path) as place, naming_file(as_path(place)), checking_crs(check_crs):
        file = as_path(place)
        if layer is None and where is None and is_point_table(file):
            features = read_point_table(file, wanted, drape=drape, kind=table)
        else:
            features = read_features(file, layer=layer, where=where, lines_only=True)
        parts = split_into_parts(features, wanted, drape=drape, notes=notes)
        yield _Lines(features, parts, wanted)


def read_lines(
    path: str | os.PathLike[str] | IO[Any],
    *,
    kind: BreaklineKind | None = None,
    walls: bool = False,
    **options: Unpack[LineOptions],
) -> list[Breakline]:
    """Read breaklines.

    Lines of several parts become several breaklines; the rings of polygons become closed ones. A
    text table of points is one line, in the order of its rows.
    The columns ``kind`` (hard, soft), ``priority`` and ``name`` are honoured where they exist.

    Parameters
    ----------
    path : path-like or file object
    crs : CRS, str, int or pyproj.CRS, optional
        CRS wanted, that of the points; default the file's own.
    target_unit : Unit or str, optional
        Unit wanted, that of the elevations of the points, if it is known.
    elevation_unit : Unit or str, optional
        Unit of the elevations in the file, if its CRS has no vertical axis that tells.
    layer : str, optional
        Needed if several layers have geometry.
    where : str, optional
        Condition on the columns, as in SQL.
    kind : {"hard", "soft"}, optional
        Kind of all of them, whatever the file says.
    walls : bool
        Make two breaklines along one line of each that has a second elevation in a column: ``top``,
        or ``foot`` or ``bottom``. With both the geometry needs no elevations.
    drape : bool
        Leave heights in the file aside.
    notes : list of str, optional
        What had to be assumed is appended to it, a sentence each.
    check_crs : bool
        Refuse coordinates that contradict their CRS; False takes them as they are, with a note.

    Returns
    -------
    list of Breakline
        (k, 3) with the file's heights in the unit of the points, their datum left alone; or (k, 2)
        to drape. Where a unit is not known it is taken to be the usual one of the CRS, that of the
        eastings (metres above degrees), and a note says so if it made a difference.

    Raises
    ------
    MissingExtraError
        If pyogrio is not installed.
    ReadError
        If the file cannot be read, has no lines, coordinates that are not finite, or columns with
        other values.
    CrsError
        If the lines cannot be brought into the CRS.
    OptionError
        If a unit is unknown, or not that of the file's CRS.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> line = [[0, 0, 5], [4, 3, 6]]
    >>> given = ts.Features(kind="lines", coordinates=line, offsets=[[0, 2]])
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(given, Path(folder, "lines.gpkg"))
    ...     [line.coords.tolist() for line in ts.read_lines(path)]
    [[[0.0, 0.0, 5.0], [4.0, 3.0, 6.0]]]
    """
    with _reading(path, **options) as (features, parts, wanted):
        notes = options.get("notes")
        if notes is not None and not options.get("drape"):
            notes.extend(_describe_unused(features, parts))
        kinds = _parse_kinds(features) if kind is None else [kind] * len(features.numbers)
        priorities, names = _parse_priorities(features), _find_texts(features, "name")
        paths = [(part, part.coords, names[part.row]) for part in parts]
        if walls and not options.get("drape"):
            paths = _find_faces(features, parts, wanted, [] if notes is None else notes)
        elif notes is not None:
            notes.extend(_describe_walls(features))
        return [
            Breakline(coords, kind=kinds[part.row], priority=priorities[part.row], name=name)
            for part, coords, name in paths
        ]


def _find_faces(
    features: Layer, parts: Sequence[Part], wanted: Wanted, notes: list[str]
) -> list[tuple[Part, Float64Array, str]]:
    """Return lines with their names: of walls, by columns of elevations, the top and the foot."""
    levels = {}
    for what, columns in _WALL_COLUMNS.items():
        _require_numbers(features, columns, f"the {what} of a wall")
        levels[what] = _find_levels(features, wanted, columns, f"the {what} of a wall", notes)
    names, found = _find_texts(features, "name"), []
    for part in parts:
        own = {what: column[part.row] for what, column in levels.items()}
        if all(level is None for level in own.values()):
            found.append((part, part.coords, names[part.row]))
            continue
        faces = {}
        for what, level in own.items():
            if level is None and part.coords.shape[1] == 2:
                raise ReadError(
                    f"{features.label(part.row)} has a wall without its {what}: a column "
                    f"({', '.join(_WALL_COLUMNS[what])}) or elevations of the line are needed."
                )
            heights = part.coords[:, 2] if level is None else np.full(len(part.coords), level)
            faces[what] = np.column_stack([part.coords[:, :2], heights])
        beyond = float((faces["foot"] - faces["top"])[:, 2].max())
        if beyond > 0.0:
            raise ReadError(
                f"{features.label(part.row)} has a wall whose foot lies above its top, by up to "
                f"{height(beyond)}."
            )
        name = names[part.row] or "wall"
        found += [(part, faces["top"], name), (part, faces["foot"], f"{name}, foot")]
    return found


def _describe_walls(features: Layer) -> list[str]:
    """Tell of columns that would make walls, if both are there."""
    given = [
        next((name for name in columns if features.find_column(name) is not None), None)
        for columns in _WALL_COLUMNS.values()
    ]
    if None in given:
        return []
    return [
        f"'{features.path.name}': the columns {' and '.join(map(repr, given))} are not used; "
        "walls=, --walls, makes walls of them."
    ]


def _describe_unused(features: Layer, parts: Sequence[Part]) -> list[str]:
    """Tell of a column of elevations beside lines that have none in their geometry."""
    columns = list_elevation_columns(features)
    count = sum(part.coords.shape[1] == 2 for part in parts)
    if not columns or count == 0:
        return []
    lines = inflect("[line|lines] without elevations [takes its|take theirs]", count)
    return [
        f"'{features.path.name}': {count} {lines} from the surface, and not from the column "
        f"'{columns[0]}'; if these are contours, ts.from_contours (--from-contours) reads it."
    ]


def read_plain_lines(
    path: Path, *, layer: str | None, crs: CrsLike | None
) -> tuple[list[Breakline], CRS | None, list[str]]:
    """Return the lines of a file in the plane, with their names, their CRS, and notes.

    Raises as :func:`read_lines`.
    """
    notes: list[str] = []
    with _reading(path, crs=crs, layer=layer, drape=True, notes=notes) as (features, parts, wanted):
        names = _find_texts(features, "name")
        lines = [Breakline(part.coords[:, :2], name=names[part.row]) for part in parts]
        return lines, wanted.crs or features.crs, notes


def read_rings(
    path: str | os.PathLike[str] | IO[Any], **options: Unpack[LineOptions]
) -> list[Float64Array]:
    """Read rings: polygons, all their rings, and closed lines; a text table is one ring.

    Parameters
    ----------
    path : path-like or file object
    **options
        As of :func:`read_lines`, but ``kind``.

    Returns
    -------
    list of (k, 2) or (k, 3) float64 arrays
        Corners in order, the first not repeated.

    Raises
    ------
    MissingExtraError, ReadError, CrsError
        As :func:`read_lines`; ReadError also if a line is not closed.
    LinesError
        If a ring has fewer than three corners.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> ring = [[0, 0, 5], [4, 0, 5], [0, 3, 5], [0, 0, 5]]
    >>> given = ts.Features(kind="polygons", coordinates=ring, offsets=[[0, 4], [0, 1]])
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(given, Path(folder, "lines.gpkg"))
    ...     [len(ring) for ring in ts.read_rings(path)]
    [3]
    """
    with _reading(path, **options, table="polygons") as (features, parts, _):
        return [_require_ring(part, features) for part in parts]


def read_polygons(
    path: str | os.PathLike[str] | IO[Any], **options: Unpack[LineOptions]
) -> list[list[Float64Array]]:
    """Read polygons with their islands, as ``holes`` and ``erase`` of a survey take them.

    Parameters
    ----------
    path : path-like or file object
    **options
        As of :func:`read_lines`, but ``kind``.

    Returns
    -------
    list of lists of (k, 2) or (k, 3) float64 arrays
        Of each polygon the outer ring, then those of its islands; a closed line is one ring.

    Raises
    ------
    MissingExtraError, ReadError, CrsError, LinesError
        As :func:`read_rings`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> ring = [[0, 0, 5], [4, 0, 5], [0, 3, 5], [0, 0, 5]]
    >>> given = ts.Features(kind="polygons", coordinates=ring, offsets=[[0, 4], [0, 1]])
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(given, Path(folder, "lines.gpkg"))
    ...     [[len(ring) for ring in rings] for rings in ts.read_polygons(path)]
    [[3]]
    """
    polygons: list[list[Float64Array]] = []
    with _reading(path, **options, table="polygons") as (features, parts, _):
        for part in parts:
            if part.ring == 0:
                polygons.append([])
            polygons[-1].append(_require_ring(part, features))
    return polygons


def read_water(
    path: str | os.PathLike[str] | IO[Any],
    *,
    z: float | str | None = None,
    **options: Unpack[LineOptions],
) -> list[Water]:
    """Read flat polygons; a column ``name`` is honoured.

    Parameters
    ----------
    path : path-like or file object
    z : float or str, optional
        Height of all of them, in the unit of the points, or the column that holds it. Default the
        column ``z``, ``level``, ``elevation`` or ``height``; without one the heights of the
        corners, if all are equal.
    **options
        As of :func:`read_lines`, but ``kind`` and ``drape``.

    Returns
    -------
    list of Water

    Raises
    ------
    MissingExtraError, ReadError, CrsError, LinesError
        As :func:`read_rings`; ReadError also if a height is missing, or a polygon has islands.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> ring = [[0, 0, 5], [4, 0, 5], [0, 3, 5], [0, 0, 5]]
    >>> given = ts.Features(kind="polygons", coordinates=ring, offsets=[[0, 4], [0, 1]])
    >>> with TemporaryDirectory() as folder:
    ...     path = ts.write(given, Path(folder, "lines.gpkg"))
    ...     [pond.z for pond in ts.read_water(path)]
    [5.0]
    """
    with _reading(path, **options, table="polygons") as (features, parts, wanted):
        _refuse_islands(parts, features, "a water polygon")
        rings = [_require_ring(part, features) for part in parts]
        names, levels = _find_texts(features, "name"), _find_water_levels(features, wanted, z)
        return [
            Water(ring, _require_level(ring, levels, part.row, features), name=names[part.row])
            for ring, part in zip(rings, parts, strict=True)
        ]


def read_fixed_regions(
    path: str | os.PathLike[str], **options: Unpack[LineOptions]
) -> list[Float64Array]:
    """Read regions that earthwork leaves as they are, or that have levels of their own.

    Parameters
    ----------
    path : path-like or file object
    **options
        As of :func:`read_lines`, but ``kind`` and ``drape``.

    Returns
    -------
    list of (k, 2) or (k, 3) float64 arrays
        A ring each; with elevations, all the same, where the column ``z``, ``level``, ``elevation``
        or ``height`` has a level, or else the corners have one.

    Raises
    ------
    MissingExtraError, ReadError, CrsError, LinesError
        As :func:`read_rings`; ReadError also if a polygon has islands, corners of several
        elevations and no level in a column, or a level that is no number.
    """
    with _reading(path, **options, table="polygons") as (features, parts, wanted):
        _refuse_islands(parts, features, "a fixed region")
        what = "the level of a fixed region"
        _require_numbers(features, _WATER_COLUMNS, what)
        told = options.get("notes")
        notes: list[str] = [] if told is None else told
        levels = _find_levels(features, wanted, _WATER_COLUMNS, what, notes)
        rings = []
        for part in parts:
            ring, level = _require_ring(part, features), levels[part.row]
            if level is None and ring.shape[1] == 3 and np.ptp(ring[:, 2]) > 0:
                raise ReadError(
                    f"{features.label(part.row)} has elevations from {height(ring[:, 2].min())} to "
                    f"{height(ring[:, 2].max())}: a fixed region has one level, from a column "
                    f"({', '.join(_WATER_COLUMNS)}) or its corners, or none to keep the ground."
                )
            if level is not None:
                ring = np.column_stack([ring[:, :2], np.full(len(ring), level)])
            rings.append(ring)
        return rings


def _refuse_islands(parts: Sequence[Part], features: Layer, what: str) -> None:
    island = next((part for part in parts if part.ring > 0), None)
    if island is not None:
        raise ReadError(
            f"{features.label(island.row)} has an island, and {what} has one ring: "
            "cut the polygon in two along the island."
        )


def _require_ring(part: Part, features: Layer) -> Float64Array:
    if not part.is_closed:
        raise ReadError(
            f"{features.label(part.row)} is an open line: a polygon or a closed line is needed."
        )
    return as_ring(part.coords, f"the ring of feature {features.numbers[part.row]}")


# ----------------------------------------------------------------------- columns


def _parse_kinds(features: Layer) -> list[BreaklineKind]:
    allowed: dict[str, BreaklineKind] = {kind: kind for kind in get_args(BreaklineKind)}
    kinds = []
    for row, text in enumerate(_find_texts(features, "kind")):
        chosen = allowed.get(text.lower() or "hard")
        if chosen is None:
            raise ReadError(
                f"{features.label(row)} has the kind '{_shorten_text(text)}': "
                f"{' or '.join(allowed)}, or none, is allowed."
            )
        kinds.append(chosen)
    return kinds


def _parse_priorities(features: Layer) -> list[int]:
    priorities = []
    for row, text in enumerate(_find_texts(features, "priority")):
        value = _parse_finite(text or "0")
        if value is None or value != round(value) or abs(value) > LARGEST_PRIORITY:
            raise ReadError(
                f"{features.label(row)} has the priority '{_shorten_text(text)}': a whole number "
                f"from -{LARGEST_PRIORITY} to {LARGEST_PRIORITY} is needed."
            )
        priorities.append(int(value))
    return priorities


def _find_texts(features: Layer, name: str) -> list[str]:
    """Return a column as text, empty where there is no value or no such column."""
    column = features.find_column(name)
    if column is None:
        return [""] * len(features.numbers)
    return [
        "" if (value is None or value != value) else str(value).strip() for value in column.tolist()
    ]


def _shorten_text(text: str) -> str:
    return text if len(text) <= _SHOWN_LETTERS else f"{text[:_SHOWN_LETTERS]}..."


def _parse_finite(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if np.isfinite(value) else None


def _find_water_levels(
    features: Layer, wanted: Wanted, z: float | str | None
) -> list[float | None]:
    """Return the height of each feature, None where the corners must tell."""
    if z is not None and not isinstance(z, str):
        return [float(z)] * len(features.numbers)
    if z is not None and features.find_column(z) is None:
        raise ReadError(
            f"{FILE} has no column '{z}': there is {', '.join(features.columns) or 'none at all'}."
        )
    columns = _WATER_COLUMNS if z is None else (z,)
    return _find_levels(features, wanted, columns, "the height of the water", [])


def _find_levels(
    features: Layer, wanted: Wanted, columns: Sequence[str], what: str, notes: list[str]
) -> list[float | None]:
    """Return the elevation that columns give to each feature, converted; None without one."""
    given = {
        name: list(map(_parse_finite, _find_texts(features, name)))
        for name in columns
        if features.find_column(name) is not None
    }
    levels = {name: found for name, found in given.items() if any(n is not None for n in found)}
    if not levels:
        return [None] * len(features.numbers)
    name, found = next(iter(levels.items()))
    if any(others != found for others in levels.values()):
        end = "; the option `z` names one" if what.endswith("water") else ""
        raise ReadError(
            f"{FILE} has several columns that may hold {what}, and they differ: "
            f"{', '.join(levels)}{end}."
        )
    unit = find_named_unit(name, features)
    if unit is not None:
        wanted = wanted._replace(elevation_unit=settle_unit(wanted.elevation_unit, unit))
        features = features._replace(elevation_unit="")  # is that of the geometries
    factor = find_elevation_factor(features, wanted, notes=notes)
    return [None if level is None else level * factor for level in found]


def _require_numbers(features: Layer, columns: Sequence[str], what: str) -> None:
    """Refuse texts in columns of elevations."""
    for name in columns:
        for row, text in enumerate(_find_texts(features, name)):
            if text and _parse_finite(text) is None:
                raise ReadError(
                    f"{features.label(row)} has the {name} '{_shorten_text(text)}': a number is "
                    f"needed, {what}, or none."
                )


def _require_level(
    ring: Float64Array, levels: list[float | None], row: int, features: Layer
) -> float:
    level = levels[row]
    if level is not None:
        return level
    has_heights = ring.shape[1] == 3
    if has_heights and np.ptp(ring[:, 2]) == 0:
        return float(ring[0, 2])
    found = (
        f"heights from {height(ring[:, 2].min())} to {height(ring[:, 2].max())}"
        if has_heights
        else "none"
    )
    raise ReadError(
        f"{features.label(row)} needs one height and has {found}: water gets it from a column "
        f"({', '.join(_WATER_COLUMNS)}), from corners of one height, or for all from the option "
        "`water_z`."
    )
