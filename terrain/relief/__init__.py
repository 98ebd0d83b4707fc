"""Relief: slope, aspect and light, their classes and statistics, hillshade, curvature."""

from .statistics import PERCENTILES, as_table, name_percentiles, select_weighted_percentiles

__all__ = ["PERCENTILES", "as_table", "name_percentiles", "select_weighted_percentiles"]
