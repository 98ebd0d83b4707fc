"""Lines between and behind the rows of a table that are no rows: its header again, "END"."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...base.sentences import counted
from .cells import is_number, split_line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Int64Array
    from .lines import TextLines

_MOST_TITLES = 10
"""Lines of a page's title, above the header that is repeated."""
_SHOWN_LINES = 5
_END = re.compile(
    r"\W*(end|eof|ende|fin|fine|fim|einde|slut|koniec|konec|kraj|son|конец|кінець|край|τέλος|結束|结束|終わり|끝)"
    r"((\s+|\s*-\s*)(of\s+|der?\s+|du\s+|del\s+)?(the\s+)?"
    r"(file|data|report|list|points?|job|export|survey|datei|liste|fichier|archivo|listado))?\W*",
    re.IGNORECASE,
)
_LONGEST_END = 40


class PageBreaks(NamedTuple):
    """Lines that are left out, by what they are, and sentences that name them."""

    lines: dict[str, tuple[int, ...]]
    """Line numbers from 1."""
    notes: tuple[str, ...]


def find_page_breaks(
    lines: TextLines,
    rows: Int64Array,
    top: Sequence[str],
    delimiter: str,
    decimal: str,
) -> PageBreaks:
    """Find the header where it is repeated, with the title of a page, and a last line "END".

    Parameters
    ----------
    lines : TextLines
    rows : (n,) int64 array
        Lines (from 0) below the header.
    top : sequence of str
        The header, and the units below it; empty if there are none.
    delimiter, decimal : str
    """
    found: dict[str, tuple[int, ...]] = {}
    repeated = _find_repeated(lines, rows, top) if top else []
    if repeated:
        titles = _find_titles(lines, rows, repeated, delimiter, decimal)
        found["repeated header lines"] = tuple(line + 1 for line in repeated)
        if titles:
            found["page titles"] = tuple(line + 1 for line in titles)
    if len(rows) > 1 and lines.is_last:
        last = lines.decode_line(int(rows[-1])).strip()
        if len(last) <= _LONGEST_END and _END.fullmatch(last):
            found["end lines"] = (int(rows[-1]) + 1,)
    return PageBreaks(found, tuple(_describe(what, at) for what, at in found.items()))


def _find_repeated(lines: TextLines, rows: Int64Array, top: Sequence[str]) -> list[int]:
    found: list[int] = []
    for text in top:
        alike = rows[lines.starts_with(text)[rows - lines.first]] if text else rows[:0]
        found += [one for one in alike.tolist() if lines.decode_line(one).strip() == text]
    return sorted(found)


def _find_titles(
    lines: TextLines, rows: Int64Array, repeated: Sequence[int], delimiter: str, decimal: str
) -> list[int]:
    """Return the lines above repeated headers that hold no two numbers, as every row does."""
    titles: list[int] = []
    for line in set(repeated):
        at = int(np.searchsorted(rows, line))
        for above in rows[max(0, at - _MOST_TITLES) : at][::-1].tolist():
            cells = split_line(lines.decode_line(above), delimiter)
            if above in repeated or sum(is_number(cell, decimal) for cell in cells) > 1:
                break
            titles.append(above)
    return sorted(titles)


def _describe(what: str, at: Sequence[int]) -> str:
    shown = ", ".join(map(str, at[:_SHOWN_LINES])) + (", ..." if len(at) > _SHOWN_LINES else "")
    many = counted(len(at), what.removesuffix("s"))
    verb = "is" if len(at) == 1 else "are"
    return f"{many} {verb} left out: line{'' if len(at) == 1 else 's'} {shown}."
