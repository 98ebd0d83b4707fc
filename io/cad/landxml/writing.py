"""Write LandXML 1.2: a surface with its lines, survey points, contours.

Bytes depend on nothing but what is written: the date that the schema asks for is a fixed one.
Northing comes before easting. What LandXML has no place for, the kind and priority of a line and
that the unit of elevations is not known, stands in elements ``Feature``, as the schema allows.
"""

from __future__ import annotations

from typing import IO, TYPE_CHECKING

import numpy as np

from ....base.atomic import replacing
from ....base.checks import require_count
from ....base.crs import choose_wkt
from ....base.errors import FormatError, OptionError
from ....base.notes import warn
from ....base.results import Features
from ....base.sentences import FILE, counted
from ....terrain import Alignment
from ....tin import TIN, Surface, Survey
from ...registry import select_attributes, warn_of_unknown_elevations
from ..drawing import choose_length_unit, choose_name, list_lines, scale_elevations
from .alignment_writing import format_alignment
from .content import ELEVATION_UNIT, FEATURE, KIND, LINE, PRIORITY, SOURCE, UNKNOWN, quote
from .units import name_unit

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import Float64Array
    from ....base.crs import Unit, UnitLike
    from ....base.progress import Tell
    from ....tin import TIN, Survey

_BATCH = 65_536
_MOST_DECIMALS = 15
_ROUNDING = 4 * float(np.finfo(np.float64).eps)
_NAMESPACE = "http://www.landxml.org/schema/LandXML-1.2"
_ROOT = (
    '<?xml version="1.0" encoding="UTF-8"?>\n'
    f'<LandXML xmlns="{_NAMESPACE}" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xsi:schemaLocation="{_NAMESPACE} {_NAMESPACE}/LandXML-1.2.xsd" '
    'date="2000-01-01" time="00:00:00" version="1.2" language="English" readOnly="false">\n'
)
_OTHER_UNITS = {
    "Metric": 'areaUnit="squareMeter" linearUnit="{}" volumeUnit="cubicMeter" '
    'temperatureUnit="celsius" pressureUnit="milliBars" diameterUnit="millimeter"',
    "Imperial": 'areaUnit="squareFoot" linearUnit="{}" volumeUnit="cubicYard" '
    'temperatureUnit="fahrenheit" pressureUnit="inHG" diameterUnit="inch"',
}
_TEXTS = {"desc": "description", "code": "code"}
"""Attributes of an element of a point, and what of a survey they hold."""

_ANGLES = 'angularUnit="decimal degrees" directionUnit="decimal degrees"'
_SIDES = ((2, 1), (0, 2), (1, 4))
"""Corners, and the bit of the side opposite."""


def write(
    obj: TIN | Survey | Features | Alignment,
    path: Path,
    *,
    name: str | None = None,
    unit: UnitLike | None = None,
    decimals: int | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a TIN, the points and lines of a survey, contours and other lines, or an alignment.

    Of a survey points become CgPoints and lines the source data of a surface; of features points
    become CgPoints, lines of one elevation contours, other lines breaklines.

    Parameters
    ----------
    name : str, optional
        Name of the surface or alignment; default its own, else "surface" or "alignment".
    unit : Unit or str, optional
        Unit of coordinates and elevations, where the CRS does not tell. Without one the file has
        no units, and programs guess.
    decimals : int, optional
        Decimals of coordinates, for smaller files; default all digits.

    Raises
    ------
    FormatError
        Also if features are polygons.
    OptionError
        If the name is no text; if the unit is not one of LandXML, or not that of the CRS; if
        ``decimals`` are so few that triangles lose their area, or an alignment is to be rounded.
    CrsError
        If coordinates are angles.

    Warns
    -----
    LossWarning
        If elevations are converted, as LandXML has one unit for all lengths, or attributes are
        left out, or line breaks in texts.
    """
    require_count("decimals", decimals, least=0, most=_MOST_DECIMALS, or_none=True)
    if isinstance(obj, Alignment):
        if decimals is not None:
            raise OptionError("decimals", decimals, "left out: an alignment keeps all digits")
        _write_alignment(obj, path, name, unit)
        return
    if not isinstance(obj, Surface | Survey | Features):
        raise FormatError(f"Cannot write {FILE}: a {type(obj).__name__} is no surface or survey.")
    surface = choose_name(obj, name)
    _require_lines(obj)
    along, factor = choose_length_unit(
        obj, unit, is_known=lambda one: name_unit(one) is not None, format_name="LandXML"
    )
    texts = _select_texts(obj)
    is_lines = isinstance(obj, Features) and obj.kind != "points"
    points = obj.coordinates if isinstance(obj, Features) else obj.points
    points = _round(scale_elevations(points, factor), decimals)
    if isinstance(obj, Surface) and decimals is not None:
        _require_areas(obj, points, decimals)
    with replacing(path, binary=False) as file:
        file.write(_ROOT)
        _write_reference(file, obj, along, surface)
        if not isinstance(obj, Surface) and not is_lines:
            _write_points(file, points, texts)
        has_lines = is_lines or not isinstance(obj, Features)
        source = format_source(obj, factor, decimals) if has_lines else ""
        if source or isinstance(obj, Surface):
            file.write(f"<Surfaces>\n<Surface name={quote(surface)}>\n{source}")
            if isinstance(obj, Surface):
                _write_definition(file, obj, points, progress)
            file.write("</Surface>\n</Surfaces>\n")
        file.write("</LandXML>\n")
    if progress is not None:
        progress(1.0)
    warn_of_unknown_elevations(obj)


def _write_alignment(
    alignment: Alignment, path: Path, name: str | None, unit: UnitLike | None
) -> None:
    title = name if name is not None else alignment.name.strip() or "alignment"
    if not isinstance(title, str) or not title.strip():
        raise OptionError("name", name, "the name of an alignment")
    along, factor = choose_length_unit(
        alignment, unit, is_known=lambda one: name_unit(one) is not None, format_name="LandXML"
    )
    with replacing(path, binary=False) as file:
        file.write(_ROOT)
        _write_reference(file, alignment, along, title.strip())
        file.write(format_alignment(alignment, title.strip(), factor))
        file.write("</LandXML>\n")


def _require_lines(obj: TIN | Survey | Features) -> None:
    if not isinstance(obj, Features) or obj.kind == "lines":
        return
    if obj.kind == "polygons":
        raise FormatError(f"Cannot write {FILE}: LandXML holds points and lines, not polygons.")
    if not obj.has_elevations or not np.isfinite(obj.coordinates).all():
        raise FormatError("LandXML needs elevations, and some of these points have none.")


# ------------------------------------------------------------------ units and CRS


def _write_reference(
    file: IO[str], obj: TIN | Survey | Features | Alignment, unit: Unit | None, name: str
) -> None:
    """Write units, CRS, project and application, in the order of the schema."""
    _write_units(file, unit)
    _write_crs(file, obj)
    file.write(f'<Project name={quote(name)}/>\n<Application name="tinsmith"/>\n')


def _write_units(file: IO[str], unit: Unit | None) -> None:
    names = None if unit is None else name_unit(unit)
    if names is not None:
        system, name = names
        units = _OTHER_UNITS[system].format(name)
        file.write(f"<Units>\n<{system} {units} {_ANGLES}/>\n</Units>\n")


def _write_crs(file: IO[str], obj: TIN | Survey | Features | Alignment) -> None:
    if obj.crs is None:
        return
    crs = obj.crs
    words = [f"name={quote(crs.name)} desc={quote(crs.name)}"]
    code = crs.horizontal.to_epsg()
    if code is not None:
        words.append(f'epsgCode="{code}"')
    words.append(f"ogcWktCode={quote(choose_wkt(crs))}")
    file.write(f"<CoordinateSystem {' '.join(words)}")
    if obj.elevation_unit is not None:
        file.write("/>\n")
        return
    file.write(
        f'>\n<Feature name="{FEATURE}">\n<Property label="{ELEVATION_UNIT}" value="{UNKNOWN}"/>\n'
        "</Feature>\n</CoordinateSystem>\n"
    )


# ------------------------------------------------------------------ surface


def _round(rows: Float64Array, decimals: int | None) -> Float64Array:
    return rows if decimals is None else np.round(rows, decimals)


def _require_areas(tin: TIN, rounded: Float64Array, decimals: int) -> None:
    """Refuse decimals so few that triangles turn over or lose their area."""
    xy = rounded[:, :2] - rounded[:, :2].min(axis=0)
    steps = np.rint(xy * 10.0**decimals)  # whole numbers, of which differences are exact
    a, b, c = (steps[tin.triangles[:, corner]] for corner in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    left, right = ux * vy, uy * vx
    wrong = left - right <= _ROUNDING * (np.abs(left) + np.abs(right))
    if wrong.any():
        what = counted(int(wrong.sum()), "triangle")
        raise OptionError("decimals", decimals, f"more: {what} would lose area or turn over")


def _write_definition(
    file: IO[str],
    tin: TIN,
    points: Float64Array,
    progress: Tell | None,
) -> None:
    total = len(points) + len(tin.triangles)
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    file.write(
        f'<Definition surfType="TIN" area2DSurf="{tin.triangulation.area!r}" elevMax="{high!r}" '
        f'elevMin="{low!r}">\n<Pnts>\n'
    )
    for start in range(0, len(points), _BATCH):
        rows = points[start : start + _BATCH, [1, 0, 2]]
        table = np.empty((len(rows), 4), object)
        table[:, 0] = range(start + 1, start + 1 + len(rows))
        table[:, 1:] = rows
        file.write('<P id="%d">%r %r %r</P>\n' * len(rows) % tuple(table.ravel().tolist()))
        _report(progress, (start + len(rows)) / total)
    file.write("</Pnts>\n<Faces>\n")
    for start in range(0, len(tin.triangles), _BATCH):
        file.write(_format_faces(tin, start, start + _BATCH))
        _report(progress, (len(points) + min(start + _BATCH, len(tin.triangles))) / total)
    file.write("</Faces>\n</Definition>\n")


def _format_faces(tin: TIN, start: int, end: int) -> str:
    corners = tin.triangles[start:end].astype(np.int64) + 1
    flags = tin.constrained[start:end]
    if not flags.any():
        return "<F>%d %d %d</F>\n" * len(corners) % tuple(corners.ravel().tolist())
    sides = sum(flags[:, corner] * bit for corner, bit in _SIDES)
    return "".join(
        f"<F>{a} {b} {c}</F>\n" if not side else f'<F b="{side}">{a} {b} {c}</F>\n'
        for (a, b, c), side in zip(corners.tolist(), np.asarray(sides).tolist(), strict=True)
    )


def _report(progress: Tell | None, done: float) -> None:
    if progress is not None:
        progress(done)


# ------------------------------------------------------------------ points


def _write_points(file: IO[str], points: Float64Array, texts: dict[str, list[str]]) -> None:
    if len(points) == 0:
        return
    names = texts.get("number") or [str(number) for number in range(1, len(points) + 1)]
    columns = {key: texts[name] for key, name in _TEXTS.items() if name in texts}
    file.write("<CgPoints>\n")
    for start in range(0, len(points), _BATCH):
        rows = points[start : start + _BATCH, [1, 0, 2]].tolist()
        parts = [[f" {key}={quote(text)}" if text else "" for text in values[start:start + _BATCH]]
                 for key, values in columns.items()]  # fmt: skip
        extras = ["".join(words) for words in zip(*parts, strict=True)] or [""] * len(rows)
        file.write(
            "".join(
                f"<CgPoint name={quote(name)}{extra}>{n!r} {e!r} {z!r}</CgPoint>\n"
                for name, extra, (n, e, z) in zip(
                    names[start : start + _BATCH], extras, rows, strict=True
                )
            )
        )
    file.write("</CgPoints>\n")


def _select_texts(obj: TIN | Survey | Features) -> dict[str, list[str]]:
    """Return the texts of points that LandXML holds; numbers only if they all differ."""
    if isinstance(obj, Surface) or (isinstance(obj, Features) and obj.kind != "points"):
        return {}
    attributes = obj.attributes if isinstance(obj, Survey) else obj.columns
    held = select_attributes(
        attributes,
        ("number", *_TEXTS.values()),
        "LandXML has the number, the description and the code of a point",
    )
    texts = {
        name: [("" if one is None or one != one else str(one).strip()) for one in values.tolist()]
        for name, values in held.items()
    }
    numbers = texts.get("number", [])
    if not all(numbers) or len(set(numbers)) < len(numbers):
        warn(
            f"{FILE}: points are numbered 1, 2, 3 ... anew, as numbers are missing or stand "
            "twice, which LandXML does not allow."
        )
        del texts["number"]
    return texts


_BOUNDARIES = {"boundary": ("outer", "void"), "hole": ("void", "island")}
"""Of the outer ring of a polygon, and of those in it."""


def format_source(obj: TIN | Survey | Features, factor: float, decimals: int | None = None) -> str:
    """Return lines as the source data of a surface; empty if there are none.

    Lines of features that have one elevation are contours. A feature of each line of a TIN tells
    which it is, so that a reader that knows it restores their order.
    """
    found: dict[str, list[str]] = {"Boundaries": [], "Breaklines": [], "Contours": []}
    seen = set()
    for number, line in enumerate(list_lines(obj, factor)):
        rows, extra = (
            _round(line.coordinates, decimals),
            {} if line.kind == "hard" else {KIND: line.kind},
        )
        if isinstance(obj, Surface):
            extra |= {LINE: str(number), SOURCE: str(line.source)}
        elif line.priority:
            extra[PRIORITY] = str(line.priority)
        if line.kind in _BOUNDARIES and (rows[0] == rows[-1]).all():
            extra.pop(KIND)
            kind = _BOUNDARIES[line.kind][line.polygon is not None and line[1:] in seen]
            seen.add(line[1:])
            found["Boundaries"].append(_format_boundary(rows, kind, line.name, extra))
        elif isinstance(obj, Features) and rows.shape[1] == 3 and np.ptp(rows[:, 2]) == 0:
            found["Contours"].append(_format_contour(rows))
        elif line.kind != "erase":
            brk = "nondestructive" if rows.shape[1] == 2 else "standard"
            named = f" name={quote(line.name)}" if line.name else ""
            found["Breaklines"].append(
                f'<Breakline brkType="{brk}"{named}>\n{_format_list(rows)}{_format_feature(extra)}'
                "</Breakline>\n"
            )
    parts = [f"<{name}>\n{''.join(part)}</{name}>\n" for name, part in found.items() if part]
    return f"<SourceData>\n{''.join(parts)}</SourceData>\n" if parts else ""


def _format_boundary(rows: Float64Array, kind: str, name: str, extra: dict[str, str]) -> str:
    if (rows[0, :2] != rows[-1, :2]).any():
        rows = np.concatenate([rows, rows[:1]])
    named = f" name={quote(name)}" if name else ""
    return (
        f'<Boundary bndType="{kind}" edgeTrim="true"{named}>\n{_format_list(rows)}'
        f"{_format_feature(extra)}</Boundary>\n"
    )


def _format_contour(rows: Float64Array) -> str:
    return f'<Contour elev="{float(rows[0, 2])!r}">\n{_format_list(rows[:, :2])}</Contour>\n'


def _format_list(rows: Float64Array) -> str:
    ordered = rows[:, [1, 0, *range(2, rows.shape[1])]].ravel().tolist()
    tag = f"PntList{rows.shape[1]}D"
    return f"<{tag}>{' '.join(map(repr, ordered))}</{tag}>\n"


def _format_feature(values: dict[str, str]) -> str:
    if not values:
        return ""
    properties = "".join(
        f'<Property label="{label}" value={quote(value)}/>\n' for label, value in values.items()
    )
    return f'<Feature name="{FEATURE}">\n{properties}</Feature>\n'
