"""Template: the fields of an office's title block, read from a small TOML file."""

from __future__ import annotations

import datetime as dt
import io
import struct
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import optional
from ...base.atomic import as_path
from ...base.errors import OptionError, ReadError
from .paper import PURPOSE, Office, Revision, clean_text

if TYPE_CHECKING:
    from ...base.arrays import AnyArray

_LONGEST = 100
"""Letters of a text; more have no room on any sheet."""
_MOST_ROWS, _MOST_REVISIONS = 8, 10
_FIELDS = {
    "client": "Client",
    "project": "Project",
    "drawing_number": "Drawing number",
    "drawn_by": "Drawn by",
    "checked_by": "Checked by",
}
"""Heads of fields that are written one beside the other."""
_KNOWN = ("company", *_FIELDS, "date", "revisions", "rows", "logo")
_PNG = b"\x89PNG\r\n\x1a\n"
_MOST_PIXELS = 4_000_000


def read_template(given: Any) -> Office:
    """Return what a template says: the path of a TOML file, or a mapping with the same fields.

    Raises OptionError if it is neither, or if a field is unknown, too long or of another type.
    Raises ReadError if the file, or that of the logo, cannot be read.

    Examples
    --------
    >>> read_template({"client": "City of Eastmoor", "rows": {"Job": 2026014}}).fields
    (('Client', 'City of Eastmoor'), ('Job', '2026014'))
    """
    if given is None:
        return Office()
    if isinstance(given, Mapping):
        return _Template(given, "title_block", Path()).read()
    file = as_path(given, "title_block")
    return _Template(_load(file), f"'{file.name}'", file.parent).read()


def find_logo(path: Path) -> Path | None:
    """Return the file of the logo that a template names, if it names one.

    Raises ReadError if the file is no TOML.
    """
    name = _load(path).get("logo")
    return path.parent / name if isinstance(name, str) else None


def _load(file: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(_read(file).decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        raise ReadError(f"Cannot read '{file}' as TOML: it is not UTF-8.", path=file) from error
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        why = str(error) if isinstance(error, ValueError) else "it is nested too deeply"
        raise ReadError(f"Cannot read '{file}' as TOML: {why}.", path=file) from error


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a name that no file has
        why = getattr(error, "strerror", None) or str(error)
        raise ReadError(f"Cannot read '{file}': {why}.", path=file) from error


class _Template:
    """The fields of a template, checked one by one."""

    def __init__(self, fields: Mapping[Any, Any], source: str, folder: Path) -> None:
        self._fields = fields
        self._source = source
        self._folder = folder

    def read(self) -> Office:
        self._require_known(self._fields, _KNOWN, "")
        listed = [(head, self._take_text(name)) for name, head in _FIELDS.items()]
        return Office(
            company=self._take_text("company"),
            fields=(*((head, text) for head, text in listed if text), *self._take_rows()),
            revisions=self._take_revisions(),
            date=self._take_text("date"),
            logo=self._take_logo(),
        )

    def _take_text(self, name: str) -> str:
        return self._as_text(self._fields.get(name, ""), name)

    def _take_rows(self) -> list[tuple[str, str]]:
        rows = self._fields.get("rows", {})
        if not isinstance(rows, Mapping) or len(rows) > _MOST_ROWS:
            raise self._refuse("rows", rows, f"a table of at most {_MOST_ROWS} names with texts")
        return [
            (self._as_text(name, "name of a row"), self._as_text(value, f"row '{name}'"))
            for name, value in rows.items()
        ]

    def _take_revisions(self) -> tuple[Revision, ...]:
        given = self._fields.get("revisions", [])
        is_list = isinstance(given, list | tuple) and all(isinstance(one, Mapping) for one in given)
        if not is_list or len(given) > _MOST_REVISIONS:
            names = ", ".join(Revision._fields)
            allowed = f"a list of at most {_MOST_REVISIONS} tables with {names}"
            raise self._refuse("revisions", given, allowed)
        for one in given:
            self._require_known(one, Revision._fields, " of a revision")
        return tuple(map(self._as_revision, given))

    def _as_revision(self, given: Mapping[str, Any]) -> Revision:
        texts = {
            name: self._as_text(given.get(name, ""), f"{name} of a revision")
            for name in Revision._fields
        }
        return Revision(**texts)

    def _take_logo(self) -> AnyArray | None:
        name = self._take_text("logo")
        return _read_logo(self._folder / name) if name else None

    def _require_known(self, fields: Mapping[Any, Any], known: tuple[str, ...], of: str) -> None:
        for name in fields:
            if name not in known:
                raise self._refuse(f"field{of}", name, known)

    def _as_text(self, value: Any, name: str) -> str:
        """Return a text, a whole number or a date as it is written."""
        if isinstance(value, dt.date):
            value = value.isoformat()[:10]
        if isinstance(value, int) and not isinstance(value, bool):
            value = str(value)
        if not isinstance(value, str):
            raise self._refuse(name, value, "text")
        text = clean_text(value)
        if len(text) > _LONGEST:
            allowed = f"at most {_LONGEST} letters, and it has {len(text):,}"
            raise self._refuse(name, value, allowed)
        return text

    def _refuse(self, name: str, value: Any, allowed: str | tuple[str, ...]) -> OptionError:
        return OptionError("title_block", value, allowed, what=f"{name} in {self._source}")


def _read_logo(file: Path) -> AnyArray:
    """Return the picture of a PNG."""
    data = _read(file)
    if not data.startswith(_PNG) or len(data) < 24:
        raise ReadError(f"Cannot read '{file}' as a logo: it is no PNG.", path=file)
    width, height = struct.unpack(">II", data[16:24])
    if not 0 < width * height <= _MOST_PIXELS:
        size = f"{width:,} x {height:,} pixels"
        raise ReadError(
            f"Cannot read '{file}' as a logo: it has {size}, and at most {_MOST_PIXELS:,} are "
            "drawn.",
            path=file,
        )
    images = optional.load("matplotlib.image", PURPOSE)
    try:
        picture: AnyArray = images.imread(io.BytesIO(data), format="png")
    except (OSError, SyntaxError, ValueError) as error:
        raise ReadError(f"Cannot read '{file}' as a logo: {error}.", path=file) from error
    return np.repeat(picture[:, :, None], 3, axis=2) if picture.ndim == 2 else picture
