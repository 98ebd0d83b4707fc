"""A window in which a surface is turned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ... import _optional
from . import opengl
from .picture import keep_vtk_plain
from .stage import Show, make_stage

if TYPE_CHECKING:
    from ...tin import TIN
    from .look import Look
    from .ortho import Ortho

__all__ = ["open_window"]

_PURPOSE = "A preview"


def open_window(tin: TIN, look: Look, ortho: Ortho | None = None) -> None:
    """Show a surface in a window, and wait until it is closed."""
    _optional.load("pyvista", _PURPOSE)
    opengl.require_window()
    with keep_vtk_plain():
        show = Show(make_stage(tin, look, ortho, has_strips=False), look.size, off_screen=False)
        plotter = show.plotter
        plotter.enable_anti_aliasing("msaa", multi_samples=8)
        plotter.enable_terrain_style(mouse_wheel_zooms=True)
        plotter.camera.AddObserver("ModifiedEvent", show.update)
        plotter.render_window.AddObserver("WindowResizeEvent", show.update)
        plotter.show(title=show.stage.caption.title)
