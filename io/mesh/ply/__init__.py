"""PLY: header and body of a file, and what they say of a surface."""

from .file import SurfaceBlocks, read, write, write_blocks

__all__ = ["SurfaceBlocks", "read", "write", "write_blocks"]
