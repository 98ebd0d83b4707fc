"""From inputs to a surface: drape, triangulate with the lines, cut to the boundary, account."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..._sentences import counted
from .. import _kernel
from ..constraints.breaklines import Lines
from ..constraints.clipping import BOUNDARY, EXTENT, HOLES, Surface, in_rings
from ..constraints.constraint_set import LineSet
from ..constraints.draping import drape
from ..constraints.pslg import Clip, LineInfo, Model, lines_in
from ..report import LEFT_OUT, Crossings, Overruled, Report
from ..validation.points import require_three
from .constrained import Draft, draft
from .duplicates import merge_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .inputs import Recipe

__all__ = ["Built", "assemble"]


class Built(NamedTuple):
    """What a recipe gives.

    Attributes
    ----------
    surface : Surface
    vertex_of : (n,) int32 array
        The vertex of each row, -1 for none.
    lines : Lines
    report : Report
    line_xy : (k, 2) float64 array
        Vertices of the lines as they were merged with the rows: draped ones laid on the surface.
    line_vertices : (k,) int32 array
        The vertex of each, -1 for none.
    """

    surface: Surface
    vertex_of: NDArray[np.int32]
    lines: Lines
    report: Report
    line_xy: NDArray[np.float64]
    line_vertices: NDArray[np.int32]


def assemble(recipe: Recipe) -> Built:
    """Build all that the TIN of a recipe holds."""
    return _plain(recipe) if recipe.is_plain else _with_lines(recipe)


# ------------------------------------------------------------------ points alone


def _plain(recipe: Recipe) -> Built:
    xyz, options = recipe.points, recipe.options
    require_three(len(xyz))  # edits may have removed the others
    kept_row = _kernel.snap(xyz, options.snap) if options.snap > 0 else None
    growth = _kernel.grow(
        xyz if kept_row is None else _kept(xyz, kept_row), threads=options.threads
    )
    merged = merge_rows(xyz, growth.kept_row if kept_row is None else kept_row, options.duplicates)
    fixed = np.zeros(growth.triangles.shape, np.bool_)
    return Built(
        Surface(merged.points, growth.triangles, growth.neighbors, fixed),
        merged.vertex_of,
        Lines(),
        _report(recipe, len(merged.points), len(growth.triangles), merged.account),
        np.empty((0, 2)),
        np.empty(0, np.int32),
    )


def _kept(xyz: NDArray[np.float64], kept_row: NDArray[np.int32]) -> NDArray[np.float64]:
    kept: NDArray[np.float64] = xyz[kept_row == np.arange(len(xyz), dtype=np.int32)]
    return kept


def _report(recipe: Recipe, n_vertices: int, n_triangles: int, account: dict[str, Any]) -> Report:
    return Report(
        n_rows=len(recipe.points),
        n_vertices=n_vertices,
        n_triangles=n_triangles,
        duplicates=recipe.options.duplicates,
        snap=recipe.options.snap,
        skipped=dict(recipe.skipped),
        **{"notes": tuple(recipe.notes), **account},
    )


# -------------------------------------------------------------- points and lines


class _Ground(NamedTuple):
    """Lines that all have heights, and the rim where draped ones leave the surface."""

    lines: LineSet
    has_rim: bool
    notes: list[str]

    def without_rim(self) -> _Ground:
        """Return the same lines without the parts of the rim."""
        return self._replace(lines=self.lines.chosen(self.lines.sources >= 0), has_rim=False)


def _with_lines(recipe: Recipe) -> Built:
    is_erased = _erased(recipe)
    rows = np.flatnonzero(~is_erased)
    ground = _draped(rows, recipe)
    made, model = _made(recipe, ground, rows)
    has_rings = bool(recipe.boundary or recipe.extent or recipe.holes or recipe.has_rim)
    if not has_rings and model.loses_vertices_at_rim(made.surface):
        ground = ground.without_rim()
        made, model = _made(recipe, ground, rows)
    surface, number_of = model.surface(made.surface)
    vertex_of = _numbered(model.vertex_of, number_of)
    account = _account(recipe, made, number_of, is_erased, vertex_of, ground)
    is_whole = surface is made.surface
    return Built(
        surface,
        vertex_of,
        lines_in(model.pieces, model.infos, number_of, surface, is_whole=is_whole),
        _report(recipe, len(surface.points), len(surface.triangles), account),
        ground.lines.xy,
        _numbered(made.line_vertices, number_of),
    )


def _made(recipe: Recipe, ground: _Ground, rows: NDArray[np.int64]) -> tuple[Draft, Model]:
    made = draft(recipe.points, rows, ground.lines, recipe.options, conforming=recipe.conforming)
    return made, _model(recipe, ground, made, rows)


def _model(recipe: Recipe, ground: _Ground, made: Draft, rows: NDArray[np.int64]) -> Model:
    lines = ground.lines
    vertex_of = np.full(len(recipe.points), -1, np.int32)
    vertex_of[rows] = made.vertex_of
    return Model(
        points=made.surface.points,
        pieces=made.pieces,
        infos=tuple(
            LineInfo(*info)
            for info in zip(
                lines.kinds,
                lines.sources.tolist(),
                lines.names,
                lines.priorities.tolist(),
                _groups(recipe, lines),
                strict=True,
            )
        ),
        clip=Clip(
            boundary=recipe.boundary,
            extent=recipe.extent,
            holes=recipe.holes,
            has_rim=ground.has_rim or recipe.has_rim,
            max_edge=recipe.max_edge,
            is_trimmed_everywhere=recipe.trim == "everywhere",
        ),
        vertex_of=vertex_of,
    )


def _groups(recipe: Recipe, lines: LineSet) -> list[int]:
    """Return the group of each line among the rings; that of other lines says nothing."""
    of_ring = [
        *([BOUNDARY] * len(recipe.boundary)),
        *([EXTENT] * len(recipe.extent)),
    ]
    of_hole = [HOLES + number for number, rings in enumerate(recipe.holes) for _ in rings]
    groups: dict[str, list[int]] = {"boundary": of_ring, "hole": of_hole}
    if recipe.has_rim:  # of existing triangles, whose rings are edges of the rim
        groups = {}
    return [
        groups[kind][source] if kind in groups and source >= 0 else BOUNDARY
        for kind, source in zip(lines.kinds, lines.sources.tolist(), strict=True)
    ]


def _numbered(vertices: NDArray[np.int32], number_of: NDArray[np.int32]) -> NDArray[np.int32]:
    """Renumber vertices of which some are -1, for none."""
    found: NDArray[np.int32] = np.append(number_of, np.int32(-1))[vertices]
    return found


def _erased(recipe: Recipe) -> NDArray[np.bool_]:
    """Tell which rows are left out before anything is built: masked or erased ones."""
    is_erased = np.zeros(len(recipe.points), np.bool_)
    if recipe.is_masked is not None:
        is_erased |= recipe.is_masked
    for rings in recipe.erase:
        is_erased |= in_rings(recipe.points[:, :2], rings) > 0
    return is_erased


def _draped(rows: NDArray[np.int64], recipe: Recipe) -> _Ground:
    """Give all lines heights: draped ones from the surface of everything else."""
    lines = recipe.lines
    is_draped = lines.is_draped
    if not is_draped.any():
        return _Ground(lines, False, [])
    base = draft(recipe.points, rows, lines.chosen(~is_draped), recipe.options)
    laid = drape(base.surface, lines.chosen(is_draped), threads=recipe.options.threads)
    notes = []
    if laid.n_cut:
        notes.append(
            f"Of {counted(laid.n_cut, 'draped line')} the parts outside the surface "
            "of the points were left out."
        )
    together = LineSet.joined([lines.chosen(~is_draped), laid.lines, laid.rim])
    return _Ground(together, len(laid.rim.kinds) > 0, notes)


# ----------------------------------------------------------------------- account


def _account(
    recipe: Recipe,
    made: Draft,
    number_of: NDArray[np.int32],
    is_erased: NDArray[np.bool_],
    vertex_of: NDArray[np.int32],
    ground: _Ground,
) -> dict[str, Any]:
    """Return the report's fields about merged rows, left-out rows and lines that met."""
    final = _numbered(made.number_of, number_of)
    account = _without_lost_merges(dict(made.merges), final)
    left_out = np.flatnonzero(vertex_of < 0).astype(np.int32)
    labels = ground.lines.labels()
    gave_way = made.overruled
    return account | {
        "left_out_rows": left_out,
        "left_out_why": _reasons(recipe, left_out, is_erased, made),
        "n_lines": len(recipe.lines.kinds) - len(recipe.extent),
        "line_labels": tuple(labels),
        "crossings": _crossings(made, final),
        "overruled": Overruled(
            _numbered(gave_way.vertices, final), gave_way.lines, gave_way.heights, gave_way.taken
        ),
        "notes": (*recipe.notes, *ground.notes),
    }


def _crossings(made: Draft, final: NDArray[np.int32]) -> Crossings:
    met = made.noded.crossings
    lines = np.stack([met.line_a, met.line_b], axis=1).astype(np.int32)
    heights = np.stack([met.height_a, met.height_b], axis=1)
    order = np.argsort(lines, axis=1, kind="stable")
    return Crossings(
        _numbered(met.vertex, final),
        met.xy,
        np.take_along_axis(lines, order, axis=1),
        np.take_along_axis(heights, order, axis=1),
        met.height,
    )


def _without_lost_merges(account: dict[str, Any], final: NDArray[np.int32]) -> dict[str, Any]:
    """Return the merges at vertices that are left, numbered as in the TIN."""
    if not account:
        return account
    vertices = final[account["merged_vertices"]]
    keep = vertices >= 0
    counts = np.diff(account["merged_offsets"])
    rows = np.repeat(keep, counts)
    return {
        "merged_vertices": vertices[keep],
        "merged_offsets": np.append(0, np.cumsum(counts[keep])).astype(np.int32),
        "vertex_heights": account["vertex_heights"][keep],
        **{k: account[k][rows] for k in ("merged_rows", "merged_heights", "merged_shifts")},
    }


def _reasons(
    recipe: Recipe, rows: NDArray[np.int32], is_erased: NDArray[np.bool_], made: Draft
) -> NDArray[np.int8]:
    """Return why each row was left out, as places in ``LEFT_OUT``."""
    xy = recipe.points[rows, :2]
    why = np.full(len(rows), LEFT_OUT.index("trimmed"), np.int8)
    for rings in recipe.holes:
        why[in_rings(xy, rings) >= 0] = LEFT_OUT.index("in a hole")
    for outer in (recipe.extent, recipe.boundary):
        if outer and len(rows):
            why[in_rings(xy, outer) <= 0] = LEFT_OUT.index("outside the boundary")
    drowned = np.zeros(len(is_erased), np.bool_)
    drowned[np.flatnonzero(~is_erased)[made.vertex_of < 0]] = True
    why[drowned[rows]] = LEFT_OUT.index("in water")
    why[is_erased[rows]] = LEFT_OUT.index("erased")
    if recipe.is_masked is not None:
        why[recipe.is_masked[rows]] = LEFT_OUT.index("masked")
    return why
