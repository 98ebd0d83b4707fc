"""The contents of 3D Tiles 1.1, and the file that names them.

All of a tileset has one frame: metres to the east, to the north and up from a place in the middle
of the surface, which the transform of the root takes to the globe (EPSG:4978). Contents are GLB,
float32 from the middle of each, which is the translation of the node in doubles. All are whole
multiples of a step of the level, so that no place is rounded twice: a vertex on the side of two
contents is at one place.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.crs import CRS, Unit
from ..globe import describe_heights, find_frame, has_heights, place_on_globe
from ..gltf import MeshArrays, choose_colors, encode_glb, turn_up
from ..quantized_mesh import to_cartesian

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from ....base.arrays import Float64Array, Int32Array
    from ....base.types import Bounds

_RADIUS = 6_378_137.0
_STEPS = 2**23
"""In half of the width of a content: float32 holds them all."""
_METRES_PER_DEGREE = 111_320.0
_MOST_SHORT_VERTICES = 65_535


class Content(NamedTuple):
    """What a node of a tileset holds.

    Attributes
    ----------
    low, high : list of float
        The corners of its box in the frame, metres.
    error : float
        Largest distance from the whole surface, metres.
    """

    low: list[float]
    high: list[float]
    error: float

    def join(self, others: Sequence[Content]) -> Content:
        """Return the box of all, and the largest error."""
        every = [self, *others]
        return Content(
            np.min([one.low for one in every], axis=0).tolist(),
            np.max([one.high for one in every], axis=0).tolist(),
            max(one.error for one in every),
        )


@dataclass(frozen=True)
class Scene:
    """Where a surface lies on the globe.

    Attributes
    ----------
    crs : CRS
    elevation_unit : Unit or None
    bounds : Bounds
        Of the whole surface.
    elevations : (float, float)
        The lowest and the highest.
    """

    crs: CRS
    elevation_unit: Unit | None
    bounds: Bounds
    elevations: tuple[float, float]

    @cached_property
    def transform(self) -> Float64Array:
        """The (4, 4) matrix from the frame to the globe."""
        box = self.bounds
        middle = [(box.xmin + box.xmax) / 2, (box.ymin + box.ymax) / 2, sum(self.elevations) / 2]
        place = place_on_globe(np.array([middle]), self.crs, self.elevation_unit)
        return find_frame(place[0], to_cartesian(place)[0])

    @property
    def notes(self) -> list[str]:
        """What is to be told of the heights."""
        return [] if has_heights(self.crs) else [describe_heights(self.crs)]

    @property
    def metres(self) -> tuple[float, float]:
        """Of a unit of eastings, about, and of elevations."""
        along = self.crs.horizontal_unit.metres or _METRES_PER_DEGREE
        unit = self.elevation_unit or self.crs.usual_elevation_unit
        return along, (unit.metres if unit is not None else None) or 1.0

    def place(self, points: Float64Array) -> Float64Array:
        """Return points in the frame."""
        cartesian = to_cartesian(place_on_globe(points, self.crs, self.elevation_unit))
        moved, turn = cartesian - self.transform[:3, 3], self.transform[:3, :3]
        axes = [
            moved[:, 0] * turn[0, k] + moved[:, 1] * turn[1, k] + moved[:, 2] * turn[2, k]
            for k in range(3)
        ]  # the same for each point, whatever others there are
        return np.column_stack(axes)

    def find_step(self, side: float) -> float:
        """Return the step of contents that are so wide, a power of two, metres."""
        along, up = self.metres
        width = 2.0 * side * along
        reach = width + (self.elevations[1] - self.elevations[0]) * up + width * width / _RADIUS
        return float(2.0 ** math.ceil(math.log2(max(reach, 2.0**-20) / _STEPS)))


def encode_content(
    points: Float64Array, triangles: Int32Array, error: float, scene: Scene, *, side: float
) -> tuple[list[bytes], Content]:
    """Return a part of a surface as GLB, and what the tileset tells of it.

    Parameters
    ----------
    points : (n, 3) float64 array
        In the CRS.
    triangles : (m, 3) int32 array
    error : float
        Largest vertical distance from the whole surface, in the unit of elevations.
    scene : Scene
    side : float
        Of the squares of the level, CRS units.
    """
    step = scene.find_step(side)
    steps = np.rint(scene.place(points) / step)
    low, high = steps.min(axis=0), steps.max(axis=0)
    middle = np.floor((low + high) / 2)
    is_short = len(points) <= _MOST_SHORT_VERTICES
    positions = turn_up((steps - middle) * step).astype(np.float32)
    colors = choose_colors(points[:, 2], *scene.elevations)
    corners = triangles.astype(np.uint16 if is_short else np.uint32)
    node = {"translation": turn_up((middle * step)[None])[0].tolist()}
    ends = steps[triangles] * step
    longest = max(float(((ends[:, k] - ends[:, k - 1]) ** 2).sum(axis=1).max()) for k in range(3))
    bulge = longest / (6.0 * _RADIUS)  # of the globe over a flat triangle
    content = Content(
        (low * step).tolist(), (high * step).tolist(), error * scene.metres[1] + bulge
    )
    return encode_glb(MeshArrays(positions, None, corners, colors), node), content


def format_tileset(
    scene: Scene, contents: Mapping[Any, Content], uris: Mapping[Any, str], notes: Sequence[str]
) -> dict[str, Any]:
    """Return the text of ``tileset.json`` as plain values.

    Parameters
    ----------
    scene : Scene
    contents : mapping of Node to Content
        With the root, (0, 0, 0), and of each other one its parent.
    uris : mapping of Node to str
    notes : sequence of str
    """
    made: dict[Any, tuple[dict[str, Any], Content]] = {}
    for node in sorted(contents, key=lambda one: (-one.level, one.y, one.x)):
        below = [made[child] for child in node.children if child in made]
        whole = contents[node].join([content for _, content in below])
        tile: dict[str, Any] = {
            "boundingVolume": {"box": _format_box(whole)},
            "geometricError": whole.error,
            "content": {"uri": uris[node]},
        }
        if below:
            tile["children"] = [child for child, _ in below]
        made[node] = tile, whole
    root, whole = made[min(contents)]
    return {
        "asset": {"version": "1.1", "extras": {"crs": str(scene.crs), "notes": list(notes)}},
        "geometricError": max(math.dist(whole.low, whole.high), whole.error),
        "root": {
            "transform": scene.transform.T.ravel().tolist(),
            "refine": "REPLACE",
            **root,
        },
    }


def _format_box(content: Content) -> list[float]:
    """Return the middle of a box and its half axes."""
    low, high = np.array(content.low), np.array(content.high)
    half = (high - low) / 2
    return [*((low + high) / 2).tolist(), *np.diag(half).ravel().tolist()]
