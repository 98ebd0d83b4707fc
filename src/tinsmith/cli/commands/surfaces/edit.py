"""``tinsmith edit``: changes from a script or a table, made to a TIN, or taken back."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ....base.sentences import counted
from ...command import command
from ...edit_tables import read_edit_table
from ...job import Job, open_standard_input, surface_options
from ...output import Facts, Failure, mesh_counts
from ...parameters import input_file, output_files, report_option
from ...paths import INPUT, STANDARD, Named, name_file

if TYPE_CHECKING:
    from ....tin import TIN


@command
@input_file("file")
@click.argument("script", type=INPUT, required=False)
@output_files
@click.option(
    "--undo",
    metavar="N",
    type=click.IntRange(min=1),
    help="Take back the last N edits of FILE first; GeoPackages of tinsmith keep them.",
)
@report_option("JSON file that accounts for every row and every edit.")
@surface_options()
def edit(file: Path, script: Path | None, undo: int | None, report: Path | None, job: Job) -> None:
    """Edit the TIN in FILE, or built from the points in it, by the edits in SCRIPT.

    SCRIPT is a JSON list of edits, applied in order, or the report of an earlier run, or a CSV file
    with a column op and one for each argument. Each edit uses the vertex numbers after the edits
    before it: removing a vertex lowers the numbers of later ones. Removing a breakline also removes
    the vertices that only it had. In a table rows one behind the other that insert, remove or set
    elevations are one edit, and so are those that add a breakline and have the same line.

    Example:
      tinsmith edit sample_data/site_survey.csv sample_data/edits.json --crs EPSG:32616 -o site.ply

    A script:
      [{"op": "insert", "points": [[752700.5, 4024250.0, 322.1]], "duplicates": "last"},
       {"op": "remove", "vertices": [17]},
       {"op": "move", "vertex": 3, "point": [752771.2, 4024321.0, 329.1]},
       {"op": "set_elevation", "vertices": [4, 5], "z": [320.0, 320.5]},
       {"op": "flip", "a": 7, "b": 12},
       {"op": "add_breakline", "coords": [[752650, 4024200, 321], [752700, 4024300, 323]],
        "kind": "hard", "priority": 0, "name": "kerb", "crossing": "split"},
       {"op": "remove_breakline", "number": 0}]

    A table:
      op,vertex,x,y,z,a,b,number,line,name,kind,priority
      insert,,752700.5,4024250.0,322.1
      remove,17
      move,3,752771.2,4024321.0,329.1
      set_elevation,4,,,320.0
      flip,,,,,7,12
      add_breakline,,752650,4024200,321,,,,1,kerb,hard,0
      add_breakline,,752700,4024300,323,,,,1
      remove_breakline,,,,,,,0
    """
    from ....tin.editing import apply_edits
    from ...output import format_json
    from ...outputs import write_text

    if script is None and undo is None:
        raise click.UsageError("A SCRIPT of edits is needed, or --undo N.")
    more = [] if script is None else [Named(script, "the script")]
    planned = job.plan(job.list_inputs(file, more=more), "TIN", report=report)
    edits = [] if script is None else _read_script(script)
    tin = job.read_tin(file)
    before = mesh_counts(tin)
    if undo is not None:
        _take_back(tin, undo, file)
    with job.step(f"Making {counted(len(edits), 'edit')}"):
        apply_edits(tin, edits)
    planned.write("TIN", tin)
    if report is not None:
        write_text(report, format_json(tin.report.to_dict()) + "\n")
    facts = Facts(file)
    facts.add("Read", f"a TIN of {before} from {name_file(file)}")
    facts.record(script=None if script is None else str(script))
    if undo is not None:
        facts.add("Undone", counted(undo, "edit"), undone=undo)
    counts = Counter(one.operation for one in tin.edits)
    named = ", ".join(f"{count} {operation}" for operation, count in counts.items())
    text = f"{len(tin.edits):,} ({named})" if named else "none"
    facts.add("Edits", text, report=tin.report.to_dict)
    facts.add_tin("TIN", tin)
    facts.note(note for one in tin.edits for note in one.notes)
    job.finish(planned, facts)


def _take_back(tin: TIN, count: int, file: Path) -> None:
    """Take back the last edits of a file."""
    known = len(tin.edits)
    if count > known:
        raise Failure(
            f"'{file}' tells of {counted(known, 'edit')}, and {count:,} cannot be taken back: "
            "GeoPackages that tinsmith writes keep the edits of a TIN."
        )
    tin.undo(count)


def _read_script(path: Path) -> list[dict[str, Any]]:
    from ....io.isolated import open_ordinary_file, translate_system_errors

    wanted = 'a list of edits is needed, such as [{"op": "remove", "vertices": [3]}]'
    try:
        if path == STANDARD:
            text = open_standard_input().read().decode("utf-8-sig")
        else:
            with open_ordinary_file(path) as local, translate_system_errors(path):
                text = local.read_bytes().decode("utf-8-sig")
        is_script = path.suffix.lower() in (".json", "") or text.lstrip()[:1] in ("[", "{")
        if not is_script:
            return read_edit_table(text, path)
        content = json.loads(text)
    except json.JSONDecodeError as error:
        raise Failure(
            f"'{path}' is not JSON (line {error.lineno}: {error.msg}): {wanted}."
        ) from error
    except UnicodeDecodeError as error:
        raise Failure(f"'{path}' is not text in UTF-8: {wanted}.") from error
    edits = content.get("edits") if isinstance(content, dict) else content
    if not isinstance(edits, list) or not all(isinstance(one, dict) for one in edits):
        raise Failure(f"'{path}' holds something else: {wanted}.")
    return edits
