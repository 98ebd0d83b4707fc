"""Contour lines as what a TIN is built of."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

from ..base.sentences import counted
from .output.failures import Failure

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ..tin import Survey
    from .options import Reading

__all__ = ["as_contours", "require_contours"]


def as_contours(reading: Reading, paths: Sequence[Path]) -> Reading:
    """Return the options of reading that take lines as breaklines, where a format has a choice.

    Raises
    ------
    click.UsageError
        If they are to be taken as something else.
    """
    from ..io import known_formats

    if reading.lines_as == "points":
        raise click.UsageError("--from-contours takes lines as breaklines, --lines-as as points.")
    name = paths[0].name.lower()
    has_choice = any(
        (one.name == reading.format if reading.format else name.endswith(one.suffixes))
        and (one.read or "").startswith("tinsmith.io.vector.")
        for one in known_formats()
    )
    return replace(reading, lines_as="breaklines") if has_choice else reading


def require_contours(survey: Survey, path: Path) -> None:
    """Refuse a survey most of whose lines are not level.

    Raises
    ------
    Failure
    """
    import numpy as np

    lines = [np.asarray(getattr(line, "coords", line)) for line in survey.breaklines]
    if not lines:
        raise Failure(f"'{path}' has no lines: --from-contours needs contour lines.")
    level = sum(line.shape[1] == 3 and bool((line[:, 2] == line[0, 2]).all()) for line in lines)
    if 2 * level < len(lines):
        raise Failure(
            f"'{path}': of {counted(len(lines), 'line')} {level:,} are level: these are not "
            "contours, since all points of a contour have the same elevation."
        )
