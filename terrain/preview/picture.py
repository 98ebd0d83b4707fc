"""Preview: a picture of a TIN that can be handed to a client, or a window to turn it in."""

from __future__ import annotations

import secrets
from contextlib import contextmanager
from dataclasses import astuple, dataclass
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import _optional
from ..._atomic import as_path
from ...errors import OptionError, RenderError
from ...tin import Bounds
from ..lift import parse_exaggeration
from ..linework import add_lines
from ..units import find_ground
from . import opengl
from .annotations import Caption, Sheet, annotate
from .camera import VIEWS, View, aim, measure_pixels_per_unit, project_ground_axes
from .overlay import Overlay
from .scene import add_lights, add_terrain, choose_exaggeration, fade_edges, place_vertices

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

    from PIL.Image import Image

    from ...tin import TIN
    from ..units import Ground

__all__ = ["PICTURE_SUFFIXES", "preview"]

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")
"""File name endings of pictures that can be written."""

_PURPOSE = "A preview"

_SUPERSAMPLING = 2
"""Pictures are drawn this many times larger in each direction, then averaged down."""

_DESIGN_SIZE = (1600.0, 1000.0)
"""Picture size for which the annotations are laid out, pixels."""

_SIZE_RANGE = (200, 5000)
_JPEG_QUALITY = 92


def preview(
    tin: TIN,
    *,
    output: str | os.PathLike[str] | None = None,
    exaggeration: float | None = None,
    edges: bool = False,
    lines: bool = True,
    size: tuple[int, int] = (1600, 1000),
    title: str | None = None,
    view: str = "oblique",
) -> Path | None:
    """Show a TIN in 3D with hypsometric tints, hillshade, legend, scale bar and north arrow.

    Parameters
    ----------
    tin : TIN
    output : path, optional
        Picture to write, off screen: .png, .jpg, .jpeg, .tif or .tiff. Default: open a window.
    exaggeration : float, optional
        Factor on heights. Default: a round number that lifts the relief to a tenth of the extent
        or more, 1 where it is steep enough. It is written in the picture.
    edges : bool, optional
        Draw the edges of the triangles.
    lines : bool, optional
        Draw the lines in the TIN: hard breaklines dark, soft ones dashed, boundary and holes brown,
        the water's edge blue.
    size : tuple of int, optional
        Width and height, pixels, 200 to 5000 each.
    title : str, optional
        Default "Terrain surface".
    view : {"oblique", "top"}, optional
        Seen from the south-southwest, 35 degrees above the horizon, or as a map from above.

    Returns
    -------
    pathlib.Path or None
        The picture written; None after a window was closed.

    Raises
    ------
    OptionError
        If an option is outside what is allowed.
    RenderError
        If the picture cannot be written, or the machine has no OpenGL or, for a window, no
        display.
    MissingExtraError
        If pyvista is not installed.

    Notes
    -----
    Both views are parallel projections, in which one scale holds from left to right all over the
    picture. Light falls from the northwest at 45 degrees, fixed to the ground. Tints span the
    lowest to the highest elevation; perceived lightness rises evenly with elevation. The same TIN
    and options give the same bytes on the same machine.

    Examples
    --------
    >>> import tinsmith as ts
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]], crs="EPSG:32616")
    >>> with TemporaryDirectory() as folder:
    ...     ts.preview(tin, output=Path(folder, "site.png"), size=(400, 300)).name
    'site.png'
    """
    path = None if output is None else _require_picture_path(output)
    _check_options(size, view)
    factor = None if exaggeration is None else parse_exaggeration(exaggeration)
    _optional.load("pyvista", _PURPOSE)
    (opengl.require_window if path is None else opengl.require_opengl)()
    ground = find_ground(tin)
    factor = choose_exaggeration(tin, ground) if factor is None else factor
    caption = _make_caption(tin, ground, factor, title or "Terrain surface")
    stage = _Stage(tin, ground, factor, edges, lines, size, caption, VIEWS[view])
    with _keep_vtk_plain():
        if path is None:
            _Show(stage, size, off_screen=False).open_window()
        else:
            _write(path, _render(stage))
    return path


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
        fade_edges(self._surface, self.stage.tin, self.stage.ground, pixels)
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


def _check_options(size: tuple[int, int], view: str) -> None:
    if view not in VIEWS:
        raise OptionError("view", view, " or ".join(map(repr, VIEWS)))
    low, high = _SIZE_RANGE
    whole = isinstance(size, tuple | list) and all(isinstance(side, Integral) for side in size)
    if not whole or len(size) != 2 or not all(low <= side <= high for side in size):
        raise OptionError("size", size, f"width and height, {low} to {high} pixels each")


def _require_picture_path(output: str | os.PathLike[str]) -> Path:
    path = as_path(output, "output")
    if path.suffix.lower() not in PICTURE_SUFFIXES:
        raise RenderError(
            f"Cannot write a picture to '{path}': its name must end in "
            f"{', '.join(PICTURE_SUFFIXES)}."
        )
    if not path.parent.is_dir():
        raise RenderError(f"Cannot write '{path}': there is no folder '{path.parent}'.")
    return path


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
