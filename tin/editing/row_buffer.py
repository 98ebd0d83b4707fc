"""Growing: an array whose rows change and become more, with nothing copied for a few of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["GrowingRows"]

Scalar = TypeVar("Scalar", bound=np.generic)

_MANY = 4096
"""So many changes kept one by one take as long as a copy of a million rows."""


class GrowingRows(Generic[Scalar]):
    """An array with rows to come, and changes.

    Parameters
    ----------
    rows : array
        Never changed; copied once it must be.
    """

    def __init__(self, rows: NDArray[Scalar]) -> None:
        self._head = rows
        self._is_own = False
        self._changed: dict[int, NDArray[Scalar]] = {}
        self._room = np.empty((0, *rows.shape[1:]), rows.dtype)
        self._size = 0

    def __len__(self) -> int:
        return len(self._head) + self._size

    def extend(self, more: NDArray[Scalar]) -> None:
        """Add rows."""
        size = self._size + len(more)
        if size > len(self._room):
            room = np.empty((2 * size, *self._room.shape[1:]), self._room.dtype)
            room[: self._size] = self._tail
            self._room = room
        self._room[self._size : size] = more
        self._size = size

    def at(self, row: int) -> NDArray[Scalar]:
        """Return a row."""
        if row >= len(self._head):
            added: NDArray[Scalar] = self._tail[row - len(self._head)]
            return added
        own: NDArray[Scalar] = self._changed.get(row, self._head[row])
        return own

    def take(self, rows: list[int]) -> NDArray[Scalar]:
        """Return rows as an array."""
        return np.array([self.at(row) for row in rows])

    def put(self, row: int, values: NDArray[Scalar]) -> None:
        """Change a row; the values are kept, and must not change any more."""
        if row >= len(self._head):
            self._tail[row - len(self._head)] = values
        elif self._is_own:
            self._head[row] = values
        else:
            self._changed[row] = values
            if len(self._changed) > _MANY:
                self.values()

    def values(self) -> NDArray[Scalar]:
        """Return all rows, not to be changed by the caller."""
        if self._size or self._changed:
            self._head = np.concatenate([self._head, self._tail])
            for row, values in self._changed.items():
                self._head[row] = values
            self._is_own = True
            self._changed = {}
            self._size = 0
        return self._head

    @property
    def _tail(self) -> NDArray[Scalar]:
        return self._room[: self._size]
