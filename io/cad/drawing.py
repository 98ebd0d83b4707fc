"""A drawing as a value, whatever its format, and the TIN or the survey that it becomes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.crs import Unit, require_projected
from ...base.errors import LinesError, OptionError, ReadError, WriteError
from ...base.notes import warn
from ...base.policies import BreaklineKind
from ...base.sentences import FILE, counted
from ...tin import Breakline, Surface, Survey, Water
from ...tin.constraints import as_ring, as_sequence, gather_rings_of_regions
from ...tin.screening import describe_elevations
from ...tin.topology import find_offsets
from ..mesh import FileReference, require_own_crs
from ..reprojection import Placed, place
from .surfaces import Line, Mesh, make_tin_with_lines, merge_equal_points

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray, Float64Array
    from ...base.crs import UnitLike
    from ...base.georeference import Referenced
    from ...base.policies import FacePolicy
    from ...base.results import Features
    from ...tin import TIN, Survey
    from .reference import Declared, Measures

_POLYGONS = ("boundary", "hole", "erase", "island")


@dataclass(frozen=True, kw_only=True, eq=False)
class Drawing:
    """What is read of a drawing, in the coordinates of the file, and what these are."""

    path: Path
    measures: Measures
    """What the file's coordinates are measured in, with notes on it."""
    declared: Declared
    names_axes: bool = False
    """Whether the format says which coordinate is the northing."""
    is_crs_declared: bool = False
    """Whether the caller names the CRS, and the file does not."""
    points: Float64Array = field(default_factory=lambda: np.empty((0, 3)))
    """(n, 3), easting, northing, elevation."""
    attributes: dict[str, AnyArray] = field(default_factory=dict)
    lines: Sequence[Line] = ()
    mesh: Mesh | None = None
    skipped: dict[str, int] = field(default_factory=dict)
    notes: Sequence[str] = ()

    def to_tin(self, faces: FacePolicy) -> TIN:
        """Return the TIN of the triangles, with the lines that run along their edges."""
        mesh, measures = self.mesh, self.measures
        require_own_crs(measures.source, self.declared.crs)
        if mesh is None:
            raise ReadError(f"{FILE} has no faces.")
        mesh = merge_equal_points(mesh._replace(points=measures.apply(mesh.points)))
        return make_tin_with_lines(
            mesh._replace(notes=[*measures.notes, *mesh.notes, *self.notes]),
            [one._replace(coordinates=measures.apply(one.coordinates)) for one in self.lines],
            reference=FileReference(measures.source, measures.elevation_unit, self.is_crs_declared),
            faces=faces,
        )

    def to_survey(self) -> Survey:
        """Return the points and lines in the CRS wanted.

        Raises
        ------
        ReadError
            If a coordinate is not finite, or would be in degrees, or a line is none.
        CrsError
            If they cannot be transformed.
        """
        parts = [self.points, *(line.coordinates for line in self.lines)]
        placed, rows = self._place(parts)
        notes = [*self.measures.notes, *placed.notes, *self.notes]
        try:
            lines = _gather_lines(self.lines, rows[1:], notes)
            return Survey(
                points=rows[0],
                attributes=self.attributes,
                crs=placed.crs,
                elevation_unit=placed.elevation_unit,
                source=self.path.name,
                skipped=self.skipped,
                notes=[*notes, *describe_elevations(rows[0][:, 2])],
                **lines,
            )
        except LinesError as error:
            raise ReadError(f"{error}") from error

    def _place(self, parts: Sequence[Float64Array]) -> tuple[Placed, list[Float64Array]]:
        """Bring arrays of two or three columns into the CRS wanted, all at once."""
        offsets = find_offsets(len(one) for one in parts)
        together = np.zeros((int(offsets[-1]), 3))
        for one, start in zip(parts, offsets.tolist(), strict=False):
            together[start : start + len(one), : one.shape[1]] = one
        if not np.isfinite(together).all():
            row = together[np.argmin(np.isfinite(together).all(axis=1))]
            raise ReadError(f"{FILE} has coordinates that are not finite (first: {row.tolist()}).")
        placed = place(
            self.measures.apply(together),
            source=self.measures.source,
            target=self.declared.crs,
            unit=self.measures.elevation_unit,
            looks_at_area=False,
            looks_at_order=not self.names_axes,
        )
        return placed, [
            placed.points[start : start + len(one), : one.shape[1]]
            for one, start in zip(parts, offsets.tolist(), strict=False)
        ]


# ------------------------------------------------------------------ what is read


def _gather_lines(
    lines: Iterable[Line], places: Iterable[Float64Array], notes: list[str]
) -> dict[str, Any]:
    """Return breaklines, rings and water as a survey has them."""
    breaklines, water = [], []
    polygons: dict[object, tuple[str, list[Float64Array]]] = {}
    for line, rows in zip(lines, places, strict=True):
        if line.kind == "water" and rows.shape[1] == 3:
            water.append(Water(as_ring(rows, "water"), float(rows[0, 2]), name=line.name))
        elif line.kind in _POLYGONS:
            key = (line.kind, len(polygons) if line.polygon is None else line.polygon)
            rings = polygons.setdefault(key, (line.kind, []))[1]
            rings.append(as_ring(rows, line.place or line.kind))
        else:
            own: BreaklineKind = "soft" if line.kind == "soft" else "hard"
            breaklines.append(Breakline(rows, kind=own, name=line.name, priority=line.priority))
    found: dict[str, list[list[Float64Array]]] = {kind: [] for kind in _POLYGONS}
    for kind, rings in polygons.values():
        found[kind].append(rings)
    islands = [rings[0] for rings in found["island"]]
    holes = found["hole"]
    if not islands:
        left = 0
    else:
        shapely = optional.load("shapely")
        areas = [shapely.Polygon(rings[0][:, :2]) for rings in holes]
        left = 0
        for island in islands:
            place = shapely.Point(island[0, :2])
            holder = next((k for k, area in enumerate(areas) if area.intersects(place)), None)
            if holder is None:
                left += 1
            else:
                holes[holder].append(island)
    if left:
        what = counted(left, "boundary", "boundaries")
        notes.append(f"{what} of type island in no void left out.")
    unwrapped = {
        kind: [rings[0] if len(rings) == 1 else rings for rings in found[kind]]
        for kind in _POLYGONS
    }
    return {
        "breaklines": breaklines,
        "boundary": unwrapped["boundary"],
        "holes": unwrapped["hole"],
        "erase": unwrapped["erase"],
        "water": water,
    }


# ------------------------------------------------------------------ what is written


def scale_elevations(rows: Float64Array, factor: float) -> Float64Array:
    """Return coordinates with their elevations, if there are any, times a factor."""
    return rows if factor == 1.0 or rows.shape[1] == 2 else rows * [1.0, 1.0, factor]


def list_lines(obj: TIN | Survey | Features, factor: float) -> Iterator[Line]:
    """Yield the lines and closed rings of an object, elevations times a factor.

    The ``source`` of a line of features is the row of its feature.
    """
    if isinstance(obj, Surface):
        points = scale_elevations(obj.points, factor)
        stated = zip(obj.lines.kinds, obj.lines.names, obj.lines.sources.tolist(), strict=True)
        for chain, own in zip(obj.lines.chains(), stated, strict=True):
            yield Line(points[chain], *own)
    elif isinstance(obj, Survey):
        for line in _list_lines_of_survey(obj):
            yield line._replace(coordinates=scale_elevations(line.coordinates, factor))
    else:
        names = obj.columns.get("name")
        scaled = scale_elevations(obj.coordinates, factor)
        is_known = scaled.shape[1] == 2 or bool(np.isfinite(scaled).all())
        for owner, start, end in _iterate_parts(obj):
            rows = scaled[start:end]
            if not is_known and not np.isfinite(rows).all():
                rows = rows[:, :2]
            yield Line(rows, "hard", "" if names is None else str(names[owner]), owner)


def _list_lines_of_survey(survey: Survey) -> list[Line]:
    given = (one if isinstance(one, Breakline) else Breakline(one) for one in survey.breaklines)
    lines = [Line(one.coords, one.kind, one.name, priority=one.priority) for one in given]
    for regions, kind in (
        (survey.boundary, "boundary"),
        (survey.holes, "hole"),
        (survey.erase, "erase"),
    ):
        polygons = gather_rings_of_regions(as_sequence(regions, kind), kind)
        for number, rings in enumerate(polygons):
            lines += [Line(_close(ring), kind, polygon=str(number)) for ring in rings]
    for water in survey.water:
        ring = np.column_stack([water.ring, np.full(len(water.ring), water.z)])
        lines.append(Line(_close(ring), "water", water.name))
    return lines


def _close(ring: Float64Array) -> Float64Array:
    return np.concatenate([ring, ring[:1]])


def _iterate_parts(features: Features) -> Iterator[tuple[int, int, int]]:
    """Iterate over the rows of features of lines and rings, and where these begin and end."""
    owners = np.arange(len(features))
    for level in reversed(features.offsets[1:]):
        owners = np.repeat(owners, np.diff(level))
    offsets = features.offsets[0].tolist()
    return zip(owners.tolist(), offsets[:-1], offsets[1:], strict=True)


def choose_length_unit(
    obj: Referenced,
    unit: UnitLike | None,
    *,
    is_known: Callable[[Unit], bool],
    format_name: str,
) -> tuple[Unit | None, float]:
    """Return the unit of all lengths in a file, and the factor that brings elevations to it.

    Parameters
    ----------
    obj : TIN, Survey, Features or Alignment
    unit : Unit or str, optional
        Declared by the caller, where the CRS does not tell.
    is_known : callable
        Whether the format has a unit.
    format_name : str

    Warns
    -----
    LossWarning
        If the unit is not known, or elevations are converted.
    """
    declared = Unit.of(unit)
    chosen = declared or obj.elevation_unit
    if obj.crs is not None:
        require_projected(
            obj.crs,
            f"Cannot write {FILE}: {format_name} holds lengths, and {{crs}} measures in degrees: "
            "reproject first.",
        )
        chosen = obj.crs.horizontal_unit
        if declared is not None and declared != chosen:
            raise OptionError("unit", declared.name, f"{chosen.name}, the unit of {obj.crs.label}")
    if chosen is not None and not is_known(chosen):
        raise WriteError(
            f"Cannot write {FILE}: {format_name} has no unit {chosen.name}; it has metre, foot, "
            "US survey foot and their like."
        )
    return chosen, _find_factor(obj.elevation_unit, chosen, format_name)


def choose_name(obj: object, name: str | None) -> str:
    """Return what a surface is called in a file, by default its own name."""
    if name is None:
        return (obj.name.strip() if isinstance(obj, Surface) else "") or "surface"
    if not isinstance(name, str) or not name.strip():
        raise OptionError("name", name, "the name of a surface")
    return name.strip()


def _find_factor(known: Unit | None, unit: Unit | None, format_name: str) -> float:
    if unit is None:
        warn(
            f"{FILE} has no units, since none are known: programs that read it will guess; the "
            "option `unit` names one."
        )
        return 1.0
    if known is None or known == unit or known.metres is None or unit.metres is None:
        return 1.0
    warn(
        f"{FILE}: elevations were converted from {known.name} to {unit.name}, as {format_name} "
        "has one unit for all lengths."
    )
    return known.metres / unit.metres
