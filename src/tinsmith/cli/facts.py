"""Facts about points and TINs: as plain values for JSON, and as fields for people."""

from __future__ import annotations

import re
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..io.crs import as_crs, elevation_unit, is_geographic, length_unit
from ..terrain import slope
from ..tin import TIN, Bounds, Survey, quality
from .console import count
from .line_facts import constrained_edges, given_lines, given_lines_text, tin_counts

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from ..tin import Merge, Quality, Report
    from .console import Field

__all__ = [
    "crs_field",
    "extent_fields",
    "file_size",
    "merge_field",
    "quality_fields",
    "quality_of",
    "reading_fields",
    "report_facts",
    "survey_facts",
    "survey_fields",
    "tin_facts",
    "tin_fields",
    "units",
]

_EXPECTED = "header lines"
"""What every file may have, and nobody needs to be told of."""


def survey_facts(survey: Survey) -> dict[str, Any]:
    """Describe points as plain values."""
    return {
        "kind": "points",
        "points": len(survey),
        **_place_facts(survey.points, survey.crs),
        "attributes": list(survey.attributes),
        **given_lines(survey),
        "skipped": dict(survey.skipped),
        "notes": list(survey.notes),
    }


def tin_facts(tin: TIN) -> dict[str, Any]:
    """Describe a TIN as plain values; measures on the ground are None in degrees."""
    return {
        "kind": "tin",
        "vertices": len(tin.points),
        "triangles": len(tin.triangles),
        "edges": len(tin.edges),
        "hull_vertices": len(tin.hull),
        "rings": len(tin.rings),
        "constrained_edges": constrained_edges(tin),
        "lines": {kind: tin.lines.kinds.count(kind) for kind in sorted(set(tin.lines.kinds))},
        **_place_facts(tin.points, tin.crs),
        **_ground_facts(tin),
    }


def quality_of(tin: TIN) -> Quality | None:
    """Measure the triangles in the plane; None in degrees, where angles are not those on earth."""
    return None if is_geographic(tin.crs) else quality(tin)


def report_facts(report: Report, survey: Survey, gaps: Sequence[str] = ()) -> dict[str, Any]:
    """Return the report, with the gaps found, and the point numbers of merged rows."""
    facts = report.to_dict()
    facts["notes"] += gaps
    numbers = survey.attributes.get("number")
    if numbers is not None:
        for merge in facts["merges"]:
            merge["numbers"] = [_plain(numbers[row]) for row in merge["rows"]]
    return facts


def _plain(value: Any) -> Any:
    return value.item() if isinstance(value, np.generic) else value


def _place_facts(points: NDArray[np.float64], crs: str | None) -> dict[str, Any]:
    z = points[:, 2]
    return {
        "bounds": asdict(Bounds.of(points)),
        "elevation": {"min": float(z.min()), "max": float(z.max()), "mean": float(z.mean())},
        "crs": crs,
        "crs_name": None if crs is None else as_crs(crs).name,
        "units": {"horizontal": length_unit(crs).name, "vertical": elevation_unit(crs).name},
    }


def _ground_facts(tin: TIN) -> dict[str, Any]:
    if is_geographic(tin.crs):
        return {"area": None, "surface_area": None, "slope": None}
    solid = _with_one_unit(tin)
    degrees = slope(solid)
    return {
        "area": solid.area,
        "surface_area": solid.surface_area,
        "slope": {
            "min": float(degrees.min()),
            "mean": float(np.average(degrees, weights=solid.triangle_areas)),
            "max": float(degrees.max()),
        },
    }


def _with_one_unit(tin: TIN) -> TIN:
    """Return the TIN with elevations in the unit of its eastings and northings."""
    across, up = length_unit(tin.crs).metres, elevation_unit(tin.crs).metres
    if across is None or up is None or across == up:
        return tin
    return tin.replace(points=tin.points * [1.0, 1.0, up / across])


# ---------------------------------------------------------------- for people


def units(crs: str | None) -> tuple[str, str]:
    """Return the symbols of horizontal and vertical units, with the space before them."""
    across, up = length_unit(crs).symbol, elevation_unit(crs).symbol
    return across if across == "°" else f" {across}", f" {up}"


def survey_fields(survey: Survey) -> list[Field]:
    """Describe points."""
    fields = [("Points", f"{len(survey):,}"), *reading_fields(survey)]
    if survey.attributes:
        fields.append(("Columns", ", ".join(survey.attributes)))
    if survey.has_lines:
        fields.append(("Lines", given_lines_text(survey)))
    return [*fields, *extent_fields(survey.points, survey.crs), crs_field(survey.crs)]


def tin_fields(tin: TIN) -> list[Field]:
    """Describe a TIN."""
    facts = _ground_facts(tin)
    across, _ = units(tin.crs)
    fields = [
        ("TIN", tin_counts(tin)),
        ("Edges", f"{len(tin.edges):,}, {len(tin.hull):,} of them on the hull"),
        *extent_fields(tin.points, tin.crs),
    ]
    if facts["slope"] is not None:
        steep = facts["slope"]
        fields += [
            ("Area", f"{facts['area']:,.1f}{across}² in the plane"),
            ("", f"{facts['surface_area']:,.1f}{across}² in space"),
            ("Slope", f"{steep['min']:.1f}° to {steep['max']:.1f}°, mean {steep['mean']:.1f}°"),
        ]
    return [*fields, crs_field(tin.crs)]


def quality_fields(shapes: Quality | None) -> list[Field]:
    """Describe the shapes of triangles in two lines; in none if they were not measured."""
    if shapes is None:
        return []
    found = shapes.summary()
    smallest, aspect = found["min_angle"], found["aspect_ratio"]
    below = 100 * found["shares"]["min_angle_below"]["20"]
    return [
        (
            "Quality",
            f"smallest angle: median {smallest['median']:.1f}°, worst {smallest['min']:.2g}°, "
            f"below 20° in {below:.1f} % of triangles",
        ),
        ("", f"aspect ratio: median {aspect['median']:.2f}, worst {_ratio(aspect['max'])}"),
    ]


def _ratio(value: float) -> str:
    return f"{value:,.0f}" if 100 <= value < 1e9 else f"{value:.3g}"


def extent_fields(points: NDArray[np.float64], crs: str | None) -> list[Field]:
    """Describe where points lie, and how high."""
    across, up = units(crs)
    digits = 7 if is_geographic(crs) else 3
    box = Bounds.of(points)
    low, high = points[:, 2].min(), points[:, 2].max()
    east, north = ("longitude", "latitude") if is_geographic(crs) else ("easting", "northing")
    return [
        ("Extent", f"{box.width:,.{digits}f}{across} x {box.height:,.{digits}f}{across}"),
        ("", f"{east} {box.xmin:.{digits}f} to {box.xmax:.{digits}f}"),
        ("", f"{north} {box.ymin:.{digits}f} to {box.ymax:.{digits}f}"),
        ("Elevation", f"{low:,.3f} to {high:,.3f}{up}"),
    ]


def crs_field(crs: str | None) -> Field:
    """Name the CRS."""
    if crs is None:
        return ("CRS", "unknown (name it with --crs)")
    name = str(as_crs(crs).name)
    return ("CRS", f"{crs}, {name}" if len(crs) <= 24 else name)


def reading_fields(survey: Survey) -> list[Field]:
    """Say what the reader left out and what it assumed, if anything."""
    skipped = [
        count(number, _singular(what), what)
        for what, number in survey.skipped.items()
        if what != _EXPECTED
    ]
    fields = [("Skipped", ", ".join(skipped))] if skipped else []
    return [*fields, *(("Note", note) for note in survey.notes)]


def _singular(what: str) -> str:
    """Return what was skipped as one thing: "nodata cells", "rows without an elevation"."""
    return re.sub(r"\b(cell|row|line|point)s\b", r"\1", what, count=1)


def merge_field(report: Report, survey: Survey) -> list[Field]:
    """Say how many rows were merged and where their elevations differ most."""
    surplus = len(report.merged_rows) - len(report.merged_vertices)
    if surplus == 0:
        return []
    text = f"{count(surplus, 'row')} at {count(len(report.merged_vertices), 'place')}"
    starts = report.merged_offsets[:-1]
    spread = np.maximum.reduceat(report.merged_heights, starts) - np.minimum.reduceat(
        report.merged_heights, starts
    )
    worst = int(spread.argmax())
    if spread[worst] == 0:
        return [("Merged", f"{text}, with equal elevations")]
    merge = next(_merges_from(report, worst))
    _, up = units(survey.crs)
    differing = int(np.count_nonzero(spread))
    return [
        ("Merged", f"{text}, elevation by '{report.duplicates}'"),
        (
            "",
            f"elevations differ at {count(differing, 'place')}, most by {spread[worst]:.3f}{up}: "
            f"{_rows_text(merge, survey)}",
        ),
    ]


def _merges_from(report: Report, index: int) -> Any:
    """Walk the merges from the one at ``index``."""
    begin = report.merged_offsets[index]
    return replace(
        report,
        merged_vertices=report.merged_vertices[index:],
        merged_offsets=report.merged_offsets[index:] - begin,
        merged_rows=report.merged_rows[begin:],
        merged_heights=report.merged_heights[begin:],
        merged_shifts=report.merged_shifts[begin:],
        vertex_heights=report.vertex_heights[index:],
    ).merges()


def _rows_text(merge: Merge, survey: Survey) -> str:
    """Name the rows of a merge, by point number where there is one, with their elevations."""
    numbers = survey.attributes.get("number")
    names = merge.rows if numbers is None else [numbers[row] for row in merge.rows]
    shown = ", ".join(
        f"{name} ({height:.3f})"
        for name, height in list(zip(names, merge.heights, strict=True))[:4]
    )
    more = "" if len(merge.rows) <= 4 else " ..."
    return f"{'rows' if numbers is None else 'points'} {shown}{more}"


def file_size(path: Path) -> str:
    """Return the size of a file for people."""
    size = float(path.stat().st_size)
    for unit in ("bytes", "kB", "MB"):
        if size < 1000:
            return f"{size:.0f} {unit}" if unit == "bytes" or size >= 100 else f"{size:.1f} {unit}"
        size /= 1000
    return f"{size:.1f} GB"
