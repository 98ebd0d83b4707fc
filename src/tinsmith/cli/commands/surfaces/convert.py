"""``tinsmith convert``: the same points or TIN in another format."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ....base.sentences import counted
from ...command import file_command
from ...job import Job, surface_options
from ...option_groups import GROUND_COORDINATES, tell_factor
from ...options import CONSOLE, READING, WRITING
from ...output import Facts, Failure
from ...paths import name_file, split_output

if TYPE_CHECKING:
    from ....terrain import Raster
    from ....tin import Survey


@file_command
@surface_options(READING, GROUND_COORDINATES, WRITING, CONSOLE)
def convert(file: Path, job: Job) -> None:
    """Write what is in FILE in another format: a TIN as a TIN, points as points.

    A TIN can also be written as points or features (--kind), and points that are the cells of a
    grid, such as those of a DEM, as a raster. To build a TIN from points, use 'tinsmith build';
    for a raster of another surface 'tinsmith raster'. With --to-ground coordinates are those on the
    ground; --to-crs with the CRS of the grid brings them back, from files that keep their CRS.

    Example:
      tinsmith convert sample_data/site_survey.csv -o site.xyz
      tinsmith convert sample_data/site_survey.csv --crs EPSG:32616 --to-ground -o on_ground.csv
    """
    from ....tin import Survey
    from ...output import note_assumed_unit, summarise_reading
    from ...outputs import describe_file

    planned = job.plan(
        job.list_inputs(file),
        "TIN",
        "Survey",
        "Raster",
        choose=lambda one: "Raster" if {*one.formats} == {"Raster"} else "any",
    )
    job.ground_coordinates.require_fitting()
    found = job.read(file)
    factor = job.ground_coordinates.find_factor(found)
    if factor is not None:
        found = factor.to_ground(found)
    made: Any = found
    if planned.holds("Raster") and isinstance(found, Survey):
        made = _make_raster(found, planned.outputs["Raster"][0].path)
    planned.write("any", found)
    planned.write("Raster", made)
    job.note_found(found)
    facts = Facts(file)
    text = (
        counted(len(found), "point")
        if isinstance(found, Survey)
        else f"a TIN of {counted(len(found.triangles), 'triangle')}"
    )
    facts.add("Read", f"{text} from {name_file(file)}")
    facts.extend(summarise_reading(found))
    tell_factor(facts, factor)
    if note := note_assumed_unit(found):
        facts.add("Elevation", note)
    paths = [split_output(path)[0] for path in job.outputs]
    facts.add("Written", "\n".join(map(describe_file, paths)), outputs=list(map(str, paths)))
    job.console.summarise(facts.lines)
    if job.console.as_json:
        job.console.emit_record(facts.values)


def _make_raster(survey: Survey, path: Path) -> Raster:
    from ....base.errors import PointsError
    from ....io.raster import make_raster

    try:
        return make_raster(survey)
    except PointsError as error:
        way = "'tinsmith raster' makes one of their surface."
        raise Failure(f"Cannot write '{path}': {error} {way}") from error
