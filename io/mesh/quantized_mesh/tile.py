"""One tile of quantized-mesh 1.0 as bytes, and back.

A tile is a rectangle of longitude and latitude: at level ``z`` the globe has 2^(z + 1) by 2^z of
them, counted from the south-west corner (TMS). Within it, places are whole numbers from 0 to 32767,
and so are heights between the lowest and the highest.

References
----------
https://github.com/CesiumGS/quantized-mesh
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ....base.arrays import Float64Array, Int64Array

_RADIUS = 6_378_137.0
_FLATTENING = 1 / 298.257223563
_POLAR_RADIUS = _RADIUS * (1 - _FLATTENING)
_FARTHEST = 1000.0
"""Of the horizon point, in radii, where a tile is so large that there is none: half the globe."""


class Sphere(NamedTuple):
    """A sphere in space, metres."""

    center: Float64Array
    radius: float


def to_cartesian(places: Float64Array) -> Float64Array:
    """Return X, Y, Z (metres from the centre of the Earth) of longitude, latitude, height.

    Parameters
    ----------
    places : (n, 3) float64 array
        Degrees, degrees, metres above the ellipsoid.
    """
    longitude, latitude = np.radians(places[:, 0]), np.radians(places[:, 1])
    squeeze = _FLATTENING * (2 - _FLATTENING)
    normal = _RADIUS / np.sqrt(1 - squeeze * np.sin(latitude) ** 2)
    across = (normal + places[:, 2]) * np.cos(latitude)
    up = (normal * (1 - squeeze) + places[:, 2]) * np.sin(latitude)
    return np.column_stack([across * np.cos(longitude), across * np.sin(longitude), up])


def bound_by_sphere(points: Float64Array) -> Sphere:
    """Return a sphere about points: about the middle of their bounds."""
    center = (points.min(axis=0) + points.max(axis=0)) / 2
    return Sphere(center, float(np.linalg.norm(points - center, axis=1).max()))


def find_horizon_point(points: Float64Array, center: Float64Array) -> Float64Array:
    """Return the point that is below the horizon only where all points are.

    Parameters
    ----------
    points : (n, 3) float64 array
        In space, metres.
    center : (3,) float64 array
        Gives the direction of the point from the centre of the Earth.

    Returns
    -------
    (3,) float64 array
        In radii of the ellipsoid.

    References
    ----------
    K. Ring, "Computing the horizon occlusion point", Cesium blog, 2013.
    """
    radii = np.array([_RADIUS, _RADIUS, _POLAR_RADIUS])
    scaled = points / radii
    direction = center / radii
    direction = direction / np.linalg.norm(direction)
    length = np.maximum(np.linalg.norm(scaled, axis=1), 1.0)
    aside = scaled / np.linalg.norm(scaled, axis=1, keepdims=True)
    cos_a = aside @ direction
    sin_a = np.linalg.norm(np.cross(aside, direction), axis=1)
    cos_b = 1.0 / length
    sin_b = np.sqrt(np.maximum(length**2 - 1.0, 0.0)) * cos_b
    below = cos_a * cos_b - sin_a * sin_b
    nearest = float(below.min())
    return np.asarray(direction * (1.0 / nearest if nearest > 1.0 / _FARTHEST else _FARTHEST))


STEPS = 32_767
"""Whole numbers from one edge of a tile to the other."""

_HEADER = struct.Struct("<3d2f3dd3d")
_NORMALS = 1
_MOST_SHORT_VERTICES = 65_536


class BrokenTileError(Exception):
    """What is wrong with the bytes of a tile, for the end of a sentence."""


@dataclass(frozen=True)
class TileName:
    """Level, column and row of a tile.

    Examples
    --------
    >>> TileName(0, 1, 0).bounds
    (0.0, -90.0, 180.0, 90.0)
    """

    level: int
    x: int
    y: int

    @property
    def width(self) -> float:
        """Degrees from edge to edge."""
        return float(180.0 / 2**self.level)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """West, south, east, north, degrees."""
        west, south = -180.0 + self.x * self.width, -90.0 + self.y * self.width
        return west, south, west + self.width, south + self.width


@dataclass(frozen=True, eq=False)
class Tile:
    """A tile as it is stored."""

    steps: Int64Array
    """(n, 3), of each vertex from west to east, south to north, lowest to highest, 0 to 32767."""
    triangles: Int64Array
    """(m, 3), counter-clockwise seen from above."""
    lowest: float
    """Height of the step 0, metres above the ellipsoid."""
    highest: float
    """Height of the step 32767 likewise."""
    normals: Float64Array | None = None
    """(n, 3), unit vectors in the axes of the globe."""
    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """That the header of a file tells, of the tile in space."""

    def place(self, west: float, south: float, width: float) -> Float64Array:
        """Return coordinates and height (metres) of the vertices in a square of the plane."""
        share = self.steps / STEPS
        heights = (1.0 - share[:, 2]) * self.lowest + share[:, 2] * self.highest
        plane = np.array([west, south]) + share[:, :2] * width
        return np.column_stack([plane, heights])


# ---------------------------------------------------------------------------- writing


def encode_tile(tile: Tile, name: TileName) -> bytes:
    """Return the bytes of a tile.

    Vertices are put in the order in which triangles first use them, which the encoding of indices
    asks for.
    """
    used, first = np.unique(tile.triangles, return_index=True)
    first_use = np.asarray(used[np.argsort(first)])
    number = np.empty(len(tile.steps), np.int64)
    number[first_use] = np.arange(len(first_use))
    steps, triangles = tile.steps[first_use], number[tile.triangles]
    west, south, _, _ = name.bounds
    places = Tile(steps, triangles, tile.lowest, tile.highest).place(west, south, name.width)
    is_long = len(steps) > _MOST_SHORT_VERTICES
    west, south, east, north = name.bounds
    middle = (float(places[:, 2].min()) + float(places[:, 2].max())) / 2
    center = to_cartesian(np.array([[(west + east) / 2, (south + north) / 2, middle]]))[0]
    cartesian = to_cartesian(places)
    sphere = bound_by_sphere(cartesian)
    horizon = find_horizon_point(cartesian, sphere.center)
    parts = [
        _HEADER.pack(*center, tile.lowest, tile.highest, *sphere.center, sphere.radius, *horizon),
        struct.pack("<I", len(steps)),
        *(_encode_steps(axis) for axis in steps.T),
    ]
    if is_long:
        parts.append(bytes(-sum(len(part) for part in parts) % 4))
    dtype = "<u4" if is_long else "<u2"
    flat = triangles.ravel()
    seen = np.maximum.accumulate(np.concatenate([[-1], flat[:-1]])) + 1
    parts += [struct.pack("<I", len(triangles)), np.asarray(seen - flat).astype(dtype).tobytes()]
    edges = []
    for axis, value in ((0, 0), (1, 0), (0, STEPS), (1, STEPS)):
        on = np.flatnonzero(steps[:, axis] == value)
        edges.append(on[np.argsort(steps[on, 1 - axis], kind="stable")])
    for edge in edges:
        parts += [struct.pack("<I", len(edge)), edge.astype(dtype).tobytes()]
    if tile.normals is not None:
        normals = _encode_normals(tile.normals[first_use])
        parts += [struct.pack("<BI", _NORMALS, len(normals)), normals]
    return b"".join(parts)


def _encode_steps(values: Int64Array) -> bytes:
    """Return differences, small ones near 0 whatever their sign (zig-zag)."""
    change = np.diff(values, prepend=0)
    return ((change << 1) ^ (change >> 63)).astype("<u2").tobytes()


def _encode_normals(normals: Float64Array) -> bytes:
    """Return two bytes a vector: its place on an octahedron.

    Meyer et al., "On floating-point normal vectors" (2010).
    """
    flat = normals / np.abs(normals).sum(axis=1, keepdims=True)
    sign = np.where(flat[:, :2] < 0, -1.0, 1.0)
    folded = (1.0 - np.abs(flat[:, 1::-1])) * sign
    plane = np.where(flat[:, 2:] < 0, folded, flat[:, :2])
    codes = np.rint((np.clip(plane, -1, 1) * 0.5 + 0.5) * 255).astype(np.uint8)
    return bytes(codes.tobytes())


# ---------------------------------------------------------------------------- reading


def decode_tile(content: bytes) -> Tile:
    """Return a tile from its bytes, unzipped."""
    if len(content) < _HEADER.size + 4:
        raise BrokenTileError("it is shorter than a header")
    header = _HEADER.unpack_from(content)
    lowest, highest = header[3:5]
    if not np.isfinite([lowest, highest]).all() or lowest > highest:
        raise BrokenTileError(f"its heights reach from {lowest:g} to {highest:g}")
    reader = _Reader(content, _HEADER.size)
    count = reader.read_count("vertices", 6)
    axes = [_decode_steps(reader.read("<u2", count)) for _ in range(3)]
    dtype = "<u2" if count <= _MOST_SHORT_VERTICES else "<u4"
    if dtype == "<u4":
        reader.at += -reader.at % 4
    n_triangles = reader.read_count("triangles", 3 * int(dtype[2]))
    codes = reader.read(dtype, 3 * n_triangles)
    seen = np.cumsum(codes == 0) - (codes == 0)
    triangles = np.asarray(seen - codes)
    steps = np.stack(axes, axis=1)
    if ((steps < 0) | (steps > STEPS)).any():
        raise BrokenTileError("a vertex lies outside of it")
    if ((triangles < 0) | (triangles >= count)).any():
        raise BrokenTileError("a triangle names a vertex that it does not have")
    center = header[:3] if np.isfinite(header[:3]).all() else (0.0, 0.0, 0.0)
    return Tile(steps, triangles.reshape(-1, 3), lowest, highest, center=center)


class _Reader:
    """Bytes read one array after the other, none longer than the rest of the file."""

    def __init__(self, content: bytes, at: int) -> None:
        self.content = content
        self.at = at

    def read_count(self, what: str, size: int) -> int:
        count = int(self.read("<u4", 1)[0])
        if count * size > len(self.content) - self.at:
            raise BrokenTileError(f"it promises {count} {what}, and ends before them")
        return count

    def read(self, dtype: str, count: int) -> Int64Array:
        size = count * int(dtype[2])
        if self.at + size > len(self.content):
            raise BrokenTileError("it ends too early")
        values = np.frombuffer(self.content, dtype, count, self.at)
        self.at += size
        return values.astype(np.int64)


def _decode_steps(values: Int64Array) -> Int64Array:
    return np.cumsum((values >> 1) ^ -(values & 1))
