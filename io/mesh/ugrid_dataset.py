"""TINs as data sets of xarray by the conventions of UGRID 1.0, for xugrid and others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ...base import optional
from ...base.checks import require_tin
from ...base.products import product
from .ugrid import write_content

if TYPE_CHECKING:
    from ...tin import TIN

__all__ = ["to_ugrid"]


@product
def to_ugrid(tin: TIN) -> Any:
    """Return a TIN as a data set of xarray by the conventions of UGRID.

    Parameters
    ----------
    tin : TIN

    Returns
    -------
    xarray.Dataset
        What a UGRID file of the TIN holds: the topology ``mesh2d``, ``mesh2d_node_x``,
        ``mesh2d_node_y`` and ``mesh2d_node_z`` in double precision, ``mesh2d_face_nodes``, the CRS
        in ``projected_coordinate_system``; where there are lines the edges with their type.
        ``xugrid.UgridDataset`` takes it.

    Raises
    ------
    MissingExtraError
        If xarray or netCDF4 is not installed.
    PointsError
        If ``tin`` is none.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
    >>> ts.to_ugrid(tin)["mesh2d_node_z"].values
    array([5., 6., 7., 8.])
    """
    xarray = optional.load("xarray", "Turning a TIN into a data set of UGRID")
    netcdf = optional.load("netCDF4", "Turning a TIN into a data set of UGRID")
    require_tin(tin)
    with netcdf.Dataset("tin.nc", "w", format="NETCDF4", diskless=True, persist=False) as data:
        write_content(data, tin)
        data.set_auto_mask(False)
        variables = {
            name: (one.dimensions, one[...], {key: one.getncattr(key) for key in one.ncattrs()})
            for name, one in data.variables.items()
        }
        about = {key: data.getncattr(key) for key in data.ncattrs()}
    made = xarray.Dataset(variables, attrs=about)
    for one in made.variables.values():  # where xarray looks for it when it writes
        if "_FillValue" in one.attrs:
            one.encoding["_FillValue"] = one.attrs.pop("_FillValue")
    return made.set_coords([name for name in made if str(name).endswith(("_node_x", "_node_y"))])
