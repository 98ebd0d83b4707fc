"""What a function of the caller's makes of each tile."""

from __future__ import annotations

import pickle
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ...base.atomic import replacing
from ...base.errors import OptionError
from ...terrain.parts import are_owned, as_surface
from ..tasks import TileProduct, find_reference

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from ...base.types import Bounds
    from ...tin import TIN
    from ..reading import StoredPoints
    from ..running import Record
    from ..tasks import Part


def measure_area(tin: TIN, box: Bounds) -> float:
    """Return the area of the triangles of a tile whose first corner lies in it: an example."""
    return float(tin.triangle_areas[are_owned(tin.points[tin.triangles[:, 0]], box)].sum())


def check_options(*, function: Any) -> dict[str, Any]:
    """Return the name of a function that workers can import."""
    module, name = getattr(function, "__module__", None), getattr(function, "__qualname__", "")
    if module in (None, "__main__") or "<" in name or not callable(function):
        raise OptionError("function", function, "a function of a module that workers can import")
    return {"function": f"{module}:{name}"}


def compute(part: Part) -> tuple[int, dict[str, Any], list[str]]:
    """Call the function with the triangles that meet a tile, and its box."""
    job = part.job
    local = part.triangulate(job.tile.box)
    if not len(local.triangles):
        return 0, {}, []
    options = job.options
    tin = as_surface(local, *find_reference(options))
    module, _, name = options["function"].partition(":")
    function: Any = import_module(module)
    for one in name.split("."):
        function = getattr(function, one)
    file_name = f"{job.key}.pickle"
    with replacing(part.folder / file_name) as file:
        pickle.dump(function(tin, job.tile.box), file)
    return len(local.points), {}, [file_name]


def join(
    points: StoredPoints, options: Mapping[str, Any], records: Mapping[str, Record], folder: Path
) -> list[Any]:
    """Return what the function made, in the order of the tiles."""
    del points, options
    made = []
    for record in records.values():
        for name in record.files:
            with (folder / name).open("rb") as file:
                made.append(pickle.load(file))
    return made


PRODUCT = TileProduct(check_options, compute, join)
