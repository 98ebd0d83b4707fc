"""Geometry of pictures, without drawing: frame, scale bar, compass, strips and titles."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np

import tinsmith as ts
from tinsmith.base.crs import METRE
from tinsmith.terrain.drawing import make_legend
from tinsmith.terrain.viewer.annotations import TitleBlock, annotate
from tinsmith.terrain.viewer.camera import View, aim
from tinsmith.terrain.viewer.corridor import STRIP_GAP
from tinsmith.terrain.viewer.options import PreviewOptions
from tinsmith.terrain.viewer.scene import fit_layout, make_scene
from tinsmith.terrain.viewer.strips import place_strips

from .campaign import Campaign, Case

LETTER = 0.55
"""Width of a letter as a share of its size, as the oracle measures it."""


class Recorder:
    """An overlay that keeps what it is asked to draw."""

    def __init__(self) -> None:
        self.bar, self.needle, self.ring = [], None, None
        self.texts: list[tuple[str, float, float, float, bool]] = []

    def clear(self) -> None:
        self.__init__()  # type: ignore[misc]

    def draw_scale(self, corner: Any, size: Any, colors: Any) -> None:
        self.draw_rectangle(corner, size, tuple(colors[0]))

    def draw_rectangle(self, corner: Any, size: Any, color: Any) -> None:
        if size[1] == 7.0:
            self.bar.append((corner[0], size[0]))

    def draw_polygon(self, corners: Any, color: Any) -> None:
        self.needle = np.array(corners[0]) if self.needle is None else self.needle

    def draw_line(self, places: Any, color: Any, *, width: float = 1.0) -> None:
        if len(places) > 40:
            self.ring = np.array(places)

    def draw_text(
        self, place: Any, words: str, color: Any, *, size: float, bold: bool = False, **_: Any
    ) -> None:
        self.texts.append((words, place[0], place[1], size, bold))

    def measure_text(self, words: str, *, size: float, bold: bool = False) -> float:
        return LETTER * size * len(words)


def generate(rng: np.random.Generator) -> Case:
    """Points in a turned box of any proportions, and options in their ranges."""
    count = int(rng.integers(3, 60))
    sides = 10.0 ** rng.uniform(-1, 4, 2)
    turn = rng.uniform(0, math.pi)
    flat = (rng.random((count, 2)) - 0.5) * sides
    flat = flat @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    heights = rng.choice([0.0, 1.0]) * rng.random(count) * 10.0 ** rng.uniform(-1, 3)
    title = "".join(rng.choice(list("abc  "), int(10.0 ** rng.uniform(0, 3.2))))
    return {
        "points": np.column_stack([flat + rng.choice([0.0, 5e5]), heights]).tolist(),
        "azimuth": None if rng.random() < 0.4 else float(rng.uniform(0, 360)),
        "tilt": None if rng.random() < 0.3 else float(rng.choice([0, 5, 35, 60, 89.6, 90])),
        "size": rng.integers(200, 3000, 2).tolist(),
        "title": title.strip() or "x",
    }


def examine(case: Case) -> str:
    """Project every point by hand, and compare with what the annotations say."""
    try:
        tin = ts.triangulate(case["points"])
    except ts.TinsmithError:
        return "refused: points"
    options = {name: case[name] for name in ("azimuth", "tilt", "size", "title")}
    scene = make_scene(tin, PreviewOptions.of(**options))
    layout, _ = fit_layout(scene.options.size)
    if scene.strips is not None:
        examine_strips(scene, layout)
        return f"{min(len(scene.strips.lows), 9)} strips"
    size = (layout.width, layout.height)
    camera = SimpleNamespace()
    points = scene.points[~scene.shown.is_far_off]
    aim(camera, points, view=scene.view, frame=layout.frame, size=size)
    shown = project(camera, points, size)
    frame, slack = layout.frame, 1e-6 * max(size)
    assert (shown.min(axis=0) >= np.array([frame.xmin, frame.ymin]) - slack).all(), "left, below"
    assert (shown.max(axis=0) <= np.array([frame.xmax, frame.ymax]) + slack).all(), "right, above"
    room = np.array([frame.width, frame.height]) - np.ptp(shown, axis=0)
    assert room.min() <= 1e-3 * max(size), "the frame is not filled"
    examine_annotations(scene, layout, camera)
    return "one picture"


def project(camera: Any, points: Any, size: Any) -> Any:
    """Pixels from the lower left, from the position, focus and upward direction alone."""
    toward = np.subtract(camera.position, camera.focal_point)
    toward = toward / np.linalg.norm(toward)
    right = np.cross(camera.up, toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    away = np.asarray(points, float) - camera.focal_point
    scale = size[1] / 2 / camera.parallel_scale
    assert (away @ toward <= np.linalg.norm(camera.position - camera.focal_point) * 1.001).all()
    return np.column_stack([away @ right, away @ up]) * scale + np.divide(size, 2)


def examine_annotations(scene: Any, layout: Any, camera: Any) -> None:
    overlay, size = Recorder(), (layout.width, layout.height)
    unit = float(camera.parallel_scale)
    legend = make_legend("elevation", (0.0, 1.0), "m")
    title_block = TitleBlock(scene.title_block.title, "S", 1.0, legend, METRE)
    annotate(overlay, layout, title_block, camera)  # type: ignore[arg-type]
    view: View = scene.view
    turn = math.radians(view.azimuth)
    ends = [[0, 0, 0], [0, unit, 0], [-unit * math.cos(turn), unit * math.sin(turn), 0]]
    start, north, across = project(camera, ends, size)
    pixels = (across - start)[0] / unit
    assert abs((across - start)[1]) < 1e-6 * size[1], "across is not level"
    ring = overlay.ring
    center = (ring.max(axis=0) + ring.min(axis=0)) / 2
    expected = (north - start) / (unit * pixels) * 40.0
    assert np.abs(overlay.needle - center - expected).max() < 1e-3, "north"
    length = sum(width for _, width in overlay.bar)
    assert 0.4 * 260 <= length <= 260.001, "length of the scale bar"
    said = [words for words, _, y, size, _ in overlay.texts if (y, size) == (76.0, 15)]
    *_, number, symbol = said
    meters = float(number.replace(",", "")) * (1000.0 if symbol == "km" else 1.0)
    assert abs(meters * pixels - length) < 1e-6 * length, f"{meters} m are {length} pixels"
    examine_title(overlay, layout, scene.title_block.title)


def examine_title(overlay: Recorder, layout: Any, title: str) -> None:
    lines = [one for one in overlay.texts if one[4] and one[0] != "N"]
    whole = " ".join(words for words, *_ in lines)
    is_cut = whole.endswith("...")
    kept = whole.removesuffix("...").replace(" ", "")
    assert title.replace(" ", "").startswith(kept), "another title"
    assert is_cut or kept == title.replace(" ", ""), "a title is cut and does not show it"
    for words, _, y, size, _ in lines:
        assert len(words) * LETTER * size <= layout.width - 88 + 1e-6, "too wide"
        assert layout.frame.ymax < y < layout.height - size / 2, "outside of the header"


def examine_strips(scene: Any, layout: Any) -> None:
    strips, (right, up, _) = scene.strips, scene.view.axes
    across, along = scene.points @ right, scene.points @ up
    slack = 1e-9 * (np.ptp(across) + np.ptp(along))
    assert strips.edges[0] <= across.min() + slack, "begins too late"
    assert strips.edges[-1] >= across.max() - slack, "ends too early"
    last = len(strips.lows) - 1
    strip = np.clip(np.searchsorted(strips.edges, across, side="right") - 1, 0, last)
    assert (along >= strips.lows[strip] - slack).all(), "below its strip"
    assert (along <= strips.highs[strip] + slack).all(), "above its strip"
    places, frame = place_strips(strips, layout), layout.frame
    assert places[0].top <= frame.ymax - STRIP_GAP + 1e-6, "no room for the label"
    assert places[-1].top - places[-1].height >= frame.ymin - 1e-6, "below the frame"
    assert places[0].left >= frame.xmin - 1e-6, "left of the frame"
    assert strips.length * strips.scale <= frame.width * (1 + 1e-9), "wider than the frame"


CAMPAIGNS = (
    Campaign("pictures", "frame, scale bar, compass, strips and title", generate, examine),
)
