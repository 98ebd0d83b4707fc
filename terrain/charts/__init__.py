"""Charts: distributions and comparisons as flat pictures."""

from .figures import PICTURE_SUFFIXES, save_figure

__all__ = ["PICTURE_SUFFIXES", "save_figure"]
