"""Captions: what a title block says, of the drawing and of the office that made it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ....base.arrays import AnyArray
    from ....base.crs import Unit


class Revision(NamedTuple):
    """A revision of a drawing."""

    mark: str
    date: str
    text: str
    by: str


class Office(NamedTuple):
    """What the office says that made a drawing; of a template."""

    company: str = ""
    fields: tuple[tuple[str, str], ...] = ()
    """Such as ("Client", "City of Eastmoor"), in the order of the sheet."""
    revisions: tuple[Revision, ...] = ()
    date: str = ""
    logo: AnyArray | None = None
    """(rows, columns, 3 or 4), from the top."""

    @property
    def has_band(self) -> bool:
        """Whether there is more than a date."""
        return bool(self.company or self.fields or self.revisions or self.logo is not None)

    def list_texts(self) -> Iterator[str]:
        """Yield all texts."""
        yield self.company
        for head, text in self.fields:
            yield head
            yield text
        for revision in self.revisions:
            yield from revision


class Caption(NamedTuple):
    """What a title block says."""

    title: str
    facts: tuple[str, ...]
    """CRS, elevations, contours, points: a line each."""
    scale: str
    sheet: str
    """Such as "Sheet 1 of 3"."""
    date: str
    unit: Unit
    """Of the coordinates."""
    office: Office = Office()

    def list_texts(self) -> Iterator[str]:
        """Yield all texts."""
        yield from (self.title, self.date, *self.facts)
        yield from self.office.list_texts()
