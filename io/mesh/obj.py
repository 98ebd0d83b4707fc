"""Wavefront OBJ: vertices and faces as text, every digit kept, elevation up as it is.

Comments keep the CRS, ``# crs: EPSG:32616``, and the unit of elevations where it is known,
``# elevation unit: US survey foot``. Which edges are constrained is lost. With a texture there are
two files more, ``site.mtl`` with the material and ``site_texture.jpg`` or ``.png``, the picture.
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import chain
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from ...base.atomic import replacing
from ...base.errors import WriteError
from ..registry import replacing_data_set
from . import common
from .common import Mesh, mesh_reader
from .text_rows import (
    TextRows,
    find_reference,
    format_rows,
    split_rows,
    write_batches,
    write_reference,
)
from .texture import load_texture

if TYPE_CHECKING:
    import os
    from pathlib import Path
    from typing import IO

    from ...base.arrays import Int64Array
    from ...base.progress import Tell
    from ...tin import TIN
    from .texture import Texture

_MATERIAL = "terrain"
_PICTURE = "_texture"
_SHOWN_LETTERS = 60
_MOST_DIGITS = 18
_VERTEX_NUMBER = re.compile(r"([-+]?)([0-9]+)(?:/|$)")


@mesh_reader
def read(path: Path) -> Mesh:
    """Read the vertices and faces of an OBJ file.

    CRS and unit default to those in the comments ``# crs: ...`` and ``# elevation unit: ...``.
    Polygons are cut into triangles; texture, normals, colours, groups and materials are skipped. A
    file without faces gives a survey.
    """
    content = common.read_content(path)
    rows = split_rows(content)
    vertices, faces = rows.select("v"), rows.select("f")
    points = vertices.parse_floats(slice(1, 4), "a vertex needs x, y and z")
    crs, unit = find_reference(content)
    mesh = Mesh(points, crs=crs, elevation_unit=unit)
    if not len(faces):
        return mesh
    corners, offsets = _parse_faces(vertices, faces)
    return replace(mesh, corners=corners, offsets=offsets)


def _parse_faces(vertices: TextRows, faces: TextRows) -> tuple[Int64Array, Int64Array]:
    """Return the vertex numbers, from 0 on, of all faces, and the offsets of each."""
    is_plain = all(text.count(" ") == 3 for text in faces.texts)
    plain = faces.parse_plain(slice(1, 4), np.int64) if is_plain else None
    if plain is not None and plain.min() > 0:
        return plain.ravel() - 1, np.arange(0, plain.size + 1, 3)
    corners: list[int] = []
    offsets = [0]
    before = np.searchsorted(vertices.lines, faces.lines).tolist()
    for row, (text, n_before) in enumerate(zip(faces.texts, before, strict=True)):
        for word in text.split()[1:]:
            # Turn ``7``, ``7/1``, ``7//2`` or ``-1`` (the vertex just before) into a number
            # from 0 on.
            shown = word if len(word) <= _SHOWN_LETTERS else f"{word[:_SHOWN_LETTERS]}..."
            found = _VERTEX_NUMBER.match(word)
            if found is None:
                raise faces.describe_fault(row, f"'{shown}' names no vertex")
            digits = found[2].lstrip("0")
            if len(digits) > _MOST_DIGITS:
                raise faces.describe_fault(row, f"'{shown}' names no vertex: the file has fewer")
            number = int(digits or "0")
            if number == 0 or (found[1] == "-" and number > n_before):
                raise faces.describe_fault(row, f"'{shown}' names no vertex: they count from 1")
            corners.append(n_before - number if found[1] == "-" else number - 1)
        offsets.append(len(corners))
    return np.array(corners, np.int64), np.array(offsets, np.int64)


def write(
    surface: TIN,
    path: Path,
    *,
    ortho: str | os.PathLike[str] | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a TIN as OBJ; :func:`read` gives the same vertices and triangles back.

    Parameters
    ----------
    ortho : path-like, optional
        Picture to lay over it, as :func:`.gltf.writing.write` takes it. The material (``.mtl``) and
        the picture are written beside the file, under its name.

    Raises
    ------
    ReadError
        If the picture cannot be read, or shows nothing of the surface.
    WriteError
        Also if the texture itself would be overwritten.
    """
    tin = common.require_tin(surface, format_name="OBJ")
    if ortho is None:
        with replacing(path, binary=False) as file:
            _write_body(file, tin, None, progress)
        return
    draped = load_texture(ortho, tin)
    picture = path.with_name(f"{path.stem}{_PICTURE}{draped.suffix}")
    for target in (picture, path, path.with_suffix(".mtl")):
        if target.exists() and target.samefile(ortho):
            raise WriteError(
                f"Cannot write '{target}': it is the texture itself; name the output otherwise.",
                path=target,
            )
    with replacing_data_set(path, "obj") as beside:
        beside.with_name(picture.name).write_bytes(draped.content)
        material = f"newmtl {_MATERIAL}\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nmap_Kd {picture.name}\n"
        beside.with_suffix(".mtl").write_text(material, encoding="utf-8")
        with beside.open("w", encoding="utf-8", newline="") as file:
            _write_body(file, tin, draped, progress)


def _write_body(file: IO[str], tin: TIN, texture: Texture | None, progress: Tell | None) -> None:
    write_reference(file, tin)
    if texture is not None:
        name = PurePath(file.name).with_suffix(".mtl").name
        file.write(f"mtllib {name}\nusemtl {_MATERIAL}\n")
        places = texture.places * (1.0, -1.0) + (0.0, 1.0)  # v grows upwards here
        file.writelines(text for _, text in format_rows("vt %.9g %.9g\n", places))
    corners = tin.triangles.astype(np.int64) + 1
    faces = (
        format_rows("f %d %d %d\n", corners)
        if texture is None
        else format_rows("f %d/%d %d/%d %d/%d\n", np.repeat(corners, 2, axis=1))
    )
    write_batches(file, tin, chain(format_rows("v %r %r %r\n", tin.points), faces), progress)
