"""Polygons as rings: a ring alone, or several of which the inner ones leave islands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import LinesError
from ..validation import find_geometries
from .breaklines import as_ring, find_elevations_at_start
from .given_geometries import list_regions

if TYPE_CHECKING:
    from ...base.arrays import Float64Array


def gather_rings_of_regions(regions: Sequence[Any], what: str) -> list[list[Float64Array]]:
    """Return the rings of regions, one list for each; LinesError for anything else.

    A region is a ring, (k, 2) or (k, 3), a sequence of rings, or an object that has a
    ``__geo_interface__`` with polygons, such as one of shapely, every polygon of which is a region.
    ``what`` the rings are is said in sentences.

    Examples
    --------
    >>> [len(rings) for rings in gather_rings_of_regions([[[0, 0], [1, 0], [0, 1]]], "hole")]
    [1]
    """
    return [[as_ring(*one) for one in rings] for rings in _label_rings(regions, what)]


def starts_with_elevations(regions: Sequence[Any], what: str) -> list[tuple[str, Float64Array]]:
    """Return the rings that close with several elevations: name, vertices with the lowest first."""
    rings = [one for rings in _label_rings(regions, what) for one in rings]
    starts = [(label, find_elevations_at_start(ring, label)) for ring, label in rings]
    return [(label, start) for label, start in starts if len(start) > 1]


def _label_rings(regions: Sequence[Any], what: str) -> Iterator[list[tuple[Any, str]]]:
    """Walk the regions, each a list of rings with their names."""
    number = 0
    for region in regions:
        for rings in _as_rings(region, what):
            yield [(ring, f"{what} ring {number + i}") for i, ring in enumerate(rings)]
            number += len(rings)


def _as_rings(region: Any, what: str) -> Iterator[Sequence[Any]]:
    """Walk the regions that something given as one holds, each as a sequence of rings."""
    found = find_geometries(region)
    if found is not None:
        yield from list_regions(found, what)
    elif _is_sequence_of_rings(region):
        if len(region) == 0:
            raise LinesError(f"Invalid {what}: a polygon without a ring.")
        yield region
    else:
        yield [region]


def _is_sequence_of_rings(region: Any) -> bool:
    """Whether there is one more level than in a ring: rings, of vertices, of numbers."""
    if isinstance(region, np.ndarray) and region.dtype != object:
        return region.ndim == 3
    first = region
    for _ in range(2):
        if not isinstance(first, Sequence | np.ndarray) or isinstance(first, str) or not len(first):
            return False
        first = first[0]
    return isinstance(first, Sequence | np.ndarray) and np.ndim(first) == 1
