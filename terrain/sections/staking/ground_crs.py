"""The CRS of coordinates on the ground: derived from that of the grid by an affine transformation.

OGC 18-005r4 (ISO 19111), method EPSG:9624.
"""

from __future__ import annotations

from typing import Any

from ....base import optional
from ....base.crs import CRS
from ....base.georeference import gives_northing_first

_SCHEMA = "https://proj.org/schemas/v0.7/projjson.schema.json"
_SCALE = {"type": "Unit", "name": "coefficient", "conversion_factor": 1}
_CODES = {"A0": 8623, "A1": 8624, "A2": 8625, "B0": 8639, "B1": 8640, "B2": 8641}


def derive_ground_crs(crs: CRS, factor: float, base: tuple[float, float]) -> CRS:
    """Return the CRS of coordinates that are ``base + (grid - base) / factor``."""
    pyproj: Any = optional.load("pyproj", "A CRS")
    flat = crs.horizontal
    grid: Any = flat.to_pyproj().to_json_dict()
    axes = grid["coordinate_system"]
    scale = 1.0 / factor
    moved = [one * (1.0 - scale) for one in base]
    first, second = moved[::-1] if gives_northing_first(flat) else moved
    values = {"A0": first, "A1": scale, "A2": 0.0, "B0": second, "B1": 0.0, "B2": scale}
    unit = axes["axis"][0]["unit"]
    name = f"{flat.name}, ground (combined factor {factor:.10g})"
    made: dict[str, Any] = {
        "$schema": _SCHEMA,
        "type": "DerivedProjectedCRS",
        "name": name,
        "base_crs": grid,
        "conversion": {
            "name": "Grid to ground",
            "method": {
                "name": "Affine parametric transformation",
                "id": {"authority": "EPSG", "code": 9624},
            },
            "parameters": [
                {
                    "name": one,
                    "value": value,
                    "unit": unit if one in ("A0", "B0") else _SCALE,
                    "id": {"authority": "EPSG", "code": _CODES[one]},
                }
                for one, value in values.items()
            ],
        },
        "coordinate_system": axes,
    }
    if "bbox" in grid:
        made["bbox"] = grid["bbox"]
    parsed = pyproj.CRS.from_json_dict(made)
    parts = crs.to_pyproj().sub_crs_list
    if len(parts) > 1:
        parsed = pyproj.crs.CompoundCRS(f"{name} + {parts[1].name}", [parsed, parts[1]])
    return CRS(parsed)
