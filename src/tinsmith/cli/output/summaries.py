"""What is told of points and TINs: records for JSON, and rows for people."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.crs import assume_elevation_unit
from ...base.georeference import find_axes
from ...base.sentences import counted, write_spacing
from ...io.reprojection import is_geographic, length_unit
from ...terrain import slope
from ...terrain.surface import measure_areas
from ...tin import TIN, Bounds, Survey, quality
from ...tin.report import describe_skipped
from .counts import count_constrained_edges, describe_counts
from .line_summaries import count_given_lines, describe_given_lines, find_elevation_symbol

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.crs import CRS
    from ...terrain import Raster
    from ...tin import Merge, Quality, Report
    from .console import Row


def describe_survey(survey: Survey) -> dict[str, Any]:
    """Describe points as plain values."""
    return {
        "kind": "points",
        "points": len(survey),
        **_describe_place(survey),
        "attributes": list(survey.attributes),
        **count_given_lines(survey),
        "skipped": dict(survey.skipped),
        "skipped_lines": {what: list(rows) for what, rows in survey.skipped_lines.items()},
        "notes": list(survey.notes),
        "findings": [finding.to_dict() for finding in survey.findings],
    }


def describe_tin(tin: TIN) -> dict[str, Any]:
    """Describe a TIN as plain values; areas are None in degrees."""
    return {
        "kind": "tin",
        "vertices": len(tin.points),
        "triangles": len(tin.triangles),
        "edges": len(tin.edges),
        "hull_vertices": len(tin.hull),
        "rings": len(tin.rings),
        "constrained_edges": count_constrained_edges(tin),
        "lines": {kind: tin.lines.kinds.count(kind) for kind in sorted(set(tin.lines.kinds))},
        "attributes": list(tin.attributes),
        **_describe_place(tin),
        **_describe_ground(tin),
        "notes": list(tin.report.notes),
    }


def describe_raster_size(raster: Raster) -> str:
    """Return rows, columns and spacing for a summary."""
    rows, columns = raster.shape
    spacing = write_spacing(raster.grid.spacing)
    return f"{counted(rows, 'row')} by {counted(columns, 'column')} of {spacing}"


def measure_quality(tin: TIN) -> Quality | None:
    """Measure the triangles in the plane; None in degrees, where angles are not those on earth."""
    return None if is_geographic(tin.crs) else quality(tin)


def describe_report(tin: TIN, survey: Survey, notes: Sequence[str] = ()) -> dict[str, Any]:
    """Return the report, with further notes, and the point numbers of merged rows.

    Rows are those of the TIN's input, to which the survey may have been added.
    """
    report = tin.report
    record = report.to_dict()
    record["notes"] = list(dict.fromkeys([*record["notes"], *notes]))
    record["skipped_lines"] = {what: list(rows) for what, rows in survey.skipped_lines.items()}
    record["findings"] = [finding.to_dict() for finding in survey.findings]
    numbers = tin.row_attributes.get("number")
    if numbers is not None:
        for merge in record["merges"]:
            merge["numbers"] = np.asarray(numbers)[list(merge["rows"])].tolist()
    return record


def _describe_place(found: Survey | TIN) -> dict[str, Any]:
    crs, unit = found.crs, found.elevation_unit
    bounds = None
    elevation: dict[str, Any] | None = None
    if len(found.points):
        bounds, z = asdict(Bounds.of(found.points)), found.points[:, 2]
        usual = assume_elevation_unit(crs, None) if unit is None else None
        elevation = {"min": float(z.min()), "max": float(z.max()), "mean": float(z.mean())}
        elevation["unit_assumed"] = None if usual is None else usual.name
    return {
        "bounds": bounds,
        "elevation": elevation,
        "crs": None if crs is None else str(crs),
        "crs_name": None if crs is None else crs.name,
        "units": {
            "horizontal": "unknown" if crs is None else crs.horizontal_unit.name,
            "vertical": "unknown" if unit is None else unit.name,
        },
    }


def _describe_ground(tin: TIN) -> dict[str, Any]:
    degrees, in_degrees = slope(tin), is_geographic(tin.crs)
    return {
        "area": None if in_degrees else tin.area,
        "surface_area": None if in_degrees else tin.surface_area,
        "slope": {
            "min": float(degrees.min()),
            "mean": float(np.average(degrees, weights=measure_areas(tin))),
            "max": float(degrees.max()),
        },
    }


# ---------------------------------------------------------------- for people


def find_symbols(found: Survey | TIN) -> tuple[str, str]:
    """Return the symbols behind horizontal and vertical numbers, with the space before them."""
    across = length_unit(found.crs).symbol
    return across if across == "°" else f" {across}", find_elevation_symbol(found)


def note_assumed_unit(found: Survey | TIN) -> str:
    """Say what the unit of elevations is taken to be where it is not known; else nothing."""
    if found.elevation_unit is not None:
        return ""
    usual = assume_elevation_unit(found.crs, None)
    if usual is None or found.crs is None:
        return "unit not known"
    return f"unit not known, taken to be {usual.name}, the usual one in {found.crs.label}"


def summarise_survey(survey: Survey) -> list[Row]:
    """Describe points."""
    rows = [("Points", f"{len(survey):,}"), *summarise_reading(survey)]
    if survey.attributes:
        rows.append(("Columns", ", ".join(survey.attributes)))
    if survey.has_lines:
        rows.append(("Lines", describe_given_lines(survey)))
    return [*rows, *summarise_extent(survey), summarise_crs(survey.crs)]


def summarise_tin(tin: TIN) -> list[Row]:
    """Describe a TIN."""
    record = _describe_ground(tin)
    across, _ = find_symbols(tin)
    rows = [
        ("TIN", describe_counts(tin)),
        ("Edges", f"{len(tin.edges):,}, {sum(map(len, tin.boundary)):,} of them on the boundary"),
        *([("Columns", ", ".join(tin.attributes))] if tin.attributes else []),
        *summarise_extent(tin),
    ]
    if record["area"] is not None:
        rows += [
            ("Area", f"{record['area']:,.1f}{across}² in the plane"),
            ("", f"{record['surface_area']:,.1f}{across}² in space"),
        ]
    low, mean, high = (record["slope"][name] for name in ("min", "mean", "max"))
    rows.append(("Slope", f"{low:.1f}° to {high:.1f}°, mean {mean:.1f}°"))
    return [*rows, summarise_crs(tin.crs), *summarise_reading(tin)]


def summarise_quality(shapes: Quality | None) -> list[Row]:
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
        ("", f"aspect ratio: median {aspect['median']:.2f}, worst {_format_ratio(aspect['max'])}"),
    ]


def _format_ratio(value: float) -> str:
    return f"{value:,.0f}" if 100 <= value < 1e9 else f"{value:.3g}"


def summarise_extent(found: Survey | TIN) -> list[Row]:
    """Describe where points lie, and how high; a file of lines alone has none."""
    if len(found.points) == 0:
        return []
    across, up = find_symbols(found)
    in_degrees = is_geographic(found.crs)
    digits = 7 if in_degrees else 3
    box = Bounds.of(found.points)
    low, high = found.points[:, 2].min(), found.points[:, 2].max()
    grid = tuple(f"{direction}ing" for direction in find_axes(found.crs))
    first, second = ("longitude", "latitude") if in_degrees else grid
    note = note_assumed_unit(found)
    return [
        ("Extent", f"{box.width:,.{digits}f}{across} x {box.height:,.{digits}f}{across}"),
        ("", f"{first} {box.xmin:.{digits}f} to {box.xmax:.{digits}f}"),
        ("", f"{second} {box.ymin:.{digits}f} to {box.ymax:.{digits}f}"),
        ("Elevation", f"{low:,.3f} to {high:,.3f}{up}{f' ({note})' if note else ''}"),
    ]


def summarise_crs(crs: CRS | None) -> Row:
    """Name the CRS."""
    if crs is None:
        return ("CRS", "unknown (name it with --crs)")
    return ("CRS", crs.name if crs.label == crs.name else f"{crs}, {crs.name}")


def summarise_reading(found: Survey | TIN) -> list[Row]:
    """Say what the reader left out, what it assumed and what it found odd, if anything."""
    if not isinstance(found, Survey):
        return [("Note", note) for note in found.report.notes]
    return [("Note", note) for note in (*describe_skipped(found.skipped), *found.notes)]


def summarise_merges(report: Report, survey: Survey) -> list[Row]:
    """Say how many rows were merged and where their elevations differ most."""
    surplus = len(report.merged_rows) - len(report.merged_vertices)
    if surplus == 0:
        return []
    text = f"{counted(surplus, 'row')} at {counted(len(report.merged_vertices), 'place')}"
    starts = report.merged_offsets[:-1]
    spread = np.maximum.reduceat(report.merged_elevations, starts) - np.minimum.reduceat(
        report.merged_elevations, starts
    )
    worst = int(spread.argmax())
    if spread[worst] == 0:
        return [("Merged", f"{text}, with equal elevations")]
    begin = report.merged_offsets[worst]
    merge = next(
        replace(
            report,
            merged_vertices=report.merged_vertices[worst:],
            merged_offsets=report.merged_offsets[worst:] - begin,
            merged_rows=report.merged_rows[begin:],
            merged_elevations=report.merged_elevations[begin:],
            merged_shifts=report.merged_shifts[begin:],
            vertex_elevations=report.vertex_elevations[worst:],
        ).merges()
    )
    up = find_elevation_symbol(survey)
    differing = int(np.count_nonzero(spread))
    return [
        ("Merged", f"{text}, elevation by '{report.duplicates}'"),
        (
            "",
            f"elevations differ at {counted(differing, 'place')}, most by {spread[worst]:.3f}{up}: "
            f"{_describe_rows(merge, survey)}",
        ),
    ]


def _describe_rows(merge: Merge, survey: Survey) -> str:
    """Name the rows of a merge, by point number where there is one, with their elevations."""
    numbers = survey.attributes.get("number")
    names = merge.rows if numbers is None else [numbers[row] for row in merge.rows]
    shown = ", ".join(
        f"{name} ({height:.3f})"
        for name, height in list(zip(names, merge.elevations, strict=True))[:4]
    )
    more = "" if len(merge.rows) <= 4 else " ..."
    return f"{'rows' if numbers is None else 'points'} {shown}{more}"


def describe_file_size(path: Path) -> str:
    """Return the size of a file for people; of a folder, that of all files in it."""
    files = [one for one in path.rglob("*") if one.is_file()] if path.is_dir() else [path]
    size = float(sum(one.stat().st_size for one in files))
    for unit in ("bytes", "kB", "MB"):
        if size < 1000:
            return f"{size:.0f} {unit}" if unit == "bytes" or size >= 100 else f"{size:.1f} {unit}"
        size /= 1000
    return f"{size:.1f} GB"
