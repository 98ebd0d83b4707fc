"""A surface at several scales: a quadtree of simplified parts that fit without a crack.

The finest nodes are the surface cut along the sides of squares; each other node is simplified from
its four children. On every side of a square vertices are chosen by the elevations along it alone,
so that the nodes of a level have the same ones on both sides.
"""

from .cutting import Mesh, cut
from .nodes import find_tolerance, join_nodes, make_finest, simplify
from .quadtree import Node, Quadtree

__all__ = [
    "Mesh",
    "Node",
    "Quadtree",
    "cut",
    "find_tolerance",
    "join_nodes",
    "make_finest",
    "simplify",
]
