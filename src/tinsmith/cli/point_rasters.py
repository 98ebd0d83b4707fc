"""Rasters of points: the options of their command, and which points and surface they are of."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..base.sentences import counted
from .parameters import parsed, under
from .paths import INPUT
from .tiling import take_points

if TYPE_CHECKING:
    from ..terrain import Raster
    from ..tin import TIN
    from .job import Job
    from .parameters import Decorator

_NOISE = (7, 18)
"""Classes of low and of high noise."""
_ALL_BUT_NOISE = [number for number in range(256) if number not in _NOISE]
_HEIGHTS = ("height", "canopy")
_OF_SURFACES = {
    "method": "linear",
    "at": "center",
    "azimuth": 315.0,
    "altitude": 45.0,
    "operator": None,
    "compute_edges": False,
}


@parsed
def _parse_classes(flag: str, value: str) -> list[int]:
    words = [word.strip() for word in value.split(",")]
    if not all(word.isascii() and word.isdigit() and int(word) < 256 for word in words):
        raise click.UsageError(
            f"Invalid {flag} '{value}': it must be numbers of classes from 0 to 255 with commas "
            "between them."
        )
    return [int(word) for word in words]


def point_options(command: Any) -> Any:
    """Add the options of heights of points to a command."""
    options: tuple[Decorator, ...] = under(
        "Heights of points",
        click.option(
            "--above",
            type=INPUT,
            metavar="FILE",
            help="Points above the surface of --value height or canopy, or a folder of them; "
            "default FILE.",
        ),
        click.option(
            "--above-classes",
            metavar="C,C,...",
            callback=_parse_classes,
            help="Classes of points that are taken above the surface; default all but noise, 7 and "
            "18.",
        ),
        click.option(
            "--find-ground",
            is_flag=True,
            help="Find the ground among the points of FILE, as 'tinsmith ground' does by default, "
            "in place of --classes.",
        ),
    )
    for option in reversed(options):
        command = option(command)
    return command


@dataclass(frozen=True)
class PointChoice:
    """What a raster of points is made of; false where it is one of a surface."""

    file: Path
    job: Job
    value: str
    above: Path
    above_classes: list[int] | None
    finds_ground: bool

    @classmethod
    def take(cls, file: Path, job: Job, asked: dict[str, Any]) -> PointChoice:
        """Take the options of points from all that were given; those of none are wrong usage."""
        above, classes, value = asked.pop("above"), asked.pop("above_classes"), asked["value"]
        finds_ground = asked.pop("find_ground")
        if value not in ("count", *_HEIGHTS):
            value = ""
        given = {
            "--above": above,
            "--above-classes": classes,
            "--find-ground": finds_ground or None,
        }
        flag = next((flag for flag, one in given.items() if one is not None), None)
        if value not in _HEIGHTS and flag is not None:
            raise click.UsageError(f"{flag} is for --value height and canopy.")
        if value:
            _require_points(job, asked, value)
        has_classes = "classes" in job.reading.options
        if finds_ground and has_classes:
            raise click.UsageError(
                "--find-ground finds the ground among all points of FILE, and --classes chooses it "
                "by its class: give one of them."
            )
        if value in _HEIGHTS and above is None and not has_classes and not finds_ground:
            raise click.UsageError(
                f"--value {value} needs to know the ground: choose it by --classes 2, find it by "
                "--find-ground, or name the points above the surface of FILE by --above."
            )
        return cls(file, job, value, above or file, classes, finds_ground)

    def __bool__(self) -> bool:
        return bool(self.value)

    @property
    def files(self) -> list[Path]:
        """All files of points, each once."""
        return [*dict.fromkeys([self.file, self.above])]

    @property
    def others(self) -> list[Path]:
        """Files of the points above a surface."""
        return [self.above] if self.value in _HEIGHTS else []

    @property
    def whole(self) -> str:
        """What needs all points at a time, if anything."""
        if self.finds_ground:
            return "--find-ground"
        return "--value canopy" if self.value == "canopy" else ""

    def in_tiles(self) -> dict[str, Any]:
        """Return the options of tiles: the points above the surface."""
        if not self.others:
            return {}
        from ..io import find_format

        cloud = take_points(self._choose({}), self.above)
        if "classes" not in find_format(cloud.headers[0].format).options("read"):
            self._refuse_classes()
            return {"other": cloud}
        return {"other": take_points(self._choose({"classes": self._classes}), self.above)}

    def compute(self, asked: dict[str, Any]) -> tuple[Raster, TIN | None, int]:
        """Compute the raster in memory; return it, the surface, and how many points it is of."""
        from ..terrain import rasterize_canopy, rasterize_counts, rasterize_heights

        cells = {name: asked[name] for name in ("spacing", "like")}
        if self.value == "count":
            survey = self.job.read_survey(self.file, need=", and points are counted.")
            return rasterize_counts(survey, **cells), None, len(survey)
        tin = self._find_ground() if self.finds_ground else self.job.read_tin(self.file)
        job = self._choose({}).with_fallback(classes=self._classes)
        survey = job.read_survey(self.above, need=", and heights are those of points.")
        if "classification" not in survey.attributes:
            self._refuse_classes()
        make = rasterize_canopy if self.value == "canopy" else rasterize_heights
        return make(tin, survey, **cells, threads=self.job.building.threads), tin, len(survey)

    def _find_ground(self) -> TIN:
        """Return the TIN of the ground that is found among the points of the file."""
        from ..terrain import ground

        job = self.job.with_fallback(attributes="all")
        need = ", and the ground is found among points."
        survey = job.add_lines(job.read_survey(self.file, need=need))
        with job.step(f"Finding the ground among {counted(len(survey), 'point')}") as progress:
            found = ground(survey, progress=progress)
        tin = job.build_tin(found.survey)
        job.note_surfaces(tin)
        return tin

    @property
    def _classes(self) -> list[int]:
        return _ALL_BUT_NOISE if self.above_classes is None else self.above_classes

    def _choose(self, more: dict[str, Any]) -> Job:
        """Return the job with the classes above the surface in place of those of it."""
        reading = self.job.reading
        options = {name: value for name, value in reading.options.items() if name != "classes"}
        return replace(self.job, reading=replace(reading, options=options | more))

    def _refuse_classes(self) -> None:
        if self.above_classes is not None:
            raise click.UsageError(f"'{self.above}' has no classes: --above-classes is for lidar.")


def _require_points(job: Job, asked: dict[str, Any], value: str) -> None:
    """Refuse options that are of surfaces alone, and remove them."""
    smooth = asked.pop("smooth")
    given = [name for name, usual in _OF_SURFACES.items() if asked.pop(name) != usual]
    given += [] if smooth is None else ["smooth"]
    flags = [f"--{name.replace('_', '-')}" for name in given] + (
        job.building.shaping if value == "count" else []
    )
    if flags:
        raise click.UsageError(f"{flags[0]} is of surfaces, and not for --value {value}.")
