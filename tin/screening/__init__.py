"""Screening: what looks wrong with the points and lines of a TIN, and gaps that it spans."""

from .notes import describe_findings
from .searching import Screening, inspect_points, screen_points

__all__ = ["Screening", "describe_findings", "inspect_points", "screen_points"]
