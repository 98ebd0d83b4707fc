"""Overlay: flat shapes and words over a 3D picture, in pixels from the lower left."""

from __future__ import annotations

from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..drawing import fit_text

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...base.arrays import UInt8Array
    from ..drawing import Color

_LAST_LATIN = "\N{LATIN SMALL LETTER LONG S}"
"""Last character that VTK's own font is sure to have."""

_FONT_FROM_FILE = 4
"""VTK_FONT_FILE, which VTK's Python face does not name."""

_LAP = 0.5
"""Design pixels by which a part of a scale goes on below the next: no gap shows in between."""

_RESOLUTION = 72
"""Dots per inch at which VTK's font sizes are pixels."""

_LAYOUTS = (
    ((30.0, 27.0, 24.0), (62.0,), 92.0),
    ((24.0, 21.0), (41.0, 69.0), 96.0),
    ((18.0, 16.0, 14.0), (33.0, 54.0, 75.0), 98.0),
)
"""Sizes of letters, and how far below the upper edge the lines and the next line stand, for one,
two and three lines, design pixels."""


class Overlay:
    """Draws over one renderer of pyvista; lengths are in design pixels, times ``factor``.

    The factor is window pixels for one design pixel; it may be set anew before drawing.
    """

    def __init__(self, renderer: Any, *, factor: float = 1.0) -> None:
        self._renderer = renderer
        self.factor = factor
        self._actors: list[Any] = []

    def clear(self) -> None:
        """Remove all that was drawn."""
        for actor in self._actors:
            self._renderer.RemoveViewProp(actor)
        self._actors.clear()

    def draw_polygon(self, corners: ArrayLike, color: Color) -> None:
        """Fill a polygon, (k, 2) corners."""
        mesh = self._make_mesh(corners)
        mesh.faces = [mesh.n_points, *range(mesh.n_points)]
        self._add(mesh, color)

    def draw_line(self, places: ArrayLike, color: Color, *, width: float = 1.0) -> None:
        """Draw a polyline through (k, 2) places."""
        mesh = self._make_mesh(places)
        mesh.lines = [mesh.n_points, *range(mesh.n_points)]
        self._add(mesh, color, width=width)

    def draw_rectangle(
        self, corner: tuple[float, float], size: tuple[float, float], color: Color
    ) -> None:
        """Fill a rectangle, given its lower left corner."""
        (x, y), (w, h) = corner, size
        self.draw_polygon([(x, y), (x + w, y), (x + w, y + h), (x, y + h)], color)

    def draw_scale(
        self, corner: tuple[float, float], size: tuple[float, float], colors: UInt8Array
    ) -> None:
        """Fill a rectangle, given its lower left corner, with equal parts of (k, 3) colors."""
        step = size[0] / len(colors)
        left = corner[0] + step * np.arange(len(colors))
        x = np.stack([left, left + step + _LAP, left + step + _LAP, left], axis=1)
        y = np.tile(corner[1] + np.array([0.0, 0.0, size[1], size[1]]), len(colors))
        mesh = self._make_mesh(np.column_stack([x.ravel(), y]))
        corners = np.arange(4 * len(colors)).reshape(-1, 4)
        mesh.faces = np.insert(corners, 0, 4, axis=1).ravel()
        mesh.cell_data.set_scalars(np.ascontiguousarray(colors, np.uint8))
        self._add(mesh, (0, 0, 0))

    def draw_text(
        self,
        place: tuple[float, float],
        words: str,
        color: Color,
        *,
        size: float,
        bold: bool = False,
        align: str = "left",
    ) -> None:
        """Write one line, its baseline at ``place``; ``align`` is left, center or right."""
        from vtkmodules.vtkRenderingCore import vtkTextActor

        actor = vtkTextActor()
        actor.SetInput(words)
        style = actor.GetTextProperty()
        self._set_font(style, words, size=size, bold=bold)
        style.SetColor(*(part / 255 for part in color))
        style.SetJustification(("left", "center", "right").index(align))
        actor.SetPosition(place[0] * self.factor, place[1] * self.factor)
        self._keep(actor)

    def measure_text(self, words: str, *, size: float, bold: bool = False) -> float:
        """Return how wide a line would be, design pixels."""
        from vtkmodules.vtkRenderingCore import vtkTextProperty
        from vtkmodules.vtkRenderingFreeType import vtkMathTextFreeTypeTextRenderer

        style, box = vtkTextProperty(), [0, 0, 0, 0]
        self._set_font(style, words, size=size, bold=bold)
        vtkMathTextFreeTypeTextRenderer.GetInstance().GetBoundingBox(style, words, box, _RESOLUTION)
        return (box[1] - box[0] + 1) / self.factor

    def _set_font(self, style: Any, words: str, *, size: float, bold: bool) -> None:
        wide = _find_wide_font(bold=bold) if max(words, default="") > _LAST_LATIN else None
        if wide is None:
            style.SetFontFamilyToArial()
        else:
            style.SetFontFamily(_FONT_FROM_FILE)
            style.SetFontFile(str(wide))
        style.SetFontSize(max(1, round(size * self.factor)))
        style.SetBold(bold)

    def _make_mesh(self, places: ArrayLike) -> Any:
        import pyvista as pv

        flat = np.asarray(places, np.float64) * self.factor
        mesh = pv.PolyData(np.column_stack([flat, np.zeros(len(flat))]))
        # A mesh made from points comes with a vertex cell for each, drawn as dots.
        mesh.verts = np.empty(0, np.int64)
        return mesh

    def _add(self, mesh: Any, color: Color, *, width: float = 1.0) -> None:
        from vtkmodules.vtkRenderingCore import vtkActor2D, vtkPolyDataMapper2D

        mapper = vtkPolyDataMapper2D()
        mapper.SetInputData(mesh)
        actor = vtkActor2D()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*(part / 255 for part in color))
        actor.GetProperty().SetLineWidth(width * self.factor)
        self._keep(actor)

    def _keep(self, actor: Any) -> None:
        self._actors.append(actor)
        self._renderer.AddViewProp(actor)


@cache
def _find_wide_font(*, bold: bool) -> Path | None:
    """Find DejaVu Sans, which has more alphabets: matplotlib ships it, and pyvista needs that."""
    spec = find_spec("matplotlib")
    if spec is None or spec.origin is None:
        return None
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    font = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf" / name
    return font if font.is_file() else None


class Title(NamedTuple):
    """A title as it is written."""

    lines: tuple[str, ...]
    size: float
    """Of the letters, design pixels."""
    drops: tuple[float, ...]
    """How far below the upper edge each line stands."""
    next_drop: float
    """How far the line below the title stands."""


def fit_title(overlay: Overlay, words: str, room: float) -> Title:
    """Write a title in one line, or in up to three of smaller letters.

    The overlay measures words; ``room`` is the width for it, design pixels. A title that is too
    long for three lines is cut, which three dots at its end show.
    """
    measure = partial(overlay.measure_text, bold=True)
    for sizes, drops, next_drop in _LAYOUTS:
        fitted = fit_text(words, room, sizes, measure, lines=len(drops))
        title = Title(fitted.lines, fitted.size, drops[: len(fitted.lines)], next_drop)
        if not fitted.is_cut:
            break
    return title


def shorten(overlay: Overlay, words: str, room: float, *, size: float) -> str:
    """Cut words that are too long for the room, and show that they are cut."""
    return fit_text(words, room, [size], overlay.measure_text).lines[0]
