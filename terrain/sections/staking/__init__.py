"""Staking: lists of points to set out, and coordinates on the ground instead of the grid."""

from .factors import CombinedFactor, combined_factor
from .stakeout_points import stake_points, stakeout

__all__ = ["CombinedFactor", "combined_factor", "stake_points", "stakeout"]
