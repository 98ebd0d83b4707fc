"""The ground among lidar points: progressive densification of a TIN from cautious seeds."""

from .classification import GroundPoints, ground

__all__ = ["GroundPoints", "ground"]
