"""Points and lines become triangles: build, edit, query, check. Knows no files, no pictures."""

from ..base.lazy import lazy_names

# A small job starts at once, as it loads what it uses.
__getattr__, __dir__, __all__ = lazy_names(__name__)
