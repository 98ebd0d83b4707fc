"""What Features and Raster are made of, for the modules that hand them over."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ..arrays import AnyArray
    from ..crs import CRS, Unit
    from ..types import Grid

    Units = Mapping[str, Unit | str | None]

__all__ = ["FeatureParts", "RasterParts"]


class _Described(Protocol):
    """What both have."""

    @property
    def crs(self) -> CRS | None:
        """As of Features and Raster."""

    @property
    def units(self) -> Units:
        """Of columns or bands."""

    @property
    def name(self) -> str:
        """Of the product."""

    @property
    def notes(self) -> Sequence[str]:
        """What was assumed or left out."""


class FeatureParts(_Described, Protocol):
    """As :class:`tinsmith.Features` has them."""

    @property
    def coordinates(self) -> AnyArray:
        """One after the other."""

    @property
    def offsets(self) -> tuple[AnyArray, ...]:
        """Of each level."""

    @property
    def columns(self) -> Mapping[str, AnyArray]:
        """A value for each feature."""

    @property
    def elevation_unit(self) -> Unit | None:
        """Of the coordinates."""

    @property
    def geometry_type(self) -> str:
        """As OGC names it."""

    @property
    def has_elevations(self) -> bool:
        """Whether coordinates are in space."""

    def __len__(self) -> int: ...


class RasterParts(_Described, Protocol):
    """As :class:`tinsmith.Raster` has them."""

    @property
    def bands(self) -> Mapping[str, AnyArray]:
        """By name."""

    @property
    def grid(self) -> Grid:
        """Where the cells lie."""

    @property
    def nodata(self) -> float:
        """Of cells without surface."""
