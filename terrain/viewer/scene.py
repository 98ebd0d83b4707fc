"""Scene: terrain, light, camera and annotations in place, in a window or off screen."""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.georeference import find_ground
from ...base.sentences import counted
from ...tin import Bounds
from ..drawing import (
    add_lines,
    add_polylines,
    choose_origin,
    format_number,
    make_legend,
    palette,
)
from ..isolines import contours
from .actors import BLOCK_SHARE, add_lights, add_ortho, add_terrain, fade_edges, place_vertices
from .annotations import Layout, TitleBlock, annotate
from .camera import aim, measure_pixels_per_unit, place_camera, project_ground_axes
from .corridor import cut_into_strips, find_corridor, measure_mean_width
from .overlay import Overlay
from .relief import choose_exaggeration, measure_extent, measure_relief, round_exaggeration

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from ...base.arrays import Float64Array
    from ...base.georeference import Ground
    from ...tin import TIN
    from .camera import View
    from .corridor import Strips
    from .options import PreviewOptions
    from .ortho import Ortho
    from .relief import ElevationRange

_PURPOSE = "A preview"

_DESIGN_SIZE = (1600.0, 1000.0)
"""Picture size for which the annotations are laid out, pixels."""

_RELIEF_OF_STRIP = 0.5
"""Share of a corridor's width that the relief within a strip takes, at least."""

_CONTOUR_WIDTH = 0.9

_LEAST_WIDTH = 2.0
"""Depths of the block that the ground is wide, at least, to stand on a block: else it would hide
behind its own wall."""


@dataclass(frozen=True, eq=False)
class Scene:
    """What is to be drawn, and how."""

    tin: TIN
    ground: Ground
    options: PreviewOptions
    view: View
    shown: ElevationRange
    """Elevations that must be in the picture."""
    exaggeration: float
    """Factor on heights."""
    has_block: bool
    strips: Strips | None
    """Pieces of a corridor."""
    ortho: Ortho | None = None
    """Picture draped over the surface."""

    @property
    def points(self) -> Float64Array:
        """The vertices as drawn."""
        return place_vertices(self.tin, self.ground, self.exaggeration)

    @property
    def elevations(self) -> tuple[float, float]:
        """Of the lowest and the highest tint."""
        return self.options.elevations or (self.shown.low, self.shown.high)

    @cached_property
    def title_block(self) -> TitleBlock:
        """What is written around it."""
        options, ground = self.options, self.ground
        is_covered = self.ortho is not None and self.ortho.gap == 0.0
        legend = make_legend(options.tint, self.elevations, ground.elevation_caption)
        return TitleBlock(
            title=options.title,
            subtitle="  \N{MIDDLE DOT}  ".join(_describe(self)),
            exaggeration=self.exaggeration,
            legend=None if is_covered else legend,
            unit=ground.unit,
            sun=options.sun,
            warning=_warn(self),
            palette=options.palette,
        )


def make_scene(
    tin: TIN, options: PreviewOptions, ortho: Ortho | None = None, *, has_strips: bool = True
) -> Scene:
    """Choose all that the caller left open.

    With ``has_strips`` a corridor is cut into strips, if nobody chose where to look from.
    """
    optional.load("pyvista", _PURPOSE)
    ground = find_ground(tin)
    shown = measure_relief(tin, ground)
    view = options.seen_from
    corridor = find_corridor(tin, ground) if options.azimuth is None else None
    factor = options.exaggeration or choose_exaggeration(tin, ground, shown)
    strips = None
    if corridor is not None:
        view = replace(view, azimuth=corridor.find_side(view.azimuth))
        if has_strips:
            factor, strips = _cut(tin, ground, options, view)
    depth = BLOCK_SHARE * measure_extent(tin, ground)
    has_block = strips is None and measure_mean_width(tin, ground) >= _LEAST_WIDTH * depth
    return Scene(tin, ground, options, view, shown, factor, has_block, strips, ortho)


def _cut(
    tin: TIN, ground: Ground, options: PreviewOptions, view: View
) -> tuple[float, Strips | None]:
    """Return the exaggeration and the strips of a corridor; None where one alone is enough."""
    frame = fit_layout(options.size)[0].frame
    edges = tin.edges

    def cut(factor: float) -> Strips:
        return cut_into_strips(place_vertices(tin, ground, factor), edges, view, frame)

    factor = options.exaggeration
    if factor is None:
        relief = _measure_relief_in(cut(1.0), tin, ground, view)
        factor = round_exaggeration(_RELIEF_OF_STRIP * measure_mean_width(tin, ground), relief)
    strips = cut(factor)
    return factor, strips if len(strips.lows) > 1 else None


def _measure_relief_in(strips: Strips, tin: TIN, ground: Ground, view: View) -> float:
    """Return the median of the relief within each strip that has ground."""
    points = place_vertices(tin, ground, 1.0)
    strip = np.searchsorted(strips.edges[1:-1], points @ view.axes[0], side="right")
    lows, highs = np.full(len(strips.lows), np.inf), np.full(len(strips.lows), -np.inf)
    np.minimum.at(lows, strip, points[:, 2])
    np.maximum.at(highs, strip, points[:, 2])
    return float(np.median((highs - lows)[highs >= lows]))


class ScenePlotter:
    """A plotter with terrain, light, camera and annotations in place.

    The window is so many pixels wide and high. ``surfaces`` are the actors of the surface, and of
    what is draped over it; ``overlay`` has the annotations. ``after_update`` is called when they
    were drawn anew, which then cover what was drawn before.
    """

    def __init__(self, scene: Scene, window: tuple[int, int], *, off_screen: bool) -> None:
        self.scene = scene
        self.plotter = open_plotter(scene, window, off_screen=off_screen)
        self.overlay = Overlay(self.plotter.renderer)
        self._drawn_for: tuple[object, ...] = ()
        self.surfaces: list[Any] = []
        self._terrain: list[str] = []
        self.after_update: Callable[[], None] | None = None
        if scene.strips is None:
            self._aim(self._build(window), window)
        else:
            height = fit_layout(window)[0].height / scene.strips.scale
            place_camera(
                self.plotter.camera, scene.points, view=scene.view, middle=(0.0, 0.0), height=height
            )
        self.update()

    def _aim(self, seen: Float64Array, window: tuple[int, int]) -> None:
        layout, factor = fit_layout(window)
        frame = Bounds(*(factor * side for side in astuple(layout.frame)))
        aim(self.plotter.camera, seen, view=self.scene.view, frame=frame, size=window)
        self.plotter.renderer.ResetCameraClippingRange()

    def _build(self, window: tuple[int, int]) -> Float64Array:
        """Add the terrain, and return what must be seen."""
        before = set(self.plotter.renderer.actors)
        self.surfaces, seen = add_scene(self.plotter, self.scene, fit_layout(window)[1])
        self._terrain = [name for name in self.plotter.renderer.actors if name not in before]
        return seen

    def rebuild(self, scene: Scene) -> None:
        """Draw another scene of the same surface, seen from where the camera stands."""
        self.scene = scene
        for name in self._terrain:
            self.plotter.remove_actor(name, render=False, reset_camera=False)
        self._build(tuple(self.plotter.window_size))
        self._drawn_for = ()
        self.update()
        self.plotter.renderer.ResetCameraClippingRange()

    def update(self, *_: object) -> None:
        """Make the annotations true for the present camera and window, if these have changed."""
        camera, (width, height) = self.plotter.camera, self.plotter.window_size
        state = (width, height, camera.parallel_scale, project_ground_axes(camera).tobytes())
        if state == self._drawn_for:
            return
        self._drawn_for = state
        layout, self.overlay.factor = fit_layout((width, height))
        pixels = measure_pixels_per_unit(camera, layout.height)
        for surface in self.surfaces:
            fade_edges(surface, self.scene.tin, self.scene.ground, pixels)
        annotate(self.overlay, layout, self.scene.title_block, camera)
        if self.after_update is not None:
            self.after_update()


def open_plotter(scene: Scene, window: tuple[int, int], *, off_screen: bool) -> Any:
    """Return a plotter with background and light, and nothing in it."""
    pv = optional.load("pyvista", _PURPOSE)
    plotter = pv.Plotter(off_screen=off_screen, window_size=list(window), lighting="none")
    plotter.set_background([part / 255 for part in scene.title_block.palette.paper])
    add_lights(plotter, scene.options.sun)
    return plotter


def add_scene(plotter: Any, scene: Scene, factor: float) -> tuple[list[Any], Float64Array]:
    """Add terrain and lines to a plotter; return actors with edges, and what must be seen.

    ``factor`` is window pixels for one design pixel.
    """
    points = scene.points
    surface, seen = add_terrain(
        plotter,
        scene.tin,
        points,
        edges=scene.options.edges,
        elevations=scene.elevations,
        tint=scene.options.tint,
        is_far_off=scene.shown.is_far_off,
        has_block=scene.has_block,
    )
    surfaces = [surface]
    if scene.ortho is not None:
        surfaces.append(add_ortho(plotter, scene.tin, points, scene.ortho, surface))
    if scene.options.lines:
        add_lines(plotter, scene.tin, points, factor=factor)
    if scene.options.contours is not None:
        _add_contours(plotter, scene, scene.options.contours, factor)
    return surfaces, seen


def _add_contours(plotter: Any, scene: Scene, interval: float, factor: float) -> None:
    """Draw contour lines, index contours heavier."""
    found = contours(scene.tin, interval)
    places = place_in_scene(scene, found.coordinates)
    for is_index, width in ((False, _CONTOUR_WIDTH), (True, 2 * _CONTOUR_WIDTH)):
        chosen = np.flatnonzero(found.columns["is_index"] == is_index)
        if len(chosen):
            lines = places, found.offsets[0], chosen
            add_polylines(plotter, *lines, color=palette.CONTOURS_3D, width=width * factor)


def place_in_scene(scene: Scene, points: Float64Array) -> Float64Array:
    """Return where points, (k, 3) in the units of the TIN, are drawn."""
    placed: Float64Array = (points - choose_origin(scene.tin)) * scene.ground.scale
    return placed * (1.0, 1.0, scene.exaggeration)


def fit_layout(window: tuple[int, int]) -> tuple[Layout, float]:
    """Return the layout that fills a window, and the window pixels for one design pixel."""
    factor = min(full / design for full, design in zip(window, _DESIGN_SIZE, strict=True))
    return Layout(window[0] / factor, window[1] / factor), factor


# ----------------------------------------------------------------------- words


def _describe(scene: Scene) -> Iterator[str]:
    """Yield the parts of the subtitle."""
    tin, ground, strips = scene.tin, scene.ground, scene.strips
    yield f"{len(tin.points):,} points, {counted(len(tin.triangles), 'triangle')}"
    yield ground.crs_name
    if strips is not None:
        length = format_number(strips.length, step=1.0 if strips.length >= 100 else 0.01)
        unit = f" {ground.unit.symbol}" if ground.unit.symbol else ""
        strip = counted(len(strips.lows), "strip")
        yield f"{strip} of {length}{unit}, to read from left to right, then down"


def _warn(scene: Scene) -> str:
    """Return what the tints leave out: elevations far off, or outside of what is asked for."""
    if scene.options.elevations is None:
        return describe_far_off(scene.tin, scene.shown)
    elevations = scene.tin.points[:, 2]
    low, high = scene.options.elevations
    count = int(((elevations < low) | (elevations > high)).sum())
    return f"{counted(count, 'elevation')} out of this range" if count else ""


def describe_far_off(tin: TIN, shown: ElevationRange) -> str:
    """Return how many elevations are far off all others, and the farthest; "" if none."""
    far = tin.points[shown.is_far_off, 2]
    if len(far) == 0:
        return ""
    worst = far[np.abs(far - (shown.low + shown.high) / 2).argmax()]
    number = f"{worst:,.12g}"
    such = ":" if len(far) == 1 else ", such as"
    return f"{counted(len(far), 'elevation')} far off all others{such} {number}"
