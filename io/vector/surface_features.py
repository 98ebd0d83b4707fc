"""Parts of a TIN, and the points of a survey, as features with columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ...base.errors import FormatError, choice
from ...base.policies import FeatureKind
from ...base.results import Features
from ...terrain.drawing.linework import EDGE_KINDS
from ...terrain.relief.gradients import aspect, measure_areas, measure_ring_area, slope
from ...tin import TIN, Survey
from ..mesh.common import require_writable
from .geojson.lines import (
    find_edge_kinds,
    gather_edge_flags,
    group_rings,
    list_line_vertices,
    require_lines,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import AnyArray, Float64Array

__all__ = ["Writable", "choose_kind", "make_features", "make_whole_surface"]

Writable: TypeAlias = TIN | Survey | Features


def choose_kind(surface: Writable, kind: str | None) -> str:
    """Return the kind of parts of a surface that is to be written; "" for features.

    Raises
    ------
    FormatError
        If features are asked for a kind, or a survey for another than points; if it is neither.
    OptionError
        If there is no such kind.
    """
    if isinstance(surface, Features):
        if kind is not None:
            raise FormatError(
                f"Invalid kind '{kind}': features are written as they are, without one."
            )
        return ""
    is_survey = isinstance(require_writable(surface), Survey)
    if kind is None:
        return "points" if is_survey else "triangles"
    choice("kind", kind, FeatureKind)
    if is_survey and kind != "points":
        raise FormatError(
            f"A survey has no {kind}, only points: triangulate it first.", known=("points",)
        )
    return kind


def make_features(surface: Writable, kind: FeatureKind | None) -> Features:
    """Return what is to be written as features.

    Parameters
    ----------
    surface : TIN, Survey or Features
    kind : {"triangles", "points", "edges", "lines", "hull"}, optional
        Default triangles, of a survey points.

    Raises
    ------
    FormatError, OptionError
        As :func:`choose_kind`; also if a TIN without lines is asked for lines.
    """
    chosen = choose_kind(surface, kind)
    if isinstance(surface, Features):
        return surface
    if isinstance(surface, Survey):
        return Features.of_points(
            surface.points, columns=_list_columns(surface), **_describe_reference(surface, "points")
        )
    return _MAKERS[chosen](surface)


def _describe_reference(surface: TIN | Survey, name: str) -> dict[str, Any]:
    notes = surface.notes if isinstance(surface, Survey) else surface.report.notes
    return {
        "crs": surface.crs,
        "elevation_unit": surface.elevation_unit,
        "name": name,
        "notes": tuple(notes),
    }


def _list_columns(surface: TIN | Survey) -> dict[str, AnyArray]:
    return {str(name): _as_column(values) for name, values in surface.attributes.items()}


def _as_column(values: AnyArray) -> AnyArray:
    """Return an attribute as a column: numbers, truth values or texts."""
    column = np.asarray(values)
    if column.dtype.kind in "biufU":
        return column
    texts = [None if one is None or one != one else str(one) for one in column.tolist()]
    return np.array(texts, object)


def _make_points(tin: TIN) -> Features:
    columns = {"id": np.arange(len(tin.points))} | _list_columns(tin)
    return Features.of_points(tin.points, columns=columns, **_describe_reference(tin, "points"))


def make_whole_surface(tin: TIN) -> Features:
    """Return all triangles as the parts of one feature, with their number."""
    count = len(tin.triangles)
    return Features.of_polygons(
        _list_corners(tin),
        np.arange(0, 4 * count + 1, 4),
        np.arange(count + 1),
        [0, count],
        columns={"triangles": np.array([count])},
        **_describe_reference(tin, "surface"),
    )


def _list_corners(tin: TIN) -> Float64Array:
    """Return the rings of the triangles, one after the other."""
    corners: Float64Array = tin.points[tin.triangles[:, [0, 1, 2, 0]].ravel()]
    return corners


def _make_triangles(tin: TIN) -> Features:
    """Return triangles as rings with slope and aspect in degrees, and area in the plane."""
    count = len(tin.triangles)
    columns = {
        "id": np.arange(count),
        "slope": slope(tin),
        "aspect": aspect(tin),
        "area": measure_areas(tin),
    }
    return Features.of_polygons(
        _list_corners(tin),
        np.arange(0, 4 * count + 1, 4),
        np.arange(count + 1),
        columns=columns,
        **_describe_reference(tin, "triangles"),
    )


def _make_edges(tin: TIN) -> Features:
    """Return each edge once, with whether it is constrained, and the kind of its line."""
    flags = gather_edge_flags(tin)
    across = np.arange(len(tin.triangles), dtype=np.int32)[:, None]
    once = (tin.neighbors < 0) | (tin.neighbors > across)
    starts, ends = tin.triangles[:, [1, 2, 0]][once], tin.triangles[:, [2, 0, 1]][once]
    kinds = find_edge_kinds(tin, flags)[once]
    words = np.array([*EDGE_KINDS, None], object)
    columns = {
        "id": np.arange(len(starts)),
        "constrained": flags[once],
        "kind": words[np.where(kinds >= 0, kinds, len(EDGE_KINDS))],
    }
    coordinates = tin.points[np.stack([starts, ends], axis=1).ravel()]
    offsets = np.arange(0, 2 * len(starts) + 1, 2)
    return Features.of_lines(
        coordinates, offsets, columns=columns, **_describe_reference(tin, "edges")
    )


def _make_lines(tin: TIN) -> Features:
    """Return breaklines, boundary, holes and water, with kind, name and number in the input."""
    require_lines(tin)
    chains = list_line_vertices(tin)
    columns: dict[str, AnyArray] = {"id": np.arange(len(chains))}
    if len(tin.lines):
        columns |= {
            "kind": np.array(tin.lines.kinds, object),
            "name": np.array(tin.lines.names, object),
            "source": np.asarray(tin.lines.sources),
        }
    offsets = np.concatenate([[0], np.cumsum([len(chain) for chain in chains])])
    coordinates = tin.points[np.concatenate(chains)]
    return Features.of_lines(
        coordinates, offsets, columns=columns, **_describe_reference(tin, "lines")
    )


def _make_hull(tin: TIN) -> Features:
    """Return the outline, holes included, with its area."""
    groups = group_rings(tin)
    rings = [np.append(ring, ring[0]) for group in groups for ring in group]
    areas = [sum(measure_ring_area(tin.crs, tin.points[one]) for one in group) for group in groups]
    return Features.of_polygons(
        tin.points[np.concatenate(rings)],
        np.concatenate([[0], np.cumsum([len(ring) for ring in rings])]),
        np.concatenate([[0], np.cumsum([len(group) for group in groups])]),
        columns={"id": np.arange(len(groups)), "area": np.array(areas)},
        **_describe_reference(tin, "hull"),
    )


_MAKERS: dict[str, Callable[[TIN], Features]] = {
    "triangles": _make_triangles,
    "points": _make_points,
    "edges": _make_edges,
    "lines": _make_lines,
    "hull": _make_hull,
}
