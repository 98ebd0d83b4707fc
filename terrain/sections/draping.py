"""Draping: points, lines and polygons get the elevations of a surface."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.errors import LinesError, OptionError, choice
from ...base.georeference import describe_unknown, require_same_crs
from ...base.policies import OutsidePolicy
from ...base.products import product
from ...base.results import Features
from ...base.sentences import counted
from ...tin.topology import find_offsets, find_owners
from ..surface import as_features, as_segments
from .rows import cut_rows, find_runs
from .surfaces import as_surfaces

if TYPE_CHECKING:
    from ...base.arrays import AnyArray, BoolArray, Float64Array, Int64Array
    from ...base.georeference import Referenced
    from ...tin import TIN
    from .rows import Rows


@product
def drape(tin: TIN, features: Any, *, outside: OutsidePolicy = "error") -> Features:
    """Lay points, lines or polygons on a surface.

    Parameters
    ----------
    tin : TIN
    features : Features, (k, 2) array, Breakline, geometry, or sequence of these
        Of one kind, CRS units. An array is a polyline; a geometry is one of shapely, a
        GeoDataFrame, or whatever has a ``__geo_interface__``. Elevations in it are replaced.
    outside : {"error", "nan", "cut"}
        What becomes of parts without surface below or above them, outside it or in its holes: an
        error, vertices whose elevation is NaN, or left out (not of polygons).

    Returns
    -------
    Features
        The same features with elevations and a vertex wherever they cross an edge or pass a vertex
        of the surface, so that they lie on it; columns and units are kept. ``notes`` tell what is
        outside. With "cut" a line may have several parts, and features that are wholly outside are
        left out.

    Raises
    ------
    LinesError
        If something is outside and ``outside`` is "error", nothing would be left, a line has no
        length, coordinates are not finite, or triangles lie over each other.
    OptionError
        If ``outside`` is another word, or "cut" for polygons.
    CrsError
        If CRSs differ.

    Notes
    -----
    A vertex that is added is exact as those of :func:`tinsmith.profile`; a given vertex keeps its
    place and gets what :meth:`TIN.interpolate` gives. With "nan" a part of a line between two
    successive vertices that have elevations lies on the surface: what leaves it and comes back at
    once gets a vertex without elevation between. Vertices that repeat the one before are left out.

    Examples
    --------
    >>> import tinsmith as ts
    >>> square = [[0, 0, 0], [4, 0, 4], [4, 4, 8], [0, 4, 4]]
    >>> tin = ts.TIN.from_triangles(square, [[0, 1, 2], [0, 2, 3]])
    >>> ts.drape(tin, [[1, 2], [3, 2]]).coordinates
    array([[1., 2., 3.],
           [2., 2., 4.],
           [3., 2., 5.]])
    """
    given, is_plain = check_features(features, outside), not hasattr(features, "crs")
    surfaces = as_surfaces(tin)
    if given.kind == "points":
        elevations = tin.interpolate(_take_places(given))
        return drape_points(tin, given, elevations, outside=outside, is_plain=is_plain)
    given = _settle(given, surfaces, surfaces.notes, is_plain=is_plain)
    segments = as_segments(_take_places(given), given.offsets[0], what=given.kind[:-1])
    rows = cut_rows(surfaces, segments)
    lines = segments.lines[rows.places.segments]
    is_outside = np.zeros(len(given.offsets[0]) - 1, np.bool_)
    is_outside[lines[np.isnan(rows.elevations[:, 0])]] = True
    given = _note_pieces(given, is_outside, outside, rows, lines)
    return _cut_runs(given, rows, lines) if outside == "cut" else _keep_whole(given, rows, lines)


def check_features(features: Any, outside: OutsidePolicy) -> Features:
    """Return features of one kind, or refuse them, or an option that they cannot have."""
    choice("outside", outside, OutsidePolicy)
    given = as_features(features, "feature")
    if given.kind == "polygons" and outside == "cut":
        raise OptionError("outside", outside, allowed="error or nan for polygons")
    return given


def drape_points(
    surface: Referenced,
    given: Features,
    elevations: Float64Array,
    *,
    outside: OutsidePolicy,
    is_plain: bool,
) -> Features:
    """Return points as :func:`drape` does, of the elevations of a surface at them."""
    notes = describe_unknown(surface.crs, surface.elevation_unit)
    given = _settle(given, surface, notes, is_plain=is_plain)
    xy, is_outside = _take_places(given), np.isnan(elevations)
    if is_outside.any():
        given = _note_outside(given, is_outside, outside, xy[np.argmax(is_outside)], "point")
    xyz = np.column_stack([xy, elevations])
    if outside != "cut":
        return replace(given, coordinates=xyz)
    return _choose(given, xyz[~is_outside], (), np.flatnonzero(~is_outside))


def _settle(
    given: Features, surface: Referenced, notes: tuple[str, ...], *, is_plain: bool
) -> Features:
    """Return features in the CRS and the unit of a surface, with its notes; refuse other CRSs."""
    assumed = require_same_crs(given.crs, surface.crs, "the features", is_plain=is_plain)
    return replace(
        given,
        crs=surface.crs,
        elevation_unit=surface.elevation_unit,
        notes=(*given.notes, *notes, *assumed),
    )


def _take_places(given: Features) -> Float64Array:
    return np.ascontiguousarray(given.coordinates[:, :2]) + 0.0


def _note_pieces(
    given: Features,
    is_outside: BoolArray,
    outside: OutsidePolicy,
    rows: Rows,
    lines: AnyArray,
) -> Features:
    """Say which pieces of features are outside, or refuse them."""
    if not is_outside.any():
        return given
    first = np.flatnonzero(is_outside[lines] & np.isnan(rows.elevations[:, 0]))[0]
    what = "line" if given.kind == "lines" else "ring"
    return _note_outside(given, is_outside, outside, rows.places.xy[first], what)


def _note_outside(
    given: Features, is_outside: BoolArray, outside: OutsidePolicy, place: Any, what: str
) -> Features:
    count, first = int(is_outside.sum()), int(np.argmax(is_outside))
    all_of = counted(len(is_outside), what)
    verb = "lies" if count == 1 else "lie"
    text = (
        f"{count:,} of {all_of} {verb} outside the surface or partly so (first: {what} {first}, at "
        f"{tuple(place.tolist())})"
    )
    if outside == "error":
        ways = "`outside='nan'` keeps such parts without elevations"
        cut = "" if given.kind == "polygons" else ", `outside='cut'` leaves them out"
        raise LinesError(f"{text}: {ways}{cut}.", lines=np.flatnonzero(is_outside)[:5])
    became = "have no elevation there" if outside == "nan" else "were cut there"
    return replace(given, notes=(*given.notes, f"{text}: they {became}."))


def _keep_whole(given: Features, rows: Rows, lines: Int64Array) -> Features:
    xyz = np.column_stack([rows.places.xy, rows.elevations[:, 0]])
    pieces = find_offsets(np.bincount(lines, minlength=len(given.offsets[0]) - 1))
    return replace(given, coordinates=xyz, offsets=(pieces, *given.offsets[1:]))


def _cut_runs(given: Features, rows: Rows, lines: Int64Array) -> Features:
    runs = find_runs(rows)
    owner = lines[runs.first_rows]
    if given.is_multi:
        owner = find_owners(given.offsets[1])[owner]
    return _choose(given, runs.coordinates, (runs.offsets,), owner)


def _choose(
    given: Features,
    coordinates: Float64Array,
    offsets: tuple[Int64Array, ...],
    owner: Int64Array,
) -> Features:
    """Return the features that still have parts; ``owner`` says whose each part is."""
    kept, counts = np.unique(owner, return_counts=True)
    if len(kept) == 0:
        verb = "lies" if len(given) == 1 else "lie"
        raise LinesError(f"{counted(len(given), 'feature')} {verb} wholly outside the surface.")
    has_parts = given.is_multi or (counts > 1).any()
    lost = len(given) - len(kept)
    note = f"{counted(lost, 'feature')} wholly outside {'was' if lost == 1 else 'were'} left out."
    return replace(
        given,
        coordinates=coordinates,
        offsets=(*offsets, find_offsets(counts)) if has_parts else offsets,
        columns={name: column[kept] for name, column in given.columns.items()},
        notes=(*given.notes, note) if lost else given.notes,
    )
