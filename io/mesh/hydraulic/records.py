"""Records of Fortran's unformatted files: the number of bytes stands before and behind each."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Literal

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE, counted

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import IO

    from ....base.arrays import AnyArray

_MARK = 4
"""Bytes of a record's length."""


class RecordReader:
    """Records of a file, one after the other.

    Attributes
    ----------
    content : bytes
    order : {">", "<"}
        The order of bytes.
    at : int
        Where the next record begins.
    """

    def __init__(self, content: bytes, order: Literal[">", "<"]) -> None:
        self.content = content
        self.order = order
        self.at = 0

    def take(self, what: str, size: int | None = None) -> bytes:
        """Return the next record.

        Parameters
        ----------
        what : str
            What it holds, for a sentence.
        size : int, optional
            Bytes that it must have.

        Raises
        ------
        ReadError
            If the file ends in it, its two lengths differ, or it has another size.
        """
        start = self.at + _MARK
        if start > len(self.content):
            raise ReadError(f"{FILE} ends before {what}.")
        (length,) = struct.unpack_from(f"{self.order}i", self.content, self.at)
        stop = start + length
        if length < 0 or stop + _MARK > len(self.content):
            raise ReadError(
                f"{FILE} ends within {what}: the record has {length:,} bytes, and "
                f"{counted(len(self.content) - start, 'byte')} are left."
            )
        (again,) = struct.unpack_from(f"{self.order}i", self.content, stop)
        if again != length:
            raise ReadError(
                f"{FILE} is damaged: the record of {what} has {length:,} bytes by the number "
                f"before it, and {again:,} by the one behind it."
            )
        if size is not None and length != size:
            raise ReadError(
                f"{FILE} is damaged: the record of {what} has {length:,} bytes, not {size:,}."
            )
        self.at = stop + _MARK
        return self.content[start:stop]

    def take_integers(self, what: str, count: int) -> AnyArray:
        """Return the whole numbers of the next record."""
        return np.frombuffer(self.take(what, 4 * count), f"{self.order}i4").astype(np.int64)


def write_record(file: IO[bytes], content: bytes) -> None:
    """Write a record, the bytes of its length in the order of large numbers first."""
    mark = struct.pack(">i", len(content))
    file.write(mark)
    file.write(content)
    file.write(mark)


def list_marks(frames: AnyArray) -> Iterator[tuple[AnyArray, int]]:
    """Yield the lengths that stand about the records of frames, and the bytes between them.

    Parameters
    ----------
    frames : structured array
        With fields ``before0``, ``record0``, ``behind0``, ``before1`` and so on.
    """
    names = frames.dtype.names or ()
    for before, record, behind in zip(names[::3], names[1::3], names[2::3], strict=True):
        size = frames.dtype[record].itemsize
        yield frames[before], size
        yield frames[behind], size
