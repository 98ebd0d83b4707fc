"""Polygons of one boundary that lie within others, or overlap."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.errors import ReadError
from ...base.sentences import counted, inflect

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import Float64Array

__all__ = ["note_nesting"]


def note_nesting(polygons: Sequence[Sequence[Float64Array]], path: Path) -> list[str]:
    """Tell of polygons that lie within others, where they cut the surface away.

    Parameters
    ----------
    polygons : sequence of sequences of (k, 2) or (k, 3) arrays
        Of each the outer ring and its islands.
    path : Path
        For sentences.

    Raises
    ------
    ReadError
        If two overlap or are equal: whether the surface lies there is anybody's guess.
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
    return _describe_nesting(int(is_within.sum()), path)


_ROUNDING = 1e-9
"""Neighbours whose common border was rounded share slivers, of this part of their area at most."""


def _describe_nesting(count: int, path: Path) -> list[str]:
    if count == 0:
        return []
    what = inflect(f"{counted(count, 'polygon')} [lies|lie]", count)
    return [f"'{path.name}': {what} within another of the boundary: the surface is cut out there."]


def _shape(rings: Sequence[Float64Array]) -> Any:
    shapely = optional.load("shapely")
    outer, *islands = [ring[:, :2] for ring in rings]
    return shapely.Polygon(outer, islands)
