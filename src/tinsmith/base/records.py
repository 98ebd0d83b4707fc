"""Records: values that were stored, which may come from anyone, held against their classes.

A class says by its annotations what its fields are, and by a method ``_require_sound`` how they
belong together.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from functools import cache
from types import UnionType
from typing import Any, Literal, Union, cast, get_args, get_origin, get_type_hints

import numpy as np

from . import arrays, policies, types
from .errors import PointsError

_NAMES = {**vars(types), **vars(arrays), **vars(policies)}
"""What annotations name everywhere."""


def require(is_so: Any, what: str) -> None:
    """Raise PointsError unless something is so."""
    if not is_so:
        raise PointsError(f"The record does not fit the TIN ({what}).")


def require_fields(value: Any, names: Mapping[str, Any]) -> None:
    """Require of each field of a value what its annotation says, dtypes of arrays included.

    ``value`` is a dataclass or a named tuple; ``names`` are classes that its annotations name.
    """
    own = cast("Hashable", type(value))
    for name, kind in _find_annotations(own, tuple(names.items())).items():
        if name in type(value).__annotations__:
            require(_is_kind(getattr(value, name), kind), f"{name} of {type(value).__name__}")


@cache
def _find_annotations(kind: Hashable, names: tuple[tuple[str, Any], ...]) -> dict[str, Any]:
    return get_type_hints(kind, None, _NAMES | dict(names))


def _is_kind(value: Any, kind: Any) -> bool:
    origin, args = get_origin(kind), get_args(kind)
    if origin is np.ndarray:
        (dtype,) = get_args(args[1])
        return isinstance(value, np.ndarray) and value.dtype == dtype
    if origin is Literal:
        return type(value) is str and value in args
    if origin in (Union, UnionType):
        return any(_is_kind(value, one) for one in args)
    if origin in (tuple, list):
        return type(value) is origin and all(_is_kind(one, args[0]) for one in value)
    if origin is Sequence:
        return isinstance(value, list | tuple) and all(_is_kind(one, args[0]) for one in value)
    if origin in (dict, Mapping):
        rows = value.items() if isinstance(value, dict) else [(None, None)]
        return all(_is_kind(key, args[0]) and _is_kind(one, args[1]) for key, one in rows)
    return kind is Any or type(value) is kind


def require_indices(array: Any, end: int, what: str, *, least: int = 0) -> None:
    """Require an array of whole numbers from ``least`` up to, not including, ``end``."""
    is_array = isinstance(array, np.ndarray) and array.ndim == 1 and array.dtype.kind == "i"
    require(is_array and (not len(array) or (array.min() >= least and array.max() < end)), what)


def require_finite(array: Any, shape: tuple[int, ...], what: str) -> None:
    """Require finite numbers, so many of them."""
    require(array.shape == shape and np.isfinite(array).all(), what)


def require_offsets(offsets: Any, count: int, end: int, what: str) -> None:
    """Require the bounds of so many parts that together have ``end`` items."""
    require_indices(offsets, end + 1, what)
    require(len(offsets) == count + 1 and offsets[0] == 0 and offsets[-1] == end, what)
    require((np.diff(offsets) >= 0).all(), what)
