"""Lines without elevations: before all else each tile has the triangles that they meet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..tin.tiling import KnownTriangles
from .along import load_parts
from .given import Given
from .running import Run
from .tasks import PHASE, TileJob, compute_tile, divide_job

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from ..base.arrays import Float64Array
    from ..tin.tiling import Draping, LaidLines
    from .division import Tile
    from .reading import StoredPoints
    from .running import Phase

_PRODUCT, _LINES = "drape", "lines"
_FOLDER = "draped"


@dataclass(frozen=True, kw_only=True)
class Drape:
    """How lines are draped on the surface of all points, and of the lines that have elevations.

    Attributes
    ----------
    run : Run
        Of the product. What is done lies in folders of its own in it.
    points : StoredPoints
    phase : Phase
        In which tiles are computed.
    find_tiles : callable
        Returns the tiles of a run.
    """

    run: Run
    points: StoredPoints
    phase: Phase
    find_tiles: Callable[[Run], list[Tile]]

    def lay(self, draping: Draping, base: Path | None) -> LaidLines:
        """Drape lines; ``base`` is the file of those that have elevations, if there are any.

        A vertex is rounded, which may put it into a triangle that no line meets. Such are asked
        for next, until there is none.
        """
        asked, rounds = draping.list_asked(), 0
        while True:
            own = Run(self.run.folder / f"{_FOLDER}.{rounds}")
            known = [] if not len(asked) else self._find_triangles(own, draping, base, asked)
            laid, unknown = draping.lay(known)
            if not len(unknown):
                return laid
            beside = np.stack([unknown, np.nextafter(unknown, np.inf)], axis=1)
            asked, rounds = np.concatenate([asked, beside]), rounds + 1

    def _find_triangles(
        self, run: Run, draping: Draping, base: Path | None, asked: Float64Array
    ) -> list[KnownTriangles]:
        """Return all triangles that segments, (k, 2, 2), meet, and others."""
        given = Given(xy=asked.reshape(-1, 2), offsets=2 * np.arange(len(asked) + 1))
        run.folder.mkdir(exist_ok=True)
        given.store(run.folder / _LINES)
        options = {"kind": _LINES, _LINES: given.describe()}
        duplicates, folder = draping.inputs.options.duplicates, self.points.folder
        jobs = [
            TileJob(run.folder, folder, tile, _PRODUCT, options, duplicates, base, is_told=False)
            for tile in self.find_tiles(run)
        ]
        records = self.phase.run(run, PHASE, compute_tile, jobs, divide=divide_job)
        parts = load_parts(records, run.folder)
        return [KnownTriangles(one.points, one.triangles) for one in parts]
