"""A picture of a TIN that can be handed to a client."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.atomic import replacing_path
from . import opengl
from .scene import ScenePlotter, make_scene
from .strips import label_strips, paste_strips

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from PIL.Image import Image

    from ...tin import TIN
    from .options import PreviewOptions
    from .ortho import Ortho
    from .scene import Scene

PICTURE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff")
"""File name endings of pictures that can be written."""

_SUPERSAMPLING = 2
"""Pictures are drawn this many times larger in each direction, then averaged down."""

_JPEG_QUALITY = 92


def write_picture(
    tin: TIN, path: Path, options: PreviewOptions, ortho: Ortho | None = None
) -> None:
    """Draw a surface off screen and write the picture whole or not at all."""
    opengl.require_opengl()
    with keep_vtk_plain():
        picture = _render(make_scene(tin, options, ortho))
    resolution: dict[str, Any] = {} if options.dpi is None else {"dpi": (options.dpi, options.dpi)}
    with replacing_path(path) as beside:
        picture.save(beside, quality=_JPEG_QUALITY, **resolution)


def _render(scene: Scene) -> Image:
    """Draw off screen, larger than asked, and average down: smooth edges for lines and words."""
    from PIL.Image import fromarray

    width, height = scene.options.size
    window = (_SUPERSAMPLING * width, _SUPERSAMPLING * height)
    drawn = ScenePlotter(scene, window, off_screen=True)
    try:
        label_strips(drawn)
        pixels = np.array(drawn.plotter.screenshot(return_img=True))
    finally:
        drawn.plotter.close()
    paste_strips(pixels, scene)
    return fromarray(pixels).reduce(_SUPERSAMPLING)


@contextmanager
def keep_vtk_plain() -> Iterator[None]:
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
