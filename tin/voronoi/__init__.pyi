# Names that other packages use, each with the module that has it.
from .construction import voronoi as voronoi
from .diagram import Voronoi as Voronoi
from .diagram import divide_plane as divide_plane
