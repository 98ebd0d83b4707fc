"""What surveyors record in the field: codes of lines at their points."""

from ...base.lazy import lazy_names

__getattr__, __dir__, __all__ = lazy_names(__name__)
