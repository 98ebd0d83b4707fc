"""Options: what callers give where a number, a flag or a TIN is needed."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import OptionError, PointsError
from .sentences import shown

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .arrays import Float64Array


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


def as_floats(values: Any) -> Float64Array | None:
    """Return numbers as an array; None if they are none, or none that a float can hold."""
    try:
        return np.asarray(values, np.float64)
    except (TypeError, ValueError, ArithmeticError):
        return None


def is_collection(given: Any) -> bool:
    """Tell whether there are items to go through: texts are none, nor arrays of one value."""
    return isinstance(given, Iterable) and not (
        isinstance(given, str | bytes) or getattr(given, "shape", None) == ()
    )


def as_flag(name: str, value: Any) -> bool:
    """Return a flag, or say what is none."""
    if not isinstance(value, bool | np.bool_):
        raise OptionError(name, value, "True or False")
    return bool(value)


def as_number(
    name: str,
    value: Any,
    what: str = "a finite number",
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    below: float = math.inf,
    most: float = math.inf,
    unit: str = "",
    or_none: bool = False,
) -> float:
    """Return a finite number within limits, which the refusal names.

    ``what`` and ``unit`` stand before and behind the limits; ``or_none`` says that None is allowed
    too, which callers look for themselves.

    Examples
    --------
    >>> as_number("tilt", 91, "an angle", least=0, most=90, unit="degrees")
    Traceback (most recent call last):
    tinsmith.base.errors.OptionError: Invalid tilt 91: it must be an angle from 0 to 90 degrees.
    """
    if not (is_finite_number(value) and above < value < below and least <= value <= most):
        words = [what, _describe_limits({">": above, ">=": least, "<": below, "<=": most}), unit]
        raise OptionError(name, value, " ".join(filter(None, words)), or_none=or_none)
    return float(value)


def as_length(name: str, value: Any, *, unit: str = "in CRS units", or_none: bool = False) -> float:
    """Return a finite number above 0."""
    return as_number(name, value, "a length", above=0, unit=unit, or_none=or_none)


def as_percentages(name: str, values: ArrayLike) -> Float64Array:
    """Return numbers from 0 to 100."""
    shares = as_floats(values)
    if shares is None or shares.ndim != 1 or not ((shares >= 0) & (shares <= 100)).all():
        raise OptionError(name, values, "a sequence of numbers from 0 to 100")
    return shares


def require_count(
    name: str, value: Any, *, least: int = 1, most: float = math.inf, or_none: bool = False
) -> None:
    """Refuse what is no whole number within limits."""
    if not (is_whole_number(value) and least <= value <= most) and not (or_none and value is None):
        allowed = f"a whole number {_describe_limits({'>=': least, '<=': most})}"
        raise OptionError(name, value, allowed, or_none=or_none)


def _describe_limits(limits: dict[str, float]) -> str:
    finite = {sign: f"{limit:,.12g}" for sign, limit in limits.items() if math.isfinite(limit)}
    if [*finite] == [">=", "<="]:
        return f"from {finite['>=']} to {finite['<=']}"
    return " and ".join(f"{sign} {limit}" for sign, limit in finite.items())


def require_positive(name: str, value: Any, *, what: str = "a length") -> None:
    """Refuse what is neither a finite number above 0 nor None."""
    if value is not None:
        as_number(name, value, what, above=0, unit="in CRS units", or_none=True)


def require_distance(name: str, value: Any) -> None:
    """Refuse what is no finite number from 0 on."""
    as_number(name, value, "a distance", least=0, unit="in CRS units")


def require_type(name: str, value: Any, kind: type, *, or_none: bool = False) -> None:
    """Refuse what is not of a class of the toolkit."""
    if not isinstance(value, kind) and not (or_none and value is None):
        raise OptionError(name, value, f"a {kind.__name__}", or_none=or_none)


def require_tin(tin: Any) -> None:
    """Refuse what has not the arrays of a TIN."""
    if isinstance(tin, type) or not (hasattr(tin, "triangles") and hasattr(tin, "neighbors")):
        raise PointsError(f"Invalid TIN {shown(tin)}: one made by triangulate is needed.")
