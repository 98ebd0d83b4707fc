"""Ortho: a picture of the ground with its place on it, draped over surfaces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from ...base.errors import ReadError
from ...base.georeference import find_axes

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence
    from pathlib import Path

    from ...base.arrays import BoolArray, Float64Array, UInt8Array
    from ...base.crs import CRS
    from ...tin import TIN

MOST_PIXELS = 4096
"""Widest and highest picture in a page: what phones draw, and a few megabytes to mail."""

_READER = "tinsmith.io.raster.ortho"
"""Files are read by ``io``, which stands above this package, so it is known by its name only, as
the registry knows the families of formats."""

_OUTSIDE = 1e-6
"""Share of the picture beyond its edge that rounding of a world file explains."""


@dataclass(frozen=True, eq=False)
class Ortho:
    """A picture with its place on the ground."""

    path: Path
    """Where it was read."""
    content: bytes
    """A file that browsers and graphics libraries read."""
    kind: str
    """One of "jpeg", "png", "webp"."""
    shape: tuple[int, int]
    """Rows and columns."""
    transform: tuple[float, ...]
    """Affine, from columns and rows to eastings and northings: a, b, x, d, e, y."""
    opacity: UInt8Array | None = None
    """(rows, columns), 0 where there is no picture; None where there is everywhere."""
    gap: float = 0.0
    """Share of the vertices of the surfaces at which there is no picture."""
    notes: tuple[str, ...] = ()
    """What was done to it, or taken for granted."""

    def __post_init__(self) -> None:
        a, b, _, d, e, _ = self.transform
        if not np.isfinite(self.transform).all() or a * e - b * d == 0.0:
            raise ReadError(
                f"'{self.path}' has no place on the ground: its pixels have no area.",
                path=self.path,
            )

    @property
    def placement(self) -> Float64Array:
        """The (2, 3) affine transform from eastings and northings to :meth:`place`."""
        a, b, x, d, e, y = self.transform
        turn = np.array([[e, -b], [-d, a]]) / (a * e - b * d)
        matrix = np.column_stack([turn, -turn @ (x, y)])
        return np.asarray(matrix / np.array(self.shape)[::-1, None])

    def draw_north_up(self, crs: CRS | None) -> Ortho:
        """Return the same for a drawing with eastings and northings, of one in a CRS."""
        columns = np.reshape(self.transform, (2, 3)).T
        transform = find_axes(crs).turn(columns).T.ravel().tolist()
        return replace(self, transform=tuple(transform))

    def place(self, points: Float64Array) -> Float64Array:
        """Return where in the picture points lie, (n, 2): from the left and the top, 0 to 1."""
        a, b, x, d, e, y = self.transform
        along, up = points[:, 0] - x, points[:, 1] - y
        area = a * e - b * d
        pixels = np.column_stack([(e * along - b * up) / area, (a * up - d * along) / area])
        return np.asarray(pixels / np.array(self.shape)[::-1])

    def decode(self) -> UInt8Array:
        """Return red, green, blue and opacity, (rows, columns, 4)."""
        from PIL import Image  # comes with what draws pictures

        with Image.open(BytesIO(self.content)) as picture:
            return np.asarray(picture.convert("RGBA"))

    def measure_gap(self, tins: Sequence[TIN]) -> float:
        """Return the share of the vertices of surfaces at which there is no picture.

        Raises ReadError if it shows nothing of any of them.
        """
        if not any(self._meets(tin) for tin in tins):
            raise ReadError(
                f"'{self.path}' shows nothing of the surface: it lies elsewhere.", path=self.path
            )
        bare = [self._find_bare(tin.points[np.unique(tin.triangles)]) for tin in tins]
        return float(np.concatenate(bare).mean())

    def _find_bare(self, points: Float64Array) -> BoolArray:
        places = self.place(points)
        bare = ((places < -_OUTSIDE) | (places > 1.0 + _OUTSIDE)).any(axis=1)
        if self.opacity is None:
            return np.asarray(bare)
        most = np.array(self.shape)[::-1] - 1
        columns, rows = (np.clip(places, 0.0, 1.0) * (most + 1)).astype(np.int64).T
        pixels = self.opacity[np.minimum(rows, most[1]), np.minimum(columns, most[0])]
        return np.asarray(bare | (pixels == 0))

    def _meets(self, tin: TIN) -> bool:
        """Whether the picture and any triangle share an area, by their separating axes."""
        corners = self.place(tin.points)[tin.triangles]
        apart = (corners.min(axis=1) >= 1.0).any(axis=1) | (corners.max(axis=1) <= 0.0).any(axis=1)
        square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
        for k in range(3):
            start, stop, third = (corners[:, (k + step) % 3] for step in range(3))
            sides = _cross((stop - start)[:, None], square - start[:, None])
            inner = np.sign(_cross(stop - start, third - start))
            apart |= (sides * inner[:, None] <= 0.0).all(axis=1)
        return not apart.all()


def _cross(a: Float64Array, b: Float64Array) -> Float64Array:
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def read_ortho(source: str | os.PathLike[str], tins: Sequence[TIN]) -> Ortho:
    """Read the picture to drape over surfaces of one CRS: any that GDAL places, as a GeoTIFF.

    Raises and warns of what :func:`tinsmith.io.raster.ortho.read_ortho` does.
    """
    reader = import_module(_READER)
    ortho: Ortho = reader.read_ortho(source, tins, most_pixels=MOST_PIXELS, transparent="webp")
    return ortho
