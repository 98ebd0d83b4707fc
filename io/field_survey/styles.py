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
from typing import Literal, TypeAlias, cast, get_args

from ...base.errors import choice
from ...base.policies import CodeStyle

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


def _list_marks(text: str) -> dict[str, Meaning]:
    """Return words by groups of one meaning: "begin:B,BEG end:E,END"."""
    groups = (group.split(":") for group in text.split())
    return {word: cast("Meaning", what) for what, words in groups for word in words.split(",")}


MARKS = _list_marks("begin:B,BEG,BEGIN,ST,START end:E,END close:C,CLS,CLO,CLOSE,X")
"""Marks behind a code that begin, end and close a line in any style of plain words."""

_CURVES = "begin_curve:BC end_curve:EC begin_tangent_curve:PC end_curve:PT rectangle:RECT"
_BEGIN_END = "begin:B,BEG end:E,END"

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


_WORDS = Style("words", {**MARKS, **_list_marks(_CURVES)})

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
            _list_marks(
                f"{_BEGIN_END} continue:C close:CLS begin_curve:BC end_curve:EC rectangle:RECT "
                "begin_curve:BCV end_curve:ECV other:RPN,CPN,RT,CIR,SO"
            ),
            others=r"(?:RPN|CPN|RT|CIR|X|H|V|RECT)-?\d+(?:\.\d+)?",
        ),
        Style(
            "carlson",
            _list_marks(
                f"{_BEGIN_END} begin:+7 end:-7 close:CLO,CLOSE begin_tangent_curve:PC end_curve:PT "
                "rectangle:RECT other:SMO,JPN,OH,OV"
            ),
            others=r"[+-]\d|(?:JPN|RECT|OH|OV)-?\d+(?:\.\d+)?",
        ),
        Style(
            "trimble",
            _list_marks(
                "begin:ST,B end:END,E close:CLOSE,C begin_curve:STCV,SC,NEWCV,NC,NEWARC,NA "
                "begin_tangent_curve:STARC,SA end_curve:ENDCV,ENDONCV,EC,ENDARC,ENDONARC,EA "
                "rectangle:CLSRECT other:JP,JPT,NOJOIN"
            ),
            least_words=2,
        ),
        Style(
            "leica",
            _list_marks(
                "begin:N close:P begin_curve:CS end_curve:CE begin_tangent_curve:TS end_curve:TE "
                "exclude:X other:G,D,Y,Z,H,J,K,L,M,O,XS,XE,YS,YE,ZS,ZE"
            ),
            separators="-",
            least_words=2,
        ),
        Style(
            "cg",
            _list_marks(
                "begin:BL end:EL close:CL begin_tangent_curve:PC end_curve:PT toggle_curve:OC"
            ),
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
