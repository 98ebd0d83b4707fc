"""Profiles: each tile has the triangles that the lines meet, which are joined and cut once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...base.checks import as_length, as_number
from ...base.crs import CRS
from ...base.georeference import require_same_crs
from ...terrain import Alignment
from ...terrain.sections import CHORD, as_axis, lines_to_segments, profile
from ...terrain.surface import as_features
from ..along import compute_along, join_along, keep_lines
from ..tasks import TileProduct

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.results import Table
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part

_LINES = "lines"
"""Option and folder of the lines."""


def check_options(
    *, line: Any, interval: float | None = None, start: float = 0.0
) -> dict[str, Any]:
    """Return options, or refuse what is none."""
    line = list(line) if isinstance(line, Iterator) else line
    if isinstance(line, Alignment):
        features = line.to_features(CHORD)
        as_axis(line, line.crs, start, "line", "profile")
    else:
        features = as_features(line)
        lines_to_segments(features, start, "profile")
    if interval is not None:
        as_length("interval", interval)
    return {
        _LINES: keep_lines(line, features),
        "lines_crs": None if features.crs is None else str(features.crs),
        "interval": interval,
        "start": as_number("start", start),
    }


def settle_options(points: StoredPoints, options: Mapping[str, Any]) -> dict[str, Any]:
    """Refuse lines in another CRS than that of all points."""
    require_same_crs(CRS.of(options["lines_crs"]), points.crs, "the lines", is_plain=True)
    return dict(options)


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Return the triangles that lines meet in a tile."""
    return compute_along(part, _LINES)


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> Table:
    """Return the profile along the triangles of all tiles."""
    lines = options[_LINES]
    tin = join_along(points, lines, records, folder)
    made = profile(tin, lines.value, interval=options["interval"], start=options["start"])
    return replace(made, notes=[*points.notes, *made.notes])


PRODUCT = TileProduct(check_options, compute, join, settle_options=settle_options)
