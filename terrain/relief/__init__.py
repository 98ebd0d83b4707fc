"""Relief: slope, aspect and light, their classes and statistics, hillshade, curvature."""

from .light import Light, as_light
from .measures import PlaneMeasure

__all__ = ["Light", "PlaneMeasure", "as_light"]
