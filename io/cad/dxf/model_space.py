"""The model space of a drawing as arrays: what the child process found, and notes on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base import optional
from ....base.checks import as_length
from ....base.crs import CRS
from ....base.errors import CrsError, OptionError, ReadError
from ....base.sentences import FILE, counted
from ...isolated import Limits, choose_limits, run_isolated, translate_system_errors
from ..reference import Stated
from .layers import CRS_PROPERTY, ELEVATION_PROPERTY, UNIT_OF_CODE, UNKNOWN

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import AnyArray, Float64Array

_SLOWNESS = 5
"""Times the usual time: ezdxf reads about a million bytes in a second, on a busy machine less."""


class ModelSpace(NamedTuple):
    """What a drawing holds in its model space, blocks taken apart."""

    path: Path
    value: dict[str, Any]
    """``layers`` by number, what was left out, and texts, as the child process answers."""
    arrays: dict[str, AnyArray]
    """``points`` (n, 3), ``faces`` (m, 4, 3), ``lines`` (k, 3) with ``lengths`` and ``is_flat`` of
    each, ``text_places``, and the layer of each point, face and line.
    """

    @property
    def lines(self) -> list[Float64Array]:
        """Lines as rows, (k, 2) where an elevation of 0 stands for none."""
        ends = np.cumsum(self.arrays["lengths"]).tolist()
        starts = [0, *ends[:-1]] if ends else []
        rows = self.arrays["lines"]
        flat = self.arrays["is_flat"].tolist()
        return [
            rows[start:end, : 2 if is_flat else 3]
            for start, end, is_flat in zip(starts, ends, flat, strict=True)
        ]

    @property
    def stated(self) -> Stated:
        """What the drawing says of units and CRS."""
        properties = dict(self.value["properties"])
        text = properties.get(CRS_PROPERTY) or self.value["epsg"]
        try:
            crs = CRS.of(text or None)
        except CrsError:
            crs = None
        unit = UNIT_OF_CODE.get(self.value["unit"])
        is_unknown = properties.get(ELEVATION_PROPERTY) == UNKNOWN
        return Stated(crs, unit, None, is_unknown, "its header ($INSUNITS)")

    def describe_left_out(self) -> list[str]:
        """Tell in sentences what of the drawing was not taken, or needs to be known."""
        value, notes = self.value, []
        if value["left_out"]:
            what = ", ".join(f"{count:,} {kind}" for kind, count in value["left_out"].items())
            notes.append(f"Left out: {what}.")
        for layer, count in value["hidden"].items():
            where = "that are invisible" if layer == "invisible" else f"on the layer '{layer[:60]}'"
            why = "" if layer == "invisible" else ", which is off or frozen"
            things = counted(count, "entity", "entities")
            notes.append(f"Left out: {things} {where}{why}.")
        if value["missing_blocks"]:
            names = ", ".join(f"'{name}'" for name in value["missing_blocks"][:5])
            notes.append(f"Blocks that are not in the file were not followed: {names}.")
        if value["n_nested_lines"]:
            notes.append(f"{counted(value['n_nested_lines'], 'line')} come from inserted blocks.")
        if value["n_curves"]:
            notes.append(f"{counted(value['n_curves'], 'curve')} became polylines.")
        return notes


def read_model_space(
    path: Path,
    *,
    layer: str | None = None,
    texts: bool = False,
    tolerance: float | None = None,
    keeps_arcs: bool = False,
) -> ModelSpace:
    """Read the model space of a drawing in a child process.

    Parameters
    ----------
    path : Path
    layer : str, optional
        Names or patterns of layers, with commas between; default all that are neither off nor
        frozen.
    texts : bool
    tolerance : float, optional
        How far a curve may lie from its chords, in the unit of the drawing; default a centimetre,
        or a hundredth of a unit that is not known.
    keeps_arcs : bool
        Leave arcs of plane entities as they are: ``bulges`` has the tangent of a quarter of the
        angle that follows each vertex of lines.

    Raises
    ------
    MissingExtraError
        If ezdxf is not installed.
    ReadError
        If the file is damaged, or takes longer or more memory than it may.
    OptionError
        If there is no such layer, or the tolerance is no length above 0.
    """
    optional.require("ezdxf", "Reading DXF drawings")
    if layer is not None and not (isinstance(layer, str) and layer.strip(", ")):
        raise OptionError("layer", layer, "names or patterns of layers with commas between")
    if tolerance is not None:
        as_length("tolerance", tolerance, or_none=True)
    with translate_system_errors(path):
        size = path.stat().st_size
    usual = choose_limits(size)
    answer = run_isolated(
        f"{__package__}.dxf_child:read_drawing",
        {
            "path": str(path.absolute()),
            "layer": layer,
            "texts": texts,
            "tolerance": tolerance,
            "keeps_arcs": keeps_arcs,
        },
        path=path,
        limits=Limits(usual.seconds + (_SLOWNESS - 1) * size / 1e6, usual.memory),
    )
    drawing = ModelSpace(path, answer.value, answer.arrays)
    if layer is not None and not drawing.value["layers"]:
        names = drawing.value["all_layers"]
        shown = ", ".join(f"'{name[:60]}'" for name in names[:20])
        more = ", ..." if len(names) > 20 else ""
        raise OptionError("layer", layer, f"a layer with something in it; {FILE} has {shown}{more}")
    for name in ("points", "faces", "lines", "text_places"):
        rows = drawing.arrays[name].reshape(-1, 3)
        wrong = ~np.isfinite(rows).all(axis=1)
        if wrong.any():
            row = rows[int(np.argmax(wrong))].tolist()
            raise ReadError(f"{FILE} has coordinates that are not finite (first: {row}).")
    return drawing
