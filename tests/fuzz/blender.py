"""Damaged files in the Blender add-on: lines and surfaces that are sound, or one sentence."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from support.blender_addon import load_part

from . import readers
from .campaign import Campaign
from .samples import sample_files

_SUFFIXES = {"ply": ".ply", "gpkg": ".gpkg"}


def generate(rng: np.random.Generator) -> dict[str, Any]:
    """Choose a kind of file, a sound one, and its damages."""
    return readers.generate(rng, kind=str(rng.choice([*_SUFFIXES])))


def examine(case: dict[str, Any]) -> str:
    """Read the damaged file as the add-on does."""
    refused = load_part("reference").Refused
    part = load_part("ply" if case["kind"] == "ply" else "geopackage")
    content = dict(sample_files(case["kind"]))[case["name"]]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "a" + _SUFFIXES[case["kind"]])
        path.write_bytes(readers.damaged(content, case["damages"]))
        try:
            found = part.read(path)
        except refused as error:
            return "refused" if "\n" not in str(error) else "refused in several lines"
    for line in found.lines:
        assert np.isfinite(line.points).all()
        assert line.points.shape[1] == 3
    if found.points is not None:
        assert np.isfinite(found.points).all()
        assert found.triangles.size == 0 or found.triangles.max() < len(found.points)
    return "read"


CAMPAIGNS = (Campaign("blender", "damaged files in the Blender add-on", generate, examine),)
