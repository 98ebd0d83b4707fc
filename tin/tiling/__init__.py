"""Parts of a triangulation that is never in memory as a whole, each of them exact."""

from .boxes import are_in_box, list_sides, widen
from .circles import Discs
from .local_triangulation import LocalTriangulation, find_around, find_triangles_at, triangulate_box
from .proof import TilesProof, TileTriangles, check_tiles
from .skeleton import find_outermost, find_skeleton, reduce_to_hull
from .sources import NumberedPoints, PointSource

__all__ = [
    "Discs",
    "LocalTriangulation",
    "NumberedPoints",
    "PointSource",
    "TileTriangles",
    "TilesProof",
    "are_in_box",
    "check_tiles",
    "find_around",
    "find_outermost",
    "find_skeleton",
    "find_triangles_at",
    "list_sides",
    "reduce_to_hull",
    "triangulate_box",
    "widen",
]
