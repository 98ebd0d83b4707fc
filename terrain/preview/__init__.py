"""Preview: a surface in 3D as a picture or in a window."""

from .picture import preview

__all__ = ["preview"]
