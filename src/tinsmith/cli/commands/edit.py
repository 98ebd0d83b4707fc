"""``tinsmith edit``: changes from a script, made to a TIN."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

from ...base.sentences import counted
from ..command import command
from ..job import Job, open_standard_input, surface_options
from ..output.counts import mesh_counts
from ..output.facts import Facts
from ..output.failures import Failure
from ..parameters import input_file, output_files, report_option
from ..paths import STANDARD, Named, name_file


@command
@input_file("file")
@input_file("script")
@output_files
@report_option("JSON file that accounts for every row and every edit.")
@surface_options()
def edit(file: Path, script: Path, report: Path | None, job: Job) -> None:
    """Edit the TIN in FILE, or built from the points in it, by the edits in SCRIPT.

    SCRIPT is a JSON list of edits, applied in order: insert, remove, move, set_elevation, flip,
    add_breakline, remove_breakline. The report of an earlier run can be used, too. Each edit uses
    the vertex numbers after the edits before it: removing a vertex lowers the numbers of later
    ones. Removing a breakline also removes the vertices that only it had.

    Example:
      tinsmith edit sample_data/site_survey.csv sample_data/edits.json --crs EPSG:32616 -o site.ply

    A script:
      [{"op": "insert", "points": [[752700.5, 4024250.0, 322.1]]},
       {"op": "remove", "vertices": [17]},
       {"op": "move", "vertex": 3, "point": [752771.2, 4024321.0, 329.1]},
       {"op": "set_elevation", "vertices": [4, 5], "z": [320.0, 320.5]},
       {"op": "add_breakline", "coords": [[752650, 4024200, 321], [752700, 4024300, 323]]}]
    """
    from ...tin.editing.history import apply_edits
    from ..output.console import format_json
    from ..outputs import write_text

    inputs = job.list_inputs(file, more=[Named(script, "the script")])
    planned = job.plan(inputs, "TIN", report=report)
    edits = _read_script(script)
    tin = job.read_tin(file)
    before = mesh_counts(tin)
    with job.step(f"Making {counted(len(edits), 'edit')}"):
        apply_edits(tin, edits)
    planned.write("TIN", tin)
    if report is not None:
        write_text(report, format_json(tin.report.to_dict()) + "\n")
    facts = Facts(file)
    facts.add("Read", f"a TIN of {before} from {name_file(file)}", script=str(script))
    counts = Counter(one.operation for one in tin.edits)
    named = ", ".join(f"{count} {operation}" for operation, count in counts.items())
    text = f"{len(tin.edits):,} ({named})" if named else "none"
    facts.add("Edits", text, report=tin.report.to_dict)
    facts.add_tin("TIN", tin)
    facts.note(note for one in tin.edits for note in one.notes)
    job.finish(planned, facts)


def _read_script(path: Path) -> list[dict[str, Any]]:
    from ...io.isolated.spooling import open_ordinary_file, translate_system_errors

    wanted = 'a list of edits is needed, such as [{"op": "remove", "vertices": [3]}]'
    try:
        if path == STANDARD:
            content = json.loads(open_standard_input().read().decode("utf-8-sig"))
        else:
            with open_ordinary_file(path) as local, translate_system_errors(path):
                content = json.loads(local.read_bytes().decode("utf-8-sig"))
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
