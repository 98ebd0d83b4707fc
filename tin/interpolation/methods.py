"""Methods of interpolation by name, and what is done outside the surface."""

from __future__ import annotations

from typing import Any, Literal, get_args

from ...errors import OptionError
from ..validation.options import is_one_of, shown

__all__ = ["EXTRAPOLATIONS", "METHODS", "Extrapolation", "Method", "require_choice"]

Method = Literal["linear", "nearest", "laplace", "natural", "c1"]
Extrapolation = Literal["nearest"]

METHODS: tuple[str, ...] = get_args(Method)
EXTRAPOLATIONS: tuple[str, ...] = get_args(Extrapolation)


def require_choice(option: str, value: Any, allowed: tuple[str, ...]) -> None:
    """Refuse what is none of a few words.

    Raises
    ------
    OptionError
    """
    if not is_one_of(value, allowed):
        given = value if isinstance(value, str) else shown(value)
        raise OptionError(option, given, allowed=f"one of {', '.join(allowed)}")
