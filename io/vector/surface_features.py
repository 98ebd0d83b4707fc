"""Parts of a TIN, and the points of a survey, as features with columns."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from ...base import optional
from ...base.errors import FormatError, choice
from ...base.policies import FeatureKind
from ...base.results import Features
from ...terrain.drawing import EDGE_KINDS, find_line_edges
from ...terrain.relief import aspect, slope
from ...terrain.surface import measure_areas, measure_ring_area
from ...tin import TIN, Survey
from ...tin.topology import edge_keys, edges_at, find_offsets
from ..mesh import require_writable

if TYPE_CHECKING:
    from collections.abc import Callable

    from ...base.arrays import AnyArray, Int32Array
    from ...base.results import Kind

Writable: TypeAlias = TIN | Survey | Features


class Parts(NamedTuple):
    """Features of the vertices of a surface."""

    kind: Kind
    vertices: AnyArray
    """(k,), of the points, lines or rings, one after the other."""
    offsets: tuple[AnyArray, ...]
    """As :class:`Features` has them."""
    columns: dict[str, AnyArray]


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
    """
    chosen = choose_kind(surface, kind)
    if isinstance(surface, Features):
        return surface
    if isinstance(surface, Survey):
        parts = Parts("points", np.arange(len(surface.points)), (), _list_columns(surface))
    else:
        parts = list_parts(surface, chosen)
    return _gather(surface, parts, chosen)


def make_whole_surface(tin: TIN) -> Features:
    """Return all triangles as the parts of one feature, with their number."""
    count = len(tin.triangles)
    offsets = (4 * np.arange(count + 1), np.arange(count + 1), np.array([0, count]))
    columns = {"triangles": np.array([count])}
    corners = tin.triangles[:, [0, 1, 2, 0]].ravel()
    return _gather(tin, Parts("polygons", corners, offsets, columns), "surface")


def _gather(surface: TIN | Survey, parts: Parts, name: str) -> Features:
    return Features(
        kind=parts.kind,
        coordinates=surface.points[parts.vertices],
        offsets=parts.offsets,
        columns=parts.columns,
        crs=surface.crs,
        elevation_unit=surface.elevation_unit,
        name=name,
        notes=surface.notes if isinstance(surface, Survey) else surface.report.notes,
    )


def _list_columns(surface: TIN | Survey) -> dict[str, AnyArray]:
    columns = {}
    for name, values in surface.attributes.items():
        column = np.asarray(values)
        if column.dtype.kind not in "biufU":
            texts = [None if one is None or one != one else str(one) for one in column.tolist()]
            column = np.array(texts, object)
        columns[str(name)] = column
    return columns


def list_parts(tin: TIN, kind: str) -> Parts:
    """Return the triangles, points, edges, lines or hull of a TIN.

    Raises
    ------
    FormatError
        If there are no lines.
    """
    return _LISTS[kind](tin)


def _list_points(tin: TIN) -> Parts:
    numbers = np.arange(len(tin.points))
    return Parts("points", numbers, (), {"id": numbers} | _list_columns(tin))


def _list_triangles(tin: TIN) -> Parts:
    """Return triangles as rings with slope and aspect in degrees, and area in the plane."""
    count = len(tin.triangles)
    columns = {
        "id": np.arange(count),
        "slope": slope(tin),
        "aspect": aspect(tin),
        "area": measure_areas(tin),
    }
    corners = tin.triangles[:, [0, 1, 2, 0]].ravel()
    return Parts("polygons", corners, (4 * np.arange(count + 1), np.arange(count + 1)), columns)


def _list_edges(tin: TIN) -> Parts:
    """Return each edge once, with whether it is constrained, and the kind of its line.

    One is constrained if either of its triangles says so.
    """
    flags = tin.constrained.copy()
    triangle, corner = np.nonzero(tin.constrained & (tin.neighbors >= 0))
    other = tin.neighbors[triangle, corner]
    row, back = np.nonzero(tin.neighbors[other] == triangle[:, None])
    flags[other[row], back] = True
    kinds = np.full(flags.shape, len(EDGE_KINDS), np.int64)
    if len(tin.lines):
        known = find_line_edges(tin, guess=False)
        keys = edge_keys(known.pairs, len(tin.points))
        order = np.argsort(keys)
        wanted = edge_keys(edges_at(tin.triangles, flags), len(tin.points))
        found = order[np.minimum(np.searchsorted(keys[order], wanted), len(keys) - 1)]
        kinds[flags] = np.where(keys[found] == wanted, known.kinds[found], len(EDGE_KINDS))
    across = np.arange(len(tin.triangles), dtype=np.int32)[:, None]
    once = (tin.neighbors < 0) | (tin.neighbors > across)
    ends = (tin.triangles[:, [1, 2, 0]][once], tin.triangles[:, [2, 0, 1]][once])
    columns = {
        "id": np.arange(len(ends[0])),
        "constrained": flags[once],
        "kind": np.array([*EDGE_KINDS, None], object)[kinds[once]],
    }
    return Parts("lines", np.stack(ends, 1).ravel(), (2 * np.arange(len(ends[0]) + 1),), columns)


def _list_lines(tin: TIN) -> Parts:
    """Return breaklines, boundary, holes and water, with kind, name and number in the input.

    Where none are known they are the constrained edges one by one, without these columns.
    """
    if not (len(tin.lines) or tin.constrained.any()):
        raise FormatError(
            "This TIN has no lines: breaklines, boundary, holes and water are given when it is "
            "built.",
            known=("triangles", "points", "edges", "hull"),
        )
    chains = list(tin.lines.chains()) if len(tin.lines) else list(find_line_edges(tin).pairs)
    columns: dict[str, AnyArray] = {"id": np.arange(len(chains))}
    if len(tin.lines):
        columns |= {
            "kind": np.array(tin.lines.kinds, object),
            "name": np.array(tin.lines.names, object),
            "source": np.asarray(tin.lines.sources),
        }
    return Parts("lines", np.concatenate(chains), (find_offsets(map(len, chains)),), columns)


def _list_hull(tin: TIN) -> Parts:
    """Return the outline, an outer ring followed by its holes, with its area."""
    outer = [ring for ring in tin.rings if _measure_signed_area(tin, ring) > 0]
    holes = [ring for ring in tin.rings if _measure_signed_area(tin, ring) <= 0]
    outer.sort(key=lambda ring: _measure_signed_area(tin, ring))
    groups = [[ring] for ring in outer]
    Polygon = optional.load("shapely").Polygon
    shapes = [Polygon(tin.points[ring, :2]) for ring in outer] if holes else []
    for hole in holes:
        shape = Polygon(tin.points[hole, :2])
        home = next((i for i, around in enumerate(shapes) if around.covers(shape)), -1)
        groups[home].append(hole)
    groups.reverse()
    areas = [sum(measure_ring_area(tin.crs, tin.points[one]) for one in group) for group in groups]
    rings = [np.append(ring, ring[0]) for group in groups for ring in group]
    offsets = (find_offsets(map(len, rings)), find_offsets(map(len, groups)))
    columns = {"id": np.arange(len(groups)), "area": np.array(areas)}
    return Parts("polygons", np.concatenate(rings), offsets, columns)


def _measure_signed_area(tin: TIN, ring: Int32Array) -> float:
    x, y = (tin.points[ring, :2] - tin.points[ring[0], :2]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y)) / 2


_LISTS: dict[str, Callable[[TIN], Parts]] = {
    "triangles": _list_triangles,
    "points": _list_points,
    "edges": _list_edges,
    "lines": _list_lines,
    "hull": _list_hull,
}
