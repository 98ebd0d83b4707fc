"""Texts of a report: what was compared, the volumes, notes, and lines for signatures."""

from __future__ import annotations

import hashlib
import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.atomic import as_path
from ....base.errors import OptionError, ReadError
from ..paper import INK, Pen, clean_text, fit_text, measure_text

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from ....base.crs import Unit
    from ....base.results import Table
    from ....tin import TIN, Bounds
    from ..paper import Drawable

HEADING, PLAIN, SMALL = 3.4, 2.4, 1.9
"""Sizes of letters, millimetres."""
_LEAST = 1.3
_SPACING = 1.55
_RULE = Pen(INK, 0.13)
_SIGNATURES = ("Prepared by", "Checked by", "Accepted by")
_SIGNATURE = 13.0
"""Millimetres for each line to sign."""
_KINDS = ("cut", "fill", "net")


class Line(NamedTuple):
    """A line of a page: its cells, and where each begins as a share of the width."""

    cells: tuple[str, ...]
    places: tuple[float, ...] = (0.0,)
    size: float = PLAIN
    before: float = 0.0
    """Millimetres above it."""
    has_rule: bool = False
    """Below it."""

    @property
    def height(self) -> float:
        """Of the line with what is above it."""
        return self.before + _SPACING * self.size


def head(text: str) -> Line:
    """Return the heading of a part."""
    return Line((text,), size=HEADING, before=4.0)


# ---------------------------------------------------------------- what was compared


def describe_surface(role: str, tin: TIN, file: Path | None, unit: str) -> Iterator[Line]:
    """Yield lines on a surface: its file with its SHA-256, its points, its elevations."""
    places = (0.0, 0.16)
    name = tin.source if file is None else file.name
    yield Line((role, clean_text(name) or "made by the program"), places, before=1.0)
    if file is not None:
        yield Line(("", f"SHA-256 {hash_file(file)}"), places, SMALL)
    low, high = float(tin.points[:, 2].min()), float(tin.points[:, 2].max())
    counts = f"{len(tin.points):,} points, {len(tin.triangles):,} triangles"
    yield Line(("", f"{counts}, elevations {low:,.3f} to {high:,.3f} {unit}".rstrip()), places)


def describe_base(base: Any, unit: str) -> Line:
    """Return the line on a level or a plane."""
    given = np.asarray(base, np.float64)
    text = (
        f"level {float(given):,.3f} {unit}".rstrip()
        if given.ndim == 0
        else "a plane through "
        + ("; ".join(", ".join(f"{one:,.3f}" for one in point) for point in given.tolist()))
    )
    return Line(("Base", text), (0.0, 0.16), before=1.0)


def as_files(files: Any, count: int) -> list[Path | None]:
    """Return the file of each surface; OptionError if they are not as many."""
    if files is None:
        return [None] * count
    given = [files] if isinstance(files, str) or hasattr(files, "__fspath__") else list(files)
    if len(given) != count:
        allowed = f"{count}, one for each surface"
        raise OptionError("files", len(given), allowed, what="number of files")
    return [as_path(one, "files") for one in given]


def hash_file(path: Path) -> str:
    """Return the SHA-256 of a file; ReadError if there is none."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        why = error.strerror or str(error)
        raise ReadError(f"Cannot read '{path}' for its fingerprint: {why}.", path=path) from error


# ---------------------------------------------------------------- volumes


def list_volumes(table: Table) -> Iterator[Line]:
    """Yield the table of volumes, region by region, with errors and what is beyond a level."""
    volume, area = (_write_unit(table, name) for name in ("cut", "area"))
    places = (0.0, 0.24, 0.43, 0.62, 0.81)
    heads = ("Region", *(f"{kind.capitalize()}{volume}" for kind in _KINDS), f"Area{area}")
    yield Line(heads, places, has_rule=True)
    for row in range(len(table)):
        numbers = [_write(table, name, row) for name in (*_KINDS, "area")]
        yield Line((clean_text(str(table["region"][row])), *numbers), places)
        if "net_error" in table.columns:
            errors = [f"± {_write(table, f'{kind}_error', row)}" for kind in _KINDS]
            yield Line(("  standard error", *errors), places, SMALL)
        if "level_of_detection" in table.columns:
            level = f"{float(table['level_of_detection'][row]):.4g}"
            unit = _write_unit(table, "level_of_detection")
            beyond = [_write(table, f"thresholded_{kind}", row) for kind in _KINDS]
            yield Line((f"  beyond {level}{unit}", *beyond), places, SMALL)
        areas = [f"{_write(table, f'{kind}_area', row)}{area}" for kind in ("cut", "fill")]
        yield Line(("  over an area of", *areas, "", ""), places, SMALL)
    yield from _list_areas_alone(table)


def _list_areas_alone(table: Table) -> Iterator[Line]:
    words = {"area_alone": "the first surface", "base_area_alone": "the other surface"}
    for name, what in words.items():
        if name in table.columns and float(table[name].max()) >= 0.005:
            sizes = ", ".join(_write(table, name, row) for row in range(len(table)))
            text = f"Not compared, where only {what} is: {sizes}{_write_unit(table, name)}"
            yield Line((text,), size=SMALL)


def _write_unit(table: Table, name: str) -> str:
    unit: Any = table.units.get(name)
    symbol = getattr(unit, "symbol", unit) or ""
    return f" {symbol}" if symbol else ""


def _write(table: Table, name: str, row: int) -> str:
    value = float(table[name][row])
    return f"{value:,.2f}" if math.isfinite(value) else "\N{EN DASH}"


# ---------------------------------------------------------------- pages


def list_notes(notes: Sequence[str], width: float) -> Iterator[Line]:
    """Yield notes, each on as many lines as it needs."""
    for note in notes:
        fitted = fit_text(clean_text(note), width - 3.0, size=SMALL, least=SMALL, lines=200)
        for number, text in enumerate(fitted.lines):
            mark = "\N{EN DASH}" if number == 0 else ""
            yield Line((mark, text), (0.0, 3.0 / width), SMALL)


def divide(lines: Sequence[Line], height: float, last: float) -> list[list[Line]]:
    """Divide lines into pages of a height; the last page keeps room for something else."""
    pages: list[list[Line]] = [[]]
    left = height
    for line in lines:
        if line.height > left:
            pages.append([])
            left = height
        pages[-1].append(line)
        left -= line.height
    if left < last:
        pages.append([])
    return pages


def draw_lines(canvas: Drawable, lines: Sequence[Line], frame: Bounds) -> bool:
    """Write lines from the top of a frame down; tell whether all had room."""
    y, have_room = frame.ymax, True
    for line in lines:
        y -= line.height
        ends = [*line.places[1:], 1.0]
        for number, text in enumerate(line.cells):
            left = frame.xmin + line.places[number] * frame.width
            room = (ends[number] - line.places[number]) * frame.width - 1.5
            if not text:
                continue
            fitted = fit_text(text, room, size=line.size, least=_LEAST)
            is_figure = number > 0 and len(line.cells) > 2
            x = left + room - measure_text(fitted.lines[0], fitted.size) if is_figure else left
            canvas.write((x, y), fitted.lines[0], size=fitted.size, name="report")
            have_room &= not fitted.is_cut
        if line.has_rule:
            rule = np.array([(frame.xmin, y - 1.0), (frame.xmax, y - 1.0)])
            canvas.draw_paths([rule], _RULE, "report-rule")
            y -= 0.8
    return have_room


def measure_signatures() -> float:
    """Return the height of the lines to sign, millimetres."""
    return _SIGNATURE * len(_SIGNATURES) + 4.0


def draw_signatures(canvas: Drawable, frame: Bounds) -> None:
    """Draw lines to sign, at the foot of a frame."""
    middle = frame.xmin + 0.62 * frame.width
    for number, who in enumerate(reversed(_SIGNATURES)):
        y = frame.ymin + number * _SIGNATURE + 5.0
        rules = [
            np.array([(frame.xmin, y), (middle - 6.0, y)]),
            np.array([(middle, y), (frame.xmax, y)]),
        ]
        canvas.draw_paths(rules, _RULE, "signature")
        canvas.write((frame.xmin, y - 3.0), f"{who} (name, signature)", size=SMALL)
        canvas.write((middle, y - 3.0), "Place, date", size=SMALL)


def find_symbol(unit: Unit | None) -> str:
    """Return the symbol of a unit; "" if it is not known."""
    return "" if unit is None else unit.symbol
