"""A picture of a TIN that can be handed to a client, or a window to turn it in."""

from __future__ import annotations

import secrets
from contextlib import contextmanager
from dataclasses import astuple, dataclass, replace
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import _optional
from ...errors import OptionError, RenderError
from ...tin import Bounds
from ..linework import add_lines
from ..units import find_ground
from . import opengl
from .annotations import Caption, Sheet, annotate
from .camera import VIEWS, View, aim, measure_pixels_per_unit, project_ground_axes
from .overlay import Overlay
from .scene import (
    add_lights,
    add_ortho,
    add_terrain,
    choose_exaggeration,
    fade_edges,
    place_vertices,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from PIL.Image import Image

    from ...tin import TIN
    from ..units import Ground
    from .ortho import Ortho

__all__ = ["PICTURE_SUFFIXES", "Look", "check_look", "open_window", "write_picture"]

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")
"""File name endings of pictures that can be written."""

_PURPOSE = "A preview"

_SUPERSAMPLING = 2
"""Pictures are drawn this many times larger in each direction, then averaged down."""

_DESIGN_SIZE = (1600.0, 1000.0)
"""Picture size for which the annotations are laid out, pixels."""

_SIZE_RANGE = (200, 5000)
_JPEG_QUALITY = 92


@dataclass(frozen=True, slots=True)
class Look:
    """How a surface is shown: the options of :func:`tinsmith.preview`."""

    exaggeration: float | None = None
    edges: bool = False
    lines: bool = True
    size: tuple[int, int] = (1600, 1000)
    title: str = "Terrain surface"
    view: str = "oblique"


def write_picture(tin: TIN, path: Path, look: Look, ortho: Ortho | None = None) -> None:
    """Draw a surface off screen and write the picture whole or not at all."""
    opengl.require_opengl()
    with _keep_vtk_plain():
        _write(path, _render(_make_stage(tin, look, ortho)))


def open_window(tin: TIN, look: Look, ortho: Ortho | None = None) -> None:
    """Show a surface in a window, and wait until it is closed."""
    _optional.load("pyvista", _PURPOSE)
    opengl.require_window()
    with _keep_vtk_plain():
        _Show(_make_stage(tin, look, ortho), look.size, off_screen=False).open_window()


def _make_stage(tin: TIN, look: Look, ortho: Ortho | None) -> _Stage:
    _optional.load("pyvista", _PURPOSE)
    ground = find_ground(tin)
    factor = look.exaggeration or choose_exaggeration(tin, ground)
    caption = _make_caption(tin, ground, factor, look.title)
    if ortho is not None and ortho.gap == 0.0:
        caption = replace(caption, has_tints=False)
    view = VIEWS[look.view]
    return _Stage(tin, ground, factor, look.edges, look.lines, look.size, caption, view, ortho)


@dataclass(frozen=True, slots=True)
class _Stage:
    """What is to be drawn, and how; ``size`` is in pixels."""

    tin: TIN
    ground: Ground
    exaggeration: float
    edges: bool
    lines: bool
    size: tuple[int, int]
    caption: Caption
    view: View
    ortho: Ortho | None = None


class _Show:
    """A plotter with terrain, light, camera and annotations in place.

    Parameters
    ----------
    stage : _Stage
    window : tuple of int
        Width and height of the window, pixels.
    off_screen : bool
    """

    def __init__(self, stage: _Stage, window: tuple[int, int], *, off_screen: bool) -> None:
        pv = _optional.load("pyvista", _PURPOSE)
        self.stage = stage
        self.plotter: Any = pv.Plotter(
            off_screen=off_screen, window_size=list(window), lighting="none"
        )
        self.plotter.set_background("white")
        points = place_vertices(stage.tin, stage.ground, stage.exaggeration)
        self._surface, seen = add_terrain(self.plotter, stage.tin, points, edges=stage.edges)
        self._sheets = [self._surface]
        if stage.ortho is not None:
            sheet = add_ortho(self.plotter, stage.tin, points, stage.ortho, self._surface)
            self._sheets.append(sheet)
        add_lights(self.plotter)
        self._overlay = Overlay(self.plotter.renderer)
        self._drawn_for: tuple[object, ...] = ()
        sheet, factor = _fit_sheet(window)
        if stage.lines:
            add_lines(self.plotter, stage.tin, points, factor=factor)
        frame = Bounds(*(factor * side for side in astuple(sheet.frame)))
        aim(self.plotter.camera, seen, view=stage.view, frame=frame, size=window)
        self.plotter.renderer.ResetCameraClippingRange()
        self.update()

    def update(self, *_: object) -> None:
        """Make the annotations true for the present camera and window, if these have changed."""
        camera, (width, height) = self.plotter.camera, self.plotter.window_size
        state = (width, height, camera.parallel_scale, project_ground_axes(camera).tobytes())
        if state == self._drawn_for:
            return
        self._drawn_for = state
        sheet, self._overlay.factor = _fit_sheet((width, height))
        pixels = measure_pixels_per_unit(camera, sheet.height)
        for one in self._sheets:
            fade_edges(one, self.stage.tin, self.stage.ground, pixels)
        annotate(self._overlay, sheet, self.stage.caption, camera)

    def open_window(self) -> None:
        """Open a window and wait until it is closed."""
        self.plotter.enable_anti_aliasing("msaa", multi_samples=8)
        self.plotter.enable_terrain_style(mouse_wheel_zooms=True)
        self.plotter.camera.AddObserver("ModifiedEvent", self.update)
        self.plotter.render_window.AddObserver("WindowResizeEvent", self.update)
        self.plotter.show(title=self.stage.caption.title)


def _render(stage: _Stage) -> Image:
    """Draw off screen, larger than asked, and average down: smooth edges for lines and words."""
    from PIL.Image import fromarray

    width, height = stage.size
    window = (_SUPERSAMPLING * width, _SUPERSAMPLING * height)
    show = _Show(stage, window, off_screen=True)
    try:
        pixels = show.plotter.screenshot(return_img=True)
    finally:
        show.plotter.close()
    return fromarray(pixels).reduce(_SUPERSAMPLING)


def _fit_sheet(window: tuple[int, int]) -> tuple[Sheet, float]:
    """Return the sheet that fills a window, and the window pixels for one design pixel."""
    factor = min(full / design for full, design in zip(window, _DESIGN_SIZE, strict=True))
    return Sheet(window[0] / factor, window[1] / factor), factor


def _make_caption(tin: TIN, ground: Ground, factor: float, title: str) -> Caption:
    counts = f"{len(tin.points):,} points, {len(tin.triangles):,} triangles"
    low, high = float(tin.points[:, 2].min()), float(tin.points[:, 2].max())
    return Caption(
        title=" ".join(title.split()),
        subtitle=f"{counts}  \N{MIDDLE DOT}  {ground.crs_name}",
        exaggeration=factor,
        elevations=(low, high),
        elevation_caption=ground.elevation_caption,
        unit=ground.unit,
    )


def check_look(size: tuple[int, int], view: str) -> None:
    """Refuse a size or a view that there is not."""
    if not isinstance(view, str) or view not in VIEWS:
        raise OptionError("view", view, " or ".join(map(repr, VIEWS)))
    low, high = _SIZE_RANGE
    whole = isinstance(size, tuple | list) and all(isinstance(side, Integral) for side in size)
    if not whole or len(size) != 2 or not all(low <= side <= high for side in size):
        raise OptionError("size", size, f"width and height, {low} to {high} pixels each")


def _write(path: Path, picture: Image) -> None:
    """Write a picture whole or not at all."""
    temporary = path.with_name(f".{path.stem}-{secrets.token_hex(4)}{path.suffix}")
    try:
        picture.save(temporary, quality=_JPEG_QUALITY)
        temporary.replace(path)
    except OSError as error:
        raise RenderError(f"Cannot write '{path}': {error.strerror or error}.") from error
    finally:
        temporary.unlink(missing_ok=True)


@contextmanager
def _keep_vtk_plain() -> Iterator[None]:
    """Keep VTK from reading mathematics into titles, and from warning that there is no display."""
    from vtkmodules.vtkCommonCore import vtkLogger
    from vtkmodules.vtkRenderingFreeType import vtkMathTextFreeTypeTextRenderer

    words = vtkMathTextFreeTypeTextRenderer.GetInstance()
    before = vtkLogger.GetCurrentVerbosityCutoff(), words.GetDefaultBackend()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    words.SetDefaultBackend(words.FreeType)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before[0])
        words.SetDefaultBackend(before[1])
