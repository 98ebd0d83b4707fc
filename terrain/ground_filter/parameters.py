"""Parameters of the ground filter: one set for all terrain, in metres and degrees."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ...base.checks import is_finite_number
from ...base.errors import OptionError, choice
from ...base.policies import GroundReturns

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["Parameters"]


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """What :func:`tinsmith.ground` is told; lengths in metres."""

    building: float
    cell: float
    terrain_slope: float
    iteration_angle: float
    iteration_distance: float
    edge_length: float
    tolerance: float
    horizontal_tolerance: float
    noise_depth: float
    returns: GroundReturns

    def __post_init__(self) -> None:
        for name in ("building", "cell", "iteration_distance", "edge_length", "noise_depth"):
            _require(name, getattr(self, name), lambda x: x > 0, "a length > 0 in metres")
        for name in ("tolerance", "horizontal_tolerance"):
            _require(name, getattr(self, name), lambda x: x >= 0, "a length >= 0 in metres")
        _require("terrain_slope", self.terrain_slope, lambda x: x > 0, "a rise per length > 0")
        is_angle = "an angle above 0 and below 90 degrees"
        _require("iteration_angle", self.iteration_angle, lambda x: 0 < x < 90, is_angle)
        choice("returns", self.returns, GroundReturns)
        if self.cell > self.building:
            raise OptionError("cell", self.cell, f"no more than building, {self.building:g} m")

    def to_dict(self) -> dict[str, Any]:
        """Return all by their names."""
        return asdict(self)


def _require(name: str, value: Any, test: Callable[[float], bool], allowed: str) -> None:
    if not (is_finite_number(value) and test(float(value))):
        raise OptionError(name, value, allowed)
