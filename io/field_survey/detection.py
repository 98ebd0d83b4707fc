"""Which style descriptions are written in: all are tried, and the one that fits is told."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from ...base.errors import LinesError
from ...base.sentences import counted
from .descriptions import Coded, Description, Vocabulary
from .figures import NO_LINES, Fault, Figure, find_curves, follow_figures
from .styles import STYLES, Style

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .code_table import Rule

_HARMLESS = ("curve without an end", "line without an end")
"""What crews leave out in any style."""
_COUNTED = "end without a begin"
"""Such a line is counted for its one shot already."""


class Unread(NamedTuple):
    """A word behind a code that is neither mark nor code."""

    row: int
    word: str


@dataclass(frozen=True)
class Reading:
    """Descriptions as they are read in one style."""

    style: Style
    figures: list[Figure]
    faults: list[Fault]
    unread: list[Unread]
    descriptions: dict[str, Description]
    """By their texts; of those that begin with a code."""

    @property
    def n_faults(self) -> int:
        """How much speaks against it: words that are not read, and lines that are odd."""
        return len(self.unread) + self.n_odd_lines

    @cached_property
    def n_odd_lines(self) -> int:
        """How much is odd in the lines themselves."""
        short = sum(not one.is_long_enough for one in self.figures)
        return short + sum(fault.kind not in (*_HARMLESS, _COUNTED) for fault in self.faults)

    @cached_property
    def key(self) -> frozenset[tuple[object, ...]]:
        """What tells its lines from those of another reading."""
        return frozenset(one.key for one in self.figures if one.is_long_enough)


def read_in_style(
    order: Sequence[int], texts: Sequence[str], rules: dict[str, Rule], style: Style
) -> Reading:
    """Read descriptions in a style.

    Parameters
    ----------
    order : sequence of int
        Rows, in the order in which lines run.
    texts : sequence of str
        The descriptions, by row.
    rules : dict of str to Rule
    style : Style
    """
    descriptions = _parse(_select_coded(set(texts), rules, style), rules, style)
    descriptions = {text: one for text, one in descriptions.items() if one.codes}
    coded = [row for row in order if texts[row] in descriptions]
    return _follow(coded, texts, rules, style, descriptions)


def _select_coded(texts: Iterable[str], rules: dict[str, Rule], style: Style) -> list[str]:
    """Return the texts that may begin with a code: of a million shots most do not."""
    if style.place == "before":
        return list(texts)
    codes = "|".join(re.escape(code) for code in rules)
    may_begin = re.compile(
        rf"[\s*{re.escape(style.separators)}]*(?:{codes})", 0 if style.is_exact else re.IGNORECASE
    ).match
    return [text for text in texts if may_begin(text)]


def _parse(texts: Iterable[str], rules: dict[str, Rule], style: Style) -> dict[str, Description]:
    parse = Vocabulary(rules.keys(), style).parse
    return {text: parse(text) for text in texts}


def _follow(
    order: Sequence[int],
    texts: Sequence[str],
    rules: dict[str, Rule],
    style: Style,
    descriptions: dict[str, Description],
) -> Reading:
    lines = {text: _select_lines(one.codes, rules) for text, one in descriptions.items()}
    figures, faults = follow_figures(order, [lines[texts[row]] for row in order], rules)
    faults += _find_codes_behind_others(order, texts, rules, descriptions)
    for figure in figures:
        if figure.marks:
            find_curves(figure, faults.append)
    unread = {text: one.unread for text, one in descriptions.items() if _is_doubtful(one, rules)}
    left = [Unread(row, unread[texts[row]]) for row in order if texts[row] in unread]
    return Reading(style, figures, faults, left if unread else [], descriptions)


def _select_lines(codes: Sequence[Coded], rules: dict[str, Rule]) -> tuple[tuple[str, Coded], ...]:
    """Return the codes of a description that make lines, each with the name of its line."""
    return tuple((one.name, one) for one in codes if rules[one.code].kind not in NO_LINES)


def _is_doubtful(description: Description, rules: dict[str, Rule]) -> bool:
    """Whether a word that is not understood stands behind the code of a line."""
    codes = description.codes
    return bool(description.unread and codes) and rules[codes[-1].code].kind not in NO_LINES


def _find_codes_behind_others(
    order: Sequence[int],
    texts: Sequence[str],
    rules: dict[str, Rule],
    descriptions: dict[str, Description],
) -> list[Fault]:
    """Tell of lines whose codes have no number and stand behind others only, as remarks do."""
    first = {one.codes[0].code for one in descriptions.values() if one.codes}
    behind = {
        text: codes
        for text, one in descriptions.items()
        if (codes := _list_doubtful(one.codes, rules, first))
    }
    found: dict[str, list[int]] = {}
    for row in order if behind else ():
        for code in behind.get(texts[row], ()):
            found.setdefault(code, []).append(row)
    return [Fault("code behind others", code, tuple(rows)) for code, rows in found.items()]


def _list_doubtful(
    codes: Sequence[Coded], rules: dict[str, Rule], first: set[str]
) -> tuple[str, ...]:
    """Return the codes of lines without number and mark that never stand first."""
    return tuple(
        one.code
        for one in codes[1:]
        if not one.number and not one.marks and one.code not in first
        if rules[one.code].kind not in NO_LINES
    )


def choose_reading(
    order: Sequence[int],
    texts: Sequence[str],
    rules: dict[str, Rule],
    name_row: Callable[[int], str],
) -> tuple[Reading, list[str]]:
    """Choose the style in which the least is odd, and say so if it is not the default.

    Parameters
    ----------
    order, texts, rules
        As for :func:`read_in_style`.
    name_row : callable
        Names a row for a sentence.

    Returns
    -------
    reading : Reading
    notes : list of str

    Raises
    ------
    LinesError
        If two styles fit equally, and lead to different lines.

    Notes
    -----
    1. A style is tried if it understands a word that the default leaves, or the default finds
       something odd. A style of short words that may be remarks needs two of them, or to leave
       fewer odd lines; where it needs neither, and leaves nothing odd, it is a doubt.
    2. Those with the fewest oddities are plausible. If all of them lead to the same lines the
       first is taken.
    3. What the default takes for remarks is never odd to it: where the style "slash" understands
       every word of them, and makes other lines, the codes are refused.
    4. Where several are plausible and lead to different lines, and something is odd in each, the
       default is taken if it is among them; else the codes are refused.
    """
    plain = read_in_style(order, texts, rules, STYLES["words"])
    coded = [row for row in order if texts[row] in plain.descriptions]
    found = [plain]
    for style in list(STYLES.values())[1:]:
        parsed = _parse(plain.descriptions, rules, style)
        if parsed != plain.descriptions:
            reading = _follow(coded, texts, rules, style, parsed)
            if _is_plausible(reading, plain):
                found.append(reading)
    least = min(one.n_faults for one in found)
    plausible = [one for one in found if one.n_faults == least]
    first = plausible[0]
    other = next((one for one in plausible[1:] if one.key != first.key), None)
    if other is None and first.style.least_words > 1 and plain.n_odd_lines == 0:
        other = plain if plain.key != first.key and not _is_meant(first, plain) else None
    if other is not None and (least == 0 or first is not plain):
        raise _refuse(first, other, name_row)
    hidden = next((one for one in found[1:] if _reads_remarks(one, plain)), None)
    if first is plain and hidden is not None:
        raise _refuse(plain, hidden, name_row)
    return first, [] if first is plain else [_describe_choice(first, plain)]


def _is_plausible(reading: Reading, plain: Reading) -> bool:
    """Whether a style has enough words of its own there, or the default leaves doubts."""
    parsed = reading.descriptions
    if (
        not _is_meant(reading, plain)
        and reading.n_odd_lines >= plain.n_odd_lines
        and reading.n_faults > 0
    ):
        return False
    says_more = any(one.n_words > plain.descriptions[text].n_words for text, one in parsed.items())
    return plain.n_faults > 0 or says_more


def _is_meant(reading: Reading, plain: Reading) -> bool:
    """Whether enough words of a style's own are there, so that they are no remarks."""
    parsed = reading.descriptions.values()
    words = {word for one in parsed for code in one.codes for word in code.words}
    return len(words - plain.style.marks.keys()) >= reading.style.least_words


def _reads_remarks(reading: Reading, plain: Reading) -> bool:
    """Whether a style understands every word of what the default takes for remarks."""
    is_open = set(plain.style.comments) - set(reading.style.comments)
    return bool(is_open) and not reading.unread and reading.key != plain.key


def _describe_choice(chosen: Reading, plain: Reading) -> str:
    style = chosen.style.name
    if plain.n_faults <= chosen.n_faults:
        return (
            f"Field codes are read in the style '{style}', which understands more of their words."
        )
    left = f"{chosen.n_faults:,}" if chosen.n_faults else "none"
    return (
        f"Field codes are read in the style '{style}': {plain.n_faults:,} of their words or "
        f"lines make no sense in 'words', {left} in '{style}'."
    )


def _refuse(one: Reading, other: Reading, name_row: Callable[[int], str]) -> LinesError:
    """Return the error that shows where two readings part."""
    names = f"'{one.style.name}' and '{other.style.name}'"
    shown = _find_difference(one, other, name_row)
    return LinesError(
        f"The field codes can be read in two styles, {names}, and lead to different lines{shown}: "
        "the option `code_style` says which is meant."
    )


def _find_difference(one: Reading, other: Reading, name_row: Callable[[int], str]) -> str:
    """Name the first line that only one of two readings has."""
    for reading, keys in ((one, other.key), (other, one.key)):
        for figure in reading.figures:
            if figure.is_long_enough and figure.key not in keys:
                first, last = name_row(figure.rows[0]), name_row(figure.rows[-1])
                return (
                    f" (only '{reading.style.name}' makes {figure.name} of "
                    f"{counted(len(figure.rows), 'shot')} from {first} to {last})"
                )
    return ""
