"""What surveyors record in the field: codes of lines at their points."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from . import field_codes
else:  # a type checker takes every name for one that such a __getattr__ has
    from ..._lazy import lazy_names

    __getattr__, __dir__ = lazy_names(__name__, {".field_codes": ()})

__all__ = ["field_codes"]
