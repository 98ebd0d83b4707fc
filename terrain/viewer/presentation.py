"""Preview: a surface in 3D as a page, as a picture or in a window."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Unpack, overload

import numpy as np

from ...base.atomic import as_path, replacing
from ...base.checks import require_type
from ...base.errors import RenderError, WriteError
from ...base.georeference import find_ground
from ...base.notes import join_notes
from ...base.products import product
from ...tin import TIN, Survey
from ..earthwork import difference
from .alignment import Aligned, align
from .options import PreviewKeywords, PreviewOptions
from .ortho import Ortho, read_ortho
from .page import Start, describe_page, find_labels, make_document
from .picture import PICTURE_SUFFIXES, write_picture
from .relief import choose_exaggeration, measure_relief
from .scene import describe_far_off
from .window import open_window

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from ...base.georeference import Ground
    from .relief import ElevationRange

PAGE_SUFFIXES = (".html", ".htm")
PREVIEW_SUFFIXES = (*PICTURE_SUFFIXES, *PAGE_SUFFIXES)
"""File name endings of what can be written."""

_COMPARED = "Cut and fill"
_BASIS = "{} minus {}, on the overlay of both triangulations; rounded as the coordinates are."
_FRAME_HEIGHT = 560


class Preview:
    """One surface or several, ready to be shown; made by :func:`tinsmith.preview`.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
    >>> ts.preview(tin, title="Yard").notes
    ('The unit of elevations is not known: taken to be the metre.',)
    """

    def __init__(
        self,
        aligned: Aligned,
        options: PreviewOptions,
        survey: Survey | None,
        ortho: Ortho | None = None,
        notes: Sequence[str] = (),
    ) -> None:
        self._notes = tuple(notes)
        self._ortho = ortho
        self._aligned = aligned
        self._surfaces = aligned.surfaces
        self._look = options
        self._survey = survey

    @cached_property
    def _ranges(self) -> dict[str, ElevationRange]:
        """Range of elevations of each surface, without those far off; all of them are sorted."""
        return {n: measure_relief(tin, find_ground(tin)) for n, tin in self._surfaces.items()}

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on what a viewer should know: notes of the surfaces, elevations far off.

        Examples
        --------
        >>> import tinsmith as ts
        >>> points = [[x, y, 5.0 + x] for x in range(6) for y in range(6)]
        >>> points[7][2] = 9999.0
        >>> ts.preview(ts.triangulate(points)).notes[-1]
        '1 elevation far off all others: 9,999.'
        """
        far_off = (
            f"{words}." if len(self._surfaces) == 1 else f"{name}: {words}."
            for name, tin in self._surfaces.items()
            if (words := describe_far_off(tin, self._ranges[name]))
        )
        return join_notes(self._notes, self._aligned.notes, far_off)

    def with_notes(self, notes: Sequence[str]) -> Preview:
        """Return the same with further notes.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]])
        >>> ts.preview(tin).with_notes(["One row was left out."]).notes[0]
        'One row was left out.'
        """
        joined = join_notes(notes, self._notes)
        return Preview(self._aligned, self._look, self._survey, self._ortho, joined)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write a page (.html) or a picture (.png, .jpg, .jpeg, .tif, .tiff).

        Parameters
        ----------
        path : path

        Returns
        -------
        pathlib.Path
            The file written: whole, or the old one is left as it was.

        Raises
        ------
        OptionError
            If the path is none.
        RenderError
            If the file cannot be written, its suffix is another, or for a picture the machine has
            no OpenGL or there are several surfaces.
        MissingExtraError
            If pyvista, which draws pictures, is not installed; a page needs nothing more.

        Examples
        --------
        >>> import tinsmith as ts
        >>> from tempfile import TemporaryDirectory
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
        >>> with TemporaryDirectory() as folder:
        ...     ts.preview(tin).save(f"{folder}/yard.html").name
        'yard.html'
        """
        file = _require_path(path)
        try:
            if file.suffix.lower() not in PAGE_SUFFIXES:
                write_picture(self._require_one("A picture"), file, self._look, self._ortho)
                return file
            page = self.to_html()
            with replacing(file, binary=False) as stream:
                stream.write(page)
        except WriteError as error:
            raise RenderError(str(error)) from error
        return file

    def show(self) -> None:
        """Open a window, and wait until it is closed.

        Raises
        ------
        RenderError
            If there is no display or no OpenGL, or there are several surfaces.
        MissingExtraError
            If pyvista is not installed.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
        >>> ts.preview({"before": tin, "after": tin}).show()  # of one surface a window opens
        Traceback (most recent call last):
        tinsmith.base.errors.RenderError: A window shows one surface, and there are 2: ...
        """
        open_window(self._require_one("A window"), self._look, self._ortho)

    def to_html(self) -> str:
        """Return the page: one HTML document that needs no other file and no network.

        Examples
        --------
        >>> import tinsmith as ts
        >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
        >>> "<title>Yard" in ts.preview(tin, title="Yard").to_html()
        True
        """
        tins = list(self._surfaces.values())
        ground = find_ground(tins[-1])
        surfaces, changes, basis = _add_differences(self._surfaces)
        points, survey = self._aligned.labelled, self._survey
        labels = None if points is None or survey is None else find_labels(points, survey)
        content = describe_page(
            surfaces,
            ground,
            title=self._look.title,
            start=self._choose_start(ground),
            changes=changes,
            labels=labels,
            notes=(*self.notes, *(self._ortho.notes if self._ortho else ())),
            basis=basis,
            ortho=self._ortho,
        )
        return make_document(content)

    def _choose_start(self, ground: Ground) -> Start:
        """Choose how the page looks when it is opened, far off elevations left out."""
        options, ranges = self._look, self._ranges.values()
        relief = (min(one.low for one in ranges), max(one.high for one in ranges))
        last, shown = list(self._surfaces.values())[-1], list(ranges)[-1]
        return Start(
            exaggeration=options.exaggeration or choose_exaggeration(last, ground, shown),
            elevations=options.elevations or relief,
            relief=relief,
            tint=options.tint,
            interval=options.contours or 0.0,
        )

    def _repr_html_(self) -> str:
        page = escape(self.to_html(), quote=True)
        style = f"width: 100%; height: {_FRAME_HEIGHT}px; border: 0"
        return f'<iframe srcdoc="{page}" style="{style}" title="Terrain in 3D"></iframe>'

    def _require_one(self, what: str) -> TIN:
        if len(self._surfaces) > 1:
            raise RenderError(
                f"{what} shows one surface, and there are {len(self._surfaces)}: "
                "a page (.html) shows several."
            )
        return next(iter(self._surfaces.values()))


@overload
def preview(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    *,
    output: None = None,
    survey: Survey | None = None,
    ortho: str | os.PathLike[str] | None = None,
    **options: Unpack[PreviewKeywords],
) -> Preview: ...


@overload
def preview(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    *,
    output: str | os.PathLike[str],
    survey: Survey | None = None,
    ortho: str | os.PathLike[str] | None = None,
    **options: Unpack[PreviewKeywords],
) -> Path: ...


@product
def preview(
    tin: TIN | Sequence[TIN] | Mapping[str, TIN],
    *,
    output: str | os.PathLike[str] | None = None,
    survey: Survey | None = None,
    ortho: str | os.PathLike[str] | None = None,
    **options: Unpack[PreviewKeywords],
) -> Preview | Path:
    """Show a TIN in 3D with hypsometric tints, hillshade, legend, scale bar and north arrow.

    Parameters
    ----------
    tin : TIN, or sequence or mapping of str to TIN
        One surface, or several in one CRS for a page, the earliest or the existing ground first:
        the page has a slider between two of them, and shows cut and fill from each to the next.
        Those of a sequence are named by their files. Elevations are shown in the unit of the first.
    output : path, optional
        File to write at once: a page (.html) that turns in any browser, offline, or a picture
        (.png, .jpg, .jpeg, .tif, .tiff). Default: write nothing, and return a Preview.
    exaggeration : float, optional
        Factor on heights. Default: a round number that lifts the relief to a tenth of the extent
        or more, 1 where it is steep enough. It is written in the picture.
    edges : bool, optional
        Draw the edges of the triangles in a picture, by default not; a page has a switch for them.
    lines : bool, optional
        Draw the lines in the TIN, the default: hard breaklines dark, soft ones dashed, boundary and
        holes brown, the water's edge blue.
    size : tuple of int, optional
        Width and height of a picture or window, pixels, 200 to 5000 each; default (1600, 1000).
    title : str, optional
        Default "Terrain surface". A long one is written smaller, in up to three lines.
    view : {"oblique", "top"}, optional
        Of a picture: seen from the south-southwest, 35 degrees above the horizon, or as a map from
        above.
    azimuth : float, optional
        Where the viewer of a picture stands, degrees clockwise from north, in place of the view's.
        Default: that of the view, for a corridor across its axis.
    tilt : float, optional
        Height of the viewer of a picture above the horizon, 0 to 90 degrees, in place of the
        view's.
    sun : tuple of float, optional
        Azimuth and altitude of the light in a picture, degrees clockwise from north and above the
        horizon; default (315, 45).
    background : str, optional
        Colour behind a picture: "white" (the default), "black", "light", "dark", or one such as
        "#e8edf2". Words are light on a dark one.
    dpi : float, optional
        Dots per inch, 36 to 2400, written into a picture for those who print it.
    elevations : tuple of float, optional
        Lowest and highest elevation of the tints in a picture, so that several can be compared;
        default those of the surface.
    tint : {"elevation", "slope", "aspect", "plain"}, optional
        What colours tell in a picture; a page and a window have a switch for them.
    contours : float, optional
        Interval of contour lines in a picture, in the unit of elevations; default none.
    survey : Survey, optional
        Points that a page shows with their numbers, up to 20,000.
    ortho : path, optional
        Picture of the ground, laid over the surfaces: a GeoTIFF in any CRS, or a PNG, JPEG or JPEG
        2000 file with its place. Where it has nothing, or is transparent, the tints stay.

    Returns
    -------
    Preview or pathlib.Path
        The file written, if ``output`` is given. A Preview has ``save`` and ``show``, a window,
        and a notebook shows it as a page.

    Raises
    ------
    OptionError
        If an option is outside what is allowed, or there is no surface.
    CrsError
        If the surfaces, or the survey, have different CRSs, known of all or of none, or it cannot
        be told whether their elevations are in one unit; units that are known are converted.
    ReadError
        If the picture to drape cannot be read, has no place on the ground, or shows nothing of the
        surfaces.
    RenderError
        If the file cannot be written, or the machine has no OpenGL.
    MissingExtraError
        If pyvista, which draws pictures, or rasterio, which reads what is draped, is not installed.

    Warns
    -----
    LossWarning
        If what is draped is warped to the CRS of the surfaces, made smaller (to 4096 pixels), does
        not reach over all of them, or something about it has to be assumed.

    Notes
    -----
    Pictures are parallel projections, in which one scale holds from left to right all over the
    picture. The light is fixed to the ground. Tints span the lowest to the highest elevation;
    perceived lightness rises evenly with elevation. At either end at most one vertex in a hundred,
    if it lies off all others by more than four times their range, is left out of tints,
    exaggeration and frame, which the picture says. A surface at least ten times as long as wide is
    drawn in strips, one below the other. The same TIN and options give the same bytes on the same
    machine. Coordinates in a page are rounded to a millimetre, or finer where a surface is small.

    Examples
    --------
    >>> import tinsmith as ts
    >>> tin = ts.triangulate([[0, 0, 5], [4, 0, 6], [0, 3, 8]], crs="EPSG:32616")
    >>> page = ts.preview(tin).to_html()
    >>> page[:15]
    '<!doctype html>'
    """
    require_type("survey", survey, Survey, or_none=True)
    chosen, aligned = PreviewOptions.of(**options), align(tin, survey)
    picture = None if ortho is None else read_ortho(ortho, [*aligned.surfaces.values()])
    if picture is not None:
        picture = picture.draw_north_up(aligned.crs)
    made = Preview(aligned.draw_north_up(), chosen, survey, picture)
    return made if output is None else made.save(output)


def _add_differences(
    surfaces: Mapping[str, TIN],
) -> tuple[dict[str, TIN], dict[str, Float64Array], str]:
    """Return the surfaces, cut and fill from each to the next, and how these were computed."""
    shown, changes = dict(surfaces), {}
    pairs = [*pairwise(surfaces.items())]
    for (first_name, first), (second_name, second) in pairs:
        words = "" if len(pairs) == 1 else f", {first_name} to {second_name}"
        name = _find_free_name(f"{_COMPARED}{words}", shown)
        shown[name], changes[name] = _compare(first, second)
    one = _BASIS.format(*(name for name, _ in reversed(pairs[0]))) if len(pairs) == 1 else ""
    return shown, changes, one or (_BASIS.format("Each surface", "the one before") if pairs else "")


def _find_free_name(name: str, taken: Mapping[str, TIN]) -> str:
    """Return a name that no surface has."""
    while name in taken:
        name = f"{name} *"
    return name


def _compare(first: TIN, second: TIN) -> tuple[TIN, Float64Array]:
    """Return the second surface on the overlay with the first, and cut and fill at its vertices."""
    change = difference(first, second).tin
    places = np.array(change.points)
    differences = places[:, 2].copy()
    places[:, 2] = second.interpolate(places[:, :2], extrapolate="nearest")
    shown = TIN.from_triangles(
        places, change.triangles, crs=second.crs, elevation_unit=second.elevation_unit
    )
    return shown, differences


def _require_path(output: str | os.PathLike[str]) -> Path:
    path = as_path(output, "output")
    if path.suffix.lower() not in PREVIEW_SUFFIXES:
        raise RenderError(
            f"Cannot write a picture or a page to '{path}': its name must end in "
            f"{', '.join(PREVIEW_SUFFIXES)}."
        )
    if not path.parent.is_dir():
        raise RenderError(f"Cannot write '{path}': there is no folder '{path.parent}'.")
    return path
