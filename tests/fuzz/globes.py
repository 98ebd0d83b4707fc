"""Campaign: quantized-mesh tiles of points in tiles, against those of the surface in memory."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from support.many_files import Shuffled

import tinsmith as ts

from .campaign import Campaign, Case

_MOST_POINTS = 300


def generate(rng: np.random.Generator) -> Case:
    """Points at random, in centimetres, on a lattice or in clusters, near or across tiles."""
    count = int(rng.integers(3, _MOST_POINTS))
    size = float(rng.choice([1.0, 100.0, 5e3, 3e5]))
    kind = int(rng.integers(0, 4))
    if kind == 0:
        xy = rng.random((count, 2))
    elif kind == 1:
        xy = np.round(rng.random((count, 2)), 2)
    elif kind == 2:
        xy = rng.integers(0, 20, (count, 2)) / 20.0
    else:
        xy = np.concatenate([rng.normal(0, 0.01, (count, 2)), rng.random((count, 2))])
    xy = np.round(xy * size * rng.choice([1.0, 0.1], 2), 3)
    corner = rng.choice([[500_000.0, 4_000_000.0], [500_000.0, 0.0], [250_000.0, 5_000_000.0]])
    z = np.round(rng.normal(0, float(rng.choice([0.01, 1.0, 300.0])), len(xy)), 3)
    most = min(int(np.log2(180.0 * 111e3 / size)) + 4, 24)  # some 16 tiles across
    return {
        "points": np.column_stack([xy + corner, z]).tolist(),
        "max_level": None if kind < 3 and rng.random() < 0.7 else int(rng.integers(most - 6, most)),
        "tiles": int(rng.integers(2, 12)),
        "seed": int(rng.integers(0, 10**6)),
    }


def examine(case: Case) -> str:
    """Write both, and those of other tiles."""
    points = np.array(case["points"], np.float64).reshape(-1, 3)
    options = {"format": "quantized-mesh", "max_level": case["max_level"]}
    with TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore", ts.LossWarning)
        folder = Path(name)
        file = ts.write(ts.Survey(points=points), folder / "points.ply")
        cloud = ts.tiles(file, crs="EPSG:32616")
        try:
            tin = ts.triangulate(ts.read(file, crs="EPSG:32616"))
            whole = _read(ts.write(tin, folder / "whole", **options))
        except (ts.PointsError, ts.WriteError) as error:
            return f"refused: {type(error).__name__}"
        made = []
        for tiles in (1, case["tiles"]):
            way = {"tiles": tiles, "executor": Shuffled(case["seed"])}
            try:
                made.append(_read(cloud.write(folder / f"made{tiles}", **options, **way)))
            except (ts.PointsError, ts.ReadError) as error:
                sentence = str(error)
                allowed = ("no triangle is as large", "so narrow", "nearer to each other than")
                assert any(one in sentence for one in allowed), sentence
                return "refused in tiles"
    assert made[0] == made[1]
    finest = json.loads(whole["layer.json"])["maxzoom"]
    assert finest == json.loads(made[0]["layer.json"])["maxzoom"]
    for path, content in whole.items():
        if path.startswith(f"{finest}/"):
            assert made[0].get(path) == content, path
    own = {path for path in made[0] if path.startswith(f"{finest}/")}
    assert own <= whole.keys()
    return f"{finest} levels"


def _read(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


CAMPAIGNS = (Campaign("globes", "quantized-mesh tiles of many files", generate, examine),)
