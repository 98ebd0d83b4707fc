"""Peers in C++: CGAL and Delaunay32, each compiled when it is needed."""

from .build import PeerMissingError, build_harness

__all__ = ["PeerMissingError", "build_harness"]
