"""Readers, writers and the registry of formats."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..errors import CrsError, FormatError, OptionError, ReadError, WriteError
    from .field_survey import field_codes as field_codes
    from .field_survey.field_codes import lines_from_codes
    from .mesh.libraries import from_mesh, to_meshio, to_pyvista, to_trimesh
    from .mesh.ugrid_dataset import to_ugrid
    from .raster.elevations import read_raster
    from .raster.libraries import from_raster, to_rasterio
    from .reading import read, read_points, read_tin
    from .registry import Format, find_format, known_formats
    from .reprojection.surfaces import reproject
    from .reprojection.transformation import LengthUnit, length_unit, transform_points
    from .vector.libraries import to_features
    from .vector.reading import read_lines, read_polygons, read_rings, read_water
    from .vector.survey_lines import with_lines
    from .writing import write
else:  # a type checker takes every name for one that such a __getattr__ has
    from .._lazy import lazy_names

    # The processes that read files for native libraries start without what they do not use.
    __getattr__, __dir__ = lazy_names(
        __name__,
        {
            ".vector.libraries": ("to_features",),
            ".mesh.libraries": ("from_mesh", "to_meshio", "to_pyvista", "to_trimesh"),
            ".raster.elevations": ("read_raster",),
            ".raster.libraries": ("from_raster", "to_rasterio"),
            ".mesh.ugrid_dataset": ("to_ugrid",),
            ".field_survey": ("field_codes",),  # where the module was before
            ".field_survey.field_codes": ("lines_from_codes",),
            ".reprojection.surfaces": ("reproject",),
            ".reprojection.transformation": ("LengthUnit", "length_unit", "transform_points"),
            "..errors": ("CrsError", "FormatError", "OptionError", "ReadError", "WriteError"),
            ".reading": ("read", "read_points", "read_tin"),
            ".registry": ("Format", "find_format", "known_formats"),
            ".vector.reading": ("read_lines", "read_polygons", "read_rings", "read_water"),
            ".vector.survey_lines": ("with_lines",),
            ".writing": ("write",),
        },
    )

__all__ = [
    "CrsError",
    "Format",
    "FormatError",
    "LengthUnit",
    "OptionError",
    "ReadError",
    "WriteError",
    "find_format",
    "from_mesh",
    "from_raster",
    "known_formats",
    "length_unit",
    "lines_from_codes",
    "read",
    "read_lines",
    "read_points",
    "read_polygons",
    "read_raster",
    "read_rings",
    "read_tin",
    "read_water",
    "reproject",
    "to_features",
    "to_meshio",
    "to_pyvista",
    "to_rasterio",
    "to_trimesh",
    "to_ugrid",
    "transform_points",
    "with_lines",
    "write",
]
