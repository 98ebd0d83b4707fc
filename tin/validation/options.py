"""Options: what callers give where a number or one word of a few is needed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...errors import PointsError, TinsmithError

__all__ = [
    "as_flag",
    "is_finite_number",
    "is_one_of",
    "is_whole_number",
    "require_one_of",
    "require_tin",
    "shown",
]

_LONGEST = 60
_SHOWN = 5


def shown(value: Any) -> str:
    """Return a value as a sentence can hold it: short, and NumPy's numbers as plain ones."""
    if isinstance(value, np.integer | np.floating):
        value = value.item()
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    if type(value) in (list, tuple) and value:
        more = ", ..." if len(value) > _SHOWN else ""
        return _shortened(f"[{', '.join(shown(item) for item in value[:_SHOWN])}{more}]")
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > 200:
        return f"{'-' if value < 0 else ''}2^{value.bit_length() - 1} or more"
    try:
        text = " ".join(repr(value).split())
    except Exception:
        text = f"a {type(value).__name__}"
    return _shortened(text)


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."


def is_one_of(value: Any, allowed: Sequence[str]) -> bool:
    """Tell whether a value is one of a few words."""
    return isinstance(value, str) and value in allowed


def require_one_of(
    name: str, value: Any, allowed: Sequence[str], error: type[TinsmithError] = PointsError
) -> None:
    """Refuse an option that is none of the words allowed."""
    if not is_one_of(value, allowed):
        raise error(f"Invalid {name} {shown(value)}: one of {', '.join(allowed)}.")


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
        raise PointsError(f"Invalid {name} {shown(value)}: True or False is needed.")
    return bool(value)


def require_tin(tin: Any) -> None:
    """Refuse what has not the arrays of a TIN."""
    if isinstance(tin, type) or not (hasattr(tin, "triangles") and hasattr(tin, "neighbors")):
        raise PointsError(f"Invalid TIN {shown(tin)}: one made by triangulate is needed.")
