"""Entities of a drawing as text, many at once; ezdxf makes the rest of the file.

An object of ezdxf for each triangle would take a second for 10,000 of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .layers import APPLICATION

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ....base.arrays import Float64Array

_IN_SPACE = 8
"""Flag of a polyline that is not of one elevation."""

_LONGEST_TEXT = 250
"""DXF allows 255 letters in extended data."""

_CENTRED, _AMID = 1, 2
"""Horizontal and vertical alignment of a TEXT."""
_MIDDLE = 5
"""Attachment point of an MTEXT: the middle of its centre."""
_AS_WINDOW = 3
"""Background of an MTEXT: filled with the colour of the window."""
_MASK = 1.2
"""Size of the background by that of the text."""


class Lettering(NamedTuple):
    """How texts are written."""

    height: float
    rotations: list[float]
    """Degrees counter-clockwise from east."""


class EntityWriter:
    """Makes the text of entities of one drawing, with handles that count on.

    R12 has no subclasses; ``owner`` is the handle of the record of the model space.
    """

    def __init__(self, *, is_r12: bool, owner: str, first_handle: int) -> None:
        self._is_r12 = is_r12
        self._owner = owner
        self.next_handle = first_handle
        self.parts: list[str] = []

    def _begin(self, kind: str, layer: str, *subclasses: str, owner: str = "") -> str:
        self.next_handle += 1
        handle = f"{self.next_handle - 1:X}"
        if self._is_r12:
            return f"0\n{kind}\n5\n{handle}\n8\n{layer}\n"
        marks = "".join(f"100\n{name}\n" for name in subclasses)
        return (
            f"0\n{kind}\n5\n{handle}\n330\n{owner or self._owner}\n100\nAcDbEntity\n8\n{layer}\n"
            f"{marks}"
        )

    # ------------------------------------------------------------------ entities

    def add_faces(self, layer: str, corners: Float64Array) -> None:
        """Add triangles, (m, 3, 3), the last corner repeated as the format asks for."""
        rows = corners[:, [0, 1, 2, 2]].reshape(-1, 12).tolist()
        coordinates = "".join(f"{axis}{k}\n%r\n" for k in range(4) for axis in (1, 2, 3))
        if self._is_r12:
            head = f"0\n3DFACE\n5\n%X\n8\n{layer}\n"
        else:
            head = f"0\n3DFACE\n5\n%X\n330\n{self._owner}\n100\nAcDbEntity\n8\n{layer}\n"
            head += "100\nAcDbFace\n"
        template = head + coordinates
        first = self.next_handle
        self.parts += [template % (first + k, *row) for k, row in enumerate(rows)]
        self.next_handle += len(rows)

    def add_points(self, layer: str, points: Float64Array, stated: Sequence[Sequence[str]]) -> None:
        """Add points with texts of their extended data."""
        for row, texts in zip(points.tolist(), stated, strict=True):
            head = self._begin("POINT", layer, "AcDbPoint")
            self.parts.append(f"{head}{_format_place(row)}{format_stated(texts)}")

    def add_line(self, layer: str, rows: Float64Array, stated: Sequence[str] = ()) -> None:
        """Add a polyline: in space, or in the plane if it has no elevations or just one."""
        is_closed = len(rows) > 3 and bool((rows[0] == rows[-1]).all())
        if is_closed:
            rows = rows[:-1]
        is_flat = rows.shape[1] == 2
        if is_flat:
            self._add_plane_line(layer, rows, 0.0, is_closed=is_closed, stated=stated)
        else:
            self._add_polyline(layer, rows, _IN_SPACE | is_closed, stated)

    def add_contour(self, layer: str, rows: Float64Array) -> None:
        """Add a line of one elevation as a polyline in the plane."""
        is_closed = len(rows) > 3 and bool((rows[0] == rows[-1]).all())
        plane = rows[:-1, :2] if is_closed else rows[:, :2]
        self._add_plane_line(layer, plane, float(rows[0, 2]), is_closed=is_closed, stated=())

    def _add_plane_line(
        self,
        layer: str,
        rows: Float64Array,
        elevation: float,
        *,
        is_closed: bool,
        stated: Sequence[str],
    ) -> None:
        if self._is_r12:
            places = np.column_stack([rows, np.full(len(rows), elevation)])
            self._add_polyline(layer, places, int(is_closed), stated, elevation=elevation)
            return
        head = self._begin("LWPOLYLINE", layer, "AcDbPolyline")
        corners = "".join(f"10\n{x!r}\n20\n{y!r}\n" for x, y in rows.tolist())
        self.parts.append(
            f"{head}90\n{len(rows)}\n70\n{int(is_closed)}\n38\n{elevation!r}\n{corners}"
            f"{format_stated(stated)}"
        )

    def _add_polyline(
        self,
        layer: str,
        places: Float64Array,
        flags: int,
        stated: Sequence[str],
        *,
        elevation: float = 0.0,
    ) -> None:
        """Add a polyline with an entity for each vertex: one in space, or one of R12."""
        handle = f"{self.next_handle:X}"
        head = self._begin("POLYLINE", layer, "AcDb3dPolyline")
        self.parts.append(
            f"{head}66\n1\n10\n0.0\n20\n0.0\n30\n{elevation!r}\n70\n{flags}\n{format_stated(stated)}"
        )
        vertex_flags = "70\n32\n" if flags & _IN_SPACE else ""
        for row in places.tolist():
            vertex = self._begin(
                "VERTEX", layer, "AcDbVertex", "AcDb3dPolylineVertex", owner=handle
            )
            self.parts.append(f"{vertex}{_format_place(row)}{vertex_flags}")
        self.parts.append(self._begin("SEQEND", layer, owner=handle))

    def add_texts(
        self, layer: str, points: Float64Array, texts: Sequence[str], height: float
    ) -> None:
        """Add a text at each point; none where it is empty."""
        for row, text in zip(points.tolist(), texts, strict=True):
            plain = clean_text(text)
            if plain:
                head = self._begin("TEXT", layer, "AcDbText")
                end = "" if self._is_r12 else "100\nAcDbText\n"
                self.parts.append(f"{head}{_format_place(row)}40\n{height!r}\n1\n{plain}\n{end}")

    def add_labels(
        self, layer: str, points: Float64Array, texts: Sequence[str], how: Lettering
    ) -> None:
        """Add texts centred at points and turned, with a mask that hides the line behind each.

        R12 knows no masks.
        """
        for row, text, turn in zip(points.tolist(), texts, how.rotations, strict=True):
            place, plain = _format_place(row), clean_text(text)
            if self._is_r12:
                x, y, z = row
                self.parts.append(
                    f"{self._begin('TEXT', layer)}{place}40\n{how.height!r}\n1\n{plain}\n"
                    f"50\n{turn!r}\n72\n{_CENTRED}\n73\n{_AMID}\n"
                    f"11\n{x!r}\n21\n{y!r}\n31\n{z!r}\n"
                )
            else:
                self.parts.append(
                    f"{self._begin('MTEXT', layer, 'AcDbMText')}{place}"
                    f"40\n{how.height!r}\n71\n{_MIDDLE}\n72\n1\n1\n{plain}\n"
                    f"50\n{turn!r}\n90\n{_AS_WINDOW}\n63\n256\n45\n{_MASK!r}\n"
                )


def _format_place(row: Sequence[float]) -> str:
    return f"10\n{row[0]!r}\n20\n{row[1]!r}\n30\n{row[2]!r}\n"


def format_stated(texts: Sequence[str]) -> str:
    """Return texts as extended data; nothing if all are empty."""
    if not any(texts):
        return ""
    lines = "".join(f"1000\n{clean_text(text)}\n" for text in texts)
    return f"1001\n{APPLICATION}\n{lines}"


def clean_text(text: str) -> str:
    """Return a text of one line that a drawing can hold."""
    plain = "".join(one if one.isprintable() else " " for one in text).strip()
    return plain.encode("utf-8", "replace").decode("utf-8")[:_LONGEST_TEXT]
