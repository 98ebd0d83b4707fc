# Names that other packages use, each with the module that has it.
from .clipping import Clipped as Clipped
from .clipping import clip_tin as clip_tin
from .flips import describe_flips as describe_flips
from .shape_quality import measure_smallest_angles as measure_smallest_angles
from .simplification import Errors as Errors
from .simplification import Goal as Goal
from .simplification import are_straight as are_straight
from .simplification import find_rounding as find_rounding
from .simplification import insert_until_near as insert_until_near
from .simplification import simplify_convex as simplify_convex
from .simplification import simplify_tin as simplify_tin
from .surface_difference import Crossings as Crossings
from .surface_difference import choose_rows as choose_rows
