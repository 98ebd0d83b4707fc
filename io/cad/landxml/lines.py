"""Lines as LandXML writes them: breaklines, boundaries and contours of the source data."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from ....tin import Breakline
from ....tin.constraints.constraint_set import as_sequence
from ....tin.constraints.polygons import gather_rings_of_regions
from .content import FEATURE, KIND, LINE, PRIORITY, SOURCE

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import Float64Array
    from ....base.results import Features
    from ....tin import TIN, Survey

__all__ = ["quote", "write_features", "write_source_of_survey", "write_source_of_tin"]

_BOUNDARIES = {"boundary": "outer", "hole": "void"}


def quote(text: str) -> str:
    """Return a text as the value of an attribute, without letters that XML does not have."""
    plain = "".join(one if one.isprintable() else " " for one in text)
    return quoteattr(plain.encode("utf-8", "replace").decode("utf-8"))


def write_source_of_tin(file: IO[str], tin: TIN, points: Float64Array) -> None:
    """Write the lines of a TIN, with the elevations of its vertices.

    A feature of each tells which line it is, so that a reader that knows it restores their order.
    """
    rings, lines = [], []
    described = zip(tin.lines.kinds, tin.lines.names, tin.lines.sources.tolist(), strict=True)
    for number, (chain, (kind, name, source)) in enumerate(
        zip(tin.lines.chains(), described, strict=True)
    ):
        extra = {LINE: str(number), SOURCE: str(source)}
        if kind in _BOUNDARIES and chain[0] == chain[-1]:
            rings.append(_format_boundary(points[chain], _BOUNDARIES[kind], name, extra))
        else:
            lines.append(_format_breakline(points[chain], name, _add_kind(kind, extra)))
    _write_source(file, rings, lines)


def write_source_of_survey(file: IO[str], survey: Survey, surface: str, factor: float) -> None:
    """Write the lines of a survey as the source data of a surface; nothing if there are none."""
    rings = [
        _format_boundary(_scale(ring, factor), kind, "", {})
        for regions, what, kinds in (
            (survey.boundary, "boundary", ("outer", "void")),
            (survey.holes, "hole", ("void", "island")),
        )
        for region in gather_rings_of_regions(as_sequence(regions, what), what)
        for number, ring in enumerate(region)
        for kind in [kinds[min(number, 1)]]
    ]
    lines = [_format_line_of_survey(line, factor) for line in survey.breaklines]
    for one in survey.water:
        ring = np.column_stack([one.ring, np.full(len(one.ring), one.z)])
        ring = _scale(np.concatenate([ring, ring[:1]]), factor)
        lines.append(_format_breakline(ring, one.name, {KIND: "water"}))
    if rings or lines:
        file.write(f"<Surfaces>\n<Surface name={quote(surface)}>\n")
        _write_source(file, rings, lines)
        file.write("</Surface>\n</Surfaces>\n")


def write_features(file: IO[str], features: Features, surface: str, factor: float) -> None:
    """Write lines: those of one elevation as contours, others as breaklines."""
    contours, lines = [], []
    names = features.columns.get("name")
    for owner, part in _iterate_parts(features):
        rows = _scale(part, factor)
        if rows.shape[1] == 3 and np.isfinite(rows).all() and np.ptp(rows[:, 2]) == 0:
            contours.append(_format_contour(rows))
        else:
            rows = rows if np.isfinite(rows).all() else rows[:, :2]
            name = "" if names is None else str(names[owner])
            lines.append(_format_breakline(rows, name, {}))
    file.write(f"<Surfaces>\n<Surface name={quote(surface)}>\n")
    _write_source(file, [], lines, contours)
    file.write("</Surface>\n</Surfaces>\n")


def _iterate_parts(features: Features) -> Iterator[tuple[int, Float64Array]]:
    """Yield each line with the feature that it belongs to."""
    offsets = features.offsets[0].tolist()
    owners = (
        np.repeat(np.arange(len(features)), np.diff(features.offsets[1])).tolist()
        if features.is_multi
        else range(len(features))
    )
    for owner, start, end in zip(owners, offsets[:-1], offsets[1:], strict=True):
        yield owner, features.coordinates[start:end]


def _scale(rows: Float64Array, factor: float) -> Float64Array:
    return rows if factor == 1.0 or rows.shape[1] == 2 else rows * [1.0, 1.0, factor]


def _format_line_of_survey(line: Any, factor: float) -> str:
    one = line if isinstance(line, Breakline) else Breakline(line)
    extra = {PRIORITY: str(one.priority)} if one.priority else {}
    return _format_breakline(_scale(one.coords, factor), one.name, _add_kind(one.kind, extra))


def _add_kind(kind: str, extra: dict[str, str]) -> dict[str, str]:
    return extra if kind == "hard" else {KIND: kind, **extra}


def _write_source(
    file: IO[str], rings: list[str], lines: list[str], contours: list[str] | None = None
) -> None:
    if not (rings or lines or contours):
        return
    file.write("<SourceData>\n")
    groups = (("Boundaries", rings), ("Breaklines", lines), ("Contours", contours or []))
    for name, elements in groups:
        if elements:
            file.write(f"<{name}>\n{''.join(elements)}</{name}>\n")
    file.write("</SourceData>\n")


def _format_breakline(rows: Float64Array, name: str, extra: dict[str, str]) -> str:
    brk = "nondestructive" if rows.shape[1] == 2 else "standard"
    named = f" name={quote(name)}" if name else ""
    return (
        f'<Breakline brkType="{brk}"{named}>\n{_format_list(rows)}{_format_feature(extra)}'
        "</Breakline>\n"
    )


def _format_boundary(rows: Float64Array, kind: str, name: str, extra: dict[str, str]) -> str:
    if (rows[0, :2] != rows[-1, :2]).any():
        rows = np.concatenate([rows, rows[:1]])
    named = f" name={quote(name)}" if name else ""
    return (
        f'<Boundary bndType="{kind}" edgeTrim="true"{named}>\n{_format_list(rows)}'
        f"{_format_feature(extra)}</Boundary>\n"
    )


def _format_contour(rows: Float64Array) -> str:
    return f'<Contour elev="{float(rows[0, 2])!r}">\n{_format_list(rows[:, :2])}</Contour>\n'


def _format_list(rows: Float64Array) -> str:
    ordered = rows[:, [1, 0, *range(2, rows.shape[1])]].ravel().tolist()
    tag = f"PntList{rows.shape[1]}D"
    return f"<{tag}>{' '.join(map(repr, ordered))}</{tag}>\n"


def _format_feature(values: dict[str, str]) -> str:
    if not values:
        return ""
    properties = "".join(
        f'<Property label="{label}" value={quote(value)}/>\n' for label, value in values.items()
    )
    return f'<Feature name="{FEATURE}">\n{properties}</Feature>\n'
