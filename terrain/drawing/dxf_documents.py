"""Drawings of ezdxf: the same bytes whenever they are written, and the paper to print them on."""

from __future__ import annotations

from contextlib import contextmanager
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...base.crs import Unit

_LAST_UNIT = 20
"""Of ``$INSUNITS`` in LibreCAD, which takes US survey feet, 21, for no unit, of 1 mm on paper."""
_R12 = "AC1009"


@contextmanager
def fixed_dxf_dates() -> Iterator[None]:
    """Let ezdxf write the same dates and identifiers at any time."""
    options = import_module("ezdxf").options
    before = options.write_fixed_meta_data_for_testing
    options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        options.write_fixed_meta_data_for_testing = before


def set_paper(
    document: Any,
    size: tuple[float, float],
    corner: tuple[float, float],
    mm_per_unit: float,
    unit: Unit | None,
) -> None:
    """Let programs print a drawing true to scale on paper of a size, from a corner on.

    The size is in millimetres, as is the length of a unit on paper; the corner is in units.
    LibreCAD takes the limits of paper space for the paper, in the drawing's unit: those that ezdxf
    gives, 420 by 297, would be 420 m by 297 m of a drawing in metres, on which nothing is seen.
    R12 has a place for the paper alone, and no units.
    """
    code = 0 if document.dxfversion == _R12 else document.header["$INSUNITS"]
    metres = None if unit is None else unit.metres
    mm = 1000.0 * metres if metres and 0 < code <= _LAST_UNIT else 1.0
    scale = mm_per_unit / mm
    paper = document.active_layout()
    paper.dxf.limmin, paper.dxf.limmax = (0.0, 0.0), (size[0] / mm, size[1] / mm)
    document.header["$PINSBASE"] = (-corner[0] * scale, -corner[1] * scale, 0.0)
    document.header["$PSVPSCALE"] = scale
