"""Parameters of the ground filter: one set for all terrain, in metres and degrees."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from ...base.checks import as_length, as_number
from ...base.errors import OptionError, choice
from ...base.policies import GroundReturns


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
            as_length(name, getattr(self, name), unit="in metres")
        for name in ("tolerance", "horizontal_tolerance"):
            as_number(name, getattr(self, name), "a length", least=0, unit="in metres")
        as_number("terrain_slope", self.terrain_slope, "a rise per length", above=0)
        angle = "iteration_angle", self.iteration_angle
        as_number(*angle, "an angle", above=0, below=90, unit="degrees")
        choice("returns", self.returns, GroundReturns)
        if self.cell > self.building:
            raise OptionError("cell", self.cell, f"no more than building, {self.building:g} m")

    def to_dict(self) -> dict[str, Any]:
        """Return all by their names."""
        return asdict(self)
