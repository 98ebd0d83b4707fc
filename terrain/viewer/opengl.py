"""Whether this machine can draw: asked in a process of its own, for VTK dies where it cannot."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

from ...base import optional
from ...base.errors import RenderError

PROBE_SECONDS = 60
"""How long the probe may take: a first start from a cold disk takes a few seconds."""

_PROBE = """
from vtkmodules.vtkCommonCore import vtkLogger
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow
window = vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetSize(8, 8)
window.AddRenderer(vtkRenderer())
window.Render()
assert window.SupportsOpenGL()
print("window:" + window.GetClassName())
"""
_OFF_SCREEN_WINDOWS = ("EGL", "OSOpenGL")
_NO_DISPLAY = "There is no display to open a window on: name a picture file as output instead."


def require_opengl() -> None:
    """Make sure that a picture can be drawn off screen.

    Raises MissingExtraError if PyVista, which brings VTK, is not installed. Raises RenderError if
    this machine cannot; the sentence says what to install.
    """
    optional.require("pyvista", "A preview")
    if not _find_window_class():
        raise RenderError(
            "This machine cannot draw: OpenGL is missing or does not work. "
            "Install it (Debian and Ubuntu: apt install libegl1 libgl1-mesa-dri)."
        )


def require_window() -> None:
    """Make sure that a window can be opened.

    Raises RenderError if there is no display, or no OpenGL.
    """
    require_opengl()
    require_on_screen(_find_window_class())
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        raise RenderError(_NO_DISPLAY)


def require_on_screen(kind: str) -> None:
    """Make sure that a window can be seen: VTK draws elsewhere if it cannot reach the display.

    ``kind`` is the name of VTK's window class. Raises RenderError if it is one that nobody sees.
    """
    if any(name in kind for name in _OFF_SCREEN_WINDOWS):
        raise RenderError(_NO_DISPLAY)


@cache
def _find_window_class() -> str:
    """Return the name of VTK's window class that works here, "" if none does."""
    try:
        probe = subprocess.run(
            [sys.executable, "-c", _PROBE],
            capture_output=True,
            text=True,
            timeout=PROBE_SECONDS,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return probe.stdout.partition("window:")[2].strip() if probe.returncode == 0 else ""
