"""What a page shows, in whole steps from one origin, and the page as one file."""

from __future__ import annotations

import base64
import json
import math
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ....base.errors import OptionError
from ....base.georeference import find_ellipsoid, label_axes
from ....base.sentences import counted
from ...drawing import (
    LINE_STYLES,
    find_line_edges,
    join_edges,
    palette,
)
from .packing import pack_counts, pack_rows, pack_triangles, sort_in_morton_order

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from ....base.arrays import Float64Array, Int64Array
    from ....base.georeference import Ground
    from ....base.policies import Tint
    from ....tin import TIN, Survey
    from ..options import PreviewOptions
    from ..ortho import Ortho

_STEPS = 2**22
"""Steps of a coordinate from end to end, at least: 0.3 mm in a kilometre."""

_MOST_STEPS = 2**30
"""Steps at most, whose differences 32 bits hold: a millimetre in a thousand kilometres."""

_COLOURS = 64
_MOST_LABELS = 20_000
_DECIMALS = 3
_SHOWN_DIGITS = 2
"""Digits of a surface's span that are shown, where they are more than the decimals above."""


class Labels(NamedTuple):
    """Places of survey points, (k, 3), and what is written at them."""

    points: Float64Array
    texts: tuple[str, ...]


class Start(NamedTuple):
    """How a page looks when it is opened."""

    exaggeration: float
    elevations: tuple[float, float]
    """Lowest and highest of the tints."""
    relief: tuple[float, float]
    """Lowest and highest but for those far off all others."""
    tint: Tint
    interval: float
    """Of contours, 0 for none."""


class _Steps(NamedTuple):
    """Coordinates as whole numbers: from an origin, in steps across and up; how far they span."""

    origin: Float64Array
    scale: Float64Array
    across: float
    up: float
    spans: tuple[float, ...]

    def round(self, points: Float64Array) -> Int64Array:
        """Return the (n, 3) whole steps of places."""
        size = np.array([self.across, self.across, self.up]) / self.scale
        rounded: Int64Array = np.rint((points - self.origin) / size).astype(np.int64)
        return rounded


def describe_page(
    surfaces: Mapping[str, TIN],
    ground: Ground,
    *,
    title: str,
    start: Start,
    changes: Mapping[str, Float64Array],
    labels: Labels | None,
    notes: Sequence[str],
    basis: str = "",
    ortho: Ortho | None = None,
) -> dict[str, Any]:
    """Return what a page needs, ready for JSON.

    Surfaces are named, all in one CRS, at least one; ``changes`` are cut and fill at the vertices
    of some of them, (n,), and ``basis`` says how they were computed; ``notes`` tell what had to be
    assumed; the ortho is draped over all.
    """
    steps = _choose_steps(list(surfaces.values()), ground)
    described = [
        _describe_surface(name, tin, steps, changes.get(name)) for name, tin in surfaces.items()
    ]
    if labels is not None:
        places = pack_rows(steps.round(labels.points))
        texts = list(labels.texts)
        described[len(surfaces) - len(changes) - 1]["labels"] = {
            "title": "Points",
            "places": places,
            "texts": texts,
        }
    # Surfaces of cut and fill stand behind the others, which they repeat.
    last = [tin for name, tin in surfaces.items() if name not in changes][-1]
    counts = f"{len(last.points):,} points, {counted(len(last.triangles), 'triangle')}"
    return {
        "title": title,
        "subtitle": f"{counts} \N{MIDDLE DOT} {ground.crs_name}",
        "notes": " ".join(notes),
        "crs": ground.crs_name,
        "units": {
            "horizontal": ground.unit.symbol,
            "elevation": "" if last.elevation_unit is None else last.elevation_unit.symbol,
        },
        "elevationName": "Elevation",
        "axes": [[label.name.capitalize(), label.sign] for label in label_axes(last.crs)],
        "geographic": last.crs is not None and last.crs.is_geographic,
        "ellipsoid": find_ellipsoid(last.crs),
        "origin": steps.origin.tolist(),
        "scale": steps.scale[:2].tolist(),
        "decimals": [
            _count_decimals(steps.across, max(steps.spans[:2])),
            _count_decimals(steps.up, steps.spans[2]),
        ],
        "elevationScale": float(ground.scale[2]),
        **start._asdict(),
        "basis": basis,
        "ramps": _make_ramps(),
        "colors": palette.PAGE_COLORS,
        "ortho": None if ortho is None else _describe_ortho(ortho, steps),
        "surfaces": described,
        "tileset": None,
    }


def describe_tileset(address: str, look: PreviewOptions) -> dict[str, Any]:
    """Return what a page of a tileset needs: the rest it finds when it reads that.

    ``address`` is that of its JSON, relative to the page.
    """
    return {
        "title": look.title,
        "subtitle": "",
        "notes": "",
        "exaggeration": look.exaggeration or 0.0,
        "elevations": look.elevations,
        "tint": look.tint,
        "interval": look.contours or 0.0,
        "basis": "",
        "ramps": _make_ramps(),
        "colors": palette.PAGE_COLORS,
        "ortho": None,
        "surfaces": [],
        "tileset": {"address": address},
    }


def find_labels(points: Float64Array, survey: Survey) -> Labels | None:
    """Return the points of a survey with their numbers, or their elevations if they have none.

    ``points`` are (k, 3), elevations in the unit of the page. None where there are more than can be
    read.
    """
    if not 0 < len(points) <= _MOST_LABELS:
        return None
    numbers = survey.attributes.get("number")
    texts = (f"{z:.2f}" for z in points[:, 2]) if numbers is None else map(str, numbers)
    return Labels(points, tuple(text[:40] for text in texts))


def _choose_steps(tins: Sequence[TIN], ground: Ground) -> _Steps:
    low = np.min([tin.points.min(axis=0) for tin in tins], axis=0)
    high = np.max([tin.points.max(axis=0) for tin in tins], axis=0)
    scale = np.array([ground.scale[0], ground.scale[1], 1.0])
    spans = (high - low) * scale
    if not np.isfinite(spans).all():
        raise OptionError("tin", "a surface", "coordinates whose differences are finite")
    across, up = (_round_step(float(span)) for span in (max(spans[:2]), spans[2]))
    origin = [_round_origin(*ends) for ends in zip(low.tolist(), high.tolist(), strict=True)]
    return _Steps(np.array(origin), scale, across, up, tuple(spans.tolist()))


def _round_origin(low: float, high: float) -> float:
    """Return a number near the middle with few digits, or with all where they are needed."""
    middle = low + (high - low) / 2
    short = float(f"{middle:.9g}")
    return short if low <= short <= high else middle


def _round_step(span: float) -> float:
    """Return the largest power of ten, at most a millimetre, that makes enough steps.

    It is more than a millimetre where there would be too many of them.
    """
    if span == 0.0:
        return 1e-3
    wanted = min(10.0 ** math.floor(math.log10(span / _STEPS)), 1e-3)
    return float(max(wanted, 10.0 ** math.ceil(math.log10(span / _MOST_STEPS))))


def _count_decimals(step: float, span: float) -> int:
    """Return the decimals to show: of a millimetre, or some of a small span, but not below a step.

    Beyond the digits of a float64 none is told.
    """
    of_step = max(-math.floor(math.log10(step) + 0.5), 0)
    of_span = _SHOWN_DIGITS - math.floor(math.log10(span)) if span > 0 else 0
    return min(of_step, max(_DECIMALS, of_span))


def _describe_ortho(ortho: Ortho, steps: _Steps) -> dict[str, Any]:
    """Return the picture, and the transform to it from coordinates as the page has them."""
    placement = ortho.placement
    turn, shift = placement[:, :2], placement[:, 2]
    place = np.column_stack([turn / steps.scale[:2], turn @ steps.origin[:2] + shift])
    return {
        "kind": ortho.kind,
        "isWhole": ortho.gap == 0.0,
        "place": place.ravel().tolist(),
        "data": base64.b64encode(ortho.content).decode("ascii"),
    }


def _describe_surface(
    name: str, tin: TIN, steps: _Steps, change: Float64Array | None
) -> dict[str, Any]:
    rows = steps.round(tin.points)
    order = sort_in_morton_order(rows[:, :2])
    number = np.empty(len(order), np.int64)
    number[order] = np.arange(len(order))
    moved = None if change is None else np.rint(change[order] / steps.up).astype(np.int64)
    return {
        "name": name,
        "step": [steps.across, steps.up],
        "vertices": pack_rows(rows[order]),
        "triangles": pack_triangles(number[tin.triangles]),
        "difference": None if moved is None else pack_rows(moved[:, None]),
        "lines": list(_describe_lines(tin, rows)),
        "labels": None,
    }


def _describe_lines(tin: TIN, rows: Int64Array) -> Iterator[dict[str, Any]]:
    for kind, pairs in find_line_edges(tin).by_kind().items():
        vertices, counts = join_edges(pairs)
        lines = {"vertices": pack_rows(rows[vertices]), "counts": pack_counts(counts)}
        yield {"kind": kind, **LINE_STYLES[kind]._asdict(), "lines": lines}


def _make_ramps() -> dict[str, list[str]]:
    tints: tuple[Tint, ...] = ("elevation", "slope", "aspect")
    return {
        **{tint: palette.write_hex(palette.choose_ramp(tint, _COLOURS)) for tint in tints},
        "difference": palette.write_hex(palette.mix_tints(palette.CUT_RUNGS, _COLOURS // 2))
        + palette.write_hex(palette.mix_tints(palette.FILL_RUNGS, _COLOURS // 2)),
    }


def make_document(content: Mapping[str, Any]) -> str:
    """Return the HTML of a page of what :func:`.content.describe_page` gives.

    Data cannot end its own element or begin another: "<" is written as an escape of JSON, and the
    words of the title as character references. A content security policy in the page forbids every
    request, but those of a tileset to the server that gave the page.
    """
    folder = files(__package__)
    text = json.dumps(content, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    parts = {
        "title": escape(content["title"]),
        "subtitle": escape(content["subtitle"]),
        "notes": escape(content["notes"]),
        "requests": "" if content["tileset"] is None else "; connect-src 'self'",
        "colors": _write_colors(),
        "style": folder.joinpath("style.css").read_text("utf-8"),
        "payload": text.replace("<", "\\u003c"),
        "viewer": folder.joinpath("viewer.js").read_text("utf-8"),
    }
    pieces = folder.joinpath("template.html").read_text("utf-8").split("{{")
    filled = [pieces[0]]
    for piece in pieces[1:]:
        name, _, rest = piece.partition("}}")
        filled += [parts[name], rest]
    return "".join(filled)


def _write_colors() -> str:
    """Return the colours of both themes as variables of CSS."""
    themes = ((":root", "light"), (':root[data-theme="dark"]', "dark"))
    rules = [f":root {{ --sample: {palette.SAMPLE_FRAME}; }}"]
    for selector, theme in themes:
        codes = " ".join(f"--{name}: {code};" for name, code in palette.PAGE[theme].items())
        rules.append(f"{selector} {{ {codes} }}")
    return "\n".join(rules)
