"""``tinsmith paste``: one surface in the place of a part of another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..command import command
from ..parameters import input_file, output_files
from ..request import surface_options

if TYPE_CHECKING:
    from ...tin import TIN
    from ..output.console import Row
    from ..request import Request

__all__ = ["paste"]


@command
@input_file("base")
@input_file("patch")
@output_files
@surface_options()
def paste(base: Path, patch: Path, request: Request) -> None:
    """Replace a part of the TIN in BASE by the TIN in PATCH.

    Within the boundary of PATCH the surface is that of PATCH, elsewhere that of BASE: a new survey
    in an old one, a design in the ground. Where PATCH extends beyond BASE the surface becomes
    larger, with a note. Either file may hold points, from which the TIN is built. Elevations along
    the seam are those of PATCH.

    \b
    Example:
      tinsmith paste sample_data/site_survey.csv sample_data/design_pad.csv --codes -o site.gpkg
    """  # noqa: D301 - click reads the control character
    from ...terrain import paste as paste_tin

    files = (base, patch)
    planned = request.plan(request.list_inputs(*files), "TIN")
    surfaces = request.read_tins(files)
    with request.step("Pasting"):
        pasted = paste_tin(*surfaces)
    planned.write("TIN", pasted)
    rows = _summarise_pasting([*surfaces, pasted])
    request.finish(planned, rows, lambda: _describe_pasting(files, pasted))


def _summarise_pasting(surfaces: list[TIN]) -> list[Row]:
    from ..output.line_summaries import mesh_counts

    names = ("Base", "Patch", "Pasted")
    counts = zip(names, map(mesh_counts, surfaces), strict=True)
    return [*counts, *(("Note", note) for note in surfaces[-1].report.notes)]


def _describe_pasting(files: tuple[Path, ...], pasted: TIN) -> dict[str, Any]:
    from ..output.summaries import describe_tin

    return {
        "inputs": [str(file) for file in files],
        "tin": describe_tin(pasted),
        "report": pasted.report.to_dict(),
    }
