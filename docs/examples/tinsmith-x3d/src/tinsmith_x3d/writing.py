"""Write a TIN as X3D 4.0."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.sax.saxutils import quoteattr

import numpy as np

from tinsmith import FormatError
from tinsmith.base.crs import scale_elevations

if TYPE_CHECKING:
    from pathlib import Path

    from tinsmith import CRS, TIN

__all__ = ["write"]


def write(tin: TIN, path: Path, *, exaggeration: float = 1.0) -> None:
    """Write a TIN as a scene of X3D with one IndexedTriangleSet.

    Parameters
    ----------
    tin : TIN
        Its CRS must be a projected one.
    path : Path
    exaggeration : float
        Factor of elevations.

    Raises
    ------
    FormatError
        If the CRS is not known, or coordinates are longitude and latitude.
    """
    crs = _require_projected(tin.crs, path)
    points = tin.points * [1.0, 1.0, scale_elevations(crs, tin.elevation_unit)]
    origin = np.floor(points.min(axis=0))
    x, y, z = (points - origin).T
    rows = np.column_stack([x, z * exaggeration, -y])  # X3D has the Y axis up
    text = _format(crs, origin, rows, tin.triangles)
    beside = path.with_name(f".{path.name}.new")
    try:
        beside.write_text(text, encoding="utf-8")
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def _require_projected(crs: CRS | None, path: Path) -> CRS:
    if crs is None or crs.is_geographic:
        found = "not known" if crs is None else f"{crs.label}, of longitude and latitude"
        raise FormatError(
            f"Cannot write '{path}': the CRS is {found}; the scene needs eastings and northings."
        )
    return crs


def _format(
    crs: CRS,
    origin: np.ndarray,
    rows: np.ndarray,
    triangles: np.ndarray,
) -> str:
    start = " ".join(map(repr, origin.tolist()))
    index = " ".join(map(str, triangles.ravel().tolist()))
    point = ", ".join(" ".join(map(repr, row)) for row in rows.tolist())
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n<X3D profile="Interchange" version="4.0">\n'
        "<head>\n"
        f'<meta name="crs" content={quoteattr(crs.label)}/>\n'
        f'<meta name="origin" content="{start}"/>\n</head>\n<Scene>\n<Shape>\n'
        "<Appearance><Material/></Appearance>\n"
        f'<IndexedTriangleSet solid="false" index="{index}">\n<Coordinate point="{point}"/>\n'
        "</IndexedTriangleSet>\n</Shape>\n</Scene>\n</X3D>\n"
    )
