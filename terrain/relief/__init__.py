"""Relief of a surface: classes of slope and aspect, statistics, hillshade, curvature."""

from .classes import aspect_classes, slope_classes
from .curvatures import curvature
from .shading import hillshade
from .statistics import slope_statistics

__all__ = ["aspect_classes", "curvature", "hillshade", "slope_classes", "slope_statistics"]
