"""The only module that imports the compiled core of terrain."""

from __future__ import annotations

from .._interrupts import hold_interrupts

with hold_interrupts():
    from . import _core  # noqa: F401

__all__: list[str] = []
