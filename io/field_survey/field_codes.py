"""Lines from survey codes (field to finish): what the field book marks becomes a line.

A description begins with the code of what was shot and the number of the line, and may go on with
marks: ``EP1 BEG``, ``EP1``, ``EP 1 END``, ``BLDG2 CLS``, ``EP1 PC``, and with further codes:
``EP1 FL1``. A remark may follow, in quotes or behind a comma, ``/`` or ``;``. All shots with one
code and number are one line, in the order of their point numbers; marks begin it, end it, bend it
or close it to its first point, and a line that has been ended is followed by another one of the
same name. Other ways to write this are styles: docs/field-codes.md has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.checks import as_length, require_type
from ...base.errors import LinesError, OptionError, choice
from ...base.policies import BreaklineKind, CodeStyle, LineRole, ShotOrder
from ...base.sentences import counted
from ...tin import Breakline, Survey, Water
from .code_table import CodeTable, make_rules, read_code_table
from .descriptions import Vocabulary
from .detection import Reading, choose_reading, read_in_style
from .figures import NO_LINES, RINGS, Fault, Figure
from .geometry import build_polyline
from .remarks import describe_faults
from .several_files import NoCodesError, read_each_file, split_files
from .shot_order import find_jump, require_one_order
from .styles import find_style

if TYPE_CHECKING:
    import os
    from collections.abc import Callable, Iterable, Sequence

    from ...base.arrays import Float64Array, Int64Array

RULES: Mapping[str, LineRole] = {
    **dict.fromkeys(("RDG", "RIDGE", "GB", "BRK", "BL"), "hard"),
    **dict.fromkeys(("EP", "CL", "ROAD", "CURB", "KERB", "TC", "GUT", "SW"), "hard"),
    **dict.fromkeys(("TOB", "TOE", "FL", "DITCH", "SWALE", "WALL"), "hard"),
    **dict.fromkeys(("BLDG", "BLD", "SLAB"), "hard"),
    **dict.fromkeys(("WE", "POND", "LAKE"), "water"),
    "DAYLIGHT": "boundary",  # where a design meets the ground, and ends
}
"""Codes that make lines, and what these become. A building is a hard line: the ground around it
stays one surface, for contours and volumes; who wants the footprint cut out says "hole"."""

_SHOWN = 5
_TOLERANCE_METRES = 0.01
"""By which chords leave arcs where nobody says: below what a shot is worth."""


def lines_from_codes(
    survey: Survey,
    rules: Mapping[str, LineRole] | None = None,
    *,
    code_table: CodeTable | str | os.PathLike[str] | Mapping[str, Any] | None = None,
    code_style: CodeStyle | None = None,
    arc_tolerance: float | None = None,
    shot_order: ShotOrder | None = None,
) -> Survey:
    """Make lines of the points whose descriptions begin with a line code.

    Parameters
    ----------
    survey : Survey
        With the attributes ``description`` and, if the points have numbers, ``number``.
    rules : mapping of str to str, optional
        Codes and what their lines become: ``hard``, ``soft``, ``boundary``, ``hole``, ``erase`` or
        ``water``. Default ``RULES``.
    code_table : path-like or mapping, optional
        A table of codes in TOML, or what one holds, instead of ``rules``: docs/field-codes.md.
    code_style : str, optional
        How codes are written: ``"words"``, ``"civil3d"``, ``"carlson"``, ...; default that of the
        table, else the one that fits.
    arc_tolerance : float, optional
        By which the chords of a curve may leave it, CRS units; default that of the table, else
        0.01 m (0.01 where the CRS has no unit).
    shot_order : {"number", "row"}, optional
        What gives the order of shots along lines: their numbers, or the rows of the file. Default
        the numbers, or the rows where these are none.

    Returns
    -------
    Survey
        With the lines added to its own. Water is level at the median of its points. The points stay
        as they are, but for those that a table excludes from the surface. ``findings`` has what is
        odd, with the rows of the survey given, and ``notes`` counts it: marks that are unknown,
        and are taken for a remark, lines of too few points, which are left out, curves that cannot
        be, rings that are open. Of several files that were read as one survey each is read by
        itself: a line ends with its file.

    Raises
    ------
    LinesError
        If there are no descriptions or no line codes; if two styles are plausible and lead to
        different lines; if a curve needs too many vertices, or lies in degrees; without a
        ``shot_order`` also if numbers are repeated and give other lines than rows, if a line jumps
        in one of the two orders alone, or if a line without any mark crosses itself or joins
        groups far apart.
    OptionError
        If a rule gives a code another role, or an option has a value that it cannot have.
    ReadError
        If the table cannot be read, or has a key or value that it cannot have.

    Examples
    --------
    >>> from tinsmith import Survey
    >>> survey = Survey(
    ...     points=np.array([[0.0, 0, 5], [4, 0, 6], [9, 1, 6], [3, 3, 7]]),
    ...     attributes={"description": np.array(["EP1 BEG", "EP1", "EP1 END", "GS"])},
    ... )
    >>> lines_from_codes(survey).breaklines
    [<Breakline: hard, 3 vertices, 'EP1'>]
    """
    require_type("survey", survey, Survey)
    table = _choose_table(rules, code_table)
    if files := split_files(survey):

        def read(part: Survey) -> Survey:
            return lines_from_codes(
                part,
                code_table=table,
                code_style=code_style,
                arc_tolerance=arc_tolerance,
                shot_order=shot_order,
            )

        return read_each_file(survey, files, read)
    tolerance = _choose_tolerance(survey, table, arc_tolerance)
    if "description" not in survey.attributes:
        raise LinesError(
            "The points have no descriptions to read codes from: a column 'description' is needed."
        )
    texts = [str(one or "") for one in np.asarray(survey.attributes["description"]).tolist()]
    order = _order_shots(survey, shot_order).tolist()
    reading, notes = _read(order, texts, table, code_style, _make_namer(survey))
    if shot_order is None:
        by_row = read_in_style(range(len(survey)), texts, dict(table.rules), reading.style)
        require_one_order(survey, reading, by_row)
    if not reading.figures and not _excludes(table, reading):
        known = ", ".join(table.rules)
        raise NoCodesError(f"No description begins with a line code: {known} are known.")
    builder = _Builder(survey, table, reading, tolerance)
    return builder.build(order, texts, notes, is_ordered=shot_order is not None)


def _choose_table(
    rules: Mapping[str, LineRole] | None, code_table: CodeTable | Any | None
) -> CodeTable:
    if code_table is None:
        return CodeTable(make_rules(RULES if rules is None else rules), is_complete=False)
    if rules is not None:
        raise OptionError("rules", rules, "left out where there is a `code_table`")
    return code_table if isinstance(code_table, CodeTable) else read_code_table(code_table)


def _choose_tolerance(survey: Survey, table: CodeTable, given: float | None) -> float:
    """Return the tolerance of arcs in units of the CRS."""
    if given is not None:
        return as_length("arc_tolerance", given)
    if table.arc_tolerance is not None:
        return table.arc_tolerance
    metres = None if survey.crs is None else survey.crs.horizontal_unit.metres
    return _TOLERANCE_METRES / (metres or 1.0)


def _order_shots(survey: Survey, shot_order: ShotOrder | None) -> Int64Array:
    if shot_order is not None:
        choice("shot_order", shot_order, ShotOrder)
    numbers = survey.attributes.get("number")
    if numbers is None or numbers.dtype.kind not in "iu":
        if shot_order == "number":
            raise OptionError("shot_order", shot_order, "row, where points have no whole numbers")
        return np.arange(len(survey))
    return np.arange(len(survey)) if shot_order == "row" else np.argsort(numbers, kind="stable")


def _make_namer(survey: Survey) -> Callable[[int], str]:
    """Return what names a row for a sentence."""
    given = survey.attributes.get("number")
    numbers = None if given is None else given.tolist()
    return lambda row: f"row {row}" if numbers is None else f"point {numbers[row]}"


def _read(
    order: Sequence[int],
    texts: Sequence[str],
    table: CodeTable,
    style: CodeStyle | None,
    name_row: Callable[[int], str],
) -> tuple[Reading, list[str]]:
    """Read the descriptions in the style named, that of the table, or the one that fits."""
    rules = dict(table.rules)
    named = table.style
    if style is not None:
        named = replace(find_style(style), is_exact=table.is_exact)
    if named is not None:
        return read_in_style(order, texts, rules, named), []
    return choose_reading(order, texts, rules, name_row)


def _excludes(table: CodeTable, reading: Reading) -> bool:
    """Whether any shot is excluded from the surface, so that a survey without lines has sense."""
    return any(
        table.rules[one.code].kind == "exclude" or "exclude" in one.marks
        for description in reading.descriptions.values()
        for one in description.codes
    )


# ------------------------------------------------------------------------- lines


class _Builder:
    """Makes lines of figures, and collects what is odd."""

    def __init__(
        self, survey: Survey, table: CodeTable, reading: Reading, tolerance: float
    ) -> None:
        self.survey = survey
        self.table = table
        self.reading = reading
        self.tolerance = tolerance
        self.faults: list[Fault] = [
            Fault("unknown mark", one.word, (one.row,)) for one in reading.unread
        ]
        short = [one for one in reading.figures if not one.is_long_enough]
        self.faults += [Fault("too few points", one.name, tuple(one.rows)) for one in short]
        self.faults += reading.faults
        self.figures = [one for one in reading.figures if one.is_long_enough]

    def build(
        self,
        order: Sequence[int],
        texts: Sequence[str],
        notes: Sequence[str],
        *,
        is_ordered: bool,
    ) -> Survey:
        """Return the survey with its lines; ``is_ordered`` if the caller said the order."""
        self._require_no_degrees()
        lines = self._build_lines()
        self._find_crossings(lines["line"], is_ordered=is_ordered)
        self._find_unknown_codes(order, texts)
        self._find_marks_before(order, texts)
        survey = self.survey
        words = self.reading.style.list_words()
        noted, findings = describe_faults(self.faults, _make_namer(survey), words)
        made = replace(
            survey,
            breaklines=[*survey.breaklines, *(self._make_breakline(*one) for one in lines["line"])],
            boundary=[*survey.boundary, *(ring for _, ring in lines["boundary"])],
            holes=[*survey.holes, *(ring for _, ring in lines["hole"])],
            erase=[*survey.erase, *(ring[:, :2] for _, ring in lines["erase"])],
            water=[*survey.water, *(self._make_water(*one) for one in lines["water"])],
            notes=[
                *survey.notes,
                *notes,
                *noted,
                *self._note_curves(),
                *(self._note_water_level(figure) for figure, _ in lines["water"]),
            ],
            findings=[*survey.findings, *findings],
        )
        return self._exclude(made, texts)

    def _require_no_degrees(self) -> None:
        crs = self.survey.crs
        bent = ("begin_curve", "begin_tangent_curve", "toggle_curve")
        has_curves = any(
            meaning in bent
            for one in self.figures
            for marks in one.marks.values()
            for meaning in marks
        )
        if crs is not None and crs.is_geographic and has_curves:
            raise LinesError(f"Curves need a projected CRS: {crs.label} measures in degrees.")

    def _build_lines(self) -> dict[str, list[tuple[Figure, Float64Array]]]:
        """Return figures and their vertices, by what they become."""
        found: dict[str, list[tuple[Figure, Float64Array]]] = {
            kind: [] for kind in ("line", *RINGS)
        }
        for figure in self.figures:
            tolerance = figure.rule.arc_tolerance or self.tolerance
            vertices = build_polyline(figure, self.survey.points, tolerance, self.faults.append)
            if len(vertices) < figure.least:
                self.faults.append(Fault("too few points", figure.name, tuple(figure.rows)))
                continue
            self._find_doubts(figure, vertices)
            if (jump := find_jump(self.survey.points, figure)) is not None:
                self.faults.append(Fault("line that jumps", figure.name, jump))
            kind = figure.rule.kind
            found[kind if kind in RINGS else "line"].append((figure, vertices))
        return found

    def _find_doubts(self, figure: Figure, vertices: Float64Array) -> None:
        """Tell of rings that no mark closes, and of contours that are not level."""
        rows = tuple(figure.rows)
        ends = (rows[0], rows[-1])
        is_back = (self.survey.points[rows[0], :2] == self.survey.points[rows[-1], :2]).all()
        is_shut = figure.is_closed or figure.is_rectangle or is_back
        if figure.is_ring and not is_shut:
            self.faults.append(Fault("open figure", figure.name, ends))
        elif figure.rule.kind == "building" and not is_shut:
            self.faults.append(Fault("open building", figure.name, ends))
        if figure.rule.kind == "contour" and np.ptp(vertices[:, 2]) > 0:
            self.faults.append(Fault("contour that is not level", figure.name, rows))

    def _find_crossings(
        self, lines: Sequence[tuple[Figure, Float64Array]], *, is_ordered: bool
    ) -> None:
        """Tell of lines that cross themselves; refuse those without any mark to begin or end them.

        Raises
        ------
        LinesError
        """
        shapely = optional.load("shapely")
        shapes = [shapely.linestrings(vertices[:, :2]) for _, vertices in lines]
        crossed = [
            one
            for (one, _), simple in zip(lines, shapely.is_simple(shapes), strict=True)
            if not simple
        ]
        for figure in crossed:
            if not (is_ordered or figure.marks):
                raise LinesError(
                    f"The {len(figure.rows)} shots of the code {figure.name} have no mark to begin "
                    "or end a line, and one line through them all crosses itself: a code table "
                    "says that they are points, or the option `shot_order` that they are one line."
                )
        self.faults += [
            Fault("line that crosses itself", one.name, (one.rows[0], one.rows[-1]))
            for one in crossed
        ]

    def _find_unknown_codes(self, order: Iterable[int], texts: Sequence[str]) -> None:
        """Find codes that the table lacks; of the usual codes those that have marks of lines."""
        unknown: dict[str, list[int]] = {}
        split = Vocabulary(self.table.rules.keys(), self.reading.style).find_first_word
        for row in order:
            if texts[row] not in self.reading.descriptions and (first := split(texts[row])):
                unknown.setdefault(first.rstrip("0123456789"), []).append(row)
        kind = "unknown code" if self.table.is_complete else "unknown line code"
        self.faults += [
            Fault(kind, code or "a number", tuple(rows))
            for code, rows in unknown.items()
            if self.table.is_complete or any(self._has_mark(texts[row]) for row in rows)
        ]

    def _has_mark(self, text: str) -> bool:
        """Whether a word behind the first one is a mark that begins, ends or closes a line."""
        style = self.reading.style
        words = text.split()[1:]
        found = {style.find_meaning(one if style.is_exact else one.upper()) for one in words}
        return bool(found & {"begin", "end", "close"})

    def _find_marks_before(self, order: Iterable[int], texts: Sequence[str]) -> None:
        """Find shots whose mark stands before the code of a line, where marks stand behind."""
        read, style = self.reading.descriptions, self.reading.style
        if style.place == "before":
            return
        turned = Vocabulary(self.table.rules.keys(), replace(style, place="before"))
        found: dict[str, list[int]] = {}
        for row in order:
            word, _, rest = texts[row].partition(" ")
            is_mark = style.find_meaning(word if style.is_exact else word.upper()) is not None
            if not is_mark or texts[row] in read or not rest:
                continue
            for one in turned.parse(texts[row]).codes[:1]:
                if one.marks and self.table.rules[one.code].kind not in NO_LINES:
                    found.setdefault(f"{' '.join(one.words)} {one.name}", []).append(row)
        self.faults += [
            Fault("mark before a code", what, tuple(rows)) for what, rows in found.items()
        ]

    def _make_breakline(self, figure: Figure, vertices: Float64Array) -> Breakline:
        is_closed = figure.is_closed or figure.rule.is_closed or figure.is_rectangle
        if is_closed and (vertices[0] != vertices[-1]).any():
            vertices = np.vstack([vertices, vertices[:1]])
        kind: BreaklineKind = "soft" if figure.rule.kind in ("soft", "contour") else "hard"
        return Breakline(vertices, kind=kind, name=figure.name)

    def _make_water(self, figure: Figure, ring: Float64Array) -> Water:
        level = float(np.median(self.survey.points[figure.rows, 2]))
        return Water(ring[:, :2], level, name=figure.name)

    def _note_curves(self) -> list[str]:
        """Say that vertices which nobody shot stand for curves."""
        bent = [one for one in self.figures if one.n_added]
        if not bent:
            return []
        added = sum(one.n_added for one in bent)
        names = ", ".join(dict.fromkeys(one.name for one in bent[:_SHOWN]))
        more = " ..." if len(bent) > _SHOWN else ""
        keeps = sorted({one.rule.arc_tolerance or self.tolerance for one in bent})
        within = " or ".join(f"{one:.4g}" for one in keeps[:3])
        verb = "vertex stands" if added == 1 else "vertices stand"
        return [
            f"{added:,} {verb} for the curves of {names}{more}, whose chords keep within {within} "
            "of them; their elevations change evenly from shot to shot."
        ]

    def _note_water_level(self, figure: Figure) -> str:
        z = self.survey.points[figure.rows, 2]
        return (
            f"Water {figure.name} is level at {np.median(z):.3f}, the median of its "
            f"{counted(len(z), 'point')} ({z.min():.3f} to {z.max():.3f})."
        )

    def _exclude(self, survey: Survey, texts: Sequence[str]) -> Survey:
        """Leave out the points that are not for the surface, unless a line goes through them."""
        out = {text for text in self.reading.descriptions if self._is_excluded(text)}
        if not out:
            return survey
        is_out = np.array([text in out for text in texts], np.bool_)
        kept = ~is_out
        what = "points not for the surface"
        attributes = {name: np.asarray(v)[kept] for name, v in survey.attributes.items()}
        return replace(
            survey,
            points=survey.points[kept],
            attributes=attributes,
            row_sources=None if survey.row_sources is None else survey.row_sources.take(kept),
            skipped={**survey.skipped, what: int(is_out.sum())},
        )

    def _is_excluded(self, text: str) -> bool:
        codes = self.reading.descriptions[text].codes
        if not codes:
            return False
        rules = self.table.rules
        return all(rules[one.code].kind == "exclude" or "exclude" in one.marks for one in codes)
