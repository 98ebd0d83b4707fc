"""Which points may be ground by what their attributes say."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base.sentences import counted

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray
    from ...base.policies import GroundReturns
    from ...tin import Survey

__all__ = ["are_noise", "may_be_ground"]

_NOISE = (7, 18)
"""Low noise and high noise, by the ASPRS LAS specification 1.4."""


def are_noise(survey: Survey) -> BoolArray:
    """Tell which points are given as noise."""
    classes = _find_numbers(survey, "classification")
    return np.zeros(len(survey), bool) if classes is None else np.isin(classes, _NOISE)


def may_be_ground(survey: Survey, returns: GroundReturns) -> tuple[BoolArray, tuple[str, ...]]:
    """Tell which points may be ground by their returns, and what is to be said of them.

    A pulse that went through leaves has several returns, and only the last can be the ground.
    Numbers that make no sense tell nothing.
    """
    everyone = np.ones(len(survey), bool)
    own = _find_numbers(survey, "return_number")
    of = _find_numbers(survey, "number_of_returns")
    if returns == "all" or own is None or of is None:
        return everyone, ()
    is_sound = (own >= 1) & (own <= of)
    notes = []
    if not is_sound.all():
        notes.append(
            f"{counted(int((~is_sound).sum()), 'point')} of {len(survey):,} had a number of return "
            "that does not fit the number of returns: they were taken as last ones."
        )
    may_be = ~is_sound | (own == of)
    if not may_be.all():
        notes.append(
            f"{counted(int((~may_be).sum()), 'point')} of {len(survey):,} were no last return: "
            "they were not taken as ground."
        )
    return may_be, tuple(notes)


def _find_numbers(survey: Survey, name: str) -> AnyArray | None:
    values = survey.attributes.get(name)
    return values if values is not None and values.dtype.kind in "iuf" else None
