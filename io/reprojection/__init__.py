"""Coordinates from one CRS to another, and whether they lie where a CRS applies."""
