"""What surveyors record in the field: codes of lines at their points."""

from . import field_codes

__all__ = ["field_codes"]
