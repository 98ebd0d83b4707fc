"""Readers of printed plans that share nothing with what draws them: PDF operators, SVG elements."""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

MM = 25.4 / 72.0
_SVG = "{http://www.w3.org/2000/svg}"


@dataclass
class Text:
    text: str
    place: Any
    rotation: float
    size: float
    name: str = ""
    anchor: str = "start"


@dataclass
class Page:
    """A sheet in millimetres from its lower left corner."""

    width: float
    height: float
    paths: dict[str, list[Any]] = field(default_factory=dict)  # by name, or by colour in a PDF
    texts: list[Text] = field(default_factory=list)

    def named(self, name: str) -> list[Text]:
        return [text for text in self.texts if text.name == name]

    @property
    def frame(self) -> tuple[float, float, float, float]:
        (ring,) = self.paths["frame"]
        return (*ring.min(axis=0), *ring.max(axis=0))


# ---------------------------------------------------------------- SVG


def read_svg(path: Path) -> Page:
    root = ET.fromstring(path.read_bytes())
    width, height = (float(root.attrib[side].removesuffix("pt")) for side in ("width", "height"))
    page = Page(width * MM, height * MM)
    names = [one.attrib["id"] for one in root.iter() if "id" in one.attrib]
    assert len(names) == len(set(names)), "an SVG has each id once"
    for group in root.iter(f"{_SVG}g"):
        name = re.sub(r"-\d+$", "", group.attrib.get("id", ""))
        for one in group.findall(f"{_SVG}path"):
            page.paths.setdefault(name, []).append(_read_path(one.attrib["d"], height))
        for one in group.findall(f"{_SVG}text"):
            page.texts.append(_read_text(one, name, height))
    return page


def _read_path(text: str, height: float) -> Any:
    numbers = np.array(re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text), float).reshape(-1, 2)
    return np.column_stack([numbers[:, 0], height - numbers[:, 1]]) * MM


def _read_text(one: Any, name: str, height: float) -> Text:
    found = re.search(r"rotate\((\S+) (\S+) (\S+)\)", one.attrib.get("transform", ""))
    rotation = -float(found[1]) if found else 0.0
    x, y = float(one.attrib["x"]), float(one.attrib["y"])
    size = float(re.search(r"font-size: ([\d.]+)px", one.attrib["style"])[1])
    anchor = re.search(r"text-anchor: (\w+)", one.attrib["style"])
    place = np.array([x, height - y]) * MM
    text = "".join(one.itertext())
    return Text(text, place, rotation, size * MM, name, anchor[1] if anchor else "start")


# ---------------------------------------------------------------- PDF


def read_pdf(path: Path) -> list[Page]:
    """Return the pages: their paths by stroke colour, and their texts."""
    data = path.read_bytes()
    boxes = re.findall(
        rb"/MediaBox\s+\[\s*0\s+0\s+(\S+)\s+(\S+)\s*\]\s+/Contents\s+(\d+) 0 R", data
    )
    pages = []
    for width, height, number in boxes:
        start = re.search(rb"(?<!\d)" + number + rb" 0 obj.*?stream\r?\n", data, re.DOTALL)
        content = zlib.decompressobj().decompress(data[start.end() :])
        page = Page(float(width) * MM, float(height) * MM)
        _Reader(page).read(content)
        pages.append(page)
    return pages


_TOKEN = re.compile(rb"\((?:\\.|[^\\()])*\)|\[|\]|/\S+|[^\s\[\]()]+", re.DOTALL)
_ESCAPES = {b"n": b"\n", b"r": b"\r", b"t": b"\t", b"b": b"\b", b"f": b"\f"}


class _Reader:
    """Follows the operators that move, draw and write."""

    def __init__(self, page: Page) -> None:
        self.page = page
        self.matrices = [np.eye(3)]
        self.colors = [b""]
        self.points: list[tuple[float, float]] = []
        self.paths: list[Any] = []
        self.size = 0.0

    def read(self, content: bytes) -> None:
        stack: list[bytes] = []
        for token in _TOKEN.findall(content):
            if re.fullmatch(rb"[A-Za-z*]+", token):
                self.obey(token, stack)
                stack = []
            else:
                stack.append(token)

    def obey(self, operator: bytes, stack: list[bytes]) -> None:
        if operator == b"q":
            self.matrices.append(self.matrices[-1])
            self.colors.append(self.colors[-1])
        elif operator == b"Q":
            self.matrices.pop()
            self.colors.pop()
        elif operator == b"cm":
            a, b, c, d, e, f = map(float, stack)
            self.matrices[-1] = np.array([(a, b, 0), (c, d, 0), (e, f, 1)]) @ self.matrices[-1]
        elif operator in (b"G", b"RG"):
            self.colors[-1] = b" ".join(stack)
        elif operator == b"m":
            self.close()
            self.points = [self.at(stack)]
        elif operator == b"l":
            self.points.append(self.at(stack))
        elif operator == b"S":
            self.close()
            name = self.colors[-1].decode()
            self.page.paths.setdefault(name, []).extend(self.paths)
            self.paths = []
        elif operator in (b"f", b"n", b"B"):
            self.points, self.paths = [], []
        else:
            self.write(operator, stack)

    def at(self, stack: list[bytes]) -> tuple[float, float]:
        x, y, _ = np.array([*map(float, stack), 1.0]) @ self.matrices[-1]
        return x * MM, y * MM

    def close(self) -> None:
        if self.points:
            self.paths.append(np.array(self.points))
        self.points = []

    def write(self, operator: bytes, stack: list[bytes]) -> None:
        if operator == b"Tf":
            self.size = float(stack[1]) * MM
        elif operator in (b"TJ", b"Tj"):
            raw = b"".join(_unescape(one[1:-1]) for one in stack if one.startswith(b"("))
            (a, b, _), _, (x, y, _) = self.matrices[-1]
            rotation = float(np.degrees(np.arctan2(b, a)))
            text = raw.decode("utf-16-be")
            self.page.texts.append(Text(text, np.array([x, y]) * MM, rotation, self.size))


def _unescape(raw: bytes) -> bytes:
    return re.sub(
        rb"\\([0-7]{3}|.)",
        lambda m: bytes([int(m[1], 8)]) if len(m[1]) == 3 else _ESCAPES.get(m[1], m[1]),
        raw,
        flags=re.DOTALL,
    )


# ---------------------------------------------------------------- georeference


@dataclass
class Georeference:
    """Ground from paper, as the labels at the frame of a page say."""

    easting: Any  # of (1, x, y) in millimetres
    northing: Any

    def to_ground(self, places: Any) -> Any:
        xy = np.atleast_2d(places)
        terms = np.column_stack([np.ones(len(xy)), xy])
        return np.column_stack([terms @ self.easting, terms @ self.northing])

    @property
    def units_per_mm(self) -> tuple[float, float]:
        return float(np.hypot(*self.easting[1:])), float(np.hypot(*self.northing[1:]))


def georeference(page: Page) -> Georeference | None:
    """Measure where the labelled ticks of an SVG are; None if there are too few to say."""
    known: dict[str, list[tuple[float, float, float]]] = {"E": [], "N": []}
    ticks, labels = page.paths.get("grid-ticks", []), page.named("grid-label")
    assert len(ticks) == len(labels)
    for tick, label in zip(ticks, labels, strict=True):
        value, letter = label.text.split()
        known[letter].append((float(value), *tick[0]))
    fitted = [_fit(known["E"]), _fit(known["N"])]
    return None if any(one is None for one in fitted) else Georeference(*fitted)


def _fit(rows: list[tuple[float, float, float]]) -> Any:
    array = np.array(rows).reshape(-1, 3)
    terms = np.column_stack([np.ones(len(array)), array[:, 1:]])
    if len(array) < 3 or np.linalg.matrix_rank(terms - [0, *terms[:1, 1:].ravel()], tol=1.0) < 3:
        return None
    shift = array[0, 0]
    found, *_ = np.linalg.lstsq(terms, array[:, 0] - shift, rcond=None)
    assert np.abs(terms @ found - (array[:, 0] - shift)).max() < 1e-3 * np.hypot(*found[1:])
    return found + np.array([shift, 0.0, 0.0])
