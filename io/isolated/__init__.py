"""Native readers of untrusted files, run in a child process with limits of time and memory."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
