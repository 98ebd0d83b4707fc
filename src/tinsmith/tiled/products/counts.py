"""Counts of points: rasters of points without a surface."""

from dataclasses import replace

from . import point_rasters

PRODUCT = replace(point_rasters.PRODUCT, is_of_surface=False)
