"""Counts of points: rasters of points without a surface."""

from .point_rasters import check_options as check_options
from .point_rasters import compute as compute
from .point_rasters import join as join
from .point_rasters import settle_options as settle_options

IS_OF_SURFACE = False
