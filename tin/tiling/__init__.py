"""Parts of a triangulation that is never in memory as a whole, each of them exact."""

from .local_triangulation import LocalTriangulation, triangulate_box

__all__ = ["LocalTriangulation", "triangulate_box"]
