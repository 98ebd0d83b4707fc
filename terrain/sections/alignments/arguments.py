"""Numbers of callers: one, or one for each station or point of intersection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.checks import as_floats
from ....base.errors import OptionError, PointsError
from ....base.sentences import counted
from ....tin import validation

if TYPE_CHECKING:
    from ....base.arrays import Float64Array


def as_numbers(name: str, given: Any, count: int | None = None) -> Float64Array:
    """Return finite numbers as a row; one number is repeated if as many as ``count`` are wanted.

    Raises OptionError if they are none, not finite, or not as many.
    """
    found = as_floats(given)
    rule = "finite numbers" if count is None else f"a finite number, or {count} of them"
    if found is None or found.ndim > 1 or not np.isfinite(found).all():
        raise OptionError(name, given, allowed=rule)
    values = np.atleast_1d(found)
    if count is None:
        return values
    if len(values) not in (1, count):
        raise OptionError(name, len(values), allowed=f"1 or {count}", what=f"number of {name}")
    return np.broadcast_to(values, count).copy()


def as_places(points: Any) -> Float64Array:
    """Return the eastings and northings of points, (k, 2), that may have elevations, too.

    Raises PointsError if they are none, or not finite.
    """
    plain = as_floats(points) if isinstance(points, list | tuple | np.ndarray) else None
    if plain is not None and plain.ndim == 2:
        points = plain[:, :2]
    xy = validation.as_places(points)[0]
    lost = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if len(lost):
        row = int(lost[0])
        where = f"first: row {row}, {tuple(xy[row].tolist())}"
        raise PointsError(f"{counted(len(lost), 'point')} not finite ({where}).", rows=lost[:5])
    return xy
