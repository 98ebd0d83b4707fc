"""Trimble JobXML files (.jxl): points of the reductions, else those of the field book.

All lengths of JobXML are metres, whatever the job showed in the field. Of the reductions every
point is read, of the field book the records that are not deleted and have a position in the grid,
keyed in, computed or observed by GNSS. Circle readings are not reduced here, since corrections of
the instrument would be missing: a job that is exported with its reductions has all of it.

Reference: Trimble, JobXML schema 5.3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.parsers import expat

from ....base.errors import ReadError
from ....base.sentences import FILE, counted, inflect
from .record_lines import parse_coordinate
from .records import Book, book_reader

if TYPE_CHECKING:
    from pathlib import Path

_RECORDS: dict[tuple[str, ...], str] = {
    ("JOBFile", "Reductions", "Point"): "reductions",
    ("JOBFile", "InventoryData", "Point"): "reductions",
    ("JOBFile", "FieldBook", "PointRecord"): "field book",
}
_LEAVES = ("Name", "Code", "Method", "SurveyMethod", "Classification", "Deleted")
_GRIDS = ("Grid", "ComputedGrid")
_AXES = ("East", "North", "Elevation")
_DEEPEST = 64
"""Elements within each other; JobXML has about 8."""
_LONGEST = 10_000
_CHUNK = 1 << 20


@book_reader
def read(path: Path) -> Book:
    """Read points of a Trimble JobXML file.

    The file names its coordinate system in words of its own: ``crs`` is that of the grid
    coordinates, whose metres are converted to its unit; of units only the metre is taken.

    Returns
    -------
    Survey
        With ``number``, ``description`` (the codes), and ``method`` if there are several. Points
        that are deleted, or have no position in the grid, are left out and counted.

    Raises
    ------
    ReadError
        If it is no well-formed JobXML, declares a document type, has a grid that does not count
        to north and east, or no point has coordinates.
    """
    reader = _Reader(path)
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parser.CharacterDataHandler = reader.add_text
    parser.StartDoctypeDeclHandler = reader.refuse_declaration
    reader.parser = parser
    try:
        with path.open("rb") as file:
            while chunk := file.read(_CHUNK):
                parser.Parse(chunk, False)
            parser.Parse(b"", True)
    except expat.ExpatError as error:
        raise ReadError(
            f"{FILE}, line {error.lineno}: it is no well-formed XML, "
            f"{expat.ErrorString(error.code)}.",
            lines=[error.lineno],
        ) from error
    except (ValueError, LookupError) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"{FILE} is in an encoding that is not read.") from error
    return reader.finish()


class _Record:
    """A point as it is read."""

    def __init__(self, line: int) -> None:
        self.line = line
        self.texts: dict[str, str] = {}
        self.grids: dict[str, dict[str, str]] = {}


class _Reader:
    """Takes elements as they come; keeps those of points."""

    parser: expat.XMLParserType

    def __init__(self, path: Path) -> None:
        self.path = path
        self.records: dict[str, list[_Record]] = {"reductions": [], "field book": []}
        self._tags: list[str] = []
        self._record: _Record | None = None
        self._depth = 0
        self._text: list[str] | None = None
        self._letters = 0

    def refuse_declaration(self, *_: object) -> None:
        """Refuse a document type, which may define entities or name other files."""
        raise ReadError(f"{FILE} declares a document type, which no JobXML has.")

    def start(self, tag: str, attributes: dict[str, str]) -> None:  # noqa: ARG002 - of expat
        """Open an element."""
        self._tags.append(tag.rpartition(":")[2])
        if len(self._tags) > _DEEPEST:
            raise ReadError(
                f"{FILE}, line {self.parser.CurrentLineNumber}: its elements are nested "
                f"deeper than {_DEEPEST}.",
            )
        if len(self._tags) == 1 and self._tags[0] != "JOBFile":
            raise ReadError(f"{FILE} is <{tag[:40]}>, and JobXML is <JOBFile>.")
        if self._record is None and tuple(self._tags) in _RECORDS:
            self._record = _Record(self.parser.CurrentLineNumber)
            self._depth = len(self._tags)
        is_value = self._record is not None or self._tags[-1] == "GridOrientation"
        self._text, self._letters = ([], 0) if is_value else (None, 0)

    def add_text(self, text: str) -> None:
        """Take a part of the text of an element."""
        if self._text is not None:
            self._letters += len(text)
            if self._letters <= _LONGEST:
                self._text.append(text)

    def end(self, tag: str) -> None:  # noqa: ARG002 - as expat calls it
        """Close an element."""
        name = self._tags[-1]
        text = "".join(self._text or ()).strip()
        if self._record is not None:
            tags = self._tags[self._depth :]
            if len(tags) == 1 and tags[0] in _LEAVES:
                self._record.texts.setdefault(tags[0], text)
            elif len(tags) == 2 and tags[0] in _GRIDS and tags[1] in _AXES:
                self._record.grids.setdefault(tags[0], {}).setdefault(tags[1], text)
            if len(self._tags) == self._depth:
                self.records[_RECORDS[tuple(self._tags)]].append(self._record)
                self._record = None
        elif name == "GridOrientation" and text and text != "IncreasingNorthEast":
            raise ReadError(f"its grid is '{text[:40]}', and only IncreasingNorthEast is read.")
        self._text = None
        self._tags.pop()

    def finish(self) -> Book:
        """Return the points of the reductions, or of the field book where there are none."""
        book = Book(self.path)
        reduced, observed = self.records["reductions"], self.records["field book"]
        for record in reduced or observed:
            if record.texts.get("Deleted", "").lower() == "true":
                book.leave_out("points deleted in the field", record.line)
            else:
                grid = next((record.grids[one] for one in _GRIDS if record.grids.get(one)), None)
                if grid is None:
                    book.leave_out("points without a position in the grid", record.line)
                else:
                    x, y, z = (parse_coordinate(grid.get(axis, ""), record.line) for axis in _AXES)
                    texts = record.texts
                    method = texts.get("SurveyMethod") or texts.get("Method") or ""
                    name = texts.get("Name", "")
                    book.add(name, (x, y, z), texts.get("Code", ""), record.line, method)
        names = {record.texts.get("Name", "") for record in reduced}
        lost = [one for one in observed if reduced and one.texts.get("Name", "") not in names]
        lost = [one for one in lost if one.texts.get("Deleted", "").lower() != "true"]
        if lost:
            beginning = f"{counted(len(lost), 'point')} of the field book [is|are]"
            book.notes.append(
                f"{inflect(beginning, len(lost))} not in the reductions, and not read: "
                f"{', '.join(one.texts.get('Name', '?') for one in lost[:5])}"
                f"{' ...' if len(lost) > 5 else ''}."
            )
        return book
