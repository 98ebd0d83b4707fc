"""Charts: distributions and comparisons as flat pictures."""

from .figures import save_figure

__all__ = ["save_figure"]
