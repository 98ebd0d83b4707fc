"""Codes of several files: each is read by itself, since a line ends with the file it is in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import LinesError
from ...base.types import RowSources
from ..reprojection import SOURCE_FILE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Int64Array
    from ...tin import Survey

_LINES = ("breaklines", "boundary", "holes", "erase", "water")
_SHOWN = 5


class NoCodesError(LinesError):
    """No description begins with a code."""


def split_files(survey: Survey) -> dict[str, Int64Array]:
    """Return the rows of each file of which a survey was joined; none for a single one."""
    files = survey.attributes.get(SOURCE_FILE)
    if files is None:
        return {}
    names, number = np.unique([str(one) for one in files.tolist()], return_inverse=True)
    rows = {str(name): np.flatnonzero(number == i) for i, name in enumerate(names)}
    in_order = sorted(rows.items(), key=lambda item: int(item[1][0]))
    return dict(in_order) if len(rows) > 1 else {}


def read_each_file(
    survey: Survey, files: dict[str, Int64Array], read: Callable[[Survey], Survey]
) -> Survey:
    """Return the survey with the lines of each of its files."""
    made: dict[str, Survey] = {}
    faults: list[NoCodesError] = []
    for name, rows in files.items():
        # Some points of a survey, without its lines and what is known of it.
        nothing: dict[str, Any] = dict.fromkeys((*_LINES, "extent", "notes", "findings"), ())
        part = replace(
            survey,
            points=survey.points[rows],
            attributes={name: column[rows] for name, column in survey.attributes.items()},
            skipped={},
            skipped_lines={},
            row_sources=None if survey.row_sources is None else survey.row_sources.take(rows),
            **nothing,
        )
        try:
            made[name] = read(part)
        except NoCodesError as error:
            made[name] = part
            faults.append(error)
        except LinesError as error:
            raise LinesError(f"'{name}': {error}") from error
    if len(faults) == len(files):
        raise faults[0]
    return _join(survey, made, list(files.values()))


def _join(survey: Survey, made: dict[str, Survey], rows: Sequence[Int64Array]) -> Survey:
    parts = list(made.values())
    skipped = dict(survey.skipped)
    for part in parts:
        for what, count in part.skipped.items():
            skipped[what] = skipped.get(what, 0) + count
    lines: dict[str, Any] = {
        kind: [*getattr(survey, kind), *(line for part in parts for line in getattr(part, kind))]
        for kind in _LINES
    }
    return replace(
        survey,
        points=np.vstack([part.points for part in parts]),
        attributes={
            name: np.concatenate([part.attributes[name] for part in parts])
            for name in survey.attributes
        },
        skipped=skipped,
        row_sources=_join_sources(parts),
        notes=[
            *survey.notes,
            *(f"'{name}': {note}" for name, part in made.items() for note in part.notes),
            *_describe_shared_names(made),
        ],
        findings=[
            *survey.findings,
            *(
                finding._replace(rows=tuple(own[list(finding.rows)].tolist()))
                for part, own in zip(parts, rows, strict=True)
                for finding in part.findings
            ),
        ],
        **lines,
    )


def _join_sources(parts: Sequence[Survey]) -> RowSources | None:
    """Return the sources of the rows of parts of one survey, all of which name its files."""
    known = [part.row_sources for part in parts if part.row_sources is not None]
    if len(known) < len(parts):
        return None
    file_of, lines = (np.concatenate([one[k] for one in known]) for k in (1, 2))
    return RowSources(known[0].files, file_of, lines)


def _describe_shared_names(made: dict[str, Survey]) -> list[str]:
    """Tell of lines of one name in several files, which crews may have meant as one."""
    files: dict[str, list[str]] = {}
    for name, part in made.items():
        for line in {one.name for one in (*part.breaklines, *part.water)}:  # type: ignore[union-attr]
            files.setdefault(line, []).append(name)
    shared = sorted(line for line, names in files.items() if len(names) > 1)
    if not shared:
        return []
    shown = ", ".join(shared[:_SHOWN]) + (" ..." if len(shared) > _SHOWN else "")
    return [
        f"Lines end with their file: those of one name in several files ({shown}) were not joined."
    ]
