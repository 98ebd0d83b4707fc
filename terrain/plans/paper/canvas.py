"""Canvas: a sheet of paper on which lines, areas and texts are drawn in millimetres."""

from __future__ import annotations

import warnings
from collections import Counter
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypedDict

import numpy as np

from ....base import optional
from ...drawing import palette
from .lettering import FONT, PURPOSE
from .papers import MM_PER_INCH

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from typing import IO, Unpack

    from ....base.arrays import AnyArray, Float64Array
    from ....tin import Bounds
    from .papers import Paper

INK = palette.INK_PLAN
GREY = palette.GREY_PLAN
"""Of words that matter less."""
POINTS_PER_MM = 72.0 / MM_PER_INCH

_RULES = {
    "font.family": [FONT],
    "pdf.fonttype": 42,  # letters stay text, in a font that is embedded
    "svg.fonttype": "none",
    "svg.hashsalt": "tinsmith",  # the same bytes every time
    "path.simplify": False,
    "lines.scale_dashes": False,
    "agg.path.chunksize": 20_000,
}
METADATA: dict[str, dict[str, None]] = {
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    "svg": {"Date": None, "Creator": None},
    "png": {"Software": None},
}


HATCH_SPACING = 2.0
"""Millimetres between lines of a hatch."""


class Pen(NamedTuple):
    """How a line is drawn: its colour, and its width and dashes in millimetres."""

    color: str
    width: float
    dashes: tuple[float, ...] = ()


@contextmanager
def drawing_rules() -> Iterator[None]:
    """Draw by matplotlib's own defaults and ours, whatever the user has set for other pictures.

    Letters that the font lacks are drawn as boxes, which the notes of a plan tell.
    """
    matplotlib = optional.load("matplotlib", PURPOSE)
    with matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_RULES)
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield


class TextStyle(TypedDict, total=False):
    """How a text is drawn; each has a usual value, that of ``PLAIN``."""

    color: str
    rotation: float
    """Degrees counter-clockwise."""
    across: str
    """Which end of it is at its place: "left", "center", "right"."""
    up: str
    """Which height of it is: "baseline", "center_baseline", "top"."""
    name: str
    """What it is: its layer in a drawing, its identifier in an SVG."""


PLAIN: TextStyle = {
    "color": INK,
    "rotation": 0.0,
    "across": "left",
    "up": "baseline",
    "name": "",
}


class Drawable(Protocol):
    """What a sheet is drawn on, in millimetres from its lower left corner."""

    def draw_paths(
        self,
        parts: Sequence[Float64Array],
        pen: Pen,
        name: str,
        heights: Sequence[float] | None = None,
    ) -> None:
        """Draw polylines; ``name`` is what they are.

        ``heights`` are those of each in a drawing that has heights, in its unit.
        """

    def fill(self, rings: Sequence[Float64Array], color: str, name: str) -> None:
        """Fill the area within rings, each closed; what lies in two of them is left out."""

    def hatch(self, ring: Float64Array, pen: Pen, angle: float, name: str) -> None:
        """Draw parallel lines within a ring, 2 mm apart, at an angle in degrees."""

    def write(
        self, place: tuple[float, float], text: str, *, size: float, **how: Unpack[TextStyle]
    ) -> None:
        """Write a text on one line; ``size`` is that of its letters in millimetres."""

    def draw_picture(self, box: Bounds, picture: AnyArray) -> bool:
        """Draw a picture in a box, (rows, columns, 4); tell whether pictures can be drawn."""


class Canvas:
    """A sheet of paper; the origin is its lower left corner. Used within :func:`drawing_rules`."""

    def __init__(self, paper: Paper) -> None:
        size = paper.width / MM_PER_INCH, paper.height / MM_PER_INCH
        figure = optional.load("matplotlib.figure", PURPOSE).Figure(figsize=size)
        self.figure: Any = figure
        self._axes: Any = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self._axes.set_xlim(0.0, paper.width)
        self._axes.set_ylim(0.0, paper.height)
        self._axes.set_axis_off()
        self._order = 1
        self._names: Counter[str] = Counter()

    def draw_paths(
        self,
        parts: Sequence[Float64Array],
        pen: Pen,
        name: str,
        heights: Sequence[float] | None = None,  # noqa: ARG002 - paper is flat
    ) -> None:
        """Draw polylines; ``name`` is that of their group in an SVG."""
        if len(parts) == 0:
            return
        collections = optional.load("matplotlib.collections", PURPOSE)
        style: Any = "solid"
        if pen.dashes:
            style = (0.0, [POINTS_PER_MM * dash for dash in pen.dashes])
        drawn = collections.LineCollection(
            list(parts),
            colors=pen.color,
            linewidths=POINTS_PER_MM * pen.width,
            linestyles=[style],
            capstyle="butt" if pen.dashes else "round",
            zorder=self._take_order(),
        )
        drawn.set_gid(self._choose_name(name))
        self._axes.add_collection(drawn, autolim=False)

    def fill(self, rings: Sequence[Float64Array], color: str, name: str) -> None:
        """Fill the area within rings, each closed; what lies in two of them is left out."""
        path = optional.load("matplotlib.path", PURPOSE).Path
        patch = optional.load("matplotlib.patches", PURPOSE).PathPatch
        codes = [
            np.array([path.MOVETO, *[path.LINETO] * (len(ring) - 2), path.CLOSEPOLY])
            for ring in rings
        ]
        shape = path(np.concatenate(list(rings)), np.concatenate(codes))
        drawn = patch(shape, facecolor=color, edgecolor="none", zorder=self._take_order())
        drawn.set_gid(self._choose_name(name))
        self._axes.add_patch(drawn)

    def hatch(self, ring: Float64Array, pen: Pen, angle: float, name: str) -> None:
        """Draw parallel lines within a ring, at an angle in degrees."""
        self.draw_paths(hatch_ring(ring, angle), pen, name)

    def write(
        self, place: tuple[float, float], text: str, *, size: float, **how: Unpack[TextStyle]
    ) -> None:
        """Write a text on one line; ``size`` is that of its letters in millimetres."""
        style = PLAIN | how
        self._axes.text(
            *place,
            text,
            fontsize=POINTS_PER_MM * size,
            color=style["color"],
            rotation=style["rotation"],
            rotation_mode="anchor",
            ha=style["across"],
            va=style["up"],
            parse_math=False,
            gid=self._choose_name(style["name"]) if style["name"] else None,
            zorder=self._take_order(),
        )

    def draw_picture(self, box: Bounds, picture: AnyArray) -> bool:
        """Draw a picture in a box, (rows, columns, 4)."""
        shown = optional.load("matplotlib.image", PURPOSE).AxesImage(
            self._axes,
            extent=(box.xmin, box.xmax, box.ymin, box.ymax),
            interpolation="none",
            zorder=self._take_order(),
        )
        shown.set_data(picture)
        shown.set_gid(self._choose_name("picture"))
        self._axes.add_artist(shown)
        return True

    def save(self, stream: IO[bytes], kind: str, *, dpi: int) -> None:
        """Write the sheet as PDF, SVG or PNG, with no clock and no version in its bytes."""
        self.figure.savefig(stream, format=kind, dpi=dpi, metadata=METADATA[kind])

    def _choose_name(self, name: str) -> str:
        """Return a name that nothing has on the sheet: an SVG has each once."""
        self._names[name] += 1
        count = self._names[name]
        return name if count == 1 else f"{name}-{count}"

    def _take_order(self) -> float:
        """Return the next place in the order of drawing: later things lie on top."""
        self._order += 1
        return float(self._order)


def hatch_ring(ring: Float64Array, angle: float) -> list[Float64Array]:
    """Return the parts of parallel lines within a ring."""
    shapely = optional.load("shapely")
    area = shapely.make_valid(shapely.Polygon(ring))
    across = np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))])
    along = np.array([across[1], -across[0]])
    far, side = ring @ along, ring @ across
    numbers = np.arange(
        np.ceil(side.min() / HATCH_SPACING), np.floor(side.max() / HATCH_SPACING) + 1
    )
    middles = numbers[:, None] * HATCH_SPACING * across
    lines = np.stack([middles + far.min() * along, middles + far.max() * along], axis=1)
    found = shapely.get_parts(shapely.intersection(shapely.linestrings(lines), area))
    is_line = shapely.get_type_id(found) == shapely.GeometryType.LINESTRING
    return [shapely.get_coordinates(one) for one in found[is_line & (shapely.length(found) > 0)]]
