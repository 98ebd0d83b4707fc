"""Write a TIN as terrain of IFC: a georeferenced site, triangles, lines.

Coordinates are relative to the lower south-west corner of the surface; IfcMapConversion and
IfcProjectedCRS tell where that lies. Without a CRS the placement of the site does.

References
----------
ISO 16739-1:2024 (IFC 4.3), IfcTriangulatedIrregularNetwork; ISO 16739-1:2018 (IFC 4).
"""

from __future__ import annotations

import hashlib
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....base.atomic import replacing
from ....base.crs import METRE, choose_wkt
from ....base.errors import OptionError, choice
from ....base.notes import warn
from ....base.policies import IfcVersion
from ....base.sentences import FILE
from ...mesh import require_tin
from ..drawing import choose_length_unit, list_lines, scale_elevations
from .step import (
    DERIVED,
    NONE,
    StepWriter,
    format_list,
    format_real,
    format_rows,
    make_identifier,
    quote,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from ....base.arrays import Float64Array
    from ....base.crs import CRS, Unit, UnitLike
    from ....base.progress import Tell
    from ....tin import TIN

_SCHEMAS = {"IFC4X3": "IFC4X3_ADD2", "IFC4": "IFC4"}
_PRECISION = 1e-6
_SIDES = ((2, 1), (0, 2), (1, 4))
"""Corners, and the bit of the edge opposite: the first edge joins the first two corners."""

_TYPES = {"hard": "BREAKLINE", "soft": "SOFTBREAKLINE"}
"""Types of lines as objects; others have their kind."""

_UNITS = {"foot": "FOOT", "US survey foot": "US SURVEY FOOT"}


class _Frame(NamedTuple):
    """What the shapes of a file share."""

    step: StepWriter
    version: IfcVersion
    identify: Callable[[str], str]
    """Returns the identifier of what a word names in this file."""
    context: str
    origin: Float64Array
    """(3,), where the coordinates begin."""


def write(
    surface: TIN,
    path: Path,
    *,
    version: IfcVersion = "IFC4X3",
    name: str | None = None,
    unit: UnitLike | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a TIN as terrain of IFC: an IfcGeographicElement in an IfcSite, and its lines.

    The triangles are an IfcTriangulatedIrregularNetwork, which tells constrained edges, in IFC 4 an
    IfcTriangulatedFaceSet; each line is an IfcGeographicElement with an IfcIndexedPolyCurve.

    Parameters
    ----------
    version : {"IFC4X3", "IFC4"}
        Schema of the file; IFC 4 for programs that do not read IFC 4.3.
    name : str, optional
        Name of the terrain, the site and the project; default that of the TIN, else "terrain".
    unit : Unit or str, optional
        Unit of coordinates and elevations, where the CRS does not tell. Without one the file has
        no units, and programs guess.

    Raises
    ------
    OptionError
        If there is no such version, the name is no text, or the unit is not that of the CRS.
    CrsError
        If coordinates are angles.

    Warns
    -----
    LossWarning
        If elevations are converted, as the file has one unit for all lengths, or their unit is not
        known.
    """
    choice("version", version, IfcVersion)
    tin = require_tin(surface, format_name="IFC")
    name = tin.name.strip() or "terrain" if name is None else name
    if not isinstance(name, str) or not name.strip():
        raise OptionError("name", name, "the name of the terrain")
    along, factor = choose_length_unit(tin, unit, is_known=_has_metres, format_name="IFC")
    if along is not None and unit is None and tin.elevation_unit is None:
        warn(f"{FILE}: the unit of elevations is not known, and is told to be {along.name}.")
    points = scale_elevations(tin.points, factor)
    origin = np.floor(points.min(axis=0))
    title = quote(name.strip())
    digest = hashlib.sha256(points.tobytes() + tin.triangles.tobytes()).hexdigest()
    identify = partial(make_identifier, digest)
    with replacing(path, binary=False) as file:
        step = StepWriter(file)
        step.begin(_SCHEMAS[version], name.strip())
        units = NONE if along is None else _add_units(step, along)
        frame = _Frame(step, version, identify, _add_context(step), origin)
        if tin.crs is not None and along is not None:
            _add_crs(frame, tin.crs, along)
        start = [0.0, 0.0, 0.0] if tin.crs is not None else origin.tolist()
        project = step.add(
            "IFCPROJECT",
            identify("project"),
            NONE,
            title,
            *[NONE] * 4,
            format_list([frame.context]),
            units,
        )
        place = _add_place(step, NONE, start)
        site = step.add(
            *("IFCSITE", identify("site"), NONE, title, NONE, NONE, place, NONE, NONE, ".ELEMENT."),
            *[NONE] * 5,
        )
        own = _add_place(step, place, [0.0, 0.0, 0.0])
        elements = [
            _add_terrain(frame, tin, points, title=title, place=own),
            *_add_lines(frame, tin, factor, own),
        ]
        step.add("IFCRELAGGREGATES", identify("whole"), *[NONE] * 3, project, format_list([site]))
        step.add(
            "IFCRELCONTAINEDINSPATIALSTRUCTURE",
            *(identify("content"), *[NONE] * 3, format_list(elements), site),
        )
        step.end()
    if progress is not None:
        progress(1.0)


def _has_metres(unit: Unit) -> bool:
    return unit.metres is not None


def _add_units(step: StepWriter, unit: Unit) -> str:
    """Add the units of lengths and of angles; return their assignment."""
    angle = step.add("IFCSIUNIT", DERIVED, ".PLANEANGLEUNIT.", NONE, ".RADIAN.")
    return step.add("IFCUNITASSIGNMENT", format_list([_add_length(step, unit), angle]))


def _add_length(step: StepWriter, unit: Unit) -> str:
    metre = step.add("IFCSIUNIT", DERIVED, ".LENGTHUNIT.", NONE, ".METRE.")
    if unit == METRE or unit.metres is None:
        return metre
    exponents = step.add("IFCDIMENSIONALEXPONENTS", "1", *"000000")
    value = f"IFCLENGTHMEASURE({format_real(unit.metres)})"
    factor = step.add("IFCMEASUREWITHUNIT", value, metre)
    name = quote(_UNITS.get(unit.name, unit.name))
    return step.add("IFCCONVERSIONBASEDUNIT", exponents, ".LENGTHUNIT.", name, factor)


def _add_point(step: StepWriter, place: list[float]) -> str:
    return step.add("IFCCARTESIANPOINT", format_list(map(format_real, place)))


def _add_place(step: StepWriter, within: str, start: list[float]) -> str:
    axes = step.add("IFCAXIS2PLACEMENT3D", _add_point(step, start), NONE, NONE)
    return step.add("IFCLOCALPLACEMENT", within, axes)


def _add_context(step: StepWriter) -> str:
    axes = step.add("IFCAXIS2PLACEMENT3D", _add_point(step, [0.0, 0.0, 0.0]), NONE, NONE)
    precision = format_real(_PRECISION)
    return step.add(
        "IFCGEOMETRICREPRESENTATIONCONTEXT", NONE, "'Model'", "3", precision, axes, NONE
    )


def _add_crs(frame: _Frame, crs: CRS, along: Unit) -> None:
    """Add the CRS, and where the origin of the coordinates lies in it."""
    step, code = frame.step, crs.to_epsg()
    label = quote(crs.label if code is None else f"EPSG:{code}")
    length = _add_length(step, along)
    target = step.add("IFCPROJECTEDCRS", label, quote(crs.name), *[NONE] * 4, length)
    if code is None and frame.version == "IFC4X3":
        step.add("IFCWELLKNOWNTEXT", quote(choose_wkt(crs)), target)
    place = map(format_real, frame.origin.tolist())
    step.add("IFCMAPCONVERSION", frame.context, target, *place, *[NONE] * 3)


def _add_terrain(frame: _Frame, tin: TIN, points: Float64Array, *, title: str, place: str) -> str:
    step = frame.step
    corners = _add_points(frame, points)
    parts = _format_triangles(tin, corners, has_flags=frame.version == "IFC4X3")
    entity = {"IFC4X3": "IFCTRIANGULATEDIRREGULARNETWORK", "IFC4": "IFCTRIANGULATEDFACESET"}
    faces = step.add_long(entity[frame.version], parts)
    shape = _add_shape(frame, "Body", "Tessellation", faces)
    return step.add(
        *("IFCGEOGRAPHICELEMENT", frame.identify("terrain"), NONE, title, NONE, NONE, place, shape),
        *(NONE, ".TERRAIN."),
    )


def _add_points(frame: _Frame, points: Float64Array) -> str:
    parts = [*format_rows(points - frame.origin), *([",$"] if frame.version == "IFC4X3" else [])]
    return frame.step.add_long("IFCCARTESIANPOINTLIST3D", parts)


def _format_triangles(tin: TIN, corners: str, *, has_flags: bool) -> Iterator[str]:
    yield f"{corners},$,.F.,"
    yield from format_rows(tin.triangles.astype(np.int64) + 1)
    yield ",$"
    if has_flags:
        sides = sum(tin.constrained[:, corner].astype(np.int64) * bit for corner, bit in _SIDES)
        yield f",({','.join(map(str, np.asarray(sides).tolist()))})"


def _add_shape(frame: _Frame, identifier: str, kind: str, item: str) -> str:
    words = (quote(identifier), quote(kind), format_list([item]))
    form = frame.step.add("IFCSHAPEREPRESENTATION", frame.context, *words)
    return frame.step.add("IFCPRODUCTDEFINITIONSHAPE", NONE, NONE, format_list([form]))


def _add_lines(frame: _Frame, tin: TIN, factor: float, place: str) -> list[str]:
    found = []
    for number, line in enumerate(list_lines(tin, factor), start=1):
        points = _add_points(frame, line.coordinates)
        curve = frame.step.add("IFCINDEXEDPOLYCURVE", points, NONE, NONE)
        shape = _add_shape(frame, "Axis", "Curve3D", curve)
        kind = quote(_TYPES.get(line.kind, line.kind.upper()))
        name = quote(line.name) if line.name else NONE
        found.append(
            frame.step.add(
                *("IFCGEOGRAPHICELEMENT", frame.identify(f"line {number}"), NONE, name, NONE, kind),
                *(place, shape, NONE, ".USERDEFINED."),
            )
        )
    return found
