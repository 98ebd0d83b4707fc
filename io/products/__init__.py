"""Files of products: features for GIS, rasters, tables."""
