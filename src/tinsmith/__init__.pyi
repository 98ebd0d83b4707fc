# Public names, each with the module that has it: type checkers and `_lazy` read them here.
from . import io as io
from . import terrain as terrain
from . import tin as tin
from .base.crs import CRS as CRS
from .base.crs import Unit as Unit
from .base.errors import CheckError as CheckError
from .base.errors import CrsError as CrsError
from .base.errors import FormatError as FormatError
from .base.errors import LinesError as LinesError
from .base.errors import LossWarning as LossWarning
from .base.errors import MissingExtraError as MissingExtraError
from .base.errors import OptionError as OptionError
from .base.errors import PlugInWarning as PlugInWarning
from .base.errors import PointsError as PointsError
from .base.errors import ReadError as ReadError
from .base.errors import RenderError as RenderError
from .base.errors import TinsmithError as TinsmithError
from .base.errors import WriteError as WriteError
from .io import Format as Format
from .io import find_format as find_format
from .io import from_mesh as from_mesh
from .io import from_raster as from_raster
from .io import known_formats as known_formats
from .io import length_unit as length_unit
from .io import lines_from_codes as lines_from_codes
from .io import read as read
from .io import read_alignment as read_alignment
from .io import read_lines as read_lines
from .io import read_points as read_points
from .io import read_polygons as read_polygons
from .io import read_raster as read_raster
from .io import read_rings as read_rings
from .io import read_superelevation as read_superelevation
from .io import read_template as read_template
from .io import read_tin as read_tin
from .io import read_water as read_water
from .io import reproject as reproject
from .io import to_features as to_features
from .io import to_meshio as to_meshio
from .io import to_pyvista as to_pyvista
from .io import to_rasterio as to_rasterio
from .io import to_trimesh as to_trimesh
from .io import to_ugrid as to_ugrid
from .io import transform_points as transform_points
from .io import with_lines as with_lines
from .io import write as write
from .terrain import *  # noqa: F403
from .tiled.tiled_points import TiledPoints as TiledPoints
from .tiled.tiled_points import tiles as tiles
from .tin import *  # noqa: F403
from .tin.voronoi import voronoi as voronoi

__version__: str
