"""``tinsmith view``: a picture or a window in 3D."""

from __future__ import annotations

import re
import threading
import webbrowser
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from ...command import command
from ...job import Job, surface_options
from ...options import CONSOLE, READING, TRIANGULATING
from ...output import Facts, note_written, report_warning
from ...parameters import file_option, input_files, parsed, picture_option
from ...paths import INPUT, Named, describe_inputs, make_title, require_separate
from ...product_options import product_options

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....terrain import TilesetPreview
    from ....tin import Survey

_MOST_CELLS = 1_000_000
_UNNAMED = "Terrain surface"
_PREVIEW = "terrain.viewer.presentation.preview"
_OF_TILESETS = ("exaggeration", "title", "elevations", "tint", "contours")
"""Options of what a page shows of a tileset."""


@parsed
def _parse_size(flag: str, value: str) -> tuple[int, int]:
    """Return width and height, given as 1600x1000 or 1600,1000."""
    found = re.fullmatch(r"\s*(\d{1,9})\s*[xX,\N{MULTIPLICATION SIGN}]\s*(\d{1,9})\s*", value)
    if found is None:
        raise click.UsageError(
            f"Invalid {flag} '{value}': it must be width and height, such as 1600x1000."
        )
    return int(found[1]), int(found[2])


@command
@input_files("files")
@picture_option("Page (.html) or picture (.png, .jpg, .tif) to write instead of opening a window.")
@click.option(
    "--compare",
    is_flag=True,
    help="Show the points of each of FILES as a surface of its own in a page, the earliest first; "
    "files of TINs always are.",
)
@product_options(_PREVIEW, "exaggeration edges lines")
@click.option("--top", is_flag=True, help="View from vertically above, north up.")
@file_option(
    "--ortho",
    "Orthophoto to drape over the surface: a GeoTIFF in any CRS, or another georeferenced image.",
    type=INPUT,
)
@product_options(_PREVIEW, "azimuth tilt")
@click.option(
    "--full",
    is_flag=True,
    help="Show every cell of a large raster; default a sample of a million, or half as many in a "
    "page.",
)
@click.option("--title", metavar="TEXT", help="Title of the picture; default the name of the file.")
@click.option(
    "--size",
    metavar="WIDTHxHEIGHT",
    callback=_parse_size,
    help="Pixels of a picture or window; default 1600x1000.",
)
@product_options(_PREVIEW, "dpi sun background elevations tint contours")
@surface_options(READING, TRIANGULATING, CONSOLE)
def view(
    files: tuple[Path, ...],
    output: Path | None,
    ortho: Path | None,
    full: bool,
    compare: bool,
    job: Job,
    **drawing: Any,
) -> None:
    """Show the TIN in FILES, or built from the points in them, in 3D.

    A page shows several TINs, the earliest or the existing ground first: with a slider between two
    of them, and cut and fill from each to the next. A tileset of 3D Tiles, named by its folder, is
    shown in the browser, level by level: served on this machine until Ctrl+C, or by a page.

    Example:
      tinsmith view sample_data/site_survey.csv --crs EPSG:32616 --codes -o site.html
      tinsmith view before.ply after.ply -o change.html
    """
    from ....terrain import preview
    from ....terrain.viewer import PREVIEW_SUFFIXES, is_tileset
    from ...outputs import require_picture

    if any(map(is_tileset, files)):
        _view_tileset(files, output, job, drawing)
        return
    if compare:
        _require_several(files, output)
    more = [] if ortho is None else [Named(ortho, "the picture to drape")]
    if output is not None:
        inputs = job.list_inputs(*files, more=more)
        require_picture(output, "--output", inputs, PREVIEW_SUFFIXES)
    if not full and "stride" not in job.reading.options:
        # Half as many for a page: pages are sent by mail.
        job = job.with_fallback(most_cells=_MOST_CELLS // 2 if _is_page(output) else _MOST_CELLS)
    surfaces = job.read_surfaces(files, apart=compare)
    tin, survey = surfaces[0]
    shown_tins = tin if len(surfaces) == 1 else [one for one, _ in surfaces]
    sample = _describe_samples([survey for _, survey in surfaces])
    drawing["view"] = "top" if drawing.pop("top") else "oblique"
    named = files if len(surfaces) > 1 else files[:1]
    drawing["title"] = drawing["title"] or ", ".join(filter(None, map(make_title, named)))
    drawing = {name: value for name, value in drawing.items() if value is not None}
    if sample is not None:
        job.console.summarise([("Sampled", f"{sample} are shown; --full shows all")])
        drawing["title"] = f"{drawing['title'] or _UNNAMED} ({sample})"
    with job.step("Drawing"):
        labelled = survey if len(surfaces) == 1 else None
        shown = preview(shown_tins, survey=labelled, ortho=ortho, **drawing)
        if output is None:
            shown.show()
        else:
            shown.save(output)
    for note in shown.notes:
        if note not in job.console.notes:
            report_warning(note)
    if output is not None:
        _tell_written(output, files, {} if sample is None else {"sample": sample}, job)


def _tell_written(
    output: Path, files: Sequence[Path], more: dict[str, str], job: Job, *rows: tuple[str, str]
) -> None:
    """Tell which file was written, as a summary and as a record."""
    from ...outputs import describe_file

    note_written(output)
    facts = Facts(input=describe_inputs(files))
    facts.add("Written", describe_file(output), output=str(output))
    job.console.summarise([*facts.lines, *rows])
    facts.record(**more)
    if job.console.as_json:
        job.console.emit_record(facts.values)


def _view_tileset(
    files: Sequence[Path], output: Path | None, job: Job, drawing: dict[str, Any]
) -> None:
    """Show a tileset in a page that is written, or served to the browser of this machine."""
    from ....terrain import preview_tileset

    if len(files) > 1:
        raise click.UsageError("A tileset is shown alone: name one.")
    _refuse_others()
    (path,) = files
    if output is not None:
        if not _is_page(output):
            raise click.UsageError(
                f"A tileset is shown in a page: the name '{output}' must end in .html."
            )
        require_separate([Named(path, "the input")], [Named(output, "--output")])
    named = {name: drawing[name] for name in _OF_TILESETS if drawing[name] is not None}
    shown = preview_tileset(path, **named)
    job.console.note(shown.notes)
    if output is None:
        _serve(shown, job)
        return
    shown.save(output)
    way = ("Opening", "by a web server; from a file it asks for the folder")
    _tell_written(output, files, {}, job, way)


def _refuse_others() -> None:
    """Refuse options that a tileset, which is read by the browser, has no use for."""
    context = click.get_current_context()
    kept = {"files", "output", *_OF_TILESETS, *CONSOLE.fields}
    for one in context.command.get_params(context):
        given = context.get_parameter_source(one.name or "") is ParameterSource.COMMANDLINE
        if given and one.name not in kept:
            raise click.UsageError(f"{one.opts[0]} has no meaning for a tileset.")


def _serve(shown: TilesetPreview, job: Job) -> None:
    """Serve a tileset, open it in the browser, and wait for Ctrl+C."""
    with shown.serve() as address:
        facts = Facts(address=address)
        job.console.summarise([("Serving", f"{address} until Ctrl+C")])
        if job.console.as_json:
            job.console.emit_record(facts.values)
        webbrowser.open(address)
        with suppress(KeyboardInterrupt):
            threading.Event().wait()


def _is_page(output: Path | None) -> bool:
    from ....terrain.viewer import PAGE_SUFFIXES

    return output is not None and output.suffix.lower() in PAGE_SUFFIXES


def _require_several(files: Sequence[Path], output: Path | None) -> None:
    """Refuse what --compare cannot show, before anything is read."""
    if len(files) == 1:
        raise click.UsageError("--compare needs two files or more, and there is one.")
    if not _is_page(output):
        raise click.UsageError(
            "--compare shows several surfaces, which only a page can: name one that ends in .html "
            "(-o)."
        )


def _describe_samples(surveys: Sequence[Survey | None]) -> str | None:
    """Return how many cells of rasters were read, if not all were."""
    samples = [_describe_sample(one) for one in surveys if one is not None]
    return ", ".join(filter(None, samples)) or None


def _describe_sample(survey: Survey) -> str | None:
    """Return how many cells of a raster were read, if not all were."""
    from ....io.raster import LEFT_OUT

    left_out = survey.skipped.get(LEFT_OUT, 0)
    read = len(survey.points) + survey.skipped.get("nodata cells", 0)
    return f"{read:,} of {read + left_out:,} cells" if left_out else None
