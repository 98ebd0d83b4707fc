"""Delimited text: survey points as CSV, TXT, XYZ; in any customary layout."""

from __future__ import annotations

import csv
from itertools import chain
from typing import TYPE_CHECKING, Any, Literal

from ...base.atomic import replacing
from ...base.errors import WriteError
from ...base.progress import Progress
from ...base.sentences import FILE
from ...tin import TIN, Survey
from ..registry import PointChunk, StreamHead, gather, keep_on_one_line, taking
from .columns import find_unit_word
from .lines import BLOCK_BYTES, COMMENT_PREFIXES, iterate_lines
from .table_reader import Asked, TableReader

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

    from ...base.arrays import AnyArray
    from ...base.progress import Tell
    from ..registry import Blocks
    from ..reprojection import Placing

_CHUNK_ROWS = 100_000
_SUFFIX_DELIMITERS = {".tsv": "\t", ".xyz": " ", ".pts": " "}
_BARE_SUFFIXES = frozenset({".xyz", ".pts"})


@taking(Asked)
def read(path: Path, asked: Asked) -> Survey:
    """Read survey points.

    Longitude and latitude (WGS 84) are reprojected to ``crs``. An ``encoding`` that is not given is
    UTF-8 or UTF-16, else Windows-1252.

    Parameters
    ----------
    columns : str, sequence of str, or mapping of str to str or int, optional
        What the columns are; default by header, else by content. Letters in their order
        (``"PNEZD"``: P point number, N northing, E easting, Z elevation, D description, X
        easting, Y northing, - other), names in their order (``["id", "easting", ...]``, or one
        text with commas), or a mapping from role to name in the header or number from 1
        (``{"easting": "X_LOCAL", "northing": 3, "elevation": 4}``; on the command line
        ``easting=X_LOCAL,northing=3,elevation=4``).
    delimiter : str, optional
        One letter, or "comma", "semicolon", "tab", "pipe", "space" (runs of spaces and tabs).
    decimal : {".", ","}, optional
        Decimal mark of the numbers; found by looking if it is not given.
    comment : str, optional
        What comment lines start with; default by looking (``# // ; ! %``), "" for none.
    skip_bad : bool, optional
        Whether rows with too few or too many cells, or a coordinate that is no number, are left
        out, instead of the file being refused.

    Returns
    -------
    Survey
        Other columns are ``attributes``: ``"number"``, ``"description"``, others by name. Points
        without an elevation are left out. ``skipped`` counts what is left out, ``skipped_lines``
        names the lines; ``notes`` says what was assumed, and what is odd.

    Raises
    ------
    ReadError
        If there is no table, its columns cannot be told or may be told in two ways, a row is bad
        (with ``skip_bad`` more than half of them), no point has an elevation, or the coordinates
        would be in degrees.
    CrsError
        If a CRS is unknown, or the points lie in its area of use only with coordinates exchanged;
        if the header gives eastings and northings another unit than the CRS has.
    OptionError
        If an option has a value that it cannot have; if ``elevation_unit`` is unknown, or another
        than the header gives.

    Notes
    -----
    Without a header and without ``columns`` all customary layouts are judged together, by what
    the columns hold and by the area of use of the CRS; docs/survey-text.md has the rules. Where
    two are plausible the file is refused with the two named, else ``notes`` says which was taken
    and why. The area of use is looked at however the columns are found.

    A number is the float64 nearest to its text. One million rows take about half a second
    on one core, two seconds where quotes stand inside cells or descriptions hold blanks.
    """
    return gather(_read_blocks(path, asked, None), path)


@taking(Asked)
def stream(path: Path, asked: Asked) -> Blocks:
    """Read survey points block by block; the options are those of :func:`read`.

    Notes
    -----
    A file of up to 8 MB is one block, and read as :func:`read` does. Of a larger one the first
    block, some 100,000 rows, decides on layout, columns and CRS, and a row further on that
    contradicts is refused with its line, once it is reached. What is odd of the rows of a block by
    themselves is told with their lines.
    """
    return _read_blocks(path, asked, BLOCK_BYTES)


def _read_blocks(path: Path, asked: Asked, block_bytes: int | None) -> Blocks:
    done, reader = Progress(asked.progress), TableReader(path.suffix, asked)
    placing: Placing | None = None
    notes: list[str] = []
    for lines in iterate_lines(path, encoding=asked.encoding, block_bytes=block_bytes):
        is_alone = lines.first == 0 and lines.is_last
        taken = reader.read(lines, done.stage(0.1, 0.9) if is_alone else None)
        notes = reader.finish() if lines.is_last else []
        if taken is None or len(taken.points) == 0:
            continue
        is_first = placing is None
        placing = placing or reader.begin_placing()
        placed = placing.add(taken.points)
        if is_first:
            yield StreamHead(placed.crs, placed.elevation_unit, has_lines=True)
        yield PointChunk(placed.points, taken.rows + 1, taken.attributes)
    assert placing is not None
    return reader.conclude([*notes, *placing.finish()])


# ------------------------------------------------------------------ writing


def write(
    obj: TIN | Survey,
    path: Path,
    *,
    columns: str | None = None,
    delimiter: str | None = None,
    header: bool | None = None,
    progress: Tell | None = None,
) -> None:
    """Write points; of a TIN its vertices.

    Parameters
    ----------
    columns : {"PNEZD", "PENZD", "ENZ", "NEZ", ...}, optional
        Letters as in :func:`read`. Default PNEZD for a survey with numbers and descriptions;
        otherwise easting, northing, elevation and all attributes (``.xyz`` and ``.pts``: the
        coordinates alone).
    delimiter : str, optional
        One letter; default by suffix: ``.tsv`` tab, ``.xyz`` and ``.pts`` space, else comma.
    header : bool, optional
        Whether names stand in the first line; default not for ``.xyz`` and ``.pts``.

    Raises
    ------
    WriteError
        If the file cannot be written, an attribute is missing, or the survey has lines, which
        a list of points would lose.

    Warns
    -----
    LossWarning
        If line breaks within texts become blanks.

    Notes
    -----
    Every number is written so that it reads back as the same float64. The header names the unit of
    elevations, ``elevation (ft)``, if it is known.
    """
    is_bare = path.suffix.lower() in _BARE_SUFFIXES
    table = _choose_written_columns(obj, columns, is_bare)
    separator = delimiter or _SUFFIX_DELIMITERS.get(path.suffix.lower(), ",")
    if len(separator) != 1 or separator in '"\n\r.' or separator.isalnum():
        raise WriteError(f"Cannot write {FILE}: '{delimiter}' is no delimiter.")
    names = (
        [] if (is_bare if header is None else not header) else [_name_written_columns(table, obj)]
    )
    values = list(keep_on_one_line(table).values())
    with replacing(path, binary=False) as file:
        writer = csv.writer(
            file, delimiter=separator, lineterminator="\n", quoting=_choose_quoting(values[0])
        )
        writer.writerows(chain(names, _iterate_rows(values, progress)))


def _choose_quoting(first: AnyArray) -> Literal[0, 2]:
    """Return the quoting by which no row begins as a comment does."""
    texts = first.tolist() if first.dtype.kind in "OU" else []
    has_marks = any(str(text).lstrip().startswith(COMMENT_PREFIXES) for text in texts)
    return csv.QUOTE_NONNUMERIC if has_marks else csv.QUOTE_MINIMAL


def _name_written_columns(table: Mapping[str, AnyArray], obj: TIN | Survey) -> list[str]:
    """Return the names of the columns, that of elevations with their unit if readers know it."""
    unit = obj.elevation_unit
    named = None if unit is None else f"elevation ({unit.symbol})"
    is_read = named is not None and find_unit_word(named) is not None
    return [str(named) if name == "elevation" and is_read else name for name in table]


def _choose_written_columns(
    obj: TIN | Survey, letters: str | None, is_bare: bool
) -> dict[str, AnyArray]:
    attributes = dict(obj.attributes) if isinstance(obj, Survey) else {}
    coordinates = dict(zip(("easting", "northing", "elevation"), obj.points.T, strict=True))
    if letters is None and {"number", "description"} <= attributes.keys() and not is_bare:
        others = {name: attributes[name] for name in attributes}
        number, description = others.pop("number"), others.pop("description")
        order = ("northing", "easting", "elevation")
        surveyed = {name: coordinates[name] for name in order}
        return {"number": number, **surveyed, "description": description, **others}
    if letters is None:
        return coordinates if is_bare else {**coordinates, **attributes}
    available = {**attributes, **coordinates}
    roles = {"P": "number", "N": "northing", "Y": "northing", "E": "easting", "X": "easting"}
    roles |= {"Z": "elevation", "H": "elevation", "D": "description"}
    chosen: dict[str, AnyArray] = {}
    for letter in letters.upper():
        role = roles.get(letter)
        if role is None or role not in available or role in chosen:
            wrong = "twice" if role in chosen else "not there" if role else "unknown"
            raise WriteError(
                f"Cannot write {FILE}: column {letter} of '{letters}' is {wrong}; the letters "
                f"are {', '.join(roles)}.",
            )
        chosen[role] = available[role]
    return chosen


def _iterate_rows(columns: Sequence[AnyArray], progress: Tell | None) -> Iterator[tuple[Any, ...]]:
    """Walk the rows as Python values; a float's text is the shortest that reads back the same."""
    count = len(columns[0])
    for start in range(0, count, _CHUNK_ROWS):
        stop = min(start + _CHUNK_ROWS, count)
        yield from zip(*(column[start:stop].tolist() for column in columns), strict=True)
        if progress is not None:
            progress(stop / count)
