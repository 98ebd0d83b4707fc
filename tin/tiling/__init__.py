"""Parts of a triangulation that is never in memory as a whole, each of them exact."""

from .boxes import are_in_box, intersect, list_sides, widen
from .circles import Discs
from .draping import Draping, KnownTriangles, LaidLines, find_rim, node_base, node_laid
from .duplicates import find_differing
from .lines import NodedLines, choose_near, list_segments_near, node_lines, require_local
from .local_triangulation import LocalTriangulation, find_around, find_triangles_at, triangulate_box
from .outline import Outline, find_outline
from .proof import TilesProof, TileTriangles, check_tiles
from .rings import Rings
from .skeleton import find_outermost, find_skeleton, reduce_to_hull
from .sources import NumberedPoints, PointSource
from .sweep_order import DEEPEST, Cells, choose_crowd, sort_in_cells, sort_stars, turn_to_first

__all__ = [
    "DEEPEST",
    "Cells",
    "Discs",
    "Draping",
    "KnownTriangles",
    "LaidLines",
    "LocalTriangulation",
    "NodedLines",
    "NumberedPoints",
    "Outline",
    "PointSource",
    "Rings",
    "TileTriangles",
    "TilesProof",
    "are_in_box",
    "check_tiles",
    "choose_crowd",
    "choose_near",
    "find_around",
    "find_differing",
    "find_outermost",
    "find_outline",
    "find_rim",
    "find_skeleton",
    "find_triangles_at",
    "intersect",
    "list_segments_near",
    "list_sides",
    "node_base",
    "node_laid",
    "node_lines",
    "reduce_to_hull",
    "require_local",
    "sort_in_cells",
    "sort_stars",
    "triangulate_box",
    "turn_to_first",
    "widen",
]
