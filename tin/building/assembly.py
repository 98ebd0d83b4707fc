"""From inputs to a surface: drape, triangulate with the lines, cut to the boundary, account."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.progress import Progress
from ...base.sentences import counted
from .. import _kernel
from ..constraints import (
    BOUNDARY,
    EXTENT,
    HOLES,
    Lines,
    LineSet,
    Pslg,
    drape,
    find_lines_in,
    in_rings,
)
from ..report import LEFT_OUT, Overruled, Report
from ..topology import find_offsets
from ..triangulation import Triangulation
from ..validation import require_three
from .constrained import ConstrainedTriangulation, triangulate_constrained
from .duplicates import merge_rows
from .version import LineVertices, Version

if TYPE_CHECKING:
    from ...base.arrays import Float64Array, Int32Array, Int64Array
    from ...base.progress import Tell
    from .inputs import BuildInputs


def assemble(inputs: BuildInputs, progress: Progress | None = None) -> Version:
    """Build all that a TIN holds, and tell how far it is."""
    progress = progress or Progress(None)
    return _assemble_plain(inputs, progress) if inputs.is_plain else _with_lines(inputs, progress)


# ------------------------------------------------------------------ points alone


def _assemble_plain(inputs: BuildInputs, progress: Progress) -> Version:
    xyz, options = inputs.points, inputs.options
    require_three(len(xyz))  # edits may have removed the others
    kept_row = _kernel.snap(xyz, options.snap) if options.snap > 0 else None
    growth = _kernel.grow(
        xyz if kept_row is None else _choose_kept(xyz, kept_row),
        threads=inputs.threads,
        progress=progress.stage(0.1, 0.9),
    )
    progress(0.9)
    merged = merge_rows(xyz, growth.kept_row if kept_row is None else kept_row, options.duplicates)
    fixed = np.zeros(growth.triangles.shape, np.bool_)
    return Version(
        triangulation=Triangulation(merged.points, growth.triangles, growth.neighbors, fixed),
        vertex_of=merged.vertex_of,
        lines=Lines(),
        report=_report(inputs, len(merged.points), len(growth.triangles), merged.account),
    )


def _choose_kept(xyz: Float64Array, kept_row: Int32Array) -> Float64Array:
    kept: Float64Array = xyz[kept_row == np.arange(len(xyz), dtype=np.int32)]
    return kept


def _report(
    inputs: BuildInputs, n_vertices: int, n_triangles: int, account: dict[str, Any]
) -> Report:
    return Report(
        n_rows=len(inputs.points),
        n_vertices=n_vertices,
        n_triangles=n_triangles,
        duplicates=inputs.options.duplicates,
        snap=inputs.options.snap,
        from_raster=inputs.from_raster,
        skipped=dict(inputs.skipped),
        source=inputs.source,
        row_sources=inputs.row_sources,
        **{"notes": tuple(inputs.notes), **account},
    )


# -------------------------------------------------------------- points and lines


class _Ground(NamedTuple):
    """Lines that all have elevations, and the boundary where draped ones leave the surface."""

    lines: LineSet
    has_own_boundary: bool
    notes: list[str]

    def drop_own_boundary(self) -> _Ground:
        """Return the same lines without the parts of the boundary."""
        return self._replace(
            lines=self.lines.choose(self.lines.sources >= 0), has_own_boundary=False
        )


def _with_lines(inputs: BuildInputs, progress: Progress) -> Version:
    # which rows are left out before anything is built: masked or erased ones
    is_erased = np.zeros(len(inputs.points), np.bool_)
    if inputs.is_masked is not None:
        is_erased |= inputs.is_masked
    for rings in inputs.erase:
        is_erased |= in_rings(inputs.points[:, :2], rings) > 0
    rows = np.flatnonzero(~is_erased)
    ground = _drape_lines(rows, inputs, progress.stage(0.1, 0.4))
    progress(0.4)
    made, pslg = _triangulate_with_lines(inputs, ground, rows, progress.stage(0.4, 0.7))
    progress(0.9)
    if not inputs.clip.has_rings and pslg.loses_vertices_at_own_boundary(made.surface):
        ground = ground.drop_own_boundary()
        made, pslg = _triangulate_with_lines(inputs, ground, rows)
    surface, number_of = pslg.surface(made.surface)
    vertex_of = _renumber(pslg.vertex_of, number_of)
    account = _gather_account(inputs, ground, made, number_of, rows=rows, vertex_of=vertex_of)
    is_whole = surface is made.surface
    lines = find_lines_in(pslg.polylines, pslg.constraints, number_of, surface, is_whole=is_whole)
    is_snapped = inputs.options.snap > 0
    return Version(
        triangulation=surface,
        vertex_of=vertex_of,
        lines=lines,
        report=_report(inputs, len(surface.points), len(surface.triangles), account),
        snapped=LineVertices(ground.lines.xy, _renumber(made.line_vertices, number_of))
        if is_snapped
        else None,
    )


def _triangulate_with_lines(
    inputs: BuildInputs,
    ground: _Ground,
    rows: Int64Array,
    progress: Tell | None = None,
) -> tuple[ConstrainedTriangulation, Pslg]:
    made = triangulate_constrained(
        inputs.points, rows, ground.lines, inputs.options, progress=progress
    )
    return made, _gather_pslg(inputs, ground, made, rows)


def _gather_pslg(
    inputs: BuildInputs, ground: _Ground, made: ConstrainedTriangulation, rows: Int64Array
) -> Pslg:
    lines = ground.lines
    vertex_of = np.full(len(inputs.points), -1, np.int32)
    vertex_of[rows] = made.vertex_of
    has_own_boundary = ground.has_own_boundary or inputs.has_own_boundary
    return Pslg(
        points=made.surface.points,
        polylines=made.polylines,
        constraints=lines.table,
        groups=find_ring_groups(inputs, lines),
        clip=replace(inputs.clip, has_own_boundary=has_own_boundary),
        vertex_of=vertex_of,
    )


def find_ring_groups(inputs: BuildInputs, lines: LineSet) -> Int64Array:
    """Return the group of each line among the rings; that of other lines says nothing."""
    of_ring = [
        *([BOUNDARY] * len(inputs.boundary)),
        *([EXTENT] * len(inputs.extent)),
    ]
    of_hole = [HOLES + number for number, rings in enumerate(inputs.holes) for _ in rings]
    groups: dict[str, list[int]] = {"boundary": of_ring, "hole": of_hole}
    if inputs.has_own_boundary:  # of existing triangles, whose rings are edges of the boundary
        groups = {}
    found = [
        groups[kind][source] if kind in groups and source >= 0 else BOUNDARY
        for kind, source in zip(lines.kinds, lines.sources.tolist(), strict=True)
    ]
    return np.array(found, np.int64)


def _renumber(vertices: Int32Array, number_of: Int32Array) -> Int32Array:
    """Renumber vertices of which some are -1, for none."""
    found: Int32Array = np.append(number_of, np.int32(-1))[vertices]
    return found


def _drape_lines(rows: Int64Array, inputs: BuildInputs, progress: Tell | None) -> _Ground:
    """Give all lines elevations: draped ones from the surface of everything else."""
    lines = inputs.lines
    is_draped = lines.is_draped
    if not is_draped.any():
        return _Ground(lines, False, [])
    base = triangulate_constrained(
        inputs.points,
        rows,
        lines.choose(~is_draped),
        replace(inputs.options, conforming=False),
        progress=progress,
    )
    laid = drape(base.surface, lines.choose(is_draped), threads=inputs.threads)
    notes = []
    if laid.cut.n_cut:
        notes.append(
            f"Of {counted(laid.cut.n_cut, 'draped line')} the parts outside the surface "
            "of the points were left out."
        )
    boundary = laid.cut.boundary.lines
    together = LineSet.join([lines.choose(~is_draped), laid.lines, boundary])
    return _Ground(together, len(boundary.kinds) > 0, notes)


# ----------------------------------------------------------------------- account


def _gather_account(
    inputs: BuildInputs,
    ground: _Ground,
    made: ConstrainedTriangulation,
    number_of: Int32Array,
    *,
    rows: Int64Array,
    vertex_of: Int32Array,
) -> dict[str, Any]:
    """Return the report's fields about merged rows, left-out rows and lines that cross."""
    final = _renumber(made.number_of, number_of)
    account = _drop_lost_merges(dict(made.merges), final)
    left_out = np.flatnonzero(vertex_of < 0).astype(np.int32)
    overruled = made.overruled
    # the earlier one of two lines that cross in front
    crossings = made.crossings
    order = np.argsort(crossings.lines, axis=1, kind="stable")
    # why each row was left out, as indices into `LEFT_OUT`; `rows` were used
    xy = inputs.points[left_out, :2]
    why = np.full(len(left_out), LEFT_OUT.index("trimmed"), np.int8)
    for rings in inputs.holes:
        why[in_rings(xy, rings) >= 0] = LEFT_OUT.index("in a hole")
    for outer in (inputs.extent, inputs.boundary):
        if outer and len(left_out):
            why[in_rings(xy, outer) <= 0] = LEFT_OUT.index("outside the boundary")
    why[np.isin(left_out, rows[made.vertex_of < 0])] = LEFT_OUT.index("in water")
    why[~np.isin(left_out, rows)] = LEFT_OUT.index("erased")
    if inputs.is_masked is not None:
        why[inputs.is_masked[left_out]] = LEFT_OUT.index("masked")
    return account | {
        "left_out_rows": left_out,
        "left_out_why": why,
        "n_lines": len(inputs.lines.kinds) - len(inputs.extent),
        "line_labels": tuple(ground.lines.labels()),
        "crossings": crossings._replace(
            vertices=_renumber(crossings.vertices, final),
            lines=np.take_along_axis(crossings.lines, order, axis=1),
            elevations=np.take_along_axis(crossings.elevations, order, axis=1),
        ),
        "overruled": Overruled(_renumber(overruled.vertices, final), *overruled[1:]),
        "notes": (*inputs.notes, *ground.notes),
    }


def _drop_lost_merges(account: dict[str, Any], final: Int32Array) -> dict[str, Any]:
    """Return the merges at vertices that are left, numbered as in the TIN."""
    if not account:
        return account
    vertices = final[account["merged_vertices"]]
    keep = vertices >= 0
    counts = np.diff(account["merged_offsets"])
    rows = np.repeat(keep, counts)
    return {
        "merged_vertices": vertices[keep],
        "merged_offsets": find_offsets(counts[keep]).astype(np.int32),
        "vertex_elevations": account["vertex_elevations"][keep],
        **{k: account[k][rows] for k in ("merged_rows", "merged_elevations", "merged_shifts")},
    }
