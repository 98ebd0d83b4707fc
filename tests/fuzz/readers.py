"""Damaged files: every reader gives something sound or one clear sentence, and always in time."""

from __future__ import annotations

import re
import tempfile
import warnings
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.io import read_lines
from tinsmith.io.isolated import limits

from .campaign import Campaign
from .mesh_samples import MESH_MAKERS, TILE
from .samples import MEMORY, sample_files
from .vector_samples import VECTOR_MAKERS, WITH_PARTS

KINDS = (
    *("ply", "obj", "stl", "vtk", "gmsh", "raster", "vectors", "delimited", "tin", "instruments"),
    *("las", "landxml", "dxf", "12da"),
    *MESH_MAKERS,
    *VECTOR_MAKERS,
)

_NUMBER = re.compile(rb"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_NUMBERS = (
    *("0", "1", "2", "-1", "-0", "1e400", "-1e308", "1.7e308", "nan", "inf", "1e-320", "0.1"),
    *("2147483647", "2147483648", "4294967296", "9223372036854775807", "18446744073709551616"),
    *("99999999", "1" * 400, "7" * 5000, "1_0", "0x10", "1,5", "3.0", "+4", ""),
)
_WORDS = (
    *(" ", "\n", "\r", "\r\n", "\t", "\x00", "\xff", "#", '"', "'", "<", ">", "&", "{", "}", ","),
    *("\xef\xbb\xbf", "<!--", "-->", "nan", "/", "-", "comment " + "x" * 3000 + "\n", "\\\n", "/>"),
    *("property list uchar int vertex_index\n", "element vertex 3\n", "f 1 2 3\n", "v 1 2 3\n"),
    *(' i="1"', ' b="7"', "<F>1 2 3</F>", '<P id="1">1 2 3</P>', "</Faces>", "<Surfaces>", "&#0;"),
    *("<xi:include href='a'/>", "POLYLINE\n", "INSERT\n  2\nA\n", "VERTEX\n", "SEQEND\n  0\n"),
    *("<!DOCTYPE a>", "/vsicurl/http://127.0.0.1:9/a", "EOF\n", "  0\nSECTION\n"),
)
_LIES = (0, 1, 2, 2**15, 2**16 - 1, 10**6, 2**31 - 1, 2**31, 2**32 - 1, 2**62, 2**63, 2**64 - 1)
"""Numbers and sizes that a header has not to have."""

_SHAPES = frozenset({"hull", "boundary", "euler"})
"""What a check tells of sound surfaces too, if their boundary is not marked: concave, in pieces."""

_TOLD = {"overlap": "overlap", "unused": "to no triangle", "constrained": "on one side only"}
"""What may come back from a file only with these words in the notes of the report."""

_LETTERS = "latin-1"


# ------------------------------------------------------------------ how files are damaged


def generate(rng: np.random.Generator, *, kind: str) -> dict[str, Any]:
    """Choose a sound file and one to four damages."""
    files = sample_files(kind)
    name, content = files[int(rng.integers(len(files)))]
    count = int(rng.choice([1, 1, 1, 2, 3, 4]))
    return {"kind": kind, "name": name, "damages": [_damage(rng, content) for _ in range(count)]}


def _damage(rng: np.random.Generator, content: bytes) -> list[Any]:
    at = int(rng.integers(len(content)))
    if rng.random() < 0.4:
        at = int(rng.integers(min(len(content), 600)))  # headers are where counts are
    length = int(2 ** rng.uniform(0, 8))
    return [
        ["flip", at, int(rng.integers(8))],
        ["set", at, int(rng.choice([0, 1, 127, 128, 255, int(rng.integers(256))]))],
        ["zero", at, int(rng.choice([1, 2, 4, 8, length]))],
        ["cut", at, length],
        ["repeat", at, length],
        ["insert", at, str(rng.choice(_WORDS))],
        ["number", int(rng.integers(12 if rng.random() < 0.5 else 200)), str(rng.choice(_NUMBERS))],
        ["truncate", at],
        ["join"],
        ["lie", at, int(rng.choice([2, 4, 8])), bool(rng.random() < 0.2), int(rng.choice(12))],
    ][int(rng.choice(10, p=[0.18, 0.1, 0.07, 0.09, 0.07, 0.11, 0.18, 0.07, 0.03, 0.1]))]


def damaged(content: bytes, damages: list[list[Any]]) -> bytes:
    """Apply damages one after the other."""
    for what, *how in damages:
        content = _DAMAGES[what](content, *how) if content else content
    return content


def _flip(content: bytes, at: int, bit: int) -> bytes:
    at %= len(content)
    return content[:at] + bytes([content[at] ^ 1 << bit]) + content[at + 1 :]


def _set(content: bytes, at: int, value: int) -> bytes:
    at %= len(content)
    return content[:at] + bytes([value]) + content[at + 1 :]


def _zero(content: bytes, at: int, length: int) -> bytes:
    at %= len(content)
    return content[:at] + bytes(len(content[at : at + length])) + content[at + length :]


def _cut(content: bytes, at: int, length: int) -> bytes:
    at %= len(content)
    return content[:at] + content[at + length :]


def _repeat(content: bytes, at: int, length: int) -> bytes:
    at %= len(content)
    return content[: at + length] + content[at:]


def _insert(content: bytes, at: int, text: str) -> bytes:
    at %= len(content)
    return content[:at] + text.encode(_LETTERS) + content[at:]


def _number(content: bytes, which: int, text: str) -> bytes:
    found = list(_NUMBER.finditer(content))
    if not found:
        return content
    start, end = found[which % len(found)].span()
    return content[:start] + text.encode(_LETTERS) + content[end:]


def _lie(content: bytes, at: int, size: int, is_big: bool, which: int) -> bytes:
    """Put another whole number where one may stand in a header, on a multiple of two bytes."""
    at = at % len(content) // 2 * 2
    number = _LIES[which] % 2 ** (8 * size)
    told = number.to_bytes(size, "big" if is_big else "little")
    return (content[:at] + told + content[at + size :])[: len(content)]


def _truncate(content: bytes, at: int) -> bytes:
    return content[: at % len(content)]


def _join(content: bytes) -> bytes:
    return content + content


_DAMAGES = {
    "flip": _flip,
    "set": _set,
    "zero": _zero,
    "cut": _cut,
    "repeat": _repeat,
    "insert": _insert,
    "number": _number,
    "truncate": _truncate,
    "join": _join,
    "lie": _lie,
}


# ------------------------------------------------------------------ what must hold


def examine(case: dict[str, Any]) -> str:
    """Read the damaged file: something sound, or a sentence."""
    _hurry()
    content = damaged(dict(sample_files(case["kind"]))[case["name"]], case["damages"])
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        path = put_file(Path(folder), case["kind"], case["name"], content)
        try:
            found = _read(path, case["kind"], _choose_options(case["kind"], case["name"]))
        except ts.TinsmithError as error:
            require_sentence(str(error), path)
            return f"refused: {'crashed' if 'crashed' in str(error) else type(error).__name__}"
    require_sound(found)
    return "read"


def put_file(folder: Path, kind: str, name: str, content: bytes) -> Path:
    """Write a file, and those that lie in its folder; return what to read."""
    path = folder / name
    path.parent.mkdir(exist_ok=True)
    if kind == "esritin" or kind in WITH_PARTS:
        for other, sound in sample_files(kind):
            if other.startswith(f"{path.parent.name}/"):
                (folder / other).write_bytes(sound)
    path.write_bytes(content)
    if kind in WITH_PARTS:
        return path.with_suffix(".shp")
    return path.parent if kind == "esritin" else path


def _read(path: Path, kind: str, options: dict[str, Any]) -> Any:
    if kind == "vectors":
        return read_lines(path)
    if kind == "landxml" and "source" in path.name:
        return ts.read(path, content="source")
    return ts.read(path, **options)


def _choose_options(kind: str, name: str) -> dict[str, Any]:
    """Return the options without which even a sound file is refused."""
    if kind == "terrain":
        return {"tile": TILE}
    options = {}
    if "degrees" in name or name.endswith((".geojsonl", ".geojsons", ".kml")):
        options["crs"] = "EPSG:32616"
    if kind in VECTOR_MAKERS and "lines" in name:
        options |= {"lines_as": "breaklines", "z_field": "geometry"}
    return options


def _hurry() -> None:
    """Give up early: a campaign has thousands of files."""
    limits.LEAST_SECONDS = 2.0


def require_sentence(message: str, path: Path) -> None:
    """A message is one printable line that ends with a full stop, with no trace of Python."""
    assert message.endswith("."), message
    assert len(message) < 1500, message
    assert message.replace(str(path), "").isprintable(), message
    for word in ("np.", "Traceback", "object at 0x", "numpy", "1 points", "1 triangles", "1 rows"):
        assert not re.search(rf"(?<!\d){re.escape(word)}", message), message
    assert path.name in message or message.startswith("Unknown option"), message


def require_sound(found: Any) -> None:
    """A TIN is sound, or its report tells why not; points and lines are finite."""
    if isinstance(found, ts.TIN):
        _require_told(found)
    elif isinstance(found, ts.Survey):
        assert np.isfinite(found.points).all()
        assert len(found) > 0 or found.has_lines
    else:
        assert found
        assert all(np.isfinite(line.coords).all() for line in found)


def _require_told(tin: ts.TIN) -> None:
    problems = ts.check(tin, level=2).problems
    said = " ".join(problem.sentence for problem in problems)
    kinds = {problem.kind for problem in problems} - _SHAPES
    kinds |= {"overlap"} if "winds about itself" in said else set()
    assert kinds <= _TOLD.keys(), problems
    told = " ".join(note for note in tin.report.notes if "Left out" not in note)
    for kind, words in _TOLD.items():
        assert (words in told) == (kind in kinds), (told, problems)


CAMPAIGNS = tuple(
    Campaign(
        f"readers-{kind}",
        f"damaged {kind} files are read soundly or refused in a sentence",
        partial(generate, kind=kind),
        examine,
    )
    for kind in KINDS
)
