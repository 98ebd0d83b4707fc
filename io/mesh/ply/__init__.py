"""PLY: header and body of a file, and what they say of a surface."""

from .file import read, write

__all__ = ["read", "write"]
