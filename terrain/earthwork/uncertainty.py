"""Standard errors of volumes, and what of them lies beyond the level of detection."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...base.errors import OptionError
from ...base.results import Table
from ...base.sentences import coordinate, counted
from .. import _kernel
from ..surface import double_areas
from .cells import Overlay
from .detection import Detection, find_rounding, make_detection, require_level
from .error_models import as_error_model, find_errors
from .variances import measure_variances

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...base.arrays import Float64Array
    from ...base.progress import Progress
    from ...tin import TIN
    from ..surface import Reference, Surface
    from .cells import Cells
    from .error_models import ErrorModel
    from .volumes import Measured

_OPTIONS = ("standard_error", "other_standard_error")
_SUMS = ("cut", "fill", "net")
_BEYOND = ("cut", "fill", "cut_area", "fill_area")


class Asked(NamedTuple):
    """What is asked about errors, checked."""

    models: tuple[ErrorModel | None, ErrorModel | None]
    """Of the first surface and of the other one; None is exact."""
    level: float | None = None
    confidence: float | None = None

    @property
    def has_errors(self) -> bool:
        """Whether a surface has errors."""
        return any(self.models)

    @property
    def has_level(self) -> bool:
        """Whether there is a level of detection."""
        return self.level is not None or self.confidence is not None


def ask(first: Any, other: Any, level: Any, confidence: Any, *, is_plane: bool) -> Asked:
    """Check what is asked about errors.

    Raises OptionError.
    """
    models = [as_error_model(*pair) for pair in zip((first, other), _OPTIONS, strict=True)]
    if is_plane and other is not None:
        raise OptionError(_OPTIONS[1], other, "None with a level or a plane, which are exact")
    require_level(level, confidence)
    if confidence is not None and not any(models):
        raise OptionError("confidence", confidence, "None without a `standard_error`")
    return Asked((models[0], models[1]), level, confidence)


class SurfaceErrors(NamedTuple):
    """A surface and its errors."""

    surface: Surface
    errors: Float64Array
    """(n,), standard errors in the unit of the first surface."""
    model: ErrorModel | None
    shift: float
    """Standard error of a shift of all of it."""

    def measure_variances(self, weights: Float64Array) -> Float64Array:
        """Return the variances of sums of its errors with weights, (k, n)."""
        if self.model is None:
            return np.zeros(len(weights))
        loads = weights * self.errors
        used = np.flatnonzero(loads.any(axis=0))
        xy = self.surface.points[used, :2]
        found = measure_variances(xy, np.ascontiguousarray(loads[:, used].T), self.model)
        variances: Float64Array = found + (weights.sum(axis=1) * self.shift) ** 2
        return variances


def find_surface_errors(
    measured: Measured, asked: Asked, tins: Sequence[TIN | None]
) -> list[SurfaceErrors]:
    """Return the surfaces of a measurement with their errors.

    Raises OptionError if a column is none of the surface's, or has no value for a vertex.
    """
    found = []
    given = zip(
        (measured.first, measured.other), tins, asked.models, measured.reference.factors, _OPTIONS,
        strict=True,
    )  # fmt: skip
    for surface, tin, model, factor, option in given:
        if surface is None or tin is None:
            continue
        errors = np.zeros(len(surface.points))
        if model is not None:
            errors += find_errors(model, tin, option)
            _require_all(errors, surface, model, option)
        shift = 0.0 if model is None else model.systematic * factor
        found.append(SurfaceErrors(surface, errors * factor, model, shift))
    return found


def _require_all(errors: Float64Array, surface: Surface, model: ErrorModel, option: str) -> None:
    used = np.unique(surface.triangles)
    lost = used[np.isnan(errors[used])]
    if len(lost):
        x, y = surface.points[lost[0], :2].tolist()
        where = (
            f"{counted(len(lost), 'vertex', 'vertices')}, such as {coordinate(x)} {coordinate(y)}"
        )
        raise OptionError(
            option,
            str(model.standard_error),
            f"a column with a value for every vertex, and it has none for {where}",
        )


def find_detection(
    measured: Measured, asked: Asked, tins: Sequence[TIN | None]
) -> Detection | None:
    """Return the level of detection that is asked for, None if none is."""
    surfaces = [one for one in (measured.first, measured.other) if one is not None]
    if asked.level is not None:
        return Detection(asked.level, rounding=find_rounding(*surfaces))
    if asked.confidence is None:
        return None
    given = [
        (one.surface, one.errors, one.shift) for one in find_surface_errors(measured, asked, tins)
    ]
    return make_detection(asked.confidence, given, find_rounding(*surfaces))


def add_errors(
    measured: Measured,
    asked: Asked,
    tins: Sequence[TIN | None],
    detection: Detection | None,
    done: Progress,
) -> Table:
    """Return the table of volumes with their standard errors, and what is beyond the level.

    Notes
    -----
    A volume is linear in the elevations as long as the cells that are cut and filled stay the same:
    its derivative by the elevation of a vertex is the integral, over what is cut or filled, of the
    function that is 1 at the vertex, 0 at all others and linear between. These weights are the same
    for small errors of any kind; their sum with the errors has the variance that is taken.
    """
    if not asked.has_errors and detection is None:
        return measured.table
    surfaces = find_surface_errors(measured, asked, tins)
    overlay = Overlay(measured.pieces, measured.other, measured.plane)
    is_copy = len(surfaces) == 2 and not all(asked.models)
    rounding = find_rounding(*(one.surface for one in surfaces)) if is_copy else -1.0
    count = len(measured.names)
    variances, beyond = np.zeros((count, 3)), np.zeros((count, 5))
    agreed = 0.0
    for group in range(count):
        weights = [np.zeros((3, len(one.surface.points))) for one in surfaces]
        for cells in overlay.list_cells(group):
            if asked.has_errors:
                agreed += _add_weights(cells, surfaces, weights, rounding)
            if detection is not None:
                beyond[group] += _sum_beyond(cells, detection)
        for one, own in zip(surfaces, weights, strict=True):
            variances[group] += one.measure_variances(own)
        done((group + 1) / count)
    columns: dict[str, Any] = {}
    if asked.has_errors:
        errors = np.sqrt(variances) * measured.reference.up
        columns |= {f"{name}_error": errors[:, k] for k, name in enumerate(_SUMS)}
    if detection is not None:
        columns |= _list_beyond(beyond, detection, measured)
    notes = _describe(asked, len(surfaces), agreed if is_copy else 0.0, measured.reference)
    return _extend(measured.table, columns, measured.reference, notes)


def _add_weights(
    cells: Cells, surfaces: Sequence[SurfaceErrors], weights: list[Float64Array], rounding: float
) -> float:
    """Add what the elevation of each vertex changes cut, fill and net by, but for the sign.

    Where surfaces differ by no more than a ``rounding`` one is a copy of the other: there nothing
    changes. Returns the area of that.
    """
    areas, classes = cells.measure_areas(), cells.classify()
    centers = cells.points[cells.triangles, :2].mean(axis=1)
    is_net = (np.abs(cells.points[:, 2]) > rounding)[cells.triangles].any(axis=1)
    classes[~is_net] = 0
    for one, own, numbers in zip(surfaces, weights, (cells.first, cells.other), strict=False):
        assert numbers is not None
        corners = one.surface.triangles[numbers]
        shares = areas[:, None] * _find_shares(one.surface.points[corners, :2], centers)
        used, vertex = np.unique(corners, return_inverse=True)
        vertex = vertex.reshape(-1, 3)
        for row, chosen in zip(own, (classes < 0, classes > 0, is_net), strict=True):
            row[used] += np.bincount(
                vertex[chosen].ravel(), shares[chosen].ravel(), minlength=len(used)
            )
    return float(areas[~is_net].sum())


def _find_shares(corners: Float64Array, places: Float64Array) -> Float64Array:
    """Return the barycentric coordinates of places in triangles, (m, 3): none is below 0."""
    x, y = np.moveaxis(corners - places[:, None], 2, 0)
    shares = np.roll(x, -1, axis=1) * np.roll(y, -2, axis=1)
    shares -= np.roll(x, -2, axis=1) * np.roll(y, -1, axis=1)
    shares = np.maximum(shares, 0.0)
    total = shares.sum(axis=1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        found: Float64Array = np.where(total > 0.0, shares / total, 1.0 / 3.0)
    return found


def _sum_beyond(cells: Cells, detection: Detection) -> Float64Array:
    """Return cut and fill beyond the level, their areas, and the integral of the level."""
    divided = detection.divide(cells.points, cells.triangles)
    points, classes = divided.points, divided.classify()
    is_sound = double_areas(points, divided.triangles) > 0.0  # rounding turns over the thinnest
    flat = np.ascontiguousarray(points * (1.0, 1.0, 0.0))
    heights = np.ascontiguousarray(points[:, 2])
    triangles = np.ascontiguousarray(divided.triangles[is_sound])
    groups = classes[is_sound].astype(np.int32) + np.int32(1)
    sums = _kernel.sum_heights(flat, triangles, heights, groups, 3, 1.0)
    column = _kernel.SUMS.index
    parts = [sums[0, column("cut")], sums[2, column("fill")]]
    parts += [sums[0, column("cut_area")], sums[2, column("fill_area")]]
    levels = detection.measure(cells.points[:, :2])[cells.triangles].mean(axis=1)
    return np.array([*parts, float(levels @ cells.measure_areas())])


def _list_beyond(
    beyond: Float64Array, detection: Detection, measured: Measured
) -> dict[str, Float64Array]:
    area = np.asarray(measured.table["area"], float)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = beyond[:, 4] / area
    level = np.full(len(area), detection.level) if detection.is_even else mean
    cut, fill = (beyond[:, :2] * measured.reference.up).T
    columns = {"level_of_detection": level}
    columns |= {"thresholded_cut": cut, "thresholded_fill": fill, "thresholded_net": fill - cut}
    columns |= {"thresholded_cut_area": beyond[:, 2], "thresholded_fill_area": beyond[:, 3]}
    return columns


def _describe(asked: Asked, count: int, agreed: float, reference: Reference) -> list[str]:
    """Say what was taken for granted."""
    notes = []
    if asked.has_errors and count == 2 and not all(asked.models):
        which, option = ("other", 1) if asked.models[1] is None else ("first", 0)
        notes.append(
            f"The {which} surface is taken as exact: no `{_OPTIONS[option]}` of it is given."
        )
    if agreed > 0.0:
        notes.append(
            f"Over {agreed:.6g} {reference.units.area or 'square units'} the surfaces agree "
            "exactly: there one is taken as a copy of the other, whose errors do not count."
        )
    return notes


def _extend(
    table: Table, columns: dict[str, Any], reference: Reference, notes: Sequence[str]
) -> Table:
    """Return a table with more columns behind the volumes."""
    names = list(table.columns)
    at = names.index("net") + 1
    before, behind = (
        {name: table.columns[name] for name in part} for part in (names[:at], names[at:])
    )
    units: dict[str, Any] = {
        name: reference.units.area if "area" in name else reference.units.volume for name in columns
    }
    if "level_of_detection" in columns:
        units["level_of_detection"] = reference.elevation_unit
    return Table(
        before | columns | behind,
        units={**table.units, **units},
        name=table.name,
        notes=[*table.notes, *notes],
    )
