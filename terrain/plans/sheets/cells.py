"""Section cells: cross sections on paper, each with its grid, its labels and its cut and fill."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import OptionError
from ...drawing import format_number, palette
from ..paper import INK, Pen, fit_text, measure_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import BoolArray, Float64Array
    from ..paper import Drawable
    from ..scales import Scale

HEAD, ROW = 10.0, 3.4
"""Millimetres above the grid for station and areas, and of a row of figures below."""
_RIGHT = 4.0
_SIZE, _STATION_SIZE, _LEAST_SIZE = 1.8, 2.6, 1.2
_NARROWEST = 60.0
"""Of a cell, so that station and areas have room."""
_STEP_UP, _STEP_ALONG = 6.0, 12.0
"""Between lines of the grid at least."""
_AIR = 2.0
"""Between the lowest line and the datum, the highest and the top."""
_FINEST = 1e-3
"""Rounding of elevations as a share of a step of the grid, at most."""
GRID_PEN = Pen(palette.GRID, 0.13)
DATUM_PEN = Pen(INK, 0.35)
FRAME_PEN = Pen(INK, 0.18)
AXIS_PEN = Pen(INK, 0.18, (6.0, 1.5, 1.0, 1.5))
KINDS = ("cut", "fill")
HATCH_PENS = {"cut": Pen(palette.EARTHWORK[0], 0.13), "fill": Pen(palette.EARTHWORK[4], 0.13)}
TINTS = {"cut": palette.CUT, "fill": palette.FILL}
ANGLES = {"cut": 45.0, "fill": 135.0}


@dataclass(frozen=True, eq=False)
class Section:
    """Surfaces along a line square to the axis."""

    station: str
    """As it is written."""
    offsets: Float64Array
    """(n,)."""
    elevations: Float64Array
    """(k, n) of k surfaces; NaN where one is not."""
    areas: tuple[str, str] | None
    """Cut and fill as they are written, if there are two surfaces."""
    ends: tuple[float, float]
    """Lowest and highest elevation; NaN where no surface is."""


class Measures(NamedTuple):
    """How sections are drawn, all of them alike."""

    reaches: tuple[float, float]
    """First and last offset."""
    along: float
    """Millimetres of a unit of offsets."""
    up: float
    """Millimetres of a unit of elevations."""
    steps: tuple[float, float]
    """Of the grid, along and up."""
    names: tuple[str, ...]
    """Of the surfaces."""
    left: float
    """Millimetres beside the grid, for labels."""
    rows: int = 0
    """Rows below the figures of the surfaces."""

    @property
    def width(self) -> float:
        """Of a cell, millimetres."""
        own = self.left + (self.reaches[1] - self.reaches[0]) * self.along + _RIGHT
        return max(own, _NARROWEST)

    @property
    def foot(self) -> float:
        """Of the figures below the grid, millimetres."""
        return ROW * (1 + len(self.names) + self.rows) + 1.0

    def find_ends(self, section: Section) -> tuple[float, float]:
        """Return the elevations at the foot and at the top of the grid."""
        step, (low, high) = self.steps[1], section.ends
        if math.isnan(low):
            return 0.0, 2.0 * step
        datum, top = math.floor(low / step), math.ceil(high / step)
        datum -= (low - datum * step) * self.up < _AIR
        top += (top * step - high) * self.up < _AIR
        return datum * step, top * step

    def measure_height(self, section: Section) -> float:
        """Return the height of a cell, millimetres."""
        datum, top = self.find_ends(section)
        return self.foot + (top - datum) * self.up + HEAD


def choose_measures(
    ends: tuple[float, float],
    names: tuple[str, ...],
    reaches: tuple[float, float],
    factors: tuple[float, float],
    scale: Scale,
) -> Measures:
    """Choose the grid for a scale, and for elevations between two ends.

    ``factors`` are millimetres of a unit along and up.

    Raises OptionError if elevations are too large to tell lines of the grid apart.
    """
    along, up = factors
    step, largest = _round_up(_STEP_UP / up), max(map(abs, ends))
    if not math.ulp(largest) <= _FINEST * step:
        allowed = f"smaller: elevations of {largest:.3g} are not known so finely"
        raise OptionError("scale", scale.text, allowed)
    figures = [write_height(one) for one in ends]
    grid = [_write(round(one / step) * step, step) for one in ends]
    widest = max(measure_text(one, _SIZE) for one in figures) + 2.0
    widest = max(widest, *(measure_text(f"{one:.0f}", _SIZE) + 2.0 for one in reaches), _STEP_ALONG)
    labels = max(measure_text(one, _SIZE) for one in grid) + 2.0
    heads = [min(measure_text(one, _SIZE), 22.0) for one in ("Offset", *names)]
    return Measures(
        reaches, along, up, (_round_up(widest / along), step), names, max(labels, *heads) + 3.0
    )


def _round_up(value: float) -> float:
    """Return the smallest of 1, 2, 5 times a power of ten that is at least ``value``."""
    power = 10.0 ** math.floor(math.log10(value))
    lead = next(one for one in (1.0, 2.0, 5.0, 10.0) if one * power >= value * (1 - 1e-9))
    return lead * power


def _write(value: float, step: float) -> str:
    return format_number(value + 0.0, step=step).replace(",", "")


def write_height(value: float) -> str:
    """Write an elevation with two decimals; a dash where there is none."""
    return f"{value:.2f}" if math.isfinite(value) else "\N{EN DASH}"


# ---------------------------------------------------------------- drawing


class Cell:
    """A section at its place on a sheet."""

    head = "Offset"
    """What figures along it are called."""

    def __init__(self, canvas: Drawable, measures: Measures, section: Section) -> None:
        self._canvas = canvas
        self._measures = measures
        self._section = section
        self._left = self._low = 0.0
        self._datum, self._top = measures.find_ends(section)

    def draw(self, place: tuple[float, float]) -> bool:
        """Draw all of it, its lower left corner at a place; tell whether its texts had room."""
        self._left = place[0] + self._measures.left
        self._low = place[1] + self._measures.foot
        self._draw_grid()
        self._draw_earthwork()
        self._draw_axis()
        self._draw_surfaces()
        has_room = self._write_figures()
        return self._write_head() and has_room

    def _to_paper(self, offsets: Float64Array, elevations: Float64Array) -> Float64Array:
        """Return places on paper, (n, 2)."""
        measures = self._measures
        return np.column_stack(
            [
                self._left + (offsets - measures.reaches[0]) * measures.along,
                self._low + (elevations - self._datum) * measures.up,
            ]
        )

    def _list_offsets(self) -> list[float]:
        (first, last), step = self._measures.reaches, self._measures.steps[0]
        numbers = range(math.ceil(first / step - 1e-9), math.floor(last / step + 1e-9) + 1)
        return [number * step for number in numbers]

    def _draw_grid(self) -> None:
        canvas, measures = self._canvas, self._measures
        first, last = measures.reaches
        step = measures.steps[1]
        numbers = np.arange(round(self._datum / step), round(self._top / step) + 1)
        levels = numbers * step
        offsets = np.array(self._list_offsets())
        ends = np.array([first, last])
        lines = [self._to_paper(ends, np.full(2, level)) for level in levels[1:-1]]
        heights = np.array([self._datum, self._top])
        lines += [self._to_paper(np.full(2, one), heights) for one in offsets]
        canvas.draw_paths(lines, GRID_PEN, "grid")
        ring = [(first, heights[1]), (first, heights[0]), (last, heights[0]), (last, heights[1])]
        corners = np.array([*ring, ring[0]])
        canvas.draw_paths([self._to_paper(*corners.T)], FRAME_PEN, "frame-of-section")
        canvas.draw_paths([self._to_paper(ends, np.full(2, self._datum))], DATUM_PEN, "datum")
        for level in levels.tolist():
            x, y = self._to_paper(ends[:1], np.array([level]))[0].tolist()
            canvas.write(
                (x - 1.0, y),
                _write(level, step),
                size=_SIZE,
                across="right",
                up="center_baseline",
                name="elevation-label",
            )

    def _draw_axis(self) -> None:
        first, last = self._measures.reaches
        if first < 0.0 < last:
            heights = np.array([self._datum, self._top])
            self._canvas.draw_paths([self._to_paper(np.zeros(2), heights)], AXIS_PEN, "centreline")

    def _draw_surfaces(self) -> None:
        for number, elevations in enumerate(self._section.elevations):
            parts = [
                self._to_paper(self._section.offsets[run], elevations[run])
                for run in _find_runs(np.isfinite(elevations))
            ]
            self._canvas.draw_paths(parts, find_pen(number), f"surface{number + 1}")

    def _draw_earthwork(self) -> None:
        if self._section.areas is None:
            return
        for kind, ring in find_rings(self._section):
            placed = self._to_paper(*ring.T)
            self._canvas.fill([placed], TINTS[kind], kind)
            self._canvas.hatch(placed, HATCH_PENS[kind], ANGLES[kind], f"{kind}-hatch")

    # ---------------------------------------------------------------- texts

    def _write_figures(self) -> bool:
        """Write offsets, and the elevations of each surface there, below the datum."""
        canvas, measures = self._canvas, self._measures
        offsets = self._list_offsets()
        rows = self._list_figures(offsets)
        at = self._to_paper(np.array(offsets), np.full(len(offsets), self._datum))[:, 0]
        have_room = True
        for row, (name, color, texts) in enumerate(rows):
            y = self._low - ROW * (row + 0.75)
            room = measures.left - 3.0
            fitted = fit_text(name, room, size=_SIZE, least=_LEAST_SIZE)
            canvas.write(
                (self._left - 5.0, y),
                fitted.lines[0],
                size=fitted.size,
                color=color,
                across="right",
                name="figure-name",
            )
            for x, text in zip(at.tolist(), texts, strict=True):
                canvas.write((x, y), text, size=_SIZE, color=color, across="center", name="figure")
            have_room &= not fitted.is_cut
        return have_room

    def _list_figures(self, offsets: Sequence[float]) -> list[tuple[str, str, list[str]]]:
        """Return the name, the colour and the texts of each row."""
        rows = [(self.head, INK, [self._write_offset(one) for one in offsets])]
        for number, name in enumerate(self._measures.names):
            texts = [write_height(one) for one in self._interpolate(number, offsets)]
            rows.append((name, find_pen(number).color, texts))
        return rows

    def _write_offset(self, offset: float) -> str:
        return _write(offset, self._measures.steps[0])

    def _interpolate(self, number: int, offsets: Sequence[float]) -> list[float]:
        """Return the elevations of a surface at offsets, straight between rows; NaN in gaps."""
        own = self._section.elevations[number]
        found = np.interp(offsets, self._section.offsets, own)
        for k, offset in enumerate(offsets):
            here = own[self._section.offsets == offset]  # beside a gap too
            known = here[np.isfinite(here)]
            found[k] = known[0] if len(known) else found[k]
        return [float(one) for one in found]

    def _write_head(self) -> bool:
        """Write station and areas above the grid."""
        top = self._low + (self._top - self._datum) * self._measures.up
        width = self._measures.width - self._measures.left
        head = fit_text(self._section.station, width, size=_STATION_SIZE, least=_LEAST_SIZE)
        self._canvas.write(
            (self._left, top + 5.6), head.lines[0], size=head.size, name="station-label"
        )
        text = self._describe_earthwork()
        if not text:
            return not head.is_cut
        fitted = fit_text(text, width, size=2.0, least=_LEAST_SIZE)
        self._canvas.write(
            (self._left, top + 2.0), fitted.lines[0], size=fitted.size, name="areas-label"
        )
        return not (head.is_cut or fitted.is_cut)

    def _describe_earthwork(self) -> str:
        """Return cut and fill as they are written, or which surface is not here."""
        section, names = self._section, self._measures.names
        if math.isnan(section.ends[0]):
            return "No surface here"
        if section.areas is None:
            return ""
        missing = [name for name, own in zip(names, section.elevations[:2], strict=False)
                   if not np.isfinite(own).any()]  # fmt: skip
        if missing:
            return f"No {missing[0]} here"
        return "Cut {}   Fill {}".format(*section.areas)


def find_pen(number: int) -> Pen:
    """Return the pen of a surface."""
    return Pen(palette.CURVES[number % len(palette.CURVES)], 0.35 if number else 0.5)


def _find_runs(is_known: BoolArray) -> list[slice]:
    """Return where rows with an elevation follow each other, two of them at least."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], is_known.astype(np.int8), [0]])))
    return [
        slice(begin, end)
        for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
        if end - begin > 1
    ]


def find_rings(section: Section) -> list[tuple[str, Float64Array]]:
    """Return what is cut and filled from the first surface to the second, ring by ring.

    Each ring is (n, 2), offsets and elevations, and ends where it begins.
    """
    first, second = section.elevations[:2]
    found: list[tuple[str, Float64Array]] = []
    for run in _find_runs(np.isfinite(first) & np.isfinite(second)):
        places = _add_crossings(section.offsets[run], first[run], second[run])
        rise = places[:, 2] - places[:, 1]
        signs = np.sign(rise[:-1] + rise[1:])
        starts = np.flatnonzero(np.append(True, np.diff(signs) != 0))
        for begin, end in zip(starts, np.append(starts[1:], len(signs)), strict=True):
            part = places[begin : end + 1]
            if signs[begin] == 0.0 or part[0, 0] == part[-1, 0]:
                continue
            ring = np.concatenate([part[:, [0, 1]], part[::-1, [0, 2]], part[:1, [0, 1]]])
            found.append((KINDS[int(signs[begin] > 0.0)], ring))
    return found


def _add_crossings(
    offsets: Float64Array, first: Float64Array, second: Float64Array
) -> Float64Array:
    """Return offsets and both elevations, (n, 3), with rows where the surfaces cross."""
    rows = np.column_stack([offsets, first, second])
    rise = second - first
    before = np.flatnonzero(np.sign(rise[:-1]) * np.sign(rise[1:]) < 0)
    share = (rise[before] / (rise[before] - rise[before + 1]))[:, None]
    met = rows[before] + share * np.diff(rows, axis=0)[before]
    met[:, 2] = met[:, 1]
    return np.insert(rows, before + 1, met, axis=0)
