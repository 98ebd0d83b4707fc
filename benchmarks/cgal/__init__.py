"""CGAL's harness in C++, compiled when it is needed."""

from .build import CgalMissingError, build_harness

__all__ = ["CgalMissingError", "build_harness"]
