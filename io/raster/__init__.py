"""Elevation rasters as points, through GDAL in a child process."""
