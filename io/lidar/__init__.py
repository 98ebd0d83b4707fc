"""Lidar: LAS, LAZ and COPC point clouds, read and written through laspy."""
