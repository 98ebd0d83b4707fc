"""Lines from survey codes (field to finish): what the field book marks becomes a line.

A description begins with the code of what was shot and the number of the line, and may go on with
a mark: ``EP1 BEG``, ``EP1``, ``EP 1 END``, ``BLDG2 CLS``. A note may follow, in quotes or behind a
comma, ``/`` or ``;``. All shots with one code and number are one line, in the order of their point
numbers; marks begin it, end it or close it to its first point, and a line that has been ended is
followed by another one of the same name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, get_args

import numpy as np

from ...errors import LinesError, OptionError
from ...policies import BreaklineKind, LineRole
from ...tin import Breakline, Survey, Water

if TYPE_CHECKING:
    from numpy.typing import NDArray


__all__ = ["MARKS", "RULES", "LineRole", "lines_from_codes"]

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

MARKS: Mapping[str, str] = {
    **dict.fromkeys(("B", "BEG", "BEGIN", "ST", "START"), "begin"),
    **dict.fromkeys(("E", "END"), "end"),
    **dict.fromkeys(("C", "CLS", "CLO", "CLOSE"), "close"),
}
"""Marks behind a code, and what they mean."""

_SHOWN = 5
_CODE = re.compile(r"\s*(?P<code>[A-Z]+) ?(?P<number>\d*)(?![A-Z0-9])\s*(?P<rest>.*)", re.I | re.S)
_NOTE = ('"', "'", ",", "/", ";", "(")


@dataclass
class _Run:
    """The rows of one line in the making."""

    name: str
    role: LineRole
    rows: list[int]
    is_closed: bool = False


def lines_from_codes(survey: Survey, rules: Mapping[str, LineRole] | None = None) -> Survey:
    """Make lines of the points whose descriptions begin with a line code.

    Parameters
    ----------
    survey : Survey
        With the attribute ``description``; ``number`` gives the order of the points, else the
        rows do. The points stay as they are.
    rules : mapping of str to str, optional
        Codes and what their lines become: ``hard``, ``soft``, ``boundary``, ``hole``, ``erase`` or
        ``water``. Default ``RULES``.

    Returns
    -------
    Survey
        With the lines added to its own. Water is level at the median of its points. ``notes``
        names marks that are unknown, and are taken for a remark, and lines that are left out, of
        one point or rings of fewer than three.

    Raises
    ------
    LinesError
        If there are no descriptions or no line codes.
    OptionError
        If a rule gives a code another role.

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
    if not isinstance(survey, Survey):
        raise OptionError("survey", survey, "a Survey")
    roles = _require_rules(RULES if rules is None else rules)
    found, notes = _follow_lines(survey, roles)
    runs = [run for run in found if len(run.rows) >= _count_least(run)]
    notes += _note_short_lines(survey, [run for run in found if len(run.rows) < _count_least(run)])
    ponds = [_make_water(survey, run) for run in runs if run.role == "water"]
    return replace(
        survey,
        breaklines=[
            *survey.breaklines,
            *(_make_breakline(survey, r) for r in _select_roles(runs, "hard", "soft")),
        ],
        boundary=[
            *survey.boundary,
            *(survey.points[r.rows] for r in _select_roles(runs, "boundary")),
        ],
        holes=[*survey.holes, *(survey.points[r.rows] for r in _select_roles(runs, "hole"))],
        erase=[*survey.erase, *(survey.points[r.rows, :2] for r in _select_roles(runs, "erase"))],
        water=[*survey.water, *ponds],
        notes=[
            *survey.notes,
            *notes,
            *(_note_water_level(survey, r) for r in _select_roles(runs, "water")),
        ],
    )


def _require_rules(rules: Mapping[str, LineRole]) -> dict[str, LineRole]:
    if not isinstance(rules, Mapping):
        raise OptionError("rules", rules, "a mapping of codes to roles")
    for code, role in rules.items():
        if role not in get_args(LineRole):
            roles = ", ".join(get_args(LineRole))
            raise OptionError("rules", {code: role}, f"a role for each code, one of {roles}")
    return {code.upper(): role for code, role in rules.items()}


def _select_roles(runs: Iterable[_Run], *roles: LineRole) -> list[_Run]:
    return [run for run in runs if run.role in roles]


# ------------------------------------------------------------------------- codes


def _follow_lines(survey: Survey, roles: Mapping[str, LineRole]) -> tuple[list[_Run], list[str]]:
    """Follow every line through the points, in the order of the first point of each.

    Also say which marks are unknown.
    """
    runs: list[_Run] = []
    running: dict[str, _Run] = {}
    unknown: list[tuple[int, str]] = []
    for row, name, role, mark in _iterate_coded(survey, roles):
        meaning = MARKS.get(mark.upper(), "") if mark else ""
        if mark and not meaning:
            unknown.append((row, mark))
        if name not in running or meaning == "begin":
            running[name] = _Run(name, role, [])
            runs.append(running[name])
        running[name].rows.append(row)
        if meaning in ("end", "close"):
            running.pop(name).is_closed = meaning == "close"
    if not runs:
        raise LinesError(f"No description begins with a line code: {', '.join(roles)} are known.")
    return runs, _mark_notes(survey, unknown)


def _iterate_coded(
    survey: Survey, roles: Mapping[str, LineRole]
) -> Iterator[tuple[int, str, LineRole, str]]:
    """Walk the points of lines: row, name of the line, role and mark."""
    if "description" not in survey.attributes:
        raise LinesError(
            "The points have no descriptions to read codes from: a column 'description' is needed."
        )
    descriptions = survey.attributes["description"].tolist()
    for row in _order_by_number(survey).tolist():
        found = _CODE.match(str(descriptions[row] or ""))
        role = None if found is None else roles.get(found["code"].upper())
        if found is not None and role is not None:
            rest = found["rest"]
            mark = "" if rest.startswith(_NOTE) else re.split(r"[\s,/;\"(]", rest, maxsplit=1)[0]
            yield row, found["code"].upper() + found["number"], role, mark


def _order_by_number(survey: Survey) -> NDArray[np.int64]:
    numbers = survey.attributes.get("number")
    if numbers is None or numbers.dtype.kind not in "iu":
        return np.arange(len(survey))
    return np.argsort(numbers, kind="stable")


# --------------------------------------------------------------------- sentences


def _name_point(survey: Survey, row: int) -> str:
    numbers = survey.attributes.get("number")
    return f"row {row}" if numbers is None else f"point {numbers[row]}"


def _mark_notes(survey: Survey, unknown: list[tuple[int, str]]) -> list[str]:
    if not unknown:
        return []
    shown = ", ".join(f"'{mark}' at {_name_point(survey, row)}" for row, mark in unknown[:_SHOWN])
    more = " ..." if len(unknown) > _SHOWN else ""
    marks = "mark behind line codes is" if len(unknown) == 1 else "marks behind line codes are"
    return [
        f"{len(unknown)} unknown {marks} taken for remarks ({shown}{more}): "
        f"{', '.join(MARKS)} are known; a remark stands in quotes or behind a comma, / or ;."
    ]


def _note_short_lines(survey: Survey, short: list[_Run]) -> list[str]:
    if not short:
        return []
    shown = ", ".join(
        f"{run.name}: {', '.join(_name_point(survey, row) for row in run.rows)}"
        for run in short[:_SHOWN]
    )
    more = " ..." if len(short) > _SHOWN else ""
    have = "line is left out, which has" if len(short) == 1 else "lines are left out, which have"
    return [
        f"{len(short)} {have} too few points ({shown}{more}): a line needs two, a closed one three."
    ]


def _count_least(run: _Run) -> int:
    return 3 if run.is_closed or run.role not in ("hard", "soft") else 2


def _note_water_level(survey: Survey, run: _Run) -> str:
    z = survey.points[run.rows, 2]
    return (
        f"Water {run.name} is level at {np.median(z):.3f}, the median of its {len(z)} points "
        f"({z.min():.3f} to {z.max():.3f})."
    )


# ------------------------------------------------------------------------- lines


def _make_breakline(survey: Survey, run: _Run) -> Breakline:
    rows = [*run.rows, run.rows[0]] if run.is_closed else run.rows
    kind: BreaklineKind = "soft" if run.role == "soft" else "hard"
    return Breakline(survey.points[rows], kind=kind, name=run.name)


def _make_water(survey: Survey, run: _Run) -> Water:
    points = survey.points[run.rows]
    return Water(points[:, :2], float(np.median(points[:, 2])), name=run.name)
