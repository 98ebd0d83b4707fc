"""Inspection: blunders, marks of missing data, gaps, and flat triangles of contour data."""
