"""The text of a STEP file (ISO 10303-21): instances, numbers, texts, identifiers."""

from __future__ import annotations

import re
import string
import uuid
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ....base.arrays import AnyArray

_BATCH = 65_536
_DIGITS = string.digits + string.ascii_uppercase + string.ascii_lowercase + "_$"
"""Of identifiers in base 64."""

_LENGTH = 22
"""Letters of an identifier."""

_EXPONENT = re.compile(r"(\.\d+|\d)e([-+]\d+)")
_NO_CLOCK = "1970-01-01T00:00:00"
"""Time in the header: the same TIN gives the same bytes."""

NONE, DERIVED = "$", "*"
"""A value that is not given, and one that follows from others."""


class StepWriter:
    """Writes instances one after the other; each is called by its number."""

    def __init__(self, file: IO[str]) -> None:
        self._file = file
        self._count = 0

    def begin(self, schema: str, name: str) -> None:
        """Write the header, and begin the data."""
        self._file.write(
            "ISO-10303-21;\nHEADER;\n"
            "FILE_DESCRIPTION(('ViewDefinition [NotAssigned]'),'2;1');\n"
            f"FILE_NAME({quote(name)},'{_NO_CLOCK}',(''),(''),'tinsmith','tinsmith','');\n"
            f"FILE_SCHEMA(('{schema}'));\nENDSEC;\nDATA;\n"
        )

    def end(self) -> None:
        """End the data."""
        self._file.write("ENDSEC;\nEND-ISO-10303-21;\n")

    def add(self, entity: str, *values: str) -> str:
        """Write an instance of an entity; return what others call it."""
        return self.add_long(entity, [",".join(values)])

    def add_long(self, entity: str, parts: Iterable[str]) -> str:
        """Write an instance whose values come in parts; return what others call it."""
        self._count += 1
        self._file.write(f"#{self._count}={entity}(")
        for part in parts:
            self._file.write(part)
        self._file.write(");\n")
        return f"#{self._count}"


def quote(text: str) -> str:
    r"""Return a text in quotes, letters beyond ASCII by their numbers.

    Examples
    --------
    >>> print(quote("Böschung 'A'"))
    'B\X2\00F6\X0\schung ''A'''
    """
    return "'" + "".join(map(_encode, text)) + "'"


def _encode(letter: str) -> str:
    if letter in "'\\":
        return 2 * letter
    number = ord(letter)
    if 32 <= number < 127:
        return letter
    if number < 32:
        return " "
    return f"\\X2\\{number:04X}\\X0\\" if number < 2**16 else f"\\X4\\{number:08X}\\X0\\"


def format_real(value: float) -> str:
    """Return a number with every digit; STEP wants a point before an exponent.

    Examples
    --------
    >>> format_real(1e-06), format_real(1.5e20), format_real(4)
    ('1.E-06', '1.5E+20', '4.0')
    """
    return _turn_exponents(repr(float(value)))


def _turn_exponents(text: str) -> str:
    if "e" not in text:
        return text
    return _EXPONENT.sub(
        lambda found: f"{found[1]}{'' if '.' in found[1] else '.'}E{found[2]}", text
    )


def format_list(values: Iterable[str]) -> str:
    """Return a list of values."""
    return f"({','.join(values)})"


def format_rows(rows: AnyArray) -> Iterable[str]:
    """Yield the text of a list of rows of numbers, in parts."""
    form = f"({','.join(['%r'] * rows.shape[1])})"
    yield "("
    for start in range(0, len(rows), _BATCH):
        part = rows[start : start + _BATCH]
        text = ",\n".join([form] * len(part)) % tuple(part.ravel().tolist())
        yield (",\n" if start else "") + _turn_exponents(text)
    yield ")"


def make_identifier(*words: str) -> str:
    """Return an identifier in quotes, the same for the same words: 128 bits in base 64.

    Examples
    --------
    >>> make_identifier("site") == make_identifier("site"), len(make_identifier("site"))
    (True, 24)
    """
    number = uuid.uuid5(uuid.NAMESPACE_URL, "/".join(("tinsmith", *words))).int
    letters = [_DIGITS[number >> 6 * k & 63] for k in reversed(range(_LENGTH))]
    return f"'{''.join(letters)}'"
