# Names that other packages use, each with the module that has it.
from .gridded import make_raster as make_raster
from .ortho import as_picture_path as as_picture_path
from .ortho import read_ortho as read_ortho
from .reading import LEFT_OUT as LEFT_OUT
from .reading import is_raster as is_raster
from .target_grid import read_cells as read_cells
from .target_grid import take_cells as take_cells
from .virtual import is_virtual as is_virtual
