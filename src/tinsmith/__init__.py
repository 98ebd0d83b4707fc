"""tinsmith: exact terrain surfaces (TINs) from elevation points.

>>> import tinsmith as ts
>>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [4, 3, 7], [0, 3, 8]])
>>> tin.interpolate([[2.0, 1.0]]).round(3)
array([6.5])
"""

from .base.lazy import lazy_names, register_methods

# What tin cannot do itself, for it knows no pictures, features and files.
register_methods(
    {
        "TIN._repr_html_": "tinsmith.terrain.viewer.html_repr:make_html_repr",
        "Snapshot._repr_html_": "tinsmith.terrain.viewer.html_repr:make_html_repr",
        "Surface.findings": "tinsmith.tin.screening:describe_findings",
        "Survey._repr_html_": "tinsmith.terrain.drawing.html_repr.survey:make_survey_html",
        "Report._repr_html_": "tinsmith.terrain.drawing.html_repr.survey:make_report_html",
        "Features._repr_html_": "tinsmith.terrain.drawing.html_repr.results:make_features_html",
        "Raster._repr_html_": "tinsmith.terrain.drawing.html_repr.results:make_raster_html",
        "Table._repr_html_": "tinsmith.terrain.drawing.html_repr.results:make_table_html",
        "TIN.plot": "tinsmith.terrain.charts.triangles:plot_tin",
        "TIN.to_crs": "tinsmith.io.reprojection.surfaces:reproject",
        "TIN.to_geodataframe": "tinsmith.io.vector.interop:build_frame",
        "TIN.__geo_interface__": "tinsmith.io.vector.interop:build_collection",
        "TIN.__arrow_c_stream__": "tinsmith.io.vector.interop:build_stream",
    }
)

__getattr__, __dir__, __all__ = lazy_names(
    __name__,
    dict.fromkeys(  # they read the file of `like`, too
        ("hillshade", "rasterize", "rasterize_canopy", "rasterize_counts", "rasterize_heights"),
        ".io.raster.target_grid",
    ),
)
__all__ += ["__version__"]

__version__ = "0.1.0"
