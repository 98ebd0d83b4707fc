"""Preview: a surface in 3D as a page, as a picture or in a window."""

from .presentation import Preview, preview

__all__ = ["Preview", "preview"]
