"""What passes between a program and its reading child: JSON and plain arrays, nothing pickled.

A message is a length (8 bytes, little-endian), that many bytes of JSON, and then the bytes of each
array that the JSON announces by name, type and shape.
"""

from __future__ import annotations

import json
import re
import struct
from typing import IO, Any, NamedTuple

import numpy as np

_LENGTH = struct.Struct("<Q")
_PLAIN_TYPE = re.compile(r"[<>|][biuf][1248]")
_LONGEST_AXES = 8


class Answer(NamedTuple):
    """A value that JSON can hold, and arrays of numbers beside it."""

    value: Any
    arrays: dict[str, np.ndarray[Any, Any]]


class Refusal(Exception):
    """A whole sentence about a file whose content was understood and is not what is needed."""


class BrokenMessageError(Exception):
    """The other side ended, or sent what is no message."""


def send(stream: IO[bytes], answer: Answer) -> None:
    """Write a message."""
    arrays = {name: np.ascontiguousarray(array) for name, array in answer.arrays.items()}
    announced = {name: [array.dtype.str, list(array.shape)] for name, array in arrays.items()}
    head = json.dumps({"value": answer.value, "arrays": announced}).encode()
    stream.write(_LENGTH.pack(len(head)))
    stream.write(head)
    for array in arrays.values():
        if array.size:
            stream.write(array.data.cast("B"))
    stream.flush()


def receive(stream: IO[bytes], *, most_bytes: int) -> Answer:
    """Read a message of at most so many bytes.

    Raises
    ------
    BrokenMessageError
        If the stream ends, or its content is no message.
    """
    (length,) = _LENGTH.unpack(_receive_bytes(stream, _LENGTH.size))
    if length > most_bytes:
        raise BrokenMessageError
    try:
        head = json.loads(bytes(_receive_bytes(stream, length)))
        announced = {str(name): _reserve_array(*how) for name, how in head["arrays"].items()}
        value = head["value"]
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise BrokenMessageError from error
    if sum(array.nbytes for array in announced.values()) > most_bytes:
        raise BrokenMessageError
    for array in announced.values():
        if array.size:
            _fill(stream, array.data.cast("B"))
    return Answer(value, announced)


def _reserve_array(type_name: str, shape: list[int]) -> np.ndarray[Any, Any]:
    """Reserve an array; the system gives it memory when it is filled."""
    plain = _PLAIN_TYPE.fullmatch(type_name) is not None
    if not plain or len(shape) > _LONGEST_AXES or any(type(n) is not int or n < 0 for n in shape):
        raise BrokenMessageError
    try:
        return np.empty(shape, type_name)
    except MemoryError as error:
        raise BrokenMessageError from error


def _receive_bytes(stream: IO[bytes], length: int) -> memoryview:
    content = memoryview(bytearray(length))
    _fill(stream, content)
    return content


def _fill(stream: IO[bytes], target: memoryview) -> None:
    done = 0
    while done < len(target):
        count = stream.readinto(target[done:])  # type: ignore[attr-defined]
        if not count:
            raise BrokenMessageError
        done += count
