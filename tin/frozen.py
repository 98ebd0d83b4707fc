"""Frozen values: their arrays are read-only, and stay so in copies and pickles."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

__all__ = ["Frozen", "seal"]

Array = TypeVar("Array", bound="np.ndarray[Any, Any]")


def seal(array: Array) -> Array:
    """Make an array read-only."""
    array.flags.writeable = False
    return array


class Frozen:
    """Base of frozen dataclasses that hold arrays, alone or in named tuples.

    What is computed once and kept in the instance (``cached_property``) is left out of pickles.
    """

    def __post_init__(self) -> None:
        for value in self.__getstate__().values():
            for array in value if isinstance(value, tuple) else (value,):
                if isinstance(array, np.ndarray):
                    seal(array)

    def __getstate__(self) -> dict[str, Any]:
        fields: dict[str, Any] = type(self).__dict__["__dataclass_fields__"]
        return {name: self.__dict__[name] for name in fields}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        Frozen.__post_init__(self)
