# Names that other packages use, each with the module that has it.
from .illegal_edges import gather_quadrilaterals as gather_quadrilaterals
from .illegal_edges import is_against_rule as is_against_rule
from .illegal_edges import mark_illegal_edges as mark_illegal_edges
from .interpolator import Interpolator as Interpolator
from .triangulation import Triangulation as Triangulation
