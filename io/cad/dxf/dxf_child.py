"""Drawings through ezdxf, as the child process reads them."""

from __future__ import annotations

import itertools
import math
import os
from array import array
from fnmatch import fnmatchcase
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ....base.sentences import FILE
from ...isolated import Answer, Refusal
from .layers import APPLICATION

if TYPE_CHECKING:
    from collections.abc import Iterator

ENVIRONMENT = {"EZDXF_CONFIG_FILE": os.devnull}

_DEEPEST = 32
"""Blocks inserted in blocks; a drawing that needs more inserts itself."""

_MOST_NAMES = 20
_CURVES = frozenset({"ARC", "CIRCLE", "ELLIPSE", "SPLINE", "HELIX"})
_TEXTS = frozenset({"TEXT", "MTEXT", "ATTRIB"})


class _NestingError(Exception):
    """Blocks that are inserted in one another without an end."""


_DEEP = (_NestingError, RecursionError)
_FAULTS = (
    *(RuntimeError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError),
    *(AssertionError, StopIteration, EOFError),
)
"""What ezdxf raises where a damaged drawing is not what it expects."""


def prepare() -> None:
    """Load the library."""
    import_module("ezdxf.render")


def read_drawing(
    path: str, *, layer: str | None, texts: bool, tolerance: float | None, keeps_arcs: bool = False
) -> Answer:
    """Return the points, faces and lines of the model space, and its texts if they are asked for.

    ``layer`` is names or patterns of layers, with commas between; ``tolerance`` is how far a curve
    may lie from its chords, in the unit of the drawing. With ``keeps_arcs`` arcs in the plane are
    no chords, but have bulges.
    """
    ezdxf = import_module("ezdxf")
    try:
        document = ezdxf.readfile(path)
    except ezdxf.DXFError as error:
        reason = " ".join(str(error).split())[:160].rstrip(" .")
        raise Refusal(f"{FILE} is a damaged DXF drawing: {reason}.") from error
    except OSError as error:
        if "DXF" not in str(error):
            raise
        raise Refusal(f"{FILE} is no DXF drawing, or a damaged one.") from error
    except _FAULTS as error:
        raise _describe_damage() from error
    try:
        gathered = _Gathered(document, layer, texts=texts, tolerance=tolerance)
        gathered.bulges = array("d") if keeps_arcs else None
        for entity, own_layer, is_nested in _iterate_entities(document, gathered):
            gathered.take(entity, own_layer, is_nested=is_nested)
        return gathered.answer()
    except _DEEP as error:
        raise Refusal(
            f"The blocks of {FILE} are inserted in one another more than {_DEEPEST} deep."
        ) from error
    except _FAULTS as error:
        raise _describe_damage() from error


def _describe_damage() -> Refusal:
    return Refusal(f"{FILE} is a damaged DXF drawing: its parts do not fit together.")


def _iterate_entities(document: Any, gathered: _Gathered) -> Iterator[tuple[Any, str, bool]]:
    """Yield entities with the layer that counts; blocks are taken apart, one inside the other."""
    pending: list[tuple[Iterator[Any], str]] = [(iter(document.modelspace()), "0")]
    while pending:
        entities, outer = pending[-1]
        entity = next(entities, None)
        if entity is None:
            pending.pop()
            continue
        own = str(entity.dxf.get("layer", "0"))
        layer = outer if own == "0" and len(pending) > 1 else own
        if entity.dxftype() != "INSERT":
            yield entity, layer, len(pending) > 1
        elif not gathered.is_hidden(entity, layer):
            if len(pending) > _DEEPEST:
                raise _NestingError
            pending.append((_iterate_block(entity, gathered), layer))


def _iterate_block(insert: Any, gathered: _Gathered) -> Iterator[Any]:
    block = insert.block()
    if block is None or block.block.is_xref or block.block.is_xref_overlay:
        gathered.missing_blocks.add(_clean(str(insert.dxf.get("name", "")))[:60])
        return
    copies = insert.multi_insert() if insert.mcount > 1 else [insert]
    for one in copies:
        yield from one.virtual_entities(skipped_entity_callback=gathered.count_skipped)
        yield from one.attribs


def _clean(text: str) -> str:
    """Return a text that every program can write."""
    return text.encode("utf-8", "replace").decode("utf-8")


class _Gathered:
    """What was found, and what was left out."""

    def __init__(
        self, document: Any, layer: str | None, *, texts: bool, tolerance: float | None
    ) -> None:
        self.document = document
        self.missing_blocks: set[str] = set()
        self.bulges: array[float] | None = None
        """Of each vertex of lines: the tangent of a quarter of the angle of the arc behind it."""
        self._patterns = None if layer is None else [
            one.strip().casefold() for one in layer.split(",") if one.strip()
        ]  # fmt: skip
        self._wants_texts = texts
        self._tolerance = tolerance
        self._layers: dict[str, int] = {}
        self._seen: dict[str, None] = {}
        self._states = {
            str(one.dxf.name).casefold(): (one.is_off(), one.is_frozen()) for one in document.layers
        }
        self._left_out: dict[str, int] = {}
        self._hidden: dict[str, int] = {}
        self._n_nested_lines = self._n_curves = 0
        self._points, self._point_layers = array("d"), array("i")
        self._point_names: list[list[str]] = []
        self._faces, self._face_layers = array("d"), array("i")
        self._lines, self._lengths, self._line_layers = array("d"), array("q"), array("i")
        self._line_flags = array("B")
        self._line_names: list[list[str]] = []
        self._texts: list[str] = []
        self._text_places, self._text_layers = array("d"), array("i")

    # ------------------------------------------------------------------ what counts

    def is_wanted(self, layer: str) -> bool:
        """Whether a layer is one of those named; all are if none is."""
        name = layer.casefold()
        return self._patterns is None or any(fnmatchcase(name, one) for one in self._patterns)

    def is_hidden(self, entity: Any, layer: str) -> bool:
        """Whether an entity is invisible, or its layer off or frozen and not asked for."""
        is_off, is_frozen = self._states.get(layer.casefold(), (False, False))
        if entity.dxf.get("invisible", 0):
            self._hidden["invisible"] = self._hidden.get("invisible", 0) + 1
            return True
        is_insert = entity.dxftype() == "INSERT"
        if self._patterns is None and (is_frozen or (is_off and not is_insert)):
            self._hidden[_clean(layer)] = self._hidden.get(_clean(layer), 0) + 1
            return True
        return False

    def count_skipped(self, entity: Any, _: str) -> None:
        """Count what a block holds and its insertion cannot transform."""
        self._count_left_out(str(entity.dxftype()))

    def _count_left_out(self, kind: str) -> None:
        self._left_out[kind] = self._left_out.get(kind, 0) + 1

    # ------------------------------------------------------------------ entities

    def take(self, entity: Any, layer: str, *, is_nested: bool) -> None:
        """Take one entity that is no block."""
        self._seen.setdefault(_clean(layer))
        if not self.is_wanted(layer) or self.is_hidden(entity, layer):
            return
        kind = str(entity.dxftype())
        number = self._layers.setdefault(_clean(layer), len(self._layers))
        if kind == "POINT":
            self._points.extend(entity.dxf.location.xyz)
            self._point_layers.append(number)
            self._point_names.append(self._find_names(entity))
        elif kind == "3DFACE":
            corners = [entity.dxf.get(f"vtx{k}") for k in range(4)]
            corners = [one if one is not None else corners[2] for one in corners]
            self._add_face([one.xyz for one in corners], number)
        elif kind in ("LINE", "LWPOLYLINE", "POLYLINE") or kind in _CURVES:
            self._take_line(entity, kind, number, is_nested=is_nested)
        elif kind == "MESH":
            self._add_mesh(entity.vertices, entity.faces, number)
        elif kind in _TEXTS and self._wants_texts:
            self._take_text(entity, number)
        else:
            self._count_left_out(kind)

    def _find_names(self, entity: Any) -> list[str]:
        if not entity.has_xdata(APPLICATION):
            return []
        return [_clean(str(tag.value)) for tag in entity.get_xdata(APPLICATION) if tag.code == 1000]

    def _add_face(self, corners: list[Any], number: int) -> None:
        for corner in corners:
            self._faces.extend(corner)
        self._face_layers.append(number)

    def _add_mesh(self, vertices: Any, faces: Any, number: int) -> None:
        rows = [tuple(float(value) for value in vertex) for vertex in vertices]
        for face in faces:
            corners = [rows[int(k)] for k in face if 0 <= int(k) < len(rows)]
            if len(corners) != len(face) or len(corners) < 3:
                self._count_left_out("damaged face")
            elif len(corners) <= 4:
                self._add_face(corners + [corners[-1]] * (4 - len(corners)), number)
            else:
                self._count_left_out("face of more than four corners")

    def _take_line(self, entity: Any, kind: str, number: int, *, is_nested: bool) -> None:
        if kind == "POLYLINE" and (entity.is_poly_face_mesh or entity.is_polygon_mesh):
            mesh = import_module("ezdxf.render").MeshBuilder.from_polyface(entity)
            self._add_mesh(mesh.vertices, mesh.faces, number)
            return
        arcs = None if self.bulges is None else find_arcs(entity, kind)
        rows = self._find_rows(entity, kind) if arcs is None else [row for row, _ in arcs]
        if len(rows) < 2:
            self._count_left_out(f"{kind} of one vertex")
            return
        self._n_nested_lines += is_nested
        for row in rows:
            self._lines.extend(row)
        if self.bulges is not None:
            self.bulges.extend([0.0] * len(rows) if arcs is None else [bulge for _, bulge in arcs])
        self._lengths.append(len(rows))
        self._line_layers.append(number)
        is_3d = kind == "POLYLINE" and entity.is_3d_polyline
        self._line_flags.append(not is_3d and all(row[2] == 0 for row in rows))
        self._line_names.append(self._find_names(entity))

    def _find_rows(self, entity: Any, kind: str) -> list[tuple[float, float, float]]:
        if kind == "LINE":
            return [entity.dxf.start.xyz, entity.dxf.end.xyz]
        if kind == "LWPOLYLINE" and not entity.has_arc:
            return _close(list(entity.vertices_in_wcs()), is_closed=entity.closed)
        if kind == "POLYLINE" and not entity.has_arc:
            places = [
                vertex.dxf.location
                for vertex in entity.vertices
                if not vertex.dxf.get("flags", 0) & FRAME_POINT
            ]
            if not entity.is_3d_polyline:
                elevation = entity.dxf.elevation.z if entity.dxf.hasattr("elevation") else 0.0
                flat = [place.replace(z=elevation or place.z) for place in places]
                places = list(entity.ocs().points_to_wcs(flat))
            return _close(places, is_closed=entity.is_closed)
        self._n_curves += 1
        distance = self._tolerance or self._choose_tolerance()
        if kind in _CURVES:
            return [place.xyz for place in entity.flattening(distance)]
        return follow_bulges(entity, kind, distance)

    def _choose_tolerance(self) -> float:
        """Return a centimetre in the unit of the drawing, a hundredth where it names none."""
        from .layers import UNIT_OF_CODE

        unit = UNIT_OF_CODE.get(self.document.header.get("$INSUNITS", 0))
        return 0.01 / unit.metres if unit is not None and unit.metres else 0.01

    def _take_text(self, entity: Any, number: int) -> None:
        text = entity.plain_text() if hasattr(entity, "plain_text") else entity.dxf.get("text", "")
        place = entity.dxf.get("insert")
        if place is not None:
            if hasattr(entity, "ocs") and entity.dxftype() != "MTEXT":
                place = entity.ocs().to_wcs(place)
            self._texts.append(_clean(str(text))[:200])
            self._text_places.extend(place.xyz)
            self._text_layers.append(number)

    # ------------------------------------------------------------------ the answer

    def answer(self) -> Answer:
        """Return all as arrays."""
        header = self.document.header
        value = {
            "layers": list(self._layers),
            "all_layers": list(self._seen),
            "unit": int(header.get("$INSUNITS", 0)),
            "properties": [[_clean(str(a)), _clean(str(b))] for a, b in header.custom_vars],
            "epsg": self._find_epsg(),
            "left_out": dict(list(self._left_out.items())[:_MOST_NAMES]),
            "hidden": dict(list(self._hidden.items())[:_MOST_NAMES]),
            "missing_blocks": sorted(self.missing_blocks)[:_MOST_NAMES],
            "n_nested_lines": self._n_nested_lines,
            "n_curves": self._n_curves,
            "point_names": self._point_names if any(self._point_names) else [],
            "line_names": self._line_names if any(self._line_names) else [],
            "texts": self._texts,
        }
        rows = {"points": self._points, "lines": self._lines, "text_places": self._text_places}
        arrays: dict[str, np.ndarray[Any, Any]] = {
            name: np.array(one, np.float64).reshape(-1, 3) for name, one in rows.items()
        }
        arrays["faces"] = np.array(self._faces, np.float64).reshape(-1, 4, 3)
        arrays["lengths"] = np.array(self._lengths, np.int64)
        if self.bulges is not None:
            arrays["bulges"] = np.array(self.bulges, np.float64)
        arrays["is_flat"] = np.array(self._line_flags, np.uint8)
        arrays["point_layers"] = np.array(self._point_layers, np.int32)
        arrays["face_layers"] = np.array(self._face_layers, np.int32)
        arrays["line_layers"] = np.array(self._line_layers, np.int32)
        return Answer(value, arrays)

    def _find_epsg(self) -> int | None:
        try:
            place = self.document.modelspace().get_geodata()
            return None if place is None else int(place.get_crs()[0])
        except Exception:
            return None


def _close(places: list[Any], *, is_closed: bool) -> list[tuple[float, float, float]]:
    rows = [tuple(place.xyz) for place in places]
    return [*rows, rows[0]] if is_closed and len(rows) > 2 and rows[0] != rows[-1] else rows


FRAME_POINT = 16
"""Flag of a vertex that is a control point of a smoothed polyline, and not on it."""

_MOST_CHORDS = 100_000
"""Of one arc; more are asked for by a tolerance that is far too small."""

Row = tuple[float, float, float]


def follow_bulges(entity: Any, kind: str, distance: float) -> list[Row]:
    """Return the vertices of a plane polyline, those of its arcs near enough.

    Parameters
    ----------
    entity : LWPolyline or Polyline
    kind : str
    distance : float
        How far an arc may lie from its chords.
    """
    rows, elevation = _list_bulged(entity, kind)
    places: list[tuple[float, float]] = []
    for (x, y, bulge), (x_end, y_end, _) in itertools.pairwise(rows):
        places.append((x, y))
        places += _follow_arc((x, y), (x_end, y_end), bulge, distance)
    places.append(rows[-1][:2])
    flat = [(x, y, elevation) for x, y in places]
    return [place.xyz for place in entity.ocs().points_to_wcs(flat_vectors(flat))]


def find_arcs(entity: Any, kind: str) -> list[tuple[Row, float]] | None:
    """Return the vertices of a plane polyline or arc with the bulges of what follows each.

    None if it is neither, or is not level, so that its arcs are none seen from above.
    """
    if kind not in ("ARC", "LWPOLYLINE") and not (kind == "POLYLINE" and entity.is_2d_polyline):
        return None
    up = entity.ocs().uz
    if up.x or up.y:
        return None
    if kind == "ARC":
        angle = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0)
        bulge = math.tan(angle / 4.0)
        flat = [place.xyz for place in (entity.start_point, entity.end_point)]
        return [(flat[0], bulge if up.z > 0 else -bulge), (flat[1], 0.0)]
    rows, elevation = _list_bulged(entity, kind)
    places = entity.ocs().points_to_wcs(flat_vectors([(x, y, elevation) for x, y, _ in rows]))
    return [
        (place.xyz, bulge if up.z > 0 else -bulge)
        for place, (_, _, bulge) in zip(places, rows, strict=True)
    ]


def _list_bulged(entity: Any, kind: str) -> tuple[list[Row], float]:
    """Return x, y and bulge of the vertices of a plane polyline, and its elevation."""
    if kind == "LWPOLYLINE":
        rows = [(x, y, bulge) for x, y, bulge in entity.get_points("xyb")]
        elevation, is_closed = float(entity.dxf.elevation), bool(entity.closed)
    else:
        rows = [
            (*vertex.dxf.location.vec2, vertex.dxf.get("bulge", 0.0))
            for vertex in entity.vertices
            if not vertex.dxf.get("flags", 0) & FRAME_POINT
        ]
        height = entity.dxf.elevation.z if entity.dxf.hasattr("elevation") else 0.0
        elevation = height or entity.vertices[0].dxf.location.z
        is_closed = bool(entity.is_closed)
    if is_closed:
        rows = [*rows, (*rows[0][:2], 0.0)]
    return rows, elevation


def flat_vectors(rows: list[Row]) -> Any:
    """Return rows as ezdxf's vectors."""
    from ezdxf.math import Vec3

    return Vec3.list(rows)


def _follow_arc(
    start: tuple[float, float], end: tuple[float, float], bulge: float, distance: float
) -> list[tuple[float, float]]:
    """Return the points within an arc; its bulge is the tangent of a quarter of its angle."""
    chord = math.dist(start, end)
    if bulge == 0 or chord == 0:
        return []
    angle = 4 * math.atan(bulge)
    radius = chord / (2 * math.sin(abs(angle) / 2)) if abs(bulge) < 1e8 else math.inf
    count = _count_chords(radius, abs(angle), distance)
    middle_x, middle_y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    away = (1 - bulge * bulge) / (4 * bulge)  # of the centre from the chord, in chords
    x = middle_x - away * (end[1] - start[1])
    y = middle_y + away * (end[0] - start[0])
    first = math.atan2(start[1] - y, start[0] - x)
    return [
        (
            x + radius * math.cos(first + angle * k / count),
            y + radius * math.sin(first + angle * k / count),
        )
        for k in range(1, count)
    ]


def _count_chords(radius: float, angle: float, distance: float) -> int:
    if not math.isfinite(radius) or distance >= radius:
        return max(2, math.ceil(angle / (math.pi / 2)))
    step = 2 * math.acos(1 - distance / radius)
    return min(max(2, math.ceil(angle / step)) if step > 0 else _MOST_CHORDS, _MOST_CHORDS)
