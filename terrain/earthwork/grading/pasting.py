"""Paste a surface into another one, along the boundary of what is pasted."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import require_tin
from ....base.errors import PointsError
from ....base.georeference import agree
from ....base.products import product
from ....base.progress import Progress
from ....base.sentences import coordinate
from ....tin import Breakline, Survey, triangulate
from ....tin.building import join_columns
from ....tin.constraints import in_rings
from ....tin.topology import edge_keys, mark_corners
from ....tin.triangulation import mark_illegal_edges
from .seams import Seam, arrange_rings, fills_hull, find_area, find_sides, measure_tolerance

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ....base.arrays import AnyArray, BoolArray, Float64Array
    from ....base.georeference import Reference
    from ....base.progress import Tell
    from ....tin import TIN

_SHARE = 1e-12
"""Of an area: less of it may lie beyond another one by rounding."""
_LEVEL = 1e-9
"""Of an elevation: those that differ by less are the same."""
_PRIORITY = 1000
"""Of the seam: where lines cross it, its elevations count."""


@product
def paste(base: TIN, patch: TIN, *, progress: Callable[[float], None] | None = None) -> TIN:
    """Put a surface in the place of a part of another one.

    Parameters
    ----------
    base : TIN
    patch : TIN
        Within the boundary of ``base`` or beyond it, with holes or in several parts: in its holes
        the base stays.
    progress : callable, optional
        Called with the fraction done, ascending to 1.0, as the base is cut and both are
        triangulated. What it raises ends the call.

    Returns
    -------
    TIN
        The surface of ``patch`` within its boundary, that of ``base`` elsewhere, in the CRS and
        unit of both. Vertices of the base within the patch are left out; lines of both stay, those
        of the base up to the seam, a hard breakline named "seam" that runs along the boundary of
        the patch. ``report.notes`` tell by how much elevations differ along it, and what area the
        patch adds where it reaches beyond the base.

    Raises
    ------
    CrsError
        If the CRSs differ, or are known of one only; if it cannot be told whether elevations are
        in one unit.
    PointsError
        If the boundaries of both are so near to each other that rounding leaves no surface
        between them.

    Notes
    -----
    Along the seam elevations are those of the patch, to which the triangles of the base that are
    cut by it are joined. So the surface is that of the base but in these triangles, and there as
    well if the patch meets the base. Edges that they are cut at, and those of both surfaces that
    are not Delaunay, are soft breaklines named "joint". Vertices keep their attributes; those made
    along the seam have none, nor have those of the patch in columns of the base alone, and the
    other way round.

    Examples
    --------
    >>> import tinsmith as ts
    >>> ground = ts.triangulate([[0, 0, 5], [9, 0, 5], [9, 9, 5], [0, 9, 5], [4, 4, 8]])
    >>> pond = ts.triangulate([[3, 3, 5], [6, 3, 5], [6, 6, 5], [3, 6, 5], [4, 5, 2]])
    >>> pasted = ts.paste(ground, pond)
    >>> pasted.interpolate([[4, 5], [4, 4], [8, 8]])
    array([2. , 3.5, 5. ])
    """
    require_tin(base)
    require_tin(patch)
    done = Progress(progress)
    found = agree((base, patch), ("the base", "the patch"))
    area = find_area(base)
    pasted = join_surfaces(base, patch, found, area, extend=True, progress=done.stage(0.0, 1.0))
    done.end()
    return pasted


def join_surfaces(
    base: TIN,
    patch: TIN,
    agreed: Reference,
    area: Any,
    name: str = "seam",
    *,
    extend: bool = False,
    progress: Tell | None = None,
) -> TIN:
    """Paste a surface into another one, name the seam, and extend the base where it is told to.

    ``agreed`` are their CRS and units, ``area`` is what the base covers; with ``extend`` the patch
    may reach beyond it.
    """
    done = Progress(progress)
    ground, insert = (
        one.triangulation.points * (1.0, 1.0, factor)
        for one, factor in zip((base, patch), agreed.factors, strict=True)
    )
    seam = Seam(patch, insert, measure_tolerance(ground, insert))
    cut = _Base(base, ground, seam, done.stage(0.1, 0.6))
    is_inserted = mark_corners(patch.triangles, len(patch.points))
    done(0.6)
    lines = [*cut.list_lines(), *cut.list_joints()]
    seam.insert_cuts()
    lines += [Breakline(ring, name=name, priority=_PRIORITY) for ring in seam.rings]
    lines += seam.list_lines()
    beyond = float(seam.area.difference(area).area) if extend else 0.0
    reaches = beyond > seam.rounding
    done(0.7)
    made = triangulate(
        Survey(
            points=np.concatenate([ground[cut.is_kept], insert[is_inserted]]),
            attributes=_join_attributes((base, cut.is_kept), (patch, is_inserted)),
        ),
        breaklines=lines,
        duplicates="last",
        crs=agreed.crs,
        elevation_unit=agreed.elevation_unit,
        progress=done.stage(0.7, 1.0),
        **(_join_rings(area, cut, seam) if reaches else _list_rings(area, cut, seam)),
    )
    gap = _describe_gap(base, area, agreed, seam)
    added = _describe_beyond(beyond, patch, agreed) if reaches else []
    notes = (*made.report.notes, *agreed.notes, *gap, *added)
    return made.replace(report=replace(made.report, notes=notes))


def _join_attributes(*taken: tuple[TIN, BoolArray]) -> dict[str, AnyArray]:
    """Return the columns of the vertices that are taken, of one surface behind the other."""
    columns = [
        {name: column[is_taken] for name, column in tin.attributes.items()}
        for tin, is_taken in taken
    ]
    return join_columns(columns, [int(is_taken.sum()) for _, is_taken in taken])


def _list_rings(area: Any, cut: _Base, seam: Seam) -> dict[str, Any]:
    """Return boundary and holes of the base, where it does not reach its hull."""
    if fills_hull(area):
        return {}
    return _join_rings(area, cut, seam) if seam.touches(area) else cut.list_rings(area)


def _join_rings(area: Any, cut: _Base, seam: Seam) -> dict[str, Any]:
    """Return boundary and holes of both surfaces together, where the patch meets the outline.

    They are made of the pieces of both boundaries as they were cut at each other, without new
    intersections: of the faces between them those in either surface.
    """
    import shapely

    paths = [*cut.list_boundary(), *(pair for ring in seam.rings for pair in _split(ring))]
    wanted = shapely.union(area, seam.area)
    faces = shapely.get_parts(shapely.polygonize(shapely.linestrings(np.array(paths)[:, :, :2])))
    shapely.prepare(wanted)
    inside = faces[shapely.contains(wanted, shapely.point_on_surface(faces))]
    try:
        joined = shapely.coverage_union_all(inside)
    except shapely.GEOSException:  # faces lie over each other, by rounding
        joined = shapely.MultiPolygon()
    if abs(joined.area - wanted.area) > 2 * seam.rounding:
        raise PointsError(
            "The patch cannot be joined to the base: their boundaries are so near to each other "
            "that they cross within the rounding of the coordinates."
        )
    return arrange_rings(joined, {(x, y): z for path in paths for x, y, z in path.tolist()})


def _split(ring: Float64Array) -> Float64Array:
    """Return the segments of a ring, (k, 2, 3)."""
    return np.stack([ring[:-1], ring[1:]], axis=1)


def _describe_beyond(beyond: float, patch: TIN, agreed: Reference) -> list[str]:
    """Say how much of the patch lies beyond the base."""
    unit = agreed.units.area or "square units"
    where = "lies beside" if beyond >= (1 - _SHARE) * patch.area else "reaches beyond"
    return [f"The patch {where} the base, which becomes larger by {beyond:.6g} {unit}."]


def _describe_gap(base: TIN, area: Any, agreed: Reference, cut: Seam) -> list[str]:
    """Say how far the surfaces are apart along the seam, if they are."""
    seam = np.concatenate(cut.rings)
    own = base.interpolate(seam[:, :2])
    lost = np.isnan(own)  # outside, or by rounding
    lost[lost] = cut.lie_near(area, seam[lost])
    own[lost] = base.interpolate(seam[lost, :2], method="linear", extrapolate="nearest")
    own *= agreed.factors[0]
    gaps = np.nan_to_num(np.abs(own - seam[:, 2]))
    worst = int(gaps.argmax())
    if gaps[worst] <= _LEVEL * max(1.0, float(np.abs(seam[:, 2]).max())):
        return []
    unit = "" if agreed.elevation_unit is None else f" {agreed.elevation_unit.symbol}"
    x, y = seam[worst, :2].tolist()
    return [
        "Along the seam the elevations of the patch differ from those of the base by up to "
        f"{gaps[worst]:.4g}{unit}, at {coordinate(x)} {coordinate(y)}: the base was joined "
        "to the patch."
    ]


class _Base:
    """What stays of the base: vertices, lines, and edges that the seam cuts."""

    def __init__(self, base: TIN, points: Float64Array, seam: Seam, progress: Tell | None) -> None:
        self._tin, self._points, self._seam = base, points, seam
        xy = np.ascontiguousarray(points[:, :2])
        self.is_kept = in_rings(xy, [ring[:, :2] for ring in seam.rings]) < 0
        self.is_kept[seam.find_near(xy)] = False
        self.is_kept &= mark_corners(base.triangles, len(base.points))
        self._pieces = self._cut_edges(progress)

    def _cut_edges(self, progress: Tell | None) -> dict[int, list[Float64Array]]:
        """Return what is left of the edges at the seam, by key."""
        edges = self._tin.edges
        ends = self._points[edges]
        is_dropped = ~self.is_kept[edges]
        crossing = self._seam.find_crossing(ends[:, :, :2])
        at_seam = np.union1d(crossing, np.flatnonzero(is_dropped[:, 0] != is_dropped[:, 1]))
        at_seam = at_seam[~is_dropped[at_seam].all(axis=1) | np.isin(at_seam, crossing)]
        pieces = self._seam.cut(ends[at_seam], self.is_kept[edges[at_seam]], progress)
        keys = edge_keys(edges[at_seam], len(self._points)).tolist()
        return dict(zip(keys, pieces, strict=True))

    def _find_parts(self, a: int, b: int) -> list[Float64Array]:
        """Return the parts of an edge that stay, in the direction from a to b."""
        key = int(edge_keys(np.array([[a, b]]), len(self._points))[0])
        if key not in self._pieces:
            return [self._points[[a, b]]] if self.is_kept[[a, b]].all() else []
        start, way = self._points[a, :2], self._points[b, :2] - self._points[a, :2]
        turned = [
            part if (part[1, :2] - part[0, :2]) @ way > 0 else part[::-1]
            for part in self._pieces[key]
        ]
        return sorted(turned, key=lambda part: float((part[0, :2] - start) @ way))

    def list_lines(self) -> Iterator[Breakline]:
        """Yield the lines of the base, clipped at the seam, but for its boundary."""
        lines = self._tin.lines
        for chain, kind, name in zip(lines.chains(), lines.kinds, lines.names, strict=True):
            if kind in ("boundary", "hole"):
                continue
            shape: Any = "soft" if kind == "soft" else "hard"
            for run in self._find_runs(chain.tolist()):
                yield Breakline(np.array(run), kind=shape, name=name)

    def _find_runs(self, chain: list[int]) -> list[list[Float64Array]]:
        """Return what stays of a chain, joined where one part begins at the end of another."""
        runs: list[list[Float64Array]] = []
        for a, b in pairwise(chain):
            for start, end in self._find_parts(a, b):
                if runs and (runs[-1][-1][:2] == start[:2]).all():
                    runs[-1].append(end)
                else:
                    runs.append([start, end])
        return runs

    def list_rings(self, area: Any) -> dict[str, Any]:
        """Return boundary and holes of the area, which no patch meets."""
        rows = self._points[np.concatenate(self._tin.boundary)]
        return arrange_rings(area, {(x, y): z for x, y, z in rows.tolist()})

    def list_boundary(self) -> Iterator[Float64Array]:
        """Yield the parts of the boundary that the patch does not cover, (2, 3) each."""
        for ring in self._tin.boundary:
            for a, b in pairwise([*ring.tolist(), int(ring[0])]):
                yield from self._find_parts(a, b)

    def list_joints(self) -> Iterator[Breakline]:
        """Yield edges without which the triangles would change, but for those in lines.

        Those of triangles that the seam cuts, constrained ones, and those that are not Delaunay.
        """
        n = len(self._points)
        mesh = self._tin.triangulation
        keys = find_sides(mesh.triangles, n)
        touched = np.asarray(np.isin(keys, np.array(list(self._pieces), np.int64)).any(axis=1))
        inside = self._tin.locate(np.concatenate(self._seam.rings)[:, :2])
        touched[inside[inside >= 0]] = True
        own = edge_keys(self._tin.lines.segments().reshape(-1, 2), n)
        wanted = touched[:, None] | (mesh.constrained & (mesh.neighbors >= 0))
        wanted |= mark_illegal_edges(mesh)
        for key in np.setdiff1d(keys[wanted], own).tolist():
            for part in self._find_parts(*divmod(key, n)):
                yield Breakline(part, kind="soft", name="joint")
