"""Merge surfaces that lie beside each other and over each other, by priority."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ....base.checks import require_distance, require_tin
from ....base.crs import require_lengths
from ....base.errors import OptionError
from ....base.georeference import agree
from ....base.products import product
from ....base.progress import Progress
from ....base.sentences import coordinate, counted, inflect
from .blending import blend_into, find_strip, measure_seam
from .pasting import join_surfaces
from .seams import find_area

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ....base.georeference import Reference
    from ....tin import TIN


@product
def merge(
    surfaces: Sequence[TIN],
    *,
    blend: float = 0.0,
    progress: Callable[[float], None] | None = None,
) -> TIN:
    """Put surfaces that lie beside each other, or over each other, together to one.

    Where several lie over each other the first one of them counts.

    Parameters
    ----------
    surfaces : sequence of TIN
        Two or more, in the order of their priority.
    blend : float
        Width of the strip in which one surface goes over into the one below, CRS units: along the
        boundary of the upper one, on its side. There elevations go linearly with the distance from
        those of the lower one to those of the upper one, at the vertices of both. 0 for no strip.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, surface by surface. What it raises ends
        the call.

    Returns
    -------
    TIN
        In the CRS and unit of the first surface that has one. Vertices keep their attributes; those
        made along seams have none. Lines stay, those of a lower surface up to the seam, a hard
        breakline named "seam". ``report.notes`` tell for each surface how much of it lies under
        those before it, and how far they are apart along the seam: on average and at most; and
        gaps, which are left.

    Raises
    ------
    CrsError
        If the CRSs differ, or are known of some only; if it cannot be told whether elevations are
        in one unit; if they are degrees and a strip is asked for.
    OptionError
        If fewer than two surfaces are given, or the width is no distance.
    PointsError
        If boundaries are so near to each other that rounding leaves no surface between them.

    Notes
    -----
    The surfaces are pasted one into the other, the last ones first, as :func:`tinsmith.paste` does.
    Without a strip triangles of a lower surface that a seam cuts are joined to the upper one, whose
    elevations count along the seam. With one, those of the lower surface count there, which so
    stays as it is beyond the seam; the upper one stays as it is beyond the strip. Beside the lower
    surface there is no strip.

    Examples
    --------
    >>> import tinsmith as ts
    >>> west = ts.triangulate([[0, 0, 5], [6, 0, 5], [6, 6, 5], [0, 6, 5]])
    >>> east = ts.triangulate([[2, 0, 6], [9, 0, 6], [9, 6, 6], [2, 6, 6]])
    >>> merged = ts.merge([west, east], blend=2.0)
    >>> merged.interpolate([[1, 3], [5, 3], [8, 3]]).round(9)
    array([5. , 5.5, 6. ])
    """
    given = _require_surfaces(surfaces)
    require_distance("blend", blend)
    done = Progress(progress)
    agreed = agree(given, [f"surface {number}" for number in range(1, len(given) + 1)])
    if blend:
        require_lengths(agreed.crs)
    levelled = [
        _convert(one, factor, agreed) for one, factor in zip(given, agreed.factors, strict=True)
    ]
    together = replace(agreed, factors=(1.0, 1.0), notes=())
    merged = levelled[-1]
    notes: list[str] = []
    for number in range(len(given) - 1, 0, -1):
        upper = levelled[number - 1]
        seam = measure_seam(upper, merged)
        notes = [seam.describe(f"Surface {number}", agreed, blend), *notes]
        strip = find_strip(upper, merged, blend) if blend else None
        if strip is not None:
            upper = blend_into(upper, merged, strip)
        merged = join_surfaces(merged, upper, together, find_area(merged), extend=True)
        done(1.0 - number / len(given))
    notes = [*agreed.notes, *notes, *_describe_gaps(merged, levelled, agreed)]
    done.end()
    return merged.replace(report=replace(merged.report, notes=tuple(notes)))


def _require_surfaces(surfaces: Any) -> list[TIN]:
    """Return two surfaces or more."""
    if not isinstance(surfaces, list | tuple):
        raise OptionError("surfaces", type(surfaces).__name__, "a list of TINs")
    if len(surfaces) < 2:
        raise OptionError("surfaces", len(surfaces), "2 or more", what="number of surfaces")
    for one in surfaces:
        require_tin(one)
    return list(surfaces)


def _convert(tin: TIN, factor: float, agreed: Reference) -> TIN:
    """Return a surface in the CRS and the unit of all."""
    points = tin.points if factor == 1.0 else tin.points * (1.0, 1.0, factor)
    return tin.replace(points=points, crs=agreed.crs, elevation_unit=agreed.elevation_unit)


def _describe_gaps(merged: TIN, surfaces: list[TIN], agreed: Reference) -> list[str]:
    """Tell of places that the surfaces enclose and none of them covers, and of parts."""
    import shapely

    parts = shapely.get_parts(find_area(merged))
    covers = [shapely.get_parts(find_area(one)) for one in surfaces]
    filled = shapely.union_all([_fill(part) for cover in covers for part in cover])
    holes = [shapely.Polygon(ring) for part in parts for ring in part.interiors]
    within = [one for one in holes if not shapely.contains(filled, shapely.point_on_surface(one))]
    notes = []
    if within:
        largest = max(within, key=lambda one: one.area)
        x, y = shapely.get_coordinates(shapely.point_on_surface(largest))[0].tolist()
        area, unit = sum(one.area for one in within), agreed.units.area or "square units"
        notes.append(
            inflect(
                f"{counted(len(within), 'gap')} between the surfaces, {area:.6g} {unit}, "
                f"[is|are] left without a surface (the largest at {coordinate(x)} "
                f"{coordinate(y)}).",
                len(within),
            )
        )
    if len(parts) > max(map(len, covers)):
        notes.append(f"The surfaces do not all touch: there are {len(parts)} parts.")
    return notes


def _fill(polygon: Any) -> Any:
    """Return a polygon without its holes."""
    import shapely

    return shapely.Polygon(polygon.exterior)
