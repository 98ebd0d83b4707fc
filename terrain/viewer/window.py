"""A window in which a surface is turned, exaggerated, coloured, read and cut."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, get_args

import numpy as np

from ...base import optional
from ...base.errors import TinsmithError
from ...base.georeference import label_axes
from ...base.policies import Tint
from ..drawing import add_polylines, choose_origin, palette, round_down
from ..sections import profile
from ..surface import compute_normals, measure_slopes
from . import opengl
from .overlay import Overlay
from .picture import keep_vtk_plain
from .scene import ScenePlotter, fit_layout, make_scene, place_in_scene

if TYPE_CHECKING:
    from ...base.results import Table
    from ...tin import TIN
    from .options import PreviewOptions
    from .ortho import Ortho

_PURPOSE = "A preview"

_TINTS = get_args(Tint)
_LEVELS = 12
"""Contour levels, about, when the window chooses their interval."""

_MOST_EXAGGERATION = 20.0
_MARK_SIZE = 12.0
_SECTION_WIDTH = 3.0
_CHART_PLACE, _CHART_SIZE = (0.52, 0.16), (0.46, 0.3)
_HELP = (
    "drag to turn, Shift to move, wheel to zoom, T tint, C contours, P read under the pointer, "
    "X section between the last two places, Q close"
)


@dataclass(frozen=True, slots=True)
class Reading:
    """What the surface is at a place, in the units of the TIN."""

    easting: float
    northing: float
    elevation: float
    """As :meth:`tinsmith.TIN.interpolate` gives it."""
    slope: float
    """Of the triangle there, degrees."""


class Window:
    """A surface in a window that follows mouse and keys, or off screen, where nobody sees it."""

    def __init__(
        self,
        tin: TIN,
        options: PreviewOptions,
        ortho: Ortho | None = None,
        *,
        off_screen: bool = False,
    ) -> None:
        scene = make_scene(tin, options, ortho, has_strips=False)
        self.drawn = ScenePlotter(scene, options.size, off_screen=off_screen)
        self.readings: list[Reading] = []
        self._slopes = measure_slopes(compute_normals(tin), "degrees")
        self._words = Overlay(self.drawn.plotter.renderer)
        self._marks: list[Any] = []
        self._section: Table | None = None
        self._chart: Any = None
        self._line = ""
        self._slider: Any = None
        self.drawn.after_update = self._raise_words
        self._raise_words()

    @property
    def scene(self) -> Any:
        """What is drawn now."""
        return self.drawn.scene

    # ------------------------------------------------------------------ drawing

    def set_exaggeration(self, factor: float) -> None:
        """Draw heights with another factor."""
        self._rebuild(replace(self.scene, exaggeration=factor))

    def set_tint(self, tint: Tint) -> None:
        """Colour by elevation, slope or aspect, or not at all."""
        self._rebuild(replace(self.scene, options=replace(self.scene.options, tint=tint)))

    def set_contours(self, interval: float | None) -> None:
        """Draw contours at an interval, in the unit of elevations; None for none."""
        self._rebuild(replace(self.scene, options=replace(self.scene.options, contours=interval)))

    def change_tint(self) -> None:
        """Colour by what comes next."""
        self.set_tint(_TINTS[(_TINTS.index(self.scene.options.tint) + 1) % len(_TINTS)])

    def toggle_contours(self) -> None:
        """Draw contours at a round interval, or none."""
        shown = self.scene.shown
        relief = shown.high - shown.low
        is_off = self.scene.options.contours is None and relief > 0
        self.set_contours(round_down(relief / _LEVELS * 1.3) if is_off else None)

    def _rebuild(self, scene: Any) -> None:
        self.drawn.rebuild(scene)
        self._mark()

    # ------------------------------------------------------------------ reading

    def pick(self, x: float, y: float) -> Reading | None:
        """Read the surface at a place of the window, in pixels from the lower left.

        None where there is no surface; the last two readings are kept for a section.
        """
        from vtkmodules.vtkRenderingCore import vtkCellPicker

        picker = vtkCellPicker()
        picker.SetTolerance(0.0)
        picker.AddPickList(self.drawn.surfaces[0])
        picker.PickFromListOn()
        if not picker.Pick(x, y, 0.0, self.drawn.plotter.renderer):
            self._say("No surface there.")
            return None
        found = self.read(np.array(picker.GetPickPosition()))
        if found is not None:
            self.readings = [*self.readings[-1:], found]
            self._section = None
            self._say(self.describe(found))
            self._mark()
        return found

    def read(self, place: Any) -> Reading | None:
        """Read the surface at a place as it is drawn, (3,) array; None off the surface."""
        tin, scale = self.scene.tin, self.scene.ground.scale
        xy = (place[:2] / scale[:2] + choose_origin(tin)[:2])[np.newaxis]
        triangle = int(tin.locate(xy)[0])
        if triangle < 0:
            return None
        elevation = float(tin.interpolate(xy)[0])
        return Reading(float(xy[0, 0]), float(xy[0, 1]), elevation, float(self._slopes[triangle]))

    def describe(self, found: Reading) -> str:
        """Return a reading in words, in the units of the CRS."""
        ground, crs = self.scene.ground, self.scene.tin.crs
        east, north = label_axes(crs)
        is_geographic = crs is not None and crs.is_geographic
        digits = 7 if is_geographic else 3
        across = "°" if is_geographic else f" {ground.unit.symbol}".rstrip()
        up = f" {ground.elevation_caption}".rstrip()
        return (
            f"{east.name.capitalize()} {east.of(found.easting):,.{digits}f}{across}   "
            f"{north.name.capitalize()} {north.of(found.northing):,.{digits}f}{across}   "
            f"Elevation {found.elevation:,.3f}{up}   Slope {found.slope:.1f}°"
        )

    def cut_section(self) -> Table | None:
        """Draw the profile between the last two readings; None if there are fewer."""
        if len(self.readings) < 2:
            self._say("A section needs two places: point at each and press P.")
            return None
        ends = [(one.easting, one.northing) for one in self.readings]
        try:
            table = profile(self.scene.tin, ends)
        except TinsmithError as error:
            self._say(str(error))
            return None
        self._section = table
        self._draw_chart(table)
        self._mark()
        return table

    def _draw_chart(self, table: Table) -> None:
        pv = optional.load("pyvista", _PURPOSE)
        if self._chart is not None:
            self.drawn.plotter.remove_chart(self._chart)
        unit, up = self.scene.ground.unit.symbol, self.scene.ground.elevation_caption
        self._chart = pv.Chart2D(
            size=_CHART_SIZE,
            loc=_CHART_PLACE,
            x_label=f"Distance ({unit})" if unit else "Distance",
            y_label=f"Elevation ({up})" if up else "Elevation",
        )
        self._chart.background_color = (1.0, 1.0, 1.0, 0.9)
        self._chart.line(np.array(table["station"]), np.array(table["elevation"]), color="k")
        self.drawn.plotter.add_chart(self._chart)

    def _mark(self) -> None:
        """Show the last readings, and the section between them, on the surface."""
        plotter = self.drawn.plotter
        for actor in self._marks:
            plotter.remove_actor(actor, render=False)
        self._marks = []
        if not self.readings:
            return
        places = [(one.easting, one.northing, one.elevation) for one in self.readings]
        drawn = place_in_scene(self.scene, np.array(places))
        options = {"color": palette.MARKS_3D, "lighting": False, "pickable": False}
        self._marks.append(
            plotter.add_points(
                drawn, point_size=_MARK_SIZE, render_points_as_spheres=True, **options
            )
        )
        if self._section is not None:
            self._marks.append(self._draw_section(self._section))

    def _draw_section(self, table: Table) -> Any:
        """Draw the line of a section along the surface, where there is one."""
        ends = np.array([(one.easting, one.northing) for one in self.readings])
        station, elevation = np.array(table["station"]), np.array(table["elevation"])
        share = (station / station[-1])[:, np.newaxis]
        places = np.column_stack([ends[0] + share * (ends[1] - ends[0]), elevation])
        seen = np.isfinite(elevation)
        pairs = np.flatnonzero(seen[:-1] & seen[1:])
        drawn = place_in_scene(self.scene, places)[np.column_stack([pairs, pairs + 1])]
        return add_polylines(
            self.drawn.plotter,
            drawn.reshape(-1, 3),
            np.arange(0, 2 * len(pairs) + 1, 2),
            np.arange(len(pairs)),
            color=palette.MARKS_3D,
            width=_SECTION_WIDTH,
        )

    def _say(self, words: str) -> None:
        """Write a line below the title, until the next one."""
        self._line = words
        self._raise_words()

    def _raise_words(self) -> None:
        """Draw the line, what keys do, and the slider over the annotations."""
        layout, self._words.factor = fit_layout(tuple(self.drawn.plotter.window_size))
        colors, left = self.scene.title_block.palette, layout.frame.xmin
        self._words.clear()
        self._words.draw_text((left, 14.0), _HELP, colors.grey, size=13)
        if self._line:
            place = (left, layout.frame.ymax - 14.0)
            self._words.draw_text(place, self._line, colors.ink, size=17)
        if self._slider is not None:
            knob, renderer = self._slider.GetRepresentation(), self.drawn.plotter.renderer
            renderer.RemoveViewProp(knob)
            renderer.AddViewProp(knob)

    # ------------------------------------------------------------------ the user

    def connect(self) -> None:
        """Follow mouse, keys and slider."""
        plotter = self.drawn.plotter
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
        plotter.enable_terrain_style(mouse_wheel_zooms=True)
        plotter.camera.AddObserver("ModifiedEvent", self.drawn.update)
        plotter.render_window.AddObserver("WindowResizeEvent", self.drawn.update)
        keys = {
            "t": self.change_tint,
            "c": self.toggle_contours,
            "p": self._pick_under_pointer,
            "x": self.cut_section,
        }
        for key, action in keys.items():
            plotter.add_key_event(key, action)
        factor = self.scene.exaggeration
        self._slider = plotter.add_slider_widget(
            self._slide,
            (min(1.0, factor), max(_MOST_EXAGGERATION, factor)),
            value=factor,
            title="Vertical exaggeration",
            pointa=(0.72, 0.93),
            pointb=(0.97, 0.93),
            color=[part / 255 for part in self.scene.title_block.palette.ink],
            interaction_event="end",
            fmt="%.1f",
            style="modern",
            slider_width=0.02,
            tube_width=0.004,
            title_height=0.018,
        )

    def _slide(self, value: float) -> None:
        factor = round(value, 1) or value
        if factor != self.scene.exaggeration:
            self.set_exaggeration(factor)

    def _pick_under_pointer(self) -> None:
        self.pick(*self.drawn.plotter.iren.get_event_position())


def open_window(tin: TIN, options: PreviewOptions, ortho: Ortho | None = None) -> None:
    """Show a surface in a window, and wait until it is closed."""
    optional.load("pyvista", _PURPOSE)
    opengl.require_window()
    with keep_vtk_plain():
        window = Window(tin, options, ortho)
        opengl.require_on_screen(window.drawn.plotter.render_window.GetClassName())
        window.connect()
        window.drawn.plotter.show(title=window.scene.title_block.title)
