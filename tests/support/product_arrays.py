"""The arrays of whatever a call returns, to compare what two calls did."""

from __future__ import annotations

from typing import Any

import numpy as np

import tinsmith as ts


def list_arrays(made: Any) -> list[Any]:
    """Return all arrays of a result."""
    if isinstance(made, ts.TIN):
        return [made.points, made.triangles, made.neighbors, made.vertex_of]
    if isinstance(made, ts.Survey):
        return [made.points, *made.attributes.values()]
    if isinstance(made, ts.Difference):
        return [*list_arrays(made.tin), np.array([made.cut, made.fill])]
    if isinstance(made, ts.GroundPoints):
        return [made.classification, made.heights]
    if isinstance(made, ts.Raster):
        return [band[:, :] for band in made.bands.values()]
    if isinstance(made, ts.Features):
        return [made.coordinates, *made.columns.values()]
    return [made[name] for name in made.columns]
