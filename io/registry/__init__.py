"""Formats: what each is, which are known, and the content that shows them."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
