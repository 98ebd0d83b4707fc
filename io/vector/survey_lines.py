"""A survey gains the lines of vector files."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import as_path
from ...base.checks import is_collection, require_type
from ...base.errors import OptionError, ReadError
from ...base.notes import naming_file
from ...base.sentences import coordinate, counted, inflect
from ...tin import Bounds, Breakline, Survey, Water
from .reading import read_lines, read_polygons, read_water

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array
    from ...base.crs import UnitLike
    from ...tin import Survey

    Source = str | os.PathLike[str]

_FAR = 10.0
"""Lines further from the points than this many diagonals of their extent are somewhere else."""


def with_lines(
    survey: Survey,
    *,
    breaklines: Sequence[Source] = (),
    soft_breaklines: Sequence[Source] = (),
    boundary: Sequence[Source] = (),
    holes: Sequence[Source] = (),
    erase: Sequence[Source] = (),
    water: Sequence[Source] = (),
    water_z: float | str | None = None,
    walls: bool = False,
    drape: bool = False,
    elevation_unit: UnitLike | None = None,
    check_crs: bool = True,
) -> Survey:
    """Add the lines of vector files to a survey, in its CRS.

    Parameters
    ----------
    survey : Survey
    breaklines, soft_breaklines, boundary, holes, erase, water : sequence of path-like
        Files; ``"plan.gpkg:kerbs"`` names a layer. The survey's own lines come first. The islands
        of polygons stay: they are no part of a hole, are not erased, and lie outside a boundary.
    water_z : float or str, optional
        Height of the water, or the column that holds it.
    walls : bool
        Make two breaklines along one line of each that has a second elevation in a column ``top``,
        ``foot`` or ``bottom``, for the ``walls`` of :func:`tinsmith.triangulate`.
    drape : bool
        Take the heights of breaklines, boundary and holes from the surface, whatever the files
        say.
    elevation_unit : Unit or str, optional
        Unit of the elevations in the files, where their CRS has no vertical axis that tells.
    check_crs : bool
        Refuse coordinates that contradict their CRS; False takes them as they are, with a note.

    Returns
    -------
    Survey
        What had to be assumed is in its notes.

    Raises
    ------
    MissingExtraError, ReadError, CrsError, LinesError
        As :func:`tinsmith.io.read_lines`; ReadError also if lines lie far away from the points, or
        if polygons of a boundary overlap.

    Examples
    --------
    >>> from tinsmith import Survey
    >>> with_lines(Survey(points=np.zeros((3, 3))))
    <Survey: 3 points, crs unknown>
    """
    require_type("survey", survey, Survey)
    notes = list(survey.notes)
    units: dict[str, Any] = {
        "crs": survey.crs,
        "target_unit": survey.elevation_unit,
        "elevation_unit": elevation_unit,
        "check_crs": check_crs,
    }

    def read(reader: Callable[..., list[Any]], sources: Iterable[Source], **how: Any) -> list[Any]:
        found = []
        if not is_collection(sources):
            raise OptionError("files of lines", sources, "a list of files")
        for source in list(sources):
            path, layer = split_layer(source)
            with naming_file(path):
                lines = reader(path, layer=layer, notes=notes, **units, **how)
                _require_near(survey, [xy for line in lines for xy in _list_coords(line)])
                if reader is read_polygons and sources is boundary:
                    notes.extend(note_nesting(lines, path))
            found += lines
        return found

    return replace(
        survey,
        breaklines=[
            *survey.breaklines,
            *read(read_lines, breaklines, drape=drape, walls=walls),
            *read(read_lines, soft_breaklines, kind="soft", drape=drape, walls=walls),
        ],
        boundary=[*survey.boundary, *chain(*read(read_polygons, boundary, drape=drape))],
        holes=[*survey.holes, *map(_unwrap_ring, read(read_polygons, holes, drape=drape))],
        erase=[*survey.erase, *map(_unwrap_ring, read(read_polygons, erase, drape=True))],
        water=[*survey.water, *read(read_water, water, z=water_z)],
        notes=notes,
    )


def _unwrap_ring(
    rings: list[Float64Array],
) -> Float64Array | list[Float64Array]:
    """Return a polygon without islands as its ring."""
    return rings[0] if len(rings) == 1 else rings


def split_layer(source: Source) -> tuple[Path, str | None]:
    """Split a layer's name off a path, unless a file of the whole name exists."""
    path = as_path(source)
    before, colon, layer = str(source).rpartition(":")
    if not path.exists() and colon and layer and Path(before).exists():
        return Path(before), layer
    return path, None


def _list_coords(line: Breakline | Water | list[Float64Array]) -> list[Float64Array]:
    if isinstance(line, list):
        return line
    return [line.coords if isinstance(line, Breakline) else line.ring]


def _require_near(survey: Survey, coords: Sequence[Float64Array]) -> None:
    """Refuse lines that lie so far away that their CRS must be wrong."""
    if len(survey) == 0:
        return
    require_near(survey.bounds, Bounds.of(np.concatenate([line[:, :2] for line in coords])))


def require_near(ours: Bounds, theirs: Bounds) -> None:
    """Refuse bounds of lines that lie far away from those of points."""
    reach = _FAR * ours.diagonal
    apart = max(
        theirs.xmin - ours.xmax,
        ours.xmin - theirs.xmax,
        theirs.ymin - ours.ymax,
        ours.ymin - theirs.ymax,
    )
    if apart > reach:
        raise ReadError(
            f"its lines are nowhere near the points (lines: {_format_extent(theirs)}; "
            f"points: {_format_extent(ours)}): check the CRS of both."
        )


def _format_extent(box: Bounds) -> str:
    return (
        f"x {coordinate(box.xmin)} to {coordinate(box.xmax)}, y {coordinate(box.ymin)} "
        f"to {coordinate(box.ymax)}"
    )


def note_nesting(polygons: Sequence[Sequence[Float64Array]], path: Path) -> list[str]:
    """Tell of polygons that lie within others, where they cut the surface away.

    Parameters
    ----------
    polygons : sequence of sequences of (k, 2) or (k, 3) arrays
        Of each the outer ring and its islands.
    path : Path
        For sentences.
    """
    shapely = optional.load("shapely")
    if len(polygons) < 2:
        return []
    shapes = shapely.make_valid(np.array([_shape(rings) for rings in polygons], object))
    one, other = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    one, other = one[one < other], other[one < other]
    shared = shapely.area(shapely.intersection(shapes[one], shapes[other]))
    is_within = shapely.covers(shapes[one], shapes[other]) | shapely.covers(
        shapes[other], shapes[one]
    )
    smaller = np.minimum(shapely.area(shapes[one]), shapely.area(shapes[other]))
    is_equal = shapely.equals(shapes[one], shapes[other])
    wrong = ((shared > _ROUNDING * smaller) & ~is_within) | is_equal
    if wrong.any():
        a, b = int(one[np.argmax(wrong)]), int(other[np.argmax(wrong)])
        count = int(wrong.sum())
        pairs = inflect(f"{counted(count, 'pair')} of boundary polygons [overlaps|overlap]", count)
        raise ReadError(
            f"{pairs} (first: number {a} and {b}, counted from 0): unite "
            "them, or cut one along the other."
        )
    count = int(is_within.sum())
    if count == 0:
        return []
    what = inflect(f"{counted(count, 'polygon')} [lies|lie]", count)
    return [f"'{path.name}': {what} within another of the boundary: the surface is cut out there."]


_ROUNDING = 1e-9
"""Neighbours whose common border was rounded share slivers, of this part of their area at most."""


def _shape(rings: Sequence[Float64Array]) -> Any:
    shapely = optional.load("shapely")
    outer, *islands = [ring[:, :2] for ring in rings]
    return shapely.Polygon(outer, islands)
