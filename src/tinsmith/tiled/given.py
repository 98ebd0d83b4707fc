"""Arrays that a caller gave, which tasks read from the folder of the run."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.atomic import replacing
from .chunks import Chunk, write_chunk
from .store import NO_POINTS, PointStore, load_chunks, save_chunks

if TYPE_CHECKING:
    from pathlib import Path

    from ..base.arrays import AnyArray, Float64Array
    from ..base.types import Bounds
    from ..tin.tiling import NumberedPoints

_ARRAYS, _CHUNKS = "arrays.npz", "chunks.npy"
_PLACES_OF_A_CHUNK = 1_000_000


class Given:
    """Arrays by name, of any size: options of a product that are not written into the manifest.

    Parameters
    ----------
    value : object
        What they were taken from, for the process that joins tiles.
    **arrays
    """

    def __init__(self, value: Any = None, **arrays: AnyArray) -> None:
        self.value = value
        self.arrays = arrays

    def describe(self) -> str:
        """Return a text that tells them from others."""
        digest = hashlib.blake2b(digest_size=16)
        for name, array in self.arrays.items():
            digest.update(f"{name} {array.dtype.str} {array.shape}".encode())
            digest.update(np.ascontiguousarray(array).data)
        return digest.hexdigest()

    def store(self, folder: Path) -> None:
        """Write them into a folder of their own, unless they are there."""
        if not (folder / _ARRAYS).exists():
            folder.mkdir(exist_ok=True)
            with replacing(folder / _ARRAYS) as file:
                np.savez(file, **self.arrays)  # type: ignore[arg-type]


@lru_cache(maxsize=1)
def load_given(folder: Path, description: str) -> dict[str, AnyArray]:
    """Return what :meth:`Given.store` wrote, which is kept for the next task."""
    del description  # another one is another entry
    with np.load(folder / _ARRAYS) as found:
        return dict(found)


class GivenPlaces(Given):
    """Places, (k, 2), stored as points are: a task reads those near its tile.

    Parameters
    ----------
    xy : (k, 2) float64 array
        NaN lies nowhere.
    value : object
    """

    def __init__(self, xy: Float64Array, value: Any = None) -> None:
        super().__init__(value, xy=xy)

    def store(self, folder: Path) -> None:
        """Write the places that lie anywhere as chunks, unless they are there."""
        if (folder / _CHUNKS).exists():
            return
        folder.mkdir(exist_ok=True)
        xy = self.arrays["xy"]
        known = np.flatnonzero(~np.isnan(xy).any(axis=1))
        chunks: list[Chunk] = []
        for start in range(0, len(known), _PLACES_OF_A_CHUNK):
            rows = known[start : start + _PLACES_OF_A_CHUNK]
            points = np.column_stack([xy[rows], np.zeros(len(rows))])
            chunks.append(write_chunk(folder, 0, len(chunks), points, rows))
        save_chunks(folder / _CHUNKS, chunks)


def read_places(folder: Path, box: Bounds) -> NumberedPoints:
    """Return the places in a closed box, with their rows among all; elevations are 0."""
    return PointStore(load_chunks(folder / _CHUNKS, folder), NO_POINTS).read_box(box)
