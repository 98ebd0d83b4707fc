"""Which points may be ground by what their attributes say."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...base.sentences import counted

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ...base.arrays import AnyArray, BoolArray
    from ...base.policies import GroundReturns

ATTRIBUTES = ("return_number", "number_of_returns", "classification")
"""Attributes that are looked at."""

_NOISE = (7, 18)
"""Low noise and high noise, by the ASPRS LAS specification 1.4."""


@dataclass
class Candidates:
    """Which points may be ground, of a survey or of its parts one after the other.

    A pulse that went through leaves has several returns, and only the last can be the ground.
    Numbers that make no sense tell nothing. Points that are given as noise are none.
    """

    returns: GroundReturns
    total: int = 0
    """Points so far."""
    odd: int = 0
    others: int = 0
    """Both, those whose numbers of returns make no sense, and those of returns that are not the
    last."""

    def find(self, attributes: Mapping[str, AnyArray], count: int) -> BoolArray:
        """Tell which of some points may be ground; (count,) array."""
        self.total += count
        may_be = ~are_noise(attributes, count)
        own, of = (_find_numbers(attributes, name) for name in ATTRIBUTES[:2])
        if self.returns == "last" and own is not None and of is not None:
            is_sound = (own >= 1) & (own <= of)
            is_last = ~is_sound | (own == of)
            self.odd += int((~is_sound).sum())
            self.others += int((~is_last).sum())
            may_be &= is_last
        return may_be

    @property
    def notes(self) -> tuple[str, ...]:
        """What is to be said of them."""
        notes = []
        if self.odd:
            notes.append(
                f"{counted(self.odd, 'point')} of {self.total:,} had a number of return that does "
                "not fit the number of returns: they were taken as last ones."
            )
        if self.others:
            notes.append(
                f"{counted(self.others, 'point')} of {self.total:,} were no last return: they were "
                "not taken as ground."
            )
        return tuple(notes)


def are_noise(attributes: Mapping[str, AnyArray], count: int) -> BoolArray:
    """Tell which points are given as noise."""
    classes = _find_numbers(attributes, "classification")
    return np.zeros(count, bool) if classes is None else np.isin(classes, _NOISE)


def _find_numbers(attributes: Mapping[str, AnyArray], name: str) -> AnyArray | None:
    values = attributes.get(name)
    return values if values is not None and values.dtype.kind in "iuf" else None
