# Names that other packages use, each with the module that has it.
from .cells import is_number as is_number
from .columns import find_role as find_role
from .columns import find_unit_word as find_unit_word
from .findings import find_odd_elevations as find_odd_elevations
from .findings import find_repeated_numbers as find_repeated_numbers
from .findings import require_ground as require_ground
from .lines import TextLines as TextLines
from .lines import read_lines as read_lines
from .marks import looks_like_table as looks_like_table
from .names import parse_name as parse_name
from .query_points import QueryPoints as QueryPoints
from .query_points import read_query_points as read_query_points
from .query_points import read_text_table as read_text_table
