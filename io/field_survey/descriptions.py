"""Descriptions of shots: the codes in them, their line numbers and the marks at each."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from .styles import Meaning, Style

_NUMBERED = re.compile(r"(?P<number>\d*)(?![^\W_])(?P<rest>.*)", re.DOTALL)
_TIGHT = r"(?<=[\w*])[{0}]+(?=\S)|(?<!\S)[{0}]+(?=[^\W\d])"
"""A separator stands within a text, or before a word: EP1-B, EP1 -B; alone it parts nothing."""
_LONGEST, LONGEST_CODE = 2_000, 64
"""Letters of a description, and of a code, that are looked at."""


class Coded(NamedTuple):
    """One code of a shot."""

    code: str
    """As the table of codes writes it."""
    number: str
    """Of the line; "" if there is none."""
    marks: tuple[Meaning, ...] = ()
    """What its marks say, in their order."""
    words: tuple[str, ...] = ()
    """The marks as they stand there."""

    @property
    def name(self) -> str:
        """Name of the line."""
        return self.code + self.number


class Description(NamedTuple):
    """What is in a description."""

    codes: tuple[Coded, ...]
    """Empty if it begins with no known code."""
    unread: str = ""
    """The first word behind a code that is neither mark nor code; "" if there is none."""

    @property
    def n_words(self) -> int:
        """How many words are understood."""
        return sum(1 + bool(one.number) + len(one.marks) for one in self.codes)


@dataclass(frozen=True)
class Vocabulary:
    """The words that descriptions are read by: codes, and the marks of a style."""

    codes: Collection[str]
    """Upper case, unless the style is exact."""
    style: Style

    def parse(self, text: str) -> Description:
        """Read a description."""
        words = self._split(text)
        if not words:
            return Description(())
        if self.style.place == "before":
            return self._parse_before(words)
        first = self._match_code(words[0])
        if first is None:
            return Description(())
        codes: list[Coded] = [first[0]]
        queue = [*first[1], *words[1:]]
        unread = self._parse_behind(queue, codes)
        return Description(tuple(codes), unread)

    def find_first_word(self, text: str) -> str:
        """Return the word that a description begins with; "" if there is none."""
        return next(iter(self._split(text)), "")

    def _split(self, text: str) -> list[str]:
        """Return the words before any remark."""
        text = re.split(rf"[\"'{re.escape(self.style.comments)}]", text[:_LONGEST], maxsplit=1)[0]
        if not self.style.is_exact:
            text = text.upper()
        if self.style.separators:
            text = re.sub(_TIGHT.format(re.escape(self.style.separators)), " ", text)
        words = (text.replace("*", " * ") if "*" in self.style.marks else text).split()
        if not self.style.separators:
            return words
        alone = (i for i, word in enumerate(words) if not word.strip(self.style.separators))
        return words[: next(alone, len(words))]  # behind a separator alone follows a remark

    def _parse_behind(self, words: list[str], codes: list[Coded]) -> str:
        """Add marks and further codes; return the first word that is neither."""
        words.reverse()
        while words:
            word = words.pop()
            one = codes[-1]
            if word.isdecimal() and not one.number and not one.marks:
                codes[-1] = one._replace(number=word)
            elif (meaning := self.style.find_meaning(word)) is not None:
                codes[-1] = one._replace(marks=(*one.marks, meaning), words=(*one.words, word))
            elif (found := self._match_code(word)) is not None:
                codes.append(found[0])
                words.extend(reversed(found[1]))
            else:
                return word if not one.marks or self.style.separators else ""
        return ""

    def _parse_before(self, words: Sequence[str]) -> Description:
        """Read marks that stand before the code that they belong to."""
        codes: list[Coded] = []
        marks: tuple[Meaning, ...] = ()
        given: tuple[str, ...] = ()
        for word in words:
            if word.isdecimal() and codes and not codes[-1].number and not marks:
                codes[-1] = codes[-1]._replace(number=word)
            elif (meaning := self.style.find_meaning(word)) is not None:
                marks, given = (*marks, meaning), (*given, word)
            elif (found := self._match_code(word)) is not None and not found[1]:
                codes.append(found[0]._replace(marks=marks, words=given))
                marks, given = (), ()
            else:
                return Description(tuple(codes), word if codes else "")
        return Description(tuple(codes), given[0] if codes and given else "")

    def _match_code(self, word: str) -> tuple[Coded, list[str]] | None:
        """Return the longest code that begins a word, with its number, and what follows in it."""
        for length in range(min(len(word), LONGEST_CODE), 0, -1):
            if word[:length] not in self.codes:
                continue
            rest = _NUMBERED.fullmatch(word[length:])
            if rest is not None:
                return Coded(word[:length], rest["number"]), [rest["rest"]] if rest["rest"] else []
        return None
