"""Triangles that may make no surface, through every format of meshes: one rule for all."""

from __future__ import annotations

import re
import tempfile
import warnings
from pathlib import Path

import numpy as np
from support.face_files import FACE_WRITERS, write_faces

import tinsmith as ts

from .campaign import Campaign, Case

_KINDS = tuple(FACE_WRITERS)
_OFFER = re.compile(r"`faces='surface'` leaves out ([\d,]+) of ([\d,]+) triangles")
_LEFT_OUT = re.compile(
    r"Left out(?:, without area or turned over by rounding| to make a surface): ([\d,]+) of"
)


def generate(rng: np.random.Generator) -> Case:
    """A triangulation of whole steps with some turned round and further ones."""
    size = int(rng.choice([4, 30, 1000, 32_767]))
    count = int(rng.integers(4, 20))
    xy = np.unique(np.vstack([[[0, 0], [size, 0], [0, size]],
                              rng.integers(0, size + 1, (count, 2))]), axis=0)  # fmt: skip
    points = np.column_stack([xy, rng.integers(0, 32_768, len(xy))])
    triangles = ts.triangulate(points.astype(float)).triangles.tolist()
    for _ in range(int(rng.choice([0, 1, 1, 2, 4]))):
        triangles.append(rng.choice(len(points), 3, replace=False).tolist())
    for row in np.flatnonzero(rng.random(len(triangles)) < rng.choice([0.0, 0.5])).tolist():
        triangles[row] = triangles[row][::-1]
    return {"points": points.tolist(), "triangles": triangles, "kind": str(rng.choice(_KINDS))}


def examine(case: Case) -> str:
    """Read with both policies: nothing is lost without a word, and the offer is what it says."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        path, how = write_faces(case["kind"], case["points"], case["triangles"], Path(folder))
        surface = ts.read(path, **how, faces="surface")
        try:
            whole = ts.read(path, **how)
        except ts.ReadError as error:
            return _examine_refusal(str(error), len(case["triangles"]) - len(surface.triangles))
    _require_surface(surface)
    told = sum(int(one[1]) for note in whole.notes if (one := _LEFT_OUT.search(note)))
    assert len(whole.triangles) == len(case["triangles"]) - told, "lost without a word"
    if len(surface.triangles) == len(whole.triangles):
        return "surface"
    assert any("overlap" in note for note in whole.notes), whole.notes
    return "told"


def _examine_refusal(sentence: str, left_out: int) -> str:
    found = _OFFER.search(sentence)
    assert found, sentence
    assert int(found[1].replace(",", "")) == left_out > 0, sentence
    return "refused"


def _require_surface(tin: ts.TIN) -> None:
    """Triangles that do not overlap have together the area of what they cover."""
    import shapely

    covered = shapely.union_all(shapely.polygons(tin.points[tin.triangles][:, :, :2]))
    total = float(np.sum(shapely.area(shapely.polygons(tin.points[tin.triangles][:, :, :2]))))
    assert abs(covered.area - total) <= 1e-9 * total + 1e-15, (covered.area, total)


CAMPAIGNS = (Campaign("faces", "meshes that are no surface, in every format", generate, examine),)
