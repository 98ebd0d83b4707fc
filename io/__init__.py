"""Readers, writers and the registry of formats."""

from ..base.lazy import lazy_names

# The processes that read files for native libraries start without what they do not use.
__getattr__, __dir__, __all__ = lazy_names(__name__)
