"""Cells of long profiles: figures of stations, differences, and a gradient line below."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..paper import INK, fit_text
from .cells import FRAME_PEN, ROW, Cell, write_height

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ...sections import VerticalAlignment
    from ..paper import Drawable
    from .cells import Measures, Section

_SIZE, _LEAST = 1.8, 1.0
_WHOLE = 1e9
"""A tolerance with which no vertical curve is cut."""


class Gradient(NamedTuple):
    """A tangent of a gradient line, or a vertical curve."""

    begin: float
    end: float
    """Stations."""
    text: str


def list_gradients(
    vertical: VerticalAlignment, write: Callable[[float], str], ratio: float
) -> tuple[Gradient, ...]:
    """Return tangents with their grades and lengths, and curves with the points they round off.

    ``write`` returns what is written at a station; ``ratio`` is how many units of stations make one
    of elevations.
    """
    cuts = vertical.cut_into_chords(_WHOLE)
    curves: dict[float, tuple[float, str]] = {}
    for point, length in zip(vertical.points, vertical.curve_lengths, strict=True):
        begin, end = point.station - point.length_in, point.station + point.length_out
        arc = ""
        if point.kind == "arc":
            begin, end = cuts[cuts < point.station].max(), cuts[cuts > point.station].min()
            arc = f", R {point.radius:.12g}"
        if point.kind is not None:
            at = f"PVI {write(point.station)}, {write_height(point.elevation)}"
            curves[float(begin)] = float(end), f"{at}; L {length:.2f}{arc}"
            cuts = cuts[(cuts <= begin) | (cuts >= end)]
    return tuple(
        Gradient(begin, *curves[begin])
        if begin in curves
        else Gradient(begin, end, _describe_tangent(vertical, begin, end, ratio))
        for begin, end in pairwise(cuts.tolist())
    )


def _describe_tangent(vertical: VerticalAlignment, begin: float, end: float, ratio: float) -> str:
    grade = ratio * float(vertical.grades_at([(begin + end) / 2])[0])
    return f"{100.0 * grade + 0.0:+.3f} %, {end - begin:.2f}"


class ProfileCell(Cell):
    """A part of a long profile at its place on a sheet."""

    head = "Station"

    def __init__(
        self,
        canvas: Drawable,
        measures: Measures,
        section: Section,
        gradients: Sequence[Gradient],
        write: Callable[[float], str],
    ) -> None:
        super().__init__(canvas, measures, section)
        self._gradients = gradients
        self._write_station = write

    def _draw_axis(self) -> None:
        """Draw none: offset 0 is the first station here."""

    def _write_offset(self, offset: float) -> str:
        return self._write_station(offset)

    def _list_figures(self, offsets: Sequence[float]) -> list[tuple[str, str, list[str]]]:
        """Add the differences of the second surface to the first."""
        rows = super()._list_figures(offsets)
        if len(self._measures.names) > 1:
            first, second = (np.array(self._interpolate(k, offsets)) for k in (0, 1))
            texts = [f"{one:+.2f}" if np.isfinite(one) else write_height(one)
                     for one in (second - first).tolist()]  # fmt: skip
            rows.append(("difference", INK, texts))
        return rows

    def _write_figures(self) -> bool:
        """Write the figures, and below them the gradient line, tangent by tangent."""
        have_room = super()._write_figures()
        if not self._gradients:
            return have_room
        begin, end = self._measures.reaches
        top = self._low - self._measures.foot + 1.0 + 1.5 * ROW
        self._canvas.write((self._left - 5.0, top - 0.95 * ROW), "gradient", size=_SIZE,
                           across="right", name="figure-name")  # fmt: skip
        for one in self._gradients:
            ends = np.clip([one.begin, one.end], begin, end)
            if ends[0] >= ends[1]:
                continue
            x = self._to_paper(ends, np.full(2, self._datum))[:, 0]
            box = np.array([(x[0], top - 1.5 * ROW), (x[1], top - 1.5 * ROW), (x[1], top),
                            (x[0], top), (x[0], top - 1.5 * ROW)])  # fmt: skip
            self._canvas.draw_paths([box], FRAME_PEN, "gradient")
            fitted = fit_text(one.text, float(x[1] - x[0]) - 1.0, size=_SIZE, least=_LEAST)
            have_room &= not fitted.is_cut
            if not fitted.is_cut:
                place = (float(x.mean()), top - 0.95 * ROW)
                self._canvas.write(place, fitted.lines[0], size=fitted.size, across="center",
                                   name="gradient-label")  # fmt: skip
        return have_room
