"""The alignments of a LandXML file as trees of elements, read as a stream."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ....base.sentences import shown
from ...isolated import translate_system_errors
from .numbers import fault, parse_words
from .parser import CHUNK, Parser

if TYPE_CHECKING:
    from pathlib import Path

    from .content import Content

_KEPT = frozenset(
    (
        *("Alignment", "CoordGeom", "Line", "Curve", "Spiral", "IrregularLine", "Chain"),
        *("Start", "End", "Center", "PI", "PntList2D", "PntList3D", "StaEquation"),
        *("Profile", "ProfAlign", "ProfSurf", "PVI", "ParaCurve", "UnsymParaCurve", "CircCurve"),
    )
)
_INFINITE = frozenset({"inf", "infinity", "+inf", "infinite"})


@dataclass(slots=True, eq=False)
class Node:
    """An element: its name, attributes, text, and the elements in it."""

    name: str
    attributes: dict[str, str]
    line: int
    """Of the file."""
    children: list[Node] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)

    def list_named(self, *names: str) -> list[Node]:
        """Return the elements in it of some names, in order."""
        return [one for one in self.children if one.name in names]

    def find(self, name: str) -> Node | None:
        """Return the first element in it of a name; None if there is none."""
        return next(iter(self.list_named(name)), None)

    def parse_text(self) -> list[float]:
        """Return the numbers of its text."""
        return parse_words("".join(self.texts), self.line, what=f"a {self.name}")

    def parse(self, name: str) -> float | None:
        """Return the number of an attribute; None if there is none."""
        text = self.attributes.get(name, "").strip()
        if not text:
            return None
        found = parse_words(text, self.line, what=f"{name} of a {self.name}")
        if len(found) != 1:
            raise fault(self.line, f"a {self.name} has {name}={shown(text)}, and one number is due")
        return found[0]

    def parse_radius(self, name: str) -> float | None:
        """Return the radius of an attribute, or None where it is infinite or not there."""
        if self.attributes.get(name, "").strip().lower() in _INFINITE:
            return None
        return self.parse(name) or None

    def require(self, name: str) -> float:
        """Return the number of an attribute that has to be there."""
        found = self.parse(name)
        if found is None:
            raise fault(self.line, f"a {self.name} has no {name}")
        return found


class _AlignmentParser(Parser):
    """The handlers of a file, and the elements of alignments as they are open."""

    def __init__(self) -> None:
        super().__init__(surface=None, points_only=True)
        self.alignments: list[Node] = []
        self._open: list[Node | None] = []

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        super()._start(tag, attributes)
        name = self._stack[-1]
        if not self._open and name != "Alignment":
            return
        is_kept = name in _KEPT and (not self._open or self._open[-1] is not None)
        node = Node(name, attributes, self._now) if is_kept else None
        if node is not None:
            parent = self._open[-1] if self._open else None
            (self.alignments if parent is None else parent.children).append(node)
            self._expat.CharacterDataHandler = node.texts.append
        else:
            self._expat.CharacterDataHandler = None
        self._open.append(node)

    def _end(self, tag: str) -> None:
        super()._end(tag)
        if self._open:
            self._open.pop()
            self._expat.CharacterDataHandler = None


def parse_alignments(path: Path) -> tuple[list[Node], Content]:
    """Read the alignments of a file, and what else it says: units, CRS and survey points.

    Raises
    ------
    ReadError
        If it is no well-formed XML, or no LandXML.
    """
    parser = _AlignmentParser()
    with translate_system_errors(path), path.open("rb") as file:
        while chunk := file.read(CHUNK):
            parser.feed(chunk)
        parser.close()
    return parser.alignments, parser.content
