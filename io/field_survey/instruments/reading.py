"""Surveys of instruments' files, whose records the other modules here gather in books."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import dc, gsi, jobxml, sdr

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.crs import CrsLike, UnitLike
    from ....tin import Survey


def read_dc(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    encoding: str | None = None,
    source_crs: CrsLike | None = None,
) -> Survey:
    """Read points of a Trimble DC file; ``elevation_unit`` says which feet a file in feet is in.

    Returns
    -------
    Survey
        Of the grid positions (69) and coordinates (08), with ``number``, ``description`` (the
        codes), and ``method`` with the method and classification if there are several. Positions of
        GNSS and observations of points that have no such record are left out and counted.

    Raises
    ------
    ReadError
        If it has no header, a number is none, or no point has coordinates.
    """
    book = dc.read_book(path, encoding=encoding)
    return book.make_survey(crs=crs, elevation_unit=elevation_unit, source_crs=source_crs)


def read_gsi(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    encoding: str | None = None,
    source_crs: CrsLike | None = None,
    code_blocks: str | None = None,
    oriented: bool = False,
    refraction: float | None = None,
) -> Survey:
    """Read points of a Leica GSI file.

    Parameters
    ----------
    code_blocks : {"before", "after"}, optional
        Whether a block of codes (word 41) stands before or after the point that it is for; default
        where the first and last block show it.
    oriented : bool, optional
        Whether the circle reads azimuths, so that shots without coordinates are reduced.
    refraction : float, optional
        Coefficient of refraction by which shots are corrected, with the earth's curvature.

    Returns
    -------
    Survey
        With ``number``, and ``description`` of the remarks (word 71) or codes (41). Shots without
        coordinates are reduced where station, heights and orientation are known, and else left out.

    Raises
    ------
    ReadError
        If a word is no word, lengths are in feet and in metres, or no point has coordinates.
    """
    book = gsi.read_book(
        path, encoding=encoding, code_blocks=code_blocks, oriented=oriented, refraction=refraction
    )
    return book.make_survey(crs=crs, elevation_unit=elevation_unit, source_crs=source_crs)


def read_sdr(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    encoding: str | None = None,
    source_crs: CrsLike | None = None,
    refraction: float | None = None,
) -> Survey:
    """Read points of an SDR file.

    Parameters
    ----------
    refraction : float, optional
        As :func:`read_gsi` takes it: corrects shots for refraction and the earth's curvature.

    Returns
    -------
    Survey
        Of the records of coordinates (08). Observations (09F1, 09F2) of points that have none are
        reduced where station, back bearing and height of the target are known, and else left out;
        so are those that the instrument has corrected itself (09MC), of which the file does not say
        by what.
    """
    book = sdr.read_book(path, encoding=encoding, refraction=refraction)
    return book.make_survey(crs=crs, elevation_unit=elevation_unit, source_crs=source_crs)


def read_jobxml(
    path: Path,
    *,
    crs: CrsLike | None = None,
    elevation_unit: UnitLike | None = None,
    source_crs: CrsLike | None = None,
) -> Survey:
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
    return jobxml.read_book(path).make_survey(
        crs=crs, elevation_unit=elevation_unit, source_crs=source_crs
    )
