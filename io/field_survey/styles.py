"""Styles of field codes: the words that begin, end, close and bend a line, and what parts them.

Each style says where its words are from:

- ``words``: what crews write whatever the program; the default.
- ``dash``, ``slash``, ``dot``: the same words, parted by one more letter: EP1-B, EP1/B, EP1.B.
- ``star``: EP1* begins a new line; ``star-end``: EP1* ends the line.
- ``civil3d``: a linework code set of Autodesk Civil 3D with the codes of its User's Guide: B begin,
  C continue, E end, BC and EC curves, RECT; and of its survey exercises: BEG, END, CLS, BCV and
  ECV; behind ``/`` follows a comment.
- ``carlson``: Carlson Field to Finish: +7 and -7 of PointCAD, PC and PT curves, CLO; not verified
  against its manual.
- ``trimble``: control codes of Trimble Business Center as LISCAD lists them: ST, END, CLOSE,
  CLSRECT, SA and EA arcs that leave their leg as a tangent, SC and EC curves.
- ``leica``: free codes of Leica instruments as n4ce lists them: CS and CE curves, TS and TE tangent
  ones, P close, N new line, X not in the surface.
- ``cg``: C&G (now Carlson): BL, EL, CL, PC and PT tangent curves, OC at the ends of others.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, TypeAlias, get_args

from ...base.errors import choice
from ...base.policies import CodeStyle

__all__ = ["COMMENTS", "MARKS", "MEANINGS", "STYLES", "Meaning", "Style", "find_style"]

Meaning: TypeAlias = Literal[
    "begin",
    "end",
    "close",
    "continue",
    "begin_curve",
    "begin_tangent_curve",
    "end_curve",
    "toggle_curve",
    "rectangle",
    "exclude",
    "other",
]
"""What a word behind a code says; ``other`` is known, and not applied."""

MEANINGS: tuple[Meaning, ...] = get_args(Meaning)

MARKS: Mapping[str, Meaning] = {
    **dict.fromkeys(("B", "BEG", "BEGIN", "ST", "START"), "begin"),
    **dict.fromkeys(("E", "END"), "end"),
    **dict.fromkeys(("C", "CLS", "CLO", "CLOSE", "X"), "close"),
}
"""Marks behind a code that begin, end and close a line in any style of plain words."""

_CURVES: Mapping[str, Meaning] = {
    "BC": "begin_curve",
    "EC": "end_curve",
    "PC": "begin_tangent_curve",
    "PT": "end_curve",
    "RECT": "rectangle",
}
_BEGIN_END: Mapping[str, Meaning] = {word: MARKS[word] for word in ("B", "BEG", "E", "END")}

COMMENTS = ",;(/"
"""A remark stands behind one of these, or in quotes."""


@dataclass(frozen=True, slots=True)
class Style:
    """How codes are written."""

    name: str
    marks: Mapping[str, Meaning] = field(default_factory=dict)
    """Words, and what each says."""
    separators: str = ""
    """Letters that part words, as blanks do."""
    comments: str = COMMENTS
    """Letters behind which a remark follows; quotes always do so."""
    place: Literal["behind", "before"] = "behind"
    """Where the words stand, seen from the code: "behind" or "before"."""
    others: str = ""
    """Pattern of words that are known, such as those with a number, and not applied."""
    is_exact: bool = False
    """Whether upper and lower case differ."""
    least_words: int = 0
    """How many different words of its own show that the style is meant."""

    def find_meaning(self, word: str) -> Meaning | None:
        """Return what a word says, None if it is no mark."""
        known = self.marks.get(word)
        if known is None and self.others and re.fullmatch(self.others, word):
            return "other"
        return known

    def list_words(self) -> str:
        """List the marks for a sentence."""
        return ", ".join(word for word, meaning in self.marks.items() if meaning != "other")


_WORDS = Style("words", {**MARKS, **_CURVES})

STYLES: Mapping[str, Style] = {
    one.name: one
    for one in (
        _WORDS,
        replace(_WORDS, name="dash", separators="-"),
        replace(_WORDS, name="slash", separators="/", comments=",;("),
        replace(_WORDS, name="dot", separators="."),
        replace(_WORDS, name="star", marks={**_WORDS.marks, "*": "begin"}),
        replace(_WORDS, name="star-end", marks={**_WORDS.marks, "*": "end"}),
        Style(
            "civil3d",
            {
                **_BEGIN_END,
                "C": "continue",
                "CLS": "close",
                **{word: _CURVES[word] for word in ("BC", "EC", "RECT")},
                "BCV": "begin_curve",
                "ECV": "end_curve",
                **dict.fromkeys(("RPN", "CPN", "RT", "CIR", "SO"), "other"),
            },
            others=r"(?:RPN|CPN|RT|CIR|X|H|V|RECT)-?\d+(?:\.\d+)?",
        ),
        Style(
            "carlson",
            {
                **_BEGIN_END,
                "+7": "begin",
                "-7": "end",
                **dict.fromkeys(("CLO", "CLOSE"), "close"),
                **{word: _CURVES[word] for word in ("PC", "PT", "RECT")},
                **dict.fromkeys(("SMO", "JPN", "OH", "OV"), "other"),
            },
            others=r"[+-]\d|(?:JPN|RECT|OH|OV)-?\d+(?:\.\d+)?",
        ),
        Style(
            "trimble",
            {
                **dict.fromkeys(("ST", "B"), "begin"),
                **dict.fromkeys(("END", "E"), "end"),
                **dict.fromkeys(("CLOSE", "C"), "close"),
                **dict.fromkeys(("STCV", "SC", "NEWCV", "NC"), "begin_curve"),
                **dict.fromkeys(("NEWARC", "NA"), "begin_curve"),
                **dict.fromkeys(("STARC", "SA"), "begin_tangent_curve"),
                **dict.fromkeys(("ENDCV", "ENDONCV", "EC"), "end_curve"),
                **dict.fromkeys(("ENDARC", "ENDONARC", "EA"), "end_curve"),
                "CLSRECT": "rectangle",
                **dict.fromkeys(("JP", "JPT", "NOJOIN"), "other"),
            },
            least_words=2,
        ),
        Style(
            "leica",
            {
                "N": "begin",
                "P": "close",
                "CS": "begin_curve",
                "CE": "end_curve",
                "TS": "begin_tangent_curve",
                "TE": "end_curve",
                "X": "exclude",
                **dict.fromkeys(("G", "D", "Y", "Z", "H", "J", "K", "L", "M", "O"), "other"),
                **dict.fromkeys(("XS", "XE", "YS", "YE", "ZS", "ZE"), "other"),
            },
            separators="-",
            least_words=2,
        ),
        Style(
            "cg",
            {
                "BL": "begin",
                "EL": "end",
                "CL": "close",
                "PC": "begin_tangent_curve",
                "PT": "end_curve",
                "OC": "toggle_curve",
            },
            least_words=2,
        ),
    )
}
"""The styles by name, in the order in which they are tried."""


def find_style(name: str) -> Style:
    """Look a style up by its name.

    Raises
    ------
    OptionError
        If there is none.

    Examples
    --------
    >>> find_style("carlson").find_meaning("+7")
    'begin'
    """
    return STYLES[choice("code_style", name, CodeStyle)]
