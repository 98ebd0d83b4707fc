# Names that other packages use, each with the module that has it.
from .geometries import read_geometries as read_geometries
from .point_tables import is_point_table as is_point_table
from .reading import read_fixed_regions as read_fixed_regions
from .reading import read_plain_lines as read_plain_lines
from .survey_lines import require_near as require_near
from .survey_lines import split_layer as split_layer
