"""The text of an archive: words, quoted texts, braces, and blocks of numbers."""

from __future__ import annotations

import math
import re
from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE, counted

if TYPE_CHECKING:
    from ....base.arrays import Float64Array

_COMMENT = re.compile(r'("(?:\\.|[^"\\\n])*")|//[^\n]*')
_TOKEN = re.compile(r'"((?:\\.|[^"\\\n])*)"|([{}])|([^\s{}"]+)|(")')
_QUOTED = re.compile(r'"(?:\\.|[^"\\\n])*"')
_ESCAPED = re.compile(r"\\(.)")
_HEXADECIMAL = re.compile(r"[-+]?0[xX][0-9a-fA-F]*\.?[0-9a-fA-F]*[pP][-+]?[0-9]{1,5}", re.ASCII)
_DECIMAL = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?", re.ASCII)
_SHOWN = 40


class Token(NamedTuple):
    """A word of an archive."""

    text: str
    at: int
    """Where it begins."""
    is_quoted: bool = False

    @property
    def word(self) -> str:
        """The word in small letters; empty for a quoted text, which is no keyword."""
        return "" if self.is_quoted else self.text.lower()


class Scanner:
    """The words of a text, one after the other, comments left out.

    Attributes
    ----------
    text : str
    at : int
        Where the next word is looked for.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self.at = 0

    @classmethod
    def of(cls, content: bytes) -> Scanner:
        """Return it of the bytes of a file, in the encodings that 12d Model writes."""
        text = decode(content).replace("\r\n", "\n")
        if "//" in text:
            text = _COMMENT.sub(lambda found: found[1] or "", text)
        return cls(text)

    def take(self) -> Token | None:
        """Return the next word, or None at the end."""
        found = _TOKEN.search(self.text, self.at)
        if found is None:
            self.at = len(self.text)
            return None
        self.at = found.end()
        if found[4]:
            raise self.describe_fault(found.start(), "a text in quotes does not end")
        if found[1] is not None:
            return Token(_ESCAPED.sub(r"\1", found[1]), found.start(), is_quoted=True)
        return Token(found[2] or found[3], found.start())

    def peek(self) -> Token | None:
        """Return the next word, and stay before it."""
        at = self.at
        token = self.take()
        self.at = at
        return token

    def take_brace(self) -> bool:
        """Pass an opening brace, if that is what comes next; return whether it is."""
        token = self.peek()
        if token is None or token.word != "{":
            return False
        self.take()
        return True

    def skip_block(self, what: str) -> None:
        """Pass a block, of which the opening brace was passed, with all blocks in it."""
        start, depth = self.at, 1
        while depth:
            token = self.take()
            if token is None:
                raise self.describe_fault(start, f"the block of {what} does not end")
            depth += {"{": 1, "}": -1}.get(token.word, 0)

    def take_rows(self, what: str, n_columns: int) -> Float64Array:
        """Return the rows of a block of numbers; ``null`` is NaN, quoted texts are left out.

        Parameters
        ----------
        what : str
            The block, for a sentence.
        n_columns : int

        Raises
        ------
        ReadError
            If the block does not end, a word is no number, or the numbers fill no rows.
        """
        start = self.at
        numbers = self.take_numbers(what)
        if len(numbers) % n_columns:
            raise self.describe_fault(
                start,
                f"{what} has {counted(len(numbers), 'number')}, which are no rows of {n_columns}",
            )
        return numbers.reshape(-1, n_columns)

    def take_numbers(self, what: str) -> Float64Array:
        """Return the numbers of a block, as :meth:`take_rows`."""
        start = self.at
        stop = self.text.find("}", start)
        if stop < 0:
            raise self.describe_fault(start, f"the block of {what} does not end")
        self.at = stop + 1
        body = self.text[start:stop]
        if '"' in body:
            body = _QUOTED.sub(" ", body)
        words = body.split()
        try:
            found = np.array(words, np.float64)
        except (ValueError, OverflowError):
            found = np.empty(0)
        else:
            if np.isfinite(found).all() and "_" not in body:  # "nan" and "1_0" are no numbers
                return found
        return np.array([self._parse(word, start) for word in words], np.float64)

    def _parse(self, word: str, start: int) -> float:
        if word.lower() == "null":
            return math.nan
        value = math.inf
        if _DECIMAL.fullmatch(word):
            value = float(word)
        elif _HEXADECIMAL.fullmatch(word):
            with suppress(OverflowError, ValueError):
                value = float.fromhex(word)
        if math.isfinite(value):
            return value
        at = self.text.find(word, start)
        raise self.describe_fault(at, f"'{word[:_SHOWN]}' is no number that 64 bits hold")

    def describe_fault(self, at: int, what: str) -> ReadError:
        """Return the error of a place in the text."""
        line = self.text.count("\n", 0, at) + 1
        return ReadError(f"{FILE}, line {line}: {what}.", lines=[line])


def decode(content: bytes) -> str:
    """Return the text of an archive: UTF-16 or UTF-8 with a mark, UTF-8, else Latin-1."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16", "replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")
