"""What is derived from a TIN: slope, 3D models, previews, charts. Knows no files."""

from ..base.lazy import lazy_names

# A small job starts at once, as it loads what it uses.
__getattr__, __dir__, __all__ = lazy_names(__name__)
