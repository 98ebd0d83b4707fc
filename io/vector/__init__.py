"""Lines and polygons of vector files, through GDAL in a child process."""
