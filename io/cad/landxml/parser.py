"""A streaming parser: elements become arrays as they come, without entities or other files.

A document type, and with it every entity, is refused; XInclude too, as what it includes would be
missing. Nothing is followed that names another file.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, NoReturn
from xml.parsers import expat

import numpy as np

from ....base.errors import ReadError
from ....base.sentences import FILE, counted
from ...isolated import translate_system_errors
from .content import Content, Line, Surface
from .numbers import fault, parse_list, parse_rows, parse_words

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

CHUNK = 1 << 20
"""Bytes that are read at a time."""

_BATCH = 65_536
_DEEPEST = 200
"""Levels of elements; the schema has about twelve."""

_LONGEST_MARKUP = 1 << 26
"""Bytes without an end of a tag or text that the parser could take: expat keeps them all."""

_LINES = frozenset({"Breakline", "Boundary", "Contour", "DataPoints"})
_LIST_WIDTHS = {"PntList2D": 2, "PntList3D": 3}
_OTHERS = {"PlanFeature": "plan feature", "Alignment": "alignment", "Parcel": "parcel"}
"""Elements with lines of their own, which are none of a surface."""
_NOT_FOR_SURFACE = frozenset({"donotinclude", "donottriangulate"})


def parse(path: Path, *, surface: str | int | None = None, points_only: bool = False) -> Content:
    """Read a file.

    Parameters
    ----------
    path : Path
    surface : str or int, optional
        Name, or number from 1, of the only surface whose points and faces are gathered; default
        all, until a second one has faces.
    points_only : bool
        Gather survey points, and nothing of surfaces.

    Raises
    ------
    ReadError
        If it is no well-formed XML, no LandXML, or what an element holds is not what it should.
    """
    parser = Parser(surface, points_only)
    with translate_system_errors(path), path.open("rb") as file:
        while chunk := file.read(CHUNK):
            parser.feed(chunk)
        parser.close()
    return parser.content


class Parser:
    """Handlers of expat, and the element that is open."""

    def __init__(self, surface: str | int | None, points_only: bool) -> None:
        self.content = Content()
        self._wanted = surface
        self._points_only = points_only
        self._stack: list[str] = []
        self._locals: dict[str, str] = {}
        self._text: list[str] = []
        self._surface: Surface | None = None
        self._line: Line | None = None
        self._attributes: dict[str, str] = {}
        self._groups: list[str] = []
        self._fed = 0
        self._batches = {"P": _Batch(), "F": _Batch()}
        self._starts: dict[str, Callable[[dict[str, str]], None]] = {
            "P": self._start_point,
            "F": self._start_face,
            **dict.fromkeys(_LIST_WIDTHS, self._start_list),
            **dict.fromkeys(_LINES, self._start_line),
            "CgPoint": self._start_survey_point,
            "CgPoints": self._start_group,
            "Chain": self._start_chain,
            "Surface": self._start_surface,
            "Definition": self._start_definition,
            "Metric": self._start_units,
            "Imperial": self._start_units,
            "CoordinateSystem": self._start_system,
            "Property": self._start_property,
            "PointFile": self._start_point_file,
            "RetWall": self._start_wall,
            **{name: partial(self._count_other, what) for name, what in _OTHERS.items()},
        }
        self._ends = {
            "P": self._end_point,
            "F": self._end_face,
            **dict.fromkeys(_LIST_WIDTHS, self._end_list),
            **dict.fromkeys(_LINES, self._end_line),
            "CgPoint": self._end_survey_point,
            "CgPoints": self._end_group,
            "Chain": self._end_chain,
            "Surface": self._end_surface,
        }
        self._expat = self._make_parser()

    def _count_other(self, what: str, _: dict[str, str]) -> None:
        """Count a thing that may have lines, and is not read."""
        self.content.others[what] = self.content.others.get(what, 0) + 1

    def _make_parser(self) -> Any:
        parser = expat.ParserCreate()
        parser.buffer_text = True
        parser.buffer_size = 1 << 16
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.StartDoctypeDeclHandler = self._refuse_doctype
        parser.ExternalEntityRefHandler = None
        parser.SetParamEntityParsing(expat.XML_PARAM_ENTITY_PARSING_NEVER)
        return parser

    # ------------------------------------------------------------------ the stream

    def feed(self, chunk: bytes) -> None:
        """Take the next bytes."""
        self._parse(chunk, is_last=False)
        self._fed += len(chunk)
        if self._fed - self._expat.CurrentByteIndex > _LONGEST_MARKUP:
            raise fault(self._now, "a tag has no end for more than 64 MB")

    def close(self) -> None:
        """Take the end of the file."""
        self._parse(b"", is_last=True)

    def _parse(self, chunk: bytes, *, is_last: bool) -> None:
        try:
            self._expat.Parse(chunk, is_last)
        except expat.ExpatError as error:
            reason = expat.ErrorString(error.code) or "damaged"
            raise fault(
                error.lineno, f"it is no well-formed XML, or it is cut short ({reason})"
            ) from None
        except (LookupError, UnicodeError, ValueError) as error:
            if isinstance(error, ReadError):
                raise
            raise ReadError(
                f"{FILE} is in an encoding that cannot be read: UTF-8, UTF-16 and those of "
                "one byte a letter can."
            ) from None

    @property
    def _now(self) -> int:
        return int(self._expat.CurrentLineNumber)

    def _refuse_doctype(self, *_: Any) -> NoReturn:
        raise fault(self._now, "it declares a document type, which LandXML has none of: refused")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        name = self._locals.get(tag)
        if name is None:
            name = tag.rpartition(":")[2]
            if name == "include" and tag != name:
                raise fault(self._now, "it includes another file, and none is followed")
            if len(self._locals) < _BATCH:
                self._locals[tag] = name
        stack = self._stack
        stack.append(name)
        if len(stack) == 1:
            if name != "LandXML":
                raise ReadError(f"{FILE} is no LandXML: its root element is '{name[:60]}'.")
            self.content.version = attributes.get("version", "")
        elif len(stack) > _DEEPEST:
            raise fault(self._now, f"elements are nested more than {_DEEPEST} deep")
        handler = self._starts.get(name)
        if handler is not None:
            handler(attributes)

    def _end(self, _: str) -> None:
        handler = self._ends.get(self._stack[-1])
        if handler is not None:
            handler()
        self._stack.pop()

    def _open_text(self) -> None:
        self._text.clear()
        self._expat.CharacterDataHandler = self._text.append

    def _close_text(self) -> str:
        self._expat.CharacterDataHandler = None
        text = self._text
        return text[0] if len(text) == 1 else "".join(text)

    def _is_inside(self, name: str) -> bool:
        return name in self._stack

    # ------------------------------------------------------------------ surfaces

    def _start_surface(self, attributes: dict[str, str]) -> None:
        if self._stack[-2] != "Surfaces":
            return
        number = len(self.content.surfaces) + 1
        self._surface = Surface(attributes.get("name", "").strip(), number, self._now)
        self._surface.is_kept = self._is_wanted(self._surface)
        self.content.surfaces.append(self._surface)

    def _is_wanted(self, surface: Surface) -> bool:
        if self._points_only:
            return False
        if self._wanted is not None:
            return self._wanted in (surface.name, surface.number, str(surface.number))
        return sum(bool(one.n_visible) for one in self.content.surfaces) < 2

    def _end_surface(self) -> None:
        if self._surface is not None:
            self._take_points(self._surface)
            self._take_faces(self._surface)
        self._surface = None

    def _start_definition(self, attributes: dict[str, str]) -> None:
        if self._surface is not None:
            self._surface.kind = attributes.get("surfType", "").strip() or "TIN"

    def _start_point(self, attributes: dict[str, str]) -> None:
        surface = self._surface
        if surface is None or not surface.is_kept or self._stack[-2] != "Pnts":
            return
        batch = self._batches["P"]
        batch.ids.append(attributes.get("id", ""))
        batch.references.append(attributes.get("pntRef", ""))
        batch.lines.append(self._expat.CurrentLineNumber)
        self._open_text()

    def _end_point(self) -> None:
        surface, batch = self._surface, self._batches["P"]
        if surface is None or not surface.is_kept or self._stack[-2] != "Pnts":
            return
        batch.texts.append(self._close_text())
        if len(batch.texts) >= _BATCH:
            self._take_points(surface)

    def _take_points(self, surface: Surface) -> None:
        batch = self._batches["P"]
        if not batch.texts:
            return
        ids = parse_rows(batch.ids, batch.lines, width=1, kind=np.int64, what="the id of a point")
        texts = batch.texts
        if any(batch.references):
            before = sum(map(len, surface.points))
            for k, name in enumerate(batch.references):
                if name and not texts[k].strip():
                    surface.references[before + k] = name
                    texts[k] = "0 0 0"
        rows = parse_rows(texts, batch.lines, width=3, kind=np.float64, what="a point")
        surface.ids.append(ids.ravel())
        surface.points.append(rows)
        batch.clear()

    def _start_face(self, attributes: dict[str, str]) -> None:
        surface = self._surface
        if surface is None or self._stack[-2] != "Faces":
            return
        if attributes:
            state = attributes.get("i", "0").strip()
            if state not in ("0", ""):
                if state not in ("1", "true"):
                    raise fault(self._now, f"a face has i='{state[:60]}', and 0 or 1 is allowed")
                surface.n_hidden += 1
                return
        surface.n_visible += 1
        if not surface.is_kept or surface.kind.lower() == "grid":
            return
        batch = self._batches["F"]
        batch.lines.append(self._expat.CurrentLineNumber)
        surface.sides.append(self._parse_sides(attributes["b"]) if "b" in attributes else 0)
        self._open_text()

    def _parse_sides(self, text: str) -> int:
        if text.strip() not in {str(k) for k in range(8)}:
            raise fault(self._now, f"a face has b='{text[:60]}', and 0 to 7 is allowed")
        return int(text)

    def _end_face(self) -> None:
        surface = self._surface
        if surface is None or self._expat.CharacterDataHandler is None:
            return
        batch = self._batches["F"]
        batch.texts.append(self._close_text())
        if len(batch.texts) >= _BATCH:
            self._take_faces(surface)

    def _take_faces(self, surface: Surface) -> None:
        batch = self._batches["F"]
        if batch.texts:
            rows = parse_rows(batch.texts, batch.lines, width=3, kind=np.int64, what="a face")
            surface.faces.append(rows)
            batch.clear()

    # ------------------------------------------------------------------ source data

    def _start_line(self, attributes: dict[str, str]) -> None:
        surface = self._surface
        if surface is not None and surface.is_kept and self._is_inside("SourceData"):
            self._line = Line(self._stack[-1], attributes, self._now)
            surface.lines.append(self._line)

    def _end_line(self) -> None:
        self._line = None

    def _start_list(self, _: dict[str, str]) -> None:
        if self._line is not None:
            self._open_text()

    def _end_list(self) -> None:
        if self._line is None:
            return
        name = self._stack[-1]
        rows = parse_list(
            self._close_text(),
            self._now,
            width=_LIST_WIDTHS[name],
            what=f"{name} of a {self._line.element}",
        )
        if len(rows):
            self._line.coordinates.append(rows)

    def _start_chain(self, attributes: dict[str, str]) -> None:
        surface = self._surface
        if surface is not None and surface.is_kept and self._is_inside("SourceData"):
            self._attributes = attributes
            self._open_text()

    def _end_chain(self) -> None:
        surface = self._surface
        if surface is not None and surface.is_kept and self._is_inside("SourceData"):
            surface.chains.append((self._close_text(), self._attributes, self._now))

    def _start_point_file(self, attributes: dict[str, str]) -> None:
        if self._surface is not None:
            self._surface.point_files.append(attributes.get("fileName", "").strip())

    def _start_wall(self, _: dict[str, str]) -> None:
        if self._surface is not None and self._is_inside("SourceData"):
            self._surface.n_walls += 1

    def _start_property(self, attributes: dict[str, str]) -> None:
        label, value = attributes.get("label", ""), attributes.get("value", "")
        if self._line is not None:
            self._line.properties[label] = value
        elif self._is_inside("CoordinateSystem"):
            self.content.system_properties[label] = value

    # ------------------------------------------------------------------ survey points

    def _start_group(self, attributes: dict[str, str]) -> None:
        self._groups.append(attributes.get("name", "").strip())

    def _end_group(self) -> None:
        self._groups.pop()

    def _start_survey_point(self, attributes: dict[str, str]) -> None:
        if self._groups:
            self._attributes = attributes
            self._open_text()

    def _end_survey_point(self) -> None:
        if not self._groups:
            return
        text, attributes, points = self._close_text(), self._attributes, self.content.points
        row = len(points)
        numbers = parse_words(text, self._now, what="a survey point")
        if len(numbers) not in (0, 2, 3):
            has = counted(len(numbers), "number")
            raise fault(self._now, f"a survey point has {has}, not 2 or 3")
        if not all(map(math.isfinite, numbers)):
            raise fault(self._now, "a survey point has a number that is not finite")
        points.coordinates.extend(numbers + [math.nan] * (3 - len(numbers)))
        points.names.append(attributes.get("name", "").strip())
        points.descriptions.append(attributes.get("desc", "").strip())
        points.codes.append(attributes.get("code", "").strip())
        points.groups.append(self._groups[-1])
        points.states.append(attributes.get("state", "").strip())
        if "pntRef" in attributes and not text.strip():
            points.references[row] = attributes["pntRef"].strip()
        if attributes.get("DTMAttribute", "").strip().lower() in _NOT_FOR_SURFACE:
            points.excluded.add(row)

    # ------------------------------------------------------------------ reference

    def _start_units(self, attributes: dict[str, str]) -> None:
        if self._stack[-2] == "Units":
            self.content.units.append((self._stack[-1], attributes))

    def _start_system(self, attributes: dict[str, str]) -> None:
        if len(self._stack) == 2:
            self.content.system.update(attributes)


class _Batch:
    """Texts of elements that become numbers together."""

    def __init__(self) -> None:
        self.ids: list[str] = []
        self.references: list[str] = []
        self.texts: list[str] = []
        self.lines: list[int] = []

    def clear(self) -> None:
        """Begin anew."""
        for part in (self.ids, self.references, self.texts, self.lines):
            part.clear()
