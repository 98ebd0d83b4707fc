# Names that other packages use, each with the module that has it.
from .ground import GroundWindow as GroundWindow
from .ground import choose_reach as choose_reach
from .rasters import RasterOptions as RasterOptions
from .rasters import compute_block as compute_block
from .rasters import count_rings as count_rings
from .rasters import find_cells as find_cells
from .rasters import find_reach as find_reach
from .surfaces import are_inner as are_inner
from .surfaces import are_owned as are_owned
from .surfaces import are_owned_triangles as are_owned_triangles
from .surfaces import as_surface as as_surface
from .surfaces import require_local as require_local
