"""Coordinates on the ground in place of those of the grid: options of commands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from ..options import Group
from ..parameters import LibraryOption, number_option, under

if TYPE_CHECKING:
    from ...terrain import CombinedFactor
    from ...tin import TIN, Survey
    from ..output import Facts


@dataclass(frozen=True)
class GroundCoordinates:
    """Whether coordinates are scaled between the grid and the ground, and by what."""

    to_ground: bool = False
    combined_factor: float | None = None
    factor_base: tuple[float, float] | None = None
    undulation: float | None = None

    def find_factor(self, places: TIN | Survey) -> CombinedFactor | None:
        """Return the factor of a surface, or of points; None if the grid is to stay.

        They must be fitting.
        """
        if not self.to_ground:
            return None
        from ...terrain import CombinedFactor, combined_factor

        if self.combined_factor is None:
            return combined_factor(places, point=self.factor_base, undulation=self.undulation)
        assert self.factor_base is not None  # as is required above
        return CombinedFactor(self.combined_factor, base=self.factor_base, crs=places.crs)

    def require_fitting(self) -> None:
        """Refuse options that do not belong together, before anything is read."""
        if not self.to_ground:
            for flag in ("--combined-factor", "--factor-base", "--undulation"):
                if getattr(self, flag[2:].replace("-", "_")) is not None:
                    raise click.UsageError(f"{flag} needs --to-ground.")
        if self.combined_factor is None:
            return
        if self.undulation is not None:
            raise click.UsageError("--combined-factor and --undulation are both given: choose one.")
        if self.factor_base is None:
            raise click.UsageError(
                "--combined-factor needs --factor-base: the point that stays where it is."
            )


GROUND_COORDINATES = Group(
    "ground_coordinates",
    GroundCoordinates,
    under(
        "Coordinates on the ground",
        click.option(
            "--to-ground",
            is_flag=True,
            help="Write coordinates on the ground, whose distances are those that are measured: by "
            "the combined factor of the CRS in the middle of the input, at its mean elevation.",
        ),
        number_option(
            "--combined-factor",
            "FACTOR",
            "Grid over ground, in place of that factor.",
            cls=LibraryOption,
            sets=("combined",),
        ),
        click.option(
            "--factor-base",
            metavar="X Y",
            nargs=2,
            type=float,
            help="Easting and northing of the point that stays, CRS units; default the middle.",
        ),
        number_option(
            "--undulation",
            "HEIGHT",
            "Of the geoid above the ellipsoid there, unit of the elevations.",
        ),
    ),
)


def tell_factor(facts: Facts, factor: CombinedFactor | None) -> None:
    """Add by which factor coordinates were scaled, if they were."""
    if factor is None:
        return
    parts: dict[str, Any] = {
        "combined_factor": factor.combined,
        "factor_base": list(factor.base),
        "grid_scale": factor.grid_scale,
        "elevation_factor": factor.elevation_factor,
    }
    text = f"{factor.combined:.10g}, distances {factor.parts_per_million:+.1f} ppm"
    facts.add("Combined factor", text, **parts)
