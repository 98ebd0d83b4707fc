"""Contour lines as what a TIN is built of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..base.sentences import counted
from .output.failures import Failure

if TYPE_CHECKING:
    from pathlib import Path

    from ..tin import Survey
    from .options import Reading

__all__ = ["as_contours", "require_contours"]


def as_contours(reading: Reading) -> Reading:
    """Return the options of reading that take lines as breaklines, where a format has a choice.

    Raises
    ------
    click.UsageError
        If they are to be taken as something else.
    """
    given = reading.options.get("lines_as")
    if given == "points":
        raise click.UsageError("--from-contours takes lines as breaklines, --lines-as as points.")
    return reading.with_fallback(lines_as="breaklines")


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
