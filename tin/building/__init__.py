"""From checked inputs to a triangulated surface: rows merged, lines forced, parts cut away."""

from .assembly import find_ring_groups
from .attributes import as_columns, join_columns
from .duplicates import merge_rows
from .inputs import BuildInputs, gather_inputs
from .options import BuildOptions
from .reference import find_crs
from .survey import Survey
from .survey_moving import move_survey
from .version import Version

__all__ = [
    "BuildInputs",
    "BuildOptions",
    "Survey",
    "Version",
    "as_columns",
    "find_crs",
    "find_ring_groups",
    "gather_inputs",
    "join_columns",
    "merge_rows",
    "move_survey",
]
