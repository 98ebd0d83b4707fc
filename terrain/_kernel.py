"""The only module that imports the compiled core of terrain."""

from __future__ import annotations

from .._interrupts import hold_interrupts

with hold_interrupts():
    from . import _core

__all__ = [
    "means_of_cells",
    "values_at_centers",
]

means_of_cells = _core.means_of_cells
values_at_centers = _core.values_at_centers
