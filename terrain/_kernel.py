"""The only module that imports the compiled core of terrain."""

from __future__ import annotations

from .._interrupts import hold_interrupts

with hold_interrupts():
    from . import _core

__all__ = ["fill_bands", "smooth_contours", "trace_contours"]

trace_contours = _core.trace_contours
smooth_contours = _core.smooth_contours
fill_bands = _core.fill_bands
