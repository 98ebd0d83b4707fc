"""GLB, the binary form of glTF 2.0: a surface for viewers, browsers and game engines.

glTF is in metres with Y up: easting becomes X, elevation Y, and northing -Z. Positions are float32
relative to an origin, the middle of the TIN's bounds in whole numbers, to which the node moves them
in doubles, and which stands in its ``extras`` with the CRS, the vertical datum and the units.
Vertices have normals, and colours by elevation or a texture.
"""

from __future__ import annotations

import json
import os
import struct
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.atomic import replacing
from ....base.checks import as_number
from ....base.crs import assume_elevation_unit, require_projected
from ....base.errors import CrsError, WriteError, choice
from ....base.notes import warn
from ....base.policies import SceneFrame
from ....base.sentences import FILE, counted
from ....terrain.drawing import interpolate_tints
from ..common import format_crs, format_unit, require_tin
from ..globe import describe_heights, find_frame, has_heights, place_on_globe
from ..quantized_mesh import to_cartesian
from ..texture import load_texture

if TYPE_CHECKING:
    from pathlib import Path

    from ....base.arrays import (
        AnyArray,
        BoolArray,
        Float32Array,
        Float64Array,
        UInt16Array,
    )
    from ....base.progress import Tell
    from ....tin import TIN
    from ..texture import Texture

_MAGIC, _VERSION = 0x46546C67, 2
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_COMPONENTS = {"f4": 5126, "u4": 5125, "u2": 5123}
_SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_TRIANGLES = 4
_LINEAR, _LINEAR_MIPMAP_LINEAR, _CLAMP_TO_EDGE = 9729, 9987, 33071
_MOST_SHORT_VERTICES = 65_535
"""The number 65535 restarts primitives: with so many vertices, 0 to 65534, it is none of them."""

_LARGEST_FILE = 2**32 - 1
_GENERATOR = "tinsmith"


class MeshArrays(NamedTuple):
    """What the file holds, in its own axes."""

    positions: Float32Array
    normals: Float32Array | None
    triangles: AnyArray
    colors: UInt16Array | None
    texture: Texture | None = None


def write(
    surface: TIN,
    path: Path,
    *,
    ortho: str | os.PathLike[str] | None = None,
    exaggeration: float = 1.0,
    frame: SceneFrame = "map",
    progress: Tell | None = None,
) -> None:
    """Write a TIN as GLB; :func:`.reading.read` gives it back.

    Parameters
    ----------
    ortho : path-like, optional
        Picture to lay over it: a GeoTIFF in any CRS, or a PNG or JPEG file with a world file beside
        it. Default colours by elevation.
    exaggeration : float
        Factor on the elevations, which ``extras`` tells.
    frame : {"map", "local", "globe"}
        Where the node puts the surface: at its coordinates of the map; about 0, for programs that
        place in 32 bits, as Blender does; or on the globe (EPSG:4978), for Cesium.

    Raises
    ------
    CrsError
        If coordinates are longitude and latitude, unless the frame is the globe, which needs to
        know the CRS.
    OptionError
        If the exaggeration is not positive, or there is no such frame.
    ReadError
        If the picture cannot be read, or shows nothing of the surface.
    WriteError
        Also if no triangle has an area in float32, or the file would be larger than 4 GiB.

    Notes
    -----
    Float32 keeps positions to about a sixteen millionth of the extent. Where the CRS is not known
    its units are taken to be metres, and ``extras`` does not tell any. Lines are lost, and so are
    triangles without area in float32, of which a LossWarning tells.
    """
    tin = require_tin(surface, format_name="GLB")
    as_number("exaggeration", exaggeration, above=0)
    choice("frame", frame, SceneFrame)
    if frame != "globe":
        require_projected(
            tin.crs,
            f"Cannot write {FILE}: GLB is in metres, and {{crs}} in degrees; build the TIN in a "
            "projected CRS, or take `frame='globe'`.",
        )
    draped = None if ortho is None else load_texture(ortho, tin)
    scale = _choose_scale(tin)
    middle = (tin.points.min(axis=0) + tin.points.max(axis=0)) / 2
    origin = middle if frame == "globe" else np.rint(middle)
    extras = _describe(tin, origin, scale) | {"exaggeration": float(exaggeration), "frame": frame}
    scale = scale * (1.0, 1.0, exaggeration)
    node: dict[str, Any] = {"extras": extras}
    if frame == "globe":
        every, node["matrix"] = _place_on_globe(tin, origin, exaggeration)
    else:
        every = (tin.points - origin) * scale
    if frame == "map":
        node["translation"] = turn_up((origin * scale)[None])[0].tolist()
    mesh = _make_mesh(tin, every, draped)
    content = encode_glb(mesh, node)
    with replacing(path) as file:
        for chunk in content:
            file.write(chunk)
    if progress is not None:
        progress(1.0)


def encode_glb(mesh: MeshArrays, node: dict[str, Any]) -> list[bytes]:
    """Return the parts of a file, one after the other.

    Parameters
    ----------
    mesh : MeshArrays
    node : dict
        Properties of the node that has the mesh, such as its ``translation``.
    """
    chunks = _pack(mesh, node)
    length = 12 + sum(8 + len(chunk) for _, chunk in chunks)
    if length > _LARGEST_FILE:
        raise WriteError(f"Cannot write {FILE}: GLB ends at 4 GiB.")
    parts = [struct.pack("<III", _MAGIC, _VERSION, length)]
    for kind, chunk in chunks:
        parts += [struct.pack("<II", len(chunk), kind), chunk]
    return parts


def _choose_scale(tin: TIN) -> Float64Array:
    if tin.crs is None:
        along, up = 1.0, tin.elevation_unit and tin.elevation_unit.metres
        return np.array([along, along, up or 1.0])
    along = tin.crs.horizontal_unit.metres or 1.0
    unit = assume_elevation_unit(tin.crs, tin.elevation_unit)
    return np.array([along, along, along if unit is None else unit.metres or along])


def turn_up(vectors: Float64Array) -> Float64Array:
    """Turn easting, northing, elevation to the axes of glTF: X, Y up, Z towards the viewer."""
    return np.column_stack([vectors[:, 0], vectors[:, 2], -vectors[:, 1]]) + 0.0


def _place_on_globe(
    tin: TIN, origin: Float64Array, exaggeration: float
) -> tuple[Float64Array, list[float]]:
    """Return points in metres to the east, to the north and up, and the matrix of their node."""
    if tin.crs is None:
        raise CrsError(
            f"Cannot write {FILE}: the CRS of this TIN is not known, and the frame is the globe: "
            "declare it."
        )
    if not has_heights(tin.crs):
        warn(f"{FILE}: {describe_heights(tin.crs)}")
    raised = np.vstack([origin, tin.points]) * (1.0, 1.0, exaggeration)
    places = place_on_globe(raised, tin.crs, tin.elevation_unit)
    cartesian = to_cartesian(places)
    frame = find_frame(places[0], cartesian[0])
    turned = np.eye(4)
    turned[:3, :3] = turn_up(turn_up(frame[:3, :3].T).T)
    turned[:3, 3] = turn_up(cartesian[:1])[0]
    return (cartesian[1:] - cartesian[0]) @ frame[:3, :3], turned.T.ravel().tolist()


def _make_mesh(tin: TIN, every: Float64Array, texture: Texture | None) -> MeshArrays:
    positions = turn_up(every).astype(np.float32)
    triangles = tin.triangles
    if not np.isfinite(positions[triangles]).all():
        raise WriteError(f"Cannot write {FILE}: the TIN is too large for float32.")
    a, b, c = (positions[triangles[:, k]].astype(np.float64) for k in range(3))
    has_area: BoolArray = (np.cross(b - a, c - a) != 0.0).any(axis=1)
    count = int(np.count_nonzero(~has_area))
    flat = (
        f"{counted(count, 'triangle')} without area in float32, whose precision is a sixteen "
        "millionth of the extent"
    )
    if not has_area.any():
        raise WriteError(f"Cannot write {FILE}: it has nothing but {flat}.")
    if count:
        warn(f"{FILE} does not hold {flat}.")
    corners = tin.triangles[has_area]
    used = np.unique(corners)
    number = np.zeros(len(tin.points), np.int32)
    number[used] = np.arange(len(used), dtype=np.int32)
    places, triangles = every[used], number[corners]
    positions = turn_up(places).astype(np.float32)
    a, b, c = (places[triangles[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    sums = np.column_stack(
        [np.bincount(triangles.ravel(), np.repeat(axis, 3), len(places)) for axis in faces.T]
    )
    normals = turn_up(np.asarray(sums / np.linalg.norm(sums, axis=1, keepdims=True))).astype(
        np.float32
    )
    is_short = len(used) <= _MOST_SHORT_VERTICES
    heights = tin.points[used, 2]
    colors = choose_colors(heights, heights.min(), heights.max()) if texture is None else None
    if texture is not None:
        texture = type(texture)(texture.content, texture.kind, texture.places[used])
    return MeshArrays(
        positions, normals, triangles.astype(np.uint16 if is_short else np.uint32), colors, texture
    )


def choose_colors(elevations: Float64Array, low: float, high: float) -> UInt16Array:
    """Return hypsometric tints between two elevations, as glTF has colours, in linear light."""
    share = np.clip((elevations - low) / (high - low if high > low else 1.0), 0.0, 1.0)
    encoded = interpolate_tints(256)[np.rint(share * 255).astype(np.int64)] / 255.0
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    colors = np.full((len(elevations), 4), 65_535, np.uint16)
    colors[:, :3] = np.rint(linear * 65_535)
    return colors


def _describe(tin: TIN, origin: Float64Array, metres: Float64Array) -> dict[str, Any]:
    """Return what leads from the file back to the coordinates."""
    extras: dict[str, Any] = {
        "origin": origin.tolist(),
        "metres": metres.tolist(),
        "axes": "x = easting, y = elevation, z = -northing, in metres from the origin",
    }
    if tin.crs is not None:
        extras["crs"] = format_crs(tin.crs)
        parts = tin.crs.to_pyproj().sub_crs_list  # none but of compound ones
        if parts:
            extras["verticalDatum"] = parts[-1].name
    if unit := format_unit(tin):
        extras["elevationUnit"] = unit
    return extras


class _Buffer:
    """The binary chunk, with the views and accessors into it."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add_bytes(self, content: bytes, **more: Any) -> int:
        """Append aligned bytes; return the number of their view."""
        self.content += bytes(-len(self.content) % 4)
        view = {"buffer": 0, "byteOffset": len(self.content), "byteLength": len(content), **more}
        self.views.append(view)
        self.content += content
        return len(self.views) - 1

    def add_array(
        self, array: AnyArray, *, target: int, has_bounds: bool = False, **more: Any
    ) -> int:
        """Append an array of one row for each element; return the number of its accessor."""
        rows = array if array.ndim == 2 else array[:, None]
        content = np.ascontiguousarray(rows, rows.dtype.newbyteorder("<")).tobytes()
        accessor: dict[str, Any] = {
            "bufferView": self.add_bytes(content, target=target),
            "componentType": _COMPONENTS[rows.dtype.str[1:]],
            "count": len(rows),
            "type": _SHAPES[rows.shape[1]],
            **more,
        }
        if has_bounds:
            accessor |= {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _pack(mesh: MeshArrays, node: dict[str, Any]) -> list[tuple[int, bytes]]:
    buffer = _Buffer()
    attributes = {
        "POSITION": buffer.add_array(mesh.positions, target=_ARRAY_BUFFER, has_bounds=True),
    }
    if mesh.normals is not None:
        attributes["NORMAL"] = buffer.add_array(mesh.normals, target=_ARRAY_BUFFER)
    surface: dict[str, Any] = {"metallicFactor": 0.0, "roughnessFactor": 1.0}
    document: dict[str, Any] = {"asset": {"version": "2.0", "generator": _GENERATOR}}
    if mesh.colors is not None:
        attributes["COLOR_0"] = buffer.add_array(mesh.colors, target=_ARRAY_BUFFER, normalized=True)
    if mesh.texture is not None:
        places = mesh.texture.places.astype(np.float32)
        attributes["TEXCOORD_0"] = buffer.add_array(places, target=_ARRAY_BUFFER)
        surface["baseColorTexture"] = {"index": 0}
        texture = mesh.texture
        view = buffer.add_bytes(texture.content)
        sampler = {
            "magFilter": _LINEAR,
            "minFilter": _LINEAR_MIPMAP_LINEAR,
            "wrapS": _CLAMP_TO_EDGE,
            "wrapT": _CLAMP_TO_EDGE,
        }
        document |= {
            "images": [{"bufferView": view, "mimeType": f"image/{texture.kind}"}],
            "samplers": [sampler],
            "textures": [{"sampler": 0, "source": 0}],
        }
    indices = buffer.add_array(mesh.triangles.ravel(), target=_ELEMENT_ARRAY_BUFFER)
    primitive = {"attributes": attributes, "indices": indices, "material": 0, "mode": _TRIANGLES}
    buffer.content += bytes(-len(buffer.content) % 4)
    document |= {
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "terrain", "mesh": 0, **node}],
        "meshes": [{"name": "terrain", "primitives": [primitive]}],
        "materials": [{"name": "terrain", "pbrMetallicRoughness": surface, "doubleSided": True}],
        "buffers": [{"byteLength": len(buffer.content)}],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return [(_JSON_CHUNK, text), (_BINARY_CHUNK, bytes(buffer.content))]
