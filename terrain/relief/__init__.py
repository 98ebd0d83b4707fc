"""Relief: slope, aspect and light, their classes and statistics, hillshade, curvature."""
