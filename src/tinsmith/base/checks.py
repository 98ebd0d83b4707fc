"""Options: what callers give where a number, a flag or a TIN is needed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .errors import OptionError, PointsError
from .sentences import shown

__all__ = [
    "as_flag",
    "as_number",
    "is_finite_number",
    "is_whole_number",
    "require_count",
    "require_distance",
    "require_positive",
    "require_tin",
    "require_type",
]


def is_whole_number(value: Any) -> bool:
    """Tell whether a value is a whole number; True and False are none."""
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def is_finite_number(value: Any) -> bool:
    """Tell whether a value is a real number that a float can hold; True and False are none."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        return False
    try:
        return math.isfinite(float(value))
    except OverflowError:
        return False


def as_flag(name: str, value: Any) -> bool:
    """Return a flag, or say what is none."""
    if not isinstance(value, bool | np.bool_):
        raise OptionError(name, value, "True or False")
    return bool(value)


def as_number(
    name: str,
    value: Any,
    allowed: str,
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
) -> float:
    """Return a finite number within limits; ``allowed`` says in words what they are."""
    if not (is_finite_number(value) and value > above and least <= value <= most):
        raise OptionError(name, value, allowed)
    return float(value)


def require_count(name: str, value: Any, *, or_none: bool = False) -> None:
    """Refuse what is no whole number above 0."""
    if not (is_whole_number(value) and value >= 1) and not (or_none and value is None):
        raise OptionError(name, value, "a whole number >= 1", or_none=or_none)


def require_positive(name: str, value: Any, *, what: str = "a length") -> None:
    """Refuse what is neither a finite number above 0 nor None."""
    if value is not None and not (is_finite_number(value) and value > 0):
        raise OptionError(name, value, f"{what} > 0 in CRS units", or_none=True)


def require_distance(name: str, value: Any) -> None:
    """Refuse what is no finite number from 0 on."""
    if not (is_finite_number(value) and value >= 0):
        raise OptionError(name, value, "a distance >= 0 in CRS units")


def require_type(name: str, value: Any, kind: type, *, or_none: bool = False) -> None:
    """Refuse what is not of a class of the toolkit."""
    if not isinstance(value, kind) and not (or_none and value is None):
        raise OptionError(name, value, f"a {kind.__name__}", or_none=or_none)


def require_tin(tin: Any) -> None:
    """Refuse what has not the arrays of a TIN."""
    if isinstance(tin, type) or not (hasattr(tin, "triangles") and hasattr(tin, "neighbors")):
        raise PointsError(f"Invalid TIN {shown(tin)}: one made by triangulate is needed.")
