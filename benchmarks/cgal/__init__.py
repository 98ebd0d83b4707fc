"""CGAL's harness in C++, compiled when it is needed."""

from .build import CgalMissingError, harness

__all__ = ["CgalMissingError", "harness"]
