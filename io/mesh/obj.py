"""Wavefront OBJ: vertices and faces as text, every digit kept, elevation up as it is.

Comments keep the CRS, ``# crs: EPSG:32616``, and the unit of elevations where it is known,
``# elevation unit: US survey foot``. Which edges are constrained is lost. With a texture there are
two files more, ``site.mtl`` with the material and ``site_texture.jpg`` or ``.png``, the picture.
"""

from __future__ import annotations

import re
import warnings
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from ...base.atomic import replacing
from ...base.errors import ReadError, WriteError
from ..registry.side_files import replacing_data_set
from . import common
from .text_writing import BATCH, write_batches, write_reference
from .texture import choose_picture, load_texture

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence
    from pathlib import Path
    from typing import IO

    from ...base.arrays import AnyArray, Float64Array, Int64Array
    from ...base.crs import CrsLike, UnitLike
    from ...base.policies import FacePolicy
    from ...base.progress import Tell
    from ...tin import TIN, Survey
    from .texture import Texture

__all__ = ["read", "write"]

_MATERIAL = "terrain"
_PICTURE = "_texture"
_SHOWN_LETTERS = 60
_MOST_DIGITS = 18
_CLAMPED = 2**63 - 1
"""What NumPy makes of a larger number."""

_VERTEX_NUMBER = re.compile(r"([-+]?)([0-9]+)(?:/|$)")


def read(
    path: Path,
    *,
    crs: CrsLike | None = None,
    z_unit: UnitLike | None = None,
    faces: FacePolicy = "most",
) -> TIN | Survey:
    """Read the vertices and faces of an OBJ file.

    CRS and unit default to those in the comments ``# crs: ...`` and ``# elevation unit: ...``.
    Polygons are cut into triangles; texture, normals, colours, groups and materials are skipped. A
    file without faces gives a survey.
    """
    lines = _split_lines(common.read_content(path))
    vertex_lines = [i for i, line in enumerate(lines) if line[:2] in ("v ", "v\t")]
    face_lines = [i for i, line in enumerate(lines) if line[:2] in ("f ", "f\t")]
    points = _parse_points(lines, vertex_lines, path)
    reference = common.choose_reference(
        crs,
        z_unit,
        path,
        found_crs=_find_comment(lines, "crs"),
        found_unit=_find_comment(lines, "elevation unit"),
    )
    if not face_lines:
        return common.make_survey(points, path, reference=reference)
    corners, offsets = _parse_faces(lines, vertex_lines, face_lines, path)
    made = common.cut_into_fans(corners, offsets, points, path)
    return common.make_tin(
        points, made.triangles, path, reference=reference, notes=made.notes, faces=faces
    )


def _split_lines(content: bytes) -> list[str]:
    """Cut into stripped lines; one that a backslash continues is followed by empty ones."""
    text = content.decode("utf-8", errors="replace")
    lines = [line.strip() for line in text.split("\n")]
    if "\\" in text:
        for i in range(len(lines) - 2, -1, -1):
            if lines[i].endswith("\\") and not lines[i].startswith("#"):
                lines[i] = f"{lines[i][:-1]} {lines[i + 1]}"
                lines[i + 1] = ""
    return lines


def _find_comment(lines: Sequence[str], name: str) -> str | None:
    """Return what is named so among the comments at the top."""
    for line in lines:
        if line.strip() and not line.startswith("#"):
            return None
        if line.startswith(f"# {name}: "):
            return line.removeprefix(f"# {name}: ").strip() or None
    return None


def _parse_points(lines: Sequence[str], vertex_lines: Sequence[int], path: Path) -> Float64Array:
    plain = _parse_plain_rows([lines[i] for i in vertex_lines], np.float64)
    if plain is not None:
        return plain
    rows = [lines[i].split()[1:4] for i in vertex_lines]
    for i, row in zip(vertex_lines, rows, strict=True):
        if len(row) < 3:
            raise _describe_line_fault(lines, i, "a vertex needs x, y and z", path)
    try:
        return np.array(rows, np.float64).reshape(-1, 3)
    except ValueError:
        for i, row in zip(vertex_lines, rows, strict=True):
            _require_numbers(row, lines, i, path)
        raise


def _parse_plain_rows(rows: Sequence[str], dtype: type[np.generic]) -> AnyArray | None:
    """Return the numbers of rows like ``v 1 2 3`` at once; None where a row is anything else."""
    if any(row.count(" ") != 3 for row in rows):
        return None
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            numbers = np.fromstring(" ".join([row[2:] for row in rows]), dtype, sep=" ")
        except (DeprecationWarning, ValueError):
            return None
    return numbers.reshape(-1, 3) if numbers.size == 3 * len(rows) else None


def _require_numbers(words: Sequence[str], lines: Sequence[str], i: int, path: Path) -> None:
    try:
        np.array(words, np.float64)
    except ValueError:
        raise _describe_line_fault(lines, i, "a coordinate is no number", path) from None


def _parse_faces(
    lines: Sequence[str], vertex_lines: Sequence[int], face_lines: Sequence[int], path: Path
) -> tuple[Int64Array, Int64Array]:
    """Return the vertex numbers, from 0 on, of all faces, and the offsets of each."""
    plain = _parse_plain_rows([lines[i] for i in face_lines], np.int64)
    if plain is not None and plain.min() > 0 and plain.max() < _CLAMPED:
        return plain.ravel() - 1, np.arange(0, plain.size + 1, 3)
    corners: list[int] = []
    offsets = [0]
    before = np.searchsorted(vertex_lines, face_lines).tolist()
    for i, n_before in zip(face_lines, before, strict=True):
        for word in lines[i].split()[1:]:
            corners.append(_parse_vertex_number(word, n_before, lines, i, path))
        offsets.append(len(corners))
    return np.array(corners, np.int64), np.array(offsets, np.int64)


def _parse_vertex_number(word: str, n_before: int, lines: Sequence[str], i: int, path: Path) -> int:
    """Turn ``7``, ``7/1``, ``7//2`` or ``-1`` (the vertex just before) into a number from 0 on."""
    shown = word if len(word) <= _SHOWN_LETTERS else f"{word[:_SHOWN_LETTERS]}..."
    found = _VERTEX_NUMBER.match(word)
    if found is None:
        raise _describe_line_fault(lines, i, f"'{shown}' names no vertex", path)
    digits = found[2].lstrip("0")
    if len(digits) > _MOST_DIGITS:
        raise _describe_line_fault(lines, i, f"'{shown}' names no vertex: the file has fewer", path)
    number = int(digits or "0")
    if number == 0 or (found[1] == "-" and number > n_before):
        raise _describe_line_fault(lines, i, f"'{shown}' names no vertex: they count from 1", path)
    return n_before - number if found[1] == "-" else number - 1


def _describe_line_fault(lines: Sequence[str], i: int, what: str, path: Path) -> ReadError:
    shown = lines[i].strip()[:_SHOWN_LETTERS]
    return ReadError(f"'{path}', line {i + 1}: {what} ('{shown}').", path=path, lines=[i + 1])


def write(
    surface: TIN,
    path: Path,
    *,
    drape: str | os.PathLike[str] | None = None,
    texture: str | os.PathLike[str] | None = None,
    progress: Tell | None = None,
) -> None:
    """Write a TIN as OBJ; :func:`read` gives the same vertices and triangles back.

    Parameters
    ----------
    drape, texture : path-like, optional
        Picture to lay over it, as :func:`.gltf.writing.write` takes it. The material (``.mtl``) and
        the picture are written beside the file, under its name.

    Raises
    ------
    ReadError
        If the picture cannot be read, or shows nothing of the surface.
    OptionError
        If two pictures are named.
    WriteError
        Also if the texture itself would be overwritten.
    """
    tin = common.require_tin(surface, path, format_name="OBJ")
    source = choose_picture(drape, texture)
    if source is None:
        with replacing(path, binary=False) as file:
            _write_body(file, tin, None, progress)
        return
    draped = load_texture(source, tin)
    picture = path.with_name(f"{path.stem}{_PICTURE}{draped.suffix}")
    _require_other_file(source, (picture, path, path.with_suffix(".mtl")))
    with replacing_data_set(path, "obj") as beside:
        beside.with_name(picture.name).write_bytes(draped.content)
        material = f"newmtl {_MATERIAL}\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nmap_Kd {picture.name}\n"
        beside.with_suffix(".mtl").write_text(material, encoding="utf-8")
        with beside.open("w", encoding="utf-8", newline="") as file:
            _write_body(file, tin, draped, progress)


def _require_other_file(texture: str | os.PathLike[str], targets: Sequence[Path]) -> None:
    """Refuse to write over the picture that is read."""
    for target in targets:
        if target.exists() and target.samefile(texture):
            raise WriteError(
                f"Cannot write '{target}': it is the texture itself; name the output otherwise.",
                path=target,
            )


def _write_body(file: IO[str], tin: TIN, texture: Texture | None, progress: Tell | None) -> None:
    write_reference(file, tin)
    if texture is not None:
        name = PurePath(file.name).with_suffix(".mtl").name
        file.write(f"mtllib {name}\nusemtl {_MATERIAL}\n")
        for start in range(0, len(texture.places), BATCH):
            u, v = texture.places[start : start + BATCH].T
            rows = np.column_stack([u, 1.0 - v]).ravel().tolist()  # v grows upwards here
            file.write(("vt %.9g %.9g\n" * len(u)) % tuple(rows))
    batches = _iterate_batches(tin, is_textured=texture is not None)
    write_batches(file, tin, batches, progress)


def _iterate_batches(tin: TIN, *, is_textured: bool) -> Iterator[tuple[int, str]]:
    for start in range(0, len(tin.points), BATCH):
        rows = tin.points[start : start + BATCH]
        yield len(rows), ("v %r %r %r\n" * len(rows)) % tuple(rows.ravel().tolist())
    face = "f %d/%d %d/%d %d/%d\n" if is_textured else "f %d %d %d\n"
    for start in range(0, len(tin.triangles), BATCH):
        corners = tin.triangles[start : start + BATCH].astype(np.int64).ravel() + 1
        numbers = np.repeat(corners, 2 if is_textured else 1).tolist()
        yield len(corners) // 3, (face * (len(corners) // 3)) % tuple(numbers)
