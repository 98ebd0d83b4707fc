"""Write a TIN as IFC 4."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING, Any

import ifcopenshell
import ifcopenshell.guid
import numpy as np

from tinsmith import FormatError
from tinsmith.base.crs import scale_elevations

if TYPE_CHECKING:
    from pathlib import Path

    from tinsmith import CRS, TIN

__all__ = ["write"]

_NO_CLOCK = "1970-01-01T00:00:00"
"""Time in the header: the same TIN gives the same bytes."""


def write(tin: TIN, path: Path, *, name: str = "Terrain") -> None:
    """Write a TIN as an IfcSite whose shape is an IfcTriangulatedFaceSet.

    Parameters
    ----------
    tin : TIN
        Its CRS must be a projected one.
    path : Path
    name : str
        Of the project and the site.

    Raises
    ------
    FormatError
        If the CRS is not known, or coordinates are longitude and latitude.
    """
    crs = _require_projected(tin.crs, path)
    points = tin.points * [1.0, 1.0, scale_elevations(crs, tin.elevation_unit)]
    origin = np.floor(points.min(axis=0))
    model = ifcopenshell.file(schema="IFC4")
    unit = _add_unit(model, crs)
    context = _add_context(model, crs, unit, origin)
    shape = _add_shape(model, context, points - origin, tin.triangles)
    _add_site(model, context, unit, shape, name)
    model.header.file_name.time_stamp = _NO_CLOCK
    beside = path.with_name(f".{path.name}.new")
    try:
        model.write(str(beside))
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def _require_projected(crs: CRS | None, path: Path) -> CRS:
    if crs is None or crs.is_geographic:
        found = "not known" if crs is None else f"{crs.label}, of longitude and latitude"
        raise FormatError(
            f"Cannot write '{path}': the CRS is {found}; IFC needs eastings and northings."
        )
    return crs


def _add_unit(model: Any, crs: CRS) -> Any:
    """Add the unit of all lengths: that of the eastings."""
    metre = model.create_entity("IfcSIUnit", UnitType="LENGTHUNIT", Name="METRE")
    if crs.horizontal_unit.metres == 1.0:
        return metre
    factor = model.create_entity(
        "IfcMeasureWithUnit",
        ValueComponent=model.create_entity("IfcLengthMeasure", crs.horizontal_unit.metres),
        UnitComponent=metre,
    )
    return model.create_entity(
        "IfcConversionBasedUnit",
        Dimensions=model.create_entity("IfcDimensionalExponents", 1, 0, 0, 0, 0, 0, 0),
        UnitType="LENGTHUNIT",
        Name=crs.horizontal_unit.name,
        ConversionFactor=factor,
    )


def _add_context(model: Any, crs: CRS, unit: Any, origin: Any) -> Any:
    """Add the context of the shape, and where its origin lies on the map."""
    place = model.create_entity(
        "IfcAxis2Placement3D",
        Location=model.create_entity("IfcCartesianPoint", (0.0, 0.0, 0.0)),
    )
    context = model.create_entity(
        "IfcGeometricRepresentationContext",
        ContextType="Model",
        CoordinateSpaceDimension=3,
        Precision=1e-6,
        WorldCoordinateSystem=place,
    )
    target = model.create_entity(
        "IfcProjectedCRS", Name=crs.label, Description=crs.name, MapUnit=unit
    )
    easting, northing, elevation = origin.tolist()
    model.create_entity(
        "IfcMapConversion",
        SourceCRS=context,
        TargetCRS=target,
        Eastings=easting,
        Northings=northing,
        OrthogonalHeight=elevation,
    )
    return context


def _add_shape(model: Any, context: Any, points: Any, triangles: Any) -> Any:
    corners = model.create_entity("IfcCartesianPointList3D", points.tolist())
    faces = model.create_entity(
        "IfcTriangulatedFaceSet",
        Coordinates=corners,
        Closed=False,
        CoordIndex=(triangles + 1).tolist(),
    )
    representation = model.create_entity(
        "IfcShapeRepresentation",
        ContextOfItems=context,
        RepresentationIdentifier="Body",
        RepresentationType="Tessellation",
        Items=[faces],
    )
    return model.create_entity("IfcProductDefinitionShape", Representations=[representation])


def _add_site(model: Any, context: Any, unit: Any, shape: Any, name: str) -> None:
    project = model.create_entity(
        "IfcProject",
        GlobalId=_make_guid("project", name),
        Name=name,
        RepresentationContexts=[context],
        UnitsInContext=model.create_entity("IfcUnitAssignment", Units=[unit]),
    )
    placement = model.create_entity(
        "IfcLocalPlacement", RelativePlacement=context.WorldCoordinateSystem
    )
    site = model.create_entity(
        "IfcSite",
        GlobalId=_make_guid("site", name),
        Name=name,
        ObjectPlacement=placement,
        Representation=shape,
        CompositionType="ELEMENT",
    )
    model.create_entity(
        "IfcRelAggregates",
        GlobalId=_make_guid("whole", name),
        RelatingObject=project,
        RelatedObjects=[site],
    )


def _make_guid(*words: str) -> str:
    """Return an identifier that is the same for the same words."""
    found = uuid.uuid5(uuid.NAMESPACE_URL, "/".join(("tinsmith-ifc", *words)))
    return str(ifcopenshell.guid.compress(found.hex))
