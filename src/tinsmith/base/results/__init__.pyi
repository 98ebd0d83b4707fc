# Names that other packages use, each with the module that has it.
from .columns import UNKNOWN_UNIT as UNKNOWN_UNIT
from .columns import Units as Units
from .columns import unit_text as unit_text
from .features import Features as Features
from .features import Kind as Kind
from .geometries import build_geometries as build_geometries
from .gridded import find_turn as find_turn
from .gridded import locate_all_centers as locate_all_centers
from .gridded import locate_centers as locate_centers
from .raster import Raster as Raster
from .raster import require_grid as require_grid
from .raster import require_square as require_square
from .table import Table as Table
from .table import tabulate_columns as tabulate_columns
