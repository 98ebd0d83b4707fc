"""Parts of a TIN, points of a survey and cells of a Voronoi diagram as features."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import measure_angular_unit
from ...base.errors import OptionError
from ...base.georeference import find_plane_units
from ...base.products import product
from ...base.results import Features
from ...terrain.surface import measure_ring_areas
from ...tin import TIN, Surface, Survey, Voronoi
from ...tin.topology import find_offsets
from .surface_features import make_features

if TYPE_CHECKING:
    from ...base.arrays import AnyArray
    from ...base.policies import FeatureKind


@product
def to_features(surface: TIN | Survey | Voronoi, kind: FeatureKind | None = None) -> Features:
    """Return the parts of a surface as features, for GIS and other libraries.

    Parameters
    ----------
    surface : TIN, Survey or Voronoi
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Of a TIN; default triangles. A survey has points, a Voronoi diagram its cells.

    Returns
    -------
    Features
        Triangles are polygons with ``slope``, ``aspect`` (degrees) and ``area``; points have the
        attributes of the vertices; edges tell whether they are ``constrained`` and the ``kind`` of
        their line; lines have ``kind``, ``name`` and ``source``, and are none where the TIN has no
        lines; the hull is the outline with its holes. Cells have the number of their ``vertex`` and
        their ``area``; a vertex without a cell is left out.

    Raises
    ------
    OptionError
        If the surface is none, or there is no such kind.
    FormatError
        If a survey is asked for another kind than points.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]], crs="EPSG:32616")
    >>> to_features(tin)
    <Features triangles: 2 polygons, columns id, slope, aspect, area, crs EPSG:32616>
    >>> float(to_features(tin, "edges").to_geodataframe().length.max())
    5.0
    >>> to_features(ts.voronoi(tin, pad=0)).columns["area"]
    array([3., 3., 3., 3.])
    """
    if isinstance(surface, Voronoi):
        if kind is not None:
            raise OptionError("kind", kind, "None: a Voronoi diagram has cells only")
        return _make_cells(surface)
    if not isinstance(surface, Surface | Survey):
        raise OptionError("surface", surface, "a TIN, a Survey or a Voronoi diagram")
    is_without_lines = isinstance(surface, Surface) and not _has_lines(surface)
    if isinstance(kind, str) and kind == "lines" and is_without_lines:
        texts, numbers = np.empty(0, object), np.empty(0, np.int64)
        columns: dict[str, AnyArray] = {
            "id": numbers, "kind": texts, "name": texts, "source": numbers
        }  # fmt: skip
        return Features.of_lines(
            np.empty((0, 3)),
            [0],
            columns=columns,
            crs=surface.crs,
            elevation_unit=surface.elevation_unit,
            name="lines",
        )
    return make_features(surface, kind)


def _has_lines(tin: TIN) -> bool:
    return bool(len(tin.lines) or tin.constrained.any())


def _make_cells(diagram: Voronoi) -> Features:
    """Return cells as polygons, each ring closed; several parts only where there are some."""
    sizes = np.diff(diagram.part_offsets)
    starts = diagram.part_offsets[:-1]
    lengths = sizes + 1
    rings = find_offsets(lengths)
    within = np.arange(rings[-1]) - np.repeat(rings[:-1], lengths)
    closed = np.repeat(starts, lengths) + within % np.repeat(sizes, lengths)
    parts = find_offsets(np.bincount(diagram.cell_of_part, minlength=len(diagram)))
    vertices = np.flatnonzero(np.diff(parts))
    has_parts = len(vertices) < len(sizes)
    areas = diagram.areas
    if measure_angular_unit(diagram.crs) is not None:
        of_parts = measure_ring_areas(diagram.crs, diagram.coords[closed], rings)
        areas = np.bincount(diagram.cell_of_part, of_parts, len(diagram)).astype(np.float64)
    return Features.of_polygons(
        diagram.coords[closed],
        rings,
        np.arange(len(sizes) + 1),
        np.append(parts[vertices], len(sizes)) if has_parts else None,
        columns={"vertex": vertices, "area": areas[vertices]},
        units={"area": find_plane_units(diagram.crs).area},
        crs=diagram.crs,
        name="cells",
    )


# ---------------------------------------------------------------- methods of a TIN


@product
def build_frame(tin: TIN, kind: FeatureKind | None = None) -> Any:
    """Return the GeoDataFrame of :meth:`TIN.to_geodataframe`."""
    return to_features(tin, kind).to_geodataframe()


@product
def build_collection(tin: TIN) -> dict[str, Any]:
    """Return the triangles as the ``__geo_interface__`` has them."""
    return to_features(tin).__geo_interface__


@product
def build_stream(tin: TIN, requested_schema: object | None = None) -> object:
    """Return the triangles as a stream of Arrow."""
    return to_features(tin).__arrow_c_stream__(requested_schema)
