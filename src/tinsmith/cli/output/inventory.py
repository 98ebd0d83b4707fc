"""What ``tinsmith info`` tells of the files of a folder, by their headers alone."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from ...base.sentences import coordinate, counted
from ..tiling import add_plan
from .facts import Facts

if TYPE_CHECKING:
    from pathlib import Path

    from ...io.inventory import Inventory
    from ...io.registry import SourceHeader
    from ..job import Job


def find_tiles(folder: Path, job: Job) -> list[Path]:
    """Return the files of points of a folder; none where it has no such, but is one itself."""
    from ...base.errors import ReadError
    from ...io.reading import list_files

    try:
        return list_files(folder, job.reading.format)
    except ReadError:
        return []  # the reader tells better


def describe_folder(path: Path, files: list[Path], job: Job) -> Facts:
    """Return what there is to tell of the files of points of a folder."""
    from ...io.inventory import take_inventory
    from ...tiled import tiles

    given = {name: value for name, value in job.reading.given.items() if name != "remote"}
    found = take_inventory(files, **given)
    facts = Facts(path, kind="files")
    size = sum(one.size for one in found.headers)
    facts.add("Files", f"{counted(len(files), 'file')}, {size / 1e6:,.1f} MB", bytes=size)
    points = "unknown" if found.count is None else f"{found.count:,}"
    facts.add("Points", points, points=found.count)
    _add_place(facts, found)
    if len(found.headers) == len(files):
        add_plan(facts, tiles(files, **given).plan())
    facts.record(
        files=[_describe_file(one) for one in found.headers],
        disagreements=[one._asdict() for one in found.disagreements],
        overlaps=[one._asdict() for one in found.overlaps],
    )
    for one in found.disagreements:
        facts.add(one.kind.replace("_", " ").capitalize(), one.sentence)
    facts.note(dict.fromkeys(note for header in found.headers for note in header.notes))
    return facts


def _add_place(facts: Facts, found: Inventory) -> None:
    boxes = [one.bounds for one in found.headers if one.bounds is not None and one.count != 0]
    names = list(dict.fromkeys(_name_crs(one) for one in found.headers))
    if boxes and len(names) == 1:
        west, south = (min(getattr(box, side) for box in boxes) for side in ("xmin", "ymin"))
        east, north = (max(getattr(box, side) for box in boxes) for side in ("xmax", "ymax"))
        bounds = {"xmin": west, "ymin": south, "xmax": east, "ymax": north}
        text = (
            f"{coordinate(west)} to {coordinate(east)} east, {coordinate(south)} to "
            f"{coordinate(north)} north"
        )
        facts.add("Extent", text, bounds=bounds)
    facts.add("CRS", "; ".join(names), crs=names)
    records = list(dict.fromkeys(one.records for one in found.headers if one.records))
    if records:
        facts.add("Records", "; ".join(records), records=records)
    if found.densities:
        low, high = min(found.densities), max(found.densities)
        text = f"{low:.3g} to {high:.3g} points per square unit within the bounds of a file"
        facts.add("Density", text, density={"lowest": low, "highest": high})


def _name_crs(header: SourceHeader) -> str:
    return "not known" if header.crs is None else header.crs.label


def _describe_file(one: SourceHeader) -> dict[str, Any]:
    from ...io.inventory import measure_density

    return {
        "path": str(one.path),
        "format": one.format,
        "bytes": one.size,
        "points": one.count,
        "bounds": None if one.bounds is None else asdict(one.bounds),
        "crs": None if one.crs is None else str(one.crs),
        "elevation_unit": None if one.elevation_unit is None else one.elevation_unit.text,
        "records": one.records,
        "density": measure_density(one),
    }
