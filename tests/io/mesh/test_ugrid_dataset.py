"""Data sets by the conventions of UGRID, opened by xugrid."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from support.surfaces import hills

import tinsmith as ts

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # that numba is not there
    import xugrid


@pytest.mark.filterwarnings("ignore")  # of xugrid, about what it does without numba
def test_xugrid_opens_it():
    tin = hills(crs="EPSG:32616")
    opened = xugrid.UgridDataset(ts.to_ugrid(tin))
    grid = opened.ugrid.grid
    np.testing.assert_array_equal(grid.node_x, tin.points[:, 0])
    np.testing.assert_array_equal(grid.node_y, tin.points[:, 1])
    np.testing.assert_array_equal(grid.face_node_connectivity, tin.triangles)
    np.testing.assert_allclose(grid.area, tin.triangle_areas, rtol=1e-9)
    np.testing.assert_array_equal(opened["mesh2d_node_z"].values, tin.points[:, 2])
    assert opened["mesh2d_node_z"].attrs["standard_name"] == "altitude"


def test_it_is_the_file_of_the_tin(tmp_path):
    tin = hills(crs="EPSG:32616")
    made = ts.to_ugrid(tin)
    made.to_netcdf(tmp_path / "a.nc")
    back = ts.read(tmp_path / "a.nc")
    wanted = ts.read(ts.write(tin, tmp_path / "b.nc"))
    assert back == wanted
    assert made["projected_coordinate_system"].attrs["epsg"] == 32616
    with pytest.raises(ts.PointsError, match="Invalid TIN"):
        ts.to_ugrid(5)
