"""The ground among lidar points: progressive densification of a TIN from cautious seeds."""

from .classification import GroundPoints, classify, find_units, ground, require_candidates
from .frame import Frame, Units
from .parameters import Parameters
from .returns import ATTRIBUTES, Candidates, are_noise

__all__ = [
    "ATTRIBUTES",
    "Candidates",
    "Frame",
    "GroundPoints",
    "Parameters",
    "Units",
    "are_noise",
    "classify",
    "find_units",
    "ground",
    "require_candidates",
]
